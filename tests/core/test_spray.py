# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray: born of breaking crests by hash, flown by formula, the same from any frame."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from ocean_tweak.core import Foam, Ocean, OceanParameters, Patch, Spray, WaveLayer
from ocean_tweak.core.foam.model import breaking_of
from ocean_tweak.core.numerics import random
from ocean_tweak.core.parameters.fingerprint import shot_fingerprint
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.core.sea import spray as sea_spray
from ocean_tweak.core.sea import spray_outlook
from ocean_tweak.core.sea.foam_levels import FoamLevels
from ocean_tweak.core.sea.patch_plan import Wish, planned
from ocean_tweak.core.sea.spray import CameraSpray, TileSpray
from ocean_tweak.core.sea.spray_outlook import SprayError, check_spray, why_none
from ocean_tweak.core.sea.spray_squares import Square, outside, squares
from ocean_tweak.core.spray import drops
from ocean_tweak.core.spray.flight import Flight
from ocean_tweak.core.spray.particles import (
    Crests,
    Particles,
    expected,
    friction_velocity,
    in_the_air,
    mean_life,
)
from ocean_tweak.core.waves.contribution import Wind

_TIME = 10.0


def _sea(wind: float = 20.0, **changes: object) -> OceanParameters:
    layer = WaveLayer(wind_speed=wind, fetch=300e3, wind_direction=0.4)
    values: dict[str, object] = {"resolution": 128, "domain_size": 150.0, "seed": 3, "layers": (layer,)}
    return OceanParameters(**{**values, **changes})


def _same(first: Particles, second: Particles) -> bool:
    return all(one.tobytes() == other.tobytes() for one, other in zip(first, second, strict=True))


def test_hashes_of_cells_are_pinned() -> None:
    column, row = np.array([0, 1, -7]), np.array([0, 2, 123456789])
    key = random.hash_cells(column, row, 3, 80, 0)
    # of an implementation in whole numbers of Python, which have no width
    assert key.tolist() == [_plain_hash(int(x), int(y), (3, 80, 0)) for x, y in zip(column, row, strict=True)]
    assert key.tolist() == [1186809077215440058, 16314423248499748561, 10635049431675908547]


def _mixed(value: int) -> int:
    value = (value ^ (value >> 30)) * 0xBF58476D1CE4E5B9 % 2**64
    value = (value ^ (value >> 27)) * 0x94D049BB133111EB % 2**64
    return value ^ (value >> 31)


def _plain_hash(x: int, y: int, seeds: tuple[int, ...]) -> int:
    golden, start = 0x9E3779B97F4A7C15, 0
    for seed in seeds:
        start = _mixed(((start ^ seed) + golden) % 2**64)
    first = _mixed((((x % 2**64) ^ start) + golden) % 2**64)
    return _mixed(first ^ _mixed(((y % 2**64) + 2 * golden) % 2**64))


def test_a_frame_alone_is_that_of_a_sequence() -> None:
    sequence, spray = TileSpray(Ocean(_sea())), Spray()
    for frame in range(4):
        last = sequence.at(_TIME + frame / 24.0, spray)
    assert len(last.age) > 1000
    assert _same(last, TileSpray(Ocean(_sea(), workers=2)).at(_TIME + 3 / 24.0, spray))
    assert _same(sequence.at(_TIME, spray), TileSpray(Ocean(_sea())).at(_TIME, spray))  # and back again


def test_a_particle_flies_on_under_its_id() -> None:
    maker = TileSpray(Ocean(_sea()))
    before, after = (maker.at(time, Spray()) for time in (_TIME, _TIME + 1 / 24.0))
    both, first, second = np.intersect1d(before.id, after.id, return_indices=True)
    assert len(np.unique(after.id)) == len(after.id)
    assert len(both) > 0.7 * len(before.id)
    np.testing.assert_allclose(after.age[second] - before.age[first], 1 / 24.0, atol=1e-5)
    mean = 0.5 * (before.velocity[first] + after.velocity[second])
    moved = after.position[second] - before.position[first]
    assert np.abs(moved - mean / 24.0).max() < 0.05  # m: from 0.04 s, at up to 20 m/s


