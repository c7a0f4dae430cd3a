# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray of a bow, which is thrown up where it meets the water: the more, the faster they meet.

The amount is proportional to the square of the speed of the hull relative to the water (Zakrzewski 1987), so
there is more where a crest's water comes towards the bow or rises at it, and to how high the water stands at
the hull. What the bow parts flies forwards, aside and up.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..contribution import OwnSpray
from .foam import HullFoam

Array = NDArray[np.float64]

#: relative speed in m/s at which a bow throws up as much as a wind of 17 m/s tears off a crest that breaks
_AS_A_CREST = 2.5
#: velocity at which water is thrown, forwards, aside and up, in relative speeds
_AHEAD, _ASIDE, _UP = 0.35, 0.45, 1.0


def bow_spray(
    hull: HullFoam, draught: float, x: Array, y: Array, time: float, height: Array, velocity: Array
) -> OwnSpray | None:
    """What a hull of some m of draught throws up at rest positions (places,) in m and a time in s.

    height : of the water there above calm water, (places,) m: none is thrown from below the keel, twice as
        much from as high above calm water as the keel is below
    velocity : of the water there, (places, 3) m/s

    None where there is no bow, or the hull stands still.
    """
    breaking, side = hull.bow(x, y, time)
    _, course = hull.track.place(time)
    speed = float(np.hypot(*course))
    if not (speed > 0.0 and np.any(breaking > 0.0)):
        return None
    ahead = np.array((*course, 0.0)) / speed
    to_port = np.array((-ahead[1], ahead[0], 0.0))
    meeting = np.hypot(np.maximum(speed - velocity @ ahead, 0.0), np.maximum(velocity[:, 2], 0.0))
    wet = np.clip(1.0 + height / draught, 0.0, 2.0)
    way = _AHEAD * ahead + _ASIDE * side[:, np.newaxis] * to_port + (0.0, 0.0, _UP)
    strength = breaking * wet * (meeting / _AS_A_CREST) ** 2
    return OwnSpray(strength, velocity + meeting[:, np.newaxis] * way)
