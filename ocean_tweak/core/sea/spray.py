# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray of a sea: the crests that break at each moment, and the particles in the air at a time.

Moments are the lattice times of the foam, and cells those of its grids: the samples of a tile, or nested
squares around a place, fine near it and coarse far away, with the crests visible there. Breaking crests of
each moment are cached, so a sequence only computes the newest; changing amount, size, wind or life only
recomputes the particles.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Hashable, Sequence
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..foam.model import FoamModel, breaking_of
from ..numerics import random
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.patch_seas import open_sea
from ..parameters.spray import Spray
from ..spray.drops import torn_rate
from ..spray.gusts import gusts
from ..spray.particles import Crests, Particles, expected, in_the_air, joined, mean_life
from ..waves.coast.breakers import whitecaps_left
from .coast_waves import CoastWaves
from .foam_levels import FoamLevels
from .hull_motion import HullMotion
from .memory import ground_of
from .ocean import Ocean
from .placed_waves import own_spray, stronger, throws
from .regions import TILE, Places
from .spray_outlook import check_spray_memory, tearing_wind, why_none
from .spray_squares import STANDS_FOR, Square, outside, squares

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: largest size in m of the parts into which a breaking cell is divided, if these are few
_PART, _MOST_CUTS = 1.0, 4
#: strength at which a breaking crest is torn completely
_ALL_TEARS = 0.25
#: particles per second and m² where what a hull throws up has a strength of 1
_OF_A_CREST = torn_rate(17.0)
#: extent of a gust in m and in moments
_GUST, _GUST_MOMENTS = 2.0, 2

#: fields needed for the motion of breaking water
_OF_WATER = frozenset({"displacement", "velocity", "slope", "strain"})


class TileSpray:
    """Spray of a sea's tile: crests break on the samples of its foam.

    Raises ValueError on use for separate patches, which have a tile each.
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
        return self._crests.in_the_air(self._foam.foam_model, time, spray, (_TILE,), self._look)

    def outlook(self, time: Fraction, spray: Spray) -> float:
        """Particles in the air where crests always break as at one moment: of that alone, it is quick."""
        return self._crests.outlook(self._foam.foam_model, time, spray, (_TILE,), self._look)

    def _look(self, index: int, _squares: Sequence[Square]) -> list[_Looked]:
        foam = self._foam
        n, side, model = foam.parameters.resolution, foam.parameters.domain_size, foam.foam_model
        time = model.reduced(index * model.step)
        fields = foam.surface(time, {*_OF_WATER, "min_eigenvalue"}, TILE)
        strength = breaking_of(model, np.subtract(1.0, fields.min_eigenvalue))
        row, column = np.nonzero(strength)
        water = _Water(*(fields[name][row, column].astype(np.float64) for name in _Water._fields))
        cells = _Cells(column, row, side / n, 0)
        rest = np.stack((column, row), axis=-1).astype(np.float64) * (side / n)
        births = _torn(foam.parameters, strength[row, column], rest[:, 0], rest[:, 1], time)
        crests = _crests(model, foam.parameters, index, cells, rest, water, births)
        return [_Looked(cells, crests)]


class CameraSpray:
    """Spray of a sea of patches around a camera, in nested squares. Creating it is cheap.

    levels : of the open sea
    over_bed : the sea with its coast, if it has one
    """

    def __init__(self, levels: FoamLevels, over_bed: Ocean | None = None) -> None:
        self._levels = levels
        self._over_bed = over_bed
        self._hulls: HullMotion | None = None
        self._crests = _Remembered(levels.parameters if over_bed is None else over_bed.parameters)

    @classmethod
    def of(cls, sea: OceanParameters) -> CameraSpray:
        """That of a sea."""
        levels = FoamLevels(open_sea(sea), far=sea.has_coast)
        return cls(levels, Ocean(sea) if sea.has_coast else None)

    @property
    def nbytes(self) -> int:
        """Bytes of the crests that are remembered, and of what hulls felt."""
        return self._crests.nbytes + (0 if self._hulls is None else self._hulls.nbytes)

    def at(self, time: float | Fraction, spray: Spray, place: tuple[float, float]) -> Particles:
        """All that is in the air at a time in s around a place at rest, in m.

        Raises SprayError for more than the memory holds.
        """
        model = self._levels.seas[0].foam_model
        return self._crests.in_the_air(model, time, spray, squares(self._levels, place), self._look)

    def is_there(self, place: tuple[float, float], there: tuple[float, float]) -> bool:
        """Whether spray around two places is made in the same squares."""
        return squares(self._levels, place) == squares(self._levels, there)

    def outlook(self, time: Fraction, spray: Spray, place: tuple[float, float]) -> float:
        """Particles in the air where crests always break as at one moment: of that alone, it is quick."""
        model = self._levels.seas[0].foam_model
        return self._crests.outlook(model, time, spray, squares(self._levels, place), self._look)

    def _look(self, index: int, missing: Sequence[Square]) -> list[_Looked]:
        """Visible crests in each square, on the water of all waves, and what hulls throw up."""
        finest = self._levels.seas[0]
        time = finest.foam_model.reduced(index * finest.foam_model.step)
        coast = None if self._over_bed is None else self._over_bed.coast
        found = [_broken(self._levels.seas[square.level], square, time, coast) for square in missing]
        rest = [np.stack((cells.column + 0.5, cells.row + 0.5), axis=-1) * cells.size for cells, _ in found]
        x, y = np.concatenate(rest).T
        water = _water(finest, x, y, time, coast)
        births = _torn(finest.parameters, np.concatenate([strength for _, strength in found]), x, y, time)
        height, velocity = water.displacement[:, 2], water.velocity
        if self._hulls is None:
            self._hulls = HullMotion(finest.parameters)
        own = own_spray(finest.parameters, x, y, time, height, velocity, self._hulls.at)
        if coast is not None:
            births = births * whitecaps_left(coast.shares(x, y).value)
            own = stronger(own, coast.spray(x, y, time, velocity))
        thrown = _OF_A_CREST * own.strength
        more = thrown > births
        births = np.where(more, thrown, births)
        water = water._replace(velocity=np.where(more[:, np.newaxis], own.velocity, water.velocity))
        ends = np.cumsum([len(each) for each in rest])
        made = []
        for square, (cells, _), at, end in zip(missing, found, rest, ends, strict=True):
            part = slice(end - len(at), end)
            of_part = _Water._make(each[part] for each in water)
            sea = self._levels.seas[square.level]
            crests = _crests(sea.foam_model, sea.parameters, index, cells, at, of_part, births[part])
            made.append(_Looked(cells, crests))
        return made


def above_bed(made: Particles, sea: OceanParameters) -> Particles:
    """The particles between the ends of a coast's bed: beside it the coast repeats, and its mesh does not."""
    ground = ground_of(sea)
    x, y, _ = made.position.T
    across = math.cos(ground.turn) * y - math.sin(ground.turn) * x - ground.first[1]
    there = (across >= 0.0) & (across <= ground.step * ground.columns)
    return Particles._make(each[there] for each in made)


