# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray at a time, from crests that broke at earlier moments; particles are independent of each other.

A hash of cell, moment and seed determines whether a cell emits a particle and how it flies. So any frame can
be computed alone, in any order, with the same bytes, and the amount, size, wind and life can be changed
independently.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..numerics import random
from ..parameters.spray import Spray
from ..waves.contribution import Wind
from . import drops
from .flight import Flight

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: wind a metre or two above the water, which carries spray, relative to that at 10 m
_CARRYING = 0.75
#: velocities of the air's turbulence along the wind, across it and up, in friction velocities (Panofsky &
#: Dutton 1984); over some seconds they stay (Taylor 1921)
_TURBULENCE = (2.4, 1.9, 1.25)
#: that of mist up, which stays in the air for longer than an eddy near the water: what rises does so at the
# rate of a plume over ground, 0.4 friction velocities on average (Batchelor 1964)
_RISING = 0.5
#: initial fraction of the carrying wind by kind of particle, minimum and maximum
_AT_ONCE = {drops.SPUME: (0.15, 0.5), drops.DROPLET: (0.0, 0.2), drops.MIST: (0.3, 0.8)}
#: largest upward speed of launched drops in m/s: a constant, and a factor of the wind at 10 m
_UPWARD, _UPWARD_BY_WIND = 3.5, 0.04
#: variation of both among the particles of a gust
_DIFFERENCE = 0.35
#: largest life of drops in s, by which they have fallen back
_DROPS_FLY = 2.0
#: drawn radii: the drop that has that of the settings, m; a piece of a sheet of spume, and mist, over it; and
#: the friction velocities by which mist spreads
_DRAWN_AS, _SHEET, _MIST, _SPREADING = 0.5e-3, 16.0, 240.0, 0.3

#: mist is seen from afar, in streaks as wide as its puffs: largest number that one may represent
_PUFFS = 4.0

#: mean time in the air: of drops in s, and of mist relative to its life, at a wind of 25 m/s
_DROPS_STAY, _MIST_STAYS = 0.47, 0.35
#: bytes per particle while frames are computed and shown
BYTES = 300

# random streams of a cell, a gust and a particle
_COUNT, _GUST, _UP, _ALONG = range(4)
_TIME, _COLUMN, _ROW, _KIND, _RADIUS, _OWN_UP, _OWN_ALONG, _AIR = range(8)


class Crests(NamedTuple):
    """Breaking crests at a moment; (cells,) arrays of cells with a crest.

    key, gust : hashes of the cell, and of the gust at its place
    births : particles per second at an amount of 1
    stands_for : number of drops that one of the cell's represents, by which it is larger
    place : (cells, 3) centre, m
    along : (cells, 2, 3) half extents along columns and along rows, m
    velocity : (cells, 3) of the water, m/s
    """

    key: NDArray[np.uint64]
    gust: NDArray[np.uint64]
    births: RealArray
    stands_for: RealArray
    place: RealArray
    along: RealArray
    velocity: RealArray

    @property
    def nbytes(self) -> int:
        """Bytes of all arrays."""
        return sum(part.nbytes for part in self)


class Particles(NamedTuple):
    """Spray at a time; (particles,) arrays.

    position, velocity : (particles, 3) float32, m and m/s
    radius : for display, float32, m
    age : float32, s
    id : constant over its life, int64, above 0
    kind : `drops.SPUME`, DROPLET or MIST, int8
    """

    position: RealArray
    velocity: RealArray
    radius: RealArray
    age: RealArray
    id: NDArray[np.int64]
    kind: NDArray[np.int8]


def mean_life(spray: Spray) -> float:
    """Mean time of a particle in the air in s, over all kinds."""
    mist = drops.SHARE[drops.MIST]
    return (1.0 - mist) * min(spray.life, _DROPS_STAY) + mist * _MIST_STAYS * spray.life


def expected(crests: Crests, spray: Spray, step: float) -> RealArray:
    """(cells,) expected particles emitted by cells in a moment of `step` seconds, averaged over gusts."""
    drop, puff = _of_drops_and_mist(crests)
    return crests.births * (drop + puff) * np.float32(spray.amount * step)


def _of_drops_and_mist(crests: Crests) -> tuple[RealArray, RealArray]:
    """(cells,) of all particles that cells throw up, the drops and the puffs of mist that are made."""
    mist = np.float32(drops.SHARE[drops.MIST])
    return (1 - mist) / crests.stands_for, mist / np.minimum(crests.stands_for, np.float32(_PUFFS))


def in_the_air(crests: Crests, spray: Spray, wind: Wind, step: float, since: float) -> Particles:
    """Particles emitted by the crests of a moment that are still in the air.

    step : duration of the moment, s; particles start at any time in it
    since : time from its middle to now, s
    """
    count = _counts(crests, spray, step)
    cell = np.repeat(np.arange(len(count)), count)
    number = np.arange(len(cell)) - np.repeat(np.cumsum(count) - count, count)
    key = random.members(crests.key[cell], number)
    offset = ((random.uniform(key, _TIME) - 0.5) * step).astype(np.float32)
    age = np.float32(since) - offset
    drop, puff = _of_drops_and_mist(crests)
    kind = drops.kinds(random.uniform(key, _KIND), (puff / (drop + puff))[cell])
    lives = (age >= 0.0) & (age <= np.where(kind == drops.MIST, spray.life, min(spray.life, _DROPS_FLY)))
    cell, key, offset, age, kind = cell[lives], key[lives], offset[lives], age[lives], kind[lives]
    radius = drops.radii(kind, random.uniform(key, _RADIUS))
    flight = _launched(crests, cell, key, kind, radius, offset, spray, wind)
    position, velocity = flight.at(age)
    above = flight.is_above(position)
    stands_for = crests.stands_for[cell]
    stands_for = np.where(kind == drops.MIST, np.minimum(stands_for, np.float32(_PUFFS)), stands_for)
    drawn = _drawn(kind, radius, age, spray, wind) * np.sqrt(stands_for)
    made = position, velocity, drawn, age, _ids(key), kind
    return Particles._make(each[above] for each in made)