def test_loops_end_where_they_began() -> None:
    sea = _sea(loop_duration=8)
    spray = Spray()
    first, again = (TileSpray(Ocean(sea)).at(time, spray) for time in (1.0, 9.0))
    assert len(first.age) > 500
    assert np.array_equal(np.sort(first.id), np.sort(again.id))


def _integrated(flight: Flight, index: int, age: float, steps: int = 4000) -> np.ndarray:
    """Place after a time by Heun's steps through dv/dt = g + (w - v)/τ, float64."""
    place, velocity, air = (np.asarray(part[index], float) for part in flight[:3])
    response, step, gravity = float(flight.response[index]), age / steps, np.array([0.0, 0.0, -9.81])
    for _ in range(steps):
        pull = gravity + (air - velocity) / response
        guess = velocity + step * pull
        later = velocity + 0.5 * step * (pull + gravity + (air - guess) / response)
        place, velocity = place + 0.5 * step * (velocity + later), later
    return place


def test_flight_is_that_of_the_equation_of_motion() -> None:
    rng = np.random.default_rng(1)
    start, velocity, air = (rng.normal(0.0, scale, (6, 3)).astype(np.float32) for scale in (5.0, 4.0, 12.0))
    response = drops.response_time(np.geomspace(1e-4, 2e-3, 6).astype(np.float32))
    flight = Flight(start, velocity, air, response)
    for age in (0.1, 0.7, 2.0):
        place, _ = flight.at(np.full(6, age, np.float32))
        for index in range(6):
            np.testing.assert_allclose(place[index], _integrated(flight, index, age), atol=2e-3)


def test_large_drops_fall_back_as_a_stone_does() -> None:
    """3 m/s upwards lands after 2·3/9.81 = 0.61 s without air, and a little earlier with it."""
    up, none = np.array([[0.0, 0.0, 3.0]], np.float32), np.zeros((1, 3), np.float32)
    flight = Flight(none, up, none, drops.response_time(np.array([2e-3], np.float32)))
    ages = np.linspace(0.01, 1.0, 200, dtype=np.float32)
    lands = next(age for age in ages if not flight.is_above(flight.at(np.full(1, age))[0])[0])
    assert 0.5 < lands < 0.62


@pytest.mark.parametrize(
    ("diameter", "speed"),
    [(0.2e-3, 0.72), (0.5e-3, 2.06), (1.0e-3, 4.03), (2.0e-3, 6.49)],
)
def test_drops_fall_as_fast_as_was_measured(diameter: float, speed: float) -> None:
    """Gunn & Kinzer (1949), table 2."""
    assert drops.fall_speed(np.array([0.5 * diameter]))[0] == pytest.approx(speed, rel=0.1)


def test_radii_are_within_their_kind_and_fall_with_the_power() -> None:
    share = (np.arange(200_000) + 0.5) / 200_000
    for kind, least, most, power in ((drops.SPUME, 0.3e-3, 1e-3, 5.0), (drops.MIST, 37.5e-6, 0.1e-3, 2.8)):
        radius = drops.radii(np.full(share.shape, kind, np.int8), share).astype(float)
        assert least * 0.999 <= radius.min()
        assert radius.max() <= most * 1.001
        count, ends = np.histogram(radius, np.geomspace(least, most, 12))
        density, middle = count / np.diff(ends), np.sqrt(ends[1:] * ends[:-1])
        slope = np.polyfit(np.log(middle), np.log(density), 1)[0]
        assert slope == pytest.approx(-power, abs=0.3)


@pytest.mark.parametrize(("wind", "rate"), [(15.0, 100.0), (20.0, 400.0), (25.0, 1200.0)])
def test_rates_are_those_that_look_right(wind: float, rate: float) -> None:
    assert drops.torn_rate(wind) == pytest.approx(rate, rel=0.02)


