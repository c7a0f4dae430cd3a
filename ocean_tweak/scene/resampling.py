# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface of few samples on a mesh of many, and on a mesh of several patches."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

RealArray = NDArray[np.float32]


def resampled(closed: RealArray, samples: int) -> RealArray:
    """Bilinear values of an (n+1, n+1, …) field, its far edges included, as (samples+1, samples+1, …)."""
    channels = closed.reshape(*closed.shape[:2], -1)
    # columns while there are few rows: what is left are whole rows, added in place
    result = _along(0, _along(1, channels, samples), samples)
    return result.reshape(samples + 1, samples + 1, *closed.shape[2:])


def tiled(closed: RealArray, repeats: tuple[int, int]) -> RealArray:
    """An (n+1, n+1, …) field side by side along x and y, neighbours sharing their edge."""
    for axis, count in ((1, repeats[0]), (0, repeats[1])):
        if count > 1:
            whole, edge = np.split(closed, [closed.shape[axis] - 1], axis)
            closed = np.concatenate([whole] * count + [edge], axis)
    return closed


def _along(axis: int, field: RealArray, samples: int) -> RealArray:
    last = field.shape[axis] - 1
    place = np.arange(samples + 1) * (last / samples)
    before = np.minimum(place.astype(np.intp), last - 1)
    share = (place - before).astype(np.float32)
    result, step = np.take(field, before, axis), np.take(field, before + 1, axis)
    step -= result
    step *= share.reshape((-1, 1) if axis else (-1, 1, 1))
    result += step
    return result
