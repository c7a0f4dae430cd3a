# SPDX-License-Identifier: GPL-3.0-or-later
"""The inside of a hull as a lines plan: its waterlines at several levels, each a signed distance field.

A hull is rigid, so whether a point lies inside depends only on its position in the hull's own axes. The plan
is computed once and looked up, linearly interpolated along all three axes, wherever water is shaded.

At each level, a point is inside if water at that level could not flow to it from around the hull, and if some
part of the hull is below it. Open boats therefore have an inside; plates, capsized hulls and the middle of a
ring have none. The direction of face normals does not matter. Above the rim of an open hull the inside
continues upwards, so that it stays dry however high a wave is; above a deck there is no inside.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.integer]
Mask = NDArray[np.bool_]

#: number of waterlines
LEVELS = 24
#: upper bounds: texels along a hull, and texels of all levels together
_LONG, _MOST_TEXELS = 256, 400_000
#: texels around a hull; texels on either side of its outline beyond which distances are clipped
_MARGIN, BAND = 3, 6
#: coarse search for the rim: levels, texels, and the least area there relative to the largest waterline
_ROUGH_LEVELS, _ROUGH_LONG, _RIM = 48, 96, 0.1
#: distance in texels from an outline at which it is tested for water on either side
_PROBE = 1.5
_STEPS = range(-BAND, BAND + 1)


@dataclass(frozen=True)
class HullPlan:
    """Waterlines of a hull, in the unit of its vertices.

    distance : (LEVELS, ny, nx) from the outline in texels, clipped to ±BAND, negative inside. Below the first
        level everything is outside; above the last one, values are those of the last one
    low : x and y of the outer corner of the first texel, z of the first level
    texel : size of a texel
    spacing : height between levels
    """

    distance: NDArray[np.float32]
    low: tuple[float, float, float]
    texel: float
    spacing: float


class _Grid(NamedTuple):
    """Texels (levels, ny, nx), the corner of the first, their size, and the heights of the levels."""

    shape: tuple[int, int, int]
    low: Array
    texel: float
    levels: Array

    def texel_of(self, places: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Row and column of places (…, 2)."""
        column, row = np.moveaxis(np.floor((places - self.low) / self.texel).astype(np.intp), -1, 0)
        return np.clip(row, 0, self.shape[1] - 1), np.clip(column, 0, self.shape[2] - 1)


class _Pieces(NamedTuple):
    """Short pieces of outlines: the level of each, and its ends (…, 2)."""

    level: NDArray[np.intp]
    first: Array
    last: Array


def hull_plan(vertices: Array, triangles: Integers) -> HullPlan:
    """The plan of a hull with vertices (N, 3), z up, and triangles (M, 3) of vertex indices.

    Raises ValueError for a mesh that encloses nothing.
    """
    corners = vertices[triangles]
    keel, top = float(np.min(vertices[:, 2])), _rim(vertices, corners)
    spacing = (top - keel) / (LEVELS - 1.5)
    # slightly off heights that many vertices may share; the last level is above the rim
    levels: Array = keel + spacing * (np.arange(LEVELS, dtype=np.float64) + 0.013)
    grid = _grid(vertices, levels, _LONG)
    pieces = _pieces(corners, grid)
    wall = _walls(pieces, grid)
    lowest, highest = _heights(corners, grid)
    inside = ~_outside(wall) & (lowest <= levels[:, np.newaxis, np.newaxis])
    distance = _distances(pieces, inside, wall, grid)
    above = levels[:, np.newaxis, np.newaxis] > highest
    is_open = np.logical_or.accumulate(inside & ~wall & above, axis=0)
    for level in range(1, LEVELS):
        before = np.minimum(distance[level], distance[level - 1])
        distance[level] = np.where(is_open[level - 1], before, distance[level])
    low = (float(grid.low[0]), float(grid.low[1]), float(levels[0]))
    return HullPlan(distance.astype(np.float32), low, grid.texel, spacing)


