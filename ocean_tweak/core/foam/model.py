# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam: whitecaps that are born where the surface is compressed, drift and fade. The one thing with a memory.

F(x, t) is the largest of 2^(-age/T)·c(x - v·age, t - age) over the present and over a fixed lattice of times
before it: c is 1 where the compression exceeds a threshold, T the half-life, v the drift. Terms below 1/64
are dropped, so the memory is finite and any frame can be made alone. The present's c is the crest that breaks
now; the age of what is seen is that of the largest term.

Instead of F, a grid that drifts along keeps the latest birth B = t + T·log₂c of foam at each point, and the
lattice time of that birth: F is 2^((B - t)/T), and B of several times is their maximum, which neither rounds
nor depends on the order. So a sequence, a chunk of it and a single frame have the same bytes. The sea is not
made at each lattice time: see `looks`.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..numerics.interpolation import between, resampled, wrapped
from ..numerics.memo import MEMO, total_bytes
from .looks import Compressed, Looks, stride_of
from .windrows import Windrows

RealArray = NDArray[np.floating]
Array = NDArray[np.float64]

#: lattice times in a second, at the most
LATTICE_RATE = 8

#: foam thinner than this is none
FAINTEST = 2.0**-6

#: rows of a grid that are drawn out at once
_ROWS = 64

#: from no foam to full foam the compression rises by this share of the threshold
_SOFTNESS = 0.25


@dataclass(frozen=True)
class FoamModel:
    """How foam is born and how it lives.

    threshold : compression at which c begins to rise from 0
    half_life : T in s
    drift : x and y in m/s
    spacing : between samples, m
    loop_duration : of the sea, s
    windrows : in which old foam lies; None where there are none
    frequency : up to which the strains that it is born of must be known, rad/s
    """

    threshold: float
    half_life: float
    drift: tuple[float, float]
    spacing: float
    loop_duration: Fraction | None = None
    windrows: Windrows | None = None
    frequency: float = math.inf

    @property
    def stride(self) -> int:
        """Lattice times from one at which the sea is looked at to the next."""
        return stride_of(self.frequency, 1.0 / LATTICE_RATE)

    @property
    def step(self) -> Fraction:
        """Seconds between lattice times; in a loop, a whole number of looks fits."""
        if self.loop_duration is None:
            return Fraction(1, LATTICE_RATE)
        looks = max(1, math.floor(self.loop_duration * LATTICE_RATE / self.stride))
        return self.loop_duration / (looks * self.stride)

    @property
    def memory(self) -> int:
        """Lattice times that a frame depends on."""
        if self.half_life == 0.0 or math.isinf(self.threshold):
            return 0
        return math.floor(-math.log2(FAINTEST) * self.half_life / self.step) + 1

    def reduced(self, time: float | Fraction) -> Fraction:
        """The time of the sea's first loop that looks alike."""
        exact = Fraction(time)
        return exact if self.loop_duration is None else exact % self.loop_duration

    def drifted(self, now: Fraction) -> tuple[float, float]:
        """x and y in m by which windrows have moved since 0 s; in a loop they stand still."""
        time = float(now) if self.loop_duration is None else 0.0
        return self.drift[0] * time, self.drift[1] * time

    def strength(self, compression: RealArray) -> Array:
        """c in 0…1."""
        x = np.clip((compression.astype(np.float64) / self.threshold - 1.0) / _SOFTNESS, 0.0, 1.0)
        return x * x * (3.0 - 2.0 * x)


def births(count: int = 8) -> tuple[Array, Array]:
    """Strengths c from the faintest to 1, so many to a halving, and the compressions over the threshold at
    which foam is born with each."""
    halvings = round(-math.log2(FAINTEST))
    strength = 2.0 ** ((np.arange(halvings * count) + 0.5) / count - halvings)
    x = 0.5 - np.sin(np.arcsin(1.0 - 2.0 * strength) / 3.0)  # the smoothstep's inverse
    return strength, 1.0 + _SOFTNESS * x


class Whitecaps(NamedTuple):
    """Foam on samples or at places, float32 arrays of one shape, named as the channels that they are.

    foam : F in 0…1, new and old foam together
    breaking : c of the present in 0…1, nowhere more than the foam
    foam_age : s since the birth of the foam that is seen; 0 where a crest breaks, and where there is no foam
    """

    foam: RealArray
    breaking: RealArray
    foam_age: RealArray

    def at(self, x: Array, y: Array, side: float) -> Whitecaps:
        """Those of a tile, (N, N) samples that repeat after `side` m, read at places in m."""
        n = len(self.foam)
        where = between(y * (n / side), x * (n / side), (n, n))
        here, beside, above, across = ((self.foam[at], self.foam_age[at]) for at in where.corners)
        u, v = where.u.astype(np.float32), where.v.astype(np.float32)
        foam, age = _between(_between(here, beside, u), _between(above, across, u), v)
        return seen(where.read(self.breaking).astype(np.float32), foam, age)


