# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam of a hull: the turbulent band astern, and the spray of its bow.

It depends on when the hull last passed a place, so any frame can be computed alone. The band is as wide as
the beam where it begins and widens with the fifth root of the distance, as measured for ships (Milgram, Skop,
Peltzer & Griffin 1993). A narrow band runs from the bow along either side and outwards.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...numerics.interpolation import smoothstep
from ..contribution import OwnFoam
from .outlook import froude_number
from .track import Track

Array = NDArray[np.float64]

#: number of half-lives after which foam counts as none
_GONE = 8.0
#: length of the straight stretches of a path, in beams
_STRETCH = 1.0
#: Froude numbers at which a hull begins to make foam, and at which it makes the most
_BEGINS, _FULL = 0.08, 0.35
#: band from the bow: lateral distance per metre along the hull, width in beams, and half-life relative to
# that astern
_ASIDE, _NARROW, _SHORT = 0.12, 0.09, 0.2
#: softness of the edges of the band astern, in its width
_EDGE = 0.35


@dataclass(frozen=True)
class HullFoam:
    """The foam of one hull.

    length, beam : m
    amount : 0…1 at its origin
    half_life : s, of the band astern
    """

    track: Track
    length: float
    beam: float
    amount: float
    half_life: float
    gravity: float

    def at(self, x: Array, y: Array, time: float) -> OwnFoam:
        """Foam (places,) at rest positions in m and a time in s; breaking where the bow throws it up."""
        foam, age, breaking = (np.zeros(x.size, np.float32) for _ in range(3))
        for stretch in self._stretches(time):
            there = stretch.near(x, y, self._reach)
            if not there.size:
                continue
            since, aside = stretch.passed(x[there], y[there], time)
            for born, born_age, is_new in self._bands(stretch, since, aside):
                better = born > foam[there]
                foam[there[better]], age[there[better]] = born[better], born_age[better]
                new = np.where(is_new, born, 0.0)
                breaking[there] = np.maximum(breaking[there], new)
        breaking = np.minimum(breaking, foam)
        return OwnFoam(foam, breaking, age * (breaking == 0.0))

    def bow(self, x: Array, y: Array, time: float) -> tuple[Array, Array]:
        """Where the bow throws up water now, (places,): how much, 0 to 1, and 1 to port, -1 to starboard."""
        breaking, side = np.zeros(x.size), np.zeros(x.size)
        for stretch in self._stretches(time)[-1:]:
            there = stretch.near(x, y, self._reach)
            since, aside = stretch.passed(x[there], y[there], time)
            for born, _, is_new in self._bands(stretch, since, aside):
                breaking[there] = np.maximum(breaking[there], born * is_new)
            side[there] = np.sign(aside)
        return breaking, side

    @property
    def _reach(self) -> float:
        """m to either side, within which there may be foam."""
        return 2.0 * self.beam + _ASIDE * self.length

    def _bands(self, stretch: _Stretch, since: Array, aside: Array) -> list[tuple[Array, Array, Array]]:
        """Foam astern and from the bow, its age, and whether it breaks now.

        since : time since the middle of the hull was there, s
        aside : distance from the path, m
        """
        speed = stretch.speed
        froude = froude_number(speed, self.length, self.gravity)
        quick = float(smoothstep(np.array((froude - _BEGINS) / (_FULL - _BEGINS))))
        born = self.amount * stretch.immersion * quick
        if born <= 0.0:
            return []
        astern = since - 0.5 * self.length / speed
        width = 0.5 * self.beam * np.maximum(1.0 + astern * speed / self.beam, 1.0) ** 0.2
        across = np.clip((width - np.abs(aside)) / (_EDGE * width), 0.0, 1.0)
        fading = np.exp2(-np.maximum(astern, 0.0) / self.half_life)
        band = born * across * fading * (astern > 0.0)
        from_bow = since + 0.5 * self.length / speed
        run = from_bow * speed
        # a bow widens to the whole beam in the first third of the hull
        side = 0.5 * self.beam * np.sqrt(np.clip(3.0 * run / self.length, 0.0, 1.0)) + _ASIDE * run
        bow = np.exp(-(((np.abs(aside) - side) / (_NARROW * self.beam)) ** 2)) * (from_bow > 0.0)
        bow *= born * np.exp2(-np.maximum(from_bow, 0.0) / (_SHORT * self.half_life))
        is_new = from_bow < 0.25 * self.length / speed
        never = np.zeros(is_new.shape, bool)
        return [(band, np.maximum(astern, 0.0), never), (bow, np.maximum(from_bow, 0.0), is_new)]

    def _stretches(self, time: float) -> list[_Stretch]:
        """Straight parts of the path, the oldest first; the last goes on to where the bow is."""
        first = time - _GONE * self.half_life
        times = self.track.times
        inner = times[(times > first) & (times < time)]
        ends = [first, *inner.tolist(), time]
        places = np.array([self.track.place(each)[0] for each in ends])
        found: list[_Stretch] = []
        begin = 0
        for index in range(1, len(ends)):
            way = math.dist(places[begin], places[index])
            if way < _STRETCH * self.beam and index < len(ends) - 1:
                continue
            if way > 0.0:
                (x0, y0), (x1, y1) = places[begin].tolist(), places[index].tolist()
                share = self.track.immersion(0.5 * (ends[begin] + ends[index]))
                found.append(_Stretch(x0, y0, x1, y1, ends[begin], ends[index], share))
            begin = index
        if found:
            found[-1] = found[-1].further(0.5 * self.length)
        return found


@dataclass(frozen=True)
class _Stretch:
    """Straight on from one place to another, m, from one time to another, s."""

    x0: float
    y0: float
    x1: float
    y1: float
    begin: float
    end: float
    immersion: float

    @property
    def way(self) -> float:
        """m."""
        return math.hypot(self.x1 - self.x0, self.y1 - self.y0)

    @property
    def speed(self) -> float:
        """m/s."""
        return self.way / (self.end - self.begin)

    def further(self, way: float) -> _Stretch:
        """The same, some m longer."""
        more = 1.0 + way / self.way
        return _Stretch(
            self.x0, self.y0, self.x0 + more * (self.x1 - self.x0), self.y0 + more * (self.y1 - self.y0),
            self.begin, self.begin + more * (self.end - self.begin), self.immersion,
        )  # fmt: skip

    def near(self, x: Array, y: Array, reach: float) -> NDArray[np.intp]:
        """Which places may be within some m of it."""
        low_x, high_x = sorted((self.x0, self.x1))
        low_y, high_y = sorted((self.y0, self.y1))
        there = (x >= low_x - reach) & (x <= high_x + reach) & (y >= low_y - reach) & (y <= high_y + reach)
        found = np.flatnonzero(there)
        along = (
            (x[found] - self.x0) * (self.x1 - self.x0) + (y[found] - self.y0) * (self.y1 - self.y0)
        ) / self.way
        gap = 0.25 * reach  # on the outer side of a bend, stretches do not meet
        return found[(along >= -gap) & (along <= self.way)]

    def passed(self, x: Array, y: Array, time: float) -> tuple[Array, Array]:
        """s since something on the way was beside places, and how far these are aside, m, port positive."""
        east, north = (self.x1 - self.x0) / self.way, (self.y1 - self.y0) / self.way
        off_x, off_y = x - self.x0, y - self.y0
        along, aside = off_x * east + off_y * north, off_y * east - off_x * north
        return time - self.begin - along / self.speed, aside
