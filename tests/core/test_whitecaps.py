# SPDX-License-Identifier: GPL-3.0-or-later
"""How much foam a wind leaves at sea, how much of it is new, and the windrows in which the old lies."""

from __future__ import annotations

import dataclasses
import math
from fractions import Fraction

import numpy as np
import pytest

from ocean_tweak.core import Area, Foam, Ocean, OceanParameters, Patch, WaveLayer
from ocean_tweak.core.foam.threshold import foam_outlook, whitecap_coverage
from ocean_tweak.core.foam.windrows import windrows
from ocean_tweak.core.sea.regions import Places
from ocean_tweak.core.synthesis.channels import OF_MEMORY, SurfaceFields

#: by wind in m/s: 3.18e-5 (U - 3.70)³ up to 10.18 m/s, then 4.82e-6 (U + 1.98)³, by hand
CALLAGHAN = {5.0: 6.9865e-5, 10.0: 7.9515e-3, 15.0: 2.3597e-2, 20.0: 5.1184e-2, 25.0: 9.4661e-2}
#: 3.84e-6 U^3.41
MONAHAN = {10.0: 0.00987, 15.0: 0.0393, 20.0: 0.1049}


def sea(
    wind: float, resolution: int = 160, spacing: float = 50.0 / 160.0, **changes: object
) -> OceanParameters:
    """A sea of some wind in m/s on samples that are `spacing` times the wind apart, m."""
    layer = WaveLayer(wind_speed=wind, fetch=200e3)
    size = resolution * spacing * wind
    return OceanParameters(**{"resolution": resolution, "domain_size": size, "layers": (layer,), **changes})


def on_the_plane(fields: SurfaceFields, name: str = "foam") -> float:
    """The mean of a field over the horizontal plane: samples count by the area that is left of theirs."""
    return float(np.sum(fields[name] * fields.jacobian) / np.sum(fields.jacobian))


def test_laws_are_the_published_ones() -> None:
    for wind, share in CALLAGHAN.items():
        assert whitecap_coverage(wind) == pytest.approx(share, rel=1e-4)
    assert whitecap_coverage(3.7) == whitecap_coverage(0.0) == 0.0
    assert whitecap_coverage(10.18) == pytest.approx(whitecap_coverage(10.1801), rel=0.01)  # the curves meet
    # 3.18e-5 · 6.4³ before, and 4.82e-6 · 12.28³ after: the other curve would give 2.4 % more there
    assert whitecap_coverage(10.1) == pytest.approx(0.0083362, rel=1e-3)
    assert whitecap_coverage(10.3) == pytest.approx(0.0089258, rel=1e-3)
    for wind, share in MONAHAN.items():
        assert whitecap_coverage(wind, "MONAHAN_1980") == pytest.approx(share, rel=2e-3)
    assert whitecap_coverage(500.0) == 1.0


@pytest.mark.parametrize("wind", CALLAGHAN)
def test_foam_covers_what_the_wind_leaves(wind: float) -> None:
    found = []
    for seed in range(3):
        ocean = Ocean(sea(wind, seed=seed))
        found += [on_the_plane(ocean.surface(t, {"foam", "jacobian"})) for t in (30.0, 36.0)]
    assert np.mean(found) == pytest.approx(CALLAGHAN[wind], rel=0.25)


def test_the_law_and_how_much_of_it_can_be_chosen() -> None:
    covered = {}
    choices = {
        "as it is": Foam(), "twice": Foam(coverage=2.0), "none": Foam(coverage=0.0),
        "coarse": Foam(resolution=96), "Monahan": Foam(law="MONAHAN_1980"),
    }  # fmt: skip
    for name, choice in choices.items():
        ocean = Ocean(sea(15.0, seed=2, foam=dataclasses.replace(choice, half_life=1.0)))
        covered[name] = on_the_plane(ocean.surface(20.0, {"foam", "jacobian"}))
    assert covered["twice"] / covered["as it is"] == pytest.approx(2.0, rel=0.15)
    assert covered["coarse"] / covered["as it is"] == pytest.approx(1.0, rel=0.25)
    assert covered["Monahan"] / covered["as it is"] == pytest.approx(0.0393 / 0.023597, rel=0.15)
    assert covered["none"] == 0.0
    monahan = sea(15.0, foam=Foam(law="MONAHAN_1980"))
    assert foam_outlook(monahan).coverage == pytest.approx(0.0393, rel=2e-3)
    assert OceanParameters.from_json(monahan.to_json()) == monahan


