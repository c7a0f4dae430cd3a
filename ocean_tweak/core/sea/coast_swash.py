# SPDX-License-Identifier: GPL-3.0-or-later
"""Sand that waves have wetted: how high they ran up the shore of late, and how far it has dried since.

Waves that reach the shore run up it, each as high as its envelope is there: one that 2 % exceed to the
height that 2 % of run-ups exceed, and none higher. Where waves come to a shore lower than the depth lets
them, in the lee of a headland or on a wall, they run up less in proportion.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..waves.coast.ground import Ground
from ..waves.coast.runup import highest_run_up, run_up
from .coast_field import OverBed
from .coast_pictures import Pictures

Array = NDArray[np.float64]

#: s in which wet sand dries, and moments per second at which it may be wetted
_DRIES, _LOOKS = 40, 2
#: m of height over which its edge is soft
_EDGE = 0.1
#: m of land behind the waterline that are looked at
_BEHIND = 60.0
#: envelope, over its root mean square, that 2 % of waves exceed
_HIGHEST = math.sqrt(math.log(50.0))


class Swash:
    """On the land behind a bed's waterline.

    over_bed, pictures, ground : the waves
    broken_share : (rows, columns)
    slope : (rows, columns) of the bed, rise over run
    height, wavelength : of the waves in deep water, significant and at the peak, m
    """

    def __init__(
        self,
        over_bed: OverBed,
        pictures: Pictures,
        ground: Ground,
        broken_share: Array,
        slope: Array,
        height: float,
        wavelength: float,
    ) -> None:
        self._over_bed, self._ground = over_bed, ground
        wet = ground.depth > 0.0
        shore = wet & _beside(~wet)
        self._number = np.where(shore, np.cumsum(shore).reshape(wet.shape) - 1, -1)
        self._pictures = np.ascontiguousarray(pictures.elevation[:, shore[wet]])
        self._envelope = 0.5 * _HIGHEST * np.maximum(pictures.rms_height[shore[wet]], 1e-6)
        setup, swash = run_up(height, wavelength, slope[shore])
        arrives = broken_share[shore] ** 0.25  # height over what the depth lets through
        self.highest = arrives * highest_run_up(setup, swash)
        self._swash = arrives * highest_run_up(np.zeros_like(swash), swash)

    def reach(self, times: Sequence[float | Fraction]) -> Array:
        """(times, shore samples) m above still water that waves run up."""
        factors = np.stack([self._over_bed.factor(time) for time in times]).astype(np.complex64)
        part = np.minimum(np.abs(factors @ self._pictures) / self._envelope, 1.0)
        result: Array = self.highest - self._swash * (1.0 - part)
        return result

    def wet(self, x: Array, y: Array, time: float | Fraction) -> NDArray[np.float32]:
        """0…1 at places in m, of one flat shape: 1 in water, and less the longer ago a wave was there."""
        depth = self._ground.between(x, y).read(self._ground.depth)
        wet = (depth > 0.0).astype(np.float32)
        number = self._nearest[self._ground.nearest(x, y)]
        highest = float(np.max(self.highest, initial=0.0))
        there = np.flatnonzero((depth <= 0.0) & (depth > -highest - _EDGE) & (number >= 0))
        height, beside = -depth[there], number[there]
        last = math.floor(Fraction(time) * _LOOKS)
        times = [Fraction(time), *(Fraction(last - back, _LOOKS) for back in range(_DRIES * _LOOKS))]
        found = np.zeros(len(there))
        for then, reach in zip(times, self.reach(times), strict=True):
            left = 1.0 - float(Fraction(time) - then) / _DRIES
            edge = np.clip((reach[beside] - height) / _EDGE + 0.5, 0.0, 1.0)
            np.maximum(found, left * edge, out=found)
        wet[there] = found
        return wet

    @cached_property
    def _nearest(self) -> NDArray[np.intp]:
        """(rows, columns) number of the shore sample next to each, and -1 where there is none."""
        number = self._number.copy()
        for _ in range(math.ceil(_BEHIND / self._ground.step)):
            for axis, by in ((0, 1), (0, -1), (1, 1), (1, -1)):
                beside = _moved(number, axis, by, -1)
                np.copyto(number, beside, where=(number < 0) & (beside >= 0))
        return number


def _beside(there: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Whether one of four neighbours is there."""
    found: NDArray[np.bool_] = np.zeros_like(there)
    for axis, by in ((0, 1), (0, -1), (1, 1), (1, -1)):
        found |= _moved(there, axis, by, False)
    return found


def _moved(field: NDArray, axis: int, by: int, outside: int) -> NDArray:  # type: ignore[type-arg]
    """A field (rows, columns) so many samples on; it repeats along rows."""
    moved = np.roll(field, by, axis)
    if axis == 0:
        moved[0 if by > 0 else -1] = outside
    return moved