class Births:
    """At each place the birth of which there is most left, by now and at any later time.

    B counts in lattice times from one that follows the newest, in multiples of a power of two so small that
    float32 holds them all: so it does not matter from where they are counted.
    """

    def __init__(self, model: FoamModel, shape: tuple[int, ...], first: int) -> None:
        """No births yet; `first` is the first lattice time of which there may be some."""
        self._model = model
        self._first = self._zero = first
        self._halving = model.half_life / float(model.step)
        self._unit = 2.0 ** (math.ceil(math.log2(4 * model.memory + 4)) - 23)
        self._latest = np.full(shape, -np.inf, np.float32)  # B
        self._moments = np.zeros(shape, np.int32)  # lattice times after the first

    @property
    def nbytes(self) -> int:
        """Bytes of the births and their times."""
        return self._latest.nbytes + self._moments.nbytes

    def add(self, compressed: Compressed, index: int, moved: tuple[int, ...] = (0,)) -> None:
        """Those of a lattice time, moved by whole samples along each axis; of equal ones the later counts."""
        if index - self._zero > self._model.memory:
            self._latest -= np.float32(index - self._zero)
            self._zero = index
        strength = self._model.strength(compressed.compression)
        born = strength >= FAINTEST
        births = np.rint(self._halving / self._unit * np.log2(strength[born])).astype(np.float32)
        births *= np.float32(self._unit)
        births += np.float32(index - self._zero)
        places = compressed.places[born]
        if any(moved):
            axes = np.unravel_index(places, self._latest.shape)
            to = tuple(axis + by for axis, by in zip(axes, moved, strict=True))
            places = np.ravel_multi_index(to, self._latest.shape, mode="wrap")
        newer = births >= self._latest.take(places)
        places = places[newer]
        self._latest.put(places, births[newer])
        self._moments.put(places, index - self._first)

    def left(self, now: Fraction) -> tuple[RealArray, RealArray]:
        """F of what is left by now, and its age in s; what is remembered beyond the faintest is none."""
        model = self._model
        last = math.floor(now / model.step)
        # what is rounded is counted from the present: it does not depend on where the history began
        foam = self._latest - np.float32(last - self._zero)
        foam -= np.float32(now / model.step - last)
        foam *= np.float32(1.0 / self._halving)
        np.exp2(foam, out=foam)
        foam *= foam >= FAINTEST
        age = ((last - self._first) - self._moments).astype(np.float32)
        age *= np.float32(model.step)
        age += np.float32(now - last * model.step)
        age *= foam > 0.0
        return foam, age


class FoamHistory:
    """Births of foam up to a lattice time, on the grid that drifts along.

    It is what a sequence keeps between its frames; without it, a frame makes its own. One thread at a time
    goes on with it, and others wait.
    """

    def __init__(
        self, model: FoamModel, compression_at: Callable[[Fraction], RealArray], resolution: int
    ) -> None:
        """`compression_at` gives the (M, M) compression at a time; `resolution` is that of the sea, N."""
        self._model = model
        self._compression_at = compression_at
        self._resolution = resolution
        self._births: Births | None = None
        self._looks = self._new_looks()
        self._drawing: _Drawing | None = None
        self._last = 0
        self._busy = threading.Lock()
        MEMO.watch("foam", self)
        #: is told of each moment that was looked at, and of how many
        self.tell: Callable[[int, int], None] = lambda done, count: None

    @property
    def nbytes(self) -> int:
        """Bytes of the births, of the looks that they are from, and of what draws them out."""
        return total_bytes((self._births, self._looks, self._drawing))

    def whitecaps(self, time: float | Fraction) -> Whitecaps:
        """(N, N) foam at a time."""
        model, n = self._model, self._resolution
        now = model.reduced(time)
        with self._busy:
            compression = self._compression_at(now)
            breaking = resampled(breaking_of(model, compression), n)
            if model.memory == 0:
                return seen(breaking, breaking, np.zeros_like(breaking))
            foam, age = self._births_until(math.floor(now / model.step), len(compression)).left(now)
            drifted, drift = model.drifted(now), [v * float(now) for v in model.drift]
            foam, age = _moved(foam, age, [a - b for a, b in zip(drift, drifted, strict=True)], model.spacing)
            if self._drawing is not None:
                foam, age = self._drawing.drawn_out(foam, age)
        foam, age = _moved(foam, age, drifted, model.spacing)
        for axis in (0, 1):
            foam, age = _stretched(foam, age, axis, n)
        return seen(breaking, foam, age)

    def _new_looks(self) -> Looks:
        model, compression_at = self._model, self._compression_at
        return Looks(
            lambda index: compression_at(model.reduced(index * model.step)), model.stride, model.threshold
        )

    def _births_until(self, index: int, samples: int) -> Births:
        first = index - self._model.memory + 1
        if self._births is None or not self._last <= index:
            self._births, self._looks = None, self._new_looks()
            self._last = first - 1
        # births of lattice times that are forgotten by now fade below the faintest: they may stay
        first = max(first, self._last + 1)
        births = self._births
        for step in range(first, index + 1):
            compressed = self._looks.at(step)
            if births is None:
                births = Births(self._model, (samples, samples), first)
            births.add(compressed, step, self._moved(step))
            self.tell(step - first + 1, index + 1 - first)
        assert births is not None
        is_new = self._births is None
        self._births, self._last = births, index
        if is_new:
            if self._model.windrows is not None and self._drawing is None:
                self._drawing = _Drawing(self._model.windrows, samples, self._model.spacing)
            MEMO.trim()
        return births

    def _moved(self, index: int) -> tuple[int, int]:
        """Whole samples by which rows and columns of a lattice time are moved onto the drifting grid."""
        time, spacing = float(index * self._model.step), self._model.spacing
        x, y = (round(-time * v / spacing) for v in self._model.drift)
        return y, x


