# SPDX-License-Identifier: GPL-3.0-or-later
"""Frequency spectra S(ω) in m²·s/rad over the angular frequency ω in rad/s, and those of wave layers.

Symbols as in Horvath (2015): U wind speed in m/s (at 10 m unless said otherwise), F fetch in m, h depth in m,
g in m/s². Functions of ω take arrays of any shape and return float64 arrays of that shape, with S(0) = 0. In
a calm, U = 0 or F = 0, the peak is at infinity and S is 0 at every frequency, which is the limit for weak
winds.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..numerics.memo import remembered
from . import constants, dispersion
from .water import Water

if TYPE_CHECKING:
    from ..waves.spectral import WaveLayer

Array = NDArray[np.float64]


def wind_factor(wind_speed_10: float, height: float) -> float:
    """U_z / U_10 for a wind of U_10 m/s at 10 m and a height in m.

    Horvath (2015), § 5.1.3, corrected: the drag coefficient is (0.8 + 0.065 U_10)·10⁻³, and the log law
    has its 1/κ: 1 + 2.5 √C_10 ln(z/10).

    Examples
    --------
    >>> round(wind_factor(10.0, height=19.5), 3)
    1.064
    """
    drag = constants.DRAG_OFFSET + constants.DRAG_SLOPE * wind_speed_10
    return 1.0 + math.sqrt(drag) / constants.KARMAN * math.log(height / 10.0)


def wind_at_10_m(wind_speed: float, height: float) -> float:
    """U_10 in m/s of a wind measured at another height in m: the inverse of `wind_factor`.

    Examples
    --------
    >>> round(wind_at_10_m(10.6, height=19.5), 2)
    9.97
    """
    result = wind_speed
    for _ in range(100):
        result, previous = wind_speed / wind_factor(result, height), result
        if abs(result - previous) <= 1e-15 * result:
            break
    return result


def wind_at(wind_speed_10: float, height: float) -> float:
    """U_z in m/s at a height in m, for a wind of U_10 m/s at 10 m.

    Examples
    --------
    >>> round(wind_at(10.0, height=19.5), 2)
    10.64
    """
    return wind_speed_10 * wind_factor(wind_speed_10, height)


def _over(a: float, b: float) -> float:
    """a/b for b ≥ 0; infinite where b is 0: in a calm, wavelengths tend to 0 and frequencies to infinity."""
    return a / b if b > 0.0 else math.inf


def _fourth(omega: float) -> float:
    """ω⁴; infinite on overflow."""
    return omega**4 if omega < 1e77 else math.inf


def generalized_ab(omega: ArrayLike, A: float, B: float) -> Array:
    """S = A/ω⁵ exp(-B/ω⁴), A in m²/s⁴ and B in 1/s⁴. Horvath (2015), eq. 20.

    Examples
    --------
    >>> generalized_ab([0.5, 1.0], A=0.78, B=0.74).round(3)
    array([0.   , 0.372])
    """
    omega = np.asarray(omega, np.float64)
    if not math.isfinite(A * B):  # the peak lies beyond all representable waves
        return np.zeros_like(omega)
    # the exponential is zero in double precision where B/ω⁴ > 745: the floor keeps the quotient finite
    w = np.maximum(omega, (B / 1e4) ** 0.25)
    return A / w**5 * np.exp(-B / w**4)


def pierson_moskowitz_peak(U: float, g: float = constants.GRAVITY) -> float:
    """ω_p in rad/s of the Pierson-Moskowitz spectrum, 0.855 g/U. Horvath (2015), eq. 19, as it follows from
    the factor 0.74 of eq. 18.

    Examples
    --------
    >>> round(pierson_moskowitz_peak(U=10.0), 3)
    0.839
    """
    factor = (constants.PM_BETA / constants.DEVELOPMENT) ** 0.25
    return _over(factor * g, constants.PM_WIND_FACTOR * U)


def phillips_peak(U: float, g: float = constants.GRAVITY) -> float:
    """ω_p in rad/s of the Phillips (Tessendorf) spectrum: (4B/5)^¼ with B = (g/U)⁴, U at 19.5 m.

    Horvath (2015), eq. 27.

    Examples
    --------
    >>> round(phillips_peak(U=10.0), 3)
    0.904
    """
    return _over(constants.DEVELOPMENT**-0.25 * g, constants.PM_WIND_FACTOR * U)


def full_development_fetch(U: float, g: float = constants.GRAVITY) -> float:
    """Fetch in m beyond which a sea no longer grows: where JONSWAP's peak frequency (eq. 28) falls to that of
    Pierson and Moskowitz (eq. 19 of Horvath 2015), g F / U² ≈ 17 036.

    Examples
    --------
    >>> round(full_development_fetch(U=10.0) / 1e3)  # km
    174
    """
    return (constants.JONSWAP_PEAK / constants.PM_PEAK) ** 3 * U**2 / g


def jonswap_alpha(U: float, F: float, g: float = constants.GRAVITY) -> float:
    """α of JONSWAP, dimensionless. Horvath (2015), eq. 28.

    Examples
    --------
    >>> round(jonswap_alpha(U=10.0, F=100e3), 4)
    0.0101
    """
    return constants.JONSWAP_ALPHA * _over(U**2, F * g) ** constants.JONSWAP_ALPHA_EXPONENT


def jonswap_peak(U: float, F: float, g: float = constants.GRAVITY) -> float:
    """ω_p of JONSWAP in rad/s. Horvath (2015), eq. 28, corrected: the cube root is missing in print.

    Examples
    --------
    >>> round(jonswap_peak(U=10.0, F=100e3), 3)
    1.008
    """
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

    Examples
    --------
    >>> jonswap([0.5, 1.0, 2.0], alpha=0.0118, omega_p=1.0).round(4)
    array([0.    , 1.0737, 0.0328])
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

    Examples
    --------
    >>> kitaigorodskii([0.5, 1.0, 2.0]).round(3)
    array([0.125, 0.483, 0.993])
    """
    unit = Water(depth=1.0, gravity=1.0)
    kh = dispersion.wave_number(omega_h, "FINITE_DEPTH", unit)
    x = np.clip(2.0 * kh, 1e-12, 700.0)
    return np.tanh(kh) ** 2 / (1.0 + x / np.sinh(x))


