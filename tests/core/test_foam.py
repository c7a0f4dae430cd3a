# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam: as much as the wind leaves at sea, from any frame alone, fading and drifting as asked for."""

from __future__ import annotations

import dataclasses
import math
from fractions import Fraction

import numpy as np
import pytest

from ocean_tweak.core import Area, Foam, Mask, Ocean, OceanParameters, Patch, Raster, WaveLayer
from ocean_tweak.core.foam import laying
from ocean_tweak.core.foam.looks import Compressed
from ocean_tweak.core.foam.model import Births, FoamHistory, FoamModel, Whitecaps, births
from ocean_tweak.core.foam.threshold import (
    foam_outlook,
    foam_wind,
    gaussian_strains,
    strain_covariances,
)
from ocean_tweak.core.sea.regions import TILE
from ocean_tweak.core.synthesis.channels import OF_MEMORY

SEA = OceanParameters(
    resolution=64, domain_size=200.0, seed=2, layers=(WaveLayer(wind_speed=15.0, wind_direction=0.7),)
)


def foam(ocean: Ocean, frame: float) -> np.ndarray:
    return ocean.frame(frame, {"foam"}).foam


def whitecaps(ocean: Ocean, frame: float) -> bytes:
    fields = ocean.frame(frame, OF_MEMORY)
    return b"".join(fields[name].tobytes() for name in sorted(OF_MEMORY))


@pytest.mark.parametrize("changes", [{}, {"loop_duration": Fraction(3)}, {"foam": Foam(resolution=32)}])
def test_any_frame_has_the_bytes_of_the_sequence(changes: dict) -> None:
    """24 frames in order, in reverse, alone, and in two chunks; sub-frames too."""
    parameters = SEA.replace(**changes)
    frames = [frame / 2 for frame in range(2, 50)]
    ocean = Ocean(parameters)
    in_order = [whitecaps(ocean, frame) for frame in frames]
    backwards = [whitecaps(ocean, frame) for frame in reversed(frames)]
    assert backwards[::-1] == in_order
    alone = [whitecaps(Ocean(parameters), frame) for frame in frames[::9]]
    assert alone == in_order[::9]
    chunk = Ocean(parameters)
    assert [whitecaps(chunk, frame) for frame in frames[20:]] == in_order[20:]
    assert len(set(in_order)) == len(frames)


@pytest.mark.parametrize("settled", [True, False])
def test_of_births_of_which_as_much_remains_the_later_one_counts(settled: bool) -> None:
    """Full foam of a half-life ago, and half of it now: it is as much, and looks new."""
    model = FoamModel(threshold=1.0, half_life=1.0, drift=(0.0, 0.0), spacing=1.0)
    births, place = Births(model, (1,), 0), np.array([0])
    for index, compression in ((0, 1.25), (8, 1.125)):  # rises from 0 to 1 over a quarter of the threshold
        births.add(Compressed(place, np.array([compression], np.float32)), index)
        if settled:
            births.settle()
    births.settle()
    left, age = births.left(Fraction(1))
    assert (left[0], age[0]) == (0.5, 0.0)


def test_over_foam_the_more_has_its_own_age() -> None:
    of_waves = Whitecaps(*(np.float32(each) for each in ([0.5, 0.5], [0.0, 0.0], [3.0, 3.0])))
    both = of_waves.over(*(np.float32(each) for each in ([0.7, 0.2], [0.0, 0.0], [1.0, 1.0])))
    assert both.foam.tolist() == pytest.approx([0.7, 0.5])
    assert both.foam_age.tolist() == [1.0, 3.0]


def test_a_loop_of_foam_ends_where_it_began() -> None:
    ocean = Ocean(SEA.replace(loop_duration=Fraction(5)))
    assert foam(ocean, 7).tobytes() == foam(ocean, 7 + 120).tobytes()
    assert foam(ocean, 7).tobytes() != foam(ocean, 7 + 60).tobytes()


