# SPDX-License-Identifier: GPL-3.0-or-later
"""Power of the image filters over wave vectors; its square root multiplies magnitudes.

Symbols as in Mastin, Watterberg & Mareda (1987): f in Hz, its peak f_m, U in m/s at 10 m, D the fractal
dimension. All powers are even in k: an image cannot distinguish opposite directions, and the paper's figure 7
passes 45° and 225° alike.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...numerics.grid import WaveVectorGrid
from ...spectral import constants, dispersion
from ...spectral.water import Water

if TYPE_CHECKING:
    from .parameters import ImageLayer

Array = NDArray[np.float64]

#: cells within this radius, in cells, of the origin are averaged over n x n sub-cells, with n about this over
# the radius
_FINEST_RADIUS = 32.0

#: width of the texture's Gaussian over its peak wave number, not given in the paper
_TEXTURE_WIDTH = 1.0 / 3.0


def peak_frequency(U: float, g: float = constants.GRAVITY) -> float:
    """f_m in Hz, infinite in a calm. Mastin et al. (1987), eq. 2."""
    return constants.MASTIN_PEAK * g / U if U >= constants.CALM else math.inf


def pierson_moskowitz(f: ArrayLike, U: float, g: float = constants.GRAVITY) -> Array:
    """F_PM(f) in m²·s, any shape, with F_PM(0) = 0. Mastin et al. (1987), eq. 1."""
    f_m = peak_frequency(U, g)
    if math.isinf(f_m):
        return np.zeros(np.shape(f))
    # the exponential is zero in double precision where (f_m/f)⁴ > 600: the floor keeps the quotient finite
    f = np.maximum(np.asarray(f, np.float64), 0.2 * f_m)
    fall = np.exp(-constants.DEVELOPMENT * (f_m / f) ** 4)
    return np.where(f > 0.2 * f_m, constants.PM_ALPHA * g**2 / ((2.0 * np.pi) ** 4 * f**5) * fall, 0.0)


def total_energy(U: float, g: float = constants.GRAVITY) -> float:
    """m0 = ∫F_PM df in m²: α g² / (5 (2πf_m)⁴)."""
    omega_m = 2.0 * np.pi * peak_frequency(U, g)
    return float(constants.PM_ALPHA * g**2 / (4.0 * constants.DEVELOPMENT * omega_m**4))


def spreading_power(ratio: ArrayLike) -> Array:
    """p over f/f_m > 0. Mastin et al. (1987), eq. 5; both branches meet at the peak, which the paper leaves
    out."""
    ratio = np.asarray(ratio, np.float64)
    mu = np.where(ratio < 1.0, constants.MASTIN_BELOW_EXPONENT, constants.MASTIN_ABOVE_EXPONENT)
    return constants.MASTIN_SHAPE * ratio**mu


def directional_spreading(ratio: ArrayLike, theta: ArrayLike) -> Array:
    """D(f, θ) in 1/rad over f/f_m and the angle to the wind. Mastin et al. (1987), eq. 4 and 6.

    1/N_p is Γ(p+1) / (2√π Γ(p+½)), the same as the printed one by the duplication formula.
    """
    p = spreading_power(ratio)
    nodes, values = _normalisation()
    cosine = np.abs(np.cos(0.5 * np.asarray(theta, np.float64)))
    return np.interp(p, nodes, values) * np.maximum(cosine, 1e-300) ** (2.0 * p)


@lru_cache(maxsize=1)
def _normalisation() -> tuple[Array, Array]:
    """p and 1/N_p, tabulated finely enough for linear interpolation to 10⁻⁷."""
    p = np.linspace(0.0, constants.MASTIN_SHAPE, 8193)
    values = [math.exp(math.lgamma(x + 1.0) - math.lgamma(x + 0.5)) / (2.0 * math.sqrt(math.pi)) for x in p]
    return p, np.array(values)


def directional_power(k: Array, theta: Array, layer: ImageLayer, relation: str, water: Water) -> Array:
    """The modified Pierson-Moskowitz filter's power, even in k, over k > 0 and the angle to the wind.

    PAPER: F(f, θ) in m²·s/rad, eq. 3. PHYSICAL: Ψ = F·(df/dk)/k in m⁴, whose integral over the plane is m0.
    The mean of both directions, because an image gives half of its energy to either.
    """
    omega = dispersion.angular_frequency(k, relation, water)
    f, g = omega / (2.0 * np.pi), water.gravity
    radial = pierson_moskowitz(f, layer.wind_speed, g)
    if layer.filter_gain == "PHYSICAL":
        radial = radial * dispersion.group_velocity(k, relation, water) / (2.0 * np.pi * k)
    ratio = f / peak_frequency(layer.wind_speed, g)
    both = directional_spreading(ratio, theta) + directional_spreading(ratio, theta + np.pi)
    return 0.5 * radial * both


def _modified_pierson_moskowitz(
    layer: ImageLayer, grid: WaveVectorGrid, relation: str, water: Water
) -> Array:
    """Means over wave-vector cells, as the spectrum varies within a cell near the peak."""

    def power(kx: Array, ky: Array) -> Array:
        k = np.maximum(np.hypot(kx, ky), 1e-9 * grid.spacing)
        return directional_power(k, np.arctan2(ky, kx) - layer.wind_direction, layer, relation, water)

    result = power(grid.kx, grid.ky)
    near = int(min(_FINEST_RADIUS, grid.resolution // 2))
    rows = np.r_[0:near, grid.resolution - near : grid.resolution]
    radius = np.hypot(np.arange(near), grid.ky[rows] / grid.spacing)
    divisions = 2 ** np.ceil(np.log2(_FINEST_RADIUS / np.clip(radius, 1.0, _FINEST_RADIUS))).astype(int)
    for n in np.unique(divisions[divisions > 1]):
        row, column = np.nonzero(divisions == n)
        offset = ((np.arange(n) + 0.5) / n - 0.5) * grid.spacing
        kx = grid.kx[0, column][:, np.newaxis, np.newaxis] + offset
        ky = grid.ky[rows[row], 0][:, np.newaxis, np.newaxis] + offset[:, np.newaxis]
        result[rows[row], column] = power(kx, ky).mean(axis=(1, 2))
    return result


def spectral_exponent(D: float) -> float:
    """β of the power 1/k^β of a surface of fractal dimension D: 8 - 2D."""
    return 8.0 - 2.0 * D


def _fractal(layer: ImageLayer, grid: WaveVectorGrid, relation: str, water: Water) -> Array:
    """1/k^β, 1 for the longest wave (Mastin et al. 1987, fig. 2)."""
    return (np.maximum(grid.k, grid.spacing) / grid.spacing) ** -spectral_exponent(layer.fractal_dimension)


def _water_texture(layer: ImageLayer, grid: WaveVectorGrid, relation: str, water: Water) -> Array:
    """1/k^β beyond a peak and a Gaussian below it, 1 at the peak (Mastin et al. 1987, fig. 3)."""
    ratio = grid.k * (layer.texture_wavelength / (2.0 * np.pi))
    above = np.maximum(ratio, 1.0) ** -spectral_exponent(layer.fractal_dimension)
    return above * np.exp(-0.5 * (np.minimum(ratio - 1.0, 0.0) / _TEXTURE_WIDTH) ** 2)


POWERS: dict[str, Callable[[ImageLayer, WaveVectorGrid, str, Water], Array]] = {
    "MODIFIED_PIERSON_MOSKOWITZ": _modified_pierson_moskowitz,
    "FRACTAL": _fractal,
    "WATER_TEXTURE": _water_texture,
}


def filter_power(layer: ImageLayer, grid: WaveVectorGrid, relation: str, water: Water) -> Array:
    """(N, N//2+1): power of the layer's filter for each mode; 0 for the mean and at Nyquist.

    relation : name of the dispersion relation, for the filter defined over frequencies
    """
    power = POWERS[layer.filter](layer, grid, relation, water)
    power[~grid.usable] = 0.0
    return power


def unit_gain(power: Array, grid: WaveVectorGrid) -> Array:
    """The power scaled to an average of 1 over all modes except the mean, so that white noise keeps its
    variance.

    The paper's unit gain (Mastin et al. 1987, fig. 7).
    """
    total = float(np.sum(power * grid.multiplicity))
    return power * ((grid.resolution**2 - 1) / total) if total > 0.0 else power
