# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that describe a sea: of its spectrum, as the grid resolves it, of one seed, of a field.

Moments: m0 = ∫S dω is the variance of the elevation, m2 = ∫ω²S dω; Hs = 4√m0 is the significant wave
height, Tp the period at the peak of the frequency spectrum, Tz = 2π√(m0/m2) the mean period between
zero up-crossings.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import dispersion
from .grid import WaveVectorGrid
from .initial_state import InitialState
from .layer_scales import refined_peak
from .parameters import OceanParameters
from .sea_spectrum import SeaSpectrum
from .spreading import mean_cosine

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: width in ln k of the kernel that turns the energies of single modes into a frequency spectrum
_KERNEL_WIDTH = 0.1
_BINS_PER_LOG = 400

_LEAST_WAVELENGTHS = 3.0
_LEAST_RESOLVED_SHARE = 0.95
_LEAST_LOOP_PERIODS = 3.0
_LARGEST_SPEED_CHANGE = 0.1


@dataclass(frozen=True)
class SeaState:
    """Energy, periods and directions of a sea. What a flat sea does not have is NaN.

    m0 : m²
    peak_period, zero_crossing_period : Tp and Tz, s
    peak_wavelength : of waves with the peak period, m
    mean_square_slope : ∫k²S dω, for the continuous spectrum up to 100 times the peak frequency
    mean_direction : rad, counter-clockwise from +x, weighted by energy
    directional_spread : √(2 - 2r) in rad, with r the length of the mean direction vector
        (Kuik, van Vledder & Holthuijsen 1988)
    """

    m0: float
    peak_period: float
    zero_crossing_period: float
    peak_wavelength: float
    mean_square_slope: float
    mean_direction: float
    directional_spread: float

    @property
    def significant_wave_height(self) -> float:
        """Hs = 4√m0, m."""
        return float(4.0 * np.sqrt(self.m0))

    @property
    def steepness(self) -> float:
        """Hs over the peak wavelength."""
        return self.significant_wave_height / self.peak_wavelength

    def to_dict(self) -> dict[str, float | None]:
        """Plain numbers for JSON; what does not exist is None."""
        values = {"significant_wave_height": self.significant_wave_height, "steepness": self.steepness}
        values |= {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}
        return {name: value if np.isfinite(value) else None for name, value in values.items()}


@dataclass(frozen=True)
class Statistics:
    """What a sea will be.

    spectrum : the continuous spectrum, all wavelengths
    resolved : the mean over all seeds of what the grid holds
    seed : this seed, averaged over time
    wavelengths_per_domain : peak wavelengths along a side
    sample_spacing : m
    loop_speed_change : largest relative change of a wave's phase speed by the loop, or None without one
    warnings : one sentence each, with the remedy
    """

    spectrum: SeaState
    resolved: SeaState
    seed: SeaState
    wavelengths_per_domain: float
    sample_spacing: float
    loop_speed_change: float | None
    warnings: tuple[str, ...]

    @property
    def m0(self) -> float:
        """Variance of the elevation, m², of the continuous spectrum."""
        return self.spectrum.m0

    @property
    def significant_wave_height(self) -> float:
        """Hs of the continuous spectrum, m."""
        return self.spectrum.significant_wave_height

    @property
    def peak_period(self) -> float:
        """Tp of the continuous spectrum, s."""
        return self.spectrum.peak_period

    @property
    def peak_wavelength(self) -> float:
        """Wavelength at the peak of the continuous spectrum, m."""
        return self.spectrum.peak_wavelength

    @property
    def resolved_share(self) -> float:
        """Share of the spectrum's energy that the grid resolves, 0…1."""
        return self.resolved.m0 / self.spectrum.m0 if self.spectrum.m0 > 0.0 else 1.0

    def to_dict(self) -> dict[str, object]:
        """Plain data for JSON; what does not exist (the period of a flat sea) is None."""
        per_domain = self.wavelengths_per_domain
        return {
            "spectrum": self.spectrum.to_dict(),
            "resolved": self.resolved.to_dict(),
            "seed": self.seed.to_dict(),
            "resolved_share": self.resolved_share,
            "wavelengths_per_domain": per_domain if np.isfinite(per_domain) else None,
            "sample_spacing": self.sample_spacing,
            "loop_speed_change": self.loop_speed_change,
            "warnings": list(self.warnings),
        }


def sea_statistics(parameters: OceanParameters, state: InitialState) -> Statistics:
    """Statistics of a sea from its parameters and its initial state."""
    sea = SeaSpectrum(parameters)
    spectrum = spectrum_state(sea)
    along, against = np.abs(state.h_plus) ** 2, np.abs(state.h_minus) ** 2
    result = Statistics(
        spectrum=spectrum,
        resolved=mode_state(state.expected_plus, state.expected_minus, state.grid, parameters),
        seed=mode_state(along, against, state.grid, parameters),
        wavelengths_per_domain=parameters.domain_size / spectrum.peak_wavelength,
        sample_spacing=parameters.domain_size / parameters.resolution,
        loop_speed_change=_loop_speed_change(parameters, state),
        warnings=(),
    )
    return dataclasses.replace(result, warnings=_warnings(parameters, sea, result))


