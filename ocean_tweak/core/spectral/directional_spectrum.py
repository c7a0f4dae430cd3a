# SPDX-License-Identifier: GPL-3.0-or-later
"""The spectrum of one wave layer over wave vectors, Ψ(kx, ky) in m⁴, and its mean over grid cells."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..numerics.grid import WaveVectorGrid
from ..numerics.interpolation import smoothstep
from . import dispersion
from .equaliser import Equalising
from .spectra import LayerScales, layer_scales, scaled_spectrum
from .spreading import (
    WIND_MODELS,
    Shape,
    Spreading,
    directional_spreading,
    mean_cosine,
    spreading_shape,
    wrap_angle,
)
from .water import Water

if TYPE_CHECKING:
    from ..waves.spectral import WaveLayer

Array = NDArray[np.float64]

#: nodes per unit of ln k: resolves JONSWAP's peak, the narrowest feature, to 1e-5 of its value
_NODES_PER_LOG = 1024

_LEAST_ENERGY = 1e-300

#: cells within this radius, in cells, of the origin are averaged over sub-cells: n x n at radius r, with n
# the smallest power of two that is at least FINEST_RADIUS / r
FINEST_RADIUS = 32.0

#: sub-cells along a side of a cell that is cut by the end of a band
_BAND_SUBCELLS = 8


@dataclass(frozen=True)
class DirectionalSpectrum:
    """S(ω)·D(ω, θ) of one layer, and its form over wave vectors.

    Horvath (2015), eq. 16 and 61.

    patch_band : shortest and longest wavelength in m of the patch that holds it, sharp, beside the layer's
        own band; None for all waves
    equalisers : that change its heights by wavelength
    """

    layer: WaveLayer
    water: Water
    dispersion: str
    patch_band: tuple[float, float] | None = None
    equalisers: tuple[Equalising, ...] = ()

    @cached_property
    def scales(self) -> LayerScales:
        """α, ω_p, γ and the effective fetch."""
        return layer_scales(self.layer, self.water)

    @property
    def fetch_is_limited(self) -> bool:
        """Whether the sea is fully developed within its fetch."""
        return self.scales.fetch < self.layer.fetch

    @property
    def peak_frequency(self) -> float:
        """ω_p in rad/s, the peak frequency for wind and fetch before the depth factor."""
        return self.scales.peak_frequency

    @property
    def peaks(self) -> tuple[float, float]:
        """ω in rad/s between which its peaks lie: a fifth of the lowest to a hundred of the highest hold all
        of its energy."""
        return self.peak_frequency, self.peak_frequency

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
            return model  # its tables apply to every wind
        return replace(model, wind_frequency=self.scales.wind_frequency)

    def frequency_spectrum(self, omega: ArrayLike) -> Array:
        """S(ω) in m²·s/rad, any shape, with the layer's amplitude scale, band, cut-off and equalisers."""
        spectrum = self.layer.amplitude_scale**2 * self._own_spectrum(np.asarray(omega, np.float64))
        if not (self.has_band or self.layer.short_wave_cutoff > 0.0 or self.equalisers):
            return spectrum
        return self.energy_weight(dispersion.wave_number(omega, self.dispersion, self.water)) * spectrum

    def _own_spectrum(self, omega: Array) -> Array:
        """S(ω) in m²·s/rad before all that the layer does to it."""
        return scaled_spectrum(omega, self.layer, self.scales, self.water)

    def energy_weight(self, k: Array) -> Array:
        """What the energy is multiplied by, over k in rad/m: by the band and the short-wave cut-off, of which
        each leaves a share, and by equalisers.

        The cut-off is Tessendorf's exp(-k²l²) (Horvath 2015, § 5.1.3). A band and its inverse add to 1.
        """
        layer = self.layer
        weight = self._band_weight(k) if self._layer_has_band else np.ones_like(k)
        if self.patch_band is not None:
            shortest, longest = self.patch_band
            wavelength = 2.0 * np.pi / np.maximum(k, 1e-300)
            weight = weight * ((wavelength > shortest) & (wavelength <= longest))
        if layer.short_wave_cutoff > 0.0:
            weight = weight * np.exp(-((k * layer.short_wave_cutoff) ** 2))
        for equaliser in self.equalisers:
            weight = weight * equaliser.energy_gain(k)
        return weight

    @property
    def has_band(self) -> bool:
        """Whether the layer or its patch excludes wavelengths."""
        return self._layer_has_band or self.patch_band is not None

    @property
    def _layer_has_band(self) -> bool:
        return self.layer.band_inverted or bool(len(self.band_ends))

    @property
    def sharp_ends(self) -> Array:
        """Wave numbers in rad/m of sharp band ends."""
        of_layer = self.band_ends if self.layer.band_softness == 0.0 else self.band_ends[:0]
        ends = [end for end in self.patch_band or () if 0.0 < end < 1e6]
        return np.concatenate([of_layer, 2.0 * np.pi / np.array(ends)]) if ends else of_layer

    @cached_property
    def band_ends(self) -> Array:
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

    def direction_vector(self, omega: Array, energy: Array, weight: Array) -> complex:
        """∫∫E e^{iθ} dθ dω in m²: the mean direction, as long as the energy that keeps to it.

        omega, energy, weight : nodes in rad/s, this spectrum's S there in m²·s/rad, and weights in rad/s
        """
        # directions vary slowly with ω: every eighth frequency is enough
        cosine = mean_cosine(omega[::8] / self.peak_frequency, self.spreading)
        along = np.sum(energy * np.interp(omega, omega[::8], cosine) * weight)
        return complex(np.exp(1j * self.layer.wind_direction) * along)

    def density(self, kx: ArrayLike, ky: ArrayLike) -> Array:
        """Ψ(kx, ky) = S·D·(dω/dk)/k in m⁴, sampled at wave vectors other than 0. Horvath (2015), eq. 61."""
        k = np.hypot(kx, ky)
        omega = dispersion.angular_frequency(k, self.dispersion, self.water)
        spreading = self.directional_spreading(omega, np.arctan2(ky, kx))
        return self.energy_weight(k) * self._radial_energy(k, omega) * spreading

    def _radial_energy(self, k: Array, omega: Array) -> Array:
        """S·(dω/dk)/k in m⁴·rad, before band and cut-off."""
        rate = dispersion.group_velocity(k, self.dispersion, self.water)
        return self.layer.amplitude_scale**2 * self._own_spectrum(omega) * rate / k

    @property
    def finest_radius(self) -> float:
        """Distance from the origin, in cells, from which the centre of a cell stands for all of it."""
        return FINEST_RADIUS

    def sampler(self, lowest: float, highest: float) -> Sampler:
        """What samples Ψ quickly at wave numbers between these, in rad/m."""
        return RadialSampler(self, lowest, highest)

    def cell_means(self, grid: WaveVectorGrid) -> tuple[Array, Array]:
        """Ψ averaged over each wave-vector cell, in m⁴, for k and for -k.

        Returns two (N, N//2+1) arrays, 0 at the mean and at Nyquist. Sampling at the cell's centre instead
        (Horvath 2015, eq. 46; Chen 2014, eq. 17) can lose or double the energy of a narrow peak.
        """
        return CellMeans(self, grid).both()


