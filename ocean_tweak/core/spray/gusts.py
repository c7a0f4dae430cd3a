# SPDX-License-Identifier: GPL-3.0-or-later
"""Gusts: where and when the wind tears more off crests than on average, or less.

They are as long as a wave and narrow, so mist hangs over a line of crests in strands along the wind.
"""

from __future__ import annotations

import math
from itertools import product

import numpy as np
from numpy.typing import NDArray

from ..numerics import random
from ..numerics.interpolation import smoothstep

Array = NDArray[np.float64]

#: extent of a gust along the wind and across it, m, and its duration, s; chosen by eye
_ALONG, _ACROSS, _DURATION = 120.0, 18.0, 6.0


def gusts(
    x: Array, y: Array, time: float, direction: float, seed: int, loop_duration: float | None = None
) -> Array:
    """What is torn off at places, relative to the mean over all places and times; float64, of the shape of x.

    Between the points of a lattice, each of which has an exponentially distributed number of mean 1, numbers
    pass smoothly from one to the next: so their mean is 1, too.

    x, y : m
    time, loop_duration : s; after a loop's duration gusts repeat
    direction : of the wind, radians from +x
    """
    cosine, sine = math.cos(direction), math.sin(direction)
    period = None if loop_duration is None else max(1, round(loop_duration / _DURATION))
    duration = _DURATION if loop_duration is None or period is None else loop_duration / period
    column, part_x = _parted((cosine * x + sine * y) / _ALONG)
    row, part_y = _parted((cosine * y - sine * x) / _ACROSS)
    moment, part_t = _parted(np.array(time / duration))
    result = np.zeros(np.shape(x))
    for right, up, later in product((0, 1), repeat=3):
        at = int(moment) + later
        key = random.hash_cells(column + right, row + up, seed, at if period is None else at % period)
        weight = abs(1 - right - part_x) * abs(1 - up - part_y) * abs(1 - later - part_t)
        result += weight * -np.log(random.uniform(key, 0))
    return result


def _parted(place: Array) -> tuple[NDArray[np.int64], Array]:
    """The points of a lattice before places, and how much the next ones count there."""
    before = np.floor(place)
    return before.astype(np.int64), smoothstep(place - before)
