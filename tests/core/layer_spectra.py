# SPDX-License-Identifier: GPL-3.0-or-later
"""The spectra that seas are made of: published numbers are asserted on these, and not beside them."""

from __future__ import annotations

from typing import Any

from ocean_tweak.core import Water, WaveLayer
from ocean_tweak.core.spectral.directional_spectrum import DirectionalSpectrum

DEEP = Water(depth=11e3)


def spectrum_of(water: Water = DEEP, **layer: Any) -> DirectionalSpectrum:
    """Of a layer with these numbers, by default of JONSWAP and in deep water."""
    return DirectionalSpectrum(WaveLayer(**{"spectrum": "JONSWAP", **layer}), water, "DEEP")


def jonswap_scales(U: float, F: float, g: float = 9.81) -> tuple[float, float]:
    """α and ω_p in rad/s as Hasselmann et al. (1973) print them, over X = g F / U²."""
    X = g * F / U**2
    return 0.076 * X**-0.22, 22.0 * g / U * X ** (-1.0 / 3.0)
