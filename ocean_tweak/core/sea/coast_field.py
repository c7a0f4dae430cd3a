# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves over a bed at a time: the weighted sum of their pictures, the shape of individual waves, and foam."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..foam.model import FAINTEST
from ..numerics.memo import MEMO
from ..parameters.ocean_parameters import OceanParameters
from ..synthesis.transforms import X, Y, Z
from ..waves.coast.breakers import Shape, least_broken, shape_of, whiteness
from ..waves.coast.differences import Differences
from ..waves.coast.ground import Ground
from ..waves.coast.march import SHALLOWEST, wave_numbers
from ..waves.contribution import OwnFoam
from .coast_pictures import Pictures
from .sampling import Key

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]
ComplexArray = NDArray[np.complexfloating]

#: moments per second at which foam may be born
_LOOKS = 4
#: share of waves that break from which on they do for lack of depth
_FEW = 0.02
#: fraction of a front's foam that stays on the water, and s in which half of the rest, whose bubbles are
#: still rising, has gone
_STAYS, _RISING = 0.4, 0.6
#: s, by which the shape's rate is taken
_MOMENT = 0.001

_BIRTHS = "breakers on coasts"
MEMO.limit(_BIRTHS, 8)


class OverBed:
    """The waves over a bed, on its samples (rows, columns), x along the march.

    sea : whose waves they are
    pictures, ground : what became of them
    broken_share : (rows, columns) of waves
    dtype : of the fields' numbers
    """

    def __init__(
        self,
        sea: OceanParameters,
        pictures: Pictures,
        ground: Ground,
        broken_share: Array,
        dtype: type,
    ) -> None:
        self._sea, self._pictures, self._ground, self._dtype = sea, pictures, ground, dtype
        self._wet = ground.depth > 0.0
        # of these waves as many are to break as of all
        self._least = least_broken(pictures.rms_height, broken_share[self._wet]).astype(np.float32)
        # single waves may break far out: such are whitecaps, which the open sea's foam has
        share = broken_share[self._wet]
        self._of_breaking = hashlib.sha256(share.tobytes()).digest()
        self._breaks, self._strength = share > _FEW, np.clip(share / _FEW - 1.0, 0.0, 1.0).astype(np.float32)

    def components(self, time: float | Fraction, keys: Iterable[Key]) -> dict[Key, RealArray]:
        """(rows, columns) of the displacement, and their derivatives."""
        wanted = frozenset(keys)
        frame = _Frame(self, time, {by == "t" for _, by in wanted})
        return {key: frame.component(*key) for key in wanted}

    def signal(self, time: float | Fraction) -> ComplexArray:
        """(wet samples,) complex64 m; its real part is the elevation of the waves before shaping."""
        return self._pictures.signal(self.factor(time))

    def elevation(self, time: float | Fraction) -> RealArray:
        """(rows, columns) m."""
        return self._spread(self._shape.elevation(self.signal(time)))

    def elevations(self, time: float | Fraction, rates: bool) -> tuple[RealArray, RealArray | None]:
        """(rows, columns) m, and where wanted m/s."""
        factor = self.factor(time)
        if not rates:
            return self.elevation(time), None
        signal, rate = (self._pictures.signal(each) for each in (factor, factor * self._rates))
        now, later = self._shape.elevation(signal), self._shape.elevation(signal + rate * np.float32(_MOMENT))
        return self._spread(now), self._spread((later - now) / np.float32(_MOMENT))

    def potentials(self, time: float | Fraction, rates: bool) -> tuple[RealArray, RealArray | None]:
        """(rows, columns) of the horizontal displacement, choppiness applied, and where wanted its rate."""
        factor = self.factor(time) * self._sea.choppiness
        if not rates:
            return self._spread(self._pictures.potential_sum(factor)), None
        still, moving = (self._pictures.potential_sum(each) for each in (factor, factor * self._rates))
        return self._spread(still), self._spread(moving)

    @cached_property
    def differences(self) -> Differences:
        """Derivatives on the samples."""
        return Differences(self._wet, self._ground.step)

    def foam(self, time: float | Fraction) -> OwnFoam:
        """Foam (rows, columns) of depth-limited breaking, and remaining foam of earlier breakers.

        As foam is anywhere, the largest of 2^(-age/T) c over the present and over moments before it; but a
        front is a roller, of which the water behind it soon keeps only a share.
        """
        foam = self._sea.foam
        breaking = self._white(time)
        left, age = breaking.copy(), np.zeros_like(breaking)
        now = Fraction(time)
        last = math.floor(now * _LOOKS)
        memory = math.floor(-math.log2(FAINTEST) * foam.half_life * _LOOKS)
        for index in range(last, last - memory, -1):
            since = float(now - Fraction(index, _LOOKS))
            left_of_it = (_STAYS + (1.0 - _STAYS) * 2.0 ** (-since / _RISING)) * 2.0 ** (
                -since / foam.half_life
            )
            then = self._births(index) * np.float32(left_of_it)
            more = then > left
            np.copyto(left, then, where=more)
            np.copyto(age, np.float32(since), where=more)
        return OwnFoam(*(self._spread(each).astype(np.float32) for each in (left, breaking, age)))

    def _births(self, index: int) -> RealArray:
        """Breaking at one of the moments shared by all frames, (wet samples,) float32."""
        key = (self._pictures, self._of_breaking, index, self._sea.foam.coverage)
        return MEMO.get(_BIRTHS, key, lambda: self._white(Fraction(index, _LOOKS)))

    def fronts(self, time: float | Fraction) -> tuple[RealArray, RealArray]:
        """Whiteness of the fronts of broken waves, 0…1, and the height of each wave in m, (rows, columns)."""
        signal = self.signal(time)
        return self._spread(self._whiteness(signal)), self._spread(2.0 * np.abs(signal))

    def _white(self, time: float | Fraction) -> RealArray:
        strength = np.float32(min(1.0, self._sea.foam.coverage))
        return strength * self._whiteness(self.signal(time))

    def _whiteness(self, signal: ComplexArray) -> RealArray:
        white, there = np.zeros(len(self._least), np.float32), self._breaks
        white[there] = self._strength[there] * whiteness(signal[there], self._least[there])
        return white

    @cached_property
    def _shape(self) -> Shape:
        """Of single waves at wet samples: none over the rim, where the open sea goes over."""
        omega, energy = -np.imag(self._rates), self._pictures.energy
        # of no waves any frequency will do
        mean = float(energy @ omega) / float(energy.sum()) if energy.any() else 1.0
        depth = np.maximum(self._ground.depth[self._wet], SHALLOWEST)
        share = np.broadcast_to(self._ground.bed_share[:, np.newaxis], self._wet.shape)[self._wet]
        k = wave_numbers(np.array(mean), depth, self._sea.water.gravity)
        return shape_of(self._pictures.rms_height / math.sqrt(2.0), k, depth, share)

    @property
    def _rates(self) -> ComplexArray:
        """-iω of each picture, rad/s."""
        period = self._sea.repeats_after
        assert period is not None
        return -2j * np.pi / float(period) * self._pictures.numbers

    def factor(self, time: float | Fraction) -> ComplexArray:
        """e^(-iωt), exact after any number of repeats."""
        period = self._sea.repeats_after
        assert period is not None
        turns = self._pictures.numbers * float(Fraction(time) % period / period)
        factor: ComplexArray = np.exp(-2j * np.pi * (turns - np.rint(turns)))
        return factor

    def _spread(self, values: RealArray) -> RealArray:
        """(rows, columns), 0 on land, from those of wet samples."""
        field: RealArray = np.zeros(self._wet.shape, self._dtype)
        field[self._wet] = values
        return field


class _Frame:
    """Components at a time, each made when it is first asked for."""

    def __init__(self, waves: OverBed, time: float | Fraction, rates: set[bool]) -> None:
        self._waves, self._time, self._moves = waves, time, True in rates
        self._made: dict[Key, RealArray] = {}

    @cached_property
    def _elevations(self) -> tuple[RealArray, RealArray | None]:
        return self._waves.elevations(self._time, self._moves)

    @cached_property
    def _potentials(self) -> tuple[RealArray, RealArray | None]:
        return self._waves.potentials(self._time, self._moves)

    def component(self, component: int, derivative: str) -> RealArray:
        """The displacement's component or its derivative."""
        key = component, derivative
        if key not in self._made:
            self._made[key] = self._new(component, derivative)
        return self._made[key]

    def _new(self, component: int, derivative: str) -> RealArray:
        if derivative in ("x", "y"):
            return self._waves.differences.by(self.component(component, ""), "xy".index(derivative))
        of = (self._elevations if component == Z else self._potentials)[derivative == "t"]
        assert of is not None
        return of if component == Z else self._waves.differences.by(of, (X, Y).index(component))
