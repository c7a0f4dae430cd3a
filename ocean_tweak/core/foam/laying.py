# SPDX-License-Identifier: GPL-3.0-or-later
"""Old foam of a tile at its present position: drawn out into windrows, shifted, and resampled.

Foam is interpolated linearly between samples; its age is taken from the sample that contributes more, as a
mean of a new and an old birth would be the age of neither.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ..numerics.choice import chosen
from ..numerics.memo import total_bytes
from .windrows import Windrows

RealArray = NDArray[np.floating]
_Number = TypeVar("_Number", bound=np.generic)
#: foam in 0…1 and its age in s, float32 arrays of one shape
Foam = tuple[RealArray, RealArray]


class Drawing:
    """Windrows on the samples of a grid that drifts with them."""

    def __init__(self, windrows: Windrows, samples: int, spacing: float) -> None:
        self._windrows = windrows
        by_x, by_y, self._share = windrows.on_grid(spacing * np.arange(samples, dtype=np.float64))
        # offset in samples from each sample to its source
        for by in (by_x, by_y):
            by *= np.float32(-1.0 / spacing)
        whole_x, whole_y = np.floor(by_x), np.floor(by_y)
        self._u, self._v = by_x - whole_x, by_y - whole_y
        column, row = whole_x.astype(np.int32), whole_y.astype(np.int32)
        at = np.arange(samples, dtype=np.int32)
        row += at[:, np.newaxis]
        column += at
        for along in (row, column):
            along -= samples * (along // samples)
        # index of the sample before each source, in rows with the first sample repeated at the end
        self._first: NDArray[np.int32] = row * np.int32(samples + 1) + column

    @property
    def nbytes(self) -> int:
        """Bytes of the stored arrays."""
        return total_bytes((self._share, self._u, self._v, self._first))

    def rows(self, left: Foam, first: int, count: int) -> Foam:
        """(count, M) old foam and its age in the windrows, starting at a row; see `laid`."""
        foam, age = (rows_of(field[:-1, :-1], first, count) for field in left)
        at = rows_of(self._first, first, count).astype(np.intp)
        u, v = rows_of(self._u, first, count), rows_of(self._v, first, count)
        # all indices are valid; mode "wrap" is faster than bounds checking
        flat, below = [field.reshape(-1) for field in left], foam.shape[1] + 1
        here, beside, above, across = (
            [np.take(field[offset:], at, mode="wrap") for field in flat]
            for offset in (0, 1, below, below + 1)
        )
        drawn = between(between(here, beside, u), between(above, across, u), v)
        own = self._windrows.staying(foam, age)
        return self._windrows.drawn_out(own, age, *drawn, rows_of(self._share, first, count))


def laid(left: Foam, shift: Sequence[float], drawing: Drawing | None, first: int, count: int) -> Foam:
    """(count, M) rows of remaining foam, starting at a row, drawn out and then read with an offset of `shift`
    rows and columns.

    left : (M+1, M+1), with the first row and column repeated at the end
    """
    (down, by_rows), (across, by_columns) = map(_whole_and_share, shift)
    at = first + down, count + (1 if by_rows else 0)
    found = [rows_of(field[:-1, :-1], *at) for field in left]
    if drawing is not None:
        found = [*drawing.rows(left, *at)]
    if by_rows:
        found = [*between([field[:-1] for field in found], [field[1:] for field in found], by_rows)]
    if across:
        found = [np.roll(field, -across, axis=1) for field in found]
    if by_columns:
        found = [*between(found, [np.roll(field, -1, axis=1) for field in found], by_columns)]
    foam, age = found
    return foam, age


def _whole_and_share(shift: float) -> tuple[int, np.float32]:
    whole = math.floor(shift)
    return whole, np.float32(shift - whole)


def rows_of(field: NDArray[_Number], first: int, count: int) -> NDArray[_Number]:
    """`count` rows of a periodic field, starting at any row."""
    n = len(field)
    first %= n
    if first + count <= n:
        return field[first : first + count]
    return np.take(field, range(first, first + count), 0, mode="wrap")


#: interpolates fields at a fraction of the way to the next sample
Mix = Callable[[Sequence[RealArray], Sequence[RealArray], RealArray | np.float32], Sequence[RealArray]]


class Finer:
    """Resamples periodic (M, M) fields to (N, N); the first samples coincide."""

    def __init__(self, own: int, samples: int) -> None:
        place = np.arange(samples) * (own / samples)
        self._own, self._samples = own, samples
        self._before = place.astype(np.intp)
        self._share = (place - self._before).astype(np.float32)

    def rows(
        self, block: slice, given: Callable[[int, int], Sequence[RealArray]], mix: Mix
    ) -> Sequence[RealArray]:
        """(rows, N) fields.

        block : the rows of N
        given : function that returns rows of M, starting at one that may be beyond the last
        """
        if self._own == self._samples:
            return given(block.start, block.stop - block.start)
        before, share = self._before[block], self._share[block, np.newaxis]
        first = int(before[0])
        fields = given(first, int(before[-1]) - first + 2)
        near, far = ([np.take(field, before + (step - first), 0) for field in fields] for step in (0, 1))
        return self._along_rows(mix(near, far, share), mix)

    def _along_rows(self, fields: Sequence[RealArray], mix: Mix) -> Sequence[RealArray]:
        if self._samples % self._own:
            near, far = (
                [np.take(field, (self._before + step) % self._own, 1) for field in fields] for step in (0, 1)
            )
            return mix(near, far, self._share)
        # with an integer ratio, each output phase has a single weight, and whole rows are read instead of
        # places
        times = self._samples // self._own
        result = [np.empty((len(field), self._samples), np.float32) for field in fields]
        after = [np.roll(field, -1, 1) for field in fields]
        for number in range(times):
            found = mix(fields, after, np.float32(number / times)) if number else fields
            for whole, field in zip(result, found, strict=True):
                whole[:, number::times] = field
        return result


def linear(
    near: Sequence[RealArray], far: Sequence[RealArray], share: RealArray | np.float32
) -> Sequence[RealArray]:
    """Plain fields at a fraction of the way from one sample to the next."""
    return [field + share * (other - field) for field, other in zip(near, far, strict=True)]


def between(near: Sequence[RealArray], far: Sequence[RealArray], share: RealArray | np.float32) -> Foam:
    """Foam at a fraction of the way from one sample to the next, and its age."""
    (foam, age), (other_foam, other_age) = near, far
    other = share * other_foam
    own = share * foam
    np.subtract(foam, own, out=own)
    newer = other > own
    own += other
    return own, chosen(newer, other_age, age)
