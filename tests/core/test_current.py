# SPDX-License-Identifier: GPL-3.0-or-later
"""Currents: every wave turns with σ + k·U, in loops too; foam drifts along; what is keyed goes on from frame
to frame; a measured sea in a current keeps its energy."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from ocean_tweak.core import Ocean, OceanParameters, ParameterError, Places, WaveLayer
from ocean_tweak.core.data.raster import Raster
from ocean_tweak.core.parameters.ocean_parameters import (
    Current,
    HeroWave,
    ImageLayer,
    Patch,
    PathSample,
    WakeLayer,
    WindFieldLayer,
)
from ocean_tweak.core.parameters.shot import Animation, Shot
from ocean_tweak.core.statistics.sea_spectrum import SeaSpectrum
from ocean_tweak.core.statistics.sea_statistics import spectrum_state
from tests.core.test_measured import measured, sea_of

SEA = OceanParameters(resolution=64, domain_size=200.0, seed=3)
NONE = WaveLayer(muted=True)
U = Current(speed=2.0, direction=0.6)
IMAGE = ImageLayer(image=Raster(np.random.default_rng(0).uniform(size=(32, 32))), animation="DISPERSION")
KINDS = {
    "waves": (WaveLayer(),),
    "image": (NONE, IMAGE),
    "image that moves": (NONE, IMAGE.changed(animation="TRANSLATION")),
}


def test_one_wave_turns_with_sigma_and_the_current() -> None:
    """The phase of each of the grid's waves, from two coefficients a moment apart, in deep water."""
    one_way = WaveLayer(spreading="COSINE_2S", spreading_exponent=400.0, swell=0.0, wind_direction=0.9)
    sea = SEA.replace(dispersion="DEEP", current=U, layers=(one_way,))
    ocean, dt = Ocean(sea, precision="double"), 0.05
    first, second = (np.fft.rfft2(ocean.surface(t).displacement[..., 2]) for t in (7.0, 7.0 + dt))
    state = ocean.initial_state
    only_along = np.abs(state.h_minus) < 1e-4 * np.abs(state.h_plus)
    strong = only_along & (np.abs(first) > 1e-2 * np.abs(first).max()) & state.grid.usable
    assert np.count_nonzero(strong) > 20
    turned = -np.angle(second[strong] / first[strong]) / dt
    kx, ky = (np.broadcast_to(k, first.shape)[strong] for k in (state.grid.kx, state.grid.ky))
    expected = np.sqrt(9.81 * np.hypot(kx, ky)) + 2.0 * (kx * math.cos(0.6) + ky * math.sin(0.6))
    np.testing.assert_allclose(turned, expected, atol=1e-3)


@pytest.mark.parametrize("layers", KINDS.values(), ids=KINDS)
def test_all_waves_are_carried_and_velocities_are_rates(layers: tuple[WaveLayer, ...]) -> None:
    """A uniform current is a shift of the whole sea; a velocity is a difference of two displacements."""
    ocean = Ocean(SEA.replace(layers=layers, current=U), precision="double")
    before, after = (ocean.surface(9.0 + dt).displacement for dt in (-1e-3, 1e-3))
    rates = ocean.surface(9.0, {"velocity"}).velocity
    assert np.abs(rates).max() > 0.01
    np.testing.assert_allclose((after - before) / 2e-3, rates, atol=2e-4 * np.abs(rates).max())
    still = Ocean(SEA.replace(layers=layers), precision="double")
    x, y = np.random.default_rng(1).uniform(0.0, 200.0, (2, 20))
    ux, uy = U.velocity
    moved = still.height_at(x - 9.0 * ux, y - 9.0 * uy, 9.0, "exact")
    np.testing.assert_allclose(ocean.height_at(x, y, 9.0, "exact"), moved, atol=1e-4)


def test_waves_of_a_wind_field_are_carried_from_where_they_were_born() -> None:
    """As many particles, each further by U times its age: where none is older, none is further."""
    from ocean_tweak.core.waves.wind_field.wind_waves import WindWaves

    sea = SEA.replace(layers=(NONE, WindFieldLayer(wind_speed=20.0)))
    still, carried = (WindWaves(each, each.of(WindFieldLayer)).particles(20.0)
                      for each in (sea, sea.replace(current=U)))  # fmt: skip
    ux, uy = U.velocity
    age = (carried.x - still.x) / ux
    assert age.min() >= 0.0
    assert age.max() > 1.0
    np.testing.assert_allclose(carried.y - still.y, age * uy, atol=1e-9)
    np.testing.assert_allclose(carried.velocity_x - still.velocity_x, ux)


