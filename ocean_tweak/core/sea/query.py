# SPDX-License-Identifier: GPL-3.0-or-later
"""Height, normal and velocity of the surface above given places.

Waves also displace samples horizontally, so the rest position r with r + P_xy(r) = (x, y) must be found.
Newton's method starts from the place itself; where the surface folds there are several solutions, all quads
nearby are tested, and the highest sheet is taken.

For several parts, Newton's method proceeds from long waves to short: the solution for the first part is the
start for the first two, and so on. So no step has to cross more than one part's own waves.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .surfaces import Field, Values, bilinear, summed_field

RealArray = NDArray[np.floating]
Array = NDArray[np.float64]

_STEPS = 40
_TOLERANCE = 1e-5  # tolerance, in sample spacings

#: below this eigenvalue the surface may fold over nearby
_FOLDING = 0.3
#: largest number of quads along each axis of the net around a place that is searched for further sheets
_NET = 64
#: lines of a coarse net for the largest horizontal displacement nearby, and its safety factor
_ROUGH, _MARGIN = 13, 1.2
#: places processed at a time
_CHUNK = 32


@dataclass(frozen=True)
class SurfacePoints:
    """The surface above some places; arrays in the places' shape, in m and m/s.

    height : z
    rest : (…, 2) rest position of the water there
    normal : (…, 3) unit normal
    velocity : (…, 3) of the water there; None if not requested
    found : whether the solution is accurate to a hundred-thousandth of a sample; False only within folds
    """

    height: Array
    rest: Array
    normal: Array
    velocity: Array | None
    found: NDArray[np.bool_]


def find_points(
    x: ArrayLike,
    y: ArrayLike,
    displacement: RealArray,
    velocity: RealArray | None,
    spacing: float,
    folded: NDArray[np.bool_],
) -> SurfacePoints:
    """The bilinear surface above places x and y in m, arrays of one shape.

    folded : (N, N) samples near which the surface may fold over; there every quad is tested
    """
    places_x, places_y = np.broadcast_arrays(np.asarray(x, np.float64), np.asarray(y, np.float64))
    shape, px, py = places_x.shape, places_x.ravel(), places_y.ravel()
    field = bilinear(displacement, velocity, spacing)
    rest_x, rest_y, found = newton(px, py, px, py, field, spacing)
    if np.any(folded):
        reach = float(np.max(np.abs(displacement[..., :2]))) / spacing
        near = _spread(folded, int(np.ceil(reach)) + 1)
        n = len(folded)
        j, i = (np.floor(p / spacing).astype(np.intp) % n for p in (px, py))
        doubtful = np.nonzero(near[i, j] | ~found)[0]
        sheet = _highest_sheet(px[doubtful], py[doubtful], displacement, spacing, int(np.ceil(reach)) + 1)
        rest_x[doubtful] = np.where(sheet.met, sheet.rest_x, rest_x[doubtful])
        rest_y[doubtful] = np.where(sheet.met, sheet.rest_y, rest_y[doubtful])
        found[doubtful] |= sheet.met
    return described(rest_x, rest_y, found, shape, field, velocity is not None)


def _spread(mask: NDArray[np.bool_], reach: int) -> NDArray[np.bool_]:
    """Dilate a periodic mask by `reach` samples along both axes."""
    for axis in (0, 1):
        wide = mask.copy()
        for shift in range(1, min(reach, len(mask) // 2) + 1):
            wide |= np.roll(mask, shift, axis) | np.roll(mask, -shift, axis)
        mask = wide
    return mask


class _Sheet(NamedTuple):
    rest_x: Array
    rest_y: Array
    met: NDArray[np.bool_]


def _highest_sheet(px: Array, py: Array, displacement: RealArray, spacing: float, reach: int) -> _Sheet:
    """The highest quad over each place, among all within `reach` samples."""
    n = len(displacement)
    j0, i0 = np.floor(px / spacing).astype(np.intp), np.floor(py / spacing).astype(np.intp)
    best = np.full(px.shape, -np.inf)
    rest_x, rest_y = np.zeros(px.shape), np.zeros(px.shape)
    for di in range(-reach, reach + 1):
        for dj in range(-reach, reach + 1):
            i, j = i0 + di, j0 + dj
            # (4, points, 3), then relative to the place
            corners: Array = np.array(
                [displacement[(i + a) % n, (j + b) % n] for a in (0, 1) for b in (0, 1)], np.float64
            )
            corners[..., 0] += spacing * (j + np.array([[0], [1], [0], [1]])) - px
            corners[..., 1] += spacing * (i + np.array([[0], [0], [1], [1]])) - py
            plane = corners[..., :2]
            inside = np.nonzero(np.all((plane.min(axis=0) <= 0.0) & (plane.max(axis=0) >= 0.0), axis=-1))[0]
            if not len(inside):
                continue
            u, v, hit = inside_quad(corners[:, inside, :2])
            quad = corners[:, inside, 2]
            z = (quad[0] * (1 - u) + quad[1] * u) * (1 - v) + (quad[2] * (1 - u) + quad[3] * u) * v
            better = hit & (z > best[inside])
            taken = inside[better]
            best[taken] = z[better]
            rest_x[taken] = spacing * (j[taken] + u[better])
            rest_y[taken] = spacing * (i[taken] + v[better])
    return _Sheet(rest_x, rest_y, np.isfinite(best))


def inside_quad(corners: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Solve for (u, v) at which quads (4, points, 2) contain the origin, by Newton's method; also returns
    whether they do."""
    p00, p01, p10, p11 = corners
    across, up, twist = p01 - p00, p10 - p00, p00 - p01 - p10 + p11
    u = np.full(len(p00), 0.5)
    v = np.full(len(p00), 0.5)
    for _ in range(12):
        off = p00 + across * u[:, None] + up * v[:, None] + twist * (u * v)[:, None]
        by_u, by_v = across + twist * v[:, None], up + twist * u[:, None]
        determinant = by_u[:, 0] * by_v[:, 1] - by_u[:, 1] * by_v[:, 0]
        safe = np.where(np.abs(determinant) > 1e-12, determinant, 1e-12)
        u = np.clip(u - (by_v[:, 1] * off[:, 0] - by_v[:, 0] * off[:, 1]) / safe, -2.0, 3.0)
        v = np.clip(v - (by_u[:, 0] * off[:, 1] - by_u[:, 1] * off[:, 0]) / safe, -2.0, 3.0)
    off = p00 + across * u[:, None] + up * v[:, None] + twist * (u * v)[:, None]
    size = np.max(np.abs(corners), axis=(0, 2))
    near = np.max(np.abs(off), axis=-1) < 1e-6 * size
    edge = 1e-6
    inside = (u > -edge) & (u < 1 + edge) & (v > -edge) & (v < 1 + edge)
    return np.clip(u, 0.0, 1.0), np.clip(v, 0.0, 1.0), near & inside


