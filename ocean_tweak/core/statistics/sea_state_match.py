# SPDX-License-Identifier: GPL-3.0-or-later
"""A wave layer for a wanted wave height and period."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from ..data.errors import ParameterError
from ..spectral import constants, spectra
from ..spectral.spectra import layer_scales, wind_at
from ..spectral.water import Water
from ..waves.spectral import WaveLayer

#: below this dimensionless fetch g F / U² nobody has measured JONSWAP's growth
LEAST_DIMENSIONLESS_FETCH = 1.0


class Match(NamedTuple):
    """A layer with the wanted sea state, and whether a wind over a fetch makes it.

    layer : defined by WIND where such a wind exists, else by SEA_STATE
    from_wind : which of the two
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

    JONSWAP's α and ω_p (Horvath 2015, eq. 28) give the dimensionless fetch X = (α/0.076)^(-1/0.22), then
    U = 22 g X^(-1/3) / ω_p and F = X U²/g. Where this wind or fetch is beyond what is allowed or beyond
    full development, the layer is defined by its sea state instead: swell, mostly.

    template : gives everything else, its spectrum included; TMA by default

    Raises ParameterError for a height or period out of range.
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
        return Match(swell, False, f"{wanted} is set directly: {template.spectrum} has no fetch to solve for")
    if swell.significant_wave_height == 0.0:
        return Match(swell, False, f"{wanted} is a flat sea, set directly")
    scales = layer_scales(swell, water)
    X = (scales.alpha / constants.JONSWAP_ALPHA) ** (-1.0 / constants.JONSWAP_ALPHA_EXPONENT)
    U = constants.JONSWAP_PEAK * water.gravity * X ** (-1.0 / 3.0) / scales.peak_frequency
    F = X * U**2 / water.gravity
    if spectra.full_development_fetch(U, water.gravity) < F:
        return Match(swell, False, f"{wanted} is flatter than any wind sea: set directly, as swell")
    if X < LEAST_DIMENSIONLESS_FETCH:
        return Match(swell, False, f"{wanted} is steeper than any wind sea: set directly")
    try:
        wind = replace(template, definition="WIND", wind_speed=wind_at(U, template.wind_height), fetch=F)
    except ParameterError as error:
        return Match(swell, False, f"{wanted} is set directly: {error}")
    return Match(wind, True, f"{wanted} is made by a wind of {U:.3g} m/s over {F / 1e3:.3g} km")