def thompson_vincent(omega_h: ArrayLike) -> Array:
    """Thompson and Vincent's (1983) approximation of Kitaigorodskii's factor, within 0.023 of it.

    Horvath (2015), after eq. 29, completed: 1 for ω_h ≥ 2, where the printed branch turns down.

    Examples
    --------
    >>> thompson_vincent([0.5, 1.0, 2.0])
    array([0.125, 0.5  , 1.   ])
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
    """TMA spectrum: JONSWAP times the depth factor. Horvath (2015), eq. 30.

    Examples
    --------
    >>> tma([0.5, 1.0, 2.0], alpha=0.0118, omega_p=1.0, water=Water(depth=10.0)).round(4)
    array([0.    , 0.5275, 0.0326])
    """
    omega = np.asarray(omega, np.float64)
    factor = DEPTH_FACTORS[depth_factor](omega * np.sqrt(water.depth / water.gravity))
    return jonswap(omega, alpha, omega_p, gamma, water.gravity) * factor


@dataclass(frozen=True)
class LayerScales:
    """Parameters of a layer's spectrum. All spectra are α g²/ω⁵ exp(-5/4 (ω_p/ω)⁴) γ^r, TMA times its depth
    factor.

    alpha : α, dimensionless
    peak_frequency : ω_p in rad/s, before the depth factor; infinite in a calm, which has no energy
    peak_enhancement : γ; 1 except for JONSWAP and TMA
    wind_frequency : U_10 ω_p / g, for the spreading models that depend on the wind
    fetch : the effective fetch in m, limited to full development; NaN for spectra without a fetch
    """

    alpha: float
    peak_frequency: float
    peak_enhancement: float
    wind_frequency: float
    fetch: float = float("nan")


def jonswap_scales(layer: WaveLayer, U: float, g: float) -> LayerScales:
    """JONSWAP, and TMA before its depth factor. Horvath (2015), eq. 28."""
    limit = full_development_fetch(U, g) if layer.limit_fetch else np.inf
    fetch = min(layer.fetch, limit)
    omega_p = jonswap_peak(U, fetch, g)
    alpha = jonswap_alpha(U, fetch, g)
    return LayerScales(alpha, omega_p, layer.peak_enhancement, U * omega_p / g, fetch)


def pierson_moskowitz_scales(_layer: WaveLayer, U: float, g: float) -> LayerScales:
    """A fully developed sea. Horvath (2015), eq. 18: α = 8.1·10⁻³."""
    omega_p = pierson_moskowitz_peak(U, g)
    return LayerScales(constants.PM_ALPHA, omega_p, 1.0, U * omega_p / g)


def phillips_scales(_layer: WaveLayer, U: float, g: float) -> LayerScales:
    """The Phillips (Tessendorf) spectrum with the energy of Pierson-Moskowitz at the same wind.

    Horvath (2015), eq. 26: A = 2 A_T g². Chen (2014) sets its constant so that both spectra hold the same
    energy, A/4B: A = α g²/β.
    """
    omega_p = phillips_peak(U, g)
    return LayerScales(constants.PM_ALPHA / constants.PM_BETA, omega_p, 1.0, U * omega_p / g)


def generalized_ab_scales(layer: WaveLayer, U: float, g: float) -> LayerScales:
    """A/ω⁵ exp(-B/ω⁴). Horvath (2015), eq. 20."""
    omega_p = (layer.generalized_b / constants.DEVELOPMENT) ** 0.25
    return LayerScales(layer.generalized_a / g**2, omega_p, 1.0, U * omega_p / g)


#: spectrum name → function of a layer, U in m/s at 10 m and g in m/s²
FROM_WIND: dict[str, Callable[[WaveLayer, float, float], LayerScales]] = {
    "TMA": jonswap_scales,
    "JONSWAP": jonswap_scales,
    "PIERSON_MOSKOWITZ": pierson_moskowitz_scales,
    "PHILLIPS": phillips_scales,
    "GENERALIZED_AB": generalized_ab_scales,
}


def layer_scales(layer: WaveLayer, water: Water) -> LayerScales:
    """Parameters of a layer's spectrum, from its wind or from its sea state."""
    if layer.definition == "SEA_STATE":
        return _from_sea_state(layer, water)
    if layer.is_calm:
        return LayerScales(0.0, math.inf, layer.peak_enhancement, constants.PM_PEAK)
    U = wind_at_10_m(layer.wind_speed, layer.wind_height)
    return FROM_WIND[layer.spectrum](layer, U, water.gravity)


