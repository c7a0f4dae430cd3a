# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes and verifies USD layers of an ocean by the command line in a separate process, and imports them.

They contain the sea of the settings with the patch's corner at the origin, wherever the object is.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import bpy

from ..core.data.frames import Frame, format_frames
from ..core.parameters.shot import Shot
from ..export.usd.attributes import ATTRIBUTES
from ..export.usd.isolated import read_package
from ..export.usd.options import OPTIONS, command_arguments
from . import ocean_object, stored_paths
from .baked_spray import spray_arguments, spray_numbers
from .cache_place import bake_name, shown_bake
from .command_process import CommandProcess, Running
from .preferences import user_folder
from .settings import VIEWPORT_RESOLUTION, OceanObjectError, scene_of, settings_of
from .shots import animate, check_keys
from .units import frame_rate, set_frame_rate, set_time_stretch, shortest_decimal, time_stretch

_FOLDER = "usd"


class UsdExport(CommandProcess):
    """A running export.

    frames : all that are wanted
    path : the asset's own layer
    size : of all written layers and images, bytes; 0 until the end
    """

    def __init__(self, item: bpy.types.Object, shot: Shot, frames: Sequence[Frame]) -> None:
        """Start it. Raises OceanObjectError for a file without a place, OSError for what the disk refuses.

        shot : the ocean's; replaced by that of a bake if its images are used
        """
        self.frames = tuple(frames)
        self.path = usd_file(item)
        self.size = 0
        bake = used_bake(item)
        arguments = [
            "usd", f"--form={settings_of(item).usd.form}", f"--frames={format_frames(self.frames)}",
            f"--out={self.path}", *command_arguments(choices(item)),
        ]  # fmt: skip
        arguments += spray_arguments(item, scene_of(item))
        if bake is None:
            super().__init__(item.name, arguments, shot)
        else:
            super().__init__(item.name, [*arguments, *spray_numbers(item, scene_of(item)), f"--bake={bake}"])

    def take(self, said: dict[str, Any]) -> None:
        """The last line contains the size."""
        self.size = said.get("bytes", self.size)
        super().take(said)


class UsdCheck(CommandProcess):
    """A running verification.

    path : the asset's own layer
    problems : found so far
    """

    def __init__(self, item: bpy.types.Object) -> None:
        """Start it. Raises OceanObjectError for a file without a place."""
        self.path = usd_file(item)
        self.problems: list[str] = []
        super().__init__(item.name, ["usd-verify", str(self.path)])

    def take(self, said: dict[str, Any]) -> None:
        """Each line is a problem."""
        if "problem" in said:
            frame = "" if said["frame"] is None else f"frame {said['frame']}: "
            self.problems.append(frame + said["problem"])


def choices(item: bpy.types.Object) -> dict[str, Any]:
    """The ocean's settings as arguments of the command."""
    settings = settings_of(item).usd
    chosen = {name: getattr(settings, name) for name in OPTIONS}
    return {
        **chosen,
        "metres_per_unit": float(shortest_decimal(settings.metres_per_unit)),
        # in the order of the table, not of a set
        "attributes": [name for name in ATTRIBUTES if name in settings.attributes],
        "variants": "".join(settings.variants.split()),
    }


def used_bake(item: bpy.types.Object) -> Path | None:
    """The bake whose images will displace the grid; None if the export bakes its own, or needs none."""
    settings = settings_of(item)
    wanted = settings.source == "SEQUENCE" and settings.usd.form == "displacement" and settings.usd.use_bake
    return shown_bake(item) if wanted else None


def default_file(item: bpy.types.Object) -> str:
    """Default path of an ocean's asset, relative to its .blend file, in a folder of its own."""
    name = bake_name(item)
    return f"//{_FOLDER}/{name}/{name}.usd"


def usd_file(item: bpy.types.Object) -> Path:
    """The asset's own layer. Raises OceanObjectError if its path depends on an unsaved file, or is of another
    system.

    Without a path, an ocean of an unsaved file is exported to the user's folder.
    """
    path = settings_of(item).usd.file
    if bpy.data.filepath or item.library is not None:
        return stored_paths.absolute(path or default_file(item), item.library)
    if not path:
        return user_folder(_FOLDER).joinpath(*default_file(item).split("/")[3:])
    if path.startswith("//"):
        raise OceanObjectError(f"{path} lies beside this file, which was never saved: save it first")
    return stored_paths.absolute(path)


_running = Running()


def start_export(item: bpy.types.Object, shot: Shot, frames: Sequence[Frame]) -> UsdExport:
    """Start an export and remember it for the panel; raises what UsdExport raises."""
    export = _running[item.session_uid] = UsdExport(item, shot, frames)
    return export


def start_check(item: bpy.types.Object) -> UsdCheck:
    """Start a check and remember it for the panel; raises what UsdCheck raises."""
    check = _running[item.session_uid] = UsdCheck(item)
    return check


running, forget = _running.of, _running.forget


def add_from_layer(
    scene: bpy.types.Scene,
    path: Path,
    collection: bpy.types.Collection | None = None,
    use_frame_rate: bool = True,
) -> bpy.types.Object:
    """Add the sea of a layer, where the layer has it, named after its prim and animated as it was.

    use_frame_rate : set the scene's frame rate to the sea's

    Raises UsdError for a layer without a sea of ours, and the errors of `ocean_object.add`; then nothing is
    changed.
    """
    prim, package = read_package(path)
    shot, before = package.shot, (frame_rate(scene), time_stretch(scene))
    check_keys(shot)
    if use_frame_rate:
        set_frame_rate(scene, shot.parameters.timing.fps)
        set_time_stretch(scene, shot.parameters.timing.stretch)
    try:
        item = ocean_object.add(
            scene, shot.parameters, name=prim.rpartition("/")[2], collection=collection,
            viewport_resolution=VIEWPORT_RESOLUTION, repeats=package.tiles,
        )  # fmt: skip
    except ocean_object.EXPECTED_ERRORS:
        set_frame_rate(scene, before[0])
        set_time_stretch(scene, before[1])
        raise
    animate(item, scene, shot)
    return item
