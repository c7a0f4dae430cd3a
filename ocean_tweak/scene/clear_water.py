# SPDX-License-Identifier: GPL-3.0-or-later
"""What a camera in a ready scene sees of the water, and which point of the sea is put under the 3D cursor,
where Blender adds objects: a clear one.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core import Ocean, OceanParameters
from .moods import VIEW, Mood

Array = NDArray[np.float64]

#: sensor of a new camera, mm, and height by width of the lowest pictures that are usual
_SENSOR, _LOWEST = 36.0, 27.0 / 64.0
#: of the picture's half width and height: how far from its middle and from its edges
_ASIDE, _INSIDE = 0.3, 0.9
_DISTANCES, _BEARINGS, _STEPS = 96, 5, 32
#: wave heights of a better water level that a place as far as the crest is worth, against one at the camera
_FARTHER = 0.2


def clear_place(
    mood: Mood, place: Array, parameters: OceanParameters, view: float = VIEW
) -> tuple[float, float]:
    """x and y in the patch, in m, of a place near the middle of the picture that no wave hides, and where the
    water stands at its mean level in the first frame: what is added there lies on the water.

    place : of the camera, x, y and z in m, in the patch
    view : where it looks, rad counter-clockwise from +x
    """
    sea, time = Ocean(parameters), parameters.timing.time(parameters.timing.start_frame)
    wave_height = sea.statistics().seed.significant_wave_height
    crest = mood.crest_distance * wave_height
    nearest, farthest = _in_picture(mood, float(place[2]), crest)
    ahead, aside = np.meshgrid(np.geomspace(nearest, farthest, _DISTANCES), np.linspace(-1.0, 1.0, _BEARINGS))
    aside *= ahead * _ASIDE * _half_width(mood)
    forward = np.array([math.cos(view), math.sin(view)])
    away = np.stack([ahead, aside], axis=-1).reshape(-1, 2) @ np.array([forward, [forward[1], -forward[0]]])
    seen = sight(sea, time, place, away, np.linspace(0.02, 1.0, _STEPS))
    # in wave heights: how far the water is from its mean level, and how much of it stands before that place
    badness = np.abs(seen.water) + 10.0 * np.maximum(seen.horizon - np.maximum(seen.water, 0.0), 0.0)
    badness = badness / wave_height + _FARTHER * np.hypot(*away.T) / crest
    best = int(badness.argmin())
    return float(seen.x[best]), float(seen.y[best])


class Sight(NamedTuple):
    """Places that a camera looks at; (places,) each, in m.

    x, y : of each, in the patch
    water : its height there
    horizon : height there that is seen just above the waves in between
    """

    x: Array
    y: Array
    water: Array
    horizon: Array


def sight(sea: Ocean, time: float | Fraction, place: Array, away: Array, shares: Array) -> Sight:
    """What waves leave to be seen of places.

    place : of the camera, x, y and z in m, in the patch
    away : (places, 2) from the camera to each, m
    shares : of the way to a place, at which water is looked for; the last is 1, the place itself
    """
    share, way = shares[:, np.newaxis], np.hypot(*away.T)
    x, y = (place[axis] + share * away[:, axis] for axis in (0, 1))
    water = sea.height_at(x, y, time)
    steepest = ((water[:-1] - place[2]) / (share[:-1] * way)).max(axis=0)
    return Sight(x[-1], y[-1], water[-1], place[2] + steepest * way)


def _half_width(mood: Mood) -> float:
    """Of the picture, a metre from the camera, m."""
    return 0.5 * _SENSOR / mood.lens


def _in_picture(mood: Mood, height: float, crest: float) -> tuple[float, float]:
    """Distances from and to which mean water is in the picture; around the crest's where it nowhere is.

    height : of the camera over mean water, m
    crest : distance of the highest crest, m
    """
    half = math.atan(_INSIDE * _LOWEST * _half_width(mood))
    # angles below the horizon, of what is nearest and what is farthest
    lower, upper = mood.tilt + half, mood.tilt - half
    if height < 0.0:  # in a trough: mean water stands above
        height, lower, upper = -height, -upper, -lower
    if lower <= 0.0:
        return 0.5 * crest, crest
    nearest = max(height / math.tan(lower), 1e-3)
    farthest = height / math.tan(upper) if upper > 0.0 else math.inf
    return nearest, max(min(farthest, 3.0 * max(crest, nearest)), 1.01 * nearest)
