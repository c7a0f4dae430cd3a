# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights by the brightness of an image."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..numerics.interpolation import spline_slopes, spline_weights
from .parameters import Mask

Array = NDArray[np.float64]


def by_image(mask: Mask, domain_size: float, x: Array, y: Array) -> tuple[Array, Array, Array]:
    """A quadratic B-spline through the texels, whose centres are half a texel in; it stays in 0…1."""
    assert mask.image is not None
    texels = np.clip(mask.image.values[..., 0].astype(np.float64), 0.0, 1.0)
    rows, columns = texels.shape
    column, row = x / domain_size * columns - 0.5, y / domain_size * rows - 0.5
    (j, along_x), (i, along_y) = spline_weights(column), spline_weights(row)
    slope_x, slope_y = spline_slopes(column), spline_slopes(row)
    shape = np.broadcast_shapes(x.shape, y.shape)
    value, by_x, by_y = (np.zeros(shape) for _ in range(3))
    for b in range(3):
        for a in range(3):
            texel = texels[i[b] % rows, j[a] % columns]
            value += texel * along_y[b] * along_x[a]
            by_x += texel * along_y[b] * slope_x[a]
            by_y += texel * slope_y[b] * along_x[a]
    return value, by_x * (columns / domain_size), by_y * (rows / domain_size)