def test_foam_wants_the_wind_at_10_m() -> None:
    """Of layers the strongest there: 10.6357 m/s at 19.5 m are 10 m/s (`test_wind_over_height`)."""
    high = WaveLayer(wind_speed=10.6357, wind_height=19.5, wind_direction=0.3)
    for layers, speed, direction in (
        ((high,), 10.0, 0.3),
        ((high, WaveLayer(wind_speed=10.3, wind_direction=2.0)), 10.3, 2.0),
        ((high, WaveLayer(wind_speed=9.7, wind_direction=2.0)), 10.0, 0.3),
    ):
        wind = foam_wind(SEA.replace(layers=layers))
        assert wind is not None
        assert wind.speed == pytest.approx(speed, rel=1e-5)
        assert wind.direction == direction
    # 3.18e-5 · 6.3³
    assert foam_outlook(SEA.replace(layers=(high,))).coverage == pytest.approx(0.0079515, rel=1e-3)


def test_swell_without_wind_has_no_foam() -> None:
    swell = WaveLayer(definition="SEA_STATE", significant_wave_height=5.0, peak_period=9.0)
    ocean = Ocean(SEA.replace(layers=(swell,)))
    assert foam_wind(ocean.parameters) is None
    assert not np.any(foam(ocean, 20))


WIND = WaveLayer(wind_speed=20.0)
HALVES = (
    Patch(200.0, shortest_wavelength=20.0, resolution=16),
    Patch(50.0, longest_wavelength=20.0, resolution=16),
)


@pytest.mark.parametrize("precision", ["single", "double"])
@pytest.mark.parametrize(
    "changes",
    [
        {"choppiness": 0.0},
        {"choppiness": 0.0, "patches": HALVES, "merged_resolution": 32},
        {"layers": (dataclasses.replace(WIND, shortest_wavelength=1e4),)},
        {"layers": (WaveLayer(fetch=1.0),), "domain_size": 100e3},
        {"layers": (dataclasses.replace(WIND, muted=True),)},
        {"layers": (dataclasses.replace(WIND, amplitude_scale=0.0),)},
        {"layers": (dataclasses.replace(WIND, mask=Mask(source="IMAGE", image=Raster([[0.0]]))),)},
        {"layers": (WaveLayer(wind_speed=20.0, spectrum="GENERALIZED_AB", generalized_a=0.0),)},
    ],
    ids=["flat", "merged_resolution", "too long", "too short", "muted", "no gain", "masked", "no energy"],
)  # fmt: skip
def test_a_sea_without_compression_has_no_foam(changes: dict, precision: str) -> None:
    sea = OceanParameters(resolution=32, layers=(WIND,), foam=Foam(coverage=100.0, half_life=0.5)).replace(
        **changes
    )
    with np.errstate(all="raise", under="ignore"):
        fields = Ocean(sea, precision).surface(4.0, {"foam", "cusp"})
    assert not np.any(fields.foam)
    assert not np.any(fields.cusp)


def test_patches_without_compression_have_no_foam() -> None:
    sea = Ocean(OceanParameters(choppiness=0.0, layers=(WIND,), patches=HALVES))
    assert not np.any(sea.surface(4.0, {"foam"}, on=Area(100.0, 16)).foam)


def test_crests_of_one_direction_can_be_white_all_over() -> None:
    """They compress half of the sea: no threshold covers more of it."""
    swell = WaveLayer(wind_speed=100.0, spreading="COSINE_2S", spreading_exponent=1e4, swell=0.0)
    sea = OceanParameters(resolution=32, layers=(swell,), foam=Foam(coverage=100.0, half_life=0.0))
    fields = Ocean(sea).surface(4.0, {"foam", "cusp"})
    assert np.mean(fields.cusp > 1e-3) == pytest.approx(0.5, abs=0.15)
    np.testing.assert_array_equal(fields.foam[fields.cusp > 1e-3], 1.0)


