# SPDX-License-Identifier: GPL-3.0-or-later
"""Layers: independent of each other, cut into bands, given by wind or by sea state."""

from __future__ import annotations

import dataclasses
import math
import re

import numpy as np
import pytest

from ocean_tweak.core import Ocean, OceanParameters, ParameterError, Water, WaveLayer, layer_for_sea_state
from ocean_tweak.core.spectral.directional_spectrum import DirectionalSpectrum
from ocean_tweak.core.synthesis.coefficients import initial_state

WIND = WaveLayer(wind_speed=15.0, fetch=200e3, id=4)
SWELL = WaveLayer(
    definition="SEA_STATE", significant_wave_height=2.5, peak_period=14.0, swell=1.0, wind_direction=0.7, id=2
)
BASE = OceanParameters(
    resolution=64, domain_size=1500.0, seed=6, water=Water(depth=1000.0), layers=(WIND, SWELL)
)


def h(parameters: OceanParameters) -> np.ndarray:
    return initial_state(parameters).h_plus


def test_layers_are_independent() -> None:
    both = h(BASE)
    alone = [h(BASE.replace(layers=(layer,))) for layer in (WIND, SWELL)]
    np.testing.assert_allclose(both, alone[0] + alone[1], atol=1e-12)
    np.testing.assert_array_equal(h(BASE.replace(layers=(SWELL, WIND))), both)
    muted = BASE.replace(layers=(dataclasses.replace(WIND, muted=True), SWELL))
    np.testing.assert_array_equal(h(muted), alone[1])


def test_seed_of_a_layer_follows_from_its_id() -> None:
    one = BASE.replace(layers=(WIND,))
    assert not np.array_equal(h(one), h(BASE.replace(layers=(dataclasses.replace(WIND, id=5),))))
    own = dataclasses.replace(WIND, seed=77)
    np.testing.assert_array_equal(
        h(BASE.replace(layers=(own,))), h(BASE.replace(layers=(dataclasses.replace(own, id=5),), seed=1))
    )


def test_ids_are_given_once() -> None:
    layers = OceanParameters(layers=(WaveLayer(), WaveLayer(id=0), WaveLayer(), WaveLayer(id=2))).layers
    assert [layer.id for layer in layers] == [1, 0, 3, 2]
    with pytest.raises(ParameterError, match=r"layers.1.id = 3"):
        OceanParameters(layers=(WaveLayer(id=3), WaveLayer(id=3)))


def test_equal_layers_are_different_seas() -> None:
    twice = h(OceanParameters(resolution=32, layers=(WaveLayer(), WaveLayer())))
    once = h(OceanParameters(resolution=32, layers=(WaveLayer(),)))
    assert not np.allclose(twice, 2 * once)


def test_all_muted_is_a_flat_sea() -> None:
    flat = Ocean(OceanParameters(resolution=16, layers=(WaveLayer(muted=True),), trough_damping=1.0))
    assert not np.any(flat.surface(1.0).displacement)
    statistics = flat.statistics()
    assert statistics.significant_wave_height == 0.0
    assert np.isnan(statistics.peak_period)
    assert "flat" in statistics.warnings[0]
    assert statistics.to_dict()["spectrum"]["peak_period"] is None


@pytest.mark.parametrize("softness", [0.0, 1.0])
def test_a_band_and_its_inverse_are_the_whole(softness: float) -> None:
    band = dataclasses.replace(
        WIND, shortest_wavelength=60.0, longest_wavelength=200.0, band_softness=softness
    )
    inverse = dataclasses.replace(band, band_inverted=True)
    parts = [initial_state(BASE.replace(layers=(layer,))).expected_plus for layer in (band, inverse)]
    whole = initial_state(BASE.replace(layers=(WIND,))).expected_plus
    assert np.sum(parts[0] + parts[1]) == pytest.approx(np.sum(whole), rel=1e-3)
    assert np.all(parts[0] <= whole * (1 + 1e-3))
    heights = [Ocean(BASE.replace(layers=(x,))).statistics().spectrum.m0 for x in (band, inverse, WIND)]
    assert heights[0] + heights[1] == pytest.approx(heights[2], rel=1e-9)
    assert 0.1 < heights[0] / heights[2] < 0.9