def test_a_sea_that_names_no_law_has_the_usual_one() -> None:
    """Nor does its JSON, so that it is the same sea as before there were two."""
    told = sea(15.0).to_dict()
    assert "law" not in told["foam"]
    assert OceanParameters.from_dict(told).foam.law == "CALLAGHAN_2008"
    with pytest.raises(
        ValueError, match=r"foam\.law = 'WU_1979': must be one of CALLAGHAN_2008, MONAHAN_1980"
    ):
        OceanParameters.from_dict({"foam": {"law": "WU_1979"}})


@pytest.mark.parametrize("wind", [10.0, 15.0, 20.0, 25.0])
@pytest.mark.parametrize("coarse", [False, True])
def test_some_tenth_of_the_foam_is_new(wind: float, coarse: bool) -> None:
    """Of all foam, added up over samples 1.6 m apart, or up to 8 m."""
    new = old = 0.0
    ocean = Ocean(sea(wind) if coarse else sea(wind, 256, 400.0 / 256.0 / wind))
    for time in (30.0, 34.0):
        fields = ocean.surface(time, {"foam", "breaking"})
        new, old = new + np.sum(fields.breaking), old + np.sum(fields.foam)
    assert 0.03 < new / old < 0.15


# windrows


def correlation_lengths(field: np.ndarray, spacing: float) -> np.ndarray:
    """Along x and y: how far the correlation of a periodic field with itself is over 1/e, m."""
    power = np.abs(np.fft.rfft2(field - np.mean(field))) ** 2
    correlation = np.fft.irfft2(power, field.shape)
    lengths = []
    for line in (correlation[0], correlation[:, 0]):
        line = line / line[0]
        end = int(np.argmax(line < 1.0 / math.e))
        lengths.append(end - 1 + (line[end - 1] - 1.0 / math.e) / (line[end - 1] - line[end]))
    return spacing * np.array(lengths)


@pytest.mark.parametrize(
    ("wind", "low", "high"), [(9.0, 1.0 / 1.3, 1.3), (10.5, 1.0 / 1.3, 1.3), (22.0, 2.0, 9.0)]
)
def test_old_foam_lies_in_lines_from_9_bft_and_not_at_5(wind: float, low: float, high: float) -> None:
    """On a square kilometre, along the wind against across it."""
    layer = WaveLayer(wind_speed=wind, fetch=300e3)
    fields = Ocean(OceanParameters(resolution=400, domain_size=1000.0, layers=(layer,))).surface(
        40.0, {"foam", "foam_age"}
    )
    along, across = correlation_lengths(np.where(fields.foam_age > 0.0, fields.foam, 0.0), 2.5)
    assert low < along / across < high


@pytest.mark.parametrize("direction", [0.4, 1.2, 2.8])
def test_windrows_lie_along_any_wind(direction: float) -> None:
    """How much foam there is changes across the wind, several times as quickly as along it."""
    rows = windrows(25.0, direction, 1000.0, 3)
    assert rows is not None
    x, y = np.random.default_rng(4).uniform(0.0, 1000.0, (2, 2000))
    foam = np.full(x.shape, 0.2, np.float32)
    here = rows.gathered(foam, rows.sources(x, y)[2])
    along, across = (
        np.std(rows.gathered(foam, rows.sources(x + math.cos(angle), y + math.sin(angle))[2]) - here)
        for angle in (direction, direction + 0.5 * math.pi)
    )
    assert across > 4.0 * along


