# SPDX-License-Identifier: GPL-3.0-or-later
"""How hulls of a sea's layers heave and pitch on its other waves, at any time alone: see `riding`."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..numerics.memo import total_bytes
from ..parameters.ocean_parameters import OceanParameters
from ..waves.contribution import Contribution, HullPlace
from .felt_water import FeltWater, Footprint, felt_sea
from .riding import USUAL_DAMPING, Oscillator, moments, natural_periods, ride

Array = NDArray[np.float64]

#: s, over which a speed is found from two positions
_SPAN = Fraction(1, 32)
#: digits of m and of rad below which two places are one
_DIGITS = 3, 5


class Lifted(NamedTuple):
    """How high a hull is raised at places by the waves, m, and how fast it rises there, m/s.

    What it rises as it goes along its own slope does not count: water on that slope does not meet it.
    """

    height: Array
    rise: Array


class HullMotion:
    """Heave and pitch of the hulls of a sea's layers: damped oscillators with the periods of their size."""

    def __init__(self, sea: OceanParameters) -> None:
        self._sea = sea
        self._waters: dict[float, FeltWater] = {}

    @property
    def nbytes(self) -> int:
        """Bytes of what hulls felt."""
        return total_bytes(tuple(self._waters.values()))

    def at(self, layer: Contribution, x: Array, y: Array, time: Fraction) -> Lifted | None:
        """Of the hull of a layer at places in m and a time in s; None where it has none."""
        hull, later = layer.hull_at(time), layer.hull_at(time + _SPAN)
        if hull is None or later is None:
            return None
        (before, pitch_before), (after, pitch_after) = (
            self._heave_and_pitch(layer, hull, time + step) for step in (Fraction(0), _SPAN)
        )
        cosine, sine = math.cos(hull.heading), math.sin(hull.heading)
        ahead = (x - hull.x) * cosine + (y - hull.y) * sine
        way = (later.x - hull.x) * cosine + (later.y - hull.y) * sine
        rise = (after - before) + ahead * (pitch_after - pitch_before) - way * pitch_before
        return Lifted(before + ahead * pitch_before, rise / float(_SPAN))

    def _heave_and_pitch(self, layer: Contribution, hull: HullPlace, time: Fraction) -> tuple[float, float]:
        """Height in m, and slope along the hull."""
        beam, length = sorted((hull.length, hull.beam))
        periods = natural_periods(length, beam, hull.draught, self._sea.water.gravity)
        water = self._waters.get(beam) or FeltWater(felt_sea(self._sea, beam))
        self._waters[beam] = water
        found = []
        for number, period in enumerate((periods.heave, periods.pitch)):
            mode = Oscillator(period, USUAL_DAMPING)
            known = moments(time, mode)
            forcing = [water.at(moment, self._waterline(layer, moment))[number] for moment in known.times]
            found.append(ride(np.array(forcing, np.float64), known, time, mode))
        return found[0], found[1]

    def _waterline(self, layer: Contribution, time: Fraction) -> Footprint:
        hull = layer.hull_at(time)
        assert hull is not None
        return Footprint(
            round(hull.x, _DIGITS[0]), round(hull.y, _DIGITS[0]), round(hull.heading, _DIGITS[1]),
            0.5 * hull.length, 0.5 * hull.beam, 0.0,
        )  # fmt: skip