def _loop_speed_change(parameters: OceanParameters, state: InitialState) -> float | None:
    """Largest relative change of the phase speed among the modes that hold 99 % of the energy."""
    if state.loop_duration is None:
        return None
    energy = ((state.expected_plus + state.expected_minus) * state.grid.multiplicity).ravel()
    order = np.argsort(energy)[::-1]
    cumulated = np.cumsum(energy[order])
    if not cumulated[-1] > 0.0:
        return 0.0
    carrying = order[: int(np.searchsorted(cumulated, 0.99 * cumulated[-1])) + 1]
    true = dispersion.angular_frequency(
        state.grid.k.ravel()[carrying], parameters.dispersion, parameters.water
    )
    return float(np.max(np.abs(state.omega.ravel()[carrying] / true - 1.0)))


def _warnings(parameters: OceanParameters, sea: SeaSpectrum, statistics: Statistics) -> tuple[str, ...]:
    if not np.isfinite(statistics.peak_period):
        return ("The sea is flat: no layer has energy. Unmute one, or raise its wind, gain or wave height",)
    return (
        *_grid_warnings(parameters, statistics),
        *_loop_warnings(parameters, statistics),
        *_fetch_warnings(parameters, sea),
    )


def _grid_warnings(parameters: OceanParameters, statistics: Statistics) -> list[str]:
    warnings = []
    wavelength = statistics.peak_wavelength
    if statistics.wavelengths_per_domain < _LEAST_WAVELENGTHS:
        warnings.append(
            f"The domain of {parameters.domain_size:g} m holds only "
            f"{statistics.wavelengths_per_domain:.2g} of the longest waves ({wavelength:.3g} m): "
            "wave height will differ much between seeds. "
            f"Make the domain at least {_round_up(_LEAST_WAVELENGTHS * wavelength)} m"
        )
    if statistics.resolved_share < _LEAST_RESOLVED_SHARE:
        warnings.append(
            f"The grid resolves {100.0 * statistics.resolved_share:.0f} % of the energy: samples are "
            f"{statistics.sample_spacing:.3g} m apart. Raise the resolution or make the domain smaller"
        )
    return warnings


def _round_up(length: float) -> str:
    """A length rounded up to two digits."""
    unit = 10.0 ** (np.floor(np.log10(length)) - 1.0)
    return f"{np.ceil(length / unit) * unit:.10g}"


def _loop_warnings(parameters: OceanParameters, statistics: Statistics) -> list[str]:
    if parameters.loop_duration is None or statistics.loop_speed_change is None:
        return []
    duration, shortest = float(parameters.loop_duration), _LEAST_LOOP_PERIODS * statistics.peak_period
    warnings = []
    if duration < shortest:
        warnings.append(
            f"The loop of {duration:g} s is shorter than {_LEAST_LOOP_PERIODS:g} peak periods and will look "
            f"mechanical. Make it at least {_round_up(shortest)} s"
        )
    if statistics.loop_speed_change > _LARGEST_SPEED_CHANGE:
        warnings.append(
            f"The loop changes the speed of some waves by {100.0 * statistics.loop_speed_change:.0f} %. "
            "Make it longer"
        )
    return warnings


def _fetch_warnings(parameters: OceanParameters, sea: SeaSpectrum) -> list[str]:
    return [
        f"Layer {spectrum.layer.id}: the sea is fully developed after {spectrum.scales.fetch / 1e3:.4g} km; "
        f"the fetch of {spectrum.layer.fetch / 1e3:.4g} km counts as that"
        for spectrum in sea.layers
        if spectrum.fetch_is_limited
    ]


def spectrum_state(sea: SeaSpectrum) -> SeaState:
    """State of the layers' continuous spectra together, by quadrature over ln ω."""
    omega, weight = sea.rule
    parameters = sea.parameters
    k = dispersion.wave_number(omega, parameters.dispersion, parameters.water)
    spectrum, vector = np.zeros_like(omega), 0.0j
    for layer in sea.layers:
        energy = layer.frequency_spectrum(omega)
        # directions change slowly over ω: every eighth frequency will do
        cosine = mean_cosine(omega[::8] / layer.peak_frequency, layer.spreading)
        towards = np.exp(1j * layer.layer.wind_direction)
        vector += towards * np.sum(energy * np.interp(omega, omega[::8], cosine) * weight)
        spectrum += energy
    m0, m2 = np.sum(spectrum * weight), np.sum(omega**2 * spectrum * weight)
    slope = np.sum(k**2 * spectrum * weight)
    return _sea_state(m0, m2, slope, vector, sea.peak_frequency, parameters)


