# SPDX-License-Identifier: GPL-3.0-or-later
"""From what a layer is given by to the numbers of its spectrum.

Every spectrum here is α g²/ω⁵ exp(-5/4 (ω_p/ω)⁴) γ^r, with γ = 1 but for JONSWAP and TMA: a layer is its
(α, ω_p, γ), and TMA's depth factor.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..numerics.memo import remembered
from . import constants, spectra
from .water import Water

if TYPE_CHECKING:
    from ..waves.spectral import WaveLayer
from .wind_profile import wind_at_10_m

Array = NDArray[np.float64]


@dataclass(frozen=True)
class LayerScales:
    """Numbers of a layer's spectrum.

    alpha : α, dimensionless
    peak_frequency : ω_p in rad/s, before the depth acts; infinite in a calm, which has no energy
    peak_enhancement : γ
    wind_frequency : U_10 ω_p / g, for the spreading models that know the wind
    fetch : the fetch in m that acts, after its limit; NaN where none does
    """

    alpha: float
    peak_frequency: float
    peak_enhancement: float
    wind_frequency: float
    fetch: float = float("nan")


def jonswap(layer: WaveLayer, U: float, g: float) -> LayerScales:
    """JONSWAP, and TMA before its depth factor. Horvath (2015), eq. 28."""
    limit = spectra.full_development_fetch(U, g) if layer.limit_fetch else np.inf
    fetch = min(layer.fetch, limit)
    omega_p = spectra.jonswap_peak(U, fetch, g)
    alpha = spectra.jonswap_alpha(U, fetch, g)
    return LayerScales(alpha, omega_p, layer.peak_enhancement, U * omega_p / g, fetch)


def pierson_moskowitz(_layer: WaveLayer, U: float, g: float) -> LayerScales:
    """A fully developed sea. Horvath (2015), eq. 18: α = 8.1·10⁻³."""
    omega_p = spectra.pierson_moskowitz_peak(U, g)
    return LayerScales(constants.PM_ALPHA, omega_p, 1.0, U * omega_p / g)


def phillips(_layer: WaveLayer, U: float, g: float) -> LayerScales:
    """The Phillips (Tessendorf) spectrum with the energy of Pierson-Moskowitz at the same wind.

    Horvath (2015), eq. 26: A = 2 A_T g². Chen (2014) sets its constant so that both spectra hold the same
    energy, A/4B: A = α g²/β.
    """
    omega_p = spectra.phillips_peak(U, g)
    return LayerScales(constants.PM_ALPHA / constants.PM_BETA, omega_p, 1.0, U * omega_p / g)


def generalized_ab(layer: WaveLayer, U: float, g: float) -> LayerScales:
    """A/ω⁵ exp(-B/ω⁴). Horvath (2015), eq. 20."""
    omega_p = (layer.generalized_b / constants.DEVELOPMENT) ** 0.25
    return LayerScales(layer.generalized_a / g**2, omega_p, 1.0, U * omega_p / g)


#: by the name of a spectrum, from a layer, U in m/s at 10 m and g in m/s²
FROM_WIND: dict[str, Callable[[WaveLayer, float, float], LayerScales]] = {
    "TMA": jonswap,
    "JONSWAP": jonswap,
    "PIERSON_MOSKOWITZ": pierson_moskowitz,
    "PHILLIPS": phillips,
    "GENERALIZED_AB": generalized_ab,
}


def layer_scales(layer: WaveLayer, water: Water) -> LayerScales:
    """The numbers of a layer's spectrum, from its wind or from its sea state."""
    if layer.definition == "SEA_STATE":
        return _from_sea_state(layer, water)
    if layer.is_calm:
        return LayerScales(0.0, math.inf, layer.peak_enhancement, constants.PM_PEAK)
    U = wind_at_10_m(layer.wind_speed, layer.wind_height)
    return FROM_WIND[layer.spectrum](layer, U, water.gravity)


def scaled_spectrum(omega: ArrayLike, layer: WaveLayer, scales: LayerScales, water: Water) -> Array:
    """S(ω) in m²·s/rad of a layer's spectrum, before its gain and its band; any shape."""
    alpha, omega_p, gamma = scales.alpha, scales.peak_frequency, scales.peak_enhancement
    if layer.spectrum == "TMA":
        return spectra.tma(omega, alpha, omega_p, water, gamma, layer.depth_factor)
    return spectra.jonswap(omega, alpha, omega_p, gamma, water.gravity)


@remembered("scales of layers")
def _from_sea_state(layer: WaveLayer, water: Water) -> LayerScales:
    """Scales with which the layer has its Hs and its spectrum the peak at its Tp, in this depth.

    The depth factor moves the peak up a little, so ω_p is found by iteration. The spreading models take the
    wind that has fully developed these waves.
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
    """m0 = ∫S dω in m², for spectra with their peaks in between, up to 100 times the highest.

    Beyond, an ω⁻⁵ tail holds 1e-8 of the energy; below a fifth of the lowest peak there is none.
    """
    omega, weight = frequency_rule(lowest_peak, highest_peak)
    return float(spectrum(omega) @ weight)


def frequency_rule(lowest_peak: float, highest_peak: float, size: int = 8193) -> tuple[Array, Array]:
    """ω in rad/s and weights in rad/s of a quadrature over ω for spectra with their peaks in between."""
    log_omega = np.linspace(np.log(0.2 * lowest_peak), np.log(100.0 * highest_peak), size)
    omega = np.exp(log_omega)
    return omega, omega * (log_omega[1] - log_omega[0])


def refined_peak(omega: Array, spectrum: Array) -> float:
    """ω at the maximum, refined by the parabola through the three highest samples; NaN if all are 0."""
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
