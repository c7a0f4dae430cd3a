# SPDX-License-Identifier: GPL-3.0-or-later
"""Wave height, periods and directions of a sea, from the energies of its modes or from an elevation field.

m0 is the variance of the elevation, m2 that of its rate of change; Hs = 4√m0 is the significant wave height,
Tp the period at the peak of the frequency spectrum, Tz = 2π√(m0/m2) the mean period between zero
up-crossings.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..numerics.grid import WaveVectorGrid
from . import dispersion
from .spectra import refined_peak

if TYPE_CHECKING:
    from ..parameters.ocean_parameters import OceanParameters

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: width in ln k of the kernel that smooths the energies of single modes into a frequency spectrum
_KERNEL_WIDTH = 0.1
_BINS_PER_LOG = 400


class Modes(NamedTuple):
    """Energies and angular frequencies of modes.

    grid : their wave vectors
    along, against : (N, N//2+1) m², of waves along k and against it
    omega : (N, N//2+1) rad/s
    """

    grid: WaveVectorGrid
    along: RealArray
    against: RealArray
    omega: Array


@dataclass(frozen=True)
class SeaState:
    """Energy, periods and directions of a sea. Quantities undefined for a flat sea are NaN.

    m0 : m²
    peak_period, zero_crossing_period : Tp and Tz, s
    peak_wavelength : wavelength at the peak period, m
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
    def peak_wave_number(self) -> float:
        """Wave number at the peak wavelength, rad/m."""
        return 2.0 * np.pi / self.peak_wavelength

    @property
    def steepness(self) -> float:
        """Hs divided by the peak wavelength."""
        return self.significant_wave_height / self.peak_wavelength

    def to_dict(self) -> dict[str, float | None]:
        """Plain numbers for JSON; undefined ones are None."""
        values = {"significant_wave_height": self.significant_wave_height, "steepness": self.steepness}
        values |= {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}
        return {name: value if np.isfinite(value) else None for name, value in values.items()}


def mode_state(
    along: RealArray, against: RealArray, grid: WaveVectorGrid, parameters: OceanParameters
) -> SeaState:
    """State of modes with the sea's dispersion relation.

    along, against : (N, N//2+1) m², |h_plus|² and |h_minus|²: energies of the waves along +k and -k
    """
    energy = (along + against) * grid.multiplicity
    k = grid.k
    direction = np.divide(grid.kx + 1j * grid.ky, k, out=np.zeros(grid.shape, complex), where=k > 0.0)
    vector = np.sum((along - against) * grid.multiplicity * direction)
    return _state_of_modes(energy, vector, grid, parameters)


def modes_state(parts: Sequence[Modes], parameters: OceanParameters) -> SeaState:
    """State of waves of one grid that turn as they like: their periods are those that a place sees."""
    if not parameters.has_states and len(parts) == 1:
        (part,) = parts
        return mode_state(part.along, part.against, part.grid, parameters)
    grid = parts[0].grid
    along, against = (np.sum([part[side] for part in parts], axis=0) for side in (1, 2))
    state = mode_state(along, against, grid, parameters)
    if not parameters.has_states or not state.m0 > 0.0:
        return state
    near = np.exp(-0.5 * (np.log(np.maximum(grid.k, 1e-300) / state.peak_wave_number) / _KERNEL_WIDTH) ** 2)
    energies = [(part.along + part.against) * grid.multiplicity for part in parts]
    m2, at_peak = (
        sum(float(np.sum(w * e * part.omega**2)) for part, e in zip(parts, energies, strict=True))
        for w in (1.0, near)
    )
    return dataclasses.replace(
        state,
        peak_period=_mean_period(float(np.sum(near * np.sum(energies, axis=0))), at_peak),
        zero_crossing_period=_mean_period(state.m0, m2),
    )


def _mean_period(m0: float, m2: float) -> float:
    """2π√(m0/m2), s; infinite for waves that stand still."""
    return float(2.0 * np.pi * np.sqrt(m0 / m2)) if m2 > 0.0 else float("inf")


def together(states: Sequence[SeaState]) -> SeaState:
    """Combined state of several wave systems; the peak is that of the system with the most energy."""
    moving = [state for state in states if state.m0 > 0.0]
    if not moving:
        return states[0]
    if len(moving) == 1:
        return moving[0]
    m0 = sum(state.m0 for state in moving)
    m2 = sum(state.m0 * (2.0 * np.pi / state.zero_crossing_period) ** 2 for state in moving)
    vector = sum(
        state.m0 * (1.0 - 0.5 * state.directional_spread**2) * np.exp(1j * state.mean_direction)
        for state in moving
    )
    highest = max(moving, key=lambda state: state.m0)
    return dataclasses.replace(
        highest,
        m0=m0,
        zero_crossing_period=_mean_period(m0, m2),
        mean_square_slope=sum(state.mean_square_slope for state in moving),
        mean_direction=float(np.angle(vector)),
        directional_spread=float(np.sqrt(max(0.0, 2.0 - 2.0 * np.abs(vector) / m0))),
    )


def field_state(elevation: NDArray[np.floating], parameters: OceanParameters) -> SeaState:
    """State measured from one (N, N) elevation field in m.

    A single field cannot distinguish a wave from the one travelling the opposite way: the mean direction is
    an axis, in (-π/2, π/2], and the spread is around this axis.
    """
    grid = WaveVectorGrid(elevation.shape[0], parameters.domain_size)
    coefficients = np.fft.rfft2(elevation.astype(np.float64)) / elevation.size
    coefficients[0, 0] = 0.0
    energy = np.abs(coefficients) ** 2 * grid.multiplicity
    m0 = np.sum(energy)
    axis = np.sum(energy * np.exp(2j * np.arctan2(grid.ky, grid.kx)))
    # for narrow spreading, doubled angles have four times the variance, so 1 - r is a quarter of theirs
    length = m0 - 0.25 * (m0 - np.abs(axis))
    vector = length * np.exp(0.5j * np.angle(axis))
    return _state_of_modes(energy, vector, grid, parameters)


def _state_of_modes(
    energy: Array, vector: complex, grid: WaveVectorGrid, parameters: OceanParameters
) -> SeaState:
    k = grid.k
    omega = dispersion.angular_frequency(k, parameters.dispersion, parameters.water)
    peak = _mode_peak(energy, grid, parameters)
    m2, slope = np.sum(omega**2 * energy), np.sum(k**2 * energy)
    return state_of_moments(np.sum(energy), m2, slope, vector, peak, parameters)


def state_of_moments(
    m0: float, m2: float, slope: float, vector: complex, peak: float, parameters: OceanParameters
) -> SeaState:
    """State from m0, m2, the slope variance, the sum of energies times unit directions x + iy, and ω at the
    peak."""
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
    density of modes there, 2πk (dk/dω) / Δk²: a plain histogram would show the lattice.
    """
    usable = grid.usable
    if not np.any(usable):  # for an image of two samples
        return float("nan")
    position = np.log(grid.k[usable]) * _BINS_PER_LOG
    first = int(np.floor(np.min(position))) - _BINS_PER_LOG // 2
    bins = (position - first + 0.5).astype(np.int64)
    size = int(np.max(bins)) + _BINS_PER_LOG // 2
    count = np.broadcast_to(grid.multiplicity, grid.shape)[usable]
    sums = [np.bincount(bins, weights, minlength=size) for weights in (energy[usable], count)]
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
