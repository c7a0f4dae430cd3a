# SPDX-License-Identifier: GPL-3.0-or-later
"""Nested squares of cells around a place, fine near it and coarse far away, in which spray is born."""

from __future__ import annotations

from collections.abc import Hashable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .foam_levels import FINEST, FoamLevels

#: squares, at most, by how many drops one stands for there: beyond a few hundred metres nobody sees them
STANDS_FOR = (1, 1, 2, 8, 16, 128, 1024)
#: cells along each side of a square, of which the middle ones belong to the next finer one, and step in cells
# in which squares follow the place
_CELLS, _STEP = 176, 16

Numbers = NDArray[np.int64]


class Square(NamedTuple):
    """A square of cells around a place, without those of the next finer one.

    level : of the foam; its cells have a size of FINEST·2ⁿ m
    first : column and row of its first cell
    inner : first cell of the finer square, in this one's cells; None for the finest
    """

    level: int
    first: tuple[int, int]
    inner: tuple[int, int] | None

    @property
    def where(self) -> Hashable:
        """What is remembered of it by, wherever the finer one is: that one moves more often."""
        return self.level, self.first

    @property
    def size(self) -> float:
        """Size of its cells, m."""
        return FINEST * 2.0**self.level

    def cells(self) -> tuple[Numbers, Numbers]:
        """Columns and rows, row by row, of the cells that belong to it for any position of the finer one."""
        column, row = np.meshgrid(*(each + np.arange(_CELLS) for each in self.first))
        if self.inner is None:
            return column.ravel(), row.ravel()
        # the finer one follows the place in steps half as large, so it is at most one cell off centre
        x, y = (each + (_CELLS // 2 + _STEP) // 2 for each in self.first)
        own = outside(column, row, (x, y), _CELLS // 2 - _STEP)
        return column[own], row[own]


def squares(levels: FoamLevels, place: tuple[float, float]) -> tuple[Square, ...]:
    """The squares around a place, in m."""
    first = [_first(place, FINEST * 2.0**level) for level in range(_count(levels))]
    inner = [None, *((x // 2, y // 2) for x, y in first)]
    return tuple(Square(level, at, inner[level]) for level, at in enumerate(first))


def area_of_squares(levels: FoamLevels) -> float:
    """Area in m², divided by the number of particles that one represents there."""
    sides = [_CELLS * FINEST * 2.0**level for level in range(_count(levels))]
    rings = zip(sides, [0.0, *sides[:-1]], STANDS_FOR[: len(sides)], strict=True)
    return sum((side**2 - less**2) / stands for side, less, stands in rings)


def _count(levels: FoamLevels) -> int:
    return min(len(STANDS_FOR), len(levels.seas))


def _first(place: tuple[float, float], size: float) -> tuple[int, int]:
    """Indices of the first cell of a square around a place."""
    x, y = (_STEP * round(along / size / _STEP) - _CELLS // 2 for along in place)
    return x, y


def outside(
    column: Numbers, row: Numbers, first: tuple[int, int], count: int = _CELLS // 2
) -> NDArray[np.bool_]:
    """Which cells are outside a square with this many cells along each side, usually the next finer one."""
    x, y = first
    inside = (column >= x) & (column < x + count) & (row >= y) & (row < y + count)
    return np.asarray(~inside)
