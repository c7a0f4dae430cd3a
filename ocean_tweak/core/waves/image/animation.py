# SPDX-License-Identifier: GPL-3.0-or-later
"""Angular frequencies of an image's waves: the three animations of Mastin et al. (1987)."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...numerics.grid import WaveVectorGrid
from ...spectral import constants, dispersion
from ...spectral.water import Water
from .filters import POWERS, peak_frequency, pierson_moskowitz

if TYPE_CHECKING:
    from .parameters import ImageLayer

Array = NDArray[np.float64]


def runs_along(layer: ImageLayer, grid: WaveVectorGrid) -> NDArray[np.bool_]:
    """(N, N//2+1): whether the wave with the wind travels along +k, not along -k.

    For waves at right angles to the wind one direction is chosen, consistently for k and -k.
    """
    towards = grid.kx * math.cos(layer.wind_direction) + grid.ky * math.sin(layer.wind_direction)
    return (towards > 0.0) | ((towards == 0.0) & ((grid.kx > 0.0) | (grid.ky > 0.0)))


def dominant_band(layer: ImageLayer, grid: WaveVectorGrid, relation: str, water: Water) -> NDArray[np.bool_]:
    """(N, N//2+1): modes for which the filter keeps more than two thirds of its maximum.

    For the modified Pierson-Moskowitz filter this applies to the frequency spectrum of eq. 1, and in a calm
    to no mode; a fractal has its maximum at the longest wave of the patch.
    """
    if layer.filter == "MODIFIED_PIERSON_MOSKOWITZ":
        f = dispersion.angular_frequency(grid.k, relation, water) / (2.0 * np.pi)
        U, g = layer.wind_speed, water.gravity
        peak = peak_frequency(U, g)
        if math.isinf(peak):
            return np.zeros(grid.shape, bool)
        power = pierson_moskowitz(f, U, g) / pierson_moskowitz(peak, U, g)
    else:
        power = POWERS[layer.filter](layer, grid, relation, water)
    return power >= constants.DOMINANT_SHARE


def _dispersion(layer: ImageLayer, grid: WaveVectorGrid, relation: str, water: Water) -> Array:
    """Each wave at its own speed, from a dispersion relation; the paper uses that of deep water (eq. 10)."""
    return dispersion.angular_frequency(grid.k, relation, water)


def _dominant_band(layer: ImageLayer, grid: WaveVectorGrid, relation: str, water: Water) -> Array:
    """One rate for the dominant waves and another for all others."""
    band = dominant_band(layer, grid, relation, water)
    return np.where(band, layer.dominant_rate, layer.surrounding_rate)


def _translation(layer: ImageLayer, grid: WaveVectorGrid, relation: str, water: Water) -> Array:
    """abs(k·v) for the velocity v along the wind: the image moves without changing (eq. 9)."""
    vx, vy = (layer.translation_speed * part(layer.wind_direction) for part in (math.cos, math.sin))
    return np.abs(grid.kx * vx + grid.ky * vy)


RATES: dict[str, Callable[[ImageLayer, WaveVectorGrid, str, Water], Array]] = {
    "DISPERSION": _dispersion,
    "DOMINANT_BAND": _dominant_band,
    "TRANSLATION": _translation,
}


def angular_frequency(
    layer: ImageLayer,
    grid: WaveVectorGrid,
    relation: str,
    water: Water,
    loop_duration: Fraction | None = None,
) -> Array:
    """ω(k) ≥ 0 in rad/s, (N, N//2+1), the same for k and -k.

    In a loop of duration T, the nearest multiple of 2π/T, at least one for waves that move. Those of a
    translation are multiples already, as others are refused by the parameters.
    """
    omega = RATES[layer.animation](layer, grid, relation, water)
    if loop_duration is None:
        return omega
    fundamental = 2.0 * np.pi / float(loop_duration)
    turns = np.rint(omega / fundamental)
    if layer.animation != "TRANSLATION":
        turns = np.where(omega > 0.0, np.maximum(1.0, turns), 0.0)
    return fundamental * turns
