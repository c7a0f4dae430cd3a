# SPDX-License-Identifier: GPL-3.0-or-later
"""Windrows: the lines along the wind into which old foam gathers from 7 Bft.

Rolls of water with axes along the wind (Langmuir 1938) stretch and gather foam. Old foam is therefore not
read where it was born but closer to the centre of a cell elongated along the wind, which stretches it about
that centre. Cells lie in lanes of all widths; those of neighbouring lanes are offset, so that the ends of
streaks never line up across the wind.

The stretched foam is gathered by a pattern of lines g, normally distributed over the water: a coverage F
becomes F' with F'/(1 - F') = o(F) exp(σg). The odds o(F) are chosen such that the mean of F' over g is F, so
the amount of foam is preserved: closed where it was thick, threads where it was thin. The lines have all
spacings seen at sea, narrow ones between wide ones. Lines too narrow for the samples are omitted from g and
its variance, so unresolved foam is even.

Cells and lines drift with the foam. They consist of waves periodic over the sea's square, so they are the
same on a tile, on merged patches and at places; in a loop they stand still.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from statistics import NormalDist
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..numerics import random
from ..numerics.choice import chosen
from ..numerics.interpolation import smoothstep

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: wind in m/s at 10 m at which windrows appear, 7 Bft, and at which they are fully formed, 9 Bft
_FROM, _WHOLE = 13.9, 20.8

#: length of a cell along the wind in m, and the stretch of foam in it. A sea smaller than two cells has no
# windrows
_CELL, _STRETCH = 50.0, 4.0
#: lanes per standard deviation of the waves that define them; offset between neighbouring lanes in cells (by
# the golden section lanes never line up again); offset within a lane, in cells per standard deviation
_LANES, _SHIFT, _UNLIKE = 1.0, 0.618, 0.12
#: offset of the ends of cells, in cells per standard deviation of the lines and of narrow waves: lines end in
# points and tongues, and are not cut off straight
_RAGGED, _TONGUES = 0.1, 0.05
#: fraction of the variance of g that thins out foam towards the ends of cells, instead of cutting it off
_THINNING = 0.08
#: fraction of the variance of foam that fully resolved lines account for; and σ² over the ratio of that
# fraction to the rest: a logistic distribution against a normal one
_GATHERED, _LOGISTIC = 0.7, 2.9
#: table sizes: of o(F) in F, of the log odds from which it is computed, and of g
_SHARES, _ODDS, _NORMAL = 4096, np.linspace(-14.0, 14.0, 561), np.linspace(-5.0, 5.0, 161)
#: time in s in which half of a crest's foam is drawn out
_DRAWN_IN = 0.9
#: samples per wave, or between threads, at which it begins to count, and at which it counts fully
_HELD = (2.0, 4.0)

#: value of the waves at the edge of a thread, in standard deviations; narrower threads would be dotted
_THINNEST = 0.03
#: range in standard deviations of the table for threads, and its number of steps
_FARTHEST, _AWAY = 5.0, 2**14

_RADIANS = np.float32(2.0 * math.pi)

#: places processed at a time
_CHUNK = 2**16


class _Kind(NamedTuple):
    """One kind of windrow waves.

    across : their shortest and longest wavelength across the wind, m
    aspect : ratio of their length along the wind to that across
    number : number of waves
    variance : their part of the lines' variance of 1
    threads : whether lines follow the zeros of the waves, two per wave: threads that wander, part and meet;
        otherwise they are patches where the waves are high
    """

    across: tuple[float, float]
    aspect: float
    number: int
    variance: float
    threads: bool


#: waves that define the lanes of cells
_IN_LANES = _Kind((14.0, 90.0), 20.0, 12, 1.0, False)
#: waves that define the tongues in which cells end
_IN_TONGUES = _Kind((0.8, 5.0), 12.0, 6, 1.0, False)
#: wide lines, narrow lines in between, streaks, and large areas with more or fewer lines
_LINES = (
    _Kind((60.0, 300.0), 14.0, 12, 0.34, True),
    _Kind((16.0, 60.0), 16.0, 14, 0.34, True),
    _Kind((5.0, 20.0), 16.0, 14, 0.18, False),
    _Kind((60.0, 250.0), 2.5, 10, 0.14, False),
)


@dataclass(frozen=True)
class Windrows:
    """The windrows of a sea.

    strength : from 0 for none to 1, at which all old foam is drawn out
    direction : of the wind, rad
    side : of the square with which they repeat, m
    seed : of the sea
    spacing : of the samples on which they are shown, m
    """

    strength: float
    direction: float
    side: float
    seed: int
    spacing: float

    def sources(self, x: Array, y: Array) -> tuple[Array, Array, RealArray]:
        """Source positions of the foam drawn out to places in m, which drift with it, and the gathering lines
        exp(σg), in the places' shape.
        """
        source_x, source_y, lines = np.empty(x.shape), np.empty(y.shape), np.empty(x.shape, np.float32)
        for part in _parts(x.size, _CHUNK):
            off_x, off_y, lines.flat[part] = self._drawn_by(x.flat[part], y.flat[part])
            source_x.flat[part], source_y.flat[part] = x.flat[part] - off_x, y.flat[part] - off_y
        return source_x, source_y, lines

    def on_grid(self, along: Array) -> tuple[RealArray, RealArray, RealArray]:
        """Offsets in m along x and y to the source of the foam on a grid, given by the coordinates of its
        columns and rows, which drift with it, and the gathering lines exp(σg); (rows, columns) each.
        """
        count = len(along)
        found = np.empty((3, count, count), np.float32)
        for rows in _parts(count, max(1, _CHUNK // count)):
            found[:, rows] = self._drawn_by(along, along[rows, np.newaxis])
        return found[0], found[1], found[2]

    def _drawn_by(self, x: Array, y: Array) -> tuple[RealArray, RealArray, RealArray]:
        """As `on_grid`, for places in m whose x and y broadcast."""
        pattern = self._pattern
        along_x, along_y = pattern.cell
        # offset from the centre of the place's cell, in cells
        off = _turn(along_x * x) + _turn(along_y * y)
        lanes = pattern.lanes.at(x, y)
        off += np.float32(_SHIFT) * np.rint(np.float32(_LANES) * lanes) + np.float32(_UNLIKE) * lanes
        lines = pattern.lines_at(x, y)
        ragged = np.float32(_RAGGED) * lines + np.float32(_TONGUES) * pattern.tongues.at(x, y)
        off -= np.rint(off + ragged)
        ends = np.take(_ends(), (np.abs(off + ragged) * np.float32(2 * _AWAY)).astype(np.int32), mode="clip")
        off *= np.float32((1.0 - 1.0 / _STRETCH) * 2.0 * math.pi / (along_x**2 + along_y**2))
        lines *= np.float32(math.sqrt(1.0 - _THINNING))
        lines += np.float32(math.sqrt(_THINNING)) * ends
        lines = np.exp(np.float32(pattern.contrast) * lines)
        return off * np.float32(along_x), off * np.float32(along_y), lines

    def gathered(self, foam: RealArray, lines: RealArray) -> RealArray:
        """Coverage in 0…1 of foam gathered into lines; 0 stays 0.

        lines : exp(σg), as returned by `sources`
        """
        at = (foam * np.float32(_SHARES) + np.float32(0.5)).astype(np.int32)
        odds = np.take(_odds(self._pattern.contrast), at, mode="clip")
        odds *= lines
        return np.asarray(odds / (odds + np.float32(1.0)))

    def stays(self, half_life: float) -> float:
        """Half-life in s of foam at its place of birth, which is shorter if it is drawn out."""
        if self.strength < 1.0 or half_life == 0.0:
            return half_life
        return 1.0 / (1.0 / half_life + 1.0 / _DRAWN_IN)

    def staying(self, foam: RealArray, age: RealArray) -> RealArray:
        """Old foam that remains where it was born; with age it passes into the drawn-out foam."""
        return foam * (1.0 - self.strength * _drawn(age))

    def drawn_out(
        self, own: RealArray, age: RealArray, drawn: RealArray, drawn_age: RealArray, lines: RealArray
    ) -> tuple[RealArray, RealArray]:
        """Combine foam that stays where it was born with drawn-out foam; returns the foam and its age.

        The age is that of the larger of the two.
        """
        other = self.gathered(drawn, lines) * (self.strength * _drawn(drawn_age))
        return np.minimum(own + other, np.float32(1.0)), chosen(other > own, drawn_age, age)

    @property
    def _pattern(self) -> _Pattern:
        return _pattern(self.direction, self.side, self.seed, self.spacing)


def are_there(wind_speed: float) -> bool:
    """Whether a wind in m/s at 10 m draws foam out, on a sea large enough."""
    return wind_speed > _FROM


def windrows(
    wind_speed: float, direction: float, side: float, seed: int, spacing: float = 0.0
) -> Windrows | None:
    """The windrows of a wind in m/s at 10 m; None if the wind is too weak or the sea too small."""
    if not are_there(wind_speed):
        return None
    strength = float(smoothstep(np.array((wind_speed - _FROM) / (_WHOLE - _FROM))))
    if side < 2.0 * _CELL:
        return None
    return Windrows(strength, direction, side, seed, spacing)


@dataclass(frozen=True)
class _Waves:
    """A sum of waves: wave vectors in rad/m, amplitudes and phases."""

    kx: Array
    ky: Array
    amplitude: Array
    phase: Array

    def at(self, x: Array, y: Array) -> RealArray:
        """Values at places in m, float32; x and y broadcast."""
        total = np.zeros(np.broadcast_shapes(x.shape, y.shape), np.float32)
        product = np.empty_like(total)
        for kx, ky, amplitude, phase in zip(self.kx, self.ky, self.amplitude, self.phase, strict=True):
            if amplitude == 0.0:
                continue
            if x.shape == y.shape:
                total += np.float32(amplitude) * np.cos(_RADIANS * _turn(kx * x + ky * y + phase))
            else:  # on a grid, cos(a + b) separates into factors for columns and rows
                a, b = _RADIANS * _turn(kx * x), _RADIANS * _turn(ky * y + phase)
                total += np.multiply(np.float32(amplitude) * np.cos(a), np.cos(b), out=product)
                total -= np.multiply(np.float32(amplitude) * np.sin(a), np.sin(b), out=product)
        return total

    @property
    def variance(self) -> float:
        return float(np.sum(self.amplitude**2)) / 2.0


@dataclass(frozen=True)
class _Pattern:
    """The windrows as resolved by the samples.

    cell : wave vector of the cells, rad/m
    lanes : waves whose rounded height numbers the lanes of cells
    tongues : waves by which the ends of cells are offset
    lines : waves of each kind of lines
    """

    cell: tuple[float, float]
    lanes: _Waves
    tongues: _Waves
    lines: tuple[_Waves, ...]

    @property
    def held(self) -> float:
        """Resolved fraction of the lines' variance, 0…1."""
        return sum(kind.variance * waves.variance for kind, waves in zip(_LINES, self.lines, strict=True))

    @property
    def contrast(self) -> float:
        """σ, the standard deviation of the log odds due to the lines."""
        gathered = _GATHERED * self.held
        return math.sqrt(_LOGISTIC * gathered / (1.0 - gathered))

    def lines_at(self, x: Array, y: Array) -> RealArray:
        """g at places in m, normally distributed with variance 1; 0 if nothing is resolved."""
        total = np.zeros(np.broadcast_shapes(x.shape, y.shape), np.float32)
        for kind, waves in zip(_LINES, self.lines, strict=True):
            if waves.variance == 0.0:
                continue
            value = waves.at(x, y) * np.float32(1.0 / math.sqrt(waves.variance))
            if kind.threads:
                np.abs(value, out=value)
                value *= np.float32(_AWAY / _FARTHEST)
                value = np.take(_threads(), value.astype(np.int32), mode="clip")
            total += np.float32(math.sqrt(kind.variance * waves.variance)) * value
        return total * np.float32(1.0 / math.sqrt(self.held)) if self.held else total


