# SPDX-License-Identifier: GPL-3.0-or-later
"""Baked points of patches, which move them for the surface around the camera, also without the extension."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import bpy

from ..core import OceanParameters
from ..core.parameters.patch_seas import Part
from ..core.parameters.shot import Moment, Shot
from ..export.cache.folders import JOB_FILE
from ..export.frame_files import POINTS, SMALL_POINTS, files_start, image_file_of
from ..export.points import MOST_IN_WINDOW
from ..nodes.modifier_inputs import set_inputs
from ..nodes.patch_points import FILES, PATCH_POINTS
from ..nodes.shown_frame import frame_values
from ..nodes.versioned import is_of_kind, node_group
from .bake_state import told_by
from .image_sequence import baked_frames, baked_stretch, shown_frame
from .modifiers import is_of_library, set_changed
from .plan import Plan, seconds_per_file, velocity_scale
from .settings import OceanSettings
from .stored_paths import image_file, relative

_NAME = "Ocean Tweak Points"
_FOLDER = re.compile(r".*[\\/]")


@dataclass(frozen=True)
class Points:
    """The points of a bake that an ocean reads.

    folder : as the path of its displacement image has it, so that it moves along with the .blend file
    name : that the files begin with
    parameters : of the sea that was baked
    moment : of it that is shown
    frames : those that have files, ascending
    files_per_frame : of the animation
    seconds_per_file : of the scene
    scale : Blender units in a metre
    velocity_scale : Blender units per second in a metre per second
    """

    folder: str
    name: str
    parameters: OceanParameters
    moment: Moment
    frames: tuple[int, ...]
    files_per_frame: float
    seconds_per_file: float
    scale: float
    velocity_scale: float


def points_of(
    settings: OceanSettings, plan: Plan, scene: bpy.types.Scene, kind: str = POINTS
) -> Points | None:
    """The baked points that an ocean with these settings reads; None where it is live or they are missing.

    kind : POINTS, COAST or WAKES
    """
    found = files_of(settings)
    if found is None:
        return None
    folder, name, here = found
    shot = _baked_shot(here, kind)
    if shot is None:
        return None
    shown = shot.at(shown_frame(settings, scene, scene.frame_current))
    return Points(
        folder, name, shot.parameters, shown, baked_frames(settings),
        files_per_frame=float(baked_stretch(settings)),
        seconds_per_file=seconds_per_file(settings, scene),
        scale=plan.scale,
        velocity_scale=velocity_scale(settings, plan, scene),
    )  # fmt: skip


def read_points(item: bpy.types.Object, number: int, part: Part, points: Points) -> None:
    """Let a patch's mesh read baked points; its own points are removed."""
    if len(item.data.vertices):
        item.data.clear_geometry()
        item.data.update_tag()
    modifier = modifier_of(item)
    if modifier is None or is_of_library(modifier):
        read_none(item)
        modifier = item.modifiers.new(_NAME, "NODES")
    if modifier.node_group != node_group(PATCH_POINTS):
        modifier.node_group = node_group(PATCH_POINTS)
    samples = part.parameters.resolution
    in_window = SMALL_POINTS if samples > MOST_IN_WINDOW else POINTS
    set_inputs(
        modifier,
        {
            FILES[0]: points.folder + files_start(points.name, POINTS, number),
            FILES[1]: points.folder + files_start(points.name, in_window, number),
            **frame_inputs(points),
            "Domain Size": part.parameters.domain_size,
            "Resolution": samples,
        },
    )
    item.update_tag()


def read_none(item: bpy.types.Object) -> None:
    """Let a patch's mesh hold its own points again."""
    modifier = modifier_of(item)
    if modifier is not None and is_of_library(modifier):
        set_changed(modifier, show_viewport=False, show_render=False)
    elif modifier is not None:
        item.modifiers.remove(modifier)


def modifier_of(item: bpy.types.Object) -> bpy.types.NodesModifier | None:
    """The modifier by which a patch's mesh reads points; None if it is live. That of a library may be
    switched off."""
    nodes = (modifier for modifier in item.modifiers if modifier.type == "NODES")
    found = [modifier for modifier in nodes if is_of_kind(modifier.node_group, PATCH_POINTS)]
    own = [modifier for modifier in found if not is_of_library(modifier)]
    return next(iter(own or [modifier for modifier in found if modifier.show_render]), None)


def files_of(settings: OceanSettings) -> tuple[str, str, Path] | None:
    """Of the bake that an ocean reads: the folder as it is stored, the files' name, and the folder where it
    is now. None for a live ocean."""
    image = settings.sequence_maps.disp or settings.early_maps.disp
    if settings.source != "SEQUENCE" or image is None:
        return None
    path = relative(image.filepath, "")
    folder = match[0] if (match := _FOLDER.match(path)) else ""
    file = image_file_of(path.removeprefix(folder))
    return None if file is None else (folder, file.name, image_file(image).parent)


def has_points(settings: OceanSettings, kind: str) -> bool:
    """Whether the bake that an ocean reads has points of a kind; not for a live one."""
    found = files_of(settings)
    return found is not None and _baked_shot(found[2], kind) is not None


def frame_inputs(points: Points) -> dict[str, object]:
    """Values of the inputs for the frame and its scale, of groups that read points."""
    return {
        **frame_values(points.frames, points.files_per_frame, points.seconds_per_file),
        "Scale": points.scale,
        "Velocity Scale": points.velocity_scale,
    }


def _baked_shot(folder: Path, kind: str) -> Shot | None:
    """The shot of a bake with points of a kind; None for other bakes."""
    told = told_by(folder / JOB_FILE)
    return told.shot if kind in told.maps else None
