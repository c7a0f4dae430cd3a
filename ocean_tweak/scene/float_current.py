# SPDX-License-Identifier: GPL-3.0-or-later
"""What floats and drifts goes along with its ocean's current: its carrier is given how far that has come."""

from __future__ import annotations

from collections.abc import Iterator

import bpy
import numpy as np

from ..core import Current, ParameterError
from ..nodes.floating import CARRIER, CURRENT
from ..nodes.modifier_inputs import all_inputs
from ..nodes.versioned import is_of_kind
from . import float_carrier
from .animated import clock_of, is_animated, shown_settings
from .floating import Ride, ride_of
from .settings import is_ocean, oceans_in, settings_of
from .units import metres_per_unit


def come(current: Current | None, time: float) -> tuple[float, float]:
    """x and y in m that the water of an ocean has come by a time in s."""
    return (0.0, 0.0) if current is None else current.carried(time)


def follow_before_frame(scene: bpy.types.Scene) -> None:
    """At the frame that the scene is about to evaluate, of oceans that are not animated."""
    for carrier, ocean, ride in _drifting():
        if not is_animated(ocean):
            _give(carrier, ocean, ride, scene, None)


def follow_after_frame(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None) -> None:
    """Of oceans that are animated, whose current is known only now."""
    for carrier, ocean, ride in _drifting():
        if is_animated(ocean):
            _give(carrier, ocean, ride, scene, depsgraph)


def follow_by_hand(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None) -> None:
    """Whatever was set."""
    for carrier, ocean, ride in _drifting():
        _give(carrier, ocean, ride, scene, depsgraph)


def carriers_in_current(ocean: bpy.types.Object) -> list[bpy.types.Object]:
    """The carriers of what drifts with an ocean's current."""
    if not settings_of(ocean).use_current:
        return []
    return [carrier for carrier, its_ocean, ride in _drifting() if its_ocean == ocean and ride.drift]


def _drifting() -> Iterator[tuple[bpy.types.Object, bpy.types.Object, Ride]]:
    """The carriers of this file, with their oceans and rides."""
    if not any(is_of_kind(group, CARRIER) for group in bpy.data.node_groups):
        return
    for item in list(bpy.data.objects):
        if item.library is None and float_carrier.is_carrier(item):
            ocean, ride = ride_of(item)
            if ocean is not None and is_ocean(ocean):
                yield item, ocean, ride


def _give(
    carrier: bpy.types.Object,
    ocean: bpy.types.Object,
    ride: Ride,
    scene: bpy.types.Scene,
    depsgraph: bpy.types.Depsgraph | None,
) -> None:
    """Tell a carrier how far the water has come, in Blender units, where that has changed."""
    modifier = float_carrier.modifier_of(carrier)
    before = {} if modifier is None else all_inputs(modifier)
    if CURRENT not in before or ocean not in oceans_in(scene):
        return
    way = (0.0, 0.0)
    settings = shown_settings(ocean, depsgraph)
    if ride.drift and settings.use_current:
        try:
            sea = settings.to_parameters(scene)
        except ParameterError:
            return  # the ocean tells
        way = come(sea.current, float(clock_of(settings, scene, sea.timing.start_frame).time))
    metres = float(metres_per_unit(scene))
    now = (way[0] / metres, way[1] / metres, 0.0)
    if not np.array_equal(np.float32(now), np.float32(tuple(before[CURRENT]))):
        float_carrier.set_inputs(carrier, {CURRENT: now})