@lru_cache(maxsize=16)
def _pattern(direction: float, side: float, seed: int, spacing: float) -> _Pattern:
    """The pattern of windrows from wave vectors of the square."""
    step = 2.0 * math.pi / side

    def fitting(along: Array, across: Array) -> tuple[Array, Array]:
        c, s = math.cos(direction), math.sin(direction)
        return step * np.rint((c * along - s * across) / step), step * np.rint(
            (s * along + c * across) / step
        )

    def waves(stream: int, kind: _Kind) -> _Waves:
        key = random.mix(np.arange(kind.number, dtype=np.uint64) + np.uint64(random.combine(seed, stream)))
        shortest, longest = kind.across
        longest = min(longest, 0.5 * side)
        # the same number in each octave, one after another
        octaves = (np.arange(kind.number) + random.uniform(key, 0)) / kind.number
        across = 2.0 * math.pi / longest * (longest / shortest) ** octaves
        along = across / kind.aspect * random.normal(key, 1)
        kx, ky = fitting(along, across)
        length = 2.0 * math.pi / np.maximum(np.hypot(kx, ky), 0.5 * step)
        samples = length / max(spacing, 1e-6) / (2.0 if kind.threads else 1.0)
        held = np.clip((samples - _HELD[0]) / (_HELD[1] - _HELD[0]), 0.0, 1.0)
        return _Waves(kx, ky, held * math.sqrt(2.0 / kind.number), 2.0 * math.pi * random.uniform(key, 3))

    (cell_x,), (cell_y,) = fitting(np.array([2.0 * math.pi / _CELL]), np.zeros(1))
    lines = tuple(waves(stream, kind) for stream, kind in enumerate(_LINES, 2))
    tongues = waves(2 + len(_LINES), _IN_TONGUES)
    return _Pattern((float(cell_x), float(cell_y)), waves(1, _IN_LANES), tongues, lines)