def test_no_wind_below_nine_metres_a_second_tears_anything_off() -> None:
    assert drops.torn_rate(9.0) == 0.0
    assert 0.0 < drops.torn_rate(10.0) < 10.0


@pytest.mark.parametrize(("wind", "alive"), [(15.0, 15e3), (20.0, 150e3), (25.0, 0.9e6)])
def test_as_many_are_in_the_air_as_look_right(wind: float, alive: float) -> None:
    """Over 400 m; a seed's breaking area varies, so the mean of several moments of two."""
    seas = [_sea(wind, resolution=256, domain_size=400.0, seed=seed) for seed in (0, 1)]
    spray = Spray(amount=0.1)
    count = [len(TileSpray(Ocean(sea)).at(time, spray).age) for sea in seas for time in (5.0, 40.0)]
    assert 10.0 * np.mean(count) == pytest.approx(alive, rel=0.35)


def test_births_are_as_many_as_breaking_area_and_rate_say() -> None:
    """All that is born within 0.05 s and still rises, against the rate times the area that breaks, over as
    many gusts as several moments have."""
    sea, young, area = Ocean(_sea(25.0)), 0, 0.0
    for time in (_TIME, 20.0, 30.0, 40.0):
        particles = TileSpray(sea).at(time, Spray(amount=4.0))
        young += np.count_nonzero((particles.age < 0.05) & (particles.kind != drops.MIST))
        fields = sea.surface(time, {"min_eigenvalue", "jacobian"})
        breaks = breaking_of(sea.foam_model, 1.0 - fields.min_eigenvalue) > 0.0
        area += float(np.maximum(fields.jacobian, 0.0)[breaks].sum()) * (150.0 / 128) ** 2
    # of those thrown up as fast as they are, from water that rises or sinks, most rise for so long
    assert 0.5 < young / (4.0 * 1200.0 * area * 0.05) < 1.0


def test_none_is_below_the_surface_at_its_birth() -> None:
    sea = Ocean(_sea(20.0))
    particles = TileSpray(sea).at(_TIME, Spray(amount=2.0))
    new = particles.age < 0.01
    x, y, z = particles.position[new].astype(float).T
    above = z - sea.height_at(x % 150.0, y % 150.0, _TIME)
    assert np.count_nonzero(new) > 100
    assert np.percentile(above, 1.0) > -0.05  # m, of cells of 1.2 m, in which water is taken for flat
    assert above.min() > -0.08


def test_the_wind_gives_no_more_energy_than_it_has() -> None:
    """Horizontally nothing is faster than the wind and the water that it came from together."""
    wind = 20.0
    sea = Ocean(_sea(wind))
    water = np.linalg.norm(sea.surface(_TIME, {"velocity"}).velocity[..., :2], axis=-1).max()
    calm, blown = (TileSpray(sea).at(_TIME, Spray(wind=each)) for each in (0.0, 1.0))
    speed = [np.linalg.norm(each.velocity[:, :2], axis=1) for each in (calm, blown)]
    assert speed[0].max() <= 1.2 * water  # of moments before
    assert speed[1].max() <= max(wind, 1.2 * water + 0.75 * wind)
    energy = [float(np.mean(each**2)) for each in speed]
    assert energy[0] < energy[1] < wind**2
    along = blown.velocity[:, :2] @ [math.cos(0.4), math.sin(0.4)]
    assert along.mean() > 0.3 * wind  # and it is leeward that they go


def test_drag_never_speeds_a_drop_up_beyond_the_air() -> None:
    rng = np.random.default_rng(2)
    air = rng.normal(0.0, 8.0, (200, 3)).astype(np.float32)
    velocity = rng.normal(0.0, 4.0, (200, 3)).astype(np.float32)
    response = np.full(200, 0.3, np.float32)
    flight = Flight(np.zeros((200, 3), np.float32), velocity, air, response)
    for age in (0.1, 0.5, 3.0):
        _, later = flight.at(np.full(200, age, np.float32))
        most = np.maximum(np.linalg.norm(velocity[:, :2], axis=1), np.linalg.norm(air[:, :2], axis=1))
        assert np.all(np.linalg.norm(later[:, :2], axis=1) <= most * (1.0 + 1e-5))


