# SPDX-License-Identifier: GPL-3.0-or-later
"""Directional spreading D(ω, θ) in 1/rad: how the energy at a frequency is distributed over directions.

θ is the angle in rad between a wave and its wind. Every model has a shape that is 1 along the wind; a
normalisation tabulated over ω/ω_p makes ∫D dθ = 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..numerics.memo import remembered
from . import constants

Array = NDArray[np.float64]

#: range of ω/ω_p of the tables; beyond it, the shape is that at the nearer end
_TABLE_FROM, _TABLE_TO, _TABLE_SIZE = 0.03, 300.0, 6144

#: ω/ω_p at which the shape of a model has a jump or a kink
_BREAKS = (
    constants.DONELAN_MIDDLE_FROM,
    1.0,
    constants.HASSELMANN_ABOVE_FROM,
    constants.BANNER_FROM,
)


#: largest s, at which waves are within half a degree of the wind: far beyond any real sea
_LARGEST_S = 1e4


@dataclass(frozen=True)
class Spreading:
    """A spreading model with its parameters.

    model, second : names in `MODELS`; `mix` is the fraction of the second
    swell : ξ of Horvath (2015), eq. 45
    exponent : s of COSINE_2S
    wind_frequency : U ω_p / g, on which Mitsuyasu's and Hasselmann's models depend

    Examples
    --------
    >>> Spreading("MITSUYASU", swell=0.5, wind_frequency=1.0).swell
    0.5
    """

    model: str
    swell: float = 0.0
    second: str = "FLAT"
    mix: float = 0.0
    exponent: float = 1.0
    wind_frequency: float = constants.PM_PEAK


#: the models whose shape depends on the wind
WIND_MODELS = frozenset({"HASSELMANN", "MITSUYASU"})


def wrap_angle(theta: ArrayLike) -> Array:
    """The same direction in [-π, π).

    Examples
    --------
    >>> wrap_angle([3.5, -0.25]).round(4)
    array([-2.7832, -0.25  ])
    """
    return (np.asarray(theta, np.float64) + np.pi) % (2.0 * np.pi) - np.pi


def cosine_power(theta: ArrayLike, s: ArrayLike) -> Array:
    """|cos(θ/2)|^2s, the Longuet-Higgins shape. Horvath (2015), eq. 33 and 44; Chen (2014), eq. 29.

    Examples
    --------
    >>> cosine_power([0.0, np.pi / 2], s=2.0).round(3)
    array([1.  , 0.25])
    """
    cosine = np.maximum(np.abs(np.cos(0.5 * np.asarray(theta, np.float64))), 1e-150)
    return np.exp(2.0 * np.asarray(s, np.float64) * np.log(cosine))


def donelan_banner_beta(ratio: ArrayLike) -> Array:
    """β_s of Donelan-Banner over ω/ω_p. Horvath (2015), eq. 38; the first branch holds down to ω = 0.

    Examples
    --------
    >>> donelan_banner_beta([0.6, 1.2, 2.0]).round(2)
    array([1.34, 1.8 , 0.96])
    """
    x = np.maximum(np.asarray(ratio, np.float64), 1e-6)
    below = constants.DONELAN_BELOW * x**constants.DONELAN_EXPONENT
    middle = constants.DONELAN_MIDDLE * x**-constants.DONELAN_EXPONENT
    epsilon = constants.BANNER_OFFSET + constants.BANNER_FACTOR * x ** (2.0 * constants.BANNER_EXPONENT)
    above = np.where(x < constants.BANNER_FROM, middle, 10.0**epsilon)
    return np.where(x < constants.DONELAN_MIDDLE_FROM, below, above)


def mitsuyasu_s(ratio: ArrayLike, wind_frequency: float) -> Array:
    """s of Mitsuyasu's model over ω/ω_p. Horvath (2015), eq. 35 and 36.

    Examples
    --------
    >>> mitsuyasu_s([0.8, 1.0, 1.5], wind_frequency=1.0).round(2)
    array([ 3.77, 11.5 ,  4.17])
    """
    x = np.maximum(np.asarray(ratio, np.float64), 1e-6)
    # s grows without bound as the wind falls
    slow = max(wind_frequency, 1e-30)
    s_p = constants.MITSUYASU_PEAK * slow**constants.MITSUYASU_WIND_EXPONENT
    below, above = constants.MITSUYASU_BELOW_EXPONENT, constants.MITSUYASU_ABOVE_EXPONENT
    return np.minimum(s_p * np.where(x <= 1.0, x**below, x**above), _LARGEST_S)


def hasselmann_s(ratio: ArrayLike, wind_frequency: float) -> Array:
    """s of Hasselmann's model over ω/ω_p. Horvath (2015), eq. 37, corrected: the second branch begins at 1.05
    ω_p, as in Hasselmann, Dunckel & Ewing (1980).

    Examples
    --------
    >>> hasselmann_s([0.8, 1.0, 1.5], wind_frequency=1.0).round(2)
    array([2.82, 6.97, 4.2 ])
    """
    x = np.maximum(np.asarray(ratio, np.float64), 1e-6)
    growth = wind_frequency - constants.HASSELMANN_WIND_OFFSET
    exponent = constants.HASSELMANN_ABOVE_EXPONENT + constants.HASSELMANN_WIND_FACTOR * growth
    is_below = x < constants.HASSELMANN_ABOVE_FROM
    below = constants.HASSELMANN_BELOW * np.where(is_below, x, 1.0) ** constants.HASSELMANN_BELOW_EXPONENT
    above = constants.HASSELMANN_ABOVE * np.where(is_below, 1.0, x) ** exponent
    return np.where(is_below, below, above)


def swell_s(ratio: ArrayLike, swell: float) -> Array:
    """s_ξ of the swell factor over ω/ω_p. Horvath (2015), eq. 45.

    Examples
    --------
    >>> swell_s([0.8, 1.0, 1.5], swell=1.0).round(2)
    array([13.57, 12.19,  9.32])
    """
    x = np.maximum(np.asarray(ratio, np.float64), 1e-6)
    return constants.SWELL_SHAPE * np.tanh(1.0 / x) * swell**2


@dataclass(frozen=True)
class Model:
    """A family of shapes over θ with one parameter that depends on the frequency.

    parameter : of (ω/ω_p, spreading)
    shape : of (|θ| in 0…π, parameter), 1 at θ = 0
    """

    parameter: Callable[[Array, Spreading], Array]
    shape: Callable[[Array, Array], Array]


def squared_sech(theta: Array, beta: Array) -> Array:
    """sech²(βθ) for θ ≥ 0. Horvath (2015), eq. 38."""
    e = np.exp(-2.0 * beta * theta)
    return 4.0 * e / (1.0 + e) ** 2


def _half_cosine_squared(theta: Array, unused: Array) -> Array:
    """cos²θ along the wind, 0 against it. Horvath (2015), eq. 32."""
    return np.maximum(np.cos(theta), 0.0) ** 2


def _flat(theta: Array, unused: Array) -> Array:
    """Equal for all directions. Horvath (2015), eq. 39."""
    return np.ones_like(theta)


MODELS: dict[str, Model] = {
    "DONELAN_BANNER": Model(lambda ratio, spreading: donelan_banner_beta(ratio), squared_sech),
    "HASSELMANN": Model(lambda ratio, spreading: hasselmann_s(ratio, spreading.wind_frequency), cosine_power),
    "MITSUYASU": Model(lambda ratio, spreading: mitsuyasu_s(ratio, spreading.wind_frequency), cosine_power),
    "COSINE_SQUARED": Model(lambda ratio, spreading: np.zeros_like(ratio), _half_cosine_squared),
    "COSINE_2S": Model(lambda ratio, spreading: np.full_like(ratio, spreading.exponent), cosine_power),
    "FLAT": Model(lambda ratio, spreading: np.zeros_like(ratio), _flat),
}


class Shape(NamedTuple):
    """All that D depends on at a frequency: D = (w₁·shape₁ + w₂·shape₂) · |cos(θ/2)|^2s.

    All arrays have the shape of the frequencies; `second_weight` is None without a mixture, `swell` without
    swell. Horvath (2015), eq. 40, 42 and 44.
    """

    first_weight: Array
    first: Array
    second_weight: Array | None
    second: Array | None
    swell: Array | None

    def density(self, theta: Array, spreading: Spreading) -> Array:
        """D in 1/rad at angles |θ| in 0…π, broadcast against the frequencies."""
        result = self.first_weight * MODELS[spreading.model].shape(theta, self.first)
        if self.second_weight is not None and self.second is not None:
            result += self.second_weight * MODELS[spreading.second].shape(theta, self.second)
        if self.swell is not None:
            result *= cosine_power(theta, self.swell)
        return result


@cache
def direction_rule() -> tuple[Array, Array]:
    """Nodes and weights of a quadrature on [0, π], in panels that halve in width towards 0, where narrow
    peaks are, and towards π, where a small power of cos(θ/2) falls steeply."""
    towards_zero = np.pi * 2.0 ** np.arange(-10.0, 0.0)
    towards_pi = np.pi * (1.0 - 2.0 ** np.arange(-2.0, -19.0, -1.0))
    edges = np.concatenate(([0.0], towards_zero, towards_pi, [np.pi]))
    x, w = np.polynomial.legendre.leggauss(10)
    width = np.diff(edges)[:, np.newaxis]
    return (edges[:-1, np.newaxis] + 0.5 * width * (x + 1.0)).ravel(), (0.5 * width * w).ravel()


@cache
def _table_ratios() -> Array:
    """The tabulated ω/ω_p, with a node on either side of each jump, so that nothing is interpolated across
    it."""
    even = np.geomspace(_TABLE_FROM, _TABLE_TO, _TABLE_SIZE)
    return np.unique(np.concatenate((even, _BREAKS, np.nextafter(_BREAKS, 0.0))))


@remembered("spreading tables")
def _final_table(spreading: Spreading) -> Array:
    """ln Q_final at the tabulated ω/ω_p, Q_final = 1/∫D_base D_ξ dθ. Horvath (2015), eq. 43."""
    theta, weight = direction_rule()
    density = _not_normalised(_table_ratios()[:, np.newaxis], spreading).density(theta, spreading)
    return -np.log(2.0 * density @ weight)


def _alone(spreading: Spreading, model: str) -> Spreading:
    """A model without swell, as the key of its table."""
    wind_frequency = spreading.wind_frequency if model in WIND_MODELS else constants.PM_PEAK
    return Spreading(model, exponent=spreading.exponent, wind_frequency=wind_frequency)


def _normalisation(ratio: Array, spreading: Spreading) -> Array:
    return np.exp(np.interp(ratio, _table_ratios(), _final_table(spreading)))


def _not_normalised(ratio: Array, spreading: Spreading) -> Shape:
    """The shape with the weights of D_base, with each of its models normalised; eq. 34 for cosine powers."""
    first = MODELS[spreading.model].parameter(ratio, spreading)
    first_weight, second_weight, second = np.ones_like(ratio), None, None
    if spreading.mix > 0.0:
        second = MODELS[spreading.second].parameter(ratio, spreading)
        first_weight = (1.0 - spreading.mix) * _normalisation(ratio, _alone(spreading, spreading.model))
        second_weight = spreading.mix * _normalisation(ratio, _alone(spreading, spreading.second))
    swell = swell_s(ratio, spreading.swell) if spreading.swell > 0.0 else None
    return Shape(first_weight, first, second_weight, second, swell)


def spreading_shape(omega_ratio: ArrayLike, spreading: Spreading) -> Shape:
    """The normalised shape at ω/ω_p > 0, any array shape."""
    ratio = np.clip(np.asarray(omega_ratio, np.float64), _TABLE_FROM, _TABLE_TO)
    shape = _not_normalised(ratio, spreading)
    q = _normalisation(ratio, spreading)
    second_weight = None if shape.second_weight is None else q * shape.second_weight
    return shape._replace(first_weight=q * shape.first_weight, second_weight=second_weight)


def directional_spreading(omega_ratio: ArrayLike, theta: ArrayLike, spreading: Spreading) -> Array:
    """D(ω, θ) in 1/rad, normalised for every ω. Horvath (2015), eq. 42.

    omega_ratio : ω/ω_p, > 0, broadcast against theta
    theta : angle to the wind in rad, any value (it is wrapped: sech² is not periodic)

    Examples
    --------
    >>> directional_spreading(1.0, [0.0, 1.0, np.pi], Spreading("DONELAN_BANNER")).round(4)
    array([1.14  , 0.0467, 0.    ])
    """
    return spreading_shape(omega_ratio, spreading).density(np.abs(wrap_angle(theta)), spreading)


def mean_cosine(omega_ratio: ArrayLike, spreading: Spreading) -> Array:
    """∫D cos θ dθ over ω/ω_p: how closely the waves follow the wind's direction, -1…1.

    Examples
    --------
    >>> mean_cosine([0.8, 1.0, 2.0], Spreading("DONELAN_BANNER")).round(3)
    array([0.9  , 0.925, 0.669])
    """
    theta, weight = direction_rule()
    ratio = np.asarray(omega_ratio, np.float64)[..., np.newaxis]
    return 2.0 * (directional_spreading(ratio, theta, spreading) * np.cos(theta)) @ weight