def _rim(vertices: Array, corners: Array) -> float:
    """The height of the top of the hull, without masts and railings. Raises ValueError for none."""
    low, high = float(np.min(vertices[:, 2])), float(np.max(vertices[:, 2]))
    step = (high - low) / _ROUGH_LEVELS
    levels: Array = low + step * (np.arange(_ROUGH_LEVELS, dtype=np.float64) + 0.513)
    if high > low and np.all(np.ptp(vertices[:, :2], axis=0) > 0.0):
        grid = _grid(vertices, levels, _ROUGH_LONG)
        wall = _walls(_pieces(corners, grid), grid)
        lowest, _ = _heights(corners, grid)
        inside = ~_outside(wall) & ~wall & (lowest <= levels[:, np.newaxis, np.newaxis])
        areas = np.sum(inside, axis=(1, 2))
        if np.any(areas > 0):
            return float(levels[np.nonzero(areas >= _RIM * np.max(areas))[0][-1]]) + 0.5 * step
    raise ValueError("the hull encloses nothing: it needs a bottom and sides without gaps")


def _grid(vertices: Array, levels: Array, long: int) -> _Grid:
    low, high = np.min(vertices[:, :2], axis=0), np.max(vertices[:, :2], axis=0)
    size = high - low
    texel = max(float(np.max(size)) / long, float(np.sqrt(np.prod(size) * len(levels) / _MOST_TEXELS)))
    columns, rows = (np.ceil(size / texel).astype(int) + 2 * _MARGIN).tolist()
    middle = 0.5 * (low + high)
    return _Grid(
        (len(levels), rows, columns), middle - 0.5 * texel * np.array([columns, rows]), texel, levels
    )


def _pieces(corners: Array, grid: _Grid) -> _Pieces:
    """The outlines of triangles (M, 3, 3) at each level, in pieces of half a texel."""
    numbers, first, last = [], [], []
    for number, level in enumerate(grid.levels):
        above = corners[:, :, 2] > level
        cut = above.any(axis=1) & ~above.all(axis=1)
        some, is_above = corners[cut], above[cut]
        # the corner that is alone on its side, and the two others
        alone = np.argmax(is_above == (is_above.sum(axis=1) == 1)[:, np.newaxis], axis=1)
        row = np.arange(len(some))
        apex = some[row, alone]
        ends = []
        for step in (1, 2):
            other = some[row, (alone + step) % 3]
            share = ((level - apex[:, 2]) / (other[:, 2] - apex[:, 2]))[:, np.newaxis]
            ends.append(apex[:, :2] + share * (other[:, :2] - apex[:, :2]))
        numbers.append(np.full(len(some), number))
        first.append(ends[0])
        last.append(ends[1])
    level_of, start, end = np.concatenate(numbers), np.concatenate(first), np.concatenate(last)
    count = np.maximum(np.ceil(2.0 * np.hypot(*(end - start).T) / grid.texel), 1.0).astype(np.intp)
    which = np.repeat(np.arange(len(count)), count)
    place = (np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count))[:, np.newaxis]
    step = ((end - start) / count[:, np.newaxis])[which]
    begins = start[which] + place * step
    return _Pieces(level_of[which], begins, begins + step)


def _walls(pieces: _Pieces, grid: _Grid) -> Mask:
    """Texels that outlines pass through."""
    wall = np.zeros(grid.shape, bool)
    for places in (pieces.first, 0.5 * (pieces.first + pieces.last), pieces.last):
        wall[(pieces.level, *grid.texel_of(places))] = True
    return wall


def _outside(wall: Mask) -> Mask:
    """Texels connected to the border of the grid, along rows and columns (flood fill)."""
    free = np.ascontiguousarray(np.moveaxis(~wall, 0, -1))  # whole lines of texels at once
    reached = np.zeros_like(free)
    reached[[0, -1]] = True
    reached[:, [0, -1]] = True
    before = 0
    while (count := int(np.count_nonzero(reached))) != before:
        before = count
        for axis in (0, 1):
            for ahead in (slice(None), slice(None, None, -1)):
                way, open_way = (np.moveaxis(each, axis, 0)[ahead] for each in (reached, free))
                for line in range(1, len(way)):
                    way[line] |= way[line - 1] & open_way[line]
    return np.moveaxis(reached, -1, 0)


