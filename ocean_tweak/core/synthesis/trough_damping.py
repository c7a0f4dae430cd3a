# SPDX-License-Identifier: GPL-3.0-or-later
"""Trough damping: removes short waves from the troughs of long ones (future work in Horvath 2015, § 10).

With P_L and P_H the displacement of the long and of the short waves and h_L the elevation of the long ones, P
= P_L + w P_H, w = 1 - δ·S(-h_L / 2s): S is the smoothstep on 0…1 and s the standard deviation of h_L, from
the spectrum, so that no frame depends on another's statistics.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..spectral import constants
from .coefficients import InitialState

Array = NDArray[np.floating]


#: smallest deviation, m; below it the sea is flat, and the inverse would overflow single precision
_FLAT = 1e-30


@dataclass(frozen=True)
class TroughDamping:
    """A low-pass filter for the long waves, and the weight of the short ones.

    strength : δ, 0…1
    long_waves : (N, N//2+1) float64, G(k) = exp(-(k/3k_p)⁴)
    deviation : s in m, > 0
    """

    strength: float
    long_waves: NDArray[np.float64]
    deviation: float

    @property
    def nbytes(self) -> int:
        """Bytes of the filter."""
        return self.long_waves.nbytes

    def weight(self, elevation: Array) -> tuple[Array, Array]:
        """w and dw/dh_L in 1/m, from the long waves' elevation h_L in m."""
        scale = elevation.dtype.type(0.5 / self.deviation)
        depth = np.clip(-elevation * scale, 0.0, 1.0)
        strength = elevation.dtype.type(self.strength)
        weight = 1.0 - strength * depth * depth * (3.0 - 2.0 * depth)
        slope = strength * 6.0 * depth * (1.0 - depth) * scale
        return weight, slope


def trough_damping(strength: float, state: InitialState, peak_wave_number: float) -> TroughDamping | None:
    """The damping of a sea, or None if there is nothing to damp."""
    if strength == 0.0 or not np.isfinite(peak_wave_number):
        return None
    grid = state.grid
    long_waves = np.exp(-((grid.k / (constants.TROUGH_FILTER * peak_wave_number)) ** 4))
    energy = sum(part.expected_plus + part.expected_minus for part in state.parts) * grid.multiplicity
    deviation = float(np.sqrt(np.sum(long_waves**2 * energy)))
    return TroughDamping(strength, long_waves, deviation) if deviation > _FLAT else None