class Nodes(NamedTuple):
    """Positions of wave numbers between the nodes of a table."""

    below: NDArray[np.int64]
    fraction: Array


class RadialTable:
    """Energy and spreading shape over k, interpolated linearly in ln k (the energy in its logarithm).

    Apart from the angle, everything in Ψ(kx, ky) depends on k alone. The nodes are integer multiples of a
    fixed step in ln k, so a wave vector has the same value on every grid. A table covers wave numbers from
    `lowest` to `highest` in rad/m.
    """

    def __init__(self, lowest: float, highest: float) -> None:
        self._first = int(np.floor(np.log(lowest) * _NODES_PER_LOG)) - 1
        last = int(np.ceil(np.log(highest) * _NODES_PER_LOG)) + 1
        self.k: Array = np.exp(np.arange(self._first, last + 1) / _NODES_PER_LOG)

    def fill(self, energy: Array, shape: Shape) -> None:
        """Store the values at the nodes `k`: energy in m⁴ per unit of D, and the shape of D."""
        first, second = shape.first_weight, shape.second_weight
        self._values = shape._replace(
            first_weight=np.log(np.maximum(energy * first, _LEAST_ENERGY)),
            second_weight=None if second is None else np.log(np.maximum(energy * second, _LEAST_ENERGY)),
        )

    def nodes(self, k: Array) -> Nodes:
        """Positions of wave numbers k, in rad/m, within the table's range."""
        position = np.log(k)
        position *= _NODES_PER_LOG
        position -= self._first
        index = position.astype(np.int64)
        position -= index
        return Nodes(index, position)

    def shape(self, at: Nodes) -> Shape:
        """The shape of D at these nodes, its weights multiplied by the energy."""
        values = _each(self._values, lambda table: _interpolated(table, at))
        second = values.second_weight
        return values._replace(
            first_weight=np.exp(values.first_weight),
            second_weight=None if second is None else np.exp(second),
        )


