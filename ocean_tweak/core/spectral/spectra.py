# SPDX-License-Identifier: GPL-3.0-or-later
"""Non-directional wave spectra S(ω) in m²·s/rad over the angular frequency ω in rad/s.

Symbols as in Horvath (2015): U wind speed in m/s (at 10 m unless said otherwise), F fetch in m, h depth
in m, g in m/s². Functions of ω take arrays of any shape and return float64 arrays of that shape, with
S(0) = 0. In a calm, U = 0 or F = 0, peaks are at infinity and S is 0 at every frequency, as it is in the
limit.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import constants, dispersion
from .water import Water

Array = NDArray[np.float64]


def _over(a: float, b: float) -> float:
    """a/b for b ≥ 0; endless where b is 0: a calm's waves have no length, so their frequency has no end."""
    return a / b if b > 0.0 else math.inf


def _fourth(omega: float) -> float:
    """ω⁴; endless where no float holds it."""
    return omega**4 if omega < 1e77 else math.inf


def generalized_ab(omega: ArrayLike, A: float, B: float) -> Array:
    """S = A/ω⁵ exp(-B/ω⁴), A in m²/s⁴ and B in 1/s⁴. Horvath (2015), eq. 20."""
    omega = np.asarray(omega, np.float64)
    if not math.isfinite(A * B):  # the peak lies beyond all waves
        return np.zeros_like(omega)
    # the exponential is zero in double precision where B/ω⁴ > 745: the floor keeps the quotient finite
    w = np.maximum(omega, (B / 1e4) ** 0.25)
    return A / w**5 * np.exp(-B / w**4)


def pierson_moskowitz_peak(U: float, g: float = constants.GRAVITY) -> float:
    """ω_p in rad/s of the Pierson-Moskowitz spectrum, 0.855 g/U. Horvath (2015), eq. 19, as it follows from
    the factor 0.74 of eq. 18."""
    factor = (constants.PM_BETA / constants.DEVELOPMENT) ** 0.25
    return _over(factor * g, constants.PM_WIND_FACTOR * U)


def phillips_peak(U: float, g: float = constants.GRAVITY) -> float:
    """ω_p in rad/s of the Phillips (Tessendorf) spectrum: (4B/5)^¼ with B = (g/U)⁴, U at 19.5 m.

    Horvath (2015), eq. 27.
    """
    return _over(constants.DEVELOPMENT**-0.25 * g, constants.PM_WIND_FACTOR * U)


def full_development_fetch(U: float, g: float = constants.GRAVITY) -> float:
    """Fetch in m beyond which a sea grows no more: where JONSWAP's peak frequency (eq. 28) falls to
    Pierson and Moskowitz's (eq. 19 of Horvath 2015), g F / U² ≈ 17 036."""
    return (constants.JONSWAP_PEAK / constants.PM_PEAK) ** 3 * U**2 / g


def jonswap_alpha(U: float, F: float, g: float = constants.GRAVITY) -> float:
    """α of JONSWAP, dimensionless. Horvath (2015), eq. 28."""
    return constants.JONSWAP_ALPHA * _over(U**2, F * g) ** constants.JONSWAP_ALPHA_EXPONENT


def jonswap_peak(U: float, F: float, g: float = constants.GRAVITY) -> float:
    """ω_p of JONSWAP in rad/s. Horvath (2015), eq. 28, corrected: the cube root is missing in print."""
    return constants.JONSWAP_PEAK * _over(g**2, U * F) ** (1.0 / 3.0)


def jonswap(
    omega: ArrayLike,
    alpha: float,
    omega_p: float,
    gamma: float = constants.PEAK_ENHANCEMENT,
    g: float = constants.GRAVITY,
) -> Array:
    """JONSWAP spectrum: α g²/ω⁵ exp(-5/4 (ω_p/ω)⁴) γ^r.

    Horvath (2015), eq. 28, corrected: γ^r, where the paper prints γ⁴. With γ = 1 it is the generalised
    A,B spectrum of eq. 20.
    """
    base = generalized_ab(omega, alpha * g**2, constants.DEVELOPMENT * _fourth(omega_p))
    if gamma == 1.0 or math.isinf(omega_p):
        return base
    w = np.asarray(omega, np.float64)
    sigma = np.where(w <= omega_p, constants.JONSWAP_SIGMA_BELOW, constants.JONSWAP_SIGMA_ABOVE)
    r = np.exp(-0.5 * ((w - omega_p) / (sigma * omega_p)) ** 2)
    return base * gamma**r


def kitaigorodskii(omega_h: ArrayLike) -> Array:
    """Kitaigorodskii's depth factor Φ in 0…1 over ω_h = ω√(h/g).

    Horvath (2015), eq. 29, in closed form: tanh²(kh) / (1 + 2kh / sinh 2kh) with ω² = g k tanh kh.
    """
    unit = Water(depth=1.0, gravity=1.0)
    kh = dispersion.wave_number(omega_h, "FINITE_DEPTH", unit)
    x = np.clip(2.0 * kh, 1e-12, 700.0)
    return np.tanh(kh) ** 2 / (1.0 + x / np.sinh(x))


def thompson_vincent(omega_h: ArrayLike) -> Array:
    """Thompson and Vincent's (1983) approximation of Kitaigorodskii's factor, within 0.023 of it.

    Horvath (2015), after eq. 29, completed: 1 for ω_h ≥ 2, where the printed branch turns down.
    """
    w = np.clip(np.asarray(omega_h, np.float64), 0.0, 2.0)
    return np.where(w <= 1.0, 0.5 * w**2, 1.0 - 0.5 * (2.0 - w) ** 2)


DEPTH_FACTORS: dict[str, Callable[[ArrayLike], Array]] = {
    "KITAIGORODSKII": kitaigorodskii,
    "THOMPSON_VINCENT": thompson_vincent,
}


def tma(
    omega: ArrayLike,
    alpha: float,
    omega_p: float,
    water: Water,
    gamma: float = constants.PEAK_ENHANCEMENT,
    depth_factor: str = "KITAIGORODSKII",
) -> Array:
    """TMA spectrum: JONSWAP times the depth factor. Horvath (2015), eq. 30."""
    omega = np.asarray(omega, np.float64)
    factor = DEPTH_FACTORS[depth_factor](omega * np.sqrt(water.depth / water.gravity))
    return jonswap(omega, alpha, omega_p, gamma, water.gravity) * factor
