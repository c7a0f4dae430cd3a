# SPDX-License-Identifier: GPL-3.0-or-later
"""What makes a wake of an object: the size of its hull, an area for its waves, and its path.

A path that keys do not tell is recorded, frame by frame.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import bpy

from ..core import PathSample, WakeLayer
from ..core.waves.wake.outlook import froude_number
from .float_carrier import carrier_of
from .settings import settings_of
from .shots import evaluations
from .units import metres_per_unit
from .wake_makers import InWater, bow_first, footprint_of, in_water, path_of, path_through

#: m/s for which an area is made at most: what is faster jumps
_FASTEST = 60.0
#: Froude number below which an object hardly moves, and for which its area is made then
_SLOW, _USUAL = 0.1, 0.35


def new_wake(
    item: bpy.types.Object,
    ocean: bpy.types.Object,
    scene: bpy.types.Scene,
    known: WakeLayer | None,
    warn: Callable[[str], None],
) -> WakeLayer:
    """The waves of an object on an ocean, of the size and shape of its hull and on its path.

    known : the layer that it has already, of which the rest stays
    warn : is told where its mesh has no shape below the water, so that its waves are those of an ellipse

    Raises WakeError for what is not in the water, or whose path is not known.
    """
    metres = float(metres_per_unit(scene))
    wetted = in_water(item, ocean, metres)
    path = path_of(item, ocean, scene, wetted) or recorded_path(item, ocean, scene, wetted)
    wetted, path = bow_first(item, wetted, path)
    footprint = None
    try:
        footprint = footprint_of(wetted)
    except ValueError as error:
        warn(f"{item.name} makes the waves of an ellipse of its size: {error}")
    length = wetted.length * metres
    sized = replace(
        known or WakeLayer(), path=path, headings="OF_SAMPLES", length=length, beam=wetted.beam * metres,
        draught=wetted.draught * metres, footprint=footprint,
    )  # fmt: skip
    if known is not None:
        return sized
    gravity = settings_of(ocean).to_parameters(scene).water.gravity
    speed, _ = sized.track.fastest
    if froude_number(speed, length, gravity) < _SLOW:
        speed = _USUAL * math.sqrt(gravity * length)
    return sized.in_an_area(min(speed, _FASTEST), gravity)


def recorded_path(
    item: bpy.types.Object, ocean: bpy.types.Object, scene: bpy.types.Scene, wetted: InWater
) -> tuple[PathSample, ...]:
    """Where an object is at each frame of the scene, which ends where it was."""
    place, frames = carrier_of(item) or item, range(scene.frame_start, scene.frame_end + 1)
    places = []
    for depsgraph in evaluations(scene, frames, ocean):
        to_ocean = ocean.evaluated_get(depsgraph).matrix_world.inverted_safe()
        places.append(to_ocean @ place.evaluated_get(depsgraph).matrix_world)
    return path_through(frames, places, ocean, scene, wetted)
