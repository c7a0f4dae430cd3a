# SPDX-License-Identifier: GPL-3.0-or-later
"""Which waves break for lack of depth."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .march import BREAKER_INDEX

Array = NDArray[np.float64]


def broken_share(rms_height: Array, depth: Array) -> Array:
    """Q_b, the share of waves that are broken, min(1, (H_rms/γh)⁴): Thornton and Guza (1983).

    rms_height, depth : m, of one shape; where depth is 0 or less, there are none
    """
    wet = depth > 0.0
    ratio = np.divide(rms_height, BREAKER_INDEX * depth, out=np.zeros(depth.shape), where=wet)
    result: Array = np.minimum(ratio**4, 1.0)
    return result