def joined(parts: list[Particles]) -> Particles:
    """Concatenate the particles of several moments."""
    if not parts:
        none = np.empty(0, np.float32)
        at = np.empty((0, 3), np.float32)
        return Particles(at, at, none, none, np.empty(0, np.int64), np.empty(0, np.int8))
    return Particles._make(np.concatenate(each) for each in zip(*parts, strict=True))


def _counts(crests: Crests, spray: Spray, step: float) -> NDArray[np.int64]:
    """(cells,) numbers of particles, exponentially distributed over gusts."""
    torn = expected(crests, spray, step) * -np.log(random.uniform(crests.gust, _GUST))
    return np.asarray(np.floor(torn + random.uniform(crests.key, _COUNT)).astype(np.int64))


def _launched(
    crests: Crests,
    cell: NDArray[np.int64],
    key: NDArray[np.uint64],
    kind: NDArray[np.int8],
    radius: RealArray,
    offset: RealArray,
    spray: Spray,
    wind: Wind,
) -> Flight:
    """Positions on the water, launch velocities, and velocities of the air."""
    water = crests.velocity[cell]
    start = crests.place[cell] + water * offset[:, np.newaxis]
    for axis, stream in enumerate((_COLUMN, _ROW)):
        share = (2.0 * random.uniform(key, stream) - 1.0).astype(np.float32)
        start += crests.along[cell, axis] * share[:, np.newaxis]
    carrying = _CARRYING * spray.wind * wind.speed
    direction = np.array([math.cos(wind.direction), math.sin(wind.direction)], np.float32)
    gust = crests.gust[cell]
    ends = np.array([_AT_ONCE[each] for each in (drops.SPUME, drops.DROPLET, drops.MIST)], np.float32)[kind]
    along = _between(ends[:, 0], ends[:, 1], gust, _ALONG, key, _OWN_ALONG) * np.float32(carrying)
    most = np.float32(_UPWARD + _UPWARD_BY_WIND * wind.speed)
    up = _between(np.float32(0.0), most, gust, _UP, key, _OWN_UP)
    velocity = water.copy()
    velocity[:, :2] += along[:, np.newaxis] * direction
    velocity[:, 2] += up
    air = _air(key, kind, carrying, direction, spray, wind)
    return Flight(start, velocity, air, drops.response_time(radius))


def _between(
    least: RealArray | np.float32,
    most: RealArray | np.float32,
    gust: NDArray[np.uint64],
    of_gust: int,
    key: NDArray[np.uint64],
    own: int,
) -> RealArray:
    """Numbers in a range, float32, similar within a gust."""
    share = (1.0 - _DIFFERENCE) * random.uniform(gust, of_gust) + _DIFFERENCE * random.uniform(key, own)
    return np.asarray(least + (most - least) * share.astype(np.float32))


def _air(
    key: NDArray[np.uint64],
    kind: NDArray[np.int8],
    carrying: float,
    direction: RealArray,
    spray: Spray,
    wind: Wind,
) -> RealArray:
    """(particles, 3) wind around each, m/s, at most that at 10 m."""
    along, across, up = (
        np.float32(times * spray.wind * friction_velocity(wind.speed))
        * _bounded_normal(key, _AIR + 2 * index)
        for index, times in enumerate(_TURBULENCE)
    )
    up *= np.where(kind == drops.MIST, np.float32(_RISING / _TURBULENCE[2]), np.float32(1.0))
    along += np.float32(carrying)
    x, y = direction
    air = np.stack((x * along - y * across, y * along + x * across, up), axis=-1)
    speed = np.sqrt((air * air).sum(axis=-1, keepdims=True))
    most = np.float32(spray.wind * wind.speed)
    return np.asarray(air * np.minimum(most / np.maximum(speed, np.float32(1e-6)), np.float32(1.0)))


def friction_velocity(wind_speed: float) -> float:
    """Friction velocity of the air, m/s, for a wind in m/s at 10 m: the drag coefficient is (0.61 + 0.063
    U)·10⁻³ (Smith 1980)."""
    return wind_speed * math.sqrt((0.61 + 0.063 * wind_speed) * 1e-3)


def _bounded_normal(key: NDArray[np.uint64], stream: int) -> RealArray:
    """Numbers of mean 0 and variance 1 from two streams, with a triangular distribution that ends at 2.45."""
    total = random.uniform(key, stream) + random.uniform(key, stream + 1) - 1.0
    return np.asarray((math.sqrt(6.0) * total).astype(np.float32))


def _drawn(kind: NDArray[np.int8], radius: RealArray, age: RealArray, spray: Spray, wind: Wind) -> RealArray:
    """Display radii in m: spume is a piece of a sheet, mist many drops, spread by turbulence."""
    drawn = radius * np.where(kind == drops.SPUME, np.float32(_SHEET), np.float32(1.0))
    drawn *= np.float32(spray.size / _DRAWN_AS)
    spread = _MIST * spray.size + _SPREADING * friction_velocity(wind.speed) * age
    return np.where(kind == drops.MIST, spread, drawn).astype(np.float32)


def _ids(key: NDArray[np.uint64]) -> NDArray[np.int64]:
    return np.asarray(np.maximum(key >> np.uint64(1), np.uint64(1)).astype(np.int64))