class _Drawing:
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

    def drawn_out(self, foam: RealArray, age: RealArray) -> tuple[RealArray, RealArray]:
        """Old foam and its age as they lie in the windrows."""
        n = len(foam)
        fields = wrapped(foam).ravel(), wrapped(age).ravel()
        result = np.empty_like(foam), np.empty_like(age)
        for first in range(0, n, _ROWS):
            part = slice(first, first + _ROWS)
            at = self._first[part].astype(np.intp)
            here, beside, above, across = (
                [np.take(field[offset:], at) for field in fields] for offset in (0, 1, n + 1, n + 2)
            )
            u = self._u[part]
            drawn = _between(_between(here, beside, u), _between(above, across, u), self._v[part])
            made = self._windrows.drawn_out(foam[part], age[part], *drawn, self._share[part])
            for whole, rows in zip(result, made, strict=True):
                whole[part] = rows
        return result


def breaking_of(model: FoamModel, compression: RealArray) -> RealArray:
    """c of the present, float32."""
    result = np.zeros(compression.shape, np.float32)
    found = compression > model.threshold
    strength = model.strength(compression[found])
    result[found] = strength * (strength >= FAINTEST)
    return result


def seen(breaking: RealArray, old: RealArray, age: RealArray) -> Whitecaps:
    """What breaks now over what is left."""
    foam = np.maximum(old, breaking)
    foam *= foam >= FAINTEST
    breaking = breaking * (foam > 0.0)
    return Whitecaps(foam, breaking, age * ((foam > 0.0) & (breaking == 0.0)))


def _moved(
    foam: RealArray, age: RealArray, by: Sequence[float], spacing: float
) -> tuple[RealArray, RealArray]:
    """Periodic foam and its age moved by x and y in m; see `_between`."""
    for axis, metres in enumerate(reversed(by)):
        foam, age = _shifted(foam, age, axis, -metres / spacing)
    return foam, age


def _shifted(foam: RealArray, age: RealArray, axis: int, shift: float) -> tuple[RealArray, RealArray]:
    """Periodic foam and its age read `shift` samples on along an axis; see `_between`."""
    whole = math.floor(shift)
    share = np.float32(shift - whole)
    if shift == 0.0:
        return foam, age
    near = np.roll(foam, -whole, axis), np.roll(age, -whole, axis)
    return near if share == 0.0 else _between(near, [np.roll(field, -1, axis) for field in near], share)


def _stretched(foam: RealArray, age: RealArray, axis: int, samples: int) -> tuple[RealArray, RealArray]:
    """Periodic foam and its age on so many samples along an axis; see `_between`."""
    own = foam.shape[axis]
    if own == samples:
        return foam, age
    place = np.arange(samples) * (own / samples)
    before = place.astype(np.intp)
    share = (place - before).astype(np.float32).reshape((-1, 1) if axis == 0 else (1, -1))
    near, far = ([np.take(field, at, axis) for field in (foam, age)] for at in (before, (before + 1) % own))
    return _between(near, far, share)


def _between(
    near: Sequence[RealArray], far: Sequence[RealArray], share: RealArray | np.float32
) -> tuple[RealArray, RealArray]:
    """Foam between samples, linear, and the age of that of the two which gives more of it.

    A mean of a new and an old birth would be the age of neither.
    """
    (foam, age), (other_foam, other_age) = near, far
    other = share * other_foam
    own = foam - share * foam
    return own + other, np.where(other > own, other_age, age)
