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
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..numerics.interpolation import between, close
from ..numerics.memo import MEMO, total_bytes
from ..numerics.threads import default_workers, row_blocks, run_blocks
from . import laying
from .looks import Compressed, Looks, stride_of
from .windrows import Windrows

RealArray = NDArray[np.floating]
Array = NDArray[np.float64]

#: lattice times in a second, at the most
LATTICE_RATE = 8

#: foam thinner than this is none
FAINTEST = 2.0**-6

#: half-lives since the birth of foam after which it certainly is none, with the sign of an exponent
_LONG_GONE = np.float32(math.log2(FAINTEST) - 1.0)

#: what it takes to fade and lay old foam on a sample, in numbers to be transformed
_WORK_OF_OLD_FOAM = 6

#: from no foam to full foam the compression rises by this share of the threshold
_SOFTNESS = 0.25

#: strength of what is as good as no foam
_NO_FOAM = 2.0**-10


@dataclass(frozen=True)
class FoamModel:
    """How foam is born and how it lives.

    threshold : compression at which c begins to rise from 0
    breaking_threshold : the same for a crest that is seen to break, where that is more: on coarse samples
        crests are compressed for long, and all but their tops is foam that spreads
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
    breaking_threshold: float = 0.0

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

    def strength(self, compression: RealArray, least: float = 0.0) -> RealArray:
        """c in 0…1, in the precision of the compression; nowhere less than `least`."""
        x = compression * compression.dtype.type(1.0 / (_SOFTNESS * self.threshold))
        x -= compression.dtype.type(1.0 / _SOFTNESS)
        np.clip(x, _rise_of(least) if least else 0.0, 1.0, out=x)
        factor = x * compression.dtype.type(-2.0)
        factor += compression.dtype.type(3.0)
        x *= x
        x *= factor
        return x


def _rise_of(strength: float) -> float:
    """Share of the way from no foam to full foam at which it is born so strong: the smoothstep's inverse."""
    return 0.5 - math.sin(math.asin(1.0 - 2.0 * strength) / 3.0)


def births(count: int = 8) -> tuple[Array, Array]:
    """Strengths c from the faintest to 1, so many to a halving, and the compressions over the threshold at
    which foam is born with each."""
    halvings = round(-math.log2(FAINTEST))
    strength = 2.0 ** ((np.arange(halvings * count) + 0.5) / count - halvings)
    return strength, 1.0 + _SOFTNESS * np.array([_rise_of(each) for each in strength])


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
        foam, age = laying.between(laying.between(here, beside, u), laying.between(above, across, u), v)
        return seen(where.read(self.breaking).astype(np.float32), foam, age)


