# SPDX-License-Identifier: GPL-3.0-or-later
"""The Fourier coefficients of an image's waves, and their sea state."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...numerics import random
from ...numerics.grid import WaveVectorGrid
from ...numerics.memo import remembered
from ...spectral import dispersion
from ...spectral.sea_state import Modes, SeaState, modes_state
from ...spectral.water import Water
from .animation import angular_frequency, runs_along
from .filters import filter_power, peak_frequency, total_energy
from .source import fitted, image_coefficients, noise_coefficients

if TYPE_CHECKING:
    from ...parameters.ocean_parameters import OceanParameters
    from .parameters import ImageLayer

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
RealArray = NDArray[np.floating]

#: fraction of an image's energy below which a filter is considered to remove all of it
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Filtered:
    """A filtered image, on a grid of its own or on that of the sea.

    grid : its wave vectors
    coefficients : (N, N//2+1) m, of the elevation at time 0
    expected : (N, N//2+1) m², mean over all seeds of their squares; for an artist's image, the squares
    """

    grid: WaveVectorGrid
    coefficients: ComplexArray
    expected: Array

    @property
    def m0(self) -> float:
        """Expected variance of the elevation, m²."""
        return float(np.sum(self.expected * self.grid.multiplicity))

    @property
    def slope_variance(self) -> float:
        """Expected mean square slope."""
        return float(np.sum(self.grid.k**2 * self.expected * self.grid.multiplicity))


class ImageWaves(NamedTuple):
    """Waves of an image; arrays like those of the sea's initial state, transposed in memory.

    h_plus, h_minus : waves that travel along +k and -k, m
    omega : rad/s, ≥ 0, the same for k and -k
    expected_plus, expected_minus : m²
    """

    h_plus: NDArray[np.complexfloating]
    h_minus: NDArray[np.complexfloating]
    omega: Array
    expected_plus: RealArray
    expected_minus: RealArray


def noise_seed(layer: ImageLayer, sea_seed: int) -> int:
    """The seed of a layer's noise: its own, or one derived from the sea's seed and the layer's id."""
    return layer.seed if layer.seed >= 0 else random.combine(sea_seed, layer.id, 0x71C)


def filtered(
    layer: ImageLayer,
    domain_size: float,
    resolution: int | None,
    relation: str,
    water: Water,
    sea_seed: int = 0,
) -> Filtered:
    """The elevation at time 0 from an image and its filter.

    resolution : of the sea; None for all modes of the image

    Noise with the physical filter has the variance of the wind's spectrum on average over seeds. Other
    elevations have their variance exactly, counting all modes of the image: a higher resolution of the sea
    shows more modes without changing any.
    """
    noise = layer.image is None
    if layer.image is None:
        source = noise_coefficients(layer.noise_resolution, noise_seed(layer, sea_seed))
    else:
        source = image_coefficients(layer.image)
    side = len(source)
    if noise and layer.is_physical:
        return _wind_driven(layer, domain_size, resolution or side, relation, water, source)
    whole = WaveVectorGrid(side, domain_size)
    power = filter_power(layer, whole, relation, water)
    wanted = wanted_variance(layer, water)
    coefficients = source * np.sqrt(power)
    squares = np.abs(coefficients) ** 2
    if np.sum(squares) < _ROUNDING * np.max(power) * np.sum(np.abs(source) ** 2):
        squares = np.zeros_like(squares)  # the remainder is rounding noise of the image, not waves
    coefficients *= np.sqrt(_factor(squares, whole, wanted))
    energy = power if noise else squares
    result = Filtered(whole, coefficients, energy * _factor(energy, whole, wanted))
    return result if resolution is None else _on_grid(result, resolution)


def wanted_variance(layer: ImageLayer, water: Water) -> float:
    """Target variance in m² of a layer's elevation, from its wind or from its own height."""
    if layer.is_physical:
        return layer.amplitude_scale**2 * total_energy(layer.wind_speed, water.gravity)
    return (layer.amplitude_scale * layer.significant_wave_height / 4.0) ** 2


def _wind_driven(
    layer: ImageLayer,
    domain_size: float,
    resolution: int,
    relation: str,
    water: Water,
    source: ComplexArray,
) -> Filtered:
    """h = c √(ΨΔkxΔky), with c the noise's coefficients divided by their expected magnitude 1/N."""
    grid = WaveVectorGrid(resolution, domain_size)
    side = len(source)
    expected = filter_power(layer, grid, relation, water) * (layer.amplitude_scale**2 * grid.cell_area)
    limit = (min(side, resolution) // 2 - 0.5) * grid.spacing
    expected[(grid.kx > limit) | (np.abs(grid.ky) > limit)] = 0.0  # beyond the modes of the noise
    return Filtered(grid, side * fitted(source, resolution) * np.sqrt(expected), expected)


def _on_grid(whole: Filtered, resolution: int) -> Filtered:
    grid = WaveVectorGrid(resolution, whole.grid.domain_size)
    return Filtered(grid, fitted(whole.coefficients, resolution), fitted(whole.expected, resolution))


def _factor(energy: Array, grid: WaveVectorGrid, wanted: float) -> float:
    """Factor from energies to the target variance in m²; 0 if a filter removes everything."""
    total = float(np.sum(energy * grid.multiplicity))
    return wanted / total if total > 0.0 else 0.0


def image_waves(
    layer: ImageLayer,
    grid: WaveVectorGrid,
    relation: str,
    water: Water,
    sea_seed: int,
    loop_duration: Fraction | None,
    match_height: bool,
    dtype: type = np.complex128,
) -> ImageWaves:
    """Coefficients of an image's waves on the sea's grid.

    match_height : whether to scale this seed to the expected variance
    """
    made = filtered(layer, grid.domain_size, grid.resolution, relation, water, sea_seed)
    if match_height:
        made = replace(
            made,
            coefficients=made.coefficients * np.sqrt(_factor(np.abs(made.coefficients) ** 2, grid, made.m0)),
        )
    along = runs_along(layer, grid)
    real = np.float32 if dtype is np.complex64 else np.float64
    return ImageWaves(
        h_plus=_transposed(made.coefficients, along, dtype),
        h_minus=_transposed(made.coefficients, ~along, dtype),
        omega=np.asfortranarray(angular_frequency(layer, grid, relation, water, loop_duration)),
        expected_plus=_transposed(made.expected, along, real),
        expected_minus=_transposed(made.expected, ~along, real),
    )


def _transposed(values: NDArray[Any], where: NDArray[np.bool_], dtype: type) -> NDArray[Any]:
    """The values where a condition holds, 0 elsewhere; transposed in memory."""
    return np.asfortranarray(np.where(where, values, 0.0).astype(dtype, copy=False))


@remembered("states of images")
def state_of(sea: OceanParameters, layer: ImageLayer) -> SeaState:
    """State of all modes of an image; cached, as it is slow to compute and often needed.

    sea : reduced to the settings that affect it
    """
    return modes_state([_modes(sea, layer)], sea)


def _modes(sea: OceanParameters, layer: ImageLayer) -> Modes:
    """All modes of an image, whether the sea's grid resolves them or not, without the loop."""
    relation, water = sea.dispersion, sea.water
    made = filtered(layer, sea.domain_size, None, relation, water, sea.seed)
    energy = made.expected
    if layer.is_physical and made.m0 > 0.0:
        # an image or patch too small for some of the wind's waves does not make the others lower
        energy = energy * (wanted_variance(layer, water) / made.m0)
    along = runs_along(layer, made.grid)
    omega = angular_frequency(layer, made.grid, relation, water)
    return Modes(made.grid, np.where(along, energy, 0.0), np.where(along, 0.0, energy), omega)


def peak_wavelength(layer: ImageLayer, relation: str, water: Water) -> float:
    """Wavelength in m at the peak of the modified Pierson-Moskowitz filter."""
    omega_m = 2.0 * np.pi * peak_frequency(layer.wind_speed, water.gravity)
    return float(2.0 * np.pi / dispersion.wave_number(omega_m, relation, water))
