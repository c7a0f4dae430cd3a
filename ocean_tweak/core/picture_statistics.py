# SPDX-License-Identifier: GPL-3.0-or-later
"""Sums that describe a sea in which pictures move beside the wave layers."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import dispersion
from .grid import WaveVectorGrid
from .initial_state import InitialState
from .parameters import OceanParameters
from .waves.image.animation import angular_frequency, runs_along
from .waves.image.filters import peak_frequency
from .waves.image.parameters import PictureLayer
from .waves.image.state import filtered, wanted_variance

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]


class Modes(NamedTuple):
    """Energies of modes and how fast they turn.

    grid : which they are
    along, against : (N, N//2+1) m², of waves along k and against it
    omega : (N, N//2+1) rad/s
    """

    grid: WaveVectorGrid
    along: RealArray
    against: RealArray
    omega: Array


def modes_of(state: InitialState, expected: bool) -> list[Modes]:
    """Energies of all of a sea's states: expected over all seeds, or of this seed."""
    return [
        Modes(part.grid, part.expected_plus, part.expected_minus, part.omega)
        if expected
        else Modes(part.grid, np.abs(part.h_plus) ** 2, np.abs(part.h_minus) ** 2, part.omega)
        for part in state.parts
    ]


def picture_modes(parameters: OceanParameters, layer: PictureLayer) -> Modes:
    """All that a picture holds, whether the sea's grid resolves it or not, and without the loop."""
    relation, water = parameters.dispersion, parameters.water
    made = filtered(layer, parameters.domain_size, None, relation, water, parameters.seed)
    energy = made.expected
    if layer.is_physical and made.m0 > 0.0:
        # a picture or patch that is too small for some of the wind's waves does not make them any less
        energy = energy * (wanted_variance(layer, water) / made.m0)
    along = runs_along(layer, made.grid)
    omega = angular_frequency(layer, made.grid, relation, water)
    return Modes(made.grid, np.where(along, energy, 0.0), np.where(along, 0.0, energy), omega)


def longest_random_wave(parameters: OceanParameters, of_layers: float) -> float:
    """Wavelength in m of the longest peak among what differs in height from seed to seed.

    of_layers : the wave layers' peak wavelength in m; NaN for none

    Noise through the physical filter does. All other pictures have the height that they are given.
    """
    peaks = [of_layers]
    for layer in parameters.active_pictures:
        if layer.picture is None and layer.is_physical and wanted_variance(layer, parameters.water) > 0.0:
            omega_m = 2.0 * np.pi * peak_frequency(layer.wind_speed, parameters.water.gravity)
            k = dispersion.wave_number(omega_m, parameters.dispersion, parameters.water)
            peaks.append(float(2.0 * np.pi / k))
    found = [peak for peak in peaks if np.isfinite(peak)]
    return max(found) if found else float("nan")


def unlooped(parameters: OceanParameters, grid: WaveVectorGrid) -> Iterable[Array]:
    """ω in rad/s of each of a sea's states as it would be without a loop, in the order of its parts."""
    yield dispersion.angular_frequency(grid.k, parameters.dispersion, parameters.water)
    for layer in parameters.active_pictures:
        if layer.animation != "DISPERSION":
            yield angular_frequency(layer, grid, parameters.dispersion, parameters.water)
