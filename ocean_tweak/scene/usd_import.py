# SPDX-License-Identifier: GPL-3.0-or-later
"""A live ocean from what a USD layer of ours says of its sea."""

from __future__ import annotations

from pathlib import Path

import bpy

from ..export.usd.apart import read_package
from . import ocean_object
from .settings import VIEWPORT_RESOLUTION
from .shots import animate
from .units import frame_rate, set_frame_rate, set_time_stretch, time_stretch


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
    shot, before = package.shot, (frame_rate(scene), time_stretch(scene))
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