def looking_at_each_moment(parameters: OceanParameters) -> Ocean:
    """The sea whose foam interpolates nothing, and all of whose new foam breaks."""
    ocean = Ocean(parameters)
    plain = dataclasses.replace(ocean.foam_model, frequency=math.inf, breaking_threshold=0.0)
    ocean.__dict__["foam_model"] = plain
    return ocean


# The life of a single patch: a compression that is there for one lattice time


def one_birth(model: FoamModel, size: int = 32, born: int = 0) -> FoamHistory:
    """Full foam at the sample (5, 7) at one time in s and never else."""

    def compression_at(time: Fraction) -> np.ndarray:
        compression = np.zeros((size, size))
        if time == born:
            compression[5, 7] = 10.0
        return compression

    return FoamHistory(model, compression_at, size)


@pytest.mark.parametrize("half_life", [1e-12, 1e-60, 2e-182])
def test_foam_that_lives_for_no_time_at_all_is_that_of_the_present(half_life: float) -> None:
    """Also half a frame after a moment at which it may be born, when all of it has gone."""
    history = one_birth(FoamModel(threshold=1.0, half_life=half_life, drift=(0.0, 0.0), spacing=1.0))
    with np.errstate(over="raise", invalid="raise", divide="raise"):
        found = [history.whitecaps(Fraction(frame, 2)) for frame in range(-2, 6)]
    for each in found:
        assert np.isfinite(each.foam).all()
        assert each.foam.max() <= 1.0


def test_foam_fades_by_half_in_its_half_life() -> None:
    history = one_birth(FoamModel(threshold=1.0, half_life=2.0, drift=(0.0, 0.0), spacing=1.0))
    assert history.whitecaps(-0.5).foam.max() == 0.0
    for age in (0.0, 0.03, 1.0, 2.0, 4.5):
        assert history.whitecaps(age).foam[5, 7] == pytest.approx(2.0 ** (-age / 2.0), rel=1e-6)
        assert np.count_nonzero(history.whitecaps(age).foam) == 1
    assert history.whitecaps(11.9).foam[5, 7] > 0.0
    assert history.whitecaps(12.1).foam.max() == 0.0  # below 1/64


def test_foam_drifts() -> None:
    history = one_birth(FoamModel(threshold=1.0, half_life=20.0, drift=(0.5, -0.25), spacing=0.5))
    field = history.whitecaps(2.0).foam
    assert np.unravel_index(np.argmax(field), field.shape) == (5 - 1, 7 + 2)
    assert field.max() == pytest.approx(2.0**-0.1, rel=1e-6)
    halfway = history.whitecaps(0.5).foam  # half a sample in x, a quarter in y
    np.testing.assert_allclose(halfway[4:6, 7:9] / 2.0**-0.025, [[0.125, 0.125], [0.375, 0.375]], rtol=1e-6)


def test_foam_drifts_from_where_it_was_born() -> None:
    """Born at 4 s, its drifting grid has by then moved by (4, -2) samples."""
    model = FoamModel(threshold=1.0, half_life=20.0, drift=(0.5, -0.25), spacing=0.5)
    for age, place in ((0.0, (5, 7)), (2.0, (4, 9)), (8.0, (1, 15))):
        field = one_birth(model, born=4).whitecaps(4.0 + age).foam
        assert np.unravel_index(np.argmax(field), field.shape) == place
        assert field.max() == pytest.approx(2.0 ** (-age / 20.0), rel=1e-6)


def test_age_is_that_of_the_birth_that_is_seen() -> None:
    history = one_birth(FoamModel(threshold=1.0, half_life=2.0, drift=(0.0, 0.0), spacing=1.0), born=4)
    for age in (0.0, 0.03, 1.0, 4.5):
        found = history.whitecaps(4.0 + age)
        assert found.foam_age[5, 7] == pytest.approx(age, abs=1e-6)
        assert np.count_nonzero(found.foam_age) == (age > 0.0)
        assert found.breaking.max() == (age == 0.0)
    assert history.whitecaps(4.0 + 12.1).foam_age.max() == 0.0  # nothing is left of it


