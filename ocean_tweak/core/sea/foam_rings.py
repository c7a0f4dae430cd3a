# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam around a place, on square lattices in one another: dense near it, coarse far away.

Ring n is of level n of the foam (`foam_levels`) and has its cells. Its places drift along with the foam and
are whole cells apart from where the water of time 0 was, whatever place is asked for: who looks on from
elsewhere sees the same foam.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
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

    def foam(self, first: tuple[int, int]) -> DriftingFoam:
        """Foam on the ring with this first cell, without births so far."""
        along = self.spacing * np.arange(self.samples)
        x, y = np.meshgrid(*(number * self.spacing + along for number in first))
        return self.sea.new_drifting_foam(x.ravel(), y.ravel())


def samples_for(vertices: int) -> int:
    """Places along each side of a ring that a surface with so many vertices, in levels of its own, shows."""
    steps = math.ceil(_STEP * SAMPLES * math.sqrt(vertices / VERTICES))
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
        self._foam: dict[int, tuple[tuple[int, int], DriftingFoam]] = {}

    @property
    def nbytes(self) -> int:
        """Bytes of the places and their births."""
        return sum(foam.nbytes for _, foam in self._foam.values())

    def at(self, time: float | Fraction, place: Place, history: bool = True) -> Rings:
        """Foam around a place at a time in s. It may be called on any thread.

        history : whether what is left of earlier moments is wanted too, and not what breaks now alone
        """
        now = self._rings[0].sea.foam_model.reduced(time)
        lying = [ring.around(place, now) for ring in self._rings]
        if not history:
            return self._shown(
                [ring.foam(first) for ring, first in zip(self._rings, lying, strict=True)], now
            )
        with self._busy:
            for number, (ring, first) in enumerate(zip(self._rings, lying, strict=True)):
                if number not in self._foam or self._foam[number][0] != first:
                    self._foam[number] = first, ring.foam(first)
            rings = [self._foam[number][1] for number in range(len(self._rings))]
            missing = [foam.missing(now) for foam in rings]
            # moment by moment, because rings share strains
            for index in sorted({index for each in missing for index in each}):
                for foam, of_ring in zip(rings, missing, strict=True):
                    if index in of_ring:
                        foam.remember(index)
            return self._shown(rings, now)

    @cached_property
    def _rings(self) -> tuple[_Ring, ...]:
        return tuple(
            _Ring(sea, FINEST * 2.0**level, self._samples) for level, sea in enumerate(self._levels.seas)
        )

    def _shown(self, rings: Sequence[DriftingFoam], now: Fraction) -> Rings:
        corners = [tuple(float(along[0]) for along in foam.places(now)) for foam in rings]
        shown = []
        for level, foam in enumerate(rings):
            own = (field.reshape(self._samples, self._samples) for field in foam.whitecaps(now))
            shown.append(self._levels.mixed(Whitecaps(*own), level))
        return Rings(tuple((x, y) for x, y in corners), tuple(shown), self._levels.beyond)
