# SPDX-License-Identifier: GPL-3.0-or-later
"""Non-directional wave spectra S(ω) in m²·s/rad over the angular frequency ω in rad/s.

Symbols as in Horvath (2015): U wind speed at 10 m in m/s, F fetch in m, h depth in m, g in m/s².
All functions take arrays of any shape and return float64 arrays of that shape.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import constants, dispersion
from .parameters import Water

Array = NDArray[np.float64]


def full_development_fetch(U: float, g: float = constants.GRAVITY) -> float:
    """Fetch in m beyond which a sea grows no more: where JONSWAP's peak frequency (eq. 28) falls to
    Pierson and Moskowitz's (eq. 19 of Horvath 2015), g F / U² ≈ 17 036."""
    return (constants.JONSWAP_PEAK / constants.PM_PEAK) ** 3 * U**2 / g


def jonswap_alpha(U: float, F: float, g: float = constants.GRAVITY) -> float:
    """α of JONSWAP, dimensionless. Horvath (2015), eq. 28."""
    return constants.JONSWAP_ALPHA * (U**2 / (F * g)) ** constants.JONSWAP_ALPHA_EXPONENT


def jonswap_peak(U: float, F: float, g: float = constants.GRAVITY) -> float:
    """ω_p of JONSWAP in rad/s. Horvath (2015), eq. 28, corrected: the cube root is missing in print."""
    return constants.JONSWAP_PEAK * (g**2 / (U * F)) ** (1.0 / 3.0)


def jonswap(
    omega: ArrayLike,
    alpha: float,
    omega_p: float,
    gamma: float = constants.PEAK_ENHANCEMENT,
    g: float = constants.GRAVITY,
) -> Array:
    """JONSWAP spectrum, m²·s/rad; 0 at ω = 0. Horvath (2015), eq. 28, corrected: γ^r, not γ⁴."""
    omega = np.asarray(omega, np.float64)
    # ω⁻⁵ exp(-5/4 (ω_p/ω)⁴) is zero in double precision below 0.2 ω_p: the floor keeps it finite
    w = np.maximum(omega, 0.1 * omega_p)
    sigma = np.where(w <= omega_p, constants.JONSWAP_SIGMA_BELOW, constants.JONSWAP_SIGMA_ABOVE)
    r = np.exp(-0.5 * ((w - omega_p) / (sigma * omega_p)) ** 2)
    return alpha * g**2 / w**5 * np.exp(-1.25 * (omega_p / w) ** 4) * gamma**r


def kitaigorodskii(omega_h: ArrayLike) -> Array:
    """Kitaigorodskii's depth factor Φ in 0…1 over ω_h = ω√(h/g).

    Horvath (2015), eq. 29, in closed form: tanh²(kh) / (1 + 2kh / sinh 2kh) with ω² = g k tanh kh.
    """
    unit = Water(depth=1.0, gravity=1.0)
    kh = dispersion.wave_number(omega_h, "FINITE_DEPTH", unit)
    x = np.clip(2.0 * kh, 1e-12, 700.0)
    return np.tanh(kh) ** 2 / (1.0 + x / np.sinh(x))


def tma(
    omega: ArrayLike,
    alpha: float,
    omega_p: float,
    water: Water,
    gamma: float = constants.PEAK_ENHANCEMENT,
) -> Array:
    """TMA spectrum, m²·s/rad: JONSWAP times the depth factor. Horvath (2015), eq. 30."""
    omega = np.asarray(omega, np.float64)
    omega_h = omega * np.sqrt(water.depth / water.gravity)
    return jonswap(omega, alpha, omega_p, gamma, water.gravity) * kitaigorodskii(omega_h)