def test_friction_velocity_is_that_of_smith() -> None:
    """Smith (1980): a drag coefficient of 1.87e-3 at 20 m/s."""
    assert friction_velocity(20.0) == pytest.approx(20.0 * math.sqrt(1.87e-3))


def test_more_amount_adds_and_takes_nothing_away() -> None:
    maker = TileSpray(Ocean(_sea()))
    few, many = (maker.at(_TIME, Spray(amount=amount)) for amount in (0.5, 1.0))
    assert np.isin(few.id, many.id).all()
    assert len(few.id) == pytest.approx(0.5 * len(many.id), rel=0.1)


def test_size_life_and_wind_change_only_what_they_say() -> None:
    maker = TileSpray(Ocean(_sea()))
    usual, large = (maker.at(_TIME, Spray(size=size)) for size in (0.01, 0.02))
    assert np.array_equal(usual.id, large.id)
    drop = usual.kind != drops.MIST
    np.testing.assert_allclose(large.radius[drop], 2.0 * usual.radius[drop], rtol=1e-6)
    short = maker.at(_TIME, Spray(life=1.0))
    assert short.age.max() <= 1.0
    assert np.array_equal(np.sort(short.id), np.sort(maker.at(_TIME, Spray()).id[usual.age <= 1.0]))


def test_spray_changes_no_sea() -> None:
    sea, sprayed = _sea(), _sea(spray=Spray(amount=3.0))
    assert sea == sprayed
    assert hash(sea) == hash(sprayed)
    assert shot_fingerprint(Shot(sea)) == shot_fingerprint(Shot(sprayed))
    assert OceanParameters.from_json(sprayed.to_json()).spray == Spray(amount=3.0)
    assert "spray" not in sea.to_dict()


@pytest.mark.parametrize(
    ("sea", "reason"),
    [
        (_sea(8.0), "wind of 8 m/s"),
        (_sea(foam=Foam(coverage=0.0)), "no foam"),
        (_sea(layers=(WaveLayer(definition="SEA_STATE", significant_wave_height=3.0, peak_period=8.0),)),
         "no layer is given by a wind"),
    ],
)  # fmt: skip
def test_a_sea_without_spray_says_why(sea: OceanParameters, reason: str) -> None:
    assert reason in (why_none(sea) or "")
    assert len(TileSpray(Ocean(sea)).at(_TIME, Spray()).age) == 0


def test_more_than_the_memory_holds_is_refused_with_what_would_do(monkeypatch: pytest.MonkeyPatch) -> None:
    maker = TileSpray(Ocean(_sea()))
    count = len(maker.at(_TIME, Spray()).age)
    monkeypatch.setattr(spray_outlook, "usable_memory", lambda: 300 * count)  # of which half may be taken
    with pytest.raises(SprayError, match="would do") as told:
        maker.at(_TIME, Spray(amount=2.0))
    would_do = float(str(told.value).partition("amount of ")[2].split()[0])
    assert len(maker.at(_TIME, Spray(amount=would_do)).age) < 0.8 * count


def _patched() -> OceanParameters:
    layer = WaveLayer(wind_speed=22.0, fetch=300e3)
    return planned(OceanParameters(seed=2, layers=(layer,)), Wish(finest=4.0, area=200.0))


