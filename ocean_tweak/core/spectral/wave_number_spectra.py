# SPDX-License-Identifier: GPL-3.0-or-later
"""Chen's spectra over wave vectors, Ψ(k, θ) in m⁴, in deep water, in closed form.

k in rad/m, > 0; θ the angle to the wind in rad; both of any shape, broadcast against each other. They
equal S·D·(dω/dk)/k with S and D of `spectra` and `spreading` and ω² = g k (Chen 2014, eq. 28).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import constants, spectra

Array = NDArray[np.float64]


def phillips(k: ArrayLike, theta: ArrayLike, U: float, g: float = constants.GRAVITY) -> Array:
    """Phillips spectrum with U at 19.5 m: A/k⁴ exp(-g²/U⁴k²) cos²θ for waves along the wind.

    Chen (2014), eq. 4 with A = α/(πβ) = 3.48·10⁻³. Corrected: with this constant, waves against the wind
    (cos θ < 0) must be left out.

    Examples
    --------
    >>> float(round(phillips(0.05, 0.0, 20.0), 1))
    438.3
    """
    k = np.asarray(k, np.float64)
    A = constants.PM_ALPHA / (np.pi * constants.PM_BETA)
    return A / k**4 * np.exp(-(g**2) / (U**4 * k**2)) * np.maximum(np.cos(theta), 0.0) ** 2


def pierson_moskowitz(k: ArrayLike, theta: ArrayLike, U: float, g: float = constants.GRAVITY) -> Array:
    """Pierson-Moskowitz spectrum with U at 19.5 m and cos²(θ/2). Chen (2014), eq. 32.

    Examples
    --------
    >>> float(round(pierson_moskowitz(0.05, 0.0, 20.0), 1))
    172.6
    """
    k = np.asarray(k, np.float64)
    A = constants.PM_ALPHA / (2.0 * np.pi)
    return A / k**4 * np.exp(-constants.PM_BETA * g**2 / (U**4 * k**2)) * np.cos(0.5 * np.asarray(theta)) ** 2


def jonswap(
    k: ArrayLike,
    theta: ArrayLike,
    U: float,
    F: float,
    gamma: float = constants.PEAK_ENHANCEMENT,
    g: float = constants.GRAVITY,
) -> Array:
    """JONSWAP spectrum with U at 10 m and cos²(θ/2). Chen (2014), eq. 33.

    The peak frequency has the exponent -1/3, as in Hasselmann et al. (1973), where Chen prints -0.33.

    Examples
    --------
    >>> float(round(jonswap(0.05, 0.0, 20.0, 200e3), 1))
    238.8
    """
    k = np.asarray(k, np.float64)
    omega, omega_p = np.sqrt(g * k), spectra.jonswap_peak(U, F, g)
    sigma = np.where(omega <= omega_p, constants.JONSWAP_SIGMA_BELOW, constants.JONSWAP_SIGMA_ABOVE)
    r = np.exp(-((omega - omega_p) ** 2) / (2.0 * sigma**2 * omega_p**2))
    A = spectra.jonswap_alpha(U, F, g) / (2.0 * np.pi)
    fall = np.exp(-constants.DEVELOPMENT * omega_p**4 / (g * k) ** 2)
    return A / k**4 * fall * gamma**r * np.cos(0.5 * np.asarray(theta)) ** 2


def tessendorf_constant(domain_size: float) -> float:
    """The constant A in m² for which Tessendorf's amplitudes are correct on a domain of this size in m:
    ½ΔkxΔky A_Ψ.

    His Fourier coefficients omit the area of the spectral cell; a constant without it is correct for one
    domain size only. Chen (2014), eq. 25.

    Examples
    --------
    >>> round(tessendorf_constant(400.0) * 1e7, 2)
    4.3
    """
    A = constants.PM_ALPHA / (np.pi * constants.PM_BETA)
    return float(0.5 * (2.0 * np.pi / domain_size) ** 2 * A)