def test_the_age_of_what_drifts_between_samples_is_of_one_birth() -> None:
    """Two births side by side, of 0 s and of 3 s, half a sample on: no mean of their ages is seen."""

    def compression_at(time: Fraction) -> np.ndarray:
        compression = np.zeros((8, 8))
        compression[2, 2], compression[2, 3] = 10.0 * (time == 0), 10.0 * (time == 3)
        return compression

    model = FoamModel(threshold=1.0, half_life=20.0, drift=(0.1, 0.0), spacing=1.0)
    found = FoamHistory(model, compression_at, 8).whitecaps(5.0)
    assert np.count_nonzero(found.foam) == 3
    np.testing.assert_allclose(found.foam_age[found.foam > 0.0], [5.0, 2.0, 2.0], atol=1e-6)
    finer = FoamHistory(model, compression_at, 32).whitecaps(5.0)
    ages = np.unique(finer.foam_age)
    np.testing.assert_allclose(ages, [0.0, 2.0, 5.0], atol=1e-6)
    assert np.count_nonzero(finer.foam) > 16


@pytest.mark.parametrize("half_life", [0.0, 0.5])
def test_foam_is_the_largest_of_all_births_in_reach(half_life: float) -> None:
    """Against a list of all that was ever born, without drift; off the lattice of times too."""
    below_7_bft = (WaveLayer(wind_speed=13.0, wind_direction=0.7),)
    sea = SEA.replace(layers=below_7_bft, foam=Foam(drift=0.0, half_life=half_life, coverage=3.0))
    ocean = looking_at_each_moment(sea)
    threshold = ocean.foam_model.threshold
    for time in (5.0, 5.07):
        births = {time, *(np.arange(math.floor(8 * time) + 1) / 8)} if half_life else {time}
        strength = {}
        for then in births:
            x = np.clip((ocean.surface(then, {"cusp"}).cusp.astype(float) / threshold - 1.0) * 4.0, 0.0, 1.0)
            strength[then] = x * x * (3.0 - 2.0 * x)
        left = {
            then: c * (2.0 ** (-(time - then) / half_life) if half_life else 1.0)
            for then, c in strength.items()
        }
        expected = np.max(list(left.values()), axis=0)
        expected[expected < 2.0**-6] = 0.0
        age = time - np.array(list(left))[np.argmax(list(left.values()), axis=0)]
        found = ocean.surface(time, {"foam", "breaking", "foam_age"})
        np.testing.assert_allclose(found.foam, expected, atol=1e-5)
        np.testing.assert_allclose(
            found.breaking, np.where(strength[time] < 2.0**-6, 0.0, strength[time]), atol=1e-5
        )
        breaks = found.breaking > 0.0
        assert 0.01 < np.mean(breaks) < 0.5
        assert not np.any(found.foam_age[breaks | (found.foam == 0.0)])
        old = (found.foam > 0.0) & ~breaks
        np.testing.assert_allclose(found.foam_age[old], age[old], atol=1e-5)
        assert np.any(old) == (half_life > 0.0)


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"foam": Foam(resolution=32, coverage=5.0)},
        {"foam": Foam(half_life=0.0)},
        {"loop_duration": Fraction(3)},
    ],
    ids=["plain", "coarser", "no half-life", "loop"],
)
@pytest.mark.parametrize("precision", ["single", "double"])
def test_what_breaks_is_part_of_the_foam_and_new(changes: dict, precision: str) -> None:
    ocean = Ocean(SEA.replace(**changes), precision)
    for on in (TILE, Area(150.0, 40, (20.0, -70.0))):
        found = ocean.surface(2.3, {"foam", "breaking", "foam_age"}, on=on)
        assert np.any(found.breaking > 0.5)
        assert np.all((found.breaking >= 0.0) & (found.breaking <= found.foam) & (found.foam <= 1.0))
        assert not np.any(found.foam_age[(found.breaking > 0.0) | (found.foam == 0.0)])
        old = (found.breaking == 0.0) & (found.foam > 0.0)
        assert np.all(
            (found.foam_age[old] > 0.0) & (found.foam_age[old] <= 6.0 * ocean.parameters.foam.half_life + 0.2)
        )


