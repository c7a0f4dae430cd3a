# SPDX-License-Identifier: GPL-3.0-or-later
"""How a hull rides the sea: its heave, pitch and roll swing as damped oscillators that the water drives.

In each of these modes the hull hangs on the water by a spring and a damper, and the water is the plane that
its waterline feels, `core.sea.waterline`: with f of the water and q of the hull,

    q'' + 2ζω₀ (q' − f') + ω₀² (q − f) = 0

Between moments at which f is known it is taken as straight. There q = f is a solution, so that the hull's
distance from the water swings freely, and each kink of f is a blow to it:

    q(t) = f(t) − Σ_j Δf'(t_j) g(t − t_j),     g(t) = e^(−ζω₀t) sin(ω_d t)/ω_d,     ω_d = ω₀ √(1 − ζ²)

Moments are whole multiples of a step, whatever the time that is asked for. So any time follows from its own
past alone, and has the same bytes in whatever order times are asked for.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: moments in a natural period, at the least: at resonance straight lines between them lose 1 %
_PER_PERIOD = 16
#: what is left of a blow when it is forgotten
_FORGOTTEN = 0.005
#: part of the past, its oldest, over which a blow fades, so that nothing jumps when it is forgotten
_FADES = 0.25
#: moments that are looked back at, at the most
MOST_MOMENTS = 512
#: of a hull whose swing is forgotten before those moments end, in most cases
LEAST_DAMPING = 0.02
#: a fishing boat's and a ship's block coefficient is about this part of its waterplane coefficient
_FULLNESS = 0.8
#: metacentric height in beams, of a ship that nobody has inclined
_METACENTRIC_HEIGHT = 0.1
#: beams in a length from which on something is a ship, which rolls otherwise than it pitches
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
    damping : share of the critical one, above 0 and at most 1

    Raises ValueError for others.
    """

    period: float
    damping: float

    def __post_init__(self) -> None:
        if not 0.0 < self.period < math.inf:
            raise ValueError(f"period = {self.period!r}: must be a finite number of seconds above 0")
        if not 0.0 < self.damping <= 1.0:
            raise ValueError(f"damping = {self.damping!r}: must be above 0 and at most 1")

    @property
    def memory(self) -> float:
        """Seconds after which a blow is forgotten."""
        return -math.log(_FORGOTTEN) * self.period / (2.0 * math.pi * self.damping)

    def swing(self, since: Array) -> Array:
        """g, in s: the distance that a blow of 1 m/s leaves, some seconds after it; 0 before."""
        natural = 2.0 * math.pi / self.period
        # critical damping is a limit
        damped = natural * math.sqrt(max(1.0 - self.damping**2, 1e-12))
        since = np.maximum(since, 0.0)
        result: Array = np.exp(-self.damping * natural * since) * np.sin(damped * since) / damped
        return result


@dataclass(frozen=True)
class Moments:
    """When the water must be known, so that a hull's place at a time follows.

    step : s between them
    numbers : of the moments, from 0 s on; the last but one is the last that is not after the time
    """

    step: Fraction
    numbers: range

    @property
    def times(self) -> list[Fraction]:
        """Of the moments, s."""
        return [number * self.step for number in self.numbers]


def natural_periods(length: float, beam: float, draft: float, gravity: float = 9.81) -> Periods:
    """Of a hull with these sizes in m.

    Heave is 2π √((m + a)/(ρ g A)) with the added mass of half a circle as wide as the beam, ρπB²/8 a metre of
    length: 2π √((C T + πB/8)/g), where C is the block over the waterplane coefficient. Pitch has the same
    period: the gyradius of a hull, a quarter of its length, is that of an elliptic waterline. (Lloyd 1989,
    Seakeeping; DNV-RP-N103, appendix A.) Roll is that of the weather criterion, 2 C B/√GM with
    C = 0.373 + 0.023 B/T − 0.043 L/100 (IMO 2008, International Code on Intact Stability, A 2.3.4), GM being
    a tenth of the beam; what is shorter than two beams is no ship, and rolls as it pitches.

    Raises ValueError for a size, or a gravity, that is not finite and above 0.
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


def moments(time: Fraction, modes: tuple[Oscillator, ...]) -> Moments:
    """When the water must be known for a time in s: a bounded number of moments, those of other times too.

    The step is a second halved or doubled, and at most a sixteenth of each mode's period.
    """
    shortest = min(mode.period for mode in modes) / _PER_PERIOD
    step = Fraction(2) ** math.floor(math.log2(shortest))
    last = math.floor(time / step) + 1
    count = math.ceil(max(mode.memory for mode in modes) / float(step)) + 2
    return Moments(step, range(last + 1 - min(count, MOST_MOMENTS), last + 1))


def ride(water: Array, known: Moments, time: Fraction, modes: tuple[Oscillator, ...]) -> Array:
    """(modes,) where a hull is at a time in s, in the unit of what the water does.

    water : (moments, modes) what the hull feels of it. Before the first moment it went on as it begins

    Raises ValueError for water that does not fit the moments and modes, or is not finite.
    """
    if water.shape != (len(known.numbers), len(modes)) or len(known.numbers) < 2:
        raise ValueError(
            f"water is {water.shape}: must be ({len(known.numbers)}, {len(modes)}), of 2 moments or more"
        )
    if not np.all(np.isfinite(water)):
        raise ValueError("water has values that are not finite")
    step = float(known.step)
    # all from the last moment: large numbers would cost digits
    since = np.array([float(time - moment) for moment in known.times])
    slopes = np.diff(water, axis=0) / step
    place: Array = water[-2] + slopes[-1] * since[-2]
    age = since[1:-1]
    rest = np.clip((1.0 - age / (step * len(age))) / _FADES, 0.0, 1.0)
    kinks = np.diff(slopes, axis=0) * (rest**2 * (3.0 - 2.0 * rest))[:, np.newaxis]
    for column, mode in enumerate(modes):
        place[column] -= kinks[:, column] @ mode.swing(age)
    return place
