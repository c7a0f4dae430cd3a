# SPDX-License-Identifier: GPL-3.0-or-later
"""Single constants, each seen through what it does, against the paper's number or one worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ocean_tweak.core import OceanParameters, Water
from ocean_tweak.core.spectral import dispersion
from ocean_tweak.core.spectral.spreading import donelan_banner_beta, hasselmann_s
from ocean_tweak.core.synthesis.coefficients import initial_state
from ocean_tweak.core.synthesis.trough_damping import trough_damping
from tests.core.layer_spectra import spectrum_of


def test_slowest_ripples() -> None:
    # in deep water (9) has its least phase speed (4gσ/ρ)^¼ at k = √(ρg/σ): 0.232135 m/s at 364.10 rad/m
    assert dispersion.capillary(364.10, Water()) / 364.10 == pytest.approx(0.232135, rel=3e-6)
    # shorter ripples: c² = g/k + σk/ρ = 0.004905 + 0.148 at k = 2000 rad/m
    assert dispersion.capillary(2000.0, Water()) / 2000.0 == pytest.approx(math.sqrt(0.152905), rel=1e-6)


def test_branches_of_donelan_banner() -> None:
    """Horvath (2015), eq. 38, on both sides of its ends: near 1.6 the branches differ by less than 0.05 %."""
    expected = {
        0.94: 2.61 * 0.94**1.3,
        0.95: 2.28 * 0.95**-1.3,
        0.96: 2.28 * 0.96**-1.3,
        1.57: 2.28 * 1.57**-1.3,
        1.63: 10.0 ** (-0.4 + 0.8393 * math.exp(-0.567 * math.log(1.63**2))),
    }
    np.testing.assert_allclose(donelan_banner_beta(list(expected)), list(expected.values()), rtol=1e-9)
    # the two lines that meet at 1.6, worked out by hand beyond it: 1.20807 and 1.20858
    assert donelan_banner_beta(1.63) == pytest.approx(1.20858, rel=1e-5)


def test_branches_of_hasselmann() -> None:
    # eq. 37 with U ω_p/g = 1.17: 6.97 x^4.06 below 1.05, 9.77 x^-2.33 from there on
    assert hasselmann_s(1.04, 1.17) == pytest.approx(6.97 * 1.04**4.06, rel=1e-9)
    assert hasselmann_s(1.06, 1.17) == pytest.approx(9.77 * 1.06**-2.33, rel=1e-9)


def test_widths_of_the_jonswap_peak() -> None:
    # eq. 28 with γ = e: S/S(γ = 1) is exp(r); half a width away r = exp(-⅛)
    peaked, base = (spectrum_of(peak_enhancement=gamma) for gamma in (math.e, 1.0))
    for width, side in ((0.07, -1.0), (0.09, 1.0)):
        omega = base.peak_frequency * (1.0 + 0.5 * side * width)
        ratio = peaked.frequency_spectrum(omega) / base.frequency_spectrum(omega)
        assert math.log(ratio) == pytest.approx(math.exp(-0.125), rel=1e-9)


def test_long_waves_of_trough_damping() -> None:
    # G = exp(-(k/3k_p)⁴) is 1/e at three times the peak's wave number and exp(-1/81) at the peak
    state = initial_state(OceanParameters(resolution=32, domain_size=100.0))
    damping = trough_damping(0.5, state, 2.0 * state.grid.spacing)
    assert damping is not None
    assert damping.long_waves[0, 6] == pytest.approx(math.exp(-1.0), rel=1e-9)
    assert damping.long_waves[2, 0] == pytest.approx(math.exp(-1.0 / 81.0), rel=1e-9)


def test_water_of_the_paper() -> None:
    # Horvath (2015), table 1
    water = Water()
    assert (water.gravity, water.density, water.surface_tension) == (9.81, 1000.0, 0.074)
