# SPDX-License-Identifier: GPL-3.0-or-later
"""Rounding to fewer binary digits, for better compression."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray


def rounded(values: NDArray[np.floating], share: float) -> NDArray[np.floating]:
    """Round values to multiples of a power of two that is at most this fraction of their root mean square.

    The trailing bits of each float32 become zeros. The error is at most half of the fraction.
    """
    size = math.sqrt(float(np.mean(np.square(values, dtype=np.float64)))) if values.size else 0.0
    if size == 0.0 or not math.isfinite(size):
        return values
    step = 2.0 ** math.floor(math.log2(share * size))
    return (np.round(values / step) * step).astype(values.dtype)
