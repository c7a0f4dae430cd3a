# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounding boxes in a layer's units and axes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .package import Package

Corner = NDArray[np.float64]


class Box(NamedTuple):
    """Minimum and maximum of each coordinate, (3,) each."""

    least: Corner
    greatest: Corner

    def __or__(self, other: Box) -> Box:
        return Box(np.minimum(self.least, other.least), np.maximum(self.greatest, other.greatest))


def union(boxes: Iterable[Box]) -> Box:
    """The box around all of them; there must be at least one."""
    first, *others = boxes
    for other in others:
        first = first | other
    return first


def tile_offsets(package: Package) -> Corner:
    """(tiles, 3): offset of each tile, in rows from south to north; the first is the sea itself."""
    size = package.size * package.scale
    across, along = package.tiles
    column, row = (part.reshape(-1) * size for part in np.meshgrid(np.arange(across), np.arange(along)))
    nothing = np.zeros(len(column))
    return np.stack([column, nothing, -row] if package.up_axis == "Y" else [column, row, nothing], axis=-1)


def of_tiles(package: Package, box: Box) -> Box:
    """The box around all tiles of a sea with this box."""
    offsets = tile_offsets(package)
    return Box(box.least + offsets.min(axis=0), box.greatest + offsets.max(axis=0))