def mode_state(
    along: RealArray, against: RealArray, grid: WaveVectorGrid, parameters: OceanParameters
) -> SeaState:
    """State of single modes.

    along, against : (N, N//2+1) m², |h_plus|² and |h_minus|²: energies of the waves along +k and -k
    """
    energy = (along + against) * grid.multiplicity
    direction = np.divide(
        grid.kx + 1j * grid.ky, grid.k, out=np.zeros(grid.shape, complex), where=grid.k > 0.0
    )
    vector = np.sum((along - against) * grid.multiplicity * direction)
    return _state_of_modes(energy, vector, grid, parameters)


def field_state(elevation: NDArray[np.floating], parameters: OceanParameters) -> SeaState:
    """State measured on one (N, N) elevation field in m.

    One field does not tell a wave from the one that runs against it: the mean direction is that of the
    axis, in (-π/2, π/2], and the spread is the one around this axis.
    """
    grid = WaveVectorGrid(elevation.shape[0], parameters.domain_size)
    coefficients = np.fft.rfft2(elevation.astype(np.float64)) / elevation.size
    coefficients[0, 0] = 0.0
    energy = np.abs(coefficients) ** 2 * grid.multiplicity
    m0 = np.sum(energy)
    axis = np.sum(energy * np.exp(2j * np.arctan2(grid.ky, grid.kx)))
    # of a narrow sea, angles that are doubled have four times the variance: 1 - r is a quarter of theirs
    length = m0 - 0.25 * (m0 - np.abs(axis))
    vector = length * np.exp(0.5j * np.angle(axis))
    return _state_of_modes(energy, vector, grid, parameters)


def _state_of_modes(
    energy: Array, vector: complex, grid: WaveVectorGrid, parameters: OceanParameters
) -> SeaState:
    omega = dispersion.angular_frequency(grid.k, parameters.dispersion, parameters.water)
    peak = _mode_peak(energy, grid, parameters)
    m2, slope = np.sum(omega**2 * energy), np.sum(grid.k**2 * energy)
    return _sea_state(np.sum(energy), m2, slope, vector, peak, parameters)


def _sea_state(
    m0: float, m2: float, slope: float, vector: complex, peak: float, parameters: OceanParameters
) -> SeaState:
    if not (m0 > 0.0 and np.isfinite(peak)):
        nan = float("nan")
        return SeaState(float(m0), nan, nan, nan, float(slope), nan, nan)
    k = dispersion.wave_number(peak, parameters.dispersion, parameters.water)
    return SeaState(
        m0=float(m0),
        peak_period=float(2.0 * np.pi / peak),
        zero_crossing_period=float(2.0 * np.pi * np.sqrt(m0 / m2)),
        peak_wavelength=float(2.0 * np.pi / k),
        mean_square_slope=float(slope),
        mean_direction=float(np.angle(vector)),
        directional_spread=float(np.sqrt(max(0.0, 2.0 - 2.0 * np.abs(vector) / m0))),
    )


def _mode_peak(energy: Array, grid: WaveVectorGrid, parameters: OceanParameters) -> float:
    """ω in rad/s at the peak of the frequency spectrum of single modes; NaN for a flat sea.

    The spectrum is the mean energy of the modes around a frequency (Gaussian kernel in ln k) times the
    density of modes there, 2πk (dk/dω) / Δk²: a plain sum would show the lattice.
    """
    position = np.log(grid.k[grid.usable]) * _BINS_PER_LOG
    first = int(np.floor(np.min(position))) - _BINS_PER_LOG // 2
    bins = (position - first + 0.5).astype(np.int64)
    size = int(np.max(bins)) + _BINS_PER_LOG // 2
    count = np.broadcast_to(grid.multiplicity, grid.shape)[grid.usable]
    sums = [np.bincount(bins, weights, minlength=size) for weights in (energy[grid.usable], count)]
    centres = (first + np.arange(size)) / _BINS_PER_LOG
    reach = int(4.0 * _KERNEL_WIDTH * _BINS_PER_LOG)
    offset = np.arange(-reach, reach + 1) / _BINS_PER_LOG
    kernel = np.exp(-0.5 * (offset / _KERNEL_WIDTH) ** 2)
    energies, counts = (np.convolve(values, kernel, mode="same") for values in sums)
    mean_energy = np.divide(energies, counts, out=np.zeros_like(energies), where=counts > 0.0)
    k = np.exp(centres)
    rate = dispersion.group_velocity(k, parameters.dispersion, parameters.water)
    omega = dispersion.angular_frequency(k, parameters.dispersion, parameters.water)
    return refined_peak(omega, mean_energy * k / rate)
