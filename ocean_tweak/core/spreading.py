# SPDX-License-Identifier: GPL-3.0-or-later
"""Directional spreading D(ω, θ) in 1/rad: how the energy at a frequency is shared among directions.

θ is the angle in rad between a wave and its wind, in (-π, π]. Every model is evaluated as
D = Q · base · swell, with Q from a table over ω/ω_p so that ∫D dθ = 1.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import constants

Array = NDArray[np.float64]

#: ω/ω_p at which normalisations are tabulated; outside, the shape at the nearer end holds
_TABLE_FROM, _TABLE_TO, _TABLE_SIZE = 0.03, 300.0, 6144

#: ω/ω_p at which the shape of a model jumps
_BREAKS = (constants.DONELAN_MIDDLE_FROM, constants.BANNER_FROM)


def wrap_angle(theta: ArrayLike) -> Array:
    """The same direction in [-π, π)."""
    return (np.asarray(theta, np.float64) + np.pi) % (2.0 * np.pi) - np.pi


def donelan_banner_beta(ratio: ArrayLike) -> Array:
    """β_s of Donelan-Banner over ω/ω_p. Horvath (2015), eq. 38; the first branch holds down to ω = 0."""
    x = np.asarray(ratio, np.float64)
    below = constants.DONELAN_BELOW * x**constants.DONELAN_EXPONENT
    x1 = np.maximum(x, 1e-6)
    middle = constants.DONELAN_MIDDLE * x1**-constants.DONELAN_EXPONENT
    epsilon = constants.BANNER_OFFSET + constants.BANNER_FACTOR * x1 ** (2.0 * constants.BANNER_EXPONENT)
    return np.where(
        x < constants.DONELAN_MIDDLE_FROM, below, np.where(x < constants.BANNER_FROM, middle, 10.0**epsilon)
    )


def log_donelan_banner(theta: Array, ratio: Array) -> Array:
    """ln sech²(β_s θ), not normalised. Horvath (2015), eq. 38."""
    x = np.abs(donelan_banner_beta(ratio) * theta)
    return -2.0 * (x + np.log1p(np.exp(-2.0 * x)) - np.log(2.0))


def swell_shape(ratio: ArrayLike, swell: float) -> Array:
    """s_ξ of the swell factor over ω/ω_p. Horvath (2015), eq. 45."""
    return constants.SWELL_SHAPE * np.tanh(1.0 / np.maximum(np.asarray(ratio, np.float64), 1e-6)) * swell**2


def log_cosine_power(theta: Array, s: Array) -> Array:
    """ln |cos(θ/2)|^2s, not normalised. Longuet-Higgins form, Horvath (2015), eq. 33 and 44."""
    return 2.0 * s * np.log(np.maximum(np.abs(np.cos(0.5 * theta)), 1e-150))


BASE_MODELS = {"DONELAN_BANNER": log_donelan_banner}


def _log_density(theta: Array, ratio: Array, model: str, swell: float) -> Array:
    """ln (D_base D_ξ) up to a factor of ω. Horvath (2015), eq. 42."""
    result = BASE_MODELS[model](theta, ratio)
    if swell > 0.0:
        result = result + log_cosine_power(theta, swell_shape(ratio, swell))
    return result


@lru_cache(maxsize=1)
def _half_circle_rule() -> tuple[Array, Array]:
    """Nodes and weights on [0, π], in panels that halve towards 0, where narrow peaks stand, and towards π,
    where a small power of cos(θ/2) falls steeply."""
    towards_zero = np.pi * 2.0 ** np.arange(-10.0, 0.0)
    towards_pi = np.pi * (1.0 - 2.0 ** np.arange(-2.0, -25.0, -1.0))
    edges = np.concatenate(([0.0], towards_zero, towards_pi, [np.pi]))
    x, w = np.polynomial.legendre.leggauss(16)
    width = np.diff(edges)[:, np.newaxis]
    return (edges[:-1, np.newaxis] + 0.5 * width * (x + 1.0)).ravel(), (0.5 * width * w).ravel()


@lru_cache(maxsize=32)
def _normalisation_table(model: str, swell: float) -> tuple[Array, Array]:
    """ω/ω_p and ln Q(ω), Q = 1/∫D_base D_ξ dθ. Horvath (2015), eq. 43."""
    theta, weight = _half_circle_rule()
    # a node on either side of each jump: nothing is interpolated across it
    even = np.geomspace(_TABLE_FROM, _TABLE_TO, _TABLE_SIZE)
    ratio = np.sort(np.concatenate((even, _BREAKS, np.nextafter(_BREAKS, 0.0))))
    density = np.exp(_log_density(theta, ratio[:, np.newaxis], model, swell))
    return ratio, -np.log(2.0 * density @ weight)


def spreading(omega_ratio: ArrayLike, theta: ArrayLike, model: str, swell: float = 0.0) -> Array:
    """D(ω, θ) in 1/rad, normalised for every ω. Horvath (2015), eq. 42.

    omega_ratio : ω/ω_p, > 0, broadcast against theta
    theta : angle to the wind in rad, any value (it is wrapped: sech² is not periodic)
    """
    ratio = np.clip(np.asarray(omega_ratio, np.float64), _TABLE_FROM, _TABLE_TO)
    log_q = np.interp(ratio, *_normalisation_table(model, swell))
    return np.exp(_log_density(wrap_angle(theta), ratio, model, swell) + log_q)
