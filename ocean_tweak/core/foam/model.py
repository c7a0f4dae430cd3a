# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam: whitecaps that are born where the surface is compressed, drift and fade. The only field with a
history.

F(x, t) is the maximum of 2^(-age/T)·c(x - v·age, t - age) over the present and a fixed lattice of earlier
times: c rises from 0 to 1 where the compression exceeds a threshold, T is the half-life, v the drift. Terms
below 1/64 are dropped, so the history is finite and any frame can be computed alone. The c of the present is
the crest breaking now; the age of the visible foam is that of the largest term.

Instead of F, a grid that drifts along stores at each point B = t + T·log₂c of the strongest remaining birth,
and its lattice time: F is 2^((B - t)/T), and the B of several times is their maximum, which is exact and
independent of the order. So a sequence, a chunk of it and a single frame have the same bytes. The sea is not
computed at every lattice time: see `looks`.
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

#: largest number of lattice times per second
LATTICE_RATE = 8

#: foam below this counts as none
FAINTEST = 2.0**-6

#: lattice steps, half-life below which all foam but that of the present has vanished: shorter ones overflow
_LEAST_HALVING = 1e-9
#: minus the number of half-lives after which foam has certainly vanished
_LONG_GONE = np.float32(math.log2(FAINTEST) - 1.0)

#: cost of fading and laying old foam per sample, in numbers to be transformed
_WORK_OF_OLD_FOAM = 6

#: rise of the compression from no foam to full foam, as a fraction of the threshold
_SOFTNESS = 0.25

#: strength that is indistinguishable from no foam
_NO_FOAM = 2.0**-10


@dataclass(frozen=True)
class FoamModel:
    """Parameters of the birth and decay of a sea's foam.

    threshold : compression at which c begins to rise from 0
    breaking_threshold : the same for visibly breaking crests, if that is higher: on coarse samples crests
        stay compressed for long, and all but their tops is spreading foam
    half_life : T in s
    drift : x and y in m/s
    spacing : between samples, m
    loop_duration : of the sea, s
    windrows : of the old foam; None for none
    frequency : highest frequency of the strains that must be resolved, rad/s
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
        """Number of lattice times from one look at the sea to the next."""
        return stride_of(self.frequency, 1.0 / LATTICE_RATE)

    @property
    def step(self) -> Fraction:
        """Seconds between lattice times; a loop contains an integer number of looks."""
        if self.loop_duration is None:
            return Fraction(1, LATTICE_RATE)
        looks = max(1, math.floor(self.loop_duration * LATTICE_RATE / self.stride))
        return self.loop_duration / (looks * self.stride)

    @property
    def memory(self) -> int:
        """Number of lattice times that a frame depends on."""
        if self.half_life == 0.0 or math.isinf(self.threshold):
            return 0
        return math.floor(-math.log2(FAINTEST) * self.half_life / self.step) + 1

    def reduced(self, time: float | Fraction) -> Fraction:
        """The equivalent time in the first loop."""
        exact = Fraction(time)
        return exact if self.loop_duration is None else exact % self.loop_duration

    def drifted(self, now: Fraction) -> tuple[float, float]:
        """Offset (x, y) in m by which windrows have moved since time 0; in a loop they stand still."""
        time = float(now) if self.loop_duration is None else 0.0
        return self.drift[0] * time, self.drift[1] * time

    def strength(self, compression: RealArray, least: float = 0.0) -> RealArray:
        """c in 0…1, in the precision of the compression; at least `least` everywhere."""
        x = compression * compression.dtype.type(1.0 / (_SOFTNESS * self.threshold))
        x -= compression.dtype.type(1.0 / _SOFTNESS)
        np.clip(x, _rise_of(least) if least else 0.0, 1.0, out=x)
        factor = x * compression.dtype.type(-2.0)
        factor += compression.dtype.type(3.0)
        x *= x
        x *= factor
        return x


def _rise_of(strength: float) -> float:
    """Inverse of the smoothstep: the fraction of the rise at which foam of this strength is born."""
    return 0.5 - math.sin(math.asin(1.0 - 2.0 * strength) / 3.0)


def births(count: int = 8) -> tuple[Array, Array]:
    """Strengths c from the faintest to 1, a given number per factor of 2, and the compressions, relative to
    the threshold, at which each is born."""
    halvings = round(-math.log2(FAINTEST))
    strength = 2.0 ** ((np.arange(halvings * count) + 0.5) / count - halvings)
    return strength, 1.0 + _SOFTNESS * np.array([_rise_of(each) for each in strength])


class Whitecaps(NamedTuple):
    """Foam on samples or at places, float32 arrays of one shape, named like their channels.

    foam : F in 0…1, new and old foam together
    breaking : c of the present in 0…1, at most `foam`
    foam_age : age in s of the visible foam; 0 where a crest breaks, and where there is no foam
    """

    foam: RealArray
    breaking: RealArray
    foam_age: RealArray

    def over(self, foam: RealArray, breaking: RealArray, age: RealArray) -> Whitecaps:
        """With other foam at the same places: of both, that of which there is more."""
        more = foam > self.foam
        joined = np.where(more, foam, self.foam), np.maximum(breaking, self.breaking)
        return seen(joined[1], joined[0], np.where(more, age, self.foam_age))

    def at(self, x: Array, y: Array, side: float) -> Whitecaps:
        """Foam of a periodic tile of (N, N) samples and `side` m, interpolated at places in m."""
        n = len(self.foam)
        where = between(y * (n / side), x * (n / side), (n, n))
        here, beside, above, across = ((self.foam[at], self.foam_age[at]) for at in where.corners)
        u, v = where.u.astype(np.float32), where.v.astype(np.float32)
        foam, age = laying.between(laying.between(here, beside, u), laying.between(above, across, u), v)
        return seen(where.read(self.breaking).astype(np.float32), foam, age)


class _Followed(NamedTuple):
    """Births at a set of places that stays the same for several lattice times.

    places, moved : the arguments of `add`
    most, since : for each place, B in units after the lattice time `zero`, and lattice times from there to
        the birth
    """

    places: NDArray[np.intp]
    moved: tuple[int, ...]
    most: RealArray
    since: NDArray[np.int8]
    zero: int


class Births:
    """At each place, the birth of which most remains, now and at any later time.

    B is counted in lattice times relative to a recent one, in multiples of a power of two that float32
    represents exactly, so the choice of origin does not matter.
    """

    def __init__(self, model: FoamModel, shape: tuple[int, ...], first: int) -> None:
        """Start without births; `first` is the first lattice time that may have any."""
        self._model = model
        self._first = self._zero = first
        self._halving = model.half_life / float(model.step)
        self._unit = 2.0 ** (math.ceil(math.log2(4 * model.memory + 4)) - 23)
        self._latest = np.full(shape, -np.inf, np.float32)  # B
        self._moments = np.zeros(shape, np.int32)  # lattice times after the first
        self._followed: _Followed | None = None

    @property
    def nbytes(self) -> int:
        """Bytes of the births, their times, and the followed places."""
        followed = self._followed
        own = () if followed is None else (followed.most, followed.since)
        return total_bytes((self._latest, self._moments, *own))

    def add(self, compressed: Compressed, index: int, moved: tuple[int, ...] = (0,)) -> None:
        """Add the births of a lattice time, shifted by whole samples along each axis; of equal births the
        later one counts.

        They are merged with the others by `settle`.
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
        # takes a twentieth of the time of a masked copy
        later = np.int8(index - followed.zero) - followed.since
        later *= newer.view(np.int8)
        np.add(followed.since, later, out=followed.since)

    def settle(self) -> None:
        """Merge births at the followed places into the earlier ones."""
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
        """Replace the births of some places by those of others, all settled."""
        self.settle()
        other.settle()
        self._latest[where] = other._latest + np.float32(other._zero - self._zero)
        self._moments[where] = other._moments + np.int32(other._first - self._first)

    def left(self, now: Fraction, part: slice = slice(None)) -> tuple[RealArray, RealArray]:
        """Remaining F at present, and its age in s; foam fainter than the limit counts as none.

        part : of the places, along their first axis
        """
        model = self._model
        last = math.floor(now / model.step)
        # rounding is relative to the present, so it does not depend on where the history began
        foam = self._latest[part] - np.float32(last - self._zero)
        foam -= np.float32(now / model.step - last)
        foam *= np.float32(1.0 / max(self._halving, _LEAST_HALVING))
        # a subnormal result takes twenty times as long
        np.clip(foam, _LONG_GONE, np.float32(1.0), out=foam)
        np.exp2(foam, out=foam)
        foam *= foam >= FAINTEST
        age = ((last - self._first) - self._moments[part]).astype(np.float32)
        age *= np.float32(model.step)
        age += np.float32(now - last * model.step)
        age *= foam > 0.0
        return foam, age


