# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface of few samples on a mesh of many."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

RealArray = NDArray[np.float32]


def resampled(closed: RealArray, samples: int) -> RealArray:
    """Bilinear values of an (n+1, n+1, c) field, its far edges included, as (samples+1, samples+1, c)."""
    rows = _along_first_axis(closed, samples)
    return np.ascontiguousarray(_along_first_axis(rows.swapaxes(0, 1), samples).swapaxes(0, 1))


def _along_first_axis(field: RealArray, samples: int) -> RealArray:
    place = np.arange(samples + 1) * ((len(field) - 1) / samples)
    before = np.minimum(place.astype(np.intp), len(field) - 2)
    share = (place - before).astype(np.float32)[:, np.newaxis, np.newaxis]
    return field[before] * (1.0 - share) + field[before + 1] * share
