# SPDX-License-Identifier: GPL-3.0-or-later
"""The sea's past as foam needs it: how compressed it was where crests may have broken, at any moment.

Moments are the lattice times at which foam may be born. The sea is looked at in every few of them, as the
frequency of its strains allows. Between looks each place is interpolated by itself: the compression of a
place is nearly band-limited in time. Only places that are near the threshold in the look before or after are
followed: foam is rare, so this costs a fraction of a look.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..numerics.memo import total_bytes

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: looks before a moment, and after it, that tell of it
_SIDE = 3
#: phase in rad by which the highest frequency that is kept may turn from a look to the next: a tenth more
#: takes a ninth less looks, and a storm's foam is no longer like that of all moments
_REACH = 2.25
#: moments from a look to the next, at the most
_MOST = 8
#: power that is not within the band, over that which is
_NOISE = 4e-3
#: a place is followed that has this share of the threshold in a look
_NEAR = 0.9


def stride_of(frequency: float, step: float) -> int:
    """Moments from a look to the next.

    frequency : up to which the strains at a place are to be known, rad/s
    step : between moments, s
    """
    turn = frequency * step
    return _MOST if turn * _MOST <= _REACH else max(1, int(_REACH / turn))


class Compressed(NamedTuple):
    """Places as numbers of a flat array, the same array while they are the same, and their compression."""

    places: NDArray[np.intp]
    compression: RealArray


class Looks:
    """Looks at a sea whose moments are asked for in ascending order.

    compression_at : gives the compression of all places at a moment, an array of any shape
    stride : moments from a look to the next
    threshold : of the compression, from which on places are wanted
    """

    def __init__(self, compression_at: Callable[[int], RealArray], stride: int, threshold: float) -> None:
        self._compression_at = compression_at
        self._stride = stride
        self._threshold = threshold
        self._looks: dict[int, RealArray] = {}
        # the look after which places are followed, those places, and the looks around it there
        self._after: int | None = None
        self._followed: NDArray[np.intp] = np.empty(0, np.intp)
        self._around: list[RealArray] = []

    @property
    def nbytes(self) -> int:
        """Bytes of all that is kept."""
        return total_bytes((*self._looks.values(), self._followed, *self._around))

    def at(self, moment: int) -> Compressed:
        """Places among which are all that are compressed by more than the threshold."""
        since = moment % self._stride
        if self._after != moment - since:
            self._follow(moment - since)
        if since == 0:
            return Compressed(self._followed, self._around[_SIDE - 1])
        compression = np.zeros(self._followed.shape, np.float32)
        share = np.empty_like(compression)
        for weight, values in zip(_weights(since, self._stride), self._around, strict=True):
            # no product of matrices: how that adds up differs by machine
            compression += np.multiply(values, weight, out=share)
        return Compressed(self._followed, compression)

    def put(self, where: NDArray[np.intp], other: Looks) -> None:
        """Have other places instead of some, which were looked at up to the same moment."""
        for moment, values in self._looks.items():
            values[where] = other._looks[moment]
        stay = np.isin(self._followed, where, invert=True)
        self._followed = np.concatenate((self._followed[stay], where[other._followed]))
        pairs = zip(self._around, other._around, strict=True)
        self._around = [np.concatenate((values[stay], others)) for values, others in pairs]

    def _follow(self, look: int) -> None:
        """Follow places from a look to the next that may be compressed by more than the threshold."""
        if self._stride == 1:
            values = self._compression_at(look).ravel()
            self._after, self._followed = look, np.flatnonzero(values > self._threshold)
            self._around = [np.take(values, self._followed)] * _SIDE
            return
        here, following = self._look(look), self._look(look + self._stride)
        near = here > _NEAR * self._threshold
        near |= following > _NEAR * self._threshold
        around = [self._look(look + number * self._stride) for number in range(1 - _SIDE, _SIDE + 1)]
        self._after, self._followed = look, np.flatnonzero(near)
        self._around = [np.take(values, self._followed) for values in around]
        self._looks = {
            at: values for at, values in self._looks.items() if at > look + (1 - _SIDE) * self._stride
        }

    def _look(self, moment: int) -> RealArray:
        if moment not in self._looks:
            self._looks[moment] = self._compression_at(moment).ravel()
        return self._looks[moment]


@lru_cache(maxsize=64)
def _weights(since: int, stride: int) -> tuple[np.float32, ...]:
    """Of the looks around a moment, so many moments after the middle one.

    Those with the least mean square error for a signal with the same power at all frequencies up to the
    band's end (Wiener 1949): its correlation with itself is sin θ/θ.
    """
    at = np.arange(1 - _SIDE, _SIDE + 1)
    correlation = np.sinc(_REACH / math.pi * (at[:, np.newaxis] - at)) + _NOISE * np.eye(len(at))
    found = np.linalg.solve(correlation, np.sinc(_REACH / math.pi * (at - since / stride)))
    return tuple(np.float32(weight) for weight in found)
