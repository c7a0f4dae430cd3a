# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh that shows a sea over its bed."""

from __future__ import annotations

import math
import zlib

import numpy as np
from numpy.typing import NDArray

from ...numerics.memo import MEMO, total_bytes
from .ground import Ground

Array = NDArray[np.float64]

#: m offshore that the mesh goes on, and how much longer each step is there than the one before
_OFFSHORE, _GROWS = 2500.0, 1.06
#: m of land behind the farthest waterline that it covers
_BEHIND = 10.0
#: m of water that is drawn where there is none
FILM = 0.02

_MESHES = "meshes of coasts"


class CoastMesh:
    """Places over a bed and before it, in lines across the march: fine near the shore.

    rows, columns : lines of the mesh, which ends behind the farthest waterline, and places in each
    before : lines before the first one of the bed's samples
    x, y : (places,) m: those of the mesh, and behind them further lines on land to the bed's end, where waves
        wet the sand
    depth : (rows · columns,) m, of still water, at least FILM
    texture_coordinates : (rows · columns, 2) as on the tile's mesh
    """

    def __init__(self, ground: Ground, domain_size: float, resolution: int) -> None:
        wet = np.flatnonzero((ground.depth > 0.0).any(axis=1))
        last = min(wet[-1] + 1 + math.ceil(_BEHIND / ground.step), ground.rows - 1)
        before = -np.cumsum(ground.step * _GROWS ** np.arange(1, 400))
        before = before[before > -_OFFSHORE][::-1]
        along = np.concatenate((before, ground.step * np.arange(ground.rows, dtype=np.float64)))
        across = ground.step * np.arange(ground.columns + 1, dtype=np.float64)
        self.before, self.rows, self.columns = len(before), len(before) + int(last) + 1, len(across)
        along, across = np.meshgrid(along + ground.first[0], across + ground.first[1], indexing="ij")
        c, s = math.cos(ground.turn), math.sin(ground.turn)
        self.x, self.y = (c * along - s * across).ravel(), (s * along + c * across).ravel()
        drawn = slice(self.vertices)
        depth = ground.between(self.x[drawn], self.y[drawn]).read(ground.depth)
        self.depth = np.maximum(depth, FILM).astype(np.float32)
        places = np.stack((self.x[drawn], self.y[drawn]), axis=-1) / domain_size
        self.texture_coordinates = (places + 0.5 / resolution).astype(np.float32)
        self.tag = (
            f"{self.rows} {self.columns} {ground.step!r} {ground.first!r} {ground.turn!r} "
            f"{zlib.crc32(self.depth)}"
        )

    @property
    def vertices(self) -> int:
        """Of the mesh."""
        return self.rows * self.columns

    @property
    def nbytes(self) -> int:
        """Bytes of the places."""
        return total_bytes((self.x, self.y, self.depth, self.texture_coordinates))

    def corners(self) -> NDArray[np.int32]:
        """(quads, 4) vertices of each quad, counter-clockwise from above."""
        number = np.arange(self.vertices, dtype=np.int32).reshape(self.rows, self.columns)
        quads = (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:])
        return np.stack(quads, axis=-1).reshape(-1, 4)


def coast_mesh(ground: Ground, domain_size: float, resolution: int) -> CoastMesh:
    """The mesh over a bed; made once.

    domain_size, resolution : m, and samples along each side, of the sea's tile
    """
    key = (ground, domain_size, resolution)
    return MEMO.get(_MESHES, key, lambda: CoastMesh(*key))


def places_over(ground: Ground) -> int:
    """How many places the mesh over a bed has at the most."""
    before = math.log1p(_OFFSHORE * (_GROWS - 1.0) / (_GROWS * ground.step)) / math.log(_GROWS)
    return (math.ceil(before) + ground.rows) * (ground.columns + 1)