def test_foam_without_a_half_life_stays_where_it_is_born() -> None:
    history = one_birth(FoamModel(threshold=1.0, half_life=0.0, drift=(1.0, 0.0), spacing=1.0))
    assert history.whitecaps(0.0).foam[5, 7] == 1.0
    assert history.whitecaps(0.1).foam.max() == 0.0
    ocean = Ocean(SEA.replace(foam=Foam(half_life=0.0)))
    fields = ocean.surface(3.0, {"foam", "cusp"})
    born = fields.foam > 0.0
    assert np.min(fields.cusp[born]) >= np.max(fields.cusp[~born])


def test_strength_of_foam_at_its_levels() -> None:
    model = FoamModel(threshold=0.3, half_life=1.0, drift=(0.0, 0.0), spacing=1.0)
    strength, rise = births(4)
    np.testing.assert_allclose(np.log2(strength[-4:]), [-0.875, -0.625, -0.375, -0.125], atol=1e-9)
    assert strength[0] == pytest.approx(2.0**-5.875)
    np.testing.assert_allclose(model.strength(0.3 * rise), strength, rtol=1e-9)
    assert model.strength(np.array([0.0, 0.3, 0.375, 2.0])).tolist() == [0.0, 0.0, 1.0, 1.0]


def test_births_that_are_not_settled_yet_count_in_the_memory() -> None:
    """Of a place four bytes of the latest birth and four of its moment; while it is followed four and one."""
    born = Births(FoamModel(threshold=1.0, half_life=2.0, drift=(0.0, 0.0), spacing=1.0), (10, 10), 0)
    assert born.nbytes == 100 * 8
    born.add(Compressed(np.arange(30), np.full(30, 2.0, np.float32)), 0)
    assert born.nbytes == 100 * 8 + 30 * 5
    born.settle()
    assert born.nbytes == 100 * 8


def test_a_lattice_of_at_most_eight_a_second() -> None:
    model = FoamModel(threshold=1.0, half_life=2.0, drift=(0.0, 0.0), spacing=1.0)
    assert model.step == Fraction(1, 8)
    assert model.memory == math.floor(6 * 2.0 * 8) + 1
    looped = dataclasses.replace(model, loop_duration=Fraction(7, 3))
    assert looped.step >= Fraction(1, 8)
    assert (looped.loop_duration / looped.step).denominator == 1


def test_strains_are_those_of_the_fields() -> None:
    """Shares of places and of the plane, and crossings, at three levels, against the sea itself."""
    ocean = Ocean(OceanParameters(resolution=256, domain_size=800.0, layers=SEA.layers, seed=1))
    expected = gaussian_strains(
        *strain_covariances(ocean.initial_state, ocean.parameters.choppiness, (0.0, 0.0))
    )
    compressions, jacobians, rising = [], [], []
    for time in np.arange(0.0, 60.0, 5.0):
        before, after = (
            1.0 - ocean.surface(time + s, {"min_eigenvalue"}).min_eigenvalue for s in (-0.02, 0.02)
        )
        fields = ocean.surface(time, {"min_eigenvalue", "jacobian"})
        compressions.append(1.0 - fields.min_eigenvalue)
        jacobians.append(fields.jacobian)
        rising.append((before, after))
    compression, jacobian, (before, after) = map(
        np.array, (compressions, jacobians, np.moveaxis(rising, 1, 0))
    )
    for share in (0.3, 0.03, 0.003):
        level = np.quantile(compression, 1.0 - share)
        above = compression > level

        def told(name: str, level: float = level) -> float:
            return float(expected.at(np.array([level]), name)[0])

        assert told("share") == pytest.approx(share, rel=0.1)
        assert told("area") == pytest.approx(np.mean(jacobian * above), rel=0.1)
        crossed = np.mean((before <= level) & (after > level)) / 0.04
        assert told("crossings") == pytest.approx(crossed, rel=0.1)


