# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam around a place on nested square rings: dense near it, coarse far away.

Ring n has the cells and the foam of level n (`foam_levels`). Its places drift with the foam and stay on a
lattice fixed to the water, whatever the centre: foam is the same from any viewpoint.
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

#: largest number of places along each side of a ring
SAMPLES, VERTICES = 192, 200_000
#: fractions of a ring's side, from its centre: up to the first only this ring counts, from the second only
# the next one
INNER, OUTER = 5 / 12, 11 / 24
#: fraction of a ring's side in steps of which rings follow their place; in total at most 1/2 - OUTER
_STEP = 1 / 24
_LEAST_STEP = 2


class Place(NamedTuple):
    """The centre of the rings, a rest position in m."""

    x: float
    y: float


@dataclass(frozen=True)
class Rings:
    """Foam at a time.

    corners : (x, y) of each ring's first place, a rest position in m
    foam : foam of each ring, (samples, samples) [y, x]
    beyond : foam farther away, one value per field
    """

    corners: tuple[tuple[float, float], ...]
    foam: tuple[Whitecaps, ...]
    beyond: Whitecaps


class _Ring(NamedTuple):
    """One ring.

    sea : the sea of its level
    spacing : size of its cells, m
    samples : places along each side
    """

    sea: Ocean
    spacing: float
    samples: int

    def around(self, place: Place, time: Fraction) -> tuple[int, int]:
        """Indices of the first cell of a ring around a place at a time."""
        step = round(_STEP * self.samples)
        x, y = (
            step * round((along - float(time) * drift) / self.spacing / step) - self.samples // 2
            for along, drift in zip(place, self.sea.foam_model.drift, strict=True)
        )
        return x, y

    def cells(self, first: tuple[int, int]) -> tuple[Cells, Cells]:
        """Column and row indices of a ring's cells, from its first one, (samples²,) each.

        A cell always has the same position in the array: its indices modulo the number of samples.
        """
        along = np.arange(self.samples)
        x, y = (number + (along - number) % self.samples for number in first)
        columns, rows = np.meshgrid(x, y)
        return columns.ravel(), rows.ravel()

    def foam(self, columns: Cells, rows: Cells) -> DriftingFoam:
        """Foam on some cells, still without births."""
        x, y = (self.spacing * along.astype(np.float64) for along in (columns, rows))
        return self.sea.new_drifting_foam(x, y)

    def moved_on(self, lying: _Lying | None, first: tuple[int, int]) -> tuple[_Lying, _Entering | None]:
        """The ring moved to a new first cell, and the cells that enter it; all are new if nothing
        overlaps."""
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
    """A ring at its present position: its first cell, and its foam."""

    first: tuple[int, int]
    foam: DriftingFoam


class _Entering(NamedTuple):
    """Foam on the cells that enter a ring when it moves, and their positions in its arrays."""

    foam: DriftingFoam
    where: NDArray[np.intp]


def samples_for(vertices: int) -> int:
    """Places along each side of a ring suited to a surface with this many vertices."""
    steps = round(_STEP * SAMPLES * math.sqrt(vertices / VERTICES))
    return round(min(max(steps, _LEAST_STEP), _STEP * SAMPLES) / _STEP)


class FoamRings:
    """The foam of a sea of patches around a place. Creating it is cheap.

    It is efficient for ascending times and places that move little; others are computed from scratch, with
    the same result. One thread at a time uses it while others wait.

    samples : places along each side of a ring, from `samples_for`
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
        """Foam around a place at a time in s. May be called on any thread.

        history : whether to include older foam, instead of presently breaking crests only
        told : called with the completed fraction of the history, 0…1
        """
        now = self._rings[0].sea.foam_model.reduced(time)
        firsts = [ring.around(place, now) for ring in self._rings]
        if not history:
            new = [ring.foam(*ring.cells(first)) for ring, first in zip(self._rings, firsts, strict=True)]
            return self._shown(new, firsts, now)
        with self._busy:
            # after an error, start again
            before: list[_Lying | None] = [*self._lying] or [None] * len(firsts)
            self._lying = []
            both = zip(self._rings, before, firsts, strict=True)
            moved = [ring.moved_on(lying, first) for ring, lying, first in both]
            rings = [lying.foam for lying, _ in moved]
            wanting = rings + [entering.foam for _, entering in moved if entering is not None]
            missing = [foam.missing(now) for foam in wanting]
            # one moment at a time, because rings share strains
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
