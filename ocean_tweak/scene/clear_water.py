# SPDX-License-Identifier: GPL-3.0-or-later
"""Which point of a ready scene's sea is put under the 3D cursor, where Blender adds objects: a clear one."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ..core import Ocean, OceanParameters
from .moods import VIEW, Mood

#: sensor of a new camera, mm, and height by width of the lowest pictures that are usual
_SENSOR, _LOWEST = 36.0, 27.0 / 64.0
#: of the picture's half width and height: how far from its middle and from its edges
_ASIDE, _INSIDE = 0.3, 0.9
_DISTANCES, _BEARINGS, _STEPS = 96, 5, 32
#: wave heights of a better water level that a place as far as the crest is worth, against one at the camera
_FARTHER = 0.2


def clear_place(
    mood: Mood, place: NDArray[np.float64], parameters: OceanParameters, view: float = VIEW
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
    # the slopes at which each piece of the way is seen, and at last the water's mean level there
    share = np.linspace(0.02, 1.0, _STEPS)[:, np.newaxis]
    x, y = (place[axis] + share * away[:, axis] for axis in (0, 1))
    water = sea.height_at(x, y, time)
    way = np.hypot(*away.T)
    hidden = ((water - place[2]) / (share * way))[:-1].max(axis=0) * way + place[2]
    # in wave heights: how far the water is from its mean level, and how much of it stands before that place
    badness = np.abs(water[-1]) + 10.0 * np.maximum(hidden - np.maximum(water[-1], 0.0), 0.0)
    badness = badness / wave_height + _FARTHER * way / crest
    best = int(badness.argmin())
    return float(x[-1, best]), float(y[-1, best])


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