def test_a_loop_stays_a_loop() -> None:
    """All frequencies are whole numbers of turns, none further than half a turn from σ + k·U."""
    sea = SEA.replace(current=U, loop_duration=Fraction(10))
    ocean = Ocean(sea)
    np.testing.assert_array_equal(ocean.surface(0).displacement, ocean.surface(10).displacement)
    looped, free = (Ocean(each).initial_state for each in (sea, sea.replace(loop_duration=None)))
    for name in ("omega", "omega_against"):
        turns = getattr(looped, name) * 10.0 / (2.0 * np.pi)
        np.testing.assert_allclose(turns, np.rint(turns), atol=1e-9)
        np.testing.assert_allclose(turns, getattr(free, name) * 10.0 / (2.0 * np.pi), atol=0.5 + 1e-9)
    assert ocean.statistics().loop_speed_change is not None


def test_a_hero_wave_meets_its_focus_in_any_current() -> None:
    hero = HeroWave(x=100.0, y=90.0, time=3.0, wavelength=40.0, group_width=60.0, crest_height=1.0)
    for current in (None, U, Current(speed=3.0, direction=-2.0, carried_x=40.0, carried_y=-7.0)):
        for loop in (None, Fraction(20)):
            ocean = Ocean(SEA.replace(layers=(NONE, hero), current=current, loop_duration=loop))
            assert float(ocean.height_at(100.0, 90.0, 3.0, "exact")) == pytest.approx(1.0, abs=1e-4)


def test_foam_drifts_with_the_water_and_covers_as_much() -> None:
    still, carried = (Ocean(each).foam_model for each in (SEA, SEA.replace(current=U)))
    assert np.subtract(carried.drift, still.drift) == pytest.approx(U.velocity)
    assert carried.threshold == pytest.approx(still.threshold, rel=1e-9)
    assert carried.frequency == pytest.approx(still.frequency, rel=1e-9)


def test_patches_are_carried_in_their_own_axes() -> None:
    """A patch that is turned moves as one that is not: their sum is shifted as a whole."""
    patches = (Patch(domain_size=200.0, resolution=64, shortest_wavelength=20.0),
               Patch(domain_size=60.0, resolution=64, longest_wavelength=20.0, rotation=0.7))  # fmt: skip
    sea = OceanParameters(patches=patches, seed=5)
    x, y = np.random.default_rng(1).uniform(0.0, 200.0, (2, 12))
    ux, uy = U.velocity
    moved = Ocean(sea).height_at(x - 5.0 * ux, y - 5.0 * uy, 5.0, "exact")
    found = Ocean(sea.replace(current=U)).height_at(x, y, 5.0, "exact")
    np.testing.assert_allclose(found, moved, atol=2e-3)


def test_no_current_is_no_change() -> None:
    assert "current" not in SEA.to_json()
    still = Ocean(SEA).surface(4.0, {"displacement", "velocity", "foam"})
    for nothing in (Current(), Current(direction=2.0)):
        same = Ocean(SEA.replace(current=nothing)).surface(4.0, {"displacement", "velocity", "foam"})
        for name in ("displacement", "velocity", "foam"):
            np.testing.assert_array_equal(getattr(same, name), getattr(still, name))


def test_a_keyed_current_carries_the_sea_on() -> None:
    """From frame to frame by what the current is between, by an independent sum; any frame alone."""
    speeds = (0.0, 0.0, 1.0, 3.0, 3.0, 0.0)
    turns = (0.0, 0.0, 0.0, 0.5, 1.0, 1.0)
    samples = (("current.direction", turns), ("current.speed", speeds))
    shot = Shot(SEA.replace(current=Current()), Animation(1, samples))
    vectors = np.array(speeds)[:, np.newaxis] * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    way = np.concatenate(([[0.0, 0.0]], np.cumsum(0.5 * (vectors[1:] + vectors[:-1]) / 24.0, axis=0)))
    for frame in range(1, 7):
        moment = shot.at(frame)
        current = moment.parameters.current
        assert current is not None
        assert current.carried(float(moment.time)) == pytest.approx(way[frame - 1], abs=1e-9)
    assert shot.at(Fraction(7, 2)).parameters.current is not None
    with pytest.raises(ParameterError, match="constant over a loop"):
        Shot(SEA.replace(current=U, loop_duration=Fraction(10)), shot.animation)


