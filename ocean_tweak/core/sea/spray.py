# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray of a sea: which crests break at which moments, and what of that is in the air at a time.

Moments are the lattice times of the foam, and cells those of its grids: the samples of a tile, or squares in
one another around a place, fine near it and coarse far away, whose crests are those that are seen there. What
broke at a moment is remembered, so that a sequence makes only the newest; another amount, size, wind or life
makes nothing anew but the particles.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Hashable, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..data.errors import ParameterError
from ..data.frames import Frame
from ..foam.model import FoamModel, breaking_of
from ..foam.threshold import foam_outlook, foam_wind
from ..numerics import random
from ..numerics.machine import usable_memory
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.shot import Shot
from ..parameters.spray import Spray
from ..spray.drops import LEAST_WIND, torn_rate
from ..spray.particles import BYTES, MEAN_LIFE, Crests, Particles, expected, in_the_air, joined, longest_life
from .foam_levels import FINEST, FoamLevels
from .ocean import Ocean
from .regions import TILE, Places

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: cells along each side of a square around a place, of which the middle ones belong to the next finer, and
#: cells by which squares follow the place
_CELLS, _STEP = 176, 16
#: squares around a place, at most, by how many particles one stands for there: beyond a few hundred metres
#: nobody sees drops
_STANDS_FOR = (1, 1, 2, 4, 8)
#: m; a cell in which crests break is looked at in parts no larger than this
_PART = 1.0
#: strength of a breaking crest from which on all of it tears, and the area that tears over the mean strength
_ALL_TEARS, _TEARS = 0.25, 1.7
#: m and moments in which wind tears alike
_GUST, _GUST_MOMENTS = 2.0, 2

#: the fields that tell how water moves where it breaks
_OF_WATER = frozenset({"displacement", "velocity", "slope", "strain"})
#: of the machine's memory, what spray may take
_SHARE_OF_MEMORY = 0.5


class SprayError(ParameterError):
    """More particles than the memory holds, with the amount that would do."""


def why_none(parameters: OceanParameters) -> str | None:
    """Why a sea has no spray; None where it has."""
    wind = foam_wind(parameters)
    if wind is None:
        return (
            "this sea has no spray, because no layer is given by a wind: define one by wind speed and fetch"
        )
    if foam_outlook(parameters).coverage == 0.0:
        return "this sea has no spray, because it has no foam: give its foam a coverage above 0"
    if wind.speed <= LEAST_WIND:
        return (
            f"this sea has no spray, because its wind of {wind.speed:.3g} m/s tears nothing off: "
            f"spume begins at {LEAST_WIND:g} m/s"
        )
    return None


def check_spray(parameters: OceanParameters, spray: Spray) -> None:
    """Raise SprayError where a sea's spray needs more memory than there is, before any is made.

    Raises ParameterError for a sea that has none.
    """
    if (why := why_none(parameters)) is not None:
        raise ParameterError("spray", "", why)
    wind, tears = foam_wind(parameters), _TEARS * Ocean(parameters).mean_breaking
    assert wind is not None
    if parameters.is_cascade:
        sides = [_CELLS * FINEST * 2.0**level for level in range(len(_STANDS_FOR))]
        inner = [0.0, *sides]
        rings = zip(sides, inner[:-1], _STANDS_FOR, strict=True)
        area = sum((side**2 - less**2) / stands for side, less, stands in rings)
    else:
        area = parameters.domain_size**2
    _check_memory(area * tears * torn_rate(wind.speed) * spray.amount * MEAN_LIFE, spray)


class TileSpray:
    """Spray of a sea's one tile: crests break on the samples of its foam.

    Raises ValueError, when it is asked for, of separate patches, which have a tile each.
    """

    def __init__(self, sea: Ocean) -> None:
        self._foam = sea.of_foam
        self._crests = _Remembered(sea.parameters)

    @property
    def nbytes(self) -> int:
        """Bytes of the crests that are remembered."""
        return self._crests.nbytes

    def at(self, time: float | Fraction, spray: Spray) -> Particles:
        """All that is in the air at a time in s.

        Raises SprayError for more than the memory holds.
        """
        return self._crests.in_the_air(self._foam.foam_model, time, spray, (None,), self._look)

    def _look(self, index: int, _regions: Sequence[None]) -> list[Crests]:
        foam = self._foam
        n, side, model = foam.parameters.resolution, foam.parameters.domain_size, foam.foam_model
        fields = foam.surface(model.reduced(index * model.step), {*_OF_WATER, "min_eigenvalue"}, TILE)
        strength = breaking_of(model, np.subtract(1.0, fields.min_eigenvalue))
        row, column = np.nonzero(strength)
        water = _Water(*(fields[name][row, column].astype(np.float64) for name in _Water._fields))
        cells = _Cells(column, row, side / n, 0)
        rest = np.stack((column, row), axis=-1).astype(np.float64) * (side / n)
        return [_crests(model, foam.parameters, index, cells, rest, water, strength[row, column])]