def find_summed_points(
    x: ArrayLike,
    y: ArrayLike,
    fields: Sequence[Field],
    spacings: Sequence[float],
    reach: float,
    with_velocity: bool,
) -> SurfacePoints:
    """The surface of the sum of several patches above places x and y in m, arrays of one shape.

    fields, spacings : of each patch, in the sea's axes, from long waves to short
    reach : largest horizontal displacement of the sea in m

    Where the surface folds, the highest of the sheets found by a net of rest positions around each place.
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
    """The sheets over each place: index of the place, rest position and height."""
    # the largest displacement nearby is smaller than that of the whole sea
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
    # (4, places, rows, columns, 2): corners of quads relative to the place
    corners = np.stack([off[:, i : count + i, j : count + j] for i in (0, 1) for j in (0, 1)])
    near = np.all((corners.min(axis=0) <= 0.0) & (corners.max(axis=0) >= 0.0), axis=-1)
    place, row, column = np.nonzero(near)
    u, v, hit = inside_quad(corners[:, place, row, column])
    place, row, column = place[hit], row[hit], column[hit]
    u, v = u[hit], v[hit]
    step = offset[1] - offset[0]
    start_x, start_y = (net[place, row, column] + step * w for net, w in ((net_x, u), (net_y, v)))
    x, y, met = newton(px[place], py[place], start_x, start_y, field, spacing)
    # a sheet between two folds may be narrower than a Newton step: then use the net's own solution
    kept = met & (np.hypot(x - start_x, y - start_y) < 2.0 * step)
    x, y = np.where(kept, x, start_x), np.where(kept, y, start_y)
    z = [value[place, row + i, column + j, 2] for i in (0, 1) for j in (0, 1)]
    of_net = (z[0] * (1 - u) + z[1] * u) * (1 - v) + (z[2] * (1 - u) + z[3] * u) * v
    height = np.where(kept, field(x, y, False)[0].value[:, 2], of_net)
    yield from zip(*(part.tolist() for part in (place, x, y, height)), strict=True)


def _net(px: Array, py: Array, offset: Array) -> tuple[Array, Array]:
    """Coordinates x and y of a square net around each place, (places, rows, columns)."""
    x = px[:, np.newaxis, np.newaxis] + offset
    y = py[:, np.newaxis, np.newaxis] + offset[:, np.newaxis]
    net_x, net_y = np.broadcast_arrays(x, y)
    return net_x, net_y


def _near_folds(x: Array, y: Array, field: Field, step: float) -> NDArray[np.bool_]:
    """Whether the surface is strongly compressed at any of 5 x 5 positions around each place."""
    result = np.zeros(x.shape, bool)
    for dy in (-2.0, -1.0, 0.0, 1.0, 2.0):
        for dx in (-2.0, -1.0, 0.0, 1.0, 2.0):
            (_, by_x, by_y), _ = field(x + 0.5 * step * dx, y + 0.5 * step * dy, False)
            half_sum = 0.5 * (by_x[:, 0] + by_y[:, 1])
            root = np.hypot(0.5 * (by_x[:, 0] - by_y[:, 1]), 0.5 * (by_x[:, 1] + by_y[:, 0]))
            result |= 1.0 + half_sum - root < _FOLDING
    return result


def refine_points(
    x: ArrayLike,
    y: ArrayLike,
    field: Field,
    guess: SurfacePoints,
    spacing: float,
    with_velocity: bool = False,
) -> SurfacePoints:
    """The points of another surface above the same places, starting from `guess`."""
    px, py = (np.broadcast_to(np.asarray(v, np.float64), guess.height.shape).ravel() for v in (x, y))
    rest = guess.rest.reshape(-1, 2)
    rest_x, rest_y, found = newton(px, py, rest[:, 0], rest[:, 1], field, spacing)
    return described(rest_x, rest_y, found, guess.height.shape, field, with_velocity)


def described(
    rest_x: Array,
    rest_y: Array,
    found: NDArray[np.bool_],
    shape: tuple[int, ...],
    field: Field,
    with_velocity: bool,
) -> SurfacePoints:
    """The surface of a field at rest positions, in a given shape."""
    values, velocity = field(rest_x, rest_y, with_velocity)
    normal = _normals(values)
    return SurfacePoints(
        height=values.value[:, 2].reshape(shape),
        rest=np.stack((rest_x, rest_y), axis=-1).reshape(*shape, 2),
        normal=normal.reshape(*shape, 3),
        velocity=None if velocity is None else velocity.reshape(*shape, 3),
        found=found.reshape(shape),
    )


def newton(
    px: Array, py: Array, rest_x: Array, rest_y: Array, field: Field, spacing: float
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Rest positions of the surface above (px, py), from initial guesses, and whether each converged.

    Only points that have not converged take part in a step. Steps are at most two samples long and get
    shorter, so that they converge at the edges of the bilinear surface.
    """
    rest_x, rest_y = rest_x.copy(), rest_y.copy()
    waiting = np.arange(px.size)
    for step in range(_STEPS):
        values, _ = field(rest_x[waiting], rest_y[waiting], False)
        off_x = rest_x[waiting] + values.value[:, 0] - px[waiting]
        off_y = rest_y[waiting] + values.value[:, 1] - py[waiting]
        away = np.hypot(off_x, off_y) > _TOLERANCE * spacing
        if not np.any(away):
            waiting = waiting[:0]
            break
        waiting, off_x, off_y = waiting[away], off_x[away], off_y[away]
        xx, yx = 1.0 + values.by_x[away, 0], values.by_x[away, 1]
        xy, yy = values.by_y[away, 0], 1.0 + values.by_y[away, 1]
        determinant = xx * yy - xy * yx
        steep = np.abs(determinant) > 0.05
        safe = np.where(steep, determinant, 1.0)
        move_x = np.where(steep, (yy * off_x - xy * off_y) / safe, off_x)
        move_y = np.where(steep, (xx * off_y - yx * off_x) / safe, off_y)
        longest = 2.0 * spacing * (1.0 if step < 10 else 10.0 / step)
        factor = np.minimum(1.0, longest / np.maximum(np.hypot(move_x, move_y), 1e-300))
        far = np.hypot(off_x, off_y) > 4.0 * spacing  # first approach, then damp the steps
        factor = np.where(far, 1.0, factor)
        rest_x[waiting] -= factor * move_x
        rest_y[waiting] -= factor * move_y
    met = np.ones(px.shape, bool)
    met[waiting] = False
    return rest_x, rest_y, met


def _normals(values: Values) -> Array:
    along_x, along_y = values.by_x.copy(), values.by_y.copy()
    along_x[:, 0] += 1.0
    along_y[:, 1] += 1.0
    normal = np.cross(along_x, along_y)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    return np.where(normal[:, 2:] < 0.0, -normal, normal)
