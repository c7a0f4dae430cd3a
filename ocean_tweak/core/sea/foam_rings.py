# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam around a place, on square lattices in one another: dense near it, coarse far away.

Ring n has cells of the size FINEST·2ⁿ, and its foam is that of the sea without the waves shorter than four of
them: it is born on the crests that can be seen at that distance, with the threshold that belongs to them, and
no lattice shows. Its places drift along with the foam and are whole cells apart from where the water of time
0 was, whatever place is asked for: who looks on from elsewhere sees the same foam.

The coarser a ring, the less it knows of what breaks. Of its foam F counts the share κ of the strains'
variance that it holds, and for the rest the mean W of the sea, κF + (1 - κ)W: the mean stays, and what cannot
be known is even. Beyond the last ring there is W alone. Dupuy & Bruneton (2012) average whitecaps over the
waves that are too small to be seen for the same reason.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..foam.drifting import DriftingFoam
from ..foam.model import Whitecaps
from ..foam.threshold import foam_outlook
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.patch_seas import waves_above
from .ocean import Ocean

Array = NDArray[np.float64]

#: m, of the cells around the place
FINEST = 0.25
#: places along each side of a ring
SAMPLES = 192
#: cells from a ring's middle: up to the first it counts alone, from the second on the next one does
INNER, OUTER = 80, 88
#: cells by which rings follow their place: all in all no more than SAMPLES/2 - OUTER
_STEP = 8
#: cells in a ring's shortest wave
_CELLS_A_WAVE = 4.0
#: samples of a patch along its shortest wave: read between them, a fourth of that wave's variance is lost,
#: and less of longer ones
_SAMPLES_A_WAVE = 4.25
#: by how much longer a ring's shortest wave may be than a patch's, and the patch is whole all the same: rings
#: share the strains of a patch that they both have whole
_WHOLE = 1.15
#: a ring whose waves have less of the strains' variance than this tells little
_LEAST_SHARE = 0.15
_MOST_RINGS = 10


class Place(NamedTuple):
    """Around which rings lie, at rest, m."""

    x: float
    y: float


@dataclass(frozen=True)
class Rings:
    """Foam at a time.

    corners : x and y of each ring's first place at rest, m
    foam : of each ring, (SAMPLES, SAMPLES) [y, x]
    beyond : of places farther away: each of one number
    """

    corners: tuple[tuple[float, float], ...]
    foam: tuple[Whitecaps, ...]
    beyond: Whitecaps


class _Ring:
    """One ring.

    parameters : of the sea with all waves
    spacing : of its cells, m
    """

    def __init__(self, parameters: OceanParameters, spacing: float) -> None:
        self.spacing = spacing
        # foam that is made coarser elsewhere is coarse by the rings alone here
        sea = parameters.replace(foam=replace(parameters.foam, resolution=0), patches=parameters.patches)
        shortest = _CELLS_A_WAVE * spacing
        ends = (patch.shortest_wavelength for patch in sea.patches)
        shortest = next((end for end in ends if end <= shortest <= _WHOLE * end), shortest)
        self.sea = Ocean(waves_above(sea, shortest, _SAMPLES_A_WAVE))

    def around(self, place: Place, time: Fraction) -> tuple[int, int]:
        """The numbers of the first cell of a ring that lies around a place at a time."""
        x, y = (
            _STEP * round((along - float(time) * drift) / self.spacing / _STEP) - SAMPLES // 2
            for along, drift in zip(place, self.sea.foam_model.drift, strict=True)
        )
        return x, y

    def foam(self, first: tuple[int, int]) -> DriftingFoam:
        """Foam on the ring with this first cell, without births so far."""
        along = self.spacing * np.arange(SAMPLES)
        x, y = np.meshgrid(*(number * self.spacing + along for number in first))
        return self.sea.new_drifting_foam(x.ravel(), y.ravel())


class FoamRings:
    """The foam of a sea of patches around a place. Making it is cheap.

    It serves ascending times and a place that stays near; any other is made from the sea alone, and is the
    same. One thread at a time goes on with it, and others wait.
    """

    def __init__(self, parameters: OceanParameters) -> None:
        self._parameters = parameters
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
        """As many as tell anything of the strains."""
        found = [_Ring(self._parameters, FINEST)]
        least = _LEAST_SHARE * found[0].sea.divergence_variance
        for _ in range(_MOST_RINGS - 1):
            ring = _Ring(self._parameters, 2.0 * found[-1].spacing)
            if ring.sea.divergence_variance <= least:
                break
            found.append(ring)
        return tuple(found)

    @cached_property
    def _beyond(self) -> Whitecaps:
        """What the mean of the sea is."""
        foam = foam_outlook(self._parameters).coverage
        breaking = min(self._rings[0].sea.mean_breaking, foam)
        # births are as frequent at any time before, so what is left of them is exponential in its age
        age = self._parameters.foam.half_life / math.log(2.0)
        return Whitecaps(*(np.array(value, np.float32) for value in (foam, breaking, age)))

    def _shown(self, rings: Sequence[DriftingFoam], now: Fraction) -> Rings:
        corners = [tuple(float(along[0]) for along in foam.places(now)) for foam in rings]
        shown = [
            self._mixed(foam.whitecaps(now), ring.sea.divergence_variance)
            for ring, foam in zip(self._rings, rings, strict=True)
        ]
        return Rings(tuple((x, y) for x, y in corners), tuple(shown), self._beyond)

    def _mixed(self, own: Whitecaps, variance: float) -> Whitecaps:
        """Foam of a ring, of which counts the share of the strains' variance that it holds."""
        share = np.float32(variance / self._rings[0].sea.divergence_variance)
        foam, breaking, age = (field.reshape(SAMPLES, SAMPLES) for field in own)
        mean = self._beyond
        rest = np.float32(1.0) - share
        return Whitecaps(
            share * foam + rest * mean.foam,
            share * breaking + rest * mean.breaking,
            np.where(share * foam >= rest * mean.foam, age, mean.foam_age),
        )
