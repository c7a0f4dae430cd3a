# SPDX-License-Identifier: GPL-3.0-or-later
"""The spectrum of one wave layer over wave vectors, Ψ(kx, ky) in m⁴, and its mean over grid cells."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import dispersion, spectra
from .grid import WaveVectorGrid
from .parameters import Water, WaveLayer
from .spreading import spreading

Array = NDArray[np.float64]

#: cells nearer to the origin than this many cells are averaged over sub-cells: at radius r over
#: n x n with n the power of two that is at least _FINEST_RADIUS / r
_FINEST_RADIUS = 64.0


@dataclass(frozen=True)
class DirectionalSpectrum:
    """S(ω)·D(ω, θ) of one layer, and its form over wave vectors.

    Horvath (2015), eq. 16 and 61.
    """

    layer: WaveLayer
    water: Water
    dispersion: str

    @cached_property
    def fetch(self) -> float:
        """The fetch in m that acts: limited to full development where the layer says so."""
        if not self.layer.limit_fetch:
            return self.layer.fetch
        return min(
            self.layer.fetch, spectra.full_development_fetch(self.layer.wind_speed, self.water.gravity)
        )

    @property
    def fetch_is_limited(self) -> bool:
        return self.fetch < self.layer.fetch

    @cached_property
    def peak_frequency(self) -> float:
        """ω_p in rad/s, the peak frequency that wind and fetch set before the depth acts."""
        return spectra.jonswap_peak(self.layer.wind_speed, self.fetch, self.water.gravity)

    def frequency_spectrum(self, omega: ArrayLike) -> Array:
        """S(ω) in m²·s/rad, any shape; the layer's gain multiplies wave heights."""
        alpha = spectra.jonswap_alpha(self.layer.wind_speed, self.fetch, self.water.gravity)
        return self.layer.gain**2 * spectra.tma(omega, alpha, self.peak_frequency, self.water)

    def directional_spreading(self, omega: ArrayLike, theta: ArrayLike) -> Array:
        """D(ω, θ) in 1/rad; θ counter-clockwise from +x, not from the wind. Horvath (2015), eq. 41."""
        relative = np.asarray(theta, np.float64) - self.layer.wind_direction
        ratio = np.asarray(omega, np.float64) / self.peak_frequency
        return spreading(ratio, relative, self.layer.spreading, self.layer.swell)

    def density(self, kx: ArrayLike, ky: ArrayLike) -> Array:
        """Ψ(kx, ky) = S·D·(dω/dk)/k in m⁴, sampled at wave vectors other than 0. Horvath (2015), eq. 61."""
        k = np.hypot(kx, ky)
        return self._radial_part(k) * self.directional_spreading(self._omega(k), np.arctan2(ky, kx))

    def _omega(self, k: Array) -> Array:
        return dispersion.angular_frequency(k, self.dispersion, self.water)

    def _radial_part(self, k: Array) -> Array:
        rate = dispersion.group_velocity(k, self.dispersion, self.water)
        return self.frequency_spectrum(self._omega(k)) * rate / k

    def cell_means(self, grid: WaveVectorGrid) -> tuple[Array, Array]:
        """Ψ averaged over each wave-vector cell, in m⁴, for k and for -k.

        Returns two (N, N//2+1) arrays; modes that are no waves hold 0. Sampling at the cell's centre
        instead (Horvath 2015, eq. 46; Chen 2014, eq. 17) loses or doubles the energy of a narrow peak.
        """
        k = np.where(grid.usable, grid.k, grid.spacing)
        radial = self._radial_part(k)
        omega, theta = self._omega(k), np.arctan2(grid.ky, grid.kx)
        forward = radial * self.directional_spreading(omega, theta)
        backward = radial * self.directional_spreading(omega, theta + np.pi)
        self._refine_near_origin(grid, forward, backward)
        forward[~grid.usable] = 0.0
        backward[~grid.usable] = 0.0
        return forward, backward

    def _refine_near_origin(self, grid: WaveVectorGrid, forward: Array, backward: Array) -> None:
        """Replace samples by means over sub-cells where a cell is wide against its wave number."""
        radius = grid.k / grid.spacing
        wanted = _FINEST_RADIUS / np.clip(radius, 1.0, _FINEST_RADIUS)
        subdivisions = 2 ** np.ceil(np.log2(wanted)).astype(int)
        for n in np.unique(subdivisions[(subdivisions > 1) & grid.usable]):
            row, column = np.nonzero((subdivisions == n) & grid.usable)
            offset = ((np.arange(n) + 0.5) / n - 0.5) * grid.spacing
            kx = grid.kx[0, column][:, np.newaxis, np.newaxis] + offset[np.newaxis, np.newaxis, :]
            ky = grid.ky[row, 0][:, np.newaxis, np.newaxis] + offset[np.newaxis, :, np.newaxis]
            forward[row, column] = self.density(kx, ky).mean(axis=(1, 2))
            backward[row, column] = self.density(-kx, -ky).mean(axis=(1, 2))
