# SPDX-License-Identifier: GPL-3.0-or-later
"""The continuous spectrum of all layers of a sea together."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..parameters.ocean_parameters import OceanParameters
from ..spectral import dispersion
from ..spectral.layer_scales import frequency_rule, refined_peak

Array = NDArray[np.float64]


class SeaSpectrum:
    """Frequency spectrum and peak of a sea's layers, but for those in a calm."""

    def __init__(self, parameters: OceanParameters) -> None:
        self.parameters = parameters
        spectra = (layer.directional_spectrum(parameters) for layer in parameters.active())
        self.layers = tuple(spectrum for spectrum in spectra if spectrum is not None)

    def frequency_spectrum(self, omega: ArrayLike) -> Array:
        """S(ω) in m²·s/rad, any shape."""
        omega = np.asarray(omega, np.float64)
        return sum((layer.frequency_spectrum(omega) for layer in self.layers), np.zeros_like(omega))

    @cached_property
    def rule(self) -> tuple[Array, Array]:
        """ω in rad/s and weights in rad/s of a quadrature that holds all of the energy."""
        peaks = [layer.peak_frequency for layer in self.layers] or [1.0]
        return frequency_rule(min(peaks), max(peaks))

    @cached_property
    def peak_frequency(self) -> float:
        """ω in rad/s at the maximum of S; NaN for a flat sea."""
        omega, _ = self.rule
        return refined_peak(omega, self.frequency_spectrum(omega))

    @cached_property
    def peak_wave_number(self) -> float:
        """k in rad/m of the waves at the peak; NaN for a flat sea."""
        if not np.isfinite(self.peak_frequency):
            return float("nan")
        water = self.parameters.water
        return float(dispersion.wave_number(self.peak_frequency, self.parameters.dispersion, water))
