# SPDX-License-Identifier: GPL-3.0-or-later
"""The spectrum of one wave layer over wave vectors, Ψ(kx, ky) in m⁴, and its mean over grid cells."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import dispersion
from .grid import WaveVectorGrid
from .layer_scales import LayerScales, layer_scales, scaled_spectrum
from .parameters import Water, WaveLayer
from .spreading import WIND_MODELS, Spreading, directional_spreading

Array = NDArray[np.float64]

#: cells nearer to the origin than this many cells are averaged over sub-cells: at radius r over
#: n x n with n the power of two that is at least _FINEST_RADIUS / r
_FINEST_RADIUS = 64.0

#: sub-cells along a side where the end of a band cuts a cell
_BAND_SUBCELLS = 8


@dataclass(frozen=True)
class DirectionalSpectrum:
    """S(ω)·D(ω, θ) of one layer, and its form over wave vectors.

    Horvath (2015), eq. 16 and 61.
    """

    layer: WaveLayer
    water: Water
    dispersion: str

    @cached_property
    def scales(self) -> LayerScales:
        """α, ω_p, γ and the fetch that acts."""
        return layer_scales(self.layer, self.water)

    @property
    def fetch_is_limited(self) -> bool:
        """Whether the sea is fully developed before its fetch ends."""
        return self.scales.fetch < self.layer.fetch

    @property
    def peak_frequency(self) -> float:
        """ω_p in rad/s, the peak frequency that wind and fetch set before the depth acts."""
        return self.scales.peak_frequency

    @cached_property
    def spreading(self) -> Spreading:
        """The layer's spreading model."""
        layer = self.layer
        model = Spreading(
            layer.spreading,
            swell=layer.swell,
            second=layer.second_spreading,
            mix=layer.spreading_mix,
            exponent=layer.spreading_exponent,
        )
        if WIND_MODELS.isdisjoint((model.model, model.second)):
            return model  # its tables serve every wind
        return replace(model, wind_frequency=self.scales.wind_frequency)

    def frequency_spectrum(self, omega: ArrayLike) -> Array:
        """S(ω) in m²·s/rad, any shape, with the layer's gain, band and short-wave cut-off."""
        k = dispersion.wave_number(omega, self.dispersion, self.water)
        return self._filtered_spectrum(np.asarray(omega, np.float64), k)

    def _filtered_spectrum(self, omega: Array, k: Array) -> Array:
        spectrum = scaled_spectrum(omega, self.layer, self.scales, self.water)
        return self.layer.gain**2 * self.energy_weight(k) * spectrum

    def energy_weight(self, k: Array) -> Array:
        """Share of the energy that the band and the short-wave cut-off leave, 0…1, over k in rad/m.

        The cut-off is Tessendorf's exp(-k²l²) (Horvath 2015, § 5.1.3). A band and its inverse add to 1.
        """
        layer = self.layer
        weight = self._band_weight(k) if self._has_band else np.ones_like(k)
        if layer.short_wave_cutoff > 0.0:
            weight = weight * np.exp(-((k * layer.short_wave_cutoff) ** 2))
        return weight

    @property
    def _has_band(self) -> bool:
        layer = self.layer
        return layer.band_inverted or bool(len(self._band_ends))

    @cached_property
    def _band_ends(self) -> Array:
        """Wave numbers in rad/m at which a band of the layer ends."""
        layer = self.layer
        ends = [layer.shortest_wavelength if layer.shortest_wavelength > 0.0 else None]
        ends.append(layer.longest_wavelength if layer.longest_wavelength < 1e6 else None)
        return np.array([2.0 * np.pi / wavelength for wavelength in ends if wavelength])

    def _band_weight(self, k: Array) -> Array:
        layer = self.layer
        octaves = np.log2(2.0 * np.pi / np.maximum(k, 1e-300))
        weight = np.ones_like(k)
        if layer.shortest_wavelength > 0.0:
            weight = weight * _rise(octaves - np.log2(layer.shortest_wavelength), layer.band_softness)
        if layer.longest_wavelength < 1e6:
            weight = weight * (1.0 - _rise(octaves - np.log2(layer.longest_wavelength), layer.band_softness))
        return 1.0 - weight if layer.band_inverted else weight

    def directional_spreading(self, omega: ArrayLike, theta: ArrayLike) -> Array:
        """D(ω, θ) in 1/rad; θ counter-clockwise from +x, not from the wind. Horvath (2015), eq. 41."""
        relative = np.asarray(theta, np.float64) - self.layer.wind_direction
        return directional_spreading(np.asarray(omega) / self.peak_frequency, relative, self.spreading)

    def density(self, kx: ArrayLike, ky: ArrayLike) -> Array:
        """Ψ(kx, ky) = S·D·(dω/dk)/k in m⁴, sampled at wave vectors other than 0. Horvath (2015), eq. 61."""
        k = np.hypot(kx, ky)
        return self._radial_part(k) * self.directional_spreading(self._omega(k), np.arctan2(ky, kx))

    def _omega(self, k: Array) -> Array:
        return dispersion.angular_frequency(k, self.dispersion, self.water)

    def _radial_part(self, k: Array) -> Array:
        rate = dispersion.group_velocity(k, self.dispersion, self.water)
        return self._filtered_spectrum(self._omega(k), k) * rate / k

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
        self._refine(grid, forward, backward)
        forward[~grid.usable] = 0.0
        backward[~grid.usable] = 0.0
        return forward, backward

    def _refine(self, grid: WaveVectorGrid, forward: Array, backward: Array) -> None:
        """Replace samples by means over sub-cells where Ψ varies within a cell."""
        subdivisions = self._subdivisions(grid)
        for n in np.unique(subdivisions[subdivisions > 1]):
            row, column = np.nonzero(subdivisions == n)
            offset = ((np.arange(n) + 0.5) / n - 0.5) * grid.spacing
            kx = grid.kx[0, column][:, np.newaxis, np.newaxis] + offset[np.newaxis, np.newaxis, :]
            ky = grid.ky[row, 0][:, np.newaxis, np.newaxis] + offset[np.newaxis, :, np.newaxis]
            forward[row, column] = self.density(kx, ky).mean(axis=(1, 2))
            backward[row, column] = self.density(-kx, -ky).mean(axis=(1, 2))

    def _subdivisions(self, grid: WaveVectorGrid) -> NDArray[np.int64]:
        """(N, N//2+1) sub-cells along a side: more towards the origin, where cells are wide against their
        wave number, and where the sharp end of a band cuts a cell."""
        wanted = _FINEST_RADIUS / np.clip(grid.k / grid.spacing, 1.0, _FINEST_RADIUS)
        result = 2 ** np.ceil(np.log2(wanted)).astype(np.int64)
        if self.layer.band_softness == 0.0:
            for end in self._band_ends:
                cut = np.abs(grid.k - end) < np.sqrt(0.5) * grid.spacing
                result[cut] = np.maximum(result[cut], _BAND_SUBCELLS)
        result[~grid.usable] = 0
        return result


def _rise(octaves: Array, width: float) -> Array:
    """0 below, 1 above 0 octaves, with a smooth step of the given width between; a half at 0."""
    if width == 0.0:
        return (octaves >= 0.0).astype(np.float64)
    x = np.clip(octaves / width + 0.5, 0.0, 1.0)
    return x * x * (3.0 - 2.0 * x)
