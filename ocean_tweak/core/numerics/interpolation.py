# SPDX-License-Identifier: GPL-3.0-or-later
"""Interpolation between samples.

Fields [y, x] are interpolated bilinearly, as meshes, renderers and nodes do. `between` samples periodic
fields of any shape, in double precision; a `Reader` samples many periodic fields of one grid at the same
places, in their own precision. `stretched` resamples a field along one axis.

Samples at integers can also be interpolated by a quadratic B-spline, which is smooth and never leaves the
range of the samples.
"""

from __future__ import annotations

from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]
_Real = TypeVar("_Real", bound=np.floating)

#: places processed together
_PLACES = 2**14


def smoothstep(part: NDArray[_Real]) -> NDArray[_Real]:
    """From 0 at 0 and below to 1 at 1 and above, level at both ends: p²(3 - 2p)."""
    share = np.clip(part, 0.0, 1.0)
    result: NDArray[_Real] = share * share * (3.0 - 2.0 * share)
    return result


def smoothstep_slope(part: NDArray[_Real]) -> NDArray[_Real]:
    """Derivative of `smoothstep`: 6p(1 - p), and 0 beyond its ends."""
    share = np.clip(part, 0.0, 1.0)
    result: NDArray[_Real] = 6.0 * share * (1.0 - share)
    return result


class Between(NamedTuple):
    """Positions of places in a periodic field.

    corners : indices of the samples around each: here, next column, next row, both
    u, v : offset of each from the column and the row before it, 0…1
    """

    corners: tuple[tuple[NDArray[np.intp], NDArray[np.intp]], ...]
    u: Array
    v: Array

    def read(self, field: RealArray) -> RealArray:
        """The values of a (rows, columns) field at the places."""
        here, beside, above, across = (field[corner] for corner in self.corners)
        low, high = here + self.u * (beside - here), above + self.u * (across - above)
        return np.asarray(low + self.v * (high - low))


def between(row: Array, column: Array, shape: tuple[int, ...]) -> Between:
    """Locate places, given by row and column in arrays of one shape, in fields of (rows, columns, …)."""
    i, j = np.floor(row).astype(np.intp), np.floor(column).astype(np.intp)
    corners = tuple((y % shape[0], x % shape[1]) for y in (i, i + 1) for x in (j, j + 1))
    return Between(corners, column - j, row - i)


class Reader:
    """Samples square fields, [y, x] from the origin, at places given along the fields' own axes.

    The fields are `wrapped` and flat, so that neighbouring samples never need wrapping.
    """

    def __init__(self, x: Array, y: Array, size: float, resolution: int) -> None:
        self._row = resolution + 1
        self._first = np.empty(x.size, np.int32)
        self._u, self._v = np.empty(x.size, np.float32), np.empty(x.size, np.float32)
        for start in range(0, x.size, _PLACES):  # intermediate arrays stay in the processor's cache
            part = slice(start, start + _PLACES)
            (j, self._u[part]), (i, self._v[part]) = (
                _cells(place[part], size, resolution) for place in (x, y)
            )
            i *= self._row
            i += j
            self._first[part] = i

    @property
    def nbytes(self) -> int:
        """Bytes used by the stored positions."""
        return self._first.nbytes + self._u.nbytes + self._v.nbytes

    def read(self, field: RealArray) -> RealArray:
        """One value per place, in the field's precision, from a field of (N+1)² values."""
        first = self._first.astype(np.intp)
        # all indices are valid; mode "wrap" is faster than bounds checking
        p00, p01, p10, p11 = (
            np.take(field[offset:], first, mode="wrap") for offset in (0, 1, self._row, self._row + 1)
        )
        p01 -= p00
        p01 *= self._u
        p01 += p00  # between the two of the row
        p11 -= p10
        p11 *= self._u
        p11 += p10
        p11 -= p01
        p11 *= self._v
        p11 += p01
        return p11


def _cells(place: Array, size: float, resolution: int) -> tuple[NDArray[np.intp], NDArray[np.float32]]:
    """The cell of each place along an axis, and the place's offset in it, 0…1."""
    part = place / size
    part -= np.floor(part)
    part *= resolution
    cell = part.astype(np.intp)
    np.minimum(cell, resolution - 1, out=cell)  # for a place that was rounded up to the far edge
    part -= cell
    return cell, part.astype(np.float32)


def wrapped(field: RealArray, dtype: type | None = None) -> RealArray:
    """(rows+1, columns+1, …) copy of a periodic (rows, columns, …) field, with the first row and column
    repeated at the end.

    dtype : of the result, by default that of the field
    """
    rows, columns = field.shape[:2]
    result = np.empty((rows + 1, columns + 1, *field.shape[2:]), dtype or field.dtype)
    result[:rows, :columns] = field
    close(result)
    return result


def close(field: RealArray) -> None:
    """Copy the first row and column of a (rows+1, columns+1, …) field to its last ones."""
    field[-1, :-1] = field[0, :-1]
    field[:, -1] = field[:, 0]


def stretched(field: RealArray, axis: int, samples: int) -> RealArray:
    """The field at samples + 1 places along an axis, evenly spaced from its first sample to its last."""
    last = field.shape[axis] - 1
    place = np.arange(samples + 1) * (last / samples)
    before = np.minimum(place.astype(np.intp), last - 1)
    share = (place - before).astype(field.dtype)
    result, step = np.take(field, before, axis), np.take(field, before + 1, axis)
    step -= result
    step *= share.reshape([-1 if each == axis else 1 for each in range(field.ndim)])
    result += step
    return result


def spline_read(field: Array, row: Array, column: Array, *others: Array) -> tuple[Array, ...]:
    """Sample a periodic (rows, columns) field at places whose row and column broadcast. Returns the spline's
    value, its derivatives by row and by column, and the values of further fields of that shape."""
    (i, up), (j, along) = spline_weights(row), spline_weights(column)
    slope_up, slope_along = spline_slopes(row), spline_slopes(column)
    rows, columns = field.shape
    shape = np.broadcast_shapes(row.shape, column.shape)
    value, by_row, by_column = (np.zeros(shape) for _ in range(3))
    values = tuple(np.zeros(shape) for _ in others)
    for b in range(3):
        for a in range(3):
            at = i[b] % rows, j[a] % columns
            sample = field[at]
            value += sample * up[b] * along[a]
            by_row += sample * slope_up[b] * along[a]
            by_column += sample * up[b] * slope_along[a]
            for total, other in zip(values, others, strict=True):
                total += other[at] * up[b] * along[a]
    return value, by_row, by_column, *values


def spline_weights(position: Array) -> tuple[NDArray[np.intp], Array]:
    """The three samples around each place, (3, …), and their weights, which add up to 1."""
    nearest, off = _nearest(position)
    samples = nearest.astype(np.intp) + np.arange(-1, 2).reshape(3, *(1,) * position.ndim)
    return samples, np.stack((0.5 * (0.5 - off) ** 2, 0.75 - off * off, 0.5 * (0.5 + off) ** 2))


def spline_slopes(position: Array) -> Array:
    """(3, …) derivatives of those weights with respect to the position."""
    _, off = _nearest(position)
    return np.stack((off - 0.5, -2.0 * off, off + 0.5))


def _nearest(position: Array) -> tuple[Array, Array]:
    nearest = np.rint(position)
    return nearest, position - nearest
