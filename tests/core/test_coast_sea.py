# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea over a bed: the open sea's waves before it, what the bed makes of them over it."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from ocean_tweak.core import (
    Area,
    Current,
    Mask,
    Ocean,
    OceanParameters,
    ParameterError,
    Patch,
    PathSample,
    Places,
    Raster,
    WakeLayer,
    WaveLayer,
)
from ocean_tweak.core.foam.model import Whitecaps
from ocean_tweak.core.numerics.memo import MEMO
from ocean_tweak.core.parameters.patch_seas import open_sea
from ocean_tweak.core.parameters.shot import Animation, Shot
from ocean_tweak.core.sea.coast_outlook import coast_outlook
from ocean_tweak.core.sea.over_bed import with_whitecaps
from ocean_tweak.core.waves.coast.beds import BEDS, SPACING, grid
from ocean_tweak.core.waves.coast.breakers import broken_share
from ocean_tweak.core.waves.coast.parameters import repeats_after
from tests.coasts import BEACH, DEEP, SAMPLES, SIDE, sea

STEP = SIDE / SAMPLES
ALL = ("displacement", "slope", "velocity", "strain")


def height(parameters: OceanParameters) -> float:
    return Ocean(open_sea(parameters)).statistics().resolved.significant_wave_height


def test_behind_water_there_is_the_open_sea_again() -> None:
    """Where a bed ends in water, past an islet, as before it: with the open sea's bytes."""
    x, y = np.meshgrid(np.linspace(-100.0, 100.0, 101), np.linspace(-100.0, 100.0, 101))
    parameters = sea(np.minimum(15.0, 0.3 * (np.hypot(x, y) - 20.0)))
    behind = Places(*np.meshgrid(210.0 + STEP * np.arange(10), STEP * np.arange(20)))
    over_bed, open_one = (
        Ocean(each).surface(7.3, ALL, behind) for each in (parameters, open_sea(parameters))
    )
    for name in ALL:
        assert_array_equal(over_bed[name] + 0.0, open_one[name] + 0.0)