@pytest.mark.usefixtures("only_near")
def test_around_a_camera_it_is_the_same_from_anywhere_near() -> None:
    levels, spray = FoamLevels(_patched()), Spray(life=0.5)
    maker = CameraSpray(levels)
    found = maker.at(_TIME - 1 / 24.0, spray, (0.0, 0.0))
    x, y = found.position[found.age < 0.1][0, :2].tolist()  # where a crest breaks
    here = maker.at(_TIME, spray, (x, y))
    assert _same(CameraSpray(levels).at(_TIME, spray, (x, y)), here)
    aside = maker.at(_TIME, spray, (x + 4.0, y))
    near = np.hypot(*(here.position[:, :2] - [x, y]).T) < 10.0
    near &= here.age < 0.3  # what is older comes from farther away
    assert np.count_nonzero(near) > 10
    assert np.isin(here.id[near], aside.id).mean() > 0.95


def test_squares_around_a_camera_leave_no_cell_out_and_hold_none_twice() -> None:
    levels = FoamLevels(_patched())
    found = squares(levels, (37.0, -81.0))
    area = [(each.first[0] * 0.25 * 2.0**each.level, 176 * 0.25 * 2.0**each.level) for each in found]
    for (inner, size), (outer, outer_size) in pairwise(area):
        assert outer <= inner
        assert inner + size <= outer + outer_size
    for finer, coarser in pairwise(found):
        assert coarser.inner is not None
        assert [2 * number for number in coarser.inner] == list(finer.first)


def test_a_square_looks_at_all_cells_that_a_step_of_the_finer_one_can_leave_to_it() -> None:
    levels, own = FoamLevels(_patched()), 176**2 - 88**2
    asides = set()
    for x in np.arange(-40.0, 40.0, 1.7):
        for square in squares(levels, (x, 0.3 * x))[1:]:
            assert square.inner is not None
            cells = square.cells()
            assert np.count_nonzero(outside(*cells, square.inner)) == own
            assert len(cells[0]) < 1.12 * own
            asides.add(square.inner[0] - square.first[0])
    assert asides == {36, 44, 52}  # in the middle, and a step of the finer one to both sides


def test_a_step_of_the_finest_square_looks_at_no_coarser_one_again(monkeypatch: pytest.MonkeyPatch) -> None:
    looked: list[int] = []
    original = sea_spray._broken

    def counted(sea: Ocean, square: Square, *others: object) -> object:
        looked.append(square.level)
        return original(sea, square, *others)

    monkeypatch.setattr(sea_spray, "_broken", counted)
    levels, spray = FoamLevels(_patched()), Spray(life=0.1)
    maker = CameraSpray(levels)
    maker.at(_TIME, spray, (0.0, 0.0))
    assert set(looked) == {0, 1, 2, 3, 4, 5, 6}
    looked.clear()
    moved = maker.at(_TIME, spray, (3.0, 0.0))  # of 16 cells of 0.25 m, more than half
    assert set(looked) == {0}
    assert _same(moved, CameraSpray(levels).at(_TIME, spray, (3.0, 0.0)))


@pytest.mark.parametrize("life", [0.1, 4.0, 30.0])
def test_as_many_are_in_the_air_as_the_mean_life_says(life: float) -> None:
    """Of one moment's particles those that are left at each later one: their sum is how long they live."""
    n, step, spray, wind = 2000, 0.125, Spray(life=life), Wind(25.0, 0.0)
    key, gust = (random.hash_cells(np.arange(n), np.arange(n), 3, stream) for stream in (1, 2))
    rest, ones = np.zeros((n, 3), np.float32), np.ones(n, np.float32)
    rate = 0.1 * drops.torn_rate(wind.speed)
    crests = Crests(key, gust, rate * ones, ones, rest, np.zeros((n, 2, 3), np.float32), rest)
    after = np.arange(0.0, max(life, 2.0) + 2.0 * step, step)
    left = [len(in_the_air(crests, spray, wind, step, float(since)).age) for since in after]
    torn = float(expected(crests, spray, step).sum())
    assert mean_life(spray) == pytest.approx(sum(left) * step / torn, rel=0.15)