class FoamHistory:
    """Births of foam up to a lattice time, on a grid that drifts along.

    A sequence keeps it between frames; a single frame creates its own. One thread at a time extends it while
    others wait.
    """

    def __init__(
        self,
        model: FoamModel,
        compression_at: Callable[[Fraction], RealArray],
        resolution: int,
        workers: int | None = None,
    ) -> None:
        """`compression_at` returns the (M, M) compression at a time; `resolution` is that of the sea, N.

        workers : threads for drawing out foam, by default a suitable number
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
        #: called after each look, with the number of looks so far and in total
        self.tell: Callable[[int, int], None] = lambda done, count: None

    @property
    def nbytes(self) -> int:
        """Bytes of the births, of the looks, and of the windrow arrays."""
        return total_bytes((self._births, self._looks, self._drawing))

    def whitecaps(
        self,
        time: float | Fraction,
        compression: RealArray | None = None,
        out: Whitecaps | None = None,
    ) -> Whitecaps:
        """(N, N) foam at a time.

        compression : (M, M) at that time, if already known
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

            # a fixed number of rows of the foam's own samples per block, whatever the resolution of the
            # result
            run_blocks(lay, row_blocks(n, max(1, len(breaking) ** 2 // n)), workers)
        return made

    def _old_foam(self, now: Fraction, n: int, workers: int) -> Callable[[int, int], laying.Foam]:
        """A function that returns rows of the remaining older foam at its present position, and its age."""
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
        """Offset in rows and columns at which foam is read that has moved by (x, y) in m."""
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
        """Shift in whole samples from the rows and columns of a lattice time to the drifting grid."""
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
    """Combine breaking crests with remaining older foam."""
    foam = np.maximum(old, breaking)
    foam *= foam >= FAINTEST
    breaking = breaking * (foam > 0.0)
    return Whitecaps(foam, breaking, age * ((foam > 0.0) & (breaking == 0.0)))
