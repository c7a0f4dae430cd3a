# SPDX-License-Identifier: GPL-3.0-or-later
"""A calm is a wind of 0, or one over no water: flat, and what the weakest winds tend to."""

from __future__ import annotations

import dataclasses
import json
import math
from itertools import pairwise

import numpy as np
import pytest

from ocean_tweak.core import ImageLayer, Ocean, OceanParameters, Patch, WaveLayer
from ocean_tweak.core.foam.threshold import foam_outlook
from ocean_tweak.core.parameters.shot import Animation, Shot
from ocean_tweak.core.spectral import spectra
from ocean_tweak.core.spectral.directional_spectrum import DirectionalSpectrum
from ocean_tweak.core.spectral.spectra import layer_scales
from ocean_tweak.core.statistics.sea_scales import beaufort_number
from ocean_tweak.core.statistics.sea_spectrum import frequency_curves, polar_density
from ocean_tweak.core.statistics.unresolved_slopes import total_slope_variance, unresolved_slope_variance
from ocean_tweak.core.synthesis.channels import CHANNELS
from ocean_tweak.core.synthesis.coefficients import initial_state
from ocean_tweak.core.waves.image.parameters import ANIMATIONS, FILTER_GAINS
from ocean_tweak.core.waves.spectral import SPREADINGS
from tests.layers import with_layers

pytestmark = pytest.mark.filterwarnings("error")

ALL = CHANNELS.keys()
FROM_WIND = ("TMA", "JONSWAP", "PIERSON_MOSKOWITZ", "PHILLIPS")
SWELL = WaveLayer(definition="SEA_STATE", significant_wave_height=0.5, peak_period=3.0, id=7)
SEA = OceanParameters(resolution=32, domain_size=60.0, layers=(SWELL,))
CALMS = [WaveLayer(spectrum=name, wind_speed=0.0, id=1) for name in FROM_WIND]
CALMS += [WaveLayer(spectrum=name, wind_speed=20.0, fetch=0.0, id=1) for name in ("TMA", "JONSWAP")]
CALMS += [
    WaveLayer(spreading=model, wind_speed=0.0, limit_fetch=limited, id=1)
    for model in SPREADINGS
    for limited in (True, False)
]


@pytest.mark.parametrize("calm", CALMS)
def test_a_calm_is_flat_and_all_that_is_told_of_it_is_sensible(calm: WaveLayer) -> None:
    flat = SEA.replace(layers=(calm,))
    fields = Ocean(flat).surface(4.0, ALL)
    assert all(np.all(np.isfinite(getattr(fields, name))) for name in ALL)
    assert not fields.displacement.any()
    assert not fields.velocity.any()
    assert not fields.foam.any()
    np.testing.assert_array_equal(fields.normal[..., 2], 1.0)
    one_patch = flat.replace(patches=(Patch(flat.domain_size, resolution=flat.resolution),))
    for found in (Ocean(flat).statistics(), Ocean(one_patch).statistics()):
        assert found.significant_wave_height == 0.0
        assert found.warnings == (
            "The sea is flat: no layer has energy. Unmute one, or raise its wind, amplitude scale or wave "
            "height",
        )
        json.dumps(found.to_dict(), allow_nan=False)
    assert foam_outlook(flat).coverage == 0.0
    assert total_slope_variance(flat) == unresolved_slope_variance(flat) == 0.0
    assert frequency_curves(flat).layers.size == 0
    assert not polar_density(flat).density.any()
    assert OceanParameters.from_json(flat.to_json()) == flat


@pytest.mark.parametrize("calm", CALMS)
def test_a_calm_beside_a_swell_changes_nothing(calm: WaveLayer) -> None:
    both = SEA.replace(layers=(calm, SWELL))
    np.testing.assert_array_equal(initial_state(both).h_plus, initial_state(SEA).h_plus)
    fields, alone = (Ocean(sea).surface(4.0, ALL) for sea in (both, SEA))
    for name in ALL:
        np.testing.assert_array_equal(getattr(fields, name), getattr(alone, name))
    assert Ocean(both).statistics() == Ocean(SEA).statistics()
    patched = both.replace(
        patches=(
            Patch(domain_size=60.0, resolution=32, shortest_wavelength=8.0),
            Patch(domain_size=21.0, resolution=32, longest_wavelength=8.0),
        )
    )
    assert Ocean(patched).statistics().spectrum == Ocean(SEA).statistics().spectrum