def test_neighbours_in_windrows_come_from_neighbours() -> None:
    """Of places 0.1 m apart, all but where a cell ends."""
    rows = windrows(25.0, 0.0, 1000.0, 3)
    assert rows is not None
    x, y = np.random.default_rng(4).uniform(0.0, 1000.0, (2, 4000))
    here, there = rows.sources(x, y)[0], rows.sources(x, y + 0.1)[0]
    assert np.mean(np.abs(there - here) > 2.0) < 0.05


def test_lines_end_in_points_and_are_not_cut_off_straight() -> None:
    """On ways along the wind, half a metre apart: how far from each other a cell ends on two of them."""
    rows = windrows(25.0, 0.0, 1000.0, 3)
    assert rows is not None
    ways = 40.0 * np.arange(1.0, 12.0)[:, np.newaxis] + (0.0, 0.5)
    x, y = np.meshgrid(np.arange(0.0, 1000.0, 0.25), ways.ravel())
    off = rows.sources(x, y)[0] - x
    apart = []
    for first, second in zip(off[::2], off[1::2], strict=True):
        ends = [x[0, 1:][np.abs(np.diff(each)) > 10.0] for each in (first, second)]
        apart += [float(np.min(np.abs(ends[1] - end))) for end in ends[0]]
    assert len(apart) > 150
    assert 2.0 < np.median(apart) < 5.0


def test_windrows_rise_from_7_to_9_bft() -> None:
    strengths = [rows.strength if (rows := windrows(wind, 0.0, 400.0, 0)) else 0.0 for wind in range(12, 24)]
    assert strengths[:2] == [0.0, 0.0]
    assert strengths[-3:] == [1.0, 1.0, 1.0]
    assert np.all(np.diff(strengths[1:-2]) > 0.0)
    assert windrows(25.0, 0.0, 99.0, 0) is None  # there is no room for them


@pytest.mark.parametrize("direction", [0.0, 0.9])
def test_windrows_repeat_with_the_sea_and_keep_the_mean(direction: float) -> None:
    rows = windrows(25.0, direction, 600.0, 3)
    assert rows is not None
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(0.0, 600.0, 4.0), np.arange(0.0, 600.0, 4.0)))
    source_x, source_y, lines = rows.sources(x, y)
    again_x, again_y, again = rows.sources(x + 1200.0, y - 600.0)
    for found, expected in ((again_x - 1200.0, source_x), (again_y + 600.0, source_y), (again, lines)):
        assert np.mean(np.abs(found - expected) > 1e-3) < 1e-3  # but where a cell ends
    # drawn along the wind, by a part of half a cell and, where a line ends in a point, of somewhat more
    along = (source_x - x) * math.cos(direction) + (source_y - y) * math.sin(direction)
    across = (source_y - y) * math.cos(direction) - (source_x - x) * math.sin(direction)
    assert 15.0 < np.percentile(np.abs(along), 90.0) < 20.0
    assert np.max(np.abs(along)) < 35.0
    assert np.max(np.abs(across)) < 0.1 * np.max(np.abs(along))
    share = rows.gathered(np.full(lines.shape, 0.2, np.float32), lines) / 0.2
    assert np.mean(share) == pytest.approx(1.0, abs=0.15)
    assert np.max(share) / np.min(share) > 10.0


@pytest.mark.parametrize("spacing", [0.5, 8.0])
def test_gathering_foam_into_lines_keeps_how_much_there_is(spacing: float) -> None:
    """Of thin foam and thick, at places all over ten square kilometres and of several seeds."""
    seas = []
    for seed in range(4):
        rows = windrows(25.0, 0.4, 3200.0, seed, spacing)
        assert rows is not None
        seas.append(rows.sources(*np.random.default_rng(seed).uniform(0.0, 3200.0, (2, 20000)))[2])
    pattern = np.concatenate(seas)
    for share in (0.02, 0.1, 0.3, 0.6, 0.95):
        gathered = rows.gathered(np.full(pattern.shape, share, np.float32), pattern)
        assert np.mean(gathered) == pytest.approx(share, rel=0.05, abs=0.005)
        assert gathered.min() >= 0.0
        assert gathered.max() <= 1.0
    assert not np.any(rows.gathered(np.zeros(pattern.shape, np.float32), pattern))
    assert np.std(rows.gathered(np.full(pattern.shape, 0.2, np.float32), pattern)) > 0.15