def test_gaussian_strains_are_those_of_draws() -> None:
    """Strong ones, whose products count: a million Gaussian gradients, counted."""
    covariance = np.array([[0.09, 0.02, 0.01], [0.02, 0.06, -0.01], [0.01, -0.01, 0.03]])
    expected = gaussian_strains(covariance, np.eye(3))
    xx, yy, xy = np.random.default_rng(5).multivariate_normal(np.zeros(3), covariance, 1_000_000).T
    compression = np.hypot(0.5 * (xx - yy), xy) - 0.5 * (xx + yy)
    jacobian = (1.0 + xx) * (1.0 + yy) - xy**2
    for level in (0.3, 0.6):
        above = compression > level
        for name, counted in (("share", above), ("area", jacobian * above)):
            told = float(expected.at(np.array([level]), name)[0])
            assert told == pytest.approx(float(np.mean(counted)), rel=0.01)


def test_covariances_of_strains_are_those_of_the_fields() -> None:
    """Waves that run one way each, with the amplitudes of the spectrum: no seed differs from the mean."""
    layer = WaveLayer(spreading="COSINE_SQUARED", swell=0.0, wind_direction=0.7)
    sea = OceanParameters(
        resolution=32, domain_size=200.0, amplitudes="DETERMINISTIC", choppiness=0.8, layers=(layer,)
    )
    ocean = Ocean(sea, "double")
    before, now, after = (
        ocean.surface(3.0 + s, {"strain"}).strain.reshape(-1, 3) for s in (-1e-3, 0.0, 1e-3)
    )
    of_gradient, of_rates = strain_covariances(ocean.initial_state, 0.8, (0.0, 0.0))
    for fields, expected in ((now, of_gradient), ((after - before) / 2e-3, of_rates)):
        np.testing.assert_allclose(fields.T @ fields / len(fields), expected, rtol=1e-4, atol=1e-9)


def put_on(field: np.ndarray, samples: int, rows: int) -> np.ndarray:
    """A field on other samples, so many rows at a time."""
    finer = laying.Finer(len(field), samples)
    blocks = [slice(first, min(first + rows, samples)) for first in range(0, samples, rows)]

    def given(first: int, count: int) -> list[np.ndarray]:
        return [laying.rows_of(field, first, count)]

    return np.concatenate([finer.rows(block, given, laying.linear)[0] for block in blocks])


@pytest.mark.parametrize("rows", [1, 2, 4])
def test_resampling_is_bilinear_and_periodic(rows: int) -> None:
    field = np.array([[0.0, 1.0], [2.0, 3.0]], np.float32)
    np.testing.assert_allclose(
        put_on(field, 4, rows),
        [[0, 0.5, 1, 0.5], [1, 1.5, 2, 1.5], [2, 2.5, 3, 2.5], [1, 1.5, 2, 1.5]],
    )
    np.testing.assert_array_equal(put_on(put_on(field, 8, rows), 2, rows), field)
    thirds = put_on(field, 6, rows)
    np.testing.assert_allclose(thirds[0], np.array([0, 1, 2, 3, 2, 1]) / 3, rtol=1e-6)
    np.testing.assert_allclose(put_on(thirds, 4, rows)[::2, ::2], field, atol=1e-6)
