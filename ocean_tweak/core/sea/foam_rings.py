# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam around a place, on square lattices in one another: dense near it, coarse far away.

Ring n is of level n of the foam (`foam_levels`) and has its cells. Its places drift along with the foam and
are whole cells apart from where the water of time 0 was, whatever place is asked for: who looks on from
elsewhere sees the same foam.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..foam.drifting import DriftingFoam
from ..foam.model import Whitecaps
from .foam_levels import FINEST, FoamLevels
from .ocean import Ocean

Array = NDArray[np.float64]
Cells = NDArray[np.int64]

#: places along each side of a ring, at most: as many as a surface with so many vertices shows
SAMPLES, VERTICES = 192, 200_000
#: of them, from a ring's middle: up to the first it counts alone, from the second on the next one does
INNER, OUTER = 5 / 12, 11 / 24
#: of them, by which rings follow their place: all in all no more than 1/2 - OUTER
_STEP = 1 / 24
_LEAST_STEP = 2


class Place(NamedTuple):
    """Around which rings lie, at rest, m."""

    x: float
    y: float


@dataclass(frozen=True)
class Rings:
    """Foam at a time.

    corners : x and y of each ring's first place at rest, m
    foam : of each ring, (samples, samples) [y, x]
    beyond : of places farther away: each of one number
    """

    corners: tuple[tuple[float, float], ...]
    foam: tuple[Whitecaps, ...]
    beyond: Whitecaps


class _Ring(NamedTuple):
    """One ring.

    sea : of its level
    spacing : of its cells, m
    samples : along each side
    """

    sea: Ocean
    spacing: float
    samples: int

    def around(self, place: Place, time: Fraction) -> tuple[int, int]:
        """The numbers of the first cell of a ring that lies around a place at a time."""
        step = round(_STEP * self.samples)
        x, y = (
            step * round((along - float(time) * drift) / self.spacing / step) - self.samples // 2
            for along, drift in zip(place, self.sea.foam_model.drift, strict=True)
        )
        return x, y

    def cells(self, first: tuple[int, int]) -> tuple[Cells, Cells]:
        """Columns and rows of the cells of a ring with this first one, (samples²,) each.

        A cell is always at the same place of the array, whatever the ring: that of its remainder.
        """
        along = np.arange(self.samples)
        x, y = (number + (along - number) % self.samples for number in first)
        columns, rows = np.meshgrid(x, y)
        return columns.ravel(), rows.ravel()

    def foam(self, columns: Cells, rows: Cells) -> DriftingFoam:
        """Foam on some cells, without births so far."""
        x, y = (self.spacing * along.astype(np.float64) for along in (columns, rows))
        return self.sea.new_drifting_foam(x, y)

    def moved_on(self, lying: _Lying | None, first: tuple[int, int]) -> tuple[_Lying, _Entering | None]:
        """The ring with this first cell, and what is to enter it; if nothing of it stays, all is new."""
        if lying is None:
            return _Lying(first, self.foam(*self.cells(first))), None
        if lying.first == first:
            return lying, None
        columns, rows = self.cells(first)
        before = self.cells(lying.first)
        where = np.flatnonzero((columns != before[0]) | (rows != before[1]))
        if len(where) == len(columns):
            return self.moved_on(None, first)
        return _Lying(first, lying.foam), _Entering(self.foam(columns[where], rows[where]), where)


class _Lying(NamedTuple):
    """A ring as it lies: its first cell, and its foam."""

    first: tuple[int, int]
    foam: DriftingFoam


class _Entering(NamedTuple):
    """Foam on the cells that a ring gets when it moves on, and where in its arrays they come."""

    foam: DriftingFoam
    where: NDArray[np.intp]


def samples_for(vertices: int) -> int:
    """Places along each side of a ring that a surface with so many vertices, in levels of its own, shows."""
    steps = round(_STEP * SAMPLES * math.sqrt(vertices / VERTICES))
    return round(min(max(steps, _LEAST_STEP), _STEP * SAMPLES) / _STEP)


class FoamRings:
    """The foam of a sea of patches around a place. Making it is cheap.

    It serves ascending times and a place that stays near; any other is made from the sea alone, and is the
    same. One thread at a time goes on with it, and others wait.

    samples : places along each side of a ring, of `samples_for`
    """

    def __init__(self, levels: FoamLevels, samples: int = SAMPLES) -> None:
        self._levels = levels
        self._samples = samples
        self._busy = threading.Lock()
        self._lying: list[_Lying] = []

    @property
    def nbytes(self) -> int:
        """Bytes of the places and their births."""
        return sum(lying.foam.nbytes for lying in self._lying)

    def at(
        self,
        time: float | Fraction,
        place: Place,
        history: bool = True,
        told: Callable[[float], None] = lambda _: None,
    ) -> Rings:
        """Foam around a place at a time in s. It may be called on any thread.

        history : whether what is left of earlier moments is wanted too, and not what breaks now alone
        told : hears the share of these moments, 0…1, that is remembered by now
        """
        now = self._rings[0].sea.foam_model.reduced(time)
        firsts = [ring.around(place, now) for ring in self._rings]
        if not history:
            new = [ring.foam(*ring.cells(first)) for ring, first in zip(self._rings, firsts, strict=True)]
            return self._shown(new, firsts, now)
        with self._busy:
            # whoever fails on the way begins anew
            before: list[_Lying | None] = [*self._lying] or [None] * len(firsts)
            self._lying = []
            both = zip(self._rings, before, firsts, strict=True)
            moved = [ring.moved_on(lying, first) for ring, lying, first in both]
            rings = [lying.foam for lying, _ in moved]
            wanting = rings + [entering.foam for _, entering in moved if entering is not None]
            missing = [foam.missing(now) for foam in wanting]
            # moment by moment, because rings share strains
            moments = sorted({index for each in missing for index in each})
            for number, index in enumerate(moments):
                told(number / len(moments))
                for foam, of_foam in zip(wanting, missing, strict=True):
                    if index in of_foam:
                        foam.remember(index)
            for lying, entering in moved:
                if entering is not None:
                    lying.foam.put(entering.where, entering.foam)
            self._lying = [lying for lying, _ in moved]
            return self._shown(rings, firsts, now)

    @cached_property
    def _rings(self) -> tuple[_Ring, ...]:
        return tuple(
            _Ring(sea, FINEST * 2.0**level, self._samples) for level, sea in enumerate(self._levels.seas)
        )

    def _shown(
        self, rings: Sequence[DriftingFoam], firsts: Sequence[tuple[int, int]], now: Fraction
    ) -> Rings:
        corners, shown = [], []
        for level, (ring, foam, first) in enumerate(zip(self._rings, rings, firsts, strict=True)):
            drift = ring.sea.foam_model.drift
            x, y = (number * ring.spacing + float(now) * by for number, by in zip(first, drift, strict=True))
            corners.append((x, y))
            back = [-(number % self._samples) for number in reversed(first)]
            own = (
                np.roll(field.reshape(self._samples, self._samples), back, axis=(0, 1))
                for field in foam.whitecaps(now)
            )
            shown.append(self._levels.mixed(Whitecaps(*own), level))
        return Rings(tuple(corners), tuple(shown), self._levels.beyond)