def test_the_two_ends_of_a_bed_meet() -> None:
    """Its depth, 12 m at one end of the shore and 6 m at the other, has no step where the sea repeats."""
    bed = np.linspace(12.0, 6.0, 101)[:, np.newaxis] * np.ones(101)
    ground = Ocean(sea(bed)).coast.ground  # type: ignore[union-attr]
    last = ground.depth[-1]
    assert last[len(last) // 2] == pytest.approx(9.0, abs=0.2)
    assert np.abs(last - np.roll(last, 1)).max() < 0.6
    assert np.ptp(last) > 4.0


@pytest.mark.parametrize("patches", [(), (Patch(SIDE, resolution=SAMPLES, rotation=0.4),)])
def test_the_rim_has_the_open_sea_s_waves_and_before_it_their_bytes(patches: tuple[Patch, ...]) -> None:
    parameters = sea(patches=patches)
    # the axes of the patch: the bed's too
    along, across = np.meshgrid(-160.0 - 0.0 * STEP + STEP * np.arange(96), STEP * np.arange(24))
    along = STEP * np.round(along / STEP)
    c, s = (np.cos(0.4), np.sin(0.4)) if patches else (1.0, 0.0)
    there = Places(c * along - s * across, s * along + c * across)
    ocean = Ocean(parameters)
    over_bed, open_one = (each.surface(7.3, ALL, there) for each in (ocean, Ocean(open_sea(parameters))))
    assert ocean.coast is not None
    share = ocean.coast.shares(*(each.ravel() for each in (there.x, there.y)))
    assert share.value.min() >= 0.0
    before = along < -80.0 - STEP
    # as far as derivatives reach before the rim's last quarter
    comes_in = along < -80.0 + 0.75 * 40.0 - 4.0 * STEP
    significant = height(parameters)
    for name in ALL:
        own, other = over_bed[name], open_one[name]
        assert_array_equal(own[before] + 0.0, other[before] + 0.0)
        scale = significant if name == "displacement" else np.abs(other).max()
        assert np.abs(own - other)[comes_in].max() <= (1e-5 if name == "displacement" else 1e-4) * scale
    assert np.abs(over_bed.displacement - open_one.displacement)[~comes_in].max() > 0.05 * significant


def test_a_frame_alone_is_that_of_a_sequence_and_the_sea_repeats() -> None:
    parameters, area = sea(), Area(150.0, 40, (-50.0, 3.0))
    sequence = Ocean(parameters)
    for time in (0.0, 1.0, 2.0):
        last = sequence.surface(time, ALL, area)
    alone = Ocean(parameters).surface(2.0, ALL, area)
    for name in ALL:
        assert_array_equal(alone[name], last[name])
    later = Ocean(parameters).surface(514, ALL, area)
    assert_array_equal(alone.displacement, later.displacement)
    looped = replace(parameters, loop_duration=8)
    one, other = (Ocean(looped).surface(time, ALL, area).displacement for time in (1, 9))
    assert_array_equal(one, other)
    assert np.abs(one).max() > 0.1


def test_waves_turn_into_nothing_on_land_and_are_limited_by_depth() -> None:
    parameters, ocean = sea(), Ocean(sea())
    x = np.array([120.0, 150.0, 170.0, 180.0, 190.0, 199.0, 230.0])
    y = np.linspace(0.0, SIDE, 60, endpoint=False)
    heights = np.array(
        [
            ocean.surface(time, on=Places(x, y[:, np.newaxis])).displacement[..., 2]
            for time in np.linspace(0.0, 300.0, 25)
        ]
    )
    rms = 2.0 * np.sqrt(2.0) * heights.std(axis=(0, 1))
    depth = 12.0 - 0.065 * x
    wet = depth > 0.0
    assert (rms[wet] <= 0.6 * depth[wet] + 0.02).all()
    assert rms[1] > 0.7 * 0.7 * height(parameters)
    assert_allclose(heights[..., ~wet & (x > 190.0)], 0.0, atol=1e-6)
    assert np.abs(heights.mean(axis=(0, 1))).max() < 0.1 * height(parameters)


def test_its_derivatives_are_those_of_its_displacement() -> None:
    swell = Patch(SIDE, resolution=SAMPLES, shortest_wavelength=40.0)
    ocean, d, dt = Ocean(sea(patches=(swell,)), "double"), STEP, 0.01
    x, y = STEP * np.array([3.0, 12.0, 20.0, 27.0]), STEP * np.array([4.0, 17.0, 25.0, 40.0])
    fields = ocean.surface(4.0, ALL, Places(x, y))

    def moved(dx: float, dy: float, time: float = 4.0) -> np.ndarray:
        return ocean.surface(time, on=Places(x + dx, y + dy)).displacement

    velocity = (moved(0, 0, 4.0 + dt) - moved(0, 0, 4.0 - dt)) / (2.0 * dt)
    assert_allclose(fields.velocity, velocity, atol=2e-3 * np.abs(velocity).max())
    by_x, by_y = (moved(d, 0) - moved(-d, 0)) / (2.0 * d), (moved(0, d) - moved(0, -d)) / (2.0 * d)
    assert_allclose(fields.slope[:, 0], by_x[:, 2], atol=0.08 * np.abs(by_x[:, 2]).max())
    assert_allclose(fields.slope[:, 1], by_y[:, 2], atol=0.08 * np.abs(by_x[:, 2]).max())
    assert_allclose(fields.strain[:, 0], by_x[:, 0], atol=0.08 * np.abs(by_x[:, 0]).max())
    assert_allclose(fields.strain[:, 1], by_y[:, 1], atol=0.08 * np.abs(by_x[:, 0]).max())


@pytest.mark.parametrize("shore", ["+X", "+Y", "-X", "-Y"])
def test_a_bed_that_is_turned_has_the_same_waves_turned(shore: str) -> None:
    turns = ["+X", "+Y", "-X", "-Y"].index(shore)
    bed = np.rot90(BEACH, -turns)  # of [y, x] arrays, counter-clockwise in x and y
    corner = {"+X": (0.0, 0.0), "+Y": (-200.0, 0.0), "-X": (-200.0, -200.0), "-Y": (0.0, -200.0)}[shore]
    angle = 0.5 * np.pi * turns
    parameters = sea(bed, shore=shore, x=corner[0], y=corner[1])
    parameters = parameters.replace(
        layers=(WaveLayer(wind_speed=11.0, fetch=60e3, wind_direction=angle),), amplitudes="DETERMINISTIC"
    )
    c, s = np.round(np.cos(angle)), np.round(np.sin(angle))
    along, across = np.meshgrid(np.linspace(120.0, 190.0, 15), np.linspace(0.0, 200.0, 30, endpoint=False))
    there = Places(c * along - s * across, s * along + c * across)
    ocean = Ocean(parameters)
    found = [ocean.surface(time, on=there).displacement[..., 2] for time in range(0, 60, 3)]
    expected = 12.0 - 0.065 * along[0]
    rms = 2.0 * np.sqrt(2.0) * np.std(found, axis=(0, 1))
    assert (rms[:-4] > 0.25 * np.minimum(expected[:-4], height(parameters))).all()
    assert rms[-1] < 0.5 * rms[0]


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"trough_damping": 0.5}, "damped by no others"),
        ({"mask": Mask()}, "remove them"),
        ({"dispersion": "DEEP"}, "FINITE_DEPTH or CAPILLARY"),
        ({"current": Current(speed=1.0)}, "must be still over a coast"),
    ],
)
def test_what_cannot_be_beside_a_coast_is_refused(changes: dict[str, object], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        sea().replace(**changes)


@pytest.mark.parametrize(
    ("of_coast", "words"),
    [
        ({"depth": None}, "give the bed"),
        ({"depth": Raster(-BEACH)}, "land, .* positive downwards"),
        ({"shore": "-X"}, "choose another side"),
        ({"rim": 3.0}, "at least 37.5 m"),
        ({"depth": Raster([[1.0, 2.0]])}, "2 samples a side"),
    ],
)
def test_a_bed_that_waves_cannot_reach_is_refused(of_coast: dict[str, object], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        Ocean(sea(**of_coast)).surface(0.0, on=Places(0.0, 0.0))


def test_a_tile_is_refused_and_keyed_wind_too() -> None:
    with pytest.raises(ParameterError, match=r"coast = 'given': .* ask for an Area or Places"):
        Ocean(sea()).surface(0.0)
    with pytest.raises(ParameterError, match=r"layers\.0\.wind_speed.* coast"):
        Shot(sea(), Animation(1, (("layers.0.wind_speed", (1.0, 2.0)),)))
    Shot(sea(), Animation(1, (("ocean_time", (1.0, 2.0)),)))


def test_the_height_above_places_is_that_of_the_surface() -> None:
    ocean = Ocean(sea())
    at_rest = Places(np.array([20.0, 80.0, 140.0, 160.0]), np.array([10.0, 60.0, 110.0, 160.0]))
    x, y = at_rest.rest_positions()
    moved = ocean.surface(3.0, on=at_rest).displacement
    points = ocean.points_at(x + moved[:, 0], y + moved[:, 1], 3.0, velocity=True)
    assert points.found.all()
    assert_allclose(points.height, moved[:, 2], atol=2e-3)
    assert points.velocity is not None
    with pytest.raises(ValueError, match="coast"):
        ocean.points_at(0.0, 0.0, 0.0, "exact")


def test_the_share_of_broken_waves() -> None:
    heights, depths = np.array([0.0, 0.21, 0.42, 2.0, 1.0]), np.array([1.0, 1.0, 1.0, 1.0, 0.0])
    assert_allclose(broken_share(heights, depths), [0.0, 1.0 / 16.0, 1.0, 1.0, 0.0])


def test_it_is_told_how_high_waves_are_and_what_it_takes() -> None:
    ocean = Ocean(sea())
    told = coast_outlook(ocean)
    assert told is not None
    assert told.offshore == pytest.approx(height(sea()), rel=0.25)
    assert told.offshore > told.breaking > told.shore >= 0.0
    assert 0.2 < told.breaking / told.breaking_depth < 0.6
    assert 0.5 < told.share < 1.0
    assert coast_outlook(Ocean(open_sea(sea()))) is None


@pytest.mark.parametrize("name", BEDS)
def test_beds_to_begin_with_let_waves_in_and_hold_land(name: str) -> None:
    heights = BEDS[name](*grid())
    assert heights[:, 0].max() < -5.0
    assert (heights > 0.5).mean() > 0.005
    if name != "ISLET":
        assert heights[:, -1].min() > 0.5
    parameters = sea(-heights, spacing=SPACING, rim=120.0, step=8.0)
    parameters = replace(parameters, domain_size=512.0)
    assert np.isfinite(Ocean(parameters).surface(3.0, on=Places(300.0, [20.0, 256.0])).displacement).all()


def test_in_the_lee_of_a_wall_short_waves_are_lower_too() -> None:
    bed = BEACH.copy()
    bed[25:76, 50:53] = -1.0  # y from 50 to 150 m, at x = 100 m
    coast = Ocean(sea(bed)).coast
    assert coast is not None
    ground, hs = coast.ground, coast.significant_height
    assert coast.share_of_energy < 0.75
    x, y = ground.first[0] + STEP * np.arange(ground.rows), ground.first[1] + STEP * np.arange(ground.columns)
    lee, open_side = (
        hs[np.ix_((x > 110.0) & (x < 130.0), near)].mean() for near in (np.abs(y - 100.0) < 15.0, y < 20.0)
    )
    assert lee < 0.45 * open_side


def test_waves_repeat_as_soon_as_looks_random_and_a_loop_lets_them() -> None:
    """After 512 s, or the largest whole part of a loop that is no longer."""
    expected = ((None, 512), (8, 8), (512, 512), (600, 300), (1540, 385))
    for loop, after in expected:
        assert repeats_after(None if loop is None else Fraction(loop)) == after


def test_json_both_ways() -> None:
    given = sea(shore="+Y", breaking=False)
    assert OceanParameters.from_json(given.to_json()) == given
    assert "coast" not in OceanParameters().to_dict()


def test_where_no_waves_follow_the_bed_the_others_are_there_all_the_same() -> None:
    parameters = sea(bed=np.full((21, 21), 18.0), spacing=10.0, shortest_wavelength=5000.0)
    deep = Places(*np.meshgrid(100.0 + STEP * np.arange(24), STEP * np.arange(24)))
    over_bed, open_one = (
        Ocean(each).surface(7.3, ("displacement",), deep).displacement
        for each in (parameters, open_sea(parameters))
    )
    assert over_bed[..., 2].std() == pytest.approx(open_one[..., 2].std(), rel=0.1)
    told = coast_outlook(Ocean(parameters))
    assert told is not None
    assert told.frequencies == 0
    assert "coast.shortest_wavelength" in told.warnings[0]
    whole = coast_outlook(Ocean(sea()))
    assert whole is not None
    assert not whole.warnings


def test_a_wake_over_a_bed_ends_at_the_shore() -> None:
    """Deeper than a metre it is the open sea's, and land and what lies beyond it are still."""
    path = (PathSample(0.0, y=100.0), PathSample(50.0, x=300.0, y=100.0))
    wake = WakeLayer(path=path, length=20.0, beam=4.0, draught=1.0, area_size=256.0, area_resolution=128)
    calm = sea()
    both = calm.replace(layers=(*calm.layers, wake))
    x, y = np.meshgrid(4.0 * np.arange(70), 4.0 * np.arange(50))
    for time in (20.0, 45.0):
        over_bed, without, open_one, open_without = (
            Ocean(each).surface(time, ("displacement", "strain", "foam"), Places(x, y))
            for each in (both, calm, open_sea(both), open_sea(calm))
        )
        made = over_bed.displacement - without.displacement
        whole = open_one.displacement - open_without.displacement
        deep = x < 160.0  # the bed is 1 m deep at 169 m, and the shore at 185 m
        assert_allclose(made[deep], whole[deep], atol=1e-5)
        land = x > 192.0
        assert np.abs(whole[land]).max() > 0.02
        assert np.abs(made[land]).max() < 1e-5
        assert np.abs(over_bed.strain[land]).max() < 1e-5
        assert_allclose(over_bed.foam[land], without.foam[land], atol=1e-5)
        own = wake.own_foam(both, x.ravel(), y.ravel(), time).foam.reshape(x.shape)
        assert (over_bed.foam >= own - 0.01)[deep].all()
    assert np.count_nonzero(own[land] > 0.5) > 5


def test_a_sea_in_single_precision_has_its_bytes_whatever_was_asked_in_double() -> None:
    parameters, area = sea(), Area(150.0, 40, (-50.0, 3.0))
    MEMO.drop()
    alone = Ocean(parameters).surface(2.0, ALL, area)
    MEMO.drop()
    Ocean(parameters, "double").surface(2.0, ALL, area)
    after = Ocean(parameters).surface(2.0, ALL, area)
    for name in ALL:
        assert_array_equal(after[name], alone[name])


def test_what_a_wall_mirrors_runs_out_to_the_open_sea_and_ends_there() -> None:
    """A quay in 12 m of water: waves stand before it, and where the coast comes in nothing is added."""
    quay = np.full((101, 101), 12.0)
    quay[:, 90:] = -3.0
    x, y = np.meshgrid(np.arange(-90.0, 178.0, 4.0), np.arange(0.0, 200.0, 5.0))
    plain, mirrored = (
        Ocean(sea(quay, mirror=share)).surface(7.0, {"displacement", "slope"}, on=Places(x, y))
        for share in (0.0, 1.0)
    )
    change = np.abs(mirrored.displacement - plain.displacement).max(axis=(0, 2))
    assert (change[x[0] < -82.0] == 0.0).all()
    assert change[x[0] > 0.0].min() > 0.1
    assert mirrored.displacement[:, -1, 2].std() > 1.5 * plain.displacement[:, -1, 2].std()
    # what came back has the horizontal displacement of waves so long, over the bed and over the rim
    coasts = [Ocean(sea(quay, mirror=share)).coast for share in (0.0, 1.0)]
    calm, made = (coast.pictures for coast in coasts if coast is not None)
    assert coasts[0] is not None
    depth = coasts[0].ground.depth[coasts[0].ground.depth > 0.0]
    for index, number in enumerate(made.numbers):
        height, wide = (
            getattr(made, each)[index] - getattr(calm, each)[index] for each in ("elevation", "potential")
        )
        for flat in (DEEP, 12.0):
            there = np.abs(depth - flat) < 1e-6
            assert there.sum() > 500
            k = waves_k(2.0 * np.pi * number / 512.0, flat)
            assert_allclose(wide[there], height[there] / k, atol=2e-3 * np.abs(wide).max())


def waves_k(omega: float, depth: float) -> float:
    """rad/m of ω² = g k tanh kh, by bisection."""
    low, high = 0.0, 10.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        small = 9.81 * middle * np.tanh(middle * depth) < omega**2
        low, high = (middle, high) if small else (low, middle)
    return low


def test_whitecaps_are_left_in_proportion_to_the_sixth_power_of_the_open_sea_s_share() -> None:
    """As the cube of the saturation, itself in proportion to the square of the height, Phillips (1985)."""
    ocean, full = Ocean(sea()), np.ones((SAMPLES, SAMPLES), np.float32)
    x, y = np.array([-150.0, 100.0, 150.0, 195.0]), np.full(4, 60.0)
    none = {name: np.zeros(4, np.float32) for name in Whitecaps._fields}
    found = with_whitecaps(ocean, none, x, y, Whitecaps(full, full, 2.0 * full))
    assert ocean.coast is not None
    assert_allclose(found["foam"], (ocean.coast.shares(x, y).value ** 2) ** 3, atol=1e-6)
    assert found["foam"][0] == 1.0
    assert found["foam"][3] == 0.0
    assert (np.diff(found["foam"][1:]) < 0.0).all()
    # breakers of their own go before
    own = {"foam": np.ones(4, np.float32), "breaking": np.ones(4, np.float32), "foam_age": none["foam_age"]}
    found = with_whitecaps(ocean, own, x, y, Whitecaps(0.5 * full, 0.0 * full, 2.0 * full))
    assert_allclose(found["foam"], 1.0)
    assert_allclose(found["foam_age"], 0.0)
