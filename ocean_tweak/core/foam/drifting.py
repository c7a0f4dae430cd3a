# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam at arbitrary places that drift with it, so that the foam of a sum of patches does not repeat with any
of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from ..numerics.memo import total_bytes
from .looks import Looks
from .model import Births, FoamModel, Whitecaps, breaking_of, seen

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: function that returns the compression of the sea at places in m and a time in s
CompressionAt = Callable[[Array, Array, Fraction], RealArray]


class _Past:
    """Births at places that drift along.

    model : of the foam
    x, y : (places,) rest positions at time 0, m
    """

    def __init__(self, model: FoamModel, compression_at: CompressionAt, x: Array, y: Array) -> None:
        self._model = model
        self._compression_at = compression_at
        self._x, self._y = x, y
        self._births: Births | None = None
        self._looks = Looks(self._look, model.stride, model.threshold)

    @property
    def nbytes(self) -> int:
        """Bytes of the places, their births, and the looks that these are from."""
        return total_bytes((self._x, self._y, self._births, self._looks))

    def remember(self, index: int) -> None:
        """Add what is born at a lattice time."""
        if self._births is None:
            self._births = Births(self._model, self._x.shape, index)
        self._births.add(self._looks.at(index), index)

    def left(self, now: Fraction) -> tuple[RealArray, RealArray]:
        """Remaining foam of the births at present, and its age in s."""
        assert self._births is not None
        self._births.settle()
        return self._births.left(now)

    def put(self, where: NDArray[np.intp], other: _Past) -> None:
        """Replace some places by others whose births are known up to the same lattice time."""
        assert self._births is not None
        assert other._births is not None
        self._x[where], self._y[where] = other._x, other._y
        self._births.put(where, other._births)
        self._looks.put(where, other._looks)

    def _look(self, index: int) -> RealArray:
        """Sample the compression at a lattice time."""
        then = index * self._model.step
        places = moved(self._model, self._x, self._y, then)
        return self._compression_at(*places, self._model.reduced(then))


class DriftingFoam:
    """Births of foam at some places; with windrows, also at the source places of drawn-out foam.

    Before the foam of a time is requested, everything `missing` must be remembered. Times must ascend, or the
    history restarts; in a loop it always restarts, as windrows stand still and foam drifts past them.
    """

    def __init__(self, model: FoamModel, compression_at: CompressionAt, x: Array, y: Array) -> None:
        """`x` and `y` are the rest positions of the (places,) at time 0, in m."""
        self._model = model
        self._compression_at = compression_at
        self._x, self._y = x, y
        rows = model.windrows
        # for foam that stays where it was born
        self._staying = model if rows is None else replace(model, half_life=rows.stays(model.half_life))
        self._own: _Past | None = None
        self._drawn: _Past | None = None
        self._share = np.empty(0, np.float32)
        # the lattice time up to which everything is remembered, and that from which staying foam is counted
        self._last = self._counts_from = 0
        # offset (x, y) in m by which windrows have moved relative to the foam
        self._past = (0.0, 0.0)

    @property
    def nbytes(self) -> int:
        """Bytes of the places, their births, and the looks that these are from."""
        return total_bytes((self._own, self._drawn, self._share))

    def missing(self, time: float | Fraction) -> range:
        """Lattice times that must be remembered, in this order, before the foam of a time is known."""
        model = self._model
        now = model.reduced(time)
        index = math.floor(now / model.step)
        first = index - model.memory + 1
        if self._own is None or self._last > index or self._past != self._past_at(now):
            self._own = self._drawn = None
            self._past = self._past_at(now)
            self._counts_from = index - self._staying.memory + 1
            return range(first, index + 1)
        # older births have faded below the faintest foam and may stay
        return range(max(first, self._last + 1), index + 1)

    def remember(self, index: int) -> None:
        """Add what is born at a lattice time."""
        if self._own is None:
            self._own = _Past(self._staying, self._compression_at, self._x, self._y)
            if self._model.windrows is not None:
                past_x, past_y = self._past
                x, y, self._share = self._model.windrows.sources(self._x - past_x, self._y - past_y)
                self._drawn = _Past(self._model, self._compression_at, x + past_x, y + past_y)
        if index >= self._counts_from:
            self._own.remember(index)
        if self._drawn is not None:
            self._drawn.remember(index)
        self._last = index

    def put(self, where: NDArray[np.intp], other: DriftingFoam) -> None:
        """Replace some places by others whose foam is remembered up to the same lattice time."""
        self._x[where], self._y[where] = other._x, other._y
        if self._own is not None and other._own is not None:
            self._own.put(where, other._own)
        if self._drawn is not None and other._drawn is not None:
            self._drawn.put(where, other._drawn)
            self._share[where] = other._share

    def whitecaps(self, time: float | Fraction) -> Whitecaps:
        """(places,) foam at the places at a time: breaking crests, and what remains of remembered births."""
        model = self._model
        now = model.reduced(time)
        places = moved(model, self._x, self._y, now)
        breaking = breaking_of(model, self._compression_at(*places, now))
        if self._own is None:
            return seen(breaking, breaking, np.zeros_like(breaking))
        foam, age = self._own.left(now)
        if model.windrows is not None and self._drawn is not None:
            own = foam if self._staying.half_life < model.half_life else model.windrows.staying(foam, age)
            foam, age = model.windrows.drawn_out(own, age, *self._drawn.left(now), self._share)
        return seen(breaking, foam, age)

    def _past_at(self, now: Fraction) -> tuple[float, float]:
        """Offset (x, y) in m by which windrows have moved farther than the foam."""
        windrows_x, windrows_y = self._model.drifted(now)
        foam_x, foam_y = (float(now) * drift for drift in self._model.drift)
        return windrows_x - foam_x, windrows_y - foam_y


def moved(model: FoamModel, x: Array, y: Array, time: Fraction) -> tuple[Array, Array]:
    """Positions at a time of places that are at (x, y) in m at time 0."""
    drift_x, drift_y = model.drift
    return x + float(time) * drift_x, y + float(time) * drift_y


def whitecaps_at(
    model: FoamModel, compression_at: CompressionAt, x: Array, y: Array, time: float | Fraction
) -> Whitecaps:
    """(places,) foam at rest positions x and y in m at a single time; each place looks back along its own
    drift."""
    now = float(model.reduced(time))
    foam = DriftingFoam(model, compression_at, x - now * model.drift[0], y - now * model.drift[1])
    for index in foam.missing(time):
        foam.remember(index)
    return foam.whitecaps(time)