@lru_cache(maxsize=1)
def _threads() -> RealArray:
    """Table over the distance of a normal number from 0 of a value that is normally distributed too, and
    largest at 0."""
    normal, away = NormalDist(), np.linspace(_THINNEST, _FARTHEST, 500)
    known = [-normal.inv_cdf(2.0 * normal.cdf(each) - 1.0) for each in away.tolist()]
    middle = (np.arange(_AWAY) + 0.5) * (_FARTHEST / _AWAY)
    return np.asarray(np.interp(middle, away, known).astype(np.float32))


@lru_cache(maxsize=1)
def _ends() -> RealArray:
    """Normally distributed, by the distance from the centre of a cell in steps: highest in the centre."""
    quantile = NormalDist().inv_cdf
    away = (np.arange(_AWAY) + 0.5) / _AWAY
    return np.array([-quantile(each) for each in away.tolist()], np.float32)


@lru_cache(maxsize=16)
def _odds(contrast: float) -> RealArray:
    """o(F) for F from 0 to 1 in steps of 1/_SHARES."""
    weight = np.exp(-0.5 * _NORMAL**2)
    gathered = 1.0 / (1.0 + np.exp(-_ODDS[:, np.newaxis] - contrast * _NORMAL))
    share = np.sum(gathered * (weight / np.sum(weight)), axis=1)
    odds = np.exp(np.interp(np.arange(_SHARES + 1) / _SHARES, share, _ODDS))
    odds[0] = 0.0
    return np.asarray(odds.astype(np.float32))


def _drawn(age: RealArray) -> RealArray:
    """Fraction of foam of an age that is drawn out."""
    return np.asarray(1.0 - np.exp2(age * np.float32(-1.0 / _DRAWN_IN)))


def _turn(angle: Array) -> RealArray:
    """Angles in rad as turns in [-½, ½], for which single precision suffices."""
    turn = angle * (1.0 / (2.0 * math.pi))
    return np.asarray((turn - np.rint(turn)).astype(np.float32))


def _parts(count: int, size: int) -> Iterator[slice]:
    return (slice(first, min(first + size, count)) for first in range(0, count, size))
