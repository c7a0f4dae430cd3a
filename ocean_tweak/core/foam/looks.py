# SPDX-License-Identifier: GPL-3.0-or-later
"""The sea's history as foam needs it: the compression, at any moment, where crests may have broken.

Moments are the lattice times at which foam may be born. The sea is computed only at every few of them
("looks"), as the bandwidth of its strains allows. In between, each place is interpolated by itself, as the
compression of a place is nearly band-limited in time. Only places near the threshold in an adjacent look are
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

#: number of looks before a moment, and after it, that it is interpolated from
_SIDE = 3
#: largest phase change in rad of the highest frequency between looks: a tenth more saves a ninth of the
# looks, but visibly changes a storm's foam
_REACH = 2.25
#: largest number of moments from one look to the next
_MOST = 8
#: power outside the band, relative to that inside
_NOISE = 4e-3
#: a place is followed if its compression reaches this fraction of the threshold in a look
_NEAR = 0.9


def stride_of(frequency: float, step: float) -> int:
    """Number of moments from one look to the next.

    frequency : highest frequency of the strains to be resolved, rad/s
    step : between moments, s
    """
    turn = frequency * step
    return _MOST if turn * _MOST <= _REACH else max(1, int(_REACH / turn))


class Compressed(NamedTuple):
    """Indices of places in a flat array (the same object while they do not change), and their compression."""

    places: NDArray[np.intp]
    compression: RealArray


class Looks:
    """The looks at a sea, for moments requested in ascending order.

    compression_at : function that returns the compression of all places at a moment, an array of any shape
    stride : moments from one look to the next
    threshold : compression above which places are needed
    """

    def __init__(self, compression_at: Callable[[int], RealArray], stride: int, threshold: float) -> None:
        self._compression_at = compression_at
        self._stride = stride
        self._threshold = threshold
        self._looks: dict[int, RealArray] = {}
        # the look after which places are followed, these places, and the adjacent looks at them
        self._after: int | None = None
        self._followed: NDArray[np.intp] = np.empty(0, np.intp)
        self._around: list[RealArray] = []

    @property
    def nbytes(self) -> int:
        """Bytes of all that is kept."""
        return total_bytes((*self._looks.values(), self._followed, *self._around))

    def at(self, moment: int) -> Compressed:
        """Places that include all those compressed by more than the threshold."""
        since = moment % self._stride
        if self._after != moment - since:
            self._follow(moment - since)
        if since == 0:
            return Compressed(self._followed, self._around[_SIDE - 1])
        compression = np.zeros(self._followed.shape, np.float32)
        share = np.empty_like(compression)
        for weight, values in zip(_weights(since, self._stride), self._around, strict=True):
            # no matrix product: its order of summation differs between machines
            compression += np.multiply(values, weight, out=share)
        return Compressed(self._followed, compression)

    def put(self, where: NDArray[np.intp], other: Looks) -> None:
        """Replace some places by others that were computed up to the same moment."""
        for moment, values in self._looks.items():
            values[where] = other._looks[moment]
        stay = np.isin(self._followed, where, invert=True)
        self._followed = np.concatenate((self._followed[stay], where[other._followed]))
        pairs = zip(self._around, other._around, strict=True)
        self._around = [np.concatenate((values[stay], others)) for values, others in pairs]

    def _follow(self, look: int) -> None:
        """Choose the places to follow until the next look: those that may exceed the threshold."""
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
    """Weights of the looks around a moment, a number of moments after the middle one.

    They minimise the mean square error for a signal with a flat spectrum up to the end of the band (Wiener
    1949), whose autocorrelation is sin θ/θ.
    """
    at = np.arange(1 - _SIDE, _SIDE + 1)
    correlation = np.sinc(_REACH / math.pi * (at[:, np.newaxis] - at)) + _NOISE * np.eye(len(at))
    found = np.linalg.solve(correlation, np.sinc(_REACH / math.pi * (at - since / stride)))
    return tuple(np.float32(weight) for weight in found)