class CameraSpray:
    """Spray of a sea of patches around a camera, in squares in one another. Making it is cheap."""

    def __init__(self, levels: FoamLevels) -> None:
        self._levels = levels
        self._crests = _Remembered(levels.parameters)

    @property
    def nbytes(self) -> int:
        """Bytes of the crests that are remembered."""
        return self._crests.nbytes

    def at(self, time: float | Fraction, spray: Spray, place: tuple[float, float]) -> Particles:
        """All that is in the air at a time in s around a place at rest, in m.

        Raises SprayError for more than the memory holds.
        """
        model = self._levels.seas[0].foam_model
        return self._crests.in_the_air(model, time, spray, squares(self._levels, place), self._look)

    def _look(self, index: int, regions: Sequence[Square]) -> list[Crests]:
        """Crests that are seen in each square, on the water that is drawn: that of all waves."""
        finest = self._levels.seas[0]
        time = finest.foam_model.reduced(index * finest.foam_model.step)
        found = [_broken(self._levels.seas[region.level], region, time) for region in regions]
        rest = [np.stack((cells.column + 0.5, cells.row + 0.5), axis=-1) * cells.size for cells, _ in found]
        x, y = np.concatenate(rest).T
        fields = finest.surface(time, _OF_WATER, Places(x, y))
        ends = np.cumsum([len(each) for each in rest])
        made = []
        for region, (cells, strength), at, end in zip(regions, found, rest, ends, strict=True):
            part = slice(end - len(at), end)
            water = _Water(*(fields[name][part].astype(np.float64) for name in _Water._fields))
            sea = self._levels.seas[region.level]
            made.append(_crests(sea.foam_model, sea.parameters, index, cells, at, water, strength))
        return made


class ShotSpray:
    """Spray of a shot's frames; quickest where they follow each other.

    place : x and y in m around which it is made; None for the tile of a sea, which then must have one
    """

    def __init__(self, shot: Shot, spray: Spray, place: tuple[float, float] | None = None) -> None:
        self._shot = shot
        self._spray = spray
        self._place = place
        self._made: tuple[OceanParameters, Callable[[Fraction], Particles]] | None = None

    def at(self, frame: Frame) -> Particles:
        """Particles at a frame, with velocities per second of the shot.

        Raises SprayError for more than the memory holds.
        """
        moment = self._shot.at(frame)
        if self._made is None or self._made[0] != moment.parameters:
            self._made = moment.parameters, self._maker(moment.parameters)
        made = self._made[1](moment.time)
        return made if moment.rate == 1.0 else made._replace(velocity=made.velocity * np.float32(moment.rate))

    def _maker(self, sea: OceanParameters) -> Callable[[Fraction], Particles]:
        spray, place = self._spray, self._place
        if place is None:
            tile = TileSpray(Ocean(sea))
            return lambda time: tile.at(time, spray)
        around = CameraSpray(FoamLevels(sea))
        return lambda time: around.at(time, spray, place)


class Square(NamedTuple):
    """A square of cells around a place, of which those of the next finer one are not.

    level : of the foam; its cells are FINEST·2ⁿ m large
    first : column and row of its first cell
    inner : those of the finer one's, counted in this one's cells; None for the finest
    """

    level: int
    first: tuple[int, int]
    inner: tuple[int, int] | None


