# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds a wave layer for a given wave height and period."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

from ..data.errors import ParameterError
from ..spectral import constants, dispersion, spectra
from ..spectral.spectra import layer_scales, wind_at
from ..spectral.water import Water
from ..waves.spectral import WaveLayer

#: dimensionless fetch g F / U² below which JONSWAP's growth has not been measured
LEAST_DIMENSIONLESS_FETCH = 1.0
#: α of the steepest wind sea: JONSWAP's at that fetch
LARGEST_ALPHA = constants.JONSWAP_ALPHA * LEAST_DIMENSIONLESS_FETCH**-constants.JONSWAP_ALPHA_EXPONENT

#: iterations for the shortest period, and the relative change at which to stop
_TRIES, _NEAR = 20, 1e-3


class TooSteep(NamedTuple):
    """Describes a sea state steeper than any wind sea, with the two nearest possible ones.

    steepness, limit : Hs divided by the peak wavelength, and its maximum at the same period
    height : m, the maximum at the same period
    period : s, the minimum at the same height; infinite if none is long enough
    """

    steepness: float
    limit: float
    height: float
    period: float


class Match(NamedTuple):
    """A layer with the given sea state, and whether a wind over a fetch can produce it.

    layer : defined by WIND if such a wind exists, else by SEA_STATE
    from_wind : whether it is defined by WIND
    explanation : one sentence for the artist
    """

    layer: WaveLayer
    from_wind: bool
    explanation: str


def layer_for_sea_state(
    significant_wave_height: float,
    peak_period: float,
    water: Water | None = None,
    template: WaveLayer | None = None,
) -> Match:
    """A layer with a significant wave height in m and a peak period in s, in this water.

    JONSWAP's α and ω_p (Horvath 2015, eq. 28) give the dimensionless fetch X = (α/0.076)^(-1/0.22), then U =
    22 g X^(-1/3) / ω_p and F = X U²/g. If this wind or fetch is out of range or beyond full development, the
    layer is defined by its sea state instead; such seas are mostly swell.

    template : provides all other settings, including the spectrum; TMA by default

    Raises ParameterError for a height or period out of range.

    Examples
    --------
    >>> match = layer_for_sea_state(significant_wave_height=3.0, peak_period=7.0)
    >>> print(match.explanation)
    Hs 3 m with Tp 7 s is made by a wind of 15.5 m/s over 91.5 km
    """
    water = water or Water()
    template = template or WaveLayer()
    swell = replace(
        template,
        definition="SEA_STATE",
        significant_wave_height=significant_wave_height,
        peak_period=peak_period,
    )
    wanted = f"Hs {swell.significant_wave_height:g} m with Tp {swell.peak_period:g} s"
    if template.spectrum not in ("TMA", "JONSWAP"):
        return Match(
            swell,
            False,
            f"{wanted} is set directly: the spectrum {template.spectrum} has no fetch to solve for",
        )
    if swell.significant_wave_height == 0.0:
        return Match(swell, False, f"{wanted} is a flat sea, set directly")
    scales = layer_scales(swell, water)
    X = (scales.alpha / constants.JONSWAP_ALPHA) ** (-1.0 / constants.JONSWAP_ALPHA_EXPONENT)
    U = constants.JONSWAP_PEAK * water.gravity * X ** (-1.0 / 3.0) / scales.peak_frequency
    F = X * U**2 / water.gravity
    if spectra.full_development_fetch(U, water.gravity) < F:
        return Match(swell, False, f"{wanted} is flatter than any wind sea: set directly, as swell")
    if too_steep(swell, water) is not None:
        return Match(swell, False, f"{wanted} is steeper than any wind sea: set directly")
    try:
        wind = replace(template, definition="WIND", wind_speed=wind_at(U, template.wind_height), fetch=F)
    except ParameterError as error:
        return Match(swell, False, f"{wanted} is set directly: {error}")
    return Match(wind, True, f"{wanted} is made by a wind of {U:.3g} m/s over {F / 1e3:.3g} km")


def too_steep(layer: WaveLayer, water: Water) -> TooSteep | None:
    """Why a layer's sea state is too steep, and what would be possible; None if a wind can produce it.

    Energy is proportional to α and Hs to √α; in deep water α is proportional to Hs² / Tp⁴, elsewhere nearly
    so.
    """
    if layer.definition != "SEA_STATE" or layer.significant_wave_height == 0.0:
        return None
    excess = math.sqrt(layer_scales(layer, water).alpha / LARGEST_ALPHA)
    if excess <= 1.0:
        return None
    k = dispersion.wave_number(2.0 * math.pi / layer.peak_period, "FINITE_DEPTH", water)
    steepness = layer.significant_wave_height * float(k) / (2.0 * math.pi)
    height = layer.significant_wave_height / excess
    return TooSteep(steepness, steepness / excess, height, _least_period(layer, water))


def _least_period(layer: WaveLayer, water: Water) -> float:
    longest = WaveLayer.__dataclass_fields__["peak_period"].metadata["maximum"]
    period = layer.peak_period
    for _ in range(_TRIES):
        alpha = layer_scales(replace(layer, peak_period=period), water).alpha
        longer = period * (alpha / LARGEST_ALPHA) ** 0.25
        if longer > longest:
            return math.inf
        if abs(longer / period - 1.0) < _NEAR:
            break
        period = longer
    return longer
