# SPDX-License-Identifier: GPL-3.0-or-later
"""Mask weights by the distance from a place or from lines."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..numerics.interpolation import smoothstep, smoothstep_slope
from .parameters import Mask

Array = NDArray[np.float64]

#: samples along each side of a grid block that share one search for nearby lines
_BLOCK = 64


def by_distance(mask: Mask, domain_size: float, x: Array, y: Array) -> tuple[Array, Array, Array]:
    """A smoothstep over the distance from the place, or from the nearest line, both repeated with the
    domain."""
    dx, dy = (_from_place if mask.lines is None else _from_lines)(mask, domain_size, x, y)
    distance = np.hypot(dx, dy)
    part = (distance - mask.inner_radius) / (mask.outer_radius - mask.inner_radius)
    rate = smoothstep_slope(part) / (mask.outer_radius - mask.inner_radius) / np.maximum(distance, 1e-12)
    return smoothstep(part), rate * dx, rate * dy


def _from_place(mask: Mask, domain_size: float, x: Array, y: Array) -> tuple[Array, Array]:
    """Offset (x, y) from the nearest repetition of its place, m."""
    dx, dy = (
        (p - at + 0.5 * domain_size) % domain_size - 0.5 * domain_size for p, at in ((x, mask.x), (y, mask.y))
    )
    return dx, dy


def _from_lines(mask: Mask, domain_size: float, x: Array, y: Array) -> tuple[Array, Array]:
    """Offset (x, y) from the nearest point of its lines, m; arbitrary beyond the outer radius of all
    lines."""
    shape = np.broadcast_shapes(x.shape, y.shape)
    x, y = (np.broadcast_to(place % domain_size, shape) for place in (x, y))
    lines = _lines_in_reach(mask, domain_size)
    away_x, away_y = np.empty(x.shape), np.empty(x.shape)
    for block in _blocks(x.shape):
        away_x[block], away_y[block] = _away(lines, x[block], y[block], mask.outer_radius)
    return away_x, away_y


def _blocks(shape: tuple[int, ...]) -> Iterator[tuple[slice, ...]]:
    """Split the places of a grid into blocks of neighbours."""
    side = _BLOCK if len(shape) > 1 else _BLOCK**2
    firsts = itertools.product(*(range(0, count, side) for count in shape))
    yield from (tuple(slice(first, first + side) for first in each) for each in firsts)


def _away(lines: Array, x: Array, y: Array, reach: float) -> tuple[Array, Array]:
    """Offset (x, y) from the nearest of the lines, (lines, 2, 2) start points and extents, m; `reach` where
    all are farther away.

    Only lines that can be the nearest for some place are examined: those whose distance from the middle of
    the places exceeds that of the line nearest to it by at most twice the radius of the places.
    """
    nearest = np.full(x.shape, reach * reach)
    away_x, away_y = np.full(x.shape, reach), np.zeros(x.shape)
    middle_x, middle_y = (0.5 * float(np.min(place) + np.max(place)) for place in (x, y))
    around = float(np.max(np.hypot(x - middle_x, y - middle_y)))
    distance = np.hypot(*_to_lines(lines[:, 0].T, lines[:, 1].T, middle_x, middle_y))
    may_be_nearest = distance <= min(distance.min(initial=np.inf) + around, reach) + around
    for begin, extent in lines[may_be_nearest]:
        dx, dy = _to_lines(begin, extent, x, y)
        square = dx * dx + dy * dy
        is_nearer = square < nearest
        for kept, found in ((nearest, square), (away_x, dx), (away_y, dy)):
            np.copyto(kept, found, where=is_nearer)
    return away_x, away_y


def _to_lines(begin: Array, extent: Array, x: Array | float, y: Array | float) -> tuple[Array, Array]:
    """Offsets (x, y) of places from the nearest points of lines: one line and many places, or many lines and
    one place."""
    (ax, ay), (ux, uy) = begin, extent
    along = np.clip(((x - ax) * ux + (y - ay) * uy) / np.maximum(ux * ux + uy * uy, 1e-12), 0.0, 1.0)
    return x - ax - along * ux, y - ay - along * uy


def _lines_in_reach(mask: Mask, domain_size: float) -> Array:
    """(lines, 2, 2) start points and extents of the repeated lines that can be the nearest for a place in the
    domain.

    No place is farther than half a diagonal from the nearest repetition of any point.
    """
    assert mask.lines is not None
    reach = min(mask.outer_radius, math.sqrt(0.5) * domain_size)
    ends = mask.lines.values.reshape(-1, 2, 2).astype(np.float64)
    first = np.ceil((-reach - ends.max(axis=1)) / domain_size)
    last = np.floor((domain_size + reach - ends.min(axis=1)) / domain_size)
    along_x, along_y = (np.arange(first[:, a].min(), last[:, a].max() + 1.0) for a in (0, 1))
    in_x, in_y = (
        (first[:, a, np.newaxis] <= along) & (along <= last[:, a, np.newaxis])
        for a, along in enumerate((along_x, along_y))
    )
    line, i, j = np.nonzero(in_x[:, :, np.newaxis] & in_y[:, np.newaxis, :])
    begins = ends[line, 0] + domain_size * np.stack((along_x[i], along_y[j]), axis=-1)
    return np.stack((begins, ends[line, 1] - ends[line, 0]), axis=1)
