# SPDX-License-Identifier: GPL-3.0-or-later
"""A wave layer for a wanted wave height and period."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

from ..data.errors import ParameterError
from ..spectral import constants, dispersion, spectra
from ..spectral.spectra import layer_scales, wind_at
from ..spectral.water import Water
from ..waves.spectral import WaveLayer

#: below this dimensionless fetch g F / U² nobody has measured JONSWAP's growth
LEAST_DIMENSIONLESS_FETCH = 1.0
#: α of the steepest sea that a wind raises: JONSWAP's at that fetch
LARGEST_ALPHA = constants.JONSWAP_ALPHA * LEAST_DIMENSIONLESS_FETCH**-constants.JONSWAP_ALPHA_EXPONENT

#: steps towards the least period, and the change of one that is none
_TRIES, _NEAR = 20, 1e-3


class TooSteep(NamedTuple):
    """A sea state that is steeper than any wind sea, and the two nearest that are not.

    steepness, limit : Hs over the wavelength at the peak, and the most that this can be at the same period
    height : m, the most at the same period
    period : s, the least at the same height; infinite where none is long enough
    """

    steepness: float
    limit: float
    height: float
    period: float


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
    """What is wrong with a layer's sea state, and what would be possible; None where a wind can raise it.

    Energy is in proportion to α, so Hs is to √α; in deep water α is to Hs² / Tp⁴, elsewhere nearly so.
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