def lines_across(spacing: float, step: float) -> np.ndarray:
    """(40, places) logarithms of what lines gather, on ways across the wind, places `step` m apart."""
    rows = windrows(25.0, 0.0, 4096.0, 5, spacing)
    assert rows is not None
    x, y = np.meshgrid(np.linspace(0.0, 4096.0, 40, endpoint=False), np.arange(0.0, 4096.0, step))
    return np.log(rows.sources(x, y)[2].T)


def test_lines_have_all_spacings_from_metres_to_a_hundred_and_more() -> None:
    """Each octave of them across the wind has a part of the variance, and none has most of it."""
    power = np.mean(np.abs(np.fft.rfft(lines_across(0.0, 1.0), axis=1)) ** 2, axis=0)
    spacing = 4096.0 / np.maximum(np.arange(len(power)), 1e-3)
    octaves = [5.0 * 2.0**number for number in range(6)]
    parts = [np.sum(power[(spacing >= low) & (spacing < 2.0 * low)]) / np.sum(power[1:]) for low in octaves]
    assert min(parts) > 0.05
    assert max(parts) < 0.35


def test_lines_that_samples_cannot_hold_are_left_out() -> None:
    """Neighbours tell of each other on coarse samples too; lines of all widths there would be speckle."""
    for spacing in (2.0, 8.0, 16.0):
        held = lines_across(spacing, spacing)
        alike = np.corrcoef(held[:, 1:].ravel(), held[:, :-1].ravel())[0, 1]
        assert alike > 0.4
    everything = lines_across(0.0, 16.0)
    assert np.corrcoef(everything[:, 1:].ravel(), everything[:, :-1].ravel())[0, 1] < 0.3


def test_windrows_leave_the_new_foam_and_the_mean_of_the_old() -> None:
    with_them, without = (Ocean(sea(22.0, seed=4)) for _ in range(2))
    assert with_them.foam_model.windrows is not None
    without.__dict__["foam_model"] = dataclasses.replace(without.foam_model, windrows=None)
    foam, plain = [], []
    for time in (20.0, 27.0):
        drawn, born = (ocean.surface(time, OF_MEMORY) for ocean in (with_them, without))
        np.testing.assert_array_equal(drawn.breaking, born.breaking)
        assert np.abs(drawn.foam - born.foam).max() > 0.5
        foam.append(np.mean(drawn.foam))
        plain.append(np.mean(born.foam))
    assert np.mean(foam) == pytest.approx(np.mean(plain), rel=0.12)


def test_foam_that_leaves_nothing_has_no_windrows_to_lie_in() -> None:
    """A half-life of 0 in a storm, in which all old foam would be drawn out: what breaks is all there is."""
    patches = (Patch(120.0, 0.3, 12.0, 1e6, 40), Patch(31.0, -0.9, 3.0, 12.0, 32))
    layers = (WaveLayer(wind_speed=24.0, fetch=200e3),)
    ocean = Ocean(OceanParameters(layers=layers, patches=patches, foam=Foam(half_life=0.0)))
    assert ocean.foam_model.windrows is not None
    assert ocean.foam_model.windrows.strength == 1.0
    x, y = np.random.default_rng(3).uniform(0.0, 300.0, (2, 4000))
    found = ocean.surface(3.0, {*OF_MEMORY, "cusp"}, on=Places(x, y))
    born = found.foam > 0.0
    assert np.count_nonzero(born) > 20
    assert np.min(found.cusp[born]) >= np.max(found.cusp[~born])
    np.testing.assert_array_equal(found.foam, found.breaking)
    assert not found.foam_age.any()


def test_windrows_drift_with_the_foam() -> None:
    """With as much time as the foam takes for a sample they are moved by one."""
    ocean = Ocean(sea(25.0, 64, 6.0 / 64.0, foam=Foam(drift=0.04)))
    model = ocean.foam_model
    assert model.windrows is not None
    assert model.drifted(Fraction(3)) == pytest.approx((3.0, 0.0))
    assert dataclasses.replace(model, loop_duration=Fraction(5)).drifted(Fraction(3)) == (0.0, 0.0)


