# SPDX-License-Identifier: GPL-3.0-or-later
"""Heights, periods and lengths of the waves that a picture holds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...numerics.memo import remembered
from ...spectral import dispersion
from ...spectral.sea_state import Modes, SeaState, modes_state
from ...spectral.water import Water
from .animation import angular_frequency, runs_along
from .filters import peak_frequency
from .state import filtered, wanted_variance

if TYPE_CHECKING:
    from ...parameters.ocean_parameters import OceanParameters
    from .parameters import PictureLayer


@remembered("states of pictures")
def state_of(sea: OceanParameters, layer: PictureLayer) -> SeaState:
    """State of all that a picture holds: it takes long, and is asked for often.

    sea : what of a sea acts on it, and no more
    """
    return modes_state([_modes(sea, layer)], sea)


def _modes(sea: OceanParameters, layer: PictureLayer) -> Modes:
    """All that a picture holds, whether the sea's grid resolves it or not, and without the loop."""
    relation, water = sea.dispersion, sea.water
    made = filtered(layer, sea.domain_size, None, relation, water, sea.seed)
    energy = made.expected
    if layer.is_physical and made.m0 > 0.0:
        # a picture or patch that is too small for some of the wind's waves does not make them any less
        energy = energy * (wanted_variance(layer, water) / made.m0)
    along = runs_along(layer, made.grid)
    omega = angular_frequency(layer, made.grid, relation, water)
    return Modes(made.grid, np.where(along, energy, 0.0), np.where(along, 0.0, energy), omega)


def peak_wavelength(layer: PictureLayer, relation: str, water: Water) -> float:
    """Wavelength in m at the peak of the modified Pierson-Moskowitz filter."""
    omega_m = 2.0 * np.pi * peak_frequency(layer.wind_speed, water.gravity)
    return float(2.0 * np.pi / dispersion.wave_number(omega_m, relation, water))
