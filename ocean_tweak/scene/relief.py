# SPDX-License-Identifier: GPL-3.0-or-later
"""Relief of land: rock in jointed blocks, ledges and gullies."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.numerics.interpolation import smoothstep
from ..core.numerics.random import hash_cells, uniform

Array = NDArray[np.float64]

#: of blocks between joints: breadth, height by which one stands above the next, m, and slope of their tops
_BLOCKS = ((13.0, 2.6, 0.35), (5.5, 1.3, 0.4), (2.1, 0.5, 0.45))
#: rad from +x to the joints along which blocks are long, and how many times longer they are
_STRIKE, _LONG = 0.6, 1.9
#: width of the joints over that of the blocks, and how deep they are over how high blocks stand
_JOINT, _JOINT_DEPTH = 0.12, 0.6
#: breadth and depth in m of gullies
_GULLY, _GULLY_DEPTH = 24.0, 4.5
#: thickness of beds in m, how much of it stands as a ledge, and how much they rise in a metre of x and y
_BED, _LEDGE, _DIP = 2.4, 0.75, (0.16, 0.1)
#: how far in m joints and beds wander, over what length
_WANDERS, _WANDERING = 1.6, 11.0


def rock(x: Array, y: Array, height: Array) -> Array:
    """m that jointed rock stands above a smooth height, or falls short of it.

    x, y : m
    height : that of the smooth ground, m, to which beds are parallel where they do not dip
    """
    aside = [_WANDERS * (2.0 * noise(x / _WANDERING, y / _WANDERING, seed) - 1.0) for seed in (11, 12)]
    x, y = x + aside[0], y + aside[1]
    c, s = np.cos(_STRIKE), np.sin(_STRIKE)
    along, across = (c * x + s * y) / _LONG, c * y - s * x
    total = np.zeros_like(height)
    for seed, (breadth, step, slope) in enumerate(_BLOCKS):
        block = _cell(along / breadth, across / breadth, seed)
        tilted = slope * breadth * ((block.one - 0.5) * block.x + (block.other - 0.5) * block.y)
        joint = 1.0 - smoothstep(block.to_edge / _JOINT)
        total += step * (block.height - 0.5 - _JOINT_DEPTH * joint) + tilted
    gully = np.abs(2.0 * noise(x / _GULLY, y / _GULLY, 21) - 1.0)
    total -= _GULLY_DEPTH * (1.0 - smoothstep(gully / 0.45))
    bed = (height + total + _DIP[0] * x + _DIP[1] * y) / _BED
    within = bed - np.floor(bed)
    result: Array = total + _BED * _LEDGE * (smoothstep((within - 0.6) / 0.35) - within)
    return result


def noise(x: Array, y: Array, seed: int) -> Array:
    """0…1, random at integers and smooth in between."""
    column, row = np.floor(x), np.floor(y)
    u, v = smoothstep(x - column), smoothstep(y - row)
    i, j = column.astype(np.int64), row.astype(np.int64)
    low, high = (
        (1.0 - u) * uniform(hash_cells(i, j + up, seed), 0) + u * uniform(hash_cells(i + 1, j + up, seed), 0)
        for up in (0, 1)
    )
    result: Array = (1.0 - v) * low + v * high
    return result


class _Cell(NamedTuple):
    """Of the cell of random points in which places are.

    height, one, other : 0…1, random, the same all over a cell
    x, y : from its point
    to_edge : from the next cell
    """

    height: Array
    one: Array
    other: Array
    x: Array
    y: Array
    to_edge: Array


def _cell(x: Array, y: Array, seed: int) -> _Cell:
    """Cells around random points, one in each unit square (Worley 1996)."""
    column, row = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    first, second = np.full(x.shape, np.inf), np.full(x.shape, np.inf)
    own, from_x, from_y = np.zeros(x.shape, np.uint64), np.zeros(x.shape), np.zeros(x.shape)
    for right in (-1, 0, 1):
        for up in (-1, 0, 1):
            i, j = column + right, row + up
            key = hash_cells(i, j, seed)
            dx, dy = x - i - uniform(key, 0), y - j - uniform(key, 1)
            far = np.hypot(dx, dy)
            nearest = far < first
            second = np.minimum(np.maximum(far, first), second)
            first = np.where(nearest, far, first)
            own = np.where(nearest, key, own)
            from_x, from_y = np.where(nearest, dx, from_x), np.where(nearest, dy, from_y)
    return _Cell(uniform(own, 2), uniform(own, 3), uniform(own, 4), from_x, from_y, second - first)
