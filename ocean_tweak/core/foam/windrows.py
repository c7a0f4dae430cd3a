# SPDX-License-Identifier: GPL-3.0-or-later
"""Windrows: the lines along the wind in which old foam lies from 7 Bft on.

Water that rolls about axes along the wind (Langmuir 1938) draws foam out and gathers it. So old foam is read
not where it was born but nearer to the middle of a cell that is long along the wind: in each cell it is
stretched about that middle. Across the wind the cells are shifted against each other. What is seen there
counts more in some lines than in others, 1 on average, so that the mean of the foam stays what it was.

Cells and lines drift with the foam. They are made of waves that fit the side of the sea's square, so they
are the same on a tile, on one grid of several patches, and at places; in a loop they stand still.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..numerics import random
from ..numerics.choice import chosen

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: wind in m/s at 10 m at which windrows begin to show, 7 Bft, and from which they are whole, 9 Bft
_FROM, _WHOLE = 13.9, 20.8

#: m; length of a cell along the wind, by how much foam in it is stretched, and how far neighbours are shifted
#: against each other, rad. A sea that is shorter than two cells has none
_CELL, _STRETCH, _SHIFT = 50.0, 4.0, 2.0
#: wavelengths in m across the wind of what shifts cells, and of what gathers foam into lines
_FINE, _COARSE = (12.0, 60.0), (30.0, 100.0)
#: how much longer they are along the wind
_ASPECT = 8.0
#: waves of which each is made
_WAVES = 16
#: how much more lines hold than what is between them: standard deviation of the logarithm, the most over the
#: mean, and what that keeps of the mean
_CONTRAST, _MOST, _KEPT = 1.0, 4.0, 0.931
#: s; half of the foam that a crest has left is drawn out in this time
_DRAWN_IN = 0.4

#: places that are looked at together
_CHUNK = 2**16


@dataclass(frozen=True)
class Windrows:
    """Those of a sea.

    strength : 0 for none, 1 where all old foam is drawn out
    direction : of the wind, rad
    side : of the square that they repeat with, m
    seed : of the sea
    """

    strength: float
    direction: float
    side: float
    seed: int

    def sources(self, x: Array, y: Array) -> tuple[Array, Array, RealArray]:
        """Where the foam comes from that is drawn out to places in m, which drift with it, and how much of
        it there is, 1 on average; of the places' shape.
        """
        along_x, along_y, shift, gather = self._waves
        source_x, source_y = np.empty(x.shape), np.empty(y.shape)
        share = np.empty(x.shape, np.float32)
        length = math.hypot(along_x, along_y)
        for part in _parts(x.size):
            px, py = x.flat[part], y.flat[part]
            phase = along_x * px + along_y * py + _SHIFT * shift.at(px, py)
            # from the middle of its cell, in radians of the cell
            off = np.mod(phase + math.pi, 2.0 * math.pi) - math.pi
            off *= (1.0 - 1.0 / _STRETCH) / length
            source_x.flat[part] = px - off * (along_x / length)
            source_y.flat[part] = py - off * (along_y / length)
            share.flat[part] = _gathered(gather.at(px, py))
        return source_x, source_y, share

    def drawn_out(
        self, foam: RealArray, age: RealArray, drawn: RealArray, drawn_age: RealArray, share: RealArray
    ) -> tuple[RealArray, RealArray]:
        """Old foam and its age of what lies where it was born, and of what was drawn out.

        The first goes over into the second as it ages. The age is that of the larger part.
        """
        own = foam * (1.0 - self.strength * _drawn(age))
        other = drawn * share * (self.strength * _drawn(drawn_age))
        return np.minimum(own + other, np.float32(1.0)), chosen(other > own, drawn_age, age)

    @property
    def _waves(self) -> tuple[float, float, _Waves, _Waves]:
        return _waves(self.direction, self.side, self.seed)


def windrows(wind_speed: float, direction: float, side: float, seed: int) -> Windrows | None:
    """The windrows of a wind in m/s at 10 m; None where it is too weak, or the sea too small."""
    part = min(1.0, max(0.0, (wind_speed - _FROM) / (_WHOLE - _FROM)))
    strength = part * part * (3.0 - 2.0 * part)
    if strength == 0.0 or side < 2.0 * _CELL:
        return None
    return Windrows(strength, direction, side, seed)


@dataclass(frozen=True)
class _Waves:
    """A sum of waves with a variance of 1: wave vectors in rad/m and phases."""

    kx: Array
    ky: Array
    phase: Array

    def at(self, x: Array, y: Array) -> RealArray:
        """Its values at places in m, float32."""
        total = np.zeros(x.shape, np.float32)
        for kx, ky, phase in zip(self.kx, self.ky, self.phase, strict=True):
            angle = (kx * x + ky * y + phase) / (2.0 * math.pi)
            angle -= np.floor(angle)
            total += np.cos(angle.astype(np.float32) * np.float32(2.0 * math.pi))
        return total * np.float32(math.sqrt(2.0 / len(self.kx)))


@lru_cache(maxsize=8)
def _waves(direction: float, side: float, seed: int) -> tuple[float, float, _Waves, _Waves]:
    """The wave vector of the cells, and what shifts them and gathers foam, on the lattice of the square."""
    step = 2.0 * math.pi / side

    def fitting(along: Array, across: Array) -> tuple[Array, Array]:
        c, s = math.cos(direction), math.sin(direction)
        return step * np.rint((c * along - s * across) / step), step * np.rint(
            (s * along + c * across) / step
        )

    def waves(kind: int, shortest: float, longest: float) -> _Waves:
        key = random.mix(np.arange(_WAVES, dtype=np.uint64) + np.uint64(random.combine(seed, kind)))
        # as many in each octave, one after the other
        octaves = (np.arange(_WAVES) + random.uniform(key, 0)) / _WAVES
        across = 2.0 * math.pi / longest * (longest / shortest) ** octaves
        along = across / _ASPECT * random.normal(key, 1)
        return _Waves(*fitting(along, across), 2.0 * math.pi * random.uniform(key, 3))

    (cell_x,), (cell_y,) = fitting(np.array([2.0 * math.pi / _CELL]), np.zeros(1))
    return float(cell_x), float(cell_y), waves(1, *_FINE), waves(2, *_COARSE)


def _gathered(waves: RealArray) -> RealArray:
    share = np.minimum(np.exp(_CONTRAST * waves - 0.5 * _CONTRAST**2), np.float32(_MOST))
    return np.asarray(share / np.float32(_KEPT))


def _drawn(age: RealArray) -> RealArray:
    """Share of the foam of an age that is drawn out."""
    return np.asarray(1.0 - np.exp2(age * np.float32(-1.0 / _DRAWN_IN)))


def _parts(count: int) -> Iterator[slice]:
    return (slice(first, first + _CHUNK) for first in range(0, count, _CHUNK))