#: all of a sea's one tile
_TILE = Square(0, (0, 0), None)


class _Looked(NamedTuple):
    """Crests of a square at a moment, and their cell parts."""

    cells: _Cells
    crests: Crests

    @property
    def nbytes(self) -> int:
        """Bytes of all arrays."""
        return self.cells.column.nbytes + self.cells.row.nbytes + self.crests.nbytes

    def seen_in(self, square: Square) -> Crests:
        """The crests that are not in the next finer square."""
        if square.inner is None:
            return self.crests
        cuts = round(square.size / self.cells.size)
        own = outside(self.cells.column // cuts, self.cells.row // cuts, square.inner)
        return Crests._make(part[own] for part in self.crests)


class _Remembered:
    """Cached crests by square and moment, as many as a frame needs.

    One thread at a time uses them while others wait.
    """

    def __init__(self, parameters: OceanParameters) -> None:
        self._parameters = parameters
        self._looked: dict[Hashable, dict[int, _Looked]] = {}
        self._busy = threading.Lock()

    @property
    def nbytes(self) -> int:
        """Bytes of all crests."""
        return sum(looked.nbytes for known in list(self._looked.values()) for looked in list(known.values()))

    def in_the_air(
        self,
        model: FoamModel,
        time: float | Fraction,
        spray: Spray,
        around: Sequence[Square],
        look: Callable[[int, Sequence[Square]], list[_Looked]],
    ) -> Particles:
        """Particles at a time, square by square and moment by moment.

        look : function that returns the crests of a moment in some squares
        """
        if why_none(self._parameters) is not None:
            return joined([])
        wind = tearing_wind(self._parameters)
        now, step = Fraction(time), model.step
        first = math.floor((now - Fraction(spray.life)) / step - Fraction(1, 2))
        moments = range(first, math.floor(now / step + Fraction(1, 2)) + 1)
        with self._busy:
            crests = self._looked_at(moments, around, look)
        torn = _in_the_air([each for _, each in crests], spray, float(step))
        check_spray_memory(torn / len(moments), spray)
        parts = (
            in_the_air(each, spray, wind, float(step), float(now - index * step)) for index, each in crests
        )
        return joined([*parts])

    def outlook(
        self,
        model: FoamModel,
        time: Fraction,
        spray: Spray,
        around: Sequence[Square],
        look: Callable[[int, Sequence[Square]], list[_Looked]],
    ) -> float:
        """Particles in the air where crests always break as at one moment; nothing is remembered."""
        if why_none(self._parameters) is not None:
            return 0.0
        found = look(math.floor(time / model.step), around)
        crests = [each.seen_in(square) for square, each in zip(around, found, strict=True)]
        return _in_the_air(crests, spray, float(model.step))

    def _looked_at(
        self,
        moments: range,
        around: Sequence[Square],
        look: Callable[[int, Sequence[Square]], list[_Looked]],
    ) -> list[tuple[int, Crests]]:
        """Crests with their moments; all others are dropped."""
        before, self._looked = self._looked, {}
        for square in around:
            known = before.get(square.where, {})
            self._looked[square.where] = {index: known[index] for index in moments if index in known}
        for index in moments:
            missing = [square for square in around if index not in self._looked[square.where]]
            for square, made in zip(missing, look(index, missing) if missing else (), strict=True):
                self._looked[square.where][index] = made
        return [
            (index, self._looked[square.where][index].seen_in(square))
            for square in around
            for index in moments
        ]


class _Cells(NamedTuple):
    """Cells by their indices in a lattice."""

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


def _water(sea: Ocean, x: Array, y: Array, time: Fraction, coast: CoastWaves | None) -> _Water:
    """Water of all waves at rest positions in m, over the bed where there is a coast."""
    fields = sea.surface(time, _OF_WATER, Places(x, y))
    whole = fields if coast is None else coast.over({name: fields[name] for name in _OF_WATER}, x, y, time)
    return _Water(*(whole[name].astype(np.float64) for name in _Water._fields))


def _broken(sea: Ocean, square: Square, time: Fraction, coast: CoastWaves | None) -> tuple[_Cells, RealArray]:
    """The cell parts of a square in which crests are torn, with strengths, or layers or breakers throw up
    spray."""
    size = square.size
    column, row = square.cells()
    x, y = ((number.astype(np.float64) + 0.5) * size for number in (column, row))
    strength: RealArray = np.zeros(x.shape, np.float32)
    if torn_rate(tearing_wind(sea.parameters).speed) > 0.0:
        strength = breaking_of(sea.foam_model, sea.compression_at(x, y, time))
    thrown = throws(sea.parameters, x, y, time)
    if coast is not None:
        thrown |= coast.breaks(x, y, time)
    broken = np.flatnonzero((strength > 0.0) | thrown)
    cells, of_cell = _in_parts(_Cells(column[broken], row[broken], size, square.level))
    return cells, strength[broken][of_cell]


def _in_parts(cells: _Cells) -> tuple[_Cells, NDArray[np.int64]]:
    """Divide cells into small parts; also returns the cell of each part."""
    cuts = min(max(1, round(cells.size / _PART)), _MOST_CUTS)
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
    births: RealArray,
) -> Crests:
    """Crests in cells around rest positions x and y in m, with the motion of the water there.

    births : particles per second and m², at an amount of 1
    """
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
        (area * births).astype(np.float32),
        np.full(len(rest), STANDS_FOR[cells.level], np.float32),
        place.astype(np.float32),
        along,
        water.velocity.astype(np.float32),
    )


def _torn(sea: OceanParameters, strength: RealArray, x: Array, y: Array, time: Fraction) -> Array:
    """Particles per second and m² that the wind tears off crests, which break with some strength at rest
    positions in m."""
    wind, loop = tearing_wind(sea), None if sea.loop_duration is None else float(sea.loop_duration)
    torn = np.minimum(strength / np.float32(_ALL_TEARS), np.float32(1.0))
    return torn_rate(wind.speed) * torn * gusts(x, y, float(time), wind.direction, sea.seed, loop)


def _in_the_air(crests: Sequence[Crests], spray: Spray, step: float) -> float:
    """Expected particles in the air, where such crests break in each moment of `step` seconds."""
    return sum(float(expected(each, spray, step).sum()) for each in crests) / step * mean_life(spray)