@pytest.mark.parametrize("speed", [1.0, 3.0])
@pytest.mark.parametrize("towards", [0.7, 0.7 + math.pi, 2.0])
def test_measured_frequencies_are_those_that_a_fixed_place_sees(speed: float, towards: float) -> None:
    """The energy is that of the file but for what is blocked; waves that come up against the current are
    shorter than their period says, and those it carries are longer."""
    sea = sea_of(measured(), size=900.0, resolution=256)
    still = spectrum_state(SeaSpectrum(sea))
    carried = sea.replace(current=Current(speed=speed, direction=towards))
    (spectrum,) = SeaSpectrum(carried).layers
    state = spectrum_state(SeaSpectrum(carried))
    left = state.m0 / still.m0
    assert left == pytest.approx(1.0 - spectrum.blocked_share, abs=0.003)
    if towards == 0.7:
        assert state.peak_wavelength > 1.1 * still.peak_wavelength
    elif towards > 3.0:
        assert state.peak_wavelength < 0.9 * still.peak_wavelength
    statistics = Ocean(carried).statistics()
    assert statistics.resolved.m0 == pytest.approx(state.m0, rel=0.02)
    told = [warning for warning in statistics.warnings if "blocks" in warning]
    assert bool(told) == (spectrum.blocked_share > 0.0005)
    relative = measured(absolute=False)
    assert spectrum_state(SeaSpectrum(sea_of(relative).replace(current=carried.current))).m0 == still.m0


def test_what_a_current_blocks_in_deep_water() -> None:
    """Against U, no wave with ω > g/4U comes up (Phillips 1977): at 4 m/s no wave above 0.0976 Hz."""
    narrow = measured(r1=0.999, r2=0.996, towards=0.0)
    against = Current(speed=4.0, direction=math.pi)
    (spectrum,) = SeaSpectrum(sea_of(narrow).replace(current=against, dispersion="DEEP")).layers
    f, width = narrow.bins
    energy = narrow.energy_at(0.0) * width
    expected = energy[f > 9.81 / (4.0 * 4.0) / (2.0 * math.pi)].sum() / energy.sum()
    assert spectrum.blocked_share == pytest.approx(expected, abs=0.02)


def test_a_wake_lies_in_the_water_that_moves() -> None:
    """A ship over ground in a current leaves what one leaves in still water that goes the path through it."""
    path = tuple(PathSample(t, x=5.0 * t, y=0.2 * t * t) for t in np.arange(0.0, 41.0, 2.0))
    ux, uy = U.velocity
    through = tuple(PathSample(p.time, x=p.x - ux * p.time, y=p.y - uy * p.time) for p in path)
    ship = WakeLayer(path=path, area_size=512.0, area_resolution=256, length=40.0, beam=8.0)
    calm = SEA.replace(layers=(WaveLayer(wind_speed=0.0), ship), current=U)
    still = SEA.replace(layers=(WaveLayer(wind_speed=0.0), ship.changed(path=through)))
    x, y = np.random.default_rng(4).uniform(-80.0, 80.0, (2, 40)) + np.array([[150.0], [150.0]])
    shown = {"displacement", "velocity", "foam"}
    ground = Ocean(calm).surface(36.0, shown, on=Places(x, y))
    water = Ocean(still).surface(36.0, shown, on=Places(x - 36.0 * ux, y - 36.0 * uy))
    assert np.abs(water.displacement[..., 2]).max() > 0.05
    np.testing.assert_allclose(ground.displacement, water.displacement, atol=1e-4)
    np.testing.assert_allclose(ground.foam, water.foam, atol=1e-3)
    before, after = (Ocean(calm).surface(36.0 + dt, on=Places(x, y)).displacement for dt in (-0.02, 0.02))
    error = ground.velocity - (after - before) / 0.04  # fields are read between samples, 2 m apart
    assert np.sqrt(np.mean(error**2)) < 0.02 * np.abs(ground.velocity).max()
    with pytest.raises(ParameterError, match="area_follows"):
        SEA.replace(layers=(NONE, ship.changed(area_follows=False)), current=U)