def test_a_sharp_band_holds_only_its_waves() -> None:
    band = dataclasses.replace(WIND, shortest_wavelength=100.0, longest_wavelength=150.0)
    state = initial_state(BASE.replace(layers=(band,)))
    wavelength = 2 * np.pi / np.where(state.grid.k > 0, state.grid.k, np.nan)
    outside = (wavelength < 90.0) | (wavelength > 170.0)
    assert not np.any(state.expected_plus[outside])
    assert np.any(state.expected_plus)
    with pytest.raises(ParameterError, match=r"shortest_wavelength = 100\.0: must be below"):
        WaveLayer(shortest_wavelength=100.0, longest_wavelength=50.0)


def test_a_soft_band_fades_by_its_width() -> None:
    band = dataclasses.replace(WIND, longest_wavelength=100.0, band_softness=2.0)
    weight = DirectionalSpectrum(band, Water(), "DEEP").energy_weight
    k = 2 * np.pi / np.array([49.0, 50 * np.sqrt(2), 100.0, 100 * np.sqrt(2), 201.0])
    np.testing.assert_allclose(weight(k), [1.0, 27 / 32, 0.5, 5 / 32, 0.0], atol=1e-4)


@pytest.mark.parametrize("depth", [1000.0, 20.0, 4.0])
@pytest.mark.parametrize("spectrum", ["TMA", "JONSWAP", "PIERSON_MOSKOWITZ", "PHILLIPS", "GENERALIZED_AB"])
def test_a_sea_state_is_what_was_asked_for(spectrum: str, depth: float) -> None:
    layer = dataclasses.replace(SWELL, spectrum=spectrum)
    statistics = Ocean(BASE.replace(layers=(layer,), water=Water(depth=depth))).statistics()
    assert statistics.significant_wave_height == pytest.approx(2.5, rel=1e-4)
    assert statistics.peak_period == pytest.approx(14.0, rel=1e-3)


def test_crossing_seas_of_the_reference() -> None:
    # long swell (Hs 2.5, Tp 14) with 5 m/s over 30 km has Hs 2.57;
    # crossing seas (Hs 2, Tp 11) with 10 m/s over 100 km have 2.93
    breeze = WaveLayer(wind_speed=5.0, fetch=30e3)
    assert Ocean(BASE.replace(layers=(SWELL, breeze))).statistics().significant_wave_height == pytest.approx(
        2.57, abs=0.006
    )
    old = dataclasses.replace(SWELL, significant_wave_height=2.0, peak_period=11.0)
    fresh = WaveLayer(wind_speed=10.0, fetch=100e3, swell=0.2)
    crossing = BASE.replace(layers=(old, fresh), water=Water(depth=200.0))
    assert Ocean(crossing).statistics().significant_wave_height == pytest.approx(2.93, abs=0.006)


# Amplitudes


def test_fixed_amplitudes_are_the_spectrum() -> None:
    state = initial_state(BASE.replace(amplitudes="DETERMINISTIC", layers=(WIND,)))
    np.testing.assert_allclose(np.abs(state.h_plus) ** 2, state.expected_plus, rtol=1e-9)
    statistics = Ocean(BASE.replace(amplitudes="DETERMINISTIC", layers=(WIND,))).statistics()
    assert statistics.seed.m0 == pytest.approx(statistics.resolved.m0)


def test_height_can_be_matched() -> None:
    tight = BASE.replace(domain_size=250.0)
    free, matched = (Ocean(tight.replace(match_height=m)).statistics() for m in (False, True))
    assert abs(free.seed.m0 / free.resolved.m0 - 1.0) > 0.05
    assert matched.seed.m0 == pytest.approx(matched.resolved.m0)
    assert matched.resolved.m0 == free.resolved.m0


# Matching a sea state


