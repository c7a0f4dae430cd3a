# SPDX-License-Identifier: GPL-3.0-or-later
"""Hero waves: where, when and how high they are, how they run, and that they add to the sea."""

from __future__ import annotations

import dataclasses
import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from ocean_tweak.core import HeroWave, Ocean, OceanParameters, ParameterError, Patch, Water, WaveLayer
from ocean_tweak.core.parameters.fingerprint import frame_fingerprint
from ocean_tweak.core.parameters.shot import Animation, Shot
from ocean_tweak.core.waves.hero.group import needed_samples
from tests.layers import layers_of, with_layers

SIZE, SAMPLES = 400.0, 256
#: deviation of a Gaussian whose width at half its height is 1
DEVIATION = 1.0 / math.sqrt(8.0 * math.log(2.0))

Array = NDArray[np.floating]


def sea(*waves: HeroWave, **changes: Any) -> OceanParameters:
    """Hero waves alone, on calm and by default deep water without surface tension."""
    values: dict[str, Any] = {
        "resolution": SAMPLES, "domain_size": SIZE, "choppiness": 0.0, "dispersion": "DEEP",
        "layers": (WaveLayer(muted=True), *waves),
    }  # fmt: skip
    return OceanParameters(**(values | changes))


def height(parameters: OceanParameters, time: float) -> Array:
    return Ocean(parameters, "double").surface(time).displacement[..., 2]


