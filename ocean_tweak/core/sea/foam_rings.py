# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam around a place, on square lattices in one another: dense near it, coarse far away.

Ring n has cells of the size FINEST·2ⁿ, and its foam is that of the sea without the waves shorter than four of
them: it is born on the crests that can be seen at that distance, with the threshold that belongs to them, and
no lattice shows. Its places drift along with the foam and are whole cells apart from where the water of time
0 was, whatever place is asked for: who looks on from elsewhere sees the same foam.

The coarser a ring, the less it knows of what breaks. Of its foam F counts the share κ of the strains' variance
that it holds, and for the rest the mean W of the sea, κF + (1 - κ)W: the mean stays, and what cannot be known
is even. Beyond the last ring there is W alone. Dupuy & Bruneton (2012) average whitecaps over the waves that
are too small to be seen for the same reason.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..foam.model import DriftingFoam, FoamModel, Whitecaps
from ..foam.threshold import foam_outlook
from ..parameters.ocean_parameters import Foam, OceanParameters
from ..parameters.patch_seas import waves_above
from .ocean import Ocean

Array = NDArray[np.float64]

#: m, of the cells around the place
FINEST = 0.25
#: places along each side of a ring
SAMPLES = 192
#: cells from a ring's middle, of which the ring before counts alone within the first, and not beyond the second
INNER, OUTER = 80, 88
#: cells by which rings follow their place: all in all no more than SAMPLES/2 - OUTER
_STEP = 8
#: cells in a ring's shortest wave
_CELLS_A_WAVE = 4.0
#: samples of a patch along its shortest wave: read between them, a seventh of that wave's variance is lost, and
#: less of longer ones
_SAMPLES_A_WAVE = 6.0
#: a ring whose waves have less of the strains' variance than this tells nothing
_LEAST_SHARE = 0.02
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
        sea = parameters.replace(foam=_in_full(parameters.foam), patches=parameters.patches)
        self.sea = Ocean(waves_above(sea, _CELLS_A_WAVE * spacing, _SAMPLES_A_WAVE))
        self._first = (0, 0)
        self._foam: DriftingFoam | None = None

    @property
    def nbytes(self) -> int:
        return 0 if self._foam is None else self._foam.nbytes

    @property
    def foam(self) -> DriftingFoam:
        """Of the places around which it lies now."""
        assert self._foam is not None
        return self._foam

    def follow(self, place: Place, time: Fraction) -> None:
        """Lie around a place at a time, without births where that is elsewhere than before."""
        drift = self.sea.foam_model.drift
        first = tuple(
            _STEP * round((along - float(time) * v) / self.spacing / _STEP) - SAMPLES // 2
            for along, v in zip(place, drift, strict=True)
        )
        if self._foam is not None and first == self._first:
            return
        self._first = (first[0], first[1])
        along = self.spacing * np.arange(SAMPLES)
        x, y = np.meshgrid(first[0] * self.spacing + along, first[1] * self.spacing + along)
        self._foam = self.sea.new_drifting_foam(x.ravel(), y.ravel())

    def corner(self, time: Fraction) -> tuple[float, float]:
        x, y = self.foam.places(time)
        return float(x[0]), float(y[0])


def _in_full(foam: Foam) -> Foam:
    return Foam(coverage=foam.coverage, half_life=foam.half_life, drift=foam.drift)


class FoamRings:
    """The foam of a sea of patches around a place. Making it is cheap.

    It serves ascending times and a place that stays near; any other is made from the sea alone, and is the
    same. One thread at a time goes on with it, and others wait.
    """

    def __init__(self, parameters: OceanParameters) -> None:
        self._parameters = parameters
        self._busy = threading.Lock()
        self._rings: tuple[_Ring, ...] = ()
        self._shares: tuple[float, ...] = ()
        self._beyond: Whitecaps | None = None

    @property
    def nbytes(self) -> int:
        """Bytes of the places and their births."""
        return sum(ring.nbytes for ring in self._rings)

    def at(self, time: float | Fraction, place: Place) -> Rings:
        """Foam around a place at a time in s, with its history. It may be called on any thread."""
        with self._busy:
            self._make()
            now = self._model.reduced(time)
            for ring in self._rings:
                ring.follow(place, now)
            missing = [ring.foam.missing(now) for ring in self._rings]
            # moment by moment, because rings share strains
            for index in sorted({index for each in missing for index in each}):
                for ring, of_ring in zip(self._rings, missing, strict=True):
                    if index in of_ring:
                        ring.foam.remember(index)
            assert self._beyond is not None
            return Rings(
                tuple(ring.corner(now) for ring in self._rings), tuple(self._mixed(now)), self._beyond
            )

    @property
    def _model(self) -> FoamModel:
        return self._rings[0].sea.foam_model

    def _make(self) -> None:
        """The rings, as many as tell anything of the strains."""
        if self._rings:
            return
        rings = [_Ring(self._parameters, FINEST)]
        variances = [rings[0].sea.divergence_variance]
        while len(rings) < _MOST_RINGS:
            ring = _Ring(self._parameters, 2.0 * rings[-1].spacing)
            variance = ring.sea.divergence_variance
            if variance < _LEAST_SHARE * variances[0]:
                break
            rings.append(ring)
            variances.append(variance)
        self._rings = tuple(rings)
        self._shares = tuple(variance / max(variances[0], 1e-300) for variance in variances)
        foam = foam_outlook(self._parameters).coverage
        # births are as frequent at any time before, so what is left of them is exponential in its age
        values = foam, min(rings[0].sea.mean_breaking, foam), self._parameters.foam.half_life / math.log(2.0)
        self._beyond = Whitecaps(*(np.array([value], np.float32) for value in values))

    def _mixed(self, now: Fraction) -> Iterator[Whitecaps]:
        """Foam of each ring, of which its share counts."""
        beyond = self._beyond
        assert beyond is not None
        for ring, share in zip(self._rings, self._shares, strict=True):
            foam, breaking, age = (
                field.reshape(SAMPLES, SAMPLES) for field in ring.foam.whitecaps(now)
            )
            own, mean = np.float32(share), np.float32(1.0 - share)
            yield Whitecaps(
                own * foam + mean * beyond.foam,
                own * breaking + mean * beyond.breaking,
                np.where(foam > beyond.foam, age, own * age + mean * beyond.foam_age),
            )
