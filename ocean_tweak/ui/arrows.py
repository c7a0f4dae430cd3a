# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines of flat arrows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: of an arrow: its head
_HEAD = 0.3


def arrow_lines(tail: Array, along: Array) -> Array:
    """(3n, 2, 3) lines: a shaft and two strokes of a head for each arrow.

    tail, along : (n, 2) where they begin, and from there to their tips
    """
    tip, across = tail + along, np.stack((-along[:, 1], along[:, 0]), axis=-1)
    strokes = [np.stack((tail, tip), axis=1)]
    for side in (-0.5, 0.5):
        strokes.append(np.stack((tip, tip - _HEAD * (along + side * across)), axis=1))
    flat = np.concatenate(strokes)
    return np.concatenate((flat, np.zeros((*flat.shape[:2], 1))), axis=-1)
