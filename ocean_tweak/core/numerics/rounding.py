# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers with fewer digits, which take less room once they are compressed."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray


def rounded(values: NDArray[np.floating], share: float) -> NDArray[np.floating]:
    """The nearest multiples of a power of two that is at most this share of their root mean square.

    All multiples are whole in binary digits, so that the last bytes of a float32 are zeros. What is off is at
    most half of the share.
    """
    size = math.sqrt(float(np.mean(np.square(values, dtype=np.float64)))) if values.size else 0.0
    if size == 0.0 or not math.isfinite(size):
        return values
    step = 2.0 ** math.floor(math.log2(share * size))
    return (np.round(values / step) * step).astype(values.dtype)
