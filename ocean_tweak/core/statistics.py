# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that describe a sea: of its spectrum, as the grid resolves it, of one seed, of a field.

m0 is the variance of the elevation in m², Hs = 4√m0 the significant wave height in m, Tp the period in s
at the peak of the frequency spectrum.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import dispersion
from .directional_spectrum import DirectionalSpectrum
from .grid import WaveVectorGrid
from .initial_state import InitialState
from .parameters import OceanParameters

Array = NDArray[np.float64]

#: width in ln k of the kernel that turns the energies of single modes into a frequency spectrum
_KERNEL_WIDTH = 0.1
_BINS_PER_LOG = 400


@dataclass(frozen=True)
class SeaState:
    """Energy and peak of a sea. A flat sea has no peak: its period is NaN."""

    m0: float
    peak_period: float

    @property
    def significant_wave_height(self) -> float:
        """Hs = 4√m0, m."""
        return float(4.0 * np.sqrt(self.m0))


@dataclass(frozen=True)
class Statistics:
    """What a sea will be.

    spectrum : the continuous spectrum, all wavelengths
    resolved : the mean over all seeds of what the grid holds
    seed : this seed, averaged over time
    """

    spectrum: SeaState
    resolved: SeaState
    seed: SeaState
    peak_wavelength: float
    wavelengths_per_domain: float
    sample_spacing: float
    warnings: tuple[str, ...]

    @property
    def m0(self) -> float:
        return self.spectrum.m0

    @property
    def significant_wave_height(self) -> float:
        return self.spectrum.significant_wave_height

    @property
    def peak_period(self) -> float:
        return self.spectrum.peak_period

    @property
    def resolved_share(self) -> float:
        """Share of the spectrum's energy that the grid resolves, 0…1."""
        return self.resolved.m0 / self.spectrum.m0 if self.spectrum.m0 > 0.0 else 1.0

    def to_dict(self) -> dict[str, object]:
        """Plain numbers for JSON; what does not exist (the period of a flat sea) is None."""
        states = {
            name: {
                "m0": state.m0,
                "significant_wave_height": state.significant_wave_height,
                "peak_period": state.peak_period if np.isfinite(state.peak_period) else None,
            }
            for name, state in (("spectrum", self.spectrum), ("resolved", self.resolved), ("seed", self.seed))
        }
        plain = {
            field.name: getattr(self, field.name)
            for field in dataclasses.fields(self)
            if field.name not in states
        }
        plain = {key: None if value != value else value for key, value in plain.items()}
        return {**states, **plain, "resolved_share": self.resolved_share}


def sea_statistics(parameters: OceanParameters, state: InitialState) -> Statistics:
    """Statistics of a sea from its parameters and its initial state."""
    spectrum = spectrum_state(parameters)
    wavelength = peak_wavelength(spectrum.peak_period, parameters)
    per_domain = parameters.domain_size / wavelength
    result = Statistics(
        spectrum=spectrum,
        resolved=mode_state(state.expected_energy, state.grid, parameters),
        seed=mode_state(state.energy, state.grid, parameters),
        peak_wavelength=wavelength,
        wavelengths_per_domain=per_domain,
        sample_spacing=parameters.domain_size / parameters.resolution,
        warnings=(),
    )
    return dataclasses.replace(result, warnings=_warnings(parameters, result))


def _warnings(parameters: OceanParameters, statistics: Statistics) -> tuple[str, ...]:
    warnings = []
    wavelength = statistics.peak_wavelength
    if statistics.wavelengths_per_domain < 3.0:
        warnings.append(
            f"The domain of {parameters.domain_size:g} m holds only {statistics.wavelengths_per_domain:.2g} of the "
            f"longest waves ({wavelength:.3g} m): wave height will differ much between seeds. "
            f"Make the domain at least {3.0 * wavelength:.0f} m"
        )
    if statistics.resolved_share < 0.95:
        warnings.append(
            f"The grid resolves {100.0 * statistics.resolved_share:.0f} % of the energy: samples are "
            f"{statistics.sample_spacing:.3g} m apart. Raise the resolution or make the domain smaller"
        )
    for index, layer in enumerate(parameters.layers):
        layer_spectrum = DirectionalSpectrum(layer, parameters.water, parameters.dispersion)
        if layer_spectrum.fetch_is_limited:
            warnings.append(
                f"layers.{index}: the sea is fully developed after {layer_spectrum.fetch / 1e3:.4g} km; "
                f"the fetch of {layer.fetch / 1e3:.4g} km counts as that"
            )
    return tuple(warnings)


