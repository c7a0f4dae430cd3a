# SPDX-License-Identifier: GPL-3.0-or-later
"""Old foam of a tile, laid where it is by now: drawn out into windrows, moved, put on more or fewer samples.

Foam between samples is linear; its age is that of the one which gives more of it, since a mean of a new and
an old birth would be the age of neither.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..numerics.choice import chosen
from ..numerics.memo import total_bytes
from ..numerics.threads import row_blocks, run_blocks
from .windrows import Windrows

RealArray = NDArray[np.floating]
#: foam in 0…1 and its age in s, float32 arrays of one shape
Foam = tuple[RealArray, RealArray]


class Drawing:
    """Windrows on the samples of a grid that drifts with them."""

    def __init__(self, windrows: Windrows, samples: int, spacing: float) -> None:
        self._windrows = windrows
        along = spacing * np.arange(samples)
        y, x = np.broadcast_arrays(along[:, np.newaxis], along)
        source_x, source_y, self._share = windrows.sources(x, y)
        column, row = np.floor(source_x / spacing), np.floor(source_y / spacing)
        self._u = (source_x / spacing - column).astype(np.float32)
        self._v = (source_y / spacing - row).astype(np.float32)
        # of the sample before each source, where rows have one more, the first again
        self._first = (row % samples * (samples + 1) + column % samples).astype(np.int32)

    @property
    def nbytes(self) -> int:
        """Bytes of all that is kept."""
        return total_bytes((self._share, self._u, self._v, self._first))

    def rows(self, left: Foam, first: int, count: int) -> Foam:
        """(count, M) old foam and its age as they lie in the windrows, from a row on; see `laid`."""
        foam, age = (_rows(field[:-1, :-1], first, count) for field in left)
        at = _rows(self._first, first, count).astype(np.intp)
        u, v = _rows(self._u, first, count), _rows(self._v, first, count)
        # all places are there; to let them wrap is quicker than to have them checked
        flat, below = [field.reshape(-1) for field in left], foam.shape[1] + 1
        here, beside, above, across = (
            [np.take(field[offset:], at, mode="wrap") for field in flat]
            for offset in (0, 1, below, below + 1)
        )
        drawn = between(between(here, beside, u), between(above, across, u), v)
        return self._windrows.drawn_out(foam, age, *drawn, _rows(self._share, first, count))


def laid(left: Foam, shift: Sequence[float], drawing: Drawing | None, workers: int) -> Foam:
    """(M, M) foam that is left, drawn out and then read `shift` rows and columns on.

    left : (M+1, M+1), whose last row and column are the first ones again
    """
    n = len(left[0]) - 1
    foam, age = np.empty((n, n), np.float32), np.empty((n, n), np.float32)
    (down, by_rows), (across, by_columns) = map(_whole_and_share, shift)

    def lay(block: slice) -> None:
        count = block.stop - block.start
        at = block.start + down, count + (1 if by_rows else 0)
        if drawing is None:
            found = [_rows(field[:-1, :-1], *at) for field in left]
        else:
            found = [*drawing.rows(left, *at)]
        if by_rows:
            found = [*between([field[:-1] for field in found], [field[1:] for field in found], by_rows)]
        if across:
            found = [np.roll(field, -across, axis=1) for field in found]
        if by_columns:
            found = [*between(found, [np.roll(field, -1, axis=1) for field in found], by_columns)]
        foam[block], age[block] = found

    run_blocks(lay, row_blocks(n, n), workers)
    return foam, age


def _whole_and_share(shift: float) -> tuple[int, np.float32]:
    whole = math.floor(shift)
    return whole, np.float32(shift - whole)


def _rows(field: RealArray, first: int, count: int) -> RealArray:
    """So many rows of a field that repeats, from any row on."""
    n = len(field)
    first %= n
    if first + count <= n:
        return field[first : first + count]
    return np.concatenate((field[first:], field[: first + count - n]))


def put_on(foam: Foam, samples: int) -> Foam:
    """Periodic (M, M) foam on (samples, samples), the first sample being the same."""
    for axis in (0, 1):
        if foam[0].shape[axis] != samples:
            foam = _stretched(foam, axis, samples)
    return foam


def _stretched(foam: Foam, axis: int, samples: int) -> Foam:
    own = foam[0].shape[axis]
    if samples % own:
        place = np.arange(samples) * (own / samples)
        before = place.astype(np.intp)
        share = (place - before).astype(np.float32).reshape((-1, 1) if axis == 0 else (1, -1))
        near, far = ([np.take(field, at, axis) for field in foam] for at in (before, (before + 1) % own))
        return between(near, far, share)
    # so many to a sample: each of them has one share, and whole arrays are read, not places
    times = samples // own
    shape = (samples, foam[0].shape[1]) if axis == 0 else (foam[0].shape[0], samples)
    result = np.empty(shape, np.float32), np.empty(shape, np.float32)
    after = [np.roll(field, -1, axis) for field in foam]
    for number in range(times):
        found = between(foam, after, np.float32(number / times)) if number else foam
        for whole, field in zip(result, found, strict=True):
            whole[(slice(None),) * axis + (slice(number, None, times),)] = field
    return result


def between(near: Sequence[RealArray], far: Sequence[RealArray], share: RealArray | np.float32) -> Foam:
    """Foam a share of the way from one sample to the next, and its age."""
    (foam, age), (other_foam, other_age) = near, far
    other = share * other_foam
    own = share * foam
    np.subtract(foam, own, out=own)
    newer = other > own
    own += other
    return own, chosen(newer, other_age, age)
