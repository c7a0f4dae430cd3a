# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface above a given place: its height, its normal and its motion there.

The sea moves its samples sideways too, so the sample above a place must be found: the rest position r with
r + P_xy(r) = (x, y). Newton's method does so from the place itself; where the surface folds, there are
several, all quads around are looked at, and the highest sheet counts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .bilinear import between

RealArray = NDArray[np.floating]
Array = NDArray[np.float64]

_STEPS = 40
_TOLERANCE = 1e-5  # of a sample's spacing


class Values(NamedTuple):
    """A field and its derivatives by the rest position at some points: (points, channels) each."""

    value: Array
    by_x: Array
    by_y: Array


#: gives the position P (x, y, z), and with `True` the velocity, at rest positions x and y in m
Field = Callable[[Array, Array, bool], tuple[Values, Array | None]]


@dataclass(frozen=True)
class SurfacePoints:
    """The surface above some places, each array as long as those, in m and m/s.

    height : z
    rest : (…, 2) position at rest of what is there now
    normal : (…, 3) unit normal
    velocity : (…, 3) of the water there; None if it was not asked for
    found : whether the place was met to a hundred-thousandth of a sample; False only within folds
    """

    height: Array
    rest: Array
    normal: Array
    velocity: Array | None
    found: NDArray[np.bool_]


def bilinear(displacement: RealArray, velocity: RealArray | None, spacing: float) -> Field:
    """The surface that a mesh with a vertex a sample shows: bilinear between the samples, periodic."""

    def field(x: Array, y: Array, with_velocity: bool) -> tuple[Values, Array | None]:
        corners, *shares = between(y / spacing, x / spacing, displacement.shape)
        u, v = (share[:, np.newaxis] for share in shares)
        p00, p01, p10, p11 = (displacement[corner].astype(np.float64) for corner in corners)
        bottom, top = p00 + u * (p01 - p00), p10 + u * (p11 - p10)
        by_x = ((1.0 - v) * (p01 - p00) + v * (p11 - p10)) / spacing
        values = Values(bottom + v * (top - bottom), by_x, (top - bottom) / spacing)
        if not with_velocity or velocity is None:
            return values, None
        weights = ((1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v)
        moving = sum((w * velocity[corner] for w, corner in zip(weights, corners, strict=True)), np.zeros(()))
        return values, np.asarray(moving)

    return field


def find_points(
    x: ArrayLike,
    y: ArrayLike,
    displacement: RealArray,
    velocity: RealArray | None,
    spacing: float,
    folded: NDArray[np.bool_],
) -> SurfacePoints:
    """The bilinear surface above places x and y in m, of one shape.

    folded : (N, N) samples near which the surface may lie over itself: there every quad is looked at
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
    """The mask with all samples up to `reach` away, along both axes and around the edges."""
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
    """The highest of the quads over each place, looked for among all up to `reach` samples away."""
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
    """u and v at which quads (4, points, 2) pass over the origin, by Newton's method, and whether they do."""
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


def refine_points(
    x: ArrayLike,
    y: ArrayLike,
    field: Field,
    guess: SurfacePoints,
    spacing: float,
    with_velocity: bool = False,
) -> SurfacePoints:
    """The points of another surface near those of `guess`, above the same places."""
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
    """The surface of a field at rest positions, in the shape that was asked for."""
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
    """Rest positions of what is above (px, py), from first guesses, and which of them were met.

    Only points that are not there yet take part in a step. A step is at most two samples long and gets
    shorter, so that it settles where the bilinear surface has edges.
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
        far = np.hypot(off_x, off_y) > 4.0 * spacing  # first come near, then be careful
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
