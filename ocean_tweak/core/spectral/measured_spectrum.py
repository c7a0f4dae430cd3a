# SPDX-License-Identifier: GPL-3.0-or-later
"""The spectrum over wave vectors of a layer with measured energy, also in a current.

At a fixed place waves have the frequency ω = σ + k·U, with σ the frequency in still water and U the current.
For frequencies at a fixed place, the energy in dω equals that in dσ: E(σ, θ) = E(ω, θ)·(1 + U cos(θ -
θ_U)/c_g). Waves whose energy the current carries back, c_g + U·k/|k| ≤ 0, are blocked.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..numerics.grid import WaveVectorGrid
from ..numerics.memo import remembered
from . import dispersion
from .constants import PM_PEAK
from .directional_spectrum import FINEST_RADIUS, DirectionalSpectrum, Sampler
from .measured import DIRECTIONS, EnergyTable, MeasuredSpectra, table_directions
from .spectra import LayerScales, refined_peak
from .spreading import Spreading, directional_spreading

Array = NDArray[np.float64]

_TURN = 2.0 * np.pi

#: number of directions for averages in a current, unless waves keep to few; and of wave numbers in the search
# for the fastest
_COARSE, _TRIED = 180, 400
#: number of parts of a bin, each of which is blocked or not
_FINE = 16
#: cells in a radian for each 1/rad of the highest D: so sampled, a Lorentzian keeps its integral to 1 %
_SHARPNESS = 2.5


@dataclass(frozen=True)
class MeasuredSpectrum(DirectionalSpectrum):
    """S·D of a layer that has measured spectra, at its time.

    current : x and y in m/s, in the sea's axes
    """

    current: tuple[float, float] = (0.0, 0.0)

    @cached_property
    def table(self) -> EnergyTable:
        """E(f, θ), with directions from the layer's."""
        layer = self.layer
        assert layer.measured is not None
        model = Spreading(
            layer.spreading, swell=layer.swell, second=layer.second_spreading, mix=layer.spreading_mix,
            exponent=layer.spreading_exponent, wind_frequency=PM_PEAK,
        )  # fmt: skip
        return _table(layer.measured, layer.measured_time, None if layer.measured.has_directions else model)

    @cached_property
    def scales(self) -> LayerScales:
        """Only the peak frequency is defined."""
        return LayerScales(float("nan"), _TURN * peak_of_bins(self.table.f, self.table.energy), 1.0, PM_PEAK)

    @property
    def peaks(self) -> tuple[float, float]:
        """Lowest and highest peak ω in rad/s: all energy lies between a fifth of the first and a hundred
        times the second."""
        peak = self.peak_frequency
        if not np.isfinite(peak):
            peak = _TURN * float(self.table.f[0])
        return min(peak, 5.0 * _TURN * float(self.table.edges[0])), peak

    @cached_property
    def mean_direction(self) -> float:
        """rad, counter-clockwise from +x, weighted by the energy that was measured."""
        vectors = self.table.mean_vector(self.table.f)
        return (
            float(np.angle(np.sum(self.table.energy * self.table.width * vectors)))
            + self.layer.wind_direction
        )

    @property
    def shares_of_lengths(self) -> tuple[Array, Array]:
        """Wavelengths in m of the bins, and the fraction of the energy in each."""
        energy = self.table.energy * self.table.width
        k = dispersion.wave_number(_TURN * self.table.f, self.dispersion, self.water)
        return _TURN / k, energy / max(float(np.sum(energy)), 1e-300)

    @property
    def _is_shifted(self) -> bool:
        measured = self.layer.measured
        return measured is not None and measured.absolute and self.current != (0.0, 0.0)

    def _own_spectrum(self, omega: Array) -> Array:
        if not self._is_shifted:
            return self.table.frequency_spectrum(omega / _TURN) / _TURN
        return self._over_directions(omega)[0]

    def direction_vector(self, omega: Array, energy: Array, weight: Array) -> complex:
        """∫∫E e^{iθ} dθ dω in m², of the energies that are given."""
        if not self._is_shifted:
            vectors = np.exp(1j * self.layer.wind_direction) * self.table.mean_vector(omega / _TURN)
        else:
            own, vector = self._over_directions(omega)
            vectors = np.divide(vector, own, out=np.zeros_like(vector), where=own > 0.0)
        return complex(np.sum(energy * vectors * weight))

    @property
    def finest_radius(self) -> float:
        """In cells; farther out where waves keep to fewer directions than lie between two cells, up to where
        cells are as near each other as the table's directions."""
        return min(max(FINEST_RADIUS, _SHARPNESS * self.table.sharpest), DIRECTIONS / _TURN)

    @property
    def _directions(self) -> Array:
        """rad, evenly around the circle, as many as integrals over direction need."""
        return table_directions()[:: 1 if self.finest_radius > FINEST_RADIUS else DIRECTIONS // _COARSE]

    def _over_directions(self, omega: Array) -> tuple[Array, NDArray[np.complex128]]:
        """Integrals of E and of E e^{iθ} over θ, over σ in rad/s."""
        energy, vector = np.zeros(omega.shape), np.zeros(omega.shape, complex)
        k = dispersion.wave_number(omega, self.dispersion, self.water)
        rate = dispersion.group_velocity(np.maximum(k, 1e-12), self.dispersion, self.water)
        directions = self._directions
        for theta in directions:
            part = self._energy(omega, k, rate, np.asarray(theta)) * (_TURN / len(directions))
            energy += part
            vector += part * np.exp(1j * theta)
        return energy, vector

    def _energy(self, omega: Array, k: Array, rate: Array, theta: Array) -> Array:
        """E in m²·s/rad², per σ, of waves towards θ in rad, before the layer's scale and band.

        omega, k, rate : σ in rad/s, wave numbers, and group velocities in m/s
        """
        stretch, seen = np.ones_like(omega), omega
        if self._is_shifted:
            along = self.current[0] * np.cos(theta) + self.current[1] * np.sin(theta)
            stretch, seen = np.maximum(1.0 + along / rate, 0.0), np.maximum(omega + k * along, 0.0)
        f = seen / _TURN
        spread = self.table.spreading(f, theta - self.layer.wind_direction)
        return self.table.frequency_spectrum(f) * spread * stretch / _TURN

    def directional_spreading(self, omega: ArrayLike, theta: ArrayLike) -> Array:
        """D(ω, θ) in 1/rad; θ counter-clockwise from +x."""
        omega, theta = np.asarray(omega, np.float64), np.asarray(theta, np.float64)
        if not self._is_shifted:
            return self.table.spreading(omega / _TURN, theta - self.layer.wind_direction)
        omega = np.broadcast_to(omega, np.broadcast_shapes(omega.shape, theta.shape))
        k = dispersion.wave_number(omega, self.dispersion, self.water)
        rate = dispersion.group_velocity(np.maximum(k, 1e-12), self.dispersion, self.water)
        energy, whole = self._energy(omega, k, rate, theta), self._own_spectrum(omega)
        return np.divide(energy, whole, out=np.zeros_like(energy), where=whole > 0.0)

    def density(self, kx: ArrayLike, ky: ArrayLike) -> Array:
        """Ψ(kx, ky) = E·(dσ/dk)/k in m⁴, sampled at wave vectors other than 0. Horvath (2015), eq. 61."""
        k = np.hypot(kx, ky)
        omega = dispersion.angular_frequency(k, self.dispersion, self.water)
        rate = dispersion.group_velocity(k, self.dispersion, self.water)
        energy = self._energy(omega, k, rate, np.arctan2(ky, kx))
        return self.layer.amplitude_scale**2 * self.energy_weight(k) * energy * rate / k

    def sampler(self, lowest: float, highest: float) -> Sampler:
        """The spectrum is sampled directly, as its tables are over frequency and direction already."""
        return DensitySampler(self)

    @cached_property
    def blocked_share(self) -> float:
        """Fraction of the measured energy, 0…1, that the current blocks."""
        if not self._is_shifted:
            return 0.0
        theta = self._directions
        along = self.current[0] * np.cos(theta) + self.current[1] * np.sin(theta)
        k = np.geomspace(1e-4, 400.0, _TRIED)[:, np.newaxis]
        rate = dispersion.group_velocity(k, self.dispersion, self.water)
        seen = dispersion.angular_frequency(k, self.dispersion, self.water) + k * along
        # on the branch of waves that come up against the current
        fastest = np.max(np.where(rate + along > 0.0, seen, 0.0), axis=0)
        middles = np.arange(_FINE * len(self.table.f)) / _FINE + 0.5 / _FINE
        f = np.interp(middles, np.arange(len(self.table.edges)), self.table.edges)
        energy = self.table.frequency_spectrum(f) * np.repeat(self.table.width, _FINE)
        spread = self.table.spreading(f[:, np.newaxis], theta - self.layer.wind_direction)
        parts = energy[:, np.newaxis] * spread
        whole = float(np.sum(parts))
        return float(np.sum(parts[f[:, np.newaxis] * _TURN > fastest])) / whole if whole > 0.0 else 0.0


class DensitySampler:
    """Samples a spectrum by its density."""

    def __init__(self, spectrum: DirectionalSpectrum) -> None:
        self._spectrum = spectrum

    def of_columns(self, grid: WaveVectorGrid, columns: slice) -> tuple[Array, Array]:
        """At the centres of some columns' cells, (columns, N) each."""
        kx, ky = np.broadcast_arrays(grid.kx[0, columns, np.newaxis], grid.ky[:, 0])
        # the mean is no wave, and has no direction
        kx = np.where((kx == 0.0) & (ky == 0.0), 0.5 * grid.spacing, kx)
        return self.at(kx, ky)

    def at(self, kx: Array, ky: Array) -> tuple[Array, Array]:
        """At wave vectors in rad/m and at their opposites."""
        return self._spectrum.density(kx, ky), self._spectrum.density(-kx, -ky)


@remembered("measured spectra")
def _table(measured: MeasuredSpectra, time: float, model: Spreading | None) -> EnergyTable:
    """E(f, θ) at a time; where none was measured, with the directions of a model around 0."""
    if model is None:
        return measured.table(time)
    f, _ = measured.bins
    peak = peak_of_bins(f, measured.energy_at(time))
    ratio = f[:, np.newaxis] / (peak if np.isfinite(peak) else f[0])
    return measured.table(time, directional_spreading(ratio, table_directions(), model))


def peak_of_bins(f: Array, energy: Array) -> float:
    """Frequency in Hz of the highest bin, refined by a parabola through three of them; NaN for none."""
    return refined_peak(f, energy)
