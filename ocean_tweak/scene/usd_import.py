# SPDX-License-Identifier: GPL-3.0-or-later
"""A live ocean from what a USD layer of ours says of its sea."""

from __future__ import annotations

from pathlib import Path

import bpy

from ..core.shot import OCEAN_TIME, Animation, Shot
from ..export.usd.reading import read_package
from . import ocean_object
from .float_keys import write_curve
from .settings import VIEWPORT_RESOLUTION, OceanSettings, settings_of
from .units import frame_rate, set_frame_rate

_SETTINGS = "ocean_tweak"


def add_from_layer(
    scene: bpy.types.Scene,
    path: Path,
    collection: bpy.types.Collection | None = None,
    use_frame_rate: bool = True,
) -> bpy.types.Object:
    """Add the sea of a layer, where the layer has it, named after its prim and animated as it was.

    use_frame_rate : give the scene the sea's own

    Raises UsdError for a layer that holds none of our seas, and what `ocean_object.add` raises; then nothing
    is changed.
    """
    prim, package = read_package(path)
    shot, before = package.shot, frame_rate(scene)
    if use_frame_rate:
        set_frame_rate(scene, shot.parameters.timing.fps)
    try:
        item = ocean_object.add(
            scene, shot.parameters, name=prim.rpartition("/")[2], collection=collection,
            viewport_resolution=VIEWPORT_RESOLUTION, repeats=package.tiles,
        )  # fmt: skip
    except ocean_object.EXPECTED_ERRORS:
        set_frame_rate(scene, before)
        raise
    if shot.animation is not None:
        _animate(item, scene, shot, shot.animation)
    return item


def _animate(item: bpy.types.Object, scene: bpy.types.Scene, shot: Shot, animation: Animation) -> None:
    """Make keys of the samples, linear between as the samples are."""
    settings = settings_of(item)
    action = bpy.data.actions.new(item.name)
    data = item.animation_data_create()
    data.action = action
    data.action_slot = action.slots.new("OBJECT", item.name)
    for path, values in _columns(settings, scene, shot, animation).items():
        curve = action.fcurve_ensure_for_datablock(item, f"{_SETTINGS}.{path}")
        write_curve(curve, animation.first_frame, values)
    with settings.quiet():
        settings.use_ocean_time = OCEAN_TIME in dict(animation.samples)
    scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)


def _columns(
    settings: OceanSettings, scene: bpy.types.Scene, shot: Shot, animation: Animation
) -> dict[str, list[float]]:
    """Values in Blender's units by the path of their property: the settings know how to convert them."""
    columns: dict[str, list[float]] = {_property(path): [] for path, _ in animation.samples}
    with settings.quiet():
        for frame in range(animation.first_frame, animation.last_frame + 1):
            moment = shot.at(frame)
            settings.from_parameters(moment.parameters, scene)
            settings.ocean_time = float(moment.time)
            for path, column in columns.items():
                column.append(settings.path_resolve(path))
        settings.from_parameters(shot.parameters, scene)
    return columns


def _property(path: str) -> str:
    """The path of a property below the settings, from one of a parameter: layers.0.gain, layers[0].gain."""
    *parents, name = path.split(".")
    return f"{parents[0]}[{parents[1]}].{name}" if parents else name
