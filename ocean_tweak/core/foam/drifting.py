# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam at places on no grid, which drift with it: so the foam of a sum repeats with none of its patches."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..numerics.memo import total_bytes
from .looks import Looks
from .model import Births, FoamModel, Whitecaps, breaking_of, seen

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: gives the compression of the sea at places in m, at a time in s
CompressionAt = Callable[[Array, Array, Fraction], RealArray]


class DriftingFoam:
    """Births of foam at some places; where it lies in windrows, also at the places that it is drawn from.

    Whoever wants the foam of a time first lets what is `missing` be remembered. Times ascend, or it begins
    anew; in a loop, where windrows stand still and foam drifts past them, it always does.
    """

    def __init__(self, model: FoamModel, compression_at: CompressionAt, x: Array, y: Array) -> None:
        """`x` and `y` are where the (places,) are at time 0, at rest, in m."""
        self._model = model
        self._compression_at = compression_at
        self._x, self._y = x, y
        self._births: Births | None = None
        self._looks: Looks | None = None
        self._last = 0
        # how far windrows have moved past the foam, and of the places that it is drawn from x, y and share
        self._past = (0.0, 0.0)
        self._drawn: tuple[Array, Array, RealArray] | None = None

    @property
    def nbytes(self) -> int:
        """Bytes of the places, their births, and the looks that these are from."""
        return total_bytes((self._x, self._y, self._births, self._looks, *(self._drawn or ())))

    def missing(self, time: float | Fraction) -> range:
        """Lattice times that are to be remembered, in this order, before the foam of a time is known."""
        model = self._model
        now = model.reduced(time)
        index = math.floor(now / model.step)
        first = index - model.memory + 1
        if self._births is None or self._last > index or self._past != self._past_at(now):
            self._births = None
            self._past = self._past_at(now)
            return range(first, index + 1)
        # births of lattice times that are forgotten by now fade below the faintest: they may stay
        return range(max(first, self._last + 1), index + 1)

    def remember(self, index: int) -> None:
        """Add what is born at a lattice time."""
        x, y, _ = self._sources
        if self._births is None or self._looks is None:
            self._births = Births(self._model, x.shape, index)
            self._looks = Looks(partial(self._look, x, y), self._model.stride, self._model.threshold)
        self._births.add(self._looks.at(index), index)
        self._last = index

    def _look(self, x: Array, y: Array, index: int) -> RealArray:
        """The compression at a lattice time of places that are at x and y in m at time 0."""
        then = index * self._model.step
        return self._compression_at(*self._moved(x, y, then), self._model.reduced(then))

    def whitecaps(self, time: float | Fraction) -> Whitecaps:
        """(places,) foam where they are at a time: what breaks, and what is left of what is remembered."""
        model = self._model
        now = model.reduced(time)
        breaking = breaking_of(model, self._compression_at(*self.places(now), now))
        if self._births is None:
            return seen(breaking, breaking, np.zeros_like(breaking))
        self._births.settle()
        foam, age = self._births.left(now)
        if model.windrows is not None:
            count, (_, _, share) = self._x.size, self._sources
            own, drawn = (foam[:count], age[:count]), (foam[count:], age[count:])
            foam, age = model.windrows.drawn_out(*own, *drawn, share)
        return seen(breaking, foam, age)

    def places(self, time: Fraction) -> tuple[Array, Array]:
        """x and y of the places at a time, at rest, m."""
        return self._moved(self._x, self._y, time)

    def _moved(self, x: Array, y: Array, time: Fraction) -> tuple[Array, Array]:
        drift_x, drift_y = self._model.drift
        return x + float(time) * drift_x, y + float(time) * drift_y

    def _past_at(self, now: Fraction) -> tuple[float, float]:
        """x and y in m by which windrows have moved more than foam by now."""
        windrows_x, windrows_y = self._model.drifted(now)
        foam_x, foam_y = (float(now) * drift for drift in self._model.drift)
        return windrows_x - foam_x, windrows_y - foam_y

    @property
    def _sources(self) -> tuple[Array, Array, RealArray]:
        """Where births are wanted, x and y in m at time 0, and the share of those that are not the places."""
        windrows = self._model.windrows
        if windrows is None:
            return self._x, self._y, np.empty(0, np.float32)
        if self._drawn is None or self._births is None:
            past_x, past_y = self._past
            x, y, share = windrows.sources(self._x - past_x, self._y - past_y)
            self._drawn = np.concatenate((self._x, x + past_x)), np.concatenate((self._y, y + past_y)), share
        return self._drawn


def whitecaps_at(
    model: FoamModel, compression_at: CompressionAt, x: Array, y: Array, time: float | Fraction
) -> Whitecaps:
    """(places,) foam at rest positions x and y in m at a time alone: each looks back along its own drift."""
    now = float(model.reduced(time))
    foam = DriftingFoam(model, compression_at, x - now * model.drift[0], y - now * model.drift[1])
    for index in foam.missing(time):
        foam.remember(index)
    return foam.whitecaps(time)