def along_x(elevation: Array, size: float = SIZE) -> tuple[NDArray[np.complexfloating], float]:
    """Of waves along x: their analytic signal on the middle row, and the middle of the group in m.

    The signal's size is the envelope; the circular mean of its square is the middle.
    """
    row = elevation[len(elevation) // 2]
    spectrum = np.fft.fft(row)
    spectrum[len(row) // 2 :] = 0.0
    signal = 2.0 * np.fft.ifft(spectrum)
    angles = 2.0 * np.pi * np.arange(len(row)) / len(row)
    place = np.angle(np.sum(np.abs(signal) ** 2 * np.exp(1j * angles))) * size / (2.0 * np.pi)
    return signal, float(place)


# the focus


def test_crest_stands_at_its_place_and_time_with_its_height() -> None:
    """The place is a sample: 3/8 and 5/8 of the patch."""
    wave = HeroWave(
        x=150.0, y=250.0, time=12.5, direction=0.7, wavelength=50.0, crest_height=2.75, group_width=90.0
    )
    at_focus = height(sea(wave), 12.5)
    assert np.unravel_index(np.argmax(at_focus), at_focus.shape) == (160, 96)
    assert at_focus[160, 96] == pytest.approx(2.75, rel=1e-12)
    single = Ocean(sea(wave)).surface(12.5).displacement[..., 2]
    assert single[160, 96] == pytest.approx(2.75, rel=2e-6)
    assert height(sea(wave), 9.0).max() < 2.75
    assert height(sea(wave), 16.0).max() < 2.75


def test_surface_at_the_focus_is_the_formula() -> None:
    wave = HeroWave(direction=-0.4, wavelength=40.0, crest_height=2.0, group_length=2.5, group_width=70.0)
    x = np.arange(SAMPLES) * SIZE / SAMPLES - 200.0
    X, Y = np.meshgrid(x, x)
    xi = X * math.cos(-0.4) + Y * math.sin(-0.4)
    zeta = Y * math.cos(-0.4) - X * math.sin(-0.4)
    envelope = np.exp(-0.5 * ((xi / (100.0 * DEVIATION)) ** 2 + (zeta / (70.0 * DEVIATION)) ** 2))
    for phase in (0.0, 1.0):
        expected = 2.0 * envelope * np.cos(2.0 * math.pi / 40.0 * xi + phase)
        shown = height(sea(dataclasses.replace(wave, phase=phase)), 0.0)
        np.testing.assert_allclose(shown, expected, atol=5e-4)


def test_group_is_half_as_high_at_the_ends_of_its_length_and_width() -> None:
    """Of a wave along x by 8 wavelengths of 25 m, 4 crests from the focus; and 40 m to its side."""
    wave = HeroWave(wavelength=25.0, group_length=8.0, group_width=80.0, crest_height=1.0)
    shown = height(sea(wave, resolution=320), 0.0)
    assert shown[160, 160 + 80] == pytest.approx(0.5, abs=0.002)
    assert shown[160 + 32, 160] == pytest.approx(0.5, abs=1e-4)


def test_phase_of_half_a_turn_is_a_trough() -> None:
    wave = HeroWave(crest_height=2.0, phase=math.pi)
    shown = height(sea(wave), 0.0)
    assert shown[128, 128] == pytest.approx(-2.0, rel=1e-12)


def test_patch_repeats() -> None:
    wave = HeroWave(x=30.0, y=390.0, time=3.0)
    beyond = dataclasses.replace(wave, x=30.0 - 2 * SIZE, y=390.0 + SIZE)
    np.testing.assert_allclose(height(sea(wave), 5.0), height(sea(beyond), 5.0), atol=1e-9)


# on its way


@pytest.mark.parametrize(
    ("relation", "water", "wavelength", "phase_speed", "group_speed"),
    [  # by hand: √(g/k); √(g tanh kh/k) and its n = ½(1 + 2kh/sinh 2kh)
        ("DEEP", Water(depth=200.0), 25.0, 6.247620, 3.123810),
        ("FINITE_DEPTH", Water(depth=5.0), 50.0, 6.593493, 5.862770),
        ("FINITE_DEPTH", Water(depth=1.0), 40.0, 3.119312, 3.093949),
    ],
)
def test_crests_and_group_run_at_their_speeds(
    relation: str, water: Water, wavelength: float, phase_speed: float, group_speed: float
) -> None:
    """Of a long group along x: crests by how far the phase turns, the group by its middle."""
    wave = HeroWave(
        x=200.0, wavelength=wavelength, group_length=200.0 / wavelength, group_width=400.0, crest_height=1.0
    )
    parameters = sea(wave, dispersion=relation, water=water)
    (told,) = HeroWave.outlook(parameters).waves
    assert told.phase_speed == pytest.approx(phase_speed, rel=1e-4)
    assert told.group_speed == pytest.approx(group_speed, rel=1e-4)
    (_, before), (signal, now), (later_signal, after) = (
        along_x(height(parameters, t)) for t in (-6.0, 0.0, 0.25)
    )
    _, after = along_x(height(parameters, 6.0))
    way = (after - before) % SIZE
    assert way / 12.0 == pytest.approx(group_speed, rel=0.01)
    assert now % SIZE == pytest.approx(200.0, abs=0.01)
    turned = -np.angle(np.sum(later_signal * np.conj(signal)))
    assert turned / (2.0 * math.pi) * wavelength / 0.25 == pytest.approx(phase_speed, rel=0.01)


def test_crests_run_towards_the_direction() -> None:
    wave = HeroWave(x=200.0, y=200.0, direction=math.radians(120.0), wavelength=40.0, group_width=80.0)
    (told,) = HeroWave.outlook(sea(wave)).waves
    later = height(sea(wave), 20.0)
    x = 2.0 * np.pi * np.arange(SAMPLES) / SAMPLES
    energy = later**2
    place = [np.angle(np.sum(energy.sum(axis=axis) * np.exp(1j * x))) % (2.0 * np.pi) for axis in (0, 1)]
    expected = told.place(20.0)
    assert expected == pytest.approx((200.0 - 79.0 / 2.0, 200.0 + 79.0 * math.sqrt(0.75)), abs=0.1)
    np.testing.assert_allclose(np.array(place) * SIZE / (2.0 * np.pi), expected, atol=1.0)


@pytest.mark.parametrize(("relation", "depth"), [("DEEP", 200.0), ("FINITE_DEPTH", 6.0)])
def test_group_disperses_as_physics_has_it(relation: str, depth: float) -> None:
    """Of a Gaussian group to second order: lower by ⁴√(1 + (ω″t/σ²)²) · ⁴√(1 + (ω′t/k0τ²)²)."""
    wavelength, time = 25.0, 25.0
    wave = HeroWave(wavelength=wavelength, group_length=4.0, group_width=60.0, crest_height=1.0)
    parameters = sea(wave, dispersion=relation, water=Water(depth=depth))
    k0, step = 2.0 * math.pi / wavelength, 1e-4

    def omega(k: float) -> float:
        return math.sqrt(9.81 * k * (math.tanh(k * depth) if relation == "FINITE_DEPTH" else 1.0))

    rate = (omega(k0 + step) - omega(k0 - step)) / (2.0 * step)
    bend = (omega(k0 + step) - 2.0 * omega(k0) + omega(k0 - step)) / step**2
    along = 1.0 + (bend * time / (100.0 * DEVIATION) ** 2) ** 2
    across = 1.0 + (rate * time / (k0 * (60.0 * DEVIATION) ** 2)) ** 2
    for t in (-time, time):
        signal, _ = along_x(height(parameters, t))
        assert np.max(np.abs(signal)) == pytest.approx((along * across) ** -0.25, rel=0.01)
    assert along * across > 1.2  # or there was nothing to see


def test_energy_is_that_of_the_gaussian() -> None:
    """∫η² = A²πστ/2 · (1 + exp(-k0²σ²)), at any time: Parseval over the coefficients."""
    wave = HeroWave(
        time=4.0, direction=0.5, wavelength=45.0, group_length=1.5, group_width=80.0, crest_height=2.0
    )
    state = Ocean(sea(wave), "double").initial_state
    energy = np.sum((np.abs(state.h_plus) ** 2 + np.abs(state.h_minus) ** 2) * state.grid.multiplicity)
    sigma, tau = 67.5 * DEVIATION, 80.0 * DEVIATION
    # so short a group holds some waves along -k too; they are in step with the others at the focus alone
    expected = 0.5 * math.pi * sigma * tau * 2.0**2
    assert energy * SIZE**2 == pytest.approx(expected, rel=1e-3)
    mean_square = np.mean(height(sea(wave), 4.0) ** 2)
    bracket = 1.0 + math.exp(-((2.0 * math.pi / 45.0 * sigma) ** 2))
    assert mean_square * SIZE**2 == pytest.approx(expected * bracket, rel=1e-3)


# with the sea


def test_displacement_and_velocity_add_to_the_seas(windy: OceanParameters) -> None:
    wave = HeroWave(time=2.0, wavelength=160.0, group_width=300.0, crest_height=6.0, direction=2.0)
    alone = with_layers(windy.replace(layers=(WaveLayer(muted=True),)), HERO_WAVE=(wave,))
    both = with_layers(windy, HERO_WAVE=(wave,))
    parts = [
        Ocean(parameters, "double").surface(3.0, {"displacement", "velocity"})
        for parameters in (windy, alone, both)
    ]
    for name in ("displacement", "velocity"):
        of_sea, of_wave, of_both = (getattr(part, name) for part in parts)
        assert np.abs(of_wave).max() > 1.0
        np.testing.assert_allclose(of_both, of_sea + of_wave, atol=1e-9)


@pytest.mark.parametrize("amplitudes", ["RANDOM", "DETERMINISTIC"])
def test_neither_amplitudes_nor_matched_height_change_a_hero_wave(
    windy: OceanParameters, amplitudes: str
) -> None:
    wave = HeroWave(wavelength=160.0, group_width=300.0)
    calm = windy.replace(amplitudes=amplitudes, match_height=True)
    added = height(with_layers(calm, HERO_WAVE=(wave,)), 1.0) - height(calm, 1.0)
    np.testing.assert_allclose(
        added,
        height(with_layers(windy.replace(layers=(WaveLayer(muted=True),)), HERO_WAVE=(wave,)), 1.0),
        atol=1e-9,
    )


def test_expected_sea_and_its_foam_are_without_the_hero_wave(windy: OceanParameters) -> None:
    both = with_layers(windy, HERO_WAVE=(HeroWave(wavelength=160.0, group_width=300.0, crest_height=10.0),))
    plain, placed = Ocean(windy), Ocean(both)
    assert placed.statistics().resolved == plain.statistics().resolved
    assert placed.statistics().spectrum == plain.statistics().spectrum
    assert placed.statistics().seed.m0 > plain.statistics().seed.m0
    assert placed.foam_model.threshold == plain.foam_model.threshold


def test_a_hero_wave_compresses_its_crest_and_foams(windy: OceanParameters) -> None:
    """Foam lies at the crest of a steep wave, at the focus: sample (32, 16)."""
    windy = windy.replace(resolution=128, foam=dataclasses.replace(windy.foam, half_life=0.5, drift=0.0))
    wave = HeroWave(x=200.0, y=400.0, wavelength=80.0, group_width=300.0, crest_height=8.0)
    surface = Ocean(with_layers(windy, HERO_WAVE=(wave,))).surface(0.0, {"cusp", "foam"})
    assert surface.foam[62:67, 31:34].mean() > 0.5
    assert Ocean(windy).surface(0.0, {"foam"}).foam[62:67, 31:34].mean() < 0.2
    assert np.unravel_index(np.argmax(surface.cusp), surface.cusp.shape)[1] in range(26, 40)


def test_a_sea_of_a_hero_wave_alone_is_not_called_flat() -> None:
    assert not any("flat" in warning for warning in Ocean(sea(HeroWave())).statistics().warnings)
    assert any("flat" in warning for warning in Ocean(sea(HeroWave(muted=True))).statistics().warnings)


def test_loop_ends_where_it_began_and_keeps_the_focus() -> None:
    parameters = sea(HeroWave(time=10.0, crest_height=2.0), loop_duration=Fraction(90))
    ocean = Ocean(parameters)
    start, end, focus = (ocean.surface(t).displacement[..., 2] for t in (0, 90, 100))
    np.testing.assert_array_equal(start, end)
    assert focus[128, 128] == pytest.approx(2.0, rel=1e-5)
    assert not HeroWave.outlook(parameters).warnings
    (short,) = HeroWave.outlook(sea(HeroWave(), loop_duration=Fraction(40))).waves
    assert "longer than the loop" in short.warnings[0]


def test_same_wave_at_any_resolution_that_holds_it() -> None:
    wave = HeroWave(x=120.0, y=77.0, time=5.0, direction=1.0, wavelength=30.0, group_width=40.0)
    coarse, fine = (height(sea(wave, resolution=n), 8.0) for n in (128, 384))
    np.testing.assert_allclose(fine[::3, ::3], coarse, atol=1e-12)


def test_coarser_samples_leave_out_what_they_do_not_hold() -> None:
    long, short = HeroWave(wavelength=80.0), HeroWave(wavelength=20.0)
    coarse = sea(long, short).at_resolution(48)
    assert [wave.muted for wave in layers_of(coarse, "HERO_WAVE")] == [False, True]
    np.testing.assert_array_equal(height(coarse, 1.0), height(sea(long, resolution=48), 1.0))
    assert sea(long, short).at_resolution(SAMPLES) == sea(long, short)
    halves = (
        Patch(400.0, shortest_wavelength=60.0, resolution=SAMPLES),
        Patch(90.0, longest_wavelength=60.0, resolution=SAMPLES),
    )
    of_patches = sea(long, short).replace(patches=halves)
    assert [wave.muted for wave in layers_of(of_patches.on_one_grid(48), "HERO_WAVE")] == [False, True]


# as parameters


def test_a_sea_without_hero_waves_is_written_as_before_there_were_any() -> None:
    assert "hero_waves" not in OceanParameters().to_dict()
    assert OceanParameters.from_dict({"hero_waves": []}) == OceanParameters()


def test_hero_waves_survive_json_and_make_frames_of_their_own() -> None:
    parameters = sea(HeroWave(x=1.5, phase=0.25), HeroWave(muted=True))
    assert OceanParameters.from_json(parameters.to_json()) == parameters
    assert len(parameters.active(HeroWave)) == 1
    prints = {frame_fingerprint(Shot(sea(*waves)), 1) for waves in ((), (HeroWave(),), (HeroWave(time=1.0),))}
    assert len(prints) == 3
    shot = Shot(parameters, Animation(1, (("choppiness", (0.5, 1.0)),)))
    assert shot.at(2).parameters == parameters.replace(choppiness=1.0)
    with pytest.raises(ParameterError, match="animate ocean_time"):
        Animation(1, (("hero_waves.0.crest_height", (1.0, 2.0)),))


@pytest.mark.parametrize(
    ("wave", "where", "reason"),
    [
        ({"wavelength": 401.0, "group_width": 300.0}, "wavelength", "make it shorter, or the domain larger"),
        ({"group_length": 7.0}, "group_length", "is 420 m in a domain of 400 m"),
        ({"group_width": 401.0}, "group_width", "make it smaller, or the domain larger"),
        ({"group_width": 20.0}, "group_width", "at least 30 m"),
        ({"wavelength": 6.2, "group_length": 8.0}, "wavelength", "needs 260 samples"),
        ({"wavelength": 6.3, "group_length": 1.0}, "wavelength", "and the resolution is 256"),
        ({"group_length": 0.5}, "group_length", "must be from 1"),
        ({"crest_height": -1.0}, "crest_height", "must be from 0"),
    ],
)
def test_what_cannot_be_is_refused_by_name(wave: dict[str, Any], where: str, reason: str) -> None:
    data = sea().to_dict()
    with pytest.raises(ParameterError) as caught:
        OceanParameters.from_dict(data | {"hero_waves": [{"muted": True}, wave]})
    assert caught.value.field == f"layers.2.{where}"
    assert reason in str(caught.value)


def test_muted_waves_may_be_any_size() -> None:
    assert not sea(HeroWave(wavelength=1000.0, group_width=600.0, muted=True)).active(HeroWave)


def test_waves_that_would_break_are_told() -> None:
    """In deep water H/λ = 0.142 (Miche 1944): of 60 m, crests of half of 8.52 m."""
    assert not HeroWave.outlook(sea(HeroWave(crest_height=4.25))).warnings
    (steep,) = HeroWave.outlook(sea(HeroWave(crest_height=4.27))).waves
    assert "break" in steep.warnings[0]
    shallow = sea(HeroWave(crest_height=2.0), water=Water(depth=3.0))
    assert "Lower the crest to 1.3 m" in HeroWave.outlook(shallow).warnings[0]


# any of them

WAVES = st.builds(
    HeroWave,
    x=st.floats(-1e4, 1e4), y=st.floats(-1e4, 1e4), time=st.floats(-1e4, 1e4),
    direction=st.floats(-10.0, 10.0), wavelength=st.floats(40.0, 100.0), crest_height=st.floats(0.01, 10.0),
    group_length=st.floats(1.0, 4.0), group_width=st.floats(50.0, SIZE),
)  # fmt: skip


def test_the_samples_that_hold_a_wave_are_those_that_are_not_refused() -> None:
    """In viewport resolutions it is left out where a sea of as few samples would be refused."""
    wave = HeroWave(x=200.0, y=200.0, wavelength=50.0, group_length=2.0, group_width=120.0)
    for samples in range(8, 128, 2):
        try:
            sea(wave, resolution=samples)
            refused = False
        except ParameterError:
            refused = True
        assert wave.is_held(sea(), samples) is not refused


@settings(max_examples=40, deadline=None, derandomize=True)
@given(wave=WAVES, relation=st.sampled_from(["DEEP", "CAPILLARY"]), loop=st.booleans())
def test_any_wave_has_its_crest_at_its_focus(wave: HeroWave, relation: str, loop: bool) -> None:
    """Nowhere and never is it higher; and where it is on a sample, that is the crest."""
    samples = needed_samples(wave, SIZE)
    spacing = SIZE / samples
    wave = dataclasses.replace(wave, x=round(wave.x / spacing) * spacing, y=round(wave.y / spacing) * spacing)
    parameters = sea(
        wave, resolution=samples, dispersion=relation, loop_duration=Fraction(60) if loop else None
    )
    shown = height(parameters, wave.time)
    row, column = round(wave.y / spacing) % samples, round(wave.x / spacing) % samples
    assert shown[row, column] == pytest.approx(wave.crest_height, rel=1e-7)
    assert shown.max() <= wave.crest_height * (1.0 + 1e-7)
    assert np.abs(height(parameters, wave.time + 7.3)).max() <= wave.crest_height * (1.0 + 1e-7)
    assert abs(shown.mean()) < 1e-9
