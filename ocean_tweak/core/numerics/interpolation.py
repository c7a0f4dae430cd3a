# SPDX-License-Identifier: GPL-3.0-or-later
"""Values between samples.

Of fields [y, x], bilinear, as meshes, renderers and nodes show them. `between` looks places up in fields of
any number of rows and columns, in double precision; a `Reader` reads many fields of one grid at the same
places, in the fields' own precision. Both are of fields that repeat. `stretched` puts more or fewer samples
along an axis.

Of samples at whole numbers, by the quadratic B-spline: smooth, and never beyond the samples' own range.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]


#: places whose cells are found together
_PLACES = 2**14


class Between(NamedTuple):
    """Where places lie in a field that repeats.

    corners : indices of the samples around each: here, next column, next row, both
    u, v : how far each is from the column and the row before it, 0…1
    """

    corners: tuple[tuple[NDArray[np.intp], NDArray[np.intp]], ...]
    u: Array
    v: Array

    def read(self, field: RealArray) -> RealArray:
        """The values of a (rows, columns) field there."""
        here, beside, above, across = (field[corner] for corner in self.corners)
        low, high = here + self.u * (beside - here), above + self.u * (across - above)
        return np.asarray(low + self.v * (high - low))


def between(row: Array, column: Array, shape: tuple[int, ...]) -> Between:
    """Places by row and column, of one shape, in fields of (rows, columns, …)."""
    i, j = np.floor(row).astype(np.intp), np.floor(column).astype(np.intp)
    corners = tuple((y % shape[0], x % shape[1]) for y in (i, i + 1) for x in (j, j + 1))
    return Between(corners, column - j, row - i)


class Reader:
    """Reads square fields, [y, x] from the origin, at places in their own axes.

    The fields are `wrapped` and flat, so that no neighbour of a sample is looked for at the other side.
    """

    def __init__(self, x: Array, y: Array, size: float, resolution: int) -> None:
        self._row = resolution + 1
        self._first = np.empty(x.size, np.int32)
        self._u, self._v = np.empty(x.size, np.float32), np.empty(x.size, np.float32)
        for start in range(0, x.size, _PLACES):  # what is in between stays in a cache
            part = slice(start, start + _PLACES)
            (j, self._u[part]), (i, self._v[part]) = (
                _cells(place[part], size, resolution) for place in (x, y)
            )
            i *= self._row
            i += j
            self._first[part] = i

    @property
    def nbytes(self) -> int:
        """Bytes of what is kept of the places."""
        return self._first.nbytes + self._u.nbytes + self._v.nbytes

    def read(self, field: RealArray) -> RealArray:
        """One number a place, of the field's precision, from (N+1)² numbers."""
        first = self._first.astype(np.intp)
        # all places are there; to let them wrap is quicker than to have them checked
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
    """The cell of each place along an axis, and how far in it the place is, 0…1."""
    part = place / size
    part -= np.floor(part)
    part *= resolution
    cell = part.astype(np.intp)
    np.minimum(cell, resolution - 1, out=cell)  # of a place that was rounded up to the far side
    part -= cell
    return cell, part.astype(np.float32)


def wrapped(field: RealArray, dtype: type | None = None) -> RealArray:
    """(N+1, N+1, …) of an (N, N, …) field that repeats: last row and column are the first ones again.

    dtype : of the result; by default the field's own
    """
    n = len(field)
    result = np.empty((n + 1, n + 1, *field.shape[2:]), dtype or field.dtype)
    result[:n, :n] = field
    close(result)
    return result


def close(field: RealArray) -> None:
    """Make the last row and column of an (N+1, N+1, …) field the first ones again."""
    field[-1, :-1] = field[0, :-1]
    field[:, -1] = field[:, 0]


def stretched(field: RealArray, axis: int, samples: int) -> RealArray:
    """The field at samples + 1 places along an axis, evenly from its first sample to its last."""
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
    """A (rows, columns) field that repeats at places whose row and column broadcast: the spline's value, its
    derivatives by the row and by the column, and the values of other fields of that shape."""
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
    """The three samples around each place, (3, …), and how much each counts there; they add up to 1."""
    nearest, off = _nearest(position)
    samples = nearest.astype(np.intp) + np.arange(-1, 2).reshape(3, *(1,) * position.ndim)
    return samples, np.stack((0.5 * (0.5 - off) ** 2, 0.75 - off * off, 0.5 * (0.5 + off) ** 2))


def spline_slopes(position: Array) -> Array:
    """(3, …) derivatives of those weights by the position."""
    _, off = _nearest(position)
    return np.stack((off - 0.5, -2.0 * off, off + 0.5))


def _nearest(position: Array) -> tuple[Array, Array]:
    nearest = np.rint(position)
    return nearest, position - nearest