@pytest.mark.parametrize("name", FROM_WIND)
@pytest.mark.parametrize("wind", [1e-9, 0.01, 0.05, 0.1, 1.0])
def test_heights_fall_with_the_square_of_the_wind(name: str, wind: float) -> None:
    # Pierson & Moskowitz (1964), as Horvath (2015) has it: Hs = 0.02245 U². A sea that is limited to full
    # development has the same law in deep water, and more height by its peak: 4 √(0.076 · 0.305) ·
    # 17 036^-0.11 / 0.855²
    expected = {"PIERSON_MOSKOWITZ": 0.02245, "PHILLIPS": 0.02245}.get(name, 0.02910) * wind**2
    sea = SEA.replace(layers=(WaveLayer(spectrum=name, wind_speed=wind),))
    assert Ocean(sea).statistics().significant_wave_height == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize("layer", [WaveLayer(limit_fetch=False), WaveLayer(spectrum="JONSWAP")])
@pytest.mark.parametrize("field", ["wind_speed", "fetch"])
def test_the_weakest_seas_tend_to_a_calm(layer: WaveLayer, field: str) -> None:
    falling = [dataclasses.replace(layer, **{field: 10.0**-power}) for power in range(13)]
    heights = [Ocean(SEA.replace(layers=(one,))).statistics().significant_wave_height for one in falling]
    assert all(after < before for before, after in pairwise(heights))
    assert 0.0 < heights[-1] < 1e-9
    surface = Ocean(SEA.replace(layers=(falling[-1], SWELL))).surface(4.0, {"displacement"})
    calm = Ocean(SEA).surface(4.0, {"displacement"})
    np.testing.assert_allclose(surface.displacement, calm.displacement, atol=1e-9)


def test_the_formulas_have_their_limits() -> None:
    omega = np.linspace(0.0, 1e4, 64)
    for zero in (0.0, 5e-324):
        for wind, fetch in ((zero, 1e5), (10.0, zero), (zero, zero)):
            alpha, peak = spectra.jonswap_alpha(wind, fetch), spectra.jonswap_peak(wind, fetch)
            assert not spectra.jonswap(omega, alpha, peak).any()
    assert spectra.pierson_moskowitz_peak(0.0) == spectra.phillips_peak(0.0) == math.inf
    calm = WaveLayer(wind_speed=0.0)
    assert layer_scales(calm, SEA.water).peak_frequency == math.inf
    spectrum = DirectionalSpectrum(calm, SEA.water, SEA.dispersion)
    assert not spectrum.frequency_spectrum(omega).any()
    assert not spectrum.density(omega[1:], omega[1:]).any()


def test_energy_that_no_wind_gives_stays_in_a_calm() -> None:
    # A/4B is the variance of A/ω⁵ exp(-B/ω⁴)
    calm, windy = (WaveLayer(spectrum="GENERALIZED_AB", wind_speed=wind) for wind in (0.0, 12.0))
    expected = 4.0 * math.sqrt(calm.generalized_a / (4.0 * calm.generalized_b))
    assert not calm.is_calm
    for layer in (calm, windy):
        state = Ocean(SEA.replace(layers=(layer,))).statistics()
        assert state.significant_wave_height == pytest.approx(expected, rel=1e-3)
    assert not Ocean(SEA.replace(layers=(calm,))).surface(3.0, {"foam"}).foam.any()


@pytest.mark.parametrize("gain", FILTER_GAINS)
@pytest.mark.parametrize("animation", ANIMATIONS)
def test_images_of_a_calm_are_flat(gain: str, animation: str) -> None:
    layer = ImageLayer(filter_gain=gain, wind_speed=0.0, animation=animation, noise_resolution=16)
    sea = with_layers(SEA.replace(layers=(WaveLayer(muted=True),)), IMAGE=(layer,))
    fields = Ocean(sea).surface(4.0, ALL)
    assert not fields.displacement.any()
    assert not fields.foam.any()
    assert Ocean(sea).statistics().warnings


def test_a_wind_that_dies_ends_in_a_calm_and_comes_back() -> None:
    winds = (8.0, 4.0, 0.0, 0.0, 4.0)
    sea = SEA.replace(layers=(WaveLayer(id=1), SWELL))
    shot = Shot(sea, Animation(1, (("layers.0.wind_speed", winds),)))
    for frame, wind in enumerate(winds, start=1):
        moment = shot.at(frame)
        wave = dataclasses.replace(sea.layers[0], wind_speed=wind)
        expected = SEA.replace(layers=(wave, SWELL)) if wind else SEA
        np.testing.assert_array_equal(
            Ocean(moment.parameters).surface(moment.time, {"displacement"}).displacement,
            Ocean(expected).surface(moment.time, {"displacement"}).displacement,
        )


def test_sailors_call_it_calm() -> None:
    assert beaufort_number(0.0) == 0
