# SPDX-License-Identifier: GPL-3.0-or-later
"""The effect of the sea on a hull: the least-squares plane through the surface over its waterline.

The waterline is approximated by a disc or an ellipse, sampled evenly. Waves much shorter than the hull
average out, and much longer ones act in full.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: rings around the middle point; ring m has 6m points
RINGS = 5
#: points of the stencil
POINTS = 1 + 3 * RINGS * (RINGS + 1)


class Plane(NamedTuple):
    """z = height + slope_x·x + slope_y·y around the centre of the disc; height in m, slopes dimensionless."""

    height: Array
    slope_x: Array
    slope_y: Array


def stencil() -> Array:
    """(POINTS, 2) points evenly spread over a disc of radius 1, symmetric about its centre.

    Ring m lies at the root mean square radius of the area that its 6m points represent.
    """
    rings = [np.zeros((1, 2))]
    for ring in range(1, RINGS + 1):
        angle = 2.0 * np.pi * np.arange(6 * ring) / (6 * ring)
        radius = np.sqrt((1.0 + 3.0 * ring**2) / POINTS)
        rings.append(radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1))
    return np.concatenate(rings)


def fitted_plane(heights: Array, radius: float | tuple[float, float]) -> Plane:
    """The least-squares plane through heights (…, POINTS) in m over `stencil()` times a radius in m.

    radius : of a disc, or the two semi-axes of an ellipse along x and y

    Raises ValueError for a radius of 0 or less.
    """
    if not np.all(np.greater(radius, 0.0)):
        raise ValueError(f"radius = {radius!r}: must be above 0; a single point has no plane")
    offsets = np.multiply(radius, stencil())
    # the stencil is symmetric, so the normal equations are diagonal
    slopes = heights @ offsets / np.sum(offsets**2, axis=0)
    return Plane(heights.mean(axis=-1), slopes[..., 0], slopes[..., 1])
