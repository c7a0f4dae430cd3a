# SPDX-License-Identifier: GPL-3.0-or-later
"""The quadratic B-spline over samples at whole numbers: smooth, and never beyond the samples' own range."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def spline_weights(position: Array) -> tuple[NDArray[np.intp], Array]:
    """The three samples around each place, (3, …), and how much each counts there; they add up to 1."""
    nearest, off = _nearest(position)
    samples = nearest.astype(np.intp) + np.arange(-1, 2).reshape(3, *(1,) * position.ndim)
    return samples, np.stack((0.5 * (0.5 - off) ** 2, 0.75 - off * off, 0.5 * (0.5 + off) ** 2))


def spline_slopes(position: Array) -> Array:
    """(3, …) derivatives of those weights by the position."""
    _, off = _nearest(position)
    return np.stack((off - 0.5, -2.0 * off, off + 0.5))


def _nearest(position: Array) -> tuple[Array, Array]:
    nearest = np.rint(position)
    return nearest, position - nearest
