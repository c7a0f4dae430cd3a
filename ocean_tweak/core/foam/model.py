# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam: whitecaps that are born where the surface is compressed, drift and fade. The one thing with a memory.

F(x, t) is the largest of 2^(-age/T)·c(x - v·age, t - age) over the present and over a fixed lattice of times
before it: c is 1 where the compression exceeds a threshold, T the half-life, v the drift. Terms below 1/512
are dropped, so the memory is finite and any frame can be made alone.

Instead of F, a grid that drifts along keeps the latest birth B = t + T·log₂c of foam at each point: F is
2^((B - t)/T), and B of several times is their maximum, which neither rounds nor depends on the order. So a
sequence, a chunk of it and a single frame have the same bytes.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from ..numerics.memo import MEMO

RealArray = NDArray[np.floating]
Array = NDArray[np.float64]

#: lattice times in a second, at the most
LATTICE_RATE = 8

#: foam thinner than this is none
FAINTEST = 2.0**-9

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
    """

    threshold: float
    half_life: float
    drift: tuple[float, float]
    spacing: float
    loop_duration: Fraction | None = None

    @property
    def step(self) -> Fraction:
        """Seconds between lattice times; in a loop, a whole number of them fits."""
        if self.loop_duration is None:
            return Fraction(1, LATTICE_RATE)
        return self.loop_duration / max(1, math.floor(self.loop_duration * LATTICE_RATE))

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

    def birth(self, compression: RealArray, time: Fraction) -> Array:
        """B in s of the foam that is born at a time from a compression; -inf where there is none."""
        strength = self.strength(compression)
        result = np.full(strength.shape, -np.inf)
        foam = strength >= FAINTEST
        result[foam] = float(time) + self.half_life * np.log2(strength[foam])
        return result

    def strength(self, compression: RealArray) -> Array:
        """c in 0…1."""
        x = np.clip((compression.astype(np.float64) / self.threshold - 1.0) / _SOFTNESS, 0.0, 1.0)
        return x * x * (3.0 - 2.0 * x)


def strength_levels(count: int = 8) -> Array:
    """Compressions over the threshold at which foam is born with 2^-1 … 2^0 of its strength."""
    strength = 2.0 ** ((np.arange(count) + 0.5) / count - 1.0)
    x = 0.5 - np.sin(np.arcsin(1.0 - 2.0 * strength) / 3.0)  # the smoothstep's inverse
    return 1.0 + _SOFTNESS * x


class FoamHistory:
    """Births of foam up to a lattice time, on the grid that drifts along.

    It is what a sequence keeps between its frames; without it, a frame makes its own. One thread at a time
    goes on with it, and others wait.
    """

    def __init__(self, model: FoamModel, compression_at: Callable[[Fraction], RealArray]) -> None:
        """`compression_at` gives the (N, N) compression at a time."""
        self._model = model
        self._compression_at = compression_at
        self._births: Array | None = None
        self._last = 0
        self._busy = threading.Lock()
        MEMO.watch("foam", self)
        #: is told of each moment that was looked at, and of how many
        self.tell: Callable[[int, int], None] = lambda done, count: None

    @property
    def nbytes(self) -> int:
        """Bytes of the births."""
        births = self._births
        return 0 if births is None else births.nbytes

    def foam(self, time: float | Fraction) -> RealArray:
        """(N, N) float32 F in 0…1 at a time."""
        model = self._model
        now = model.reduced(time)
        with self._busy:
            present = model.strength(self._compression_at(now)).astype(np.float32)
            if model.memory == 0:
                return present
            left = faded(self._births_until(math.floor(now / model.step)), now, model)
        shift_y, shift_x = (-float(now) * v / model.spacing for v in model.drift[::-1])
        result = np.maximum(_shifted(left, shift_y, shift_x), present)
        result[result < FAINTEST] = 0.0
        return result

    def _births_until(self, index: int) -> Array:
        first = index - self._model.memory + 1
        if self._births is None or not self._last <= index:
            self._births = None
            self._last = first - 1
        # births of lattice times that are forgotten by now fade below the faintest: they may stay
        first = max(first, self._last + 1)
        for step in range(first, index + 1):
            born = self._born(step)
            self._births = born if self._births is None else np.maximum(self._births, born, out=self._births)
            self.tell(step - first + 1, index + 1 - first)
        self._last = index
        assert self._births is not None
        return self._births

    def _born(self, index: int) -> Array:
        """Births at a lattice time, moved by whole samples onto the drifting grid."""
        model = self._model
        time = index * model.step
        rows, columns = (round(-float(time) * v / model.spacing) for v in model.drift[::-1])
        compression = self._compression_at(model.reduced(time))
        return np.roll(model.birth(compression, time), (rows, columns), axis=(0, 1))


#: gives the compression of the sea at places in m, at a time in s
CompressionAt = Callable[[Array, Array, Fraction], RealArray]


def foam_at(
    model: FoamModel, compression_at: CompressionAt, x: Array, y: Array, time: float | Fraction
) -> RealArray:
    """(places,) float32 F in 0…1 at rest positions x and y in m, without a grid that could keep births.

    Each place looks back along its own drift: so the foam of a sum repeats with none of its patches.
    """
    now = model.reduced(time)
    result = model.strength(compression_at(x, y, now)).astype(np.float32)
    last = math.floor(now / model.step)
    for index in range(last - model.memory + 1, last + 1):
        then = index * model.step
        age = float(now - then)
        compression = compression_at(x - age * model.drift[0], y - age * model.drift[1], model.reduced(then))
        np.maximum(result, faded(model.birth(compression, then), now, model), out=result)
    result[result < FAINTEST] = 0.0
    return result


def faded(births: Array, now: Fraction, model: FoamModel) -> RealArray:
    """What is left of the foam by now; what a longer history remembers beyond the faintest is none."""
    result = np.exp2((births - float(now)) / model.half_life).astype(np.float32)
    result[result < FAINTEST] = 0.0
    return result


def _shifted(field: RealArray, rows: float, columns: float) -> RealArray:
    """The periodic field read at (i + rows, j + columns), bilinear."""
    for axis, shift in ((0, rows), (1, columns)):
        whole = math.floor(shift)
        fraction = np.float32(shift - whole)
        near = np.roll(field, -whole, axis=axis)
        field = near if fraction == 0.0 else near + fraction * (np.roll(near, -1, axis=axis) - near)
    return field