def test_memory_is_asked_for_as_many_squares_as_there_are(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of short waves alone there are few levels, and around them no crests are looked for."""
    patches = (Patch(40.0, 0.3, 1.5, 1e6, 128), Patch(11.0, 0.9, 0.5, 1.5, 128))
    sea = OceanParameters(seed=2, layers=(WaveLayer(wind_speed=22.0, fetch=3e3),), patches=patches)
    counts: list[float] = []
    for module in (sea_spray, spray_outlook):
        monkeypatch.setattr(module, "check_spray_memory", lambda count, spray: counts.append(count))
    assert len(squares(FoamLevels(sea), (0.0, 0.0))) < 5
    check_spray(sea, Spray(life=0.5))
    CameraSpray(FoamLevels(sea)).at(_TIME, Spray(life=0.5), (0.0, 0.0))
    beforehand, found = counts
    assert beforehand == pytest.approx(found, rel=0.5)


def _torn_at_one_place(wind: Wind, since: float, water: float = 0.0, together: float = 1.0) -> Particles:
    """What 30,000 cells at the origin threw up in a moment, on water of a speed along x."""
    n = 30_000
    key, gust = (random.hash_cells(np.arange(n), np.arange(n), 3, stream) for stream in (1, 2))
    rest, ones = np.zeros((n, 3), np.float32), np.ones(n, np.float32)
    rate = 0.12 * drops.torn_rate(wind.speed)
    velocity = np.tile(np.array([water, 0.0, 0.0], np.float32), (n, 1))
    crests = Crests(key, gust, rate * ones, together * ones, rest, np.zeros((n, 2, 3), np.float32), velocity)
    return in_the_air(crests, Spray(), wind, 0.125, since)


def test_another_wind_turns_all_flights() -> None:
    along, turned = (_torn_at_one_place(Wind(25.0, angle), 0.25) for angle in (0.0, 0.7))
    rotation = np.array([[math.cos(0.7), -math.sin(0.7)], [math.sin(0.7), math.cos(0.7)]])
    assert np.abs(along.position[:, 1]).max() > 1.0  # turbulence goes across, too
    np.testing.assert_allclose(turned.position[:, :2], along.position[:, :2] @ rotation.T, atol=1e-4)
    np.testing.assert_allclose(turned.position[:, 2], along.position[:, 2], atol=1e-5)


def test_a_crest_moves_on_with_its_water_within_a_moment() -> None:
    """It was at the origin in the moment's middle, 0.06 s ago: what is being born is where it is now."""
    made = _torn_at_one_place(Wind(25.0, 0.0), 0.06, water=10.0)
    born = made.age < 0.004
    assert np.count_nonzero(born) > 100
    np.testing.assert_allclose(made.position[born, 0], 10.0 * 0.06, atol=0.15)  # wind blows 20 m/s at most


def test_mist_spreads_as_it_ages() -> None:
    """By 0.3 friction velocities, which are 1.17 m/s in a wind of 25 m/s (Smith 1980)."""
    early, late = (_torn_at_one_place(Wind(25.0, 0.0), since) for since in (0.1, 2.1))
    radius = [float(made.radius[made.kind == drops.MIST].mean()) for made in (early, late)]
    assert radius[1] - radius[0] == pytest.approx(0.3 * 1.17 * 2.0, rel=0.03)


def test_mist_that_is_far_away_is_of_more_and_smaller_puffs_and_covers_as_much() -> None:
    """Of many particles one is drawn for so many: what they cover together is the same, for both."""
    covered = {}
    for together in (1.0, 64.0):
        made = _torn_at_one_place(Wind(25.0, 0.0), 0.25, together=together)
        for kind in (drops.SPUME, drops.DROPLET, drops.MIST):
            own = made.kind == kind
            area = float((made.radius[own].astype(float) ** 2).sum())
            covered[kind, together] = np.count_nonzero(own), area
    for kind, fewer in ((drops.SPUME, 64.0), (drops.DROPLET, 64.0), (drops.MIST, 4.0)):
        (near, area), (far, far_area) = covered[kind, 1.0], covered[kind, 64.0]
        assert near / far == pytest.approx(fewer, rel=0.1)
        assert far_area == pytest.approx(area, rel=0.1)