def _heights(corners: Array, grid: _Grid) -> tuple[Array, Array]:
    """(ny, nx) heights of the lowest and of the highest surface; ∞ and −∞ where there is none."""
    lowest, highest = np.full(grid.shape[1:], np.inf), np.full(grid.shape[1:], -np.inf)
    sides = corners - np.roll(corners, 1, axis=1)
    longest = np.hypot(sides[..., 0], sides[..., 1]).max(axis=1)
    parts = np.maximum(np.ceil(longest / (0.7 * grid.texel)), 1.0).astype(int)
    for count in np.unique(parts):
        some = corners[parts == count]
        first, second = np.meshgrid(np.arange(count + 1), np.arange(count + 1))
        within = first + second <= count
        u, v = first[within] / count, second[within] / count
        weights = np.stack([1.0 - u - v, u, v], axis=-1)
        places = (weights @ some).reshape(-1, 3)
        texel = grid.texel_of(places[:, :2])
        np.minimum.at(lowest, texel, places[:, 2])
        np.maximum.at(highest, texel, places[:, 2])
    return lowest, highest


def _distances(pieces: _Pieces, inside: Mask, wall: Mask, grid: _Grid) -> Array:
    """Signed distances in texels from the outlines that have water on exactly one side."""
    middle = 0.5 * (pieces.first + pieces.last)
    along = pieces.last - pieces.first
    length = np.hypot(*along.T)
    aside = np.stack([along[:, 1], -along[:, 0]], axis=-1) / np.maximum(length, 1e-12)[:, np.newaxis]
    wet = ~inside & ~wall
    sides = [
        wet[(pieces.level, *grid.texel_of(middle + sign * _PROBE * grid.texel * aside))]
        for sign in (1.0, -1.0)
    ]
    kept = (sides[0] ^ sides[1]) & (length > 0.0)
    outwards = (aside * np.where(sides[0], 1.0, -1.0)[:, np.newaxis])[kept]
    level, middle, half = pieces.level[kept], middle[kept], 0.5 * along[kept]
    row, column = grid.texel_of(middle)
    square = np.sum(half**2, axis=1)
    half_x, half_y = np.ascontiguousarray(half.T)
    out_x, out_y = np.ascontiguousarray(outwards.T)
    levels, rows, columns = grid.shape
    # within and out, with a border for texels beyond the grid
    fields = np.full((2, levels, rows + 2 * BAND, columns + 2 * BAND), float(BAND))
    flat, (a_side, a_level, a_row, _) = fields.reshape(-1), np.array(fields.strides) // fields.itemsize
    corner = level * a_level + row * a_row + column
    centre_x, centre_y = (
        [grid.low[axis] + grid.texel * (texel + step + 0.5) - middle[:, axis] for step in _STEPS]
        for axis, texel in ((0, column), (1, row))
    )
    for down, off_y in enumerate(centre_y):
        for right, off_x in enumerate(centre_x):
            share = np.clip((off_x * half_x + off_y * half_y) / square, -1.0, 1.0)
            distance = np.hypot(off_x - share * half_x, off_y - share * half_y) / grid.texel
            is_out = off_x * out_x + off_y * out_y > 0.0
            np.minimum.at(flat, corner + (down * a_row + right) + is_out * a_side, distance)
    within, out = fields[:, :, BAND:-BAND, BAND:-BAND]
    # beyond a sharp corner pieces disagree in sign: away from outlines the mask decides, on them the nearer
    # piece, and of two as near the one whose outside it is
    is_outside = np.where(wall, out < within + 1e-6, wet)
    signed: Array = np.where(is_outside, 1.0, -1.0) * np.minimum(out, within)
    return signed