@pytest.mark.parametrize(
    ("wind", "fetch_km", "depth"),
    [(12.0, 150.0, 200.0), (25.0, 300.0, 15.0), (6.7, 48.0, 200.0), (75.0, 1250.0, 150.0)],
)
def test_wind_and_fetch_are_found_again(wind: float, fetch_km: float, depth: float) -> None:
    water = Water(depth=depth)
    sea = Ocean(
        OceanParameters(
            resolution=16, water=water, layers=(WaveLayer(wind_speed=wind, fetch=fetch_km * 1e3),)
        )
    )
    statistics = sea.statistics()
    match = layer_for_sea_state(statistics.significant_wave_height, statistics.peak_period, water)
    assert match.from_wind
    assert match.layer.wind_speed == pytest.approx(wind, rel=0.01)
    assert match.layer.fetch == pytest.approx(fetch_km * 1e3, rel=0.05)
    assert "wind of" in match.explanation


def test_swell_is_set_directly() -> None:
    match = layer_for_sea_state(2.5, 14.0, template=WaveLayer(wind_direction=1.0, swell=1.0))
    assert not match.from_wind
    assert "flatter than any wind sea" in match.explanation
    assert match.layer == WaveLayer(
        wind_direction=1.0, swell=1.0, definition="SEA_STATE", significant_wave_height=2.5, peak_period=14.0
    )
    assert "steeper" in layer_for_sea_state(10.0, 5.0).explanation
    with pytest.raises(ParameterError, match="peak_period = 0"):
        layer_for_sea_state(1.0, 0.0)


def _steepness_warnings(height: float, period: float, depth: float = 200.0) -> list[str]:
    layer = WaveLayer(definition="SEA_STATE", significant_wave_height=height, peak_period=period)
    sea = Ocean(OceanParameters(resolution=16, water=Water(depth=depth), layers=(layer,)))
    return [text for text in sea.statistics().warnings if "steepness" in text]


def test_a_sea_state_that_cannot_be_is_told_with_the_nearest_that_can() -> None:
    (text,) = _steepness_warnings(6.0, 4.0)
    numbers = [float(number) for number in re.findall(r"[0-9]+(?:\.[0-9]+)?", text)]
    _, height, period, steepness, limit, lower, same_period, same_height, longer = numbers
    assert (height, period, same_period, same_height) == (6.0, 4.0, 4.0, 6.0)
    # in deep water the wavelength is g T²/2π; of JONSWAP m0 = 0.305 α g²/ω⁴ with γ = 3.3, and α at most 0.076
    wavelength = 9.81 * 4.0**2 / (2.0 * math.pi)
    most = 4.0 * math.sqrt(0.305 * 0.076) * 9.81 / (0.5 * math.pi) ** 2
    assert steepness == pytest.approx(6.0 / wavelength, abs=0.005)
    assert lower == pytest.approx(most, abs=0.1)
    assert limit == pytest.approx(most / wavelength, abs=0.005)
    assert longer == pytest.approx(4.0 * math.sqrt(6.0 / most), abs=0.1)
    assert _steepness_warnings(lower, 4.0) == _steepness_warnings(6.0, longer) == []


def test_nearest_seas_of_shallow_water_can_be() -> None:
    (text,) = _steepness_warnings(3.0, 5.0, depth=3.0)
    found = re.search(r"Nearest: (\S+) m at 5 s, or 3 m at (\S+) s", text)
    assert found is not None
    lower, longer = map(float, found.groups())
    assert lower < 3.0 < 5.0 < longer
    assert _steepness_warnings(lower, 5.0, 3.0) == _steepness_warnings(3.0, longer, 3.0) == []


def test_wind_is_matched_at_its_height() -> None:
    match = layer_for_sea_state(3.15, 7.58, template=WaveLayer(wind_height=19.5))
    assert match.from_wind
    # U_19.5 = U_10 (1 + 2.5 √C ln 1.95), C = (0.8 + 0.065 · 12)·10⁻³: 12 m/s become 12.80
    assert match.layer.wind_speed == pytest.approx(12.80, rel=0.01)