def scaled_spectrum(omega: ArrayLike, layer: WaveLayer, scales: LayerScales, water: Water) -> Array:
    """S(ω) in m²·s/rad of a layer's spectrum, of any shape, before amplitude scale and band."""
    alpha, omega_p, gamma = scales.alpha, scales.peak_frequency, scales.peak_enhancement
    if layer.spectrum == "TMA":
        return tma(omega, alpha, omega_p, water, gamma, layer.depth_factor)
    return jonswap(omega, alpha, omega_p, gamma, water.gravity)


@remembered("scales of layers")
def _from_sea_state(layer: WaveLayer, water: Water) -> LayerScales:
    """Parameters that give the layer its Hs and its spectrum a peak at its Tp, at this depth.

    The depth factor shifts the peak up a little, so ω_p is found by iteration. The spreading models use the
    wind for which this sea is fully developed.
    """
    gamma = layer.peak_enhancement if layer.spectrum in ("TMA", "JONSWAP") else 1.0
    target = 2.0 * np.pi / layer.peak_period
    omega_p = target
    for _ in range(30):
        scales = LayerScales(1.0, omega_p, gamma, constants.PM_PEAK)
        omega, spectrum = _around_peak(layer, scales, water)
        correction = target / refined_peak(omega, spectrum)
        omega_p *= correction
        if abs(correction - 1.0) < 1e-9:
            break
    scales = LayerScales(1.0, omega_p, gamma, constants.PM_PEAK)
    m0 = total_energy(lambda w: scaled_spectrum(w, layer, scales, water), omega_p, omega_p)
    alpha = (layer.significant_wave_height / 4.0) ** 2 / m0
    return LayerScales(float(alpha), float(omega_p), gamma, constants.PM_PEAK)


