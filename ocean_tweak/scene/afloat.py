# SPDX-License-Identifier: GPL-3.0-or-later
"""Floating objects in front of the camera of a ready scene, which give the sea its scale."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import Ocean, OceanParameters
from . import boat_hull, buoy
from .boat import new_boat
from .buoy import new_buoy
from .clear_water import sight
from .float_carrier import carrier_of
from .floating import Ride, float_on, ride_of
from .moods import VIEW
from .units import metres_per_unit

_OFF_THE_SEA = math.radians(30.0)  # how far from straight into the waves it heads
_ASIDE = (0.3, 0.55)  # of the way from the middle of the picture to its edge
#: custom property of what ocean scenes let float
_OURS = "ocean_tweak_afloat"
_LEADS, _BEARINGS = 17, 5  # of the places that are tried


@dataclass(frozen=True)
class Afloat:
    """Something that floats; lengths in m.

    new : makes it, by name and the metres in a Blender unit
    waterline : waves shorter than this do not move it
    keel : how far that is below its origin
    draft : of its keel below the water
    nearest, farthest : from the camera
    hidden : of it, by the water before it; as little as can be without a number
    """

    label: str
    new: Callable[[str, float], bpy.types.Object]
    waterline: float
    keel: float
    draft: float
    nearest: float
    farthest: float
    hidden: float | None = None


AFLOAT = {
    "BUOY": Afloat("Buoy", new_buoy, buoy.DIAMETER, buoy.DRAFT, buoy.DRAFT, 24.0, 34.0),
    "BOAT": Afloat(
        "Fishing Boat",
        new_boat,
        boat_hull.LENGTH,
        boat_hull.DRAFT,
        boat_hull.DRAFT + boat_hull.LADEN,
        6.0 * boat_hull.LENGTH,
        9.0 * boat_hull.LENGTH,
        hidden=0.8,
    ),
}


def add_afloat(
    kind: str,
    place: NDArray[np.float64],
    camera: bpy.types.Object,
    parameters: OceanParameters,
    ocean: bpy.types.Object,
    scene: bpy.types.Scene,
    collection: bpy.types.Collection,
) -> bpy.types.Object:
    """Let something of AFLOAT ride before a camera, to the side, into the waves and with room before its bow.

    place : of the camera, x, y and z in m, in the patch
    """
    heading = _heading(parameters)
    x, y = _best_seen(AFLOAT[kind], place, camera.data.angle, heading, parameters)
    return let_float(kind, x, y, heading, ocean, scene, collection)


def let_float(
    kind: str,
    x: float,
    y: float,
    heading: float,
    ocean: bpy.types.Object,
    scene: bpy.types.Scene,
    collection: bpy.types.Collection,
) -> bpy.types.Object:
    """Let something of AFLOAT ride an ocean.

    x, y : in the patch, m
    heading : rad counter-clockwise from +x
    """
    metres, chosen = float(metres_per_unit(scene)), AFLOAT[kind]
    item = chosen.new(chosen.label, metres)
    item[_OURS] = kind
    item.location = np.array(ocean.location) + np.array([x, y, 0.0]) / metres
    item.rotation_euler.z = heading
    collection.objects.link(item)
    scene.view_layers.update()
    waterline, draft, keel = (part / metres for part in (chosen.waterline, chosen.draft, chosen.keel))
    ride = Ride(waterline=waterline, draft=draft, keel=keel, tilt=0.8)
    float_on(item, ocean, ride, is_wet=True)
    return item


def own_afloat(ocean: bpy.types.Object, scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """What `add_afloat` let float on an ocean, and still does."""
    ours = ((item, carrier_of(item)) for item in scene.objects if _OURS in item)
    return [item for item, carrier in ours if carrier is not None and ride_of(carrier)[0] == ocean]


def _heading(parameters: OceanParameters) -> float:
    """Into the waves of the first layer, and of the two ways to do so the one that shows more of the side."""
    against = parameters.layers[0].wind_direction + math.pi
    return max(
        (against - _OFF_THE_SEA, against + _OFF_THE_SEA), key=lambda heading: abs(math.sin(heading - VIEW))
    )


def _best_seen(
    chosen: Afloat,
    place: NDArray[np.float64],
    angle: float,
    heading: float,
    parameters: OceanParameters,
) -> tuple[float, float]:
    """x and y in the patch, in m, where the water before it hides as much as is wanted.

    angle : of the camera, from one side of its picture to the other
    heading : of the floating object
    """
    forward = np.array([math.cos(VIEW), math.sin(VIEW)])
    right = np.array([forward[1], -forward[0]])
    side = 1.0 if math.sin(heading - VIEW) > 0.0 else -1.0  # it heads for the middle
    bearing = side * math.tan(0.5 * angle) * np.linspace(*_ASIDE, _BEARINGS)
    distance = np.linspace(chosen.nearest, chosen.farthest, _LEADS)[:, np.newaxis]
    away = (distance[..., np.newaxis] * (forward + bearing[:, np.newaxis] * right)).reshape(-1, 2)
    time = parameters.timing.time(parameters.timing.start_frame)
    seen = sight(Ocean(parameters), time, place, away, np.append(np.linspace(0.05, 0.9, 32), 1.0))
    hidden = seen.horizon - seen.water
    best = int((hidden if chosen.hidden is None else np.abs(hidden - chosen.hidden)).argmin())
    return float(seen.x[best]), float(seen.y[best])
