# SPDX-License-Identifier: GPL-3.0-or-later
"""The continuous spectrum of all layers of a sea, and its curves over frequency and direction."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..parameters.ocean_parameters import OceanParameters
from ..spectral import dispersion
from ..spectral.spectra import combined_peak, combined_rule

Array = NDArray[np.float64]

#: plotted range, in units of the lowest and of the highest peak frequency
_SHOWN = (0.45, 4.0)


class SeaSpectrum:
    """Frequency spectrum and peak of a sea's layers, except those in a calm."""

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
        return combined_rule(self.layers)

    @cached_property
    def peak_frequency(self) -> float:
        """ω in rad/s at the maximum of S; NaN for a flat sea."""
        return combined_peak(self.layers)

    @cached_property
    def peak_wave_number(self) -> float:
        """k in rad/m of the waves at the peak; NaN for a flat sea."""
        if not np.isfinite(self.peak_frequency):
            return float("nan")
        water = self.parameters.water
        return float(dispersion.wave_number(self.peak_frequency, self.parameters.dispersion, water))


class FrequencyCurves(NamedTuple):
    """S over ω.

    omega : (size,) rad/s, ascending, evenly spaced in log ω
    layers : (layers, size) m²·s/rad, the active layers that have waves
    gains : (layers, size) dB, what equalisers do to the heights of each layer
    resolved : lowest and highest ω in rad/s of the waves that the grid holds
    """

    omega: Array
    layers: Array
    gains: Array
    resolved: tuple[float, float]


class PolarDensity(NamedTuple):
    """Energy over frequency and direction.

    omega : (rings,) rad/s, ascending
    theta : (directions,) rad, counter-clockwise from +x, the first 0
    density : (rings, directions) m²·s/rad²
    """

    omega: Array
    theta: Array
    density: Array


def frequency_curves(parameters: OceanParameters, size: int = 256) -> FrequencyCurves:
    """The curves of a sea's active layers; zero rows for a sea without any, or in a calm."""
    sea = SeaSpectrum(parameters)
    omega = shown_frequencies(sea, size)
    layers = [layer.frequency_spectrum(omega) for layer in sea.layers]
    k = dispersion.wave_number(omega, parameters.dispersion, parameters.water)
    gains = [sum((at_work.gain(k) for at_work in layer.equalisers), np.zeros(size)) for layer in sea.layers]
    curves, louder = (np.array(rows).reshape(-1, size) for rows in (layers, gains))
    return FrequencyCurves(omega, curves, louder, resolved_band(parameters))


def polar_density(parameters: OceanParameters, rings: int = 48, directions: int = 144) -> PolarDensity:
    """Energy density of all active layers together."""
    sea = SeaSpectrum(parameters)
    omega = shown_frequencies(sea, rings)
    theta: Array = np.linspace(0.0, 2.0 * np.pi, directions, endpoint=False)
    density = np.zeros((rings, directions))
    for layer in sea.layers:
        spreading = layer.directional_spreading(omega[:, np.newaxis], theta[np.newaxis, :])
        density += layer.frequency_spectrum(omega)[:, np.newaxis] * spreading
    return PolarDensity(omega, theta, density)


def shown_frequencies(sea: SeaSpectrum, size: int) -> Array:
    """ω in rad/s around all peaks, evenly in log ω."""
    peaks = [layer.peak_frequency for layer in sea.layers if np.isfinite(layer.peak_frequency)] or [1.0]
    return np.geomspace(_SHOWN[0] * min(peaks), _SHOWN[1] * max(peaks), size)


def resolved_band(parameters: OceanParameters) -> tuple[float, float]:
    """Lowest and highest ω in rad/s of the waves that fit the domain and its samples."""
    length, samples = parameters.domain_size, parameters.resolution
    k = np.array([2.0 * np.pi / length, np.pi * (samples - 2) / length])
    low, high = dispersion.angular_frequency(k, parameters.dispersion, parameters.water)
    return float(low), float(high)
