# SPDX-License-Identifier: GPL-3.0-or-later
"""Heave, pitch and roll of a hull as damped oscillators that are forced by the sea.

In each mode the hull is tied by a spring and a damper to the water, that is, to the plane fitted over its
waterline (`core.sea.waterline`). With f the position of the water and q that of the hull,

    q'' + 2ζω₀ (q' − f') + ω₀² (q − f) = 0

f is known at discrete moments and linear between them. On each interval q = f is a solution, so the distance
q − f oscillates freely, and each change of slope of f acts as an impulse:

    q(t) = f(t) − Σ_j Δf'(t_j) g(t − t_j),     g(t) = e^(−ζω₀t) sin(ω_d t)/ω_d,     ω_d = ω₀ √(1 − ζ²)

The moments are multiples of a step, whatever time is asked for. Any time therefore follows from its own past
alone, with the same bytes in whatever order times are asked for. Each mode has a step of its own, a power of
two: a slow one remembers long and a quick one needs short steps, but none needs both.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..numerics.interpolation import smoothstep

Array = NDArray[np.float64]

#: moments per natural period, at least: at resonance the linear interpolation loses 1 %
_PER_PERIOD = 16
#: amplitude of an impulse response, relative to its start, at which it is cut off
_FORGOTTEN = 0.005
#: oldest part of the past over which responses are faded out, so that the cut-off causes no jump
_FADES = 0.25
#: damping ratios of ships in heave and pitch, and in roll
USUAL_DAMPING, USUAL_ROLL_DAMPING = 0.3, 0.1
#: lowest damping ratio: with it, a response lasts 42 periods, and up to 1352 moments
LEAST_DAMPING = 0.02
#: block coefficient over waterplane coefficient, of boats and ships
_FULLNESS = 0.8
#: assumed metacentric height, in beams
_METACENTRIC_HEIGHT = 0.1
#: length in beams above which the formula for the roll of ships is used
_SHIP = 2.0


class Periods(NamedTuple):
    """Natural periods, s."""

    heave: float
    pitch: float
    roll: float


@dataclass(frozen=True)
class Oscillator:
    """One mode of a hull.

    period : natural, without damping, s
    damping : share of the critical one, from `LEAST_DAMPING` to 1

    Raises ValueError for others.
    """

    period: float
    damping: float

    def __post_init__(self) -> None:
        if not 0.0 < self.period < math.inf:
            raise ValueError(f"period = {self.period!r}: must be a finite number of seconds above 0")
        if not LEAST_DAMPING <= self.damping <= 1.0:
            raise ValueError(f"damping = {self.damping!r}: must be from {LEAST_DAMPING:g} to 1")

    @property
    def memory(self) -> float:
        """Seconds after which an impulse response is cut off."""
        return -math.log(_FORGOTTEN) * self.period / (2.0 * math.pi * self.damping)

    def impulse_response(self, since: Array) -> Array:
        """Impulse response g in s, by the seconds since the impulse; 0 before it."""
        natural = 2.0 * math.pi / self.period
        # critical damping is a limit
        damped = natural * math.sqrt(max(1.0 - self.damping**2, 1e-12))
        since = np.maximum(since, 0.0)
        result: Array = np.exp(-self.damping * natural * since) * np.sin(damped * since) / damped
        return result


@dataclass(frozen=True)
class Moments:
    """The moments at which the water must be known to find a hull's position at a time.

    step : s between them
    numbers : multiples of the step; the last but one is the last moment not after that time
    """

    step: Fraction
    numbers: range

    @property
    def times(self) -> list[Fraction]:
        """In s."""
        return [number * self.step for number in self.numbers]


def natural_periods(length: float, beam: float, draft: float, gravity: float = 9.81) -> Periods:
    """Natural periods of a hull from its dimensions in m.

    Heave is 2π √((m + a)/(ρ g A)) with the added mass of half a circle as wide as the beam, ρπB²/8 a metre of
    length: 2π √((C T + πB/8)/g), where C is the block over the waterplane coefficient. Pitch has the same
    period: the gyradius of a hull, a quarter of its length, is that of an elliptic waterline. (Lloyd 1989,
    Seakeeping; DNV-RP-N103, appendix A.) Roll is that of the weather criterion, 2 C B/√GM with
    C = 0.373 + 0.023 B/T − 0.043 L/100 (IMO 2008, International Code on Intact Stability, A 2.3.4), GM being
    a tenth of the beam; a hull shorter than two beams has the same period in roll as in pitch.

    Raises ValueError for a dimension or gravity that is not finite and above 0.
    """
    for name, value in (("length", length), ("beam", beam), ("draft", draft), ("gravity", gravity)):
        if not 0.0 < value < math.inf:
            raise ValueError(f"{name} = {value!r}: must be finite and above 0")
    heave = 2.0 * math.pi * math.sqrt((_FULLNESS * draft + math.pi / 8.0 * beam) / gravity)
    if length < _SHIP * beam:
        return Periods(heave, heave, heave)
    # the code is for ships of up to some hundred metres
    share = max(0.373 + 0.023 * beam / draft - 0.043 * length / 100.0, 0.25)
    # written for 9.81 m/s²
    roll = 2.0 * share * beam / math.sqrt(_METACENTRIC_HEIGHT * beam) * math.sqrt(9.81 / gravity)
    return Periods(heave, heave, roll)


def moments(time: Fraction, mode: Oscillator) -> Moments:
    """The moments needed for a mode at a time in s: a bounded number, shared with neighbouring times.

    The step is a power of two in s, and at most a sixteenth of the mode's period. The moments reach back as
    far as its memory.
    """
    step = Fraction(2) ** math.floor(math.log2(mode.period / _PER_PERIOD))
    last = math.floor(time / step) + 1
    count = math.ceil(mode.memory / float(step)) + 2
    return Moments(step, range(last + 1 - count, last + 1))


def ride(water: Array, known: Moments, time: Fraction, mode: Oscillator) -> float:
    """Position of a hull in one mode at a time in s, in the unit of the forcing.

    water : (moments,) forcing: height or slope of the water under the hull. Before the first moment it is
        taken to continue with constant slope

    Raises ValueError for forcing of another shape, or that is not finite.
    """
    if water.shape != (len(known.numbers),) or len(water) < 2:
        raise ValueError(f"water is {water.shape}: must be ({len(known.numbers)},), of 2 moments or more")
    if not np.all(np.isfinite(water)):
        raise ValueError("water has values that are not finite")
    step = float(known.step)
    # all from the last moment: large numbers would cost digits
    since = np.array([float(time - moment) for moment in known.times])
    slopes = np.diff(water) / step
    age = since[1:-1]
    kinks = np.diff(slopes) * smoothstep((1.0 - age / (step * len(age))) / _FADES)
    return float(water[-2] + slopes[-1] * since[-2] - kinks @ mode.impulse_response(age))