def squares(levels: FoamLevels, place: tuple[float, float]) -> tuple[Square, ...]:
    """Those around a place, in m."""
    count = min(len(_STANDS_FOR), len(levels.seas))
    first = [_first(place, FINEST * 2.0**level) for level in range(count)]
    inner = [None, *((x // 2, y // 2) for x, y in first)]
    return tuple(Square(level, first[level], inner[level]) for level in range(count))


class _Remembered:
    """Crests by region and moment, as many as a frame looks back at.

    One thread at a time goes on with them, and others wait.
    """

    def __init__(self, parameters: OceanParameters) -> None:
        self._parameters = parameters
        self._crests: dict[Hashable, dict[int, Crests]] = {}
        self._busy = threading.Lock()

    @property
    def nbytes(self) -> int:
        """Bytes of all crests."""
        return sum(crests.nbytes for known in list(self._crests.values()) for crests in list(known.values()))

    def in_the_air(
        self,
        model: FoamModel,
        time: float | Fraction,
        spray: Spray,
        regions: Sequence[Any],
        look: Callable[[int, Sequence[Any]], list[Crests]],
    ) -> Particles:
        """Particles at a time, region by region and moment by moment.

        look : gives the crests of a moment in each of some regions
        """
        wind = foam_wind(self._parameters)
        if wind is None or why_none(self._parameters) is not None:
            return joined([])
        now, step = Fraction(time), model.step
        first = math.floor((now - Fraction(longest_life(spray))) / step - Fraction(1, 2))
        moments = range(first, math.floor(now / step + Fraction(1, 2)) + 1)
        with self._busy:
            crests = self._looked_at(moments, regions, look)
        torn = sum(float(expected(each, spray, wind, float(step)).sum()) for _, each in crests)
        _check_memory(torn / len(moments) / float(step) * MEAN_LIFE, spray)
        parts = (
            in_the_air(each, spray, wind, float(step), float(now - index * step)) for index, each in crests
        )
        return joined([*parts])

    def _looked_at(
        self,
        moments: range,
        regions: Sequence[Any],
        look: Callable[[int, Sequence[Any]], list[Crests]],
    ) -> list[tuple[int, Crests]]:
        """Crests with their moments; others are forgotten."""
        before = self._crests
        self._crests = {region: {} for region in regions}
        for region in regions:
            known = before.get(region, {})
            self._crests[region] = {index: known[index] for index in moments if index in known}
        for index in moments:
            missing = [region for region in regions if index not in self._crests[region]]
            for region, made in zip(missing, look(index, missing) if missing else (), strict=True):
                self._crests[region][index] = made
        return [(index, self._crests[region][index]) for region in regions for index in moments]


class _Cells(NamedTuple):
    """Cells by their numbers in a lattice."""

    column: NDArray[np.int64]
    row: NDArray[np.int64]
    size: float
    level: int


class _Water(NamedTuple):
    """Fields of the water in cells, float64."""

    displacement: Array
    velocity: Array
    slope: Array
    strain: Array


def _first(place: tuple[float, float], size: float) -> tuple[int, int]:
    """The numbers of the first cell of a square around a place."""
    x, y = (_STEP * round(along / size / _STEP) - _CELLS // 2 for along in place)
    return x, y


def _broken(sea: Ocean, square: Square, time: Fraction) -> tuple[_Cells, RealArray]:
    """The parts of a square's cells in which crests break, and how strongly."""
    size = FINEST * 2.0**square.level
    column, row = np.meshgrid(*(each + np.arange(_CELLS) for each in square.first))
    if square.inner is not None:
        within = [(number >= begin) & (number < begin + _CELLS // 2)
                  for number, begin in zip((column, row), square.inner, strict=True)]  # fmt: skip
        outside = ~(within[0] & within[1])
        column, row = column[outside], row[outside]
    column, row = column.ravel(), row.ravel()
    x, y = ((number.astype(np.float64) + 0.5) * size for number in (column, row))
    strength = breaking_of(sea.foam_model, sea.compression_at(x, y, time))
    broken = np.flatnonzero(strength)
    cells, of_cell = _in_parts(_Cells(column[broken], row[broken], size, square.level))
    return cells, strength[broken][of_cell]


def _in_parts(cells: _Cells) -> tuple[_Cells, NDArray[np.int64]]:
    """Cells cut into parts that are small enough, and of which cell each part is."""
    cuts = max(1, round(cells.size / _PART))
    of_cell = np.repeat(np.arange(len(cells.column)), cuts * cuts)
    number = np.tile(np.arange(cuts * cuts), len(cells.column))
    column = cells.column[of_cell] * cuts + number % cuts
    row = cells.row[of_cell] * cuts + number // cuts
    return _Cells(column, row, cells.size / cuts, cells.level), of_cell


def _crests(
    model: FoamModel,
    parameters: OceanParameters,
    index: int,
    cells: _Cells,
    rest: Array,
    water: _Water,
    strength: RealArray,
) -> Crests:
    """Crests in cells that lie at rest around x and y in m, with what the water is there."""
    moments = 0 if model.loop_duration is None else round(model.loop_duration / model.step)
    moment = index % moments if moments else index
    xx, yy, xy = water.strain.T
    wide = max(1, round(_GUST / cells.size))
    gust = random.hash_cells(
        cells.column // wide, cells.row // wide, parameters.seed, moment // _GUST_MOMENTS, 1
    )
    half = 0.5 * cells.size
    along = np.empty((len(rest), 2, 3), np.float32)
    for axis, (by_x, by_y) in enumerate((((1.0 + xx), xy), (xy, (1.0 + yy)))):
        for component, value in enumerate((by_x, by_y, water.slope[:, axis])):
            along[:, axis, component] = half * value
    place = water.displacement.copy()
    place[:, :2] += rest
    area = cells.size**2 * np.maximum((1.0 + xx) * (1.0 + yy) - xy * xy, 0.0)
    return Crests(
        random.hash_cells(cells.column, cells.row, parameters.seed, moment, cells.level),
        gust,
        (area * np.minimum(strength / _ALL_TEARS, 1.0)).astype(np.float32),
        np.full(len(rest), _STANDS_FOR[cells.level], np.float32),
        place.astype(np.float32),
        along,
        water.velocity.astype(np.float32),
    )


def _check_memory(count: float, spray: Spray) -> None:
    """Raise SprayError for more particles than the memory holds."""
    memory = usable_memory()
    if memory is None or count * BYTES <= _SHARE_OF_MEMORY * memory:
        return
    would_do = spray.amount * _SHARE_OF_MEMORY * memory / (count * BYTES)
    raise SprayError(
        "spray.amount", spray.amount,
        f"makes about {count:,.0f} particles, which need {count * BYTES / 2**30:.1f} GB of memory, and spray "
        f"may take {_SHARE_OF_MEMORY * memory / 2**30:.1f} GB here: an amount of {would_do:.2g} would do",
    )  # fmt: skip