def spectrum_state(parameters: OceanParameters) -> SeaState:
    """m0 and Tp of the layers' continuous spectra together, by quadrature over ln ω."""
    layers = [
        DirectionalSpectrum(layer, parameters.water, parameters.dispersion) for layer in parameters.layers
    ]
    lowest = min(layer.peak_frequency for layer in layers)
    highest = max(layer.peak_frequency for layer in layers)
    # beyond 100 ω_p an ω⁻⁵ tail holds 1e-8 of the energy; below 0.2 ω_p there is none
    log_omega = np.linspace(np.log(0.2 * lowest), np.log(100.0 * highest), 16385)
    omega = np.exp(log_omega)
    spectrum = sum((layer.frequency_spectrum(omega) for layer in layers), np.zeros_like(omega))
    m0 = float(np.sum(spectrum * omega) * (log_omega[1] - log_omega[0]))
    return SeaState(m0, _peak_period(omega, spectrum))


def mode_state(energy: Array, grid: WaveVectorGrid, parameters: OceanParameters) -> SeaState:
    """m0 and Tp of single modes, from their energies (N, N//2+1) in m².

    The frequency spectrum is estimated as the mean energy of the modes around a frequency (Gaussian kernel
    in ln k) times the density of modes there, 2πk (dk/dω) / Δk²: a plain sum would show the lattice.
    """
    m0 = float(np.sum(energy))
    if not m0 > 0.0:
        return SeaState(m0, float("nan"))
    log_k = np.log(grid.k[grid.usable])
    centres = np.arange(log_k.min() - 0.5, log_k.max() + 0.5, 1.0 / _BINS_PER_LOG)
    edges = np.append(centres, centres[-1] + 1.0 / _BINS_PER_LOG) - 0.5 / _BINS_PER_LOG
    count = np.broadcast_to(grid.multiplicity, grid.shape)[grid.usable]
    sums = [np.histogram(log_k, bins=edges, weights=w)[0] for w in (energy[grid.usable], count)]
    reach = int(4.0 * _KERNEL_WIDTH * _BINS_PER_LOG)
    offset = np.arange(-reach, reach + 1) / _BINS_PER_LOG
    kernel = np.exp(-0.5 * (offset / _KERNEL_WIDTH) ** 2)
    energies, counts = (np.convolve(values, kernel, mode="same") for values in sums)
    mean_energy = np.divide(energies, counts, out=np.zeros_like(energies), where=counts > 0.0)
    k = np.exp(centres)
    rate = dispersion.group_velocity(k, parameters.dispersion, parameters.water)
    omega = dispersion.angular_frequency(k, parameters.dispersion, parameters.water)
    return SeaState(m0, _peak_period(omega, mean_energy * k / rate))


def field_state(elevation: NDArray[np.floating], parameters: OceanParameters) -> SeaState:
    """m0 and Tp measured on one (N, N) elevation field, in m: the energies of its Fourier modes."""
    grid = WaveVectorGrid(elevation.shape[0], parameters.domain_size)
    coefficients = np.fft.rfft2(elevation.astype(np.float64)) / elevation.size
    coefficients[0, 0] = 0.0
    energy = np.abs(coefficients) ** 2 * grid.multiplicity
    return mode_state(energy, grid, parameters)


def peak_wavelength(peak_period: float, parameters: OceanParameters) -> float:
    """Wavelength in m of the waves with the peak period; NaN for a flat sea."""
    if not np.isfinite(peak_period):
        return float("nan")
    k = dispersion.wave_number(2.0 * np.pi / peak_period, parameters.dispersion, parameters.water)
    return float(2.0 * np.pi / k)


def _peak_period(omega: Array, spectrum: Array) -> float:
    """Period at the spectrum's maximum, refined by the parabola through its three highest samples."""
    index = int(np.argmax(spectrum))
    if not spectrum[index] > 0.0:
        return float("nan")
    peak = omega[index]
    if 0 < index < len(spectrum) - 1:
        around = slice(index - 1, index + 2)
        curvature, slope, _ = np.polyfit(omega[around] / peak - 1.0, spectrum[around] / spectrum[index], 2)
        peak *= 1.0 - 0.5 * slope / curvature if curvature < 0.0 else 1.0
    return float(2.0 * np.pi / peak)
