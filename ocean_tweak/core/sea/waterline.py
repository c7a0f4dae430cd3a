# SPDX-License-Identifier: GPL-3.0-or-later
"""What a hull feels of the sea: the plane of least squares through the surface over its waterline.

The waterline is a disc. Points spread evenly over it stand for its area, so waves much shorter than the hull
cancel out and those much longer pass in full.
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
    """z = height + slope_x·x + slope_y·y around the middle of the disc; m, and slopes without a unit."""

    height: Array
    slope_x: Array
    slope_y: Array


def stencil() -> Array:
    """(POINTS, 2) points that share a disc of radius 1 evenly, symmetric about its middle.

    Ring m lies at the root of the mean square radius of the part of the area that its 6m points stand for.
    """
    rings = [np.zeros((1, 2))]
    for ring in range(1, RINGS + 1):
        angle = 2.0 * np.pi * np.arange(6 * ring) / (6 * ring)
        radius = np.sqrt((1.0 + 3.0 * ring**2) / POINTS)
        rings.append(radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1))
    return np.concatenate(rings)


def fitted_plane(heights: Array, radius: float) -> Plane:
    """The plane of least squares through heights (…, POINTS) in m over `stencil()` times a radius in m.

    Raises ValueError for a radius that is not above 0.
    """
    if not radius > 0.0:
        raise ValueError(f"radius = {radius!r}: must be above 0; a single point has no plane")
    offsets = radius * stencil()
    # the stencil is symmetric: the three unknowns do not mix
    slopes = heights @ offsets / np.sum(offsets**2, axis=0)
    return Plane(heights.mean(axis=-1), slopes[..., 0], slopes[..., 1])
