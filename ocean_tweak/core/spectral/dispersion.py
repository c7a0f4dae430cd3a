# SPDX-License-Identifier: GPL-3.0-or-later
"""Dispersion: how the angular frequency ω of a wave depends on its wave number k.

Symbols as in Horvath (2015): k rad/m, ω rad/s, depth h m, gravity g m/s², surface tension σ N/m,
density ρ kg/m³. All functions take arrays of any shape and return float64 arrays of that shape.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .water import Water

Array = NDArray[np.float64]


class Dispersion(NamedTuple):
    """A dispersion relation and its derivative, both functions of (k, water)."""

    angular_frequency: Callable[[ArrayLike, Water], Array]
    derivative: Callable[[ArrayLike, Water], Array]


def _sech2(x: Array) -> Array:
    """sech²(x) for x ≥ 0 without overflow."""
    e = np.exp(-2.0 * x)
    return 4.0 * e / (1.0 + e) ** 2


def deep(k: ArrayLike, water: Water) -> Array:
    """ω = √(g k), deep water. Horvath (2015), eq. 7.

    Examples
    --------
    >>> deep([0.1, 1.0], Water()).round(3)
    array([0.99 , 3.132])
    """
    return np.sqrt(water.gravity * np.asarray(k, np.float64))


def deep_derivative(k: ArrayLike, water: Water) -> Array:
    """dω/dk = g / 2ω, m/s, for k > 0. Horvath (2015), eq. 23.

    Examples
    --------
    >>> deep_derivative([0.1, 1.0], Water()).round(3)
    array([4.952, 1.566])
    """
    return 0.5 * water.gravity / deep(k, water)


def finite_depth(k: ArrayLike, water: Water) -> Array:
    """ω = √(g k tanh kh). Horvath (2015), eq. 8.

    Examples
    --------
    >>> finite_depth([0.1, 1.0], Water(depth=5.0)).round(3)
    array([0.673, 3.132])
    """
    k = np.asarray(k, np.float64)
    return np.sqrt(water.gravity * k * np.tanh(k * water.depth))


def finite_depth_derivative(k: ArrayLike, water: Water) -> Array:
    """dω/dk of eq. 8, m/s, for k > 0: eq. 62 of Horvath (2015) without surface tension, corrected.

    Examples
    --------
    >>> finite_depth_derivative([0.1, 1.0], Water(depth=5.0)).round(3)
    array([6.231, 1.567])
    """
    k = np.asarray(k, np.float64)
    g, h = water.gravity, water.depth
    numerator = h * g * k * _sech2(k * h) + g * np.tanh(k * h)
    return numerator / (2.0 * finite_depth(k, water))


def capillary(k: ArrayLike, water: Water) -> Array:
    """ω = √((g k + σk³/ρ) tanh kh). Horvath (2015), eq. 9.

    Examples
    --------
    >>> capillary([1.0, 370.0], Water()).round(2)
    array([ 3.13, 85.9 ])
    """
    k = np.asarray(k, np.float64)
    tension = water.surface_tension / water.density
    return np.sqrt((water.gravity * k + tension * k**3) * np.tanh(k * water.depth))


def capillary_derivative(k: ArrayLike, water: Water) -> Array:
    """dω/dk of eq. 9, m/s, for k > 0. Horvath (2015), eq. 62, corrected: the second term of the
    numerator is (g + 3σk²/ρ) tanh kh, where the paper prints ω².

    Examples
    --------
    >>> capillary_derivative([1.0, 370.0], Water()).round(3)
    array([1.566, 0.234])
    """
    k = np.asarray(k, np.float64)
    g, h, tension = water.gravity, water.depth, water.surface_tension / water.density
    numerator = h * (tension * k**3 + g * k) * _sech2(k * h) + (g + 3.0 * tension * k**2) * np.tanh(k * h)
    return numerator / (2.0 * capillary(k, water))


RELATIONS: dict[str, Dispersion] = {
    "CAPILLARY": Dispersion(capillary, capillary_derivative),
    "FINITE_DEPTH": Dispersion(finite_depth, finite_depth_derivative),
    "DEEP": Dispersion(deep, deep_derivative),
}


def angular_frequency(k: ArrayLike, dispersion: str, water: Water) -> Array:
    """ω(k) in rad/s for one of the names in `RELATIONS`; 0 at k = 0.

    Examples
    --------
    >>> angular_frequency([0.1, 1.0], "FINITE_DEPTH", Water(depth=5.0)).round(3)
    array([0.673, 3.132])
    """
    return RELATIONS[dispersion].angular_frequency(k, water)


def group_velocity(k: ArrayLike, dispersion: str, water: Water) -> Array:
    """dω/dk in m/s for k > 0.

    Examples
    --------
    >>> group_velocity([0.1, 1.0], "DEEP", Water()).round(3)
    array([4.952, 1.566])
    """
    return RELATIONS[dispersion].derivative(k, water)


def wave_number(omega: ArrayLike, dispersion: str, water: Water) -> Array:
    """k(ω) in rad/m: the inverse of `angular_frequency`, to rounding, by Newton's method in ln k.

    Examples
    --------
    >>> wave_number([0.5, 1.0], "FINITE_DEPTH", Water(depth=10.0)).round(4)
    array([0.0527, 0.1216])
    """
    relation = RELATIONS[dispersion]
    omega = np.asarray(omega, np.float64)
    positive = omega > 0.0
    target = np.log(np.where(positive, omega, 1.0))
    w = np.exp(target)
    # start at the larger of the limits for deep and for shallow water; ln ω(ln k) has a slope of ½ to 2
    log_k = np.log(np.maximum(w * w / water.gravity, w / np.sqrt(water.gravity * water.depth)))
    for _ in range(60):
        k = np.exp(log_k)
        value = relation.angular_frequency(k, water)
        step = (np.log(value) - target) * value / (k * relation.derivative(k, water))
        log_k -= step
        if np.all(np.abs(step) < 1e-14):
            break
    return np.where(positive, np.exp(log_k), 0.0)
