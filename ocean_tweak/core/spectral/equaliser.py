# SPDX-License-Identifier: GPL-3.0-or-later
"""Equaliser for wave heights by octave of wavelength, which leaves speeds and directions unchanged."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..data.validation import Off, Validated, changing_fields, number
from ..numerics.interpolation import smoothstep

Array = NDArray[np.float64]

LEAST_GAIN, MOST_GAIN = -24.0, 12.0


def _gain(where: str) -> Any:
    return number(
        0.0, LEAST_GAIN, MOST_GAIN, "dB", f"Height of the waves {where}; 0 leaves them as they are, 6 "
        "doubles them, -6 halves them",
        "from a sixteenth of the height to four times it", changes=True, left_out=True,
    )  # fmt: skip


@dataclass(frozen=True)
class Equaliser(Validated):
    """Gains by octave of wavelength around the spectrum's peak, smooth in between.

    Examples
    --------
    >>> Equaliser(shorter_2=6.0).is_flat
    False
    """

    longer_3: float = _gain("eight times as long as those of the peak, and longer")
    longer_2: float = _gain("four times as long as those of the peak")
    longer_1: float = _gain("twice as long as those of the peak")
    peak: float = _gain("of the peak")
    shorter_1: float = _gain("half as long as those of the peak")
    shorter_2: float = _gain("a quarter as long as those of the peak")
    shorter_3: float = _gain("an eighth as long as those of the peak")
    shorter_4: float = _gain("a sixteenth as long as those of the peak")
    shorter_5: float = _gain("1/32 as long as those of the peak")
    shorter_6: float = _gain("1/64 as long as those of the peak, and shorter")
    wavelength: float = number(
        0.0, 0.0, 1e6, "m", "Wavelength that the bands are counted from", "any domain",
        off=Off(0.0, 100.0, "is that of the spectrum's peak"), left_out=True,
    )  # fmt: skip

    @property
    def gains(self) -> tuple[float, ...]:
        """The gains of the ten bands in dB, from long waves to short."""
        return tuple(getattr(self, name) for name in GAINS)

    @property
    def is_flat(self) -> bool:
        """Whether all gains are 0."""
        return not any(self.gains)


#: fields of an equaliser that can be animated: its gains, from long waves to short
GAINS = changing_fields(Equaliser)

#: octaves from the peak's wavelength to that of each band
OCTAVES: Array = np.arange(len(GAINS), dtype=np.float64) - GAINS.index("peak")


class Equalising(NamedTuple):
    """An equaliser with the reference wave number of its bands, in rad/m."""

    equaliser: Equaliser
    peak: float

    def gain(self, k: ArrayLike) -> Array:
        """Gain in dB over k in rad/m: smoothsteps from band to band, constant beyond the ends."""
        octaves = np.log2(np.maximum(np.asarray(k, np.float64) / self.peak, 1e-300))
        position = np.clip(octaves - OCTAVES[0], 0.0, len(OCTAVES) - 1.0)
        below = np.minimum(position.astype(np.int64), len(OCTAVES) - 2)
        x = position - below
        gains = np.array(self.equaliser.gains)
        return gains[below] + smoothstep(x) * (gains[below + 1] - gains[below])

    def energy_gain(self, k: ArrayLike) -> Array:
        """Factor of the energy over k in rad/m: heights grow by 10^(dB/20), energy by its square."""
        return np.asarray(10.0 ** (0.1 * self.gain(k)))