class _Followed(NamedTuple):
    """Births at places that are the same for some lattice times.

    places, moved : as they are added
    most, since : of each place, B in units after the lattice time `zero`, and lattice times from there to it
    """

    places: NDArray[np.intp]
    moved: tuple[int, ...]
    most: RealArray
    since: NDArray[np.int8]
    zero: int


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
        self._followed: _Followed | None = None

    @property
    def nbytes(self) -> int:
        """Bytes of the births and their times, and of those that are followed."""
        followed = self._followed
        own = () if followed is None else (followed.most, followed.since)
        return total_bytes((self._latest, self._moments, *own))

    def add(self, compressed: Compressed, index: int, moved: tuple[int, ...] = (0,)) -> None:
        """Those of a lattice time, moved by whole samples along each axis; of equal ones the later counts.

        They are with all others from when these are `settled`.
        """
        places, compression = compressed
        followed = self._followed
        if followed is None or followed.places is not places or followed.moved != moved:
            self.settle()
            most, since = np.full(places.shape, -np.inf, np.float32), np.zeros(places.shape, np.int8)
            followed = self._followed = _Followed(places, moved, most, since, index)
        births = self._model.strength(compression.astype(np.float32, copy=False), _NO_FOAM)
        np.log2(births, out=births)
        births *= np.float32(self._halving / self._unit)
        np.rint(births, out=births)
        births += np.float32((index - followed.zero) / self._unit)
        newer = births >= followed.most
        np.maximum(followed.most, births, out=followed.most)
        # a twentieth of the time that copying where something is true takes
        later = np.int8(index - followed.zero) - followed.since
        later *= newer.view(np.int8)
        np.add(followed.since, later, out=followed.since)

    def settle(self) -> None:
        """Put what was born at places that are followed with what was born before."""
        followed, self._followed = self._followed, None
        if followed is None:
            return
        if followed.zero - self._zero > self._model.memory:
            self._latest -= np.float32(followed.zero - self._zero)
            self._zero = followed.zero
        born = np.flatnonzero(followed.most >= self._halving * math.log2(FAINTEST) / self._unit)
        births = np.take(followed.most, born)
        births *= np.float32(self._unit)
        births += np.float32(followed.zero - self._zero)
        places = np.take(followed.places, born)
        if any(followed.moved):
            axes = np.unravel_index(places, self._latest.shape)
            to = tuple(axis + by for axis, by in zip(axes, followed.moved, strict=True))
            places = np.ravel_multi_index(to, self._latest.shape, mode="wrap")
        newer = np.flatnonzero(births >= self._latest.take(places))
        places = np.take(places, newer)
        self._latest.put(places, np.take(births, newer))
        since = np.take(followed.since, np.take(born, newer))
        self._moments.put(places, since.astype(np.int32) + np.int32(followed.zero - self._first))

    def put(self, where: NDArray[np.intp], other: Births) -> None:
        """Have the births of other places instead of those of some, all settled."""
        self.settle()
        other.settle()
        self._latest[where] = other._latest + np.float32(other._zero - self._zero)
        self._moments[where] = other._moments + np.int32(other._first - self._first)

    def left(self, now: Fraction, part: slice = slice(None)) -> tuple[RealArray, RealArray]:
        """F of what is left by now, and its age in s; what is remembered beyond the faintest is none.

        part : of the places, along their first axis
        """
        model = self._model
        last = math.floor(now / model.step)
        # what is rounded is counted from the present: it does not depend on where the history began
        foam = self._latest[part] - np.float32(last - self._zero)
        foam -= np.float32(now / model.step - last)
        foam *= np.float32(1.0 / self._halving)
        # a power that is no normal number takes twenty times as long
        np.clip(foam, _LONG_GONE, np.float32(1.0), out=foam)
        np.exp2(foam, out=foam)
        foam *= foam >= FAINTEST
        age = ((last - self._first) - self._moments[part]).astype(np.float32)
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
        self,
        model: FoamModel,
        compression_at: Callable[[Fraction], RealArray],
        resolution: int,
        workers: int | None = None,
    ) -> None:
        """`compression_at` gives the (M, M) compression at a time; `resolution` is that of the sea, N.

        workers : threads that draw foam out, by default as many as help
        """
        self._model = model
        self._compression_at = compression_at
        self._resolution = resolution
        self._workers = workers
        self._births: Births | None = None
        self._looks = self._new_looks()
        self._drawing: laying.Drawing | None = None
        self._last = 0
        self._busy = threading.Lock()
        MEMO.watch("foam", self)
        #: is told of each moment that was looked at, and of how many
        self.tell: Callable[[int, int], None] = lambda done, count: None

    @property
    def nbytes(self) -> int:
        """Bytes of the births, of the looks that they are from, and of what draws them out."""
        return total_bytes((self._births, self._looks, self._drawing))

    def whitecaps(
        self,
        time: float | Fraction,
        compression: RealArray | None = None,
        out: Whitecaps | None = None,
    ) -> Whitecaps:
        """(N, N) foam at a time.

        compression : (M, M) of that time, where it is known already
        out : arrays to fill
        """
        now, n = self._model.reduced(time), self._resolution
        made = out or Whitecaps(*(np.empty((n, n), np.float32) for _ in Whitecaps._fields))
        workers = self._workers or default_workers(_WORK_OF_OLD_FOAM * n * n)
        with self._busy:
            if compression is None:
                compression = self._compression_at(now)
            breaking = breaking_of(self._model, compression)
            old = self._old_foam(now, len(breaking), workers) if self._model.memory else None
            finer = laying.Finer(len(breaking), n)

            def lay(rows: slice) -> None:
                def breaks(first: int, count: int) -> list[RealArray]:
                    return [laying.rows_of(breaking, first, count)]

                (new,) = finer.rows(rows, breaks, laying.linear)
                foam = (new, np.zeros_like(new)) if old is None else finer.rows(rows, old, laying.between)
                for whole, part in zip(made, seen(new, *foam), strict=True):
                    whole[rows] = part

            # as many rows of the foam's own samples in a block, however many are made of them
            run_blocks(lay, row_blocks(n, max(1, len(breaking) ** 2 // n)), workers)
        return made

    def _old_foam(self, now: Fraction, n: int, workers: int) -> Callable[[int, int], laying.Foam]:
        """Gives so many rows, from one on, of what is left of earlier foam where it lies now, and its age."""
        model = self._model
        births = self._births_until(math.floor(now / model.step), n)
        left = np.empty((n + 1, n + 1), np.float32), np.empty((n + 1, n + 1), np.float32)

        def fill(rows: slice) -> None:
            left[0][rows, :-1], left[1][rows, :-1] = births.left(now, rows)

        run_blocks(fill, row_blocks(n, n), workers)
        drifted, drift = model.drifted(now), [v * float(now) for v in model.drift]
        past = [a - b for a, b in zip(drift, drifted, strict=True)]
        if any(past):  # windrows stand still
            for whole, moved in zip(left, laying.laid(left, self._samples(past), None, 0, n), strict=True):
                whole[:-1, :-1] = moved
        for field in left:
            close(field)
        return partial(laying.laid, left, self._samples(drifted), self._drawing)

    def _samples(self, by: Sequence[float]) -> list[float]:
        """Rows and columns on from which foam is read that has moved by x and y in m."""
        return [-metres / self._model.spacing for metres in reversed(by)]

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
        births.settle()
        is_new = self._births is None
        self._births, self._last = births, index
        if is_new:
            if self._model.windrows is not None and self._drawing is None:
                self._drawing = laying.Drawing(self._model.windrows, samples, self._model.spacing)
            MEMO.trim()
        return births

    def _moved(self, index: int) -> tuple[int, int]:
        """Whole samples by which rows and columns of a lattice time are moved onto the drifting grid."""
        time, spacing = float(index * self._model.step), self._model.spacing
        x, y = (round(-time * v / spacing) for v in self._model.drift)
        return y, x


def breaking_of(model: FoamModel, compression: RealArray) -> RealArray:
    """c of the present, float32."""
    result = np.zeros(compression.shape, np.float32)
    threshold = max(model.threshold, model.breaking_threshold)
    found = compression > threshold
    strength = model.strength(compression[found] * (model.threshold / threshold))
    result[found] = strength * (strength >= FAINTEST)
    return result


def seen(breaking: RealArray, old: RealArray, age: RealArray) -> Whitecaps:
    """What breaks now over what is left."""
    foam = np.maximum(old, breaking)
    foam *= foam >= FAINTEST
    breaking = breaking * (foam > 0.0)
    return Whitecaps(foam, breaking, age * ((foam > 0.0) & (breaking == 0.0)))
