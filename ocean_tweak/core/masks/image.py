# SPDX-License-Identifier: GPL-3.0-or-later
"""Mask weights by the brightness of an image."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..numerics.interpolation import spline_read
from .parameters import Mask

Array = NDArray[np.float64]


def by_image(mask: Mask, domain_size: float, x: Array, y: Array) -> tuple[Array, Array, Array]:
    """A quadratic B-spline over the texels, whose centres are half a texel in; its values stay in 0…1."""
    assert mask.image is not None
    texels = np.clip(mask.image.values[..., 0].astype(np.float64), 0.0, 1.0)
    rows, columns = texels.shape
    column, row = x / domain_size * columns - 0.5, y / domain_size * rows - 0.5
    value, by_y, by_x = spline_read(texels, row, column)
    return value, by_x * (columns / domain_size), by_y * (rows / domain_size)
