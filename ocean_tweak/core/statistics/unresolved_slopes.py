# SPDX-License-Identifier: GPL-3.0-or-later
"""Slope variance of waves too short for a grid, which renderers show as roughness.

The mean square slope of waves is ∬k²Ψ dkx dky over their wave vectors. Microfacet roughness has the same
meaning: alpha² of a Beckmann or GGX distribution is the mean square slope of both axes together (Walter et
al. 2007; its Gaussian slopes are those of Cox & Munk 1954).

The integral ends where capillary waves begin, at the slowest wave, k = √(ρg/σ) (Lamb 1932, § 267): 1.7 cm in
water. The spectra describe gravity waves only up to there (Elfouhaily et al. 1997 use 370 rad/m).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..numerics.grid import WaveVectorGrid
from ..numerics.memo import remembered
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.patch_seas import patch_parameters
from ..spectral import constants, dispersion
from ..spectral.directional_spectrum import DirectionalSpectrum
from ..spectral.water import Water
from .sea_spectrum import SeaSpectrum

Array = NDArray[np.float64]

_RADIAL_NODES = 512
_RING_NODES = 24
_ARC_NODES = 16


def capillary_limit(water: Water) -> float:
    """Wave number in rad/m of the slowest wave; without surface tension, that of clean water."""
    tension = water.surface_tension or constants.SURFACE_TENSION
    return float(np.sqrt(water.density * water.gravity / tension))


@remembered("slopes")
def total_slope_variance(parameters: OceanParameters) -> float:
    """Mean square slope of all gravity waves of a sea, dimensionless; 0 for a flat one."""
    sea = SeaSpectrum(parameters)
    others = _of_others(parameters, None)
    if not np.isfinite(sea.peak_frequency):
        return others
    limit = capillary_limit(parameters.water)
    lowest = 0.01 * min(sea.peak_wave_number, limit)  # below this, S underflows to 0
    return sum((_rings(layer, lowest, limit) for layer in sea.layers), others)


@remembered("unresolved slopes")
def unresolved_slope_variance(parameters: OceanParameters) -> float:
    """Mean square slope of the waves too short for the grid, dimensionless.

    The grid covers a square of wave vectors: its modes and half a cell around them. For waves without a
    spectrum, the difference between all waves of the layers and those on the grid. For a sea of patches, the
    waves too short for the last patch, or for the merged grid.
    """
    if parameters.merged_resolution:
        return unresolved_slope_variance(parameters.without_patches)
    if parameters.patches:
        *longer, last = patch_parameters(parameters)
        sharp = last.patches[0].shortest_wavelength
        whole = last.replace(patches=())
        # the end of the last band, if it lies below that of its grid
        if sharp > 2.0 * last.domain_size / last.resolution:
            limit = capillary_limit(last.water)
            rings = (_rings(layer, 2.0 * np.pi / sharp, limit) for layer in SeaSpectrum(whole).layers)
            return sum(rings, _missing_from_others(longer[0] if longer else last))
        return unresolved_slope_variance(whole)
    others = _missing_from_others(parameters)
    grid = WaveVectorGrid(parameters.resolution, parameters.domain_size)
    edge = (0.5 * parameters.resolution - 0.5) * grid.spacing
    limit = capillary_limit(parameters.water)
    if edge >= limit:
        return others
    corner = min(np.sqrt(2.0) * edge, limit)
    layers = SeaSpectrum(parameters).layers
    return sum((_sides(layer, edge, corner) + _rings(layer, corner, limit) for layer in layers), others)


def _missing_from_others(parameters: OceanParameters) -> float:
    return _of_others(parameters, None) - _of_others(parameters, parameters.resolution)


def _of_others(parameters: OceanParameters, resolution: int | None) -> float:
    """Mean square slope of waves without a spectrum: of all of them, or of those on a grid."""
    return sum((layer.slope_variance(parameters, resolution) for layer in parameters.active()), 0.0)


def _rings(layer: DirectionalSpectrum, lowest: float, highest: float) -> float:
    """∫k²S dω over full circles of wave vectors, between two wave numbers in rad/m."""
    if lowest >= highest:
        return 0.0
    step = np.log(highest / lowest) / _RADIAL_NODES
    k = lowest * np.exp(step * (np.arange(_RADIAL_NODES) + 0.5))
    omega = dispersion.angular_frequency(k, layer.dispersion, layer.water)
    rate = dispersion.group_velocity(k, layer.dispersion, layer.water)
    return float(np.sum(layer.frequency_spectrum(omega) * k**3 * rate) * step)


def _sides(layer: DirectionalSpectrum, edge: float, corner: float) -> float:
    """∬k²Ψ outside a square of wave vectors, up to the circle through its corners."""
    nodes, weights = np.polynomial.legendre.leggauss(_RING_NODES)
    # the arcs open as √(k - edge), so the integrand is smooth in the square root
    root = 0.5 * np.sqrt(corner - edge) * (nodes + 1.0)
    k = edge + root**2
    radial_weight = weights * 0.5 * np.sqrt(corner - edge) * 2.0 * root
    half_width = np.arccos(edge / k)
    arc, arc_weight = np.polynomial.legendre.leggauss(_ARC_NODES)
    middle = 0.5 * np.pi * np.arange(4)
    theta = middle[:, np.newaxis] + half_width[:, np.newaxis, np.newaxis] * arc
    kx, ky = (k[:, np.newaxis, np.newaxis] * part for part in (np.cos(theta), np.sin(theta)))
    along_arcs = np.sum(layer.density(kx, ky) * arc_weight, axis=(1, 2)) * half_width
    return float(np.sum(along_arcs * k**3 * radial_weight))
