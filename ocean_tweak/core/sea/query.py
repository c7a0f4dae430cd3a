# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface of several parts above a given place.

Newton's method goes from the long waves to the short: the place at rest that the first patch finds is where
the search with the first two begins, and so on. So no step has to cross more than a patch's own waves.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..surface_query import Field, SurfacePoints, described, inside_quad, newton
from .sampling import summed_field

Array = NDArray[np.float64]

#: where the surface is squeezed to less than this, it may lie over itself nearby
_NEARLY_FOLDED = 0.3
#: quads of the net that is laid around a place to find other sheets, at the most, along each axis
_NET = 64
#: lines of a rough net that tells how far points are moved around here, and by how much it may be wrong
_ROUGH, _MARGIN = 13, 1.2
#: places around which nets are laid at once
_CHUNK = 32


def find_summed_points(
    x: ArrayLike,
    y: ArrayLike,
    fields: Sequence[Field],
    spacings: Sequence[float],
    reach: float,
    with_velocity: bool,
) -> SurfacePoints:
    """The surface of some patches together above places x and y in m, of one shape.

    fields, spacings : of each patch, in the sea's axes, from long waves to short
    reach : how far in m the sea may have moved a point sideways

    Where the surface folds, the highest of the sheets that a net of rest positions around each place shows.
    """
    places_x, places_y = np.broadcast_arrays(np.asarray(x, np.float64), np.asarray(y, np.float64))
    shape, px, py = places_x.shape, places_x.ravel(), places_y.ravel()
    rest_x, rest_y, found = _from_long_to_short(px, py, px, py, fields, spacings)
    whole = summed_field(fields)
    doubtful = np.nonzero(_near_folds(rest_x, rest_y, whole, 0.5 * reach) | ~found)[0]
    for first in range(0, len(doubtful), _CHUNK):
        chunk = doubtful[first : first + _CHUNK]
        best = np.where(found[chunk], whole(rest_x[chunk], rest_y[chunk], False)[0].value[:, 2], -np.inf)
        for place, x_there, y_there, height in _sheets(px[chunk], py[chunk], whole, spacings[-1], reach):
            if height > best[place]:
                best[place], found[chunk[place]] = height, True
                rest_x[chunk[place]], rest_y[chunk[place]] = x_there, y_there
    return described(rest_x, rest_y, found, shape, whole, with_velocity)


def _from_long_to_short(
    px: Array, py: Array, rest_x: Array, rest_y: Array, fields: Sequence[Field], spacings: Sequence[float]
) -> tuple[Array, Array, NDArray[np.bool_]]:
    found = np.zeros(px.shape, bool)
    for count, spacing in enumerate(spacings, 1):
        rest_x, rest_y, found = newton(px, py, rest_x, rest_y, summed_field(fields[:count]), spacing)
    return rest_x, rest_y, found


def _sheets(
    px: Array, py: Array, field: Field, spacing: float, reach: float
) -> Iterator[tuple[int, float, float, float]]:
    """The sheets over each place: its number, the rest position and the height."""
    # how far points were moved around here is less than the farthest of the whole sea
    rough = np.linspace(-reach, reach, _ROUGH)
    rough_x, rough_y = _net(px, py, rough)
    (moved, _, _), _ = field(rough_x.ravel(), rough_y.ravel(), False)
    reach = min(reach, _MARGIN * float(np.max(np.hypot(moved[:, 0], moved[:, 1]))) + 2.0 * spacing)
    count = min(_NET, max(2, int(np.ceil(2.0 * reach / spacing))))
    offset = np.linspace(-reach, reach, count + 1)
    net_x, net_y = _net(px, py, offset)
    value = field(net_x.ravel(), net_y.ravel(), False)[0].value.reshape(*net_x.shape, 3)
    off = np.stack((net_x, net_y), axis=-1) + value[..., :2]
    off -= np.stack((px, py), axis=-1)[:, np.newaxis, np.newaxis]
    # (4, places, rows, columns, 2): a quad's corners as they lie around the place
    corners = np.stack([off[:, i : count + i, j : count + j] for i in (0, 1) for j in (0, 1)])
    near = np.all((corners.min(axis=0) <= 0.0) & (corners.max(axis=0) >= 0.0), axis=-1)
    place, row, column = np.nonzero(near)
    u, v, hit = inside_quad(corners[:, place, row, column])
    place, row, column = place[hit], row[hit], column[hit]
    u, v = u[hit], v[hit]
    step = offset[1] - offset[0]
    start_x, start_y = (net[place, row, column] + step * w for net, w in ((net_x, u), (net_y, v)))
    x, y, met = newton(px[place], py[place], start_x, start_y, field, spacing)
    # a sheet between two folds may be narrower than a step of Newton's: then the net itself has to do
    kept = met & (np.hypot(x - start_x, y - start_y) < 2.0 * step)
    x, y = np.where(kept, x, start_x), np.where(kept, y, start_y)
    z = [value[place, row + i, column + j, 2] for i in (0, 1) for j in (0, 1)]
    of_net = (z[0] * (1 - u) + z[1] * u) * (1 - v) + (z[2] * (1 - u) + z[3] * u) * v
    height = np.where(kept, field(x, y, False)[0].value[:, 2], of_net)
    yield from zip(*(part.tolist() for part in (place, x, y, height)), strict=True)


def _net(px: Array, py: Array, offset: Array) -> tuple[Array, Array]:
    """x and y of a square net around each place, (places, rows, columns)."""
    x = px[:, np.newaxis, np.newaxis] + offset
    y = py[:, np.newaxis, np.newaxis] + offset[:, np.newaxis]
    net_x, net_y = np.broadcast_arrays(x, y)
    return net_x, net_y


def _near_folds(x: Array, y: Array, field: Field, step: float) -> NDArray[np.bool_]:
    """Whether the surface is squeezed a lot at any of 5 x 5 places around each."""
    result = np.zeros(x.shape, bool)
    for dy in (-2.0, -1.0, 0.0, 1.0, 2.0):
        for dx in (-2.0, -1.0, 0.0, 1.0, 2.0):
            (_, by_x, by_y), _ = field(x + 0.5 * step * dx, y + 0.5 * step * dy, False)
            half_sum = 0.5 * (by_x[:, 0] + by_y[:, 1])
            root = np.hypot(0.5 * (by_x[:, 0] - by_y[:, 1]), 0.5 * (by_x[:, 1] + by_y[:, 0]))
            result |= 1.0 + half_sum - root < _NEARLY_FOLDED
    return result