def _interpolated(values: Array, at: Nodes) -> Array:
    low = values[at.below]
    return low + at.fraction * (values[at.below + 1] - low)


def _each(shape: Shape, function: Callable[[Array], Array]) -> Shape:
    """A shape with a function applied to each of its arrays."""
    return Shape._make(None if array is None else function(array) for array in shape)


class Sampler(Protocol):
    """Gives Ψ in m⁴ at wave vectors and at their opposites, band and all included."""

    def of_columns(self, grid: WaveVectorGrid, columns: slice) -> tuple[Array, Array]:
        """At the centres of some columns' cells, (columns, N) each."""

    def at(self, kx: Array, ky: Array) -> tuple[Array, Array]:
        """At wave vectors in rad/m, of any one shape."""


class RadialSampler:
    """Samples a spectrum in which but for the angle everything depends on k alone, by a table over k."""

    def __init__(self, spectrum: DirectionalSpectrum, lowest: float, highest: float) -> None:
        self._spectrum = spectrum
        self._table = RadialTable(lowest, highest)
        k = self._table.k
        omega = dispersion.angular_frequency(k, spectrum.dispersion, spectrum.water)
        shape = spreading_shape(omega / spectrum.peak_frequency, spectrum.spreading)
        self._table.fill(spectrum._radial_energy(k, omega), shape)

    def of_columns(self, grid: WaveVectorGrid, columns: slice) -> tuple[Array, Array]:
        """The radial part is even in ky: half of it is enough."""
        kx, ky = grid.kx[0, columns, np.newaxis], grid.ky[:, 0]
        half = np.maximum(np.hypot(kx, ky[: grid.resolution // 2 + 1]), 0.5 * grid.spacing)
        shape = self._weighted_shape(half)
        return self._both_ways(_each(shape, grid.mirror), kx, ky)

    def at(self, kx: Array, ky: Array) -> tuple[Array, Array]:
        """At wave vectors in rad/m, of any one shape."""
        return self._both_ways(self._weighted_shape(np.hypot(kx, ky)), kx, ky)

    def _weighted_shape(self, k: Array) -> Shape:
        shape = self._table.shape(self._table.nodes(k))
        weight = self._spectrum.energy_weight(k)
        second = None if shape.second_weight is None else weight * shape.second_weight
        return shape._replace(first_weight=weight * shape.first_weight, second_weight=second)

    def _both_ways(self, shape: Shape, kx: Array, ky: Array) -> tuple[Array, Array]:
        """Ψ at k and at -k. All spreading models are even in θ, and -k lies at π - |θ|."""
        layer, spreading = self._spectrum.layer, self._spectrum.spreading
        theta = np.abs(wrap_angle(np.arctan2(ky, kx) - layer.wind_direction))
        return shape.density(theta, spreading), shape.density(np.pi - theta, spreading)


class CellMeans:
    """Means of a spectrum over the cells of a grid.

    Arrays inside are [kx, ky], as the transforms want them in memory.
    """

    def __init__(self, spectrum: DirectionalSpectrum, grid: WaveVectorGrid) -> None:
        self._spectrum = spectrum
        self._grid = grid
        # sub-cells reach half a cell inside of the first mode and beyond the last
        self._sampler = spectrum.sampler(0.25 * grid.spacing, 0.75 * grid.resolution * grid.spacing)

    def both(self) -> tuple[Array, Array]:
        """Means for k and for -k, two (N, N//2+1) arrays in m⁴."""
        grid = self._grid
        forward, backward = (np.empty(grid.shape[::-1]) for _ in range(2))
        for columns in grid.column_blocks():
            forward[columns], backward[columns] = self._sampler.of_columns(grid, columns)
        self._refine(forward, backward)
        for means in (forward, backward):
            means[~grid.usable.T] = 0.0
        return forward.T, backward.T

    def _refine(self, forward: Array, backward: Array) -> None:
        """Replace samples by means over sub-cells where Ψ varies within a cell."""
        grid = self._grid
        for n, column, row in self._cells_to_divide():
            offset = ((np.arange(n) + 0.5) / n - 0.5) * grid.spacing
            kx = grid.kx[0, column][:, np.newaxis, np.newaxis] + offset[np.newaxis, :, np.newaxis]
            ky = grid.ky[row, 0][:, np.newaxis, np.newaxis] + offset[np.newaxis, np.newaxis, :]
            along, against = self._sampler.at(kx, ky)
            forward[column, row] = along.mean(axis=(1, 2))
            backward[column, row] = against.mean(axis=(1, 2))

    def _cells_to_divide(self) -> Iterator[tuple[int, NDArray[np.intp], NDArray[np.intp]]]:
        """Numbers n of sub-cells along a side, each with the columns and rows of the cells that need n x
        n."""
        subdivisions = self._subdivisions()
        for n in np.unique(subdivisions[subdivisions > 1]):
            column, row = np.nonzero(subdivisions == n)
            yield int(n), column, row

    def _subdivisions(self) -> NDArray[np.int16]:
        """(N//2+1, N) numbers of sub-cells along a side: more towards the origin, where cells are wide
        relative to their wave number, and where a sharp end of a band cuts a cell."""
        grid = self._grid
        result = np.zeros(grid.shape[::-1], np.int16)
        finest = self._spectrum.finest_radius
        near = int(min(finest, grid.resolution // 2))
        for rows in (slice(0, near), slice(-near, None)):
            radius = np.hypot(np.arange(near)[:, np.newaxis], grid.ky[rows, 0] / grid.spacing)
            wanted = finest / np.clip(radius, 1.0, finest)
            result[:near, rows] = 2 ** np.ceil(np.log2(wanted))
        ends = self._spectrum.sharp_ends
        k = grid.k.T if len(ends) else None
        for end in ends:
            cut = np.abs(k - end) < np.sqrt(0.5) * grid.spacing
            result[cut] = np.maximum(result[cut], _BAND_SUBCELLS)
        result[~grid.usable.T] = 0
        return result


def _rise(octaves: Array, width: float) -> Array:
    """Smoothstep of the given width in octaves: 0 below 0, ½ at 0, 1 above."""
    if width == 0.0:
        return (octaves >= 0.0).astype(np.float64)
    # clipped before the division: the width may be the smallest float
    return smoothstep(np.clip(octaves, -width, width) / width + 0.5)
