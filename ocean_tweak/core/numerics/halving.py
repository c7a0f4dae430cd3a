# SPDX-License-Identifier: GPL-3.0-or-later
"""Averages of a periodic field over larger and larger cells: a mip map (Williams 1983).

Each level averages 2 × 2 samples of the level before: sample j of n lies at (j + ½)/n of the period, between
two samples of that level. Odd counts are halved and rounded up, with interpolation between samples.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

RealArray = NDArray[np.float32]


def averages(field: RealArray) -> Iterator[RealArray]:
    """Averages of a periodic (rows, columns, …) field, from those over four samples to the mean of all.

    Yields (⌈rows/2⌉, ⌈columns/2⌉, …), and so on, to (1, 1, …).
    """
    while max(field.shape[:2]) > 1:
        field = _halved(_halved(field, 0), 1)
        yield field


def _halved(field: RealArray, axis: int) -> RealArray:
    """Half as many samples along an axis, midway between the present ones."""
    count = field.shape[axis]
    if count % 2 == 0:
        before = field.reshape(*field.shape[:axis], count // 2, 2, *field.shape[axis + 1 :])
        first, second = (before[(slice(None),) * (axis + 1) + (number,)] for number in (0, 1))
        mean = np.add(first, second, dtype=np.float32)
        mean *= np.float32(0.5)
        return mean
    wanted = (count + 1) // 2
    place = (np.arange(wanted) + 0.5) * (count / wanted) - 0.5
    low = np.floor(place).astype(np.intp)
    share = (place - low).astype(np.float32).reshape(-1, *(1,) * (field.ndim - 1 - axis))
    here, there = (field.take(number % count, axis) for number in (low, low + 1))
    return np.asarray(here + share * (there - here))