STORM = sea(24.0, 128, 6.0 / 128.0, foam=Foam(half_life=0.5))


@pytest.mark.parametrize("drift", [0.0, 0.02])
def test_an_area_shows_the_foam_of_the_tile(drift: float) -> None:
    ocean = Ocean(STORM.replace(foam=Foam(half_life=0.5, drift=drift)))
    tile = ocean.surface(4.07, OF_MEMORY)
    size = STORM.domain_size
    for corner in ((0.0, 0.0), (3.0 * size, -size)):
        there = ocean.surface(4.07, OF_MEMORY, on=Area(size, 128, corner))
        for name in OF_MEMORY:
            np.testing.assert_allclose(there[name], tile[name], atol=1e-4)
    between = ocean.surface(4.07, OF_MEMORY, on=Area(size / 7.0, 100, (1.0, 2.0)))
    assert np.all(between.breaking <= between.foam)
    assert not np.any(between.foam_age[between.breaking > 0.0])
    assert np.all(np.isin(np.round(between.foam_age, 4), np.round(tile.foam_age, 4)))  # no mean of two


PATCHES = (
    Patch(domain_size=300.0, resolution=128, shortest_wavelength=20.0),
    Patch(domain_size=95.0, resolution=128, rotation=0.5, longest_wavelength=20.0, shortest_wavelength=4.0),
)


@pytest.mark.parametrize(("drift", "samples"), [(0.0, 256), (0.02, 512)])
def test_merged_patches_have_the_foam_of_their_sum(drift: float, samples: int) -> None:
    """Away from the far sides, where one patch goes over into the next.

    Foam that drifts is laid between samples on the one grid, and not where places look back: it wants finer
    ones to be as like.
    """
    apart = OceanParameters(
        seed=3, layers=(WaveLayer(wind_speed=22.0, wind_direction=0.4, fetch=200e3),), patches=PATCHES,
        foam=Foam(half_life=0.5, drift=drift),
    )  # fmt: skip
    merged = Ocean(apart.on_one_grid(samples)).surface(4.0, OF_MEMORY)
    part = slice(0, round(0.82 * samples), samples // 85)
    along = 300.0 / samples * np.arange(samples)[part]
    at_places = Ocean(apart).surface(4.0, OF_MEMORY, on=Places(along, along[:, np.newaxis]))
    for name in ("foam", "breaking"):
        one, other = merged[name][part, part], at_places[name]
        assert np.corrcoef(one.ravel(), other.ravel())[0, 1] > 0.95
        assert np.mean(one) == pytest.approx(np.mean(other), rel=0.1)


@pytest.mark.parametrize("precision", ["single", "double"])
@pytest.mark.parametrize(
    "changes",
    [
        {"loop_duration": Fraction(3)},
        {"foam": Foam(half_life=0.0)},
        {"foam": Foam(resolution=32, half_life=0.3)},
    ],
    ids=["loop", "no half-life", "coarser"],
)
def test_a_storm_in_any_frame_alone(changes: dict, precision: str) -> None:
    parameters = STORM.replace(resolution=64, **changes)
    ocean = Ocean(parameters, precision)
    with np.errstate(all="raise", under="ignore"):
        frames = [ocean.frame(frame, OF_MEMORY) for frame in (30, 30.5, 31)]
        alone = Ocean(parameters, precision).frame(31, OF_MEMORY)
    for name in OF_MEMORY:
        np.testing.assert_array_equal(alone[name], frames[-1][name])
        assert all(np.all(np.isfinite(each[name])) for each in frames)
    assert np.any(frames[0].foam != frames[1].foam)
    if "loop_duration" in changes:
        round_once = ocean.frame(31 + 72, OF_MEMORY)
        assert all(np.array_equal(round_once[name], alone[name]) for name in OF_MEMORY)
