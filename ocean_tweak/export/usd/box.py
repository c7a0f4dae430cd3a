# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes around points, in a layer's own units and axes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .package import Package

Corner = NDArray[np.float64]


class Box(NamedTuple):
    """The least and the greatest of each coordinate, (3,) each."""

    least: Corner
    greatest: Corner

    def __or__(self, other: Box) -> Box:
        return Box(np.minimum(self.least, other.least), np.maximum(self.greatest, other.greatest))

    def moved(self, by: Corner) -> Box:
        """The box elsewhere."""
        return Box(self.least + by, self.greatest + by)


def union(boxes: Iterable[Box]) -> Box:
    """Around all of them, of which there must be one."""
    first, *others = boxes
    for other in others:
        first = first | other
    return first


def tile_offsets(package: Package) -> dict[str, Corner]:
    """Where each tile stands, by its prim's name; the first one is the sea's own place."""
    size = package.shot.parameters.domain_size * package.scale
    north = np.array([0.0, 0.0, -size] if package.up_axis == "Y" else [0.0, size, 0.0])
    east = np.array([size, 0.0, 0.0])
    across, along = package.tiles
    return {
        f"tile_{column}_{row}": column * east + row * north
        for row in range(along)
        for column in range(across)
    }


def of_tiles(package: Package, box: Box) -> Box:
    """Around all tiles of a patch with this box."""
    return union(box.moved(offset) for offset in tile_offsets(package).values())