def _around_peak(layer: WaveLayer, scales: LayerScales, water: Water) -> tuple[Array, Array]:
    # the depth factor, at most ω² in slope, moves the peak of ω⁻⁵ exp(…) up by at most (5/3)^¼
    omega = scales.peak_frequency * np.linspace(0.8, 1.4, 3001)
    return omega, scaled_spectrum(omega, layer, scales, water)


def total_energy(spectrum: Callable[[Array], Array], lowest_peak: float, highest_peak: float) -> float:
    """m0 = ∫S dω in m², for spectra with peaks between `lowest` and `highest`, up to 100 times the latter.

    Beyond, an ω⁻⁵ tail holds 1e-8 of the energy; below a fifth of the lowest peak there is none.
    """
    omega, weight = frequency_rule(lowest_peak, highest_peak)
    return float(spectrum(omega) @ weight)


def frequency_rule(lowest_peak: float, highest_peak: float, size: int = 8193) -> tuple[Array, Array]:
    """Nodes ω and weights, both in rad/s, of a quadrature for spectra with peaks between `lowest` and
    `highest`."""
    log_omega = np.linspace(np.log(0.2 * lowest_peak), np.log(100.0 * highest_peak), size)
    omega = np.exp(log_omega)
    return omega, omega * (log_omega[1] - log_omega[0])


class HasPeaks(Protocol):
    """A spectrum over frequency that tells where its peaks lie."""

    @property
    def peaks(self) -> tuple[float, float]:
        """ω in rad/s: from a fifth of the first to a hundred of the second there is all of the energy."""

    def frequency_spectrum(self, omega: Array) -> Array:
        """S(ω) in m²·s/rad."""


def combined_rule(spectra: Sequence[HasPeaks]) -> tuple[Array, Array]:
    """As `frequency_rule`, for some spectra together; around 1 rad/s for none."""
    peaks = [spectrum.peaks for spectrum in spectra] or [(1.0, 1.0)]
    return frequency_rule(min(low for low, _ in peaks), max(high for _, high in peaks))


def combined_peak(spectra: Sequence[HasPeaks]) -> float:
    """ω in rad/s at the maximum of the sum of some spectra; NaN where there is no energy."""
    omega, _ = combined_rule(spectra)
    return refined_peak(
        omega, sum((each.frequency_spectrum(omega) for each in spectra), np.zeros_like(omega))
    )


def refined_peak(omega: Array, spectrum: Array) -> float:
    """ω at the maximum, refined by a parabola through the largest sample and its neighbours; NaN if all are
    0."""
    index = int(np.argmax(spectrum))
    if not spectrum[index] > 0.0:
        return float("nan")
    peak = omega[index]
    if 0 < index < len(spectrum) - 1:
        x = omega[index - 1 : index + 2] / peak - 1.0
        y = spectrum[index - 1 : index + 2] / spectrum[index]
        curvature, slope, _ = np.polyfit(x, y, 2)
        if curvature < 0.0:
            peak *= 1.0 - 0.5 * slope / curvature
    return float(peak)
