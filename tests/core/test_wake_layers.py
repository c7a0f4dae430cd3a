# SPDX-License-Identifier: GPL-3.0-or-later
"""Wakes as a kind of waves: what a sea shows of them, wherever it is asked, and what it refuses."""

from __future__ import annotations

import dataclasses
import json
import math

import numpy as np
import pytest

from ocean_tweak.cli import main
from ocean_tweak.core import (
    Area,
    Mask,
    Ocean,
    OceanParameters,
    ParameterError,
    PathSample,
    Raster,
    Timing,
    WakeLayer,
    Water,
    WaveLayer,
)
from ocean_tweak.core.numerics.memo import MEMO
from ocean_tweak.core.parameters.fingerprint import shot_fingerprint
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.core.waves.wake.elevation import Basin
from ocean_tweak.core.waves.wake.fields import WakeWaves, Where
from ocean_tweak.core.waves.wake.foam import HullFoam
from ocean_tweak.core.waves.wake.footprint import hull_footprint
from ocean_tweak.core.waves.wake.outlook import KELVIN_ANGLE, transverse_wavelength, wake_angle
from ocean_tweak.core.waves.wake.track import Track
from ocean_tweak.export.exr import read_image

CALM = WaveLayer(muted=True)
#: from the left, a turn to the left, and a stop
TURN = (
    *(PathSample(time, 6.0 * time) for time in (0.0, 10.0)),
    *(PathSample(10.0 + time, 60.0 + 40.0 * math.sin(0.15 * time), 40.0 * (1.0 - math.cos(0.15 * time)))
      for time in np.arange(0.5, 8.1, 0.5).tolist()),
    PathSample(30.0, 60.0 + 40.0 * math.sin(1.2), 40.0 * (1.0 - math.cos(1.2))),
)  # fmt: skip
BOAT = WakeLayer(
    path=TURN, length=12.0, beam=4.0, draught=1.0, area_size=256.0, area_resolution=128, decay=0.05
)


def sea(*layers: WakeLayer, **changes: object) -> OceanParameters:
    values = {
        "resolution": 32,
        "domain_size": 100.0,
        "timing": Timing(start_frame=0),
        "layers": (CALM, *layers),
    }
    return OceanParameters(**(values | changes))


def fields(layer: WakeLayer, time: float, area: Area, *names: str, **changes: object) -> object:
    return Ocean(sea(layer, **changes)).surface(time, names or ("displacement",), on=area)


def over(size: float, samples: int, x: float = 0.0, y: float = 0.0) -> Area:
    return Area(size, samples, (x - 0.5 * size, y - 0.5 * size))


def test_json_both_ways_and_fingerprint() -> None:
    hull = Raster(np.hstack((np.ones((2, 3)), np.zeros((2, 1)))))
    given = sea(dataclasses.replace(BOAT, footprint=hull, mask=Mask(x=1.0)), BOAT)
    assert OceanParameters.from_json(given.to_json()) == given
    data = given.to_dict()["layers"][2]
    assert data["kind"] == "WAKE"
    assert data["path"][1] == {"time": 10.0, "x": 60.0, "y": 0.0, "heading": 0.0, "immersion": 1.0}
    assert "footprint" not in data
    others = [sea(BOAT), sea(BOAT.changed(draught=2.0)), sea(BOAT.changed(path=TURN[:-1]))]
    assert len({shot_fingerprint(Shot(each)) for each in (given, *others)}) == 4


def test_a_frame_alone_has_the_bytes_of_the_sequence() -> None:
    area = over(128.0, 64, 60.0, 20.0)
    names = ("displacement", "velocity", "strain")
    times = (4.0, 12.3, 17.1, 25.0)

    def shown(time: float) -> bytes:
        found = fields(BOAT, time, area, *names)
        return b"".join(found[name].tobytes() for name in names)

    MEMO.drop()
    sequence = [shown(time) for time in times]
    backwards = [shown(time) for time in times[::-1]][::-1]
    alone = []
    for time in times:
        MEMO.drop()
        alone.append(shown(time))
    assert sequence == backwards == alone
    assert len(set(alone)) == len(times)


@pytest.mark.parametrize("follows", [True, False])
def test_derivatives_are_those_of_the_displacement(follows: bool) -> None:
    """Also along the end of the area, which moves with the object."""
    layer = BOAT.changed(area_follows=follows, area_x=30.0, area_resolution=512)
    area, step = over(240.0, 480, 30.0), 1e-3
    found = fields(layer, 8.0, area, "displacement", "velocity", "slope", "strain")
    before, after = (fields(layer, 8.0 + off, area).displacement.astype(float) for off in (-step, step))
    rate = (after - before) / (2.0 * step)
    assert np.abs(rate).max() > 0.1
    np.testing.assert_allclose(found.velocity, rate, atol=0.004)
    by_y, by_x = np.gradient(found.displacement.astype(float), 0.5, axis=(0, 1))
    for made, number in (
        (found.slope[..., 0], by_x[..., 2]), (found.slope[..., 1], by_y[..., 2]),
        (found.strain[..., 0], by_x[..., 0]), (found.strain[..., 1], by_y[..., 1]),
    ):  # fmt: skip
        assert np.std(made - number) < 0.1 * np.std(made)


def test_waves_move_towards_their_crests() -> None:
    """Horizontally by a quarter of a wave, as far as up and down: D is the elevation's Hilbert transform."""
    found = fields(BOAT.changed(path=TURN[:2]), 10.0, over(128.0, 128, -10.0), "displacement", "strain")
    squeezed = found.strain[..., 0] + found.strain[..., 1]
    assert np.corrcoef(squeezed.ravel(), found.displacement[..., 2].ravel())[0, 1] < -0.6
    flat = fields(BOAT, 10.0, over(64.0, 32), choppiness=0.0).displacement
    assert np.all(flat[..., :2] == 0.0)
    assert np.any(flat[..., 2] != 0.0)


def test_in_shallow_water_the_horizontal_motion_is_as_wide_as_the_water_that_it_carries() -> None:
    """Alike at all depths where waves are long: what flows together raises the surface, η = -h ∇·D."""
    shoal = {"water": Water(depth=1.5), "orbital_motion": "FINITE_DEPTH"}
    layer = BOAT.changed(path=(PathSample(0.0), PathSample(1.0, 7.0)), length=40.0, beam=20.0, draught=0.3)
    area = over(160.0, 80, -20.0)
    found = fields(layer, 0.0, area, "displacement", "strain", **shoal)
    height, spread = found.displacement[..., 2], found.strain[..., 0] + found.strain[..., 1]
    there = np.hypot(*area.rest_positions()) < 60.0  # where the area does not fade
    share = np.sum(spread[there] * height[there]) / np.sum(height[there] ** 2)
    assert share == pytest.approx(-1.0 / 1.5, rel=0.05)
    deep = fields(layer, 0.0, area, "strain", **{**shoal, "orbital_motion": "DEEP"}).strain
    assert np.std(deep[there]) < 0.5 * np.std(found.strain[there])


def test_the_past_of_a_long_path_takes_bounded_memory() -> None:
    track = Track.of(np.arange(700.0), np.cumsum(np.random.default_rng(2).random((700, 2)), axis=0))
    made = [
        WakeWaves(Basin(64.0, 16), track, hull_footprint(6.0, 3.0, 1.0), Where(0.0, 0.0, True), math.inf)
        for _ in range(2)
    ]
    x, y = (np.array([place]) for place in track.place(690.5)[0])
    for time in np.arange(100.5, 700.0, 118.0):
        made[0].at(x, y, time, [(2, "")], 1.0)
    assert made[0].nbytes <= 8 * 2 * 16 * 9 * 8  # of eight pasts, two complex64 a wave vector
    alone, kept = (waves.at(x, y, 690.5, [(2, "")], 1.0)[2, ""] for waves in made[::-1])
    assert alone.tobytes() == kept.tobytes()


def test_outside_its_area_there_is_nothing_and_at_its_end_no_step() -> None:
    resting = BOAT.changed(area_follows=False, area_x=40.0, area_y=10.0)
    area = over(400.0, 400, 40.0, 10.0)
    for layer, middle in ((resting, (40.0, 10.0)), (BOAT.changed(path=TURN[:2]), (60.0, 0.0))):
        z = fields(layer, 10.0, area).displacement[..., 2]
        x, y = area.rest_positions()
        away = np.hypot(x - middle[0], y - middle[1])
        assert np.all(z[away > 128.0] == 0.0)
        assert np.abs(z[(away > 124.0) & (away < 128.0)]).max() < 0.01 * np.abs(z).max()
        assert np.abs(z[away < 60.0]).max() > 0.3


def test_an_area_doubled_changes_less_than_one_percent_of_the_highest_wave() -> None:
    """Of a 60 m ship at 8 m/s, at every place where the smaller area does not fade."""
    path = (PathSample(0.0), PathSample(1.0, 8.0))
    ship, area = WakeLayer(path=path, length=60.0, beam=12.0, draught=4.0), over(1024.0, 256)
    x, y = area.rest_positions()
    found = [
        fields(layer, 0.0, area).displacement[..., 2]
        for layer in (ship, ship.changed(area_size=4096.0, area_resolution=1024))
    ]
    inside, astern = np.hypot(x, y) < 500.0, x < -40.0
    assert np.abs(found[0] - found[1])[inside].max() < 0.01 * np.abs(found[1][astern]).max()


def test_wakes_of_several_add_and_cross() -> None:
    other = BOAT.changed(path=(PathSample(0.0, 60.0, -80.0), PathSample(20.0, 60.0, 60.0)))
    area = over(200.0, 100, 50.0)
    both, one, two = (
        Ocean(sea(*layers)).surface(14.0, ("displacement", "velocity"), on=area)
        for layers in ((BOAT, other), (BOAT,), (other,))
    )
    for name in ("displacement", "velocity"):
        np.testing.assert_allclose(both[name], one[name] + two[name], atol=1e-5)
    assert np.abs(one.displacement - two.displacement).max() > 0.3


@pytest.mark.parametrize("froude", [0.2, 0.35, 0.5, 0.8])
def test_outside_the_hull_the_water_never_folds(froude: float) -> None:
    """At choppiness 1, of the ellipse and of a box, as deep as ships are."""
    speed = froude * math.sqrt(9.81 * 60.0)
    area = over(400.0, 400, -60.0)
    x, y = area.rest_positions()
    path = (PathSample(0.0), PathSample(1.0, speed))
    for shape in (None, Raster(np.ones((4, 8)))):
        ship = WakeLayer(path=path, footprint=shape, draught=3.0, area_size=1024.0, area_resolution=512)
        left = fields(ship, 0.0, area, "jacobian").jacobian
        beyond = (np.abs(x) > 30.0) | (np.abs(y) > 6.0)
        assert left[beyond].min() > 0.2


def test_a_boat_in_a_sea_rides_through_its_waves() -> None:
    """Heights, areas and places tell of the same sum, also of a sea of patches and under masks."""
    wind = WaveLayer(wind_speed=6.0, fetch=20e3)
    given = sea(BOAT, layers=(wind, BOAT))
    apart = [Ocean(sea(layers=(layer,))) if layer is wind else Ocean(sea(layer)) for layer in (wind, BOAT)]
    area = over(64.0, 32, 40.0)
    total, *parts = (
        each.surface(9.0, ("displacement",), on=area).displacement for each in (Ocean(given), *apart)
    )
    np.testing.assert_allclose(total, sum(parts), atol=1e-5)
    flat = given.replace(choppiness=0.0)
    x, y = np.array([31.0, 44.5]), np.array([3.0, -2.0])
    expected = sum(Ocean(each.parameters.replace(choppiness=0.0)).height_at(x, y, 9.0) for each in apart)
    np.testing.assert_allclose(Ocean(flat).height_at(x, y, 9.0), expected, atol=1e-3)
    harbour = Mask(x=70.0, y=0.0, inner_radius=20.0, outer_radius=30.0)
    masked = fields(BOAT.changed(mask=harbour), 9.0, over(20.0, 10, 70.0)).displacement
    assert np.abs(masked).max() == 0.0
    assert np.abs(fields(BOAT, 9.0, over(20.0, 10, 70.0)).displacement).max() > 0.03


def test_a_press_makes_rings() -> None:
    """What falls in at 2 s: nothing before, then waves that run out as fast as gravity lets them."""
    immersions = ((0.0, 0.0), (2.0, 0.0), (2.25, 1.0), (2.5, 0.0))
    drop = BOAT.changed(
        path=tuple(PathSample(time, immersion=share) for time, share in immersions), length=2.0, beam=2.0,
        area_size=64.0, area_resolution=128,
    )  # fmt: skip
    area = over(60.0, 120)
    r = np.hypot(*area.rest_positions())
    assert np.all(fields(drop, 1.9, area).displacement == 0.0)
    spread = []
    for time in (4.0, 6.0):
        z = fields(drop, time, area).displacement[..., 2]
        spread.append(np.sqrt(np.average(r**2, weights=z**2)))
        assert z.max() > 0.005
        np.testing.assert_allclose(z[1:, 1:], z[1:, 1:].T, atol=1e-4)
    assert spread[1] > 1.5 * spread[0]


def test_only_capillary_dispersion_knows_of_surface_tension() -> None:
    area, path = over(1.5, 24), (PathSample(0.0), PathSample(1.0, 0.4))
    ripples = BOAT.changed(path=path, length=0.2, beam=0.1, draught=0.01, area_size=2.0)
    heavy = {"water": Water(surface_tension=1.0)}
    without, with_it = (
        [fields(ripples, 0.0, area, dispersion=law, **water).displacement for water in ({}, heavy)]
        for law in ("FINITE_DEPTH", "CAPILLARY")
    )
    np.testing.assert_array_equal(*without)
    assert np.abs(with_it[0] - with_it[1]).max() > 0.2 * np.abs(with_it[0]).max()


def test_a_path_points_ahead_before_it_begins_and_is_half_as_deep_between_up_and_down() -> None:
    """What waits points to where it will go; of a stretch counts its middle."""
    track = Track.of([0.0, 1.0, 2.0], [[0.0, 0.0], [0.0, 0.0], [0.0, 5.0]], immersions=[0.0, 1.0, 0.5])
    assert [piece.heading for piece in (track.first, *track.pieces)] == [0.5 * math.pi] * 3
    assert [piece.immersion for piece in track.pieces] == [0.5, 0.75]


def test_headings_may_be_told() -> None:
    """A boat that goes sideways has another wake; one that points along its path, the same."""
    east, north = (
        BOAT.changed(
            headings="OF_SAMPLES", path=tuple(dataclasses.replace(each, heading=heading) for each in TURN[:2])
        )
        for heading in (0.0, 0.5 * math.pi)
    )
    area = over(100.0, 50)
    along, told, across = (fields(layer, 5.0, area).displacement for layer in (BOAT, east, north))
    np.testing.assert_array_equal(told, along)
    assert np.abs(across - along).max() > 0.3


def test_a_hull_of_an_image_is_where_its_image_is() -> None:
    """At rest water goes down where the hull is: its bow half alone presses ahead of the origin."""
    bow = Raster(np.hstack((np.zeros((4, 8)), np.ones((4, 8)))))
    still = BOAT.changed(path=(PathSample(0.0),), footprint=bow, beam=6.0, decay=1e-3)
    area = over(32.0, 32)
    x, _ = area.rest_positions()
    z = fields(still, 0.0, area, choppiness=0.0).displacement[..., 2]
    assert np.average(x, weights=np.maximum(-z - 0.1, 0.0)) == pytest.approx(3.0, abs=0.25)
    assert -1.0 < z.min() < -0.6


def test_a_hull_that_is_shallow_in_part_is_there_all_the_same() -> None:
    shape = np.hstack((np.full((4, 8), 0.3), np.ones((4, 8))))
    stern, bow = (
        half.sum() for half in np.array_split(hull_footprint(40.0, 8.0, 2.0, shape).draught, 2, axis=1)
    )
    assert stern / bow == pytest.approx(0.3, abs=0.05)


BAD = {
    r"layers\.1\.path = .*has no samples": {"path": ()},
    r"path\.1\.time = 0\.0: must be later than the sample before it, 0 s": {
        "path": (PathSample(), PathSample())
    },
    r"layers\.1\.path\.1 = '80 m/s': is too fast for an area of 256 m: transverse waves are 4099 m long\. "
    r"Make the area larger, or the object slower than 14\.1 m/s; where it jumps": {
        "path": (PathSample(), PathSample(1.0, 80.0))
    },
    r"layers\.1\.path\.1 = '1e\+306 m/s': is too fast": {"path": (PathSample(), PathSample(1e-300, 1e6))},
    r"layers\.1\.area_size = 256\.0: must be at least 600 m, 3 times the hull": {"length": 200.0},
    r"layers\.1\.area_resolution = 128: must be at least 1280": {"beam": 0.2},
    "area_resolution = 127: must be an even number": {"area_resolution": 127},
    "footprint = '0 to 0': must be shares of the draught.*above the water": {
        "footprint": Raster(np.zeros((2, 2)))
    },
    "footprint = '-1 to 1'": {"footprint": Raster([[-1.0, 1.0]])},
    "draught = 0": {"draught": 0.0},
    "beam = 0": {"beam": 0.0},
}


@pytest.mark.parametrize(("message", "changes"), BAD.items())
def test_what_cannot_be_is_refused_with_the_remedy(message: str, changes: dict[str, object]) -> None:
    with pytest.raises(ParameterError, match=message) as caught:
        sea(BOAT.changed(**changes))
    assert "\n" not in str(caught.value)


def test_muted_it_may_be_what_no_sea_can_have() -> None:
    given = sea(BOAT.changed(path=(), muted=True))
    assert Ocean(given).surface(0.0).displacement.shape == (32, 32, 3)  # a tile, for nothing does not repeat


def test_what_is_expected_of_a_wake() -> None:
    ship = WakeLayer(path=(PathSample(), PathSample(10.0, 80.0)))
    told = WakeLayer.outlook(sea(ship, BOAT.changed(path=TURN[:1])))
    first, second = told.wakes
    assert (first.speed, first.wavelength) == (8.0, pytest.approx(40.99, abs=0.01))
    assert first.froude == pytest.approx(8.0 / math.sqrt(9.81 * 60.0))
    assert first.angle == KELVIN_ANGLE
    assert first.warnings == ()
    assert "rests" in second.line()
    coarse = WakeLayer.outlook(sea(ship.changed(area_resolution=192, beam=30.0)))
    assert "too coarse. Raise area_resolution" in coarse.warnings[0]
    around = WakeLayer.outlook(sea(ship.changed(area_size=512.0)))
    assert "come around the area" in around.warnings[0]
    deep = WakeLayer.outlook(sea(ship.changed(draught=12.0)))
    assert "folds beside it. Make draught" in deep.warnings[0]
    aground = WakeLayer.outlook(sea(ship, water=Water(depth=2.5)))
    assert "more than the water's depth of 2.5 m" in aground.warnings[-1]
    assert len(told.lines()) == 3
    assert json.dumps(told.to_plain())
    shallow = WakeLayer.outlook(sea(ship, water=Water(depth=5.0))).wakes[0]
    assert math.isinf(shallow.wavelength)
    assert "no transverse waves" in shallow.line()


@pytest.mark.parametrize(("length", "speed"), [(2.0, 1.0), (15.0, 5.0), (60.0, 8.0), (200.0, 14.0)])
def test_an_area_to_begin_with_holds_the_waves_of_its_object(length: float, speed: float) -> None:
    path = (PathSample(), PathSample(1.0, speed))
    ship = WakeLayer(path=path, length=length, beam=0.2 * length, draught=0.06 * length)
    assert WakeLayer.outlook(sea(ship.in_an_area(speed, 9.81))).warnings == ()
    scaled = ship.changed(amplitude_scale=4.0).in_an_area(speed, 9.81)
    assert "folds beside it" in WakeLayer.outlook(sea(scaled)).warnings[0]


def test_transverse_waves_of_a_depth_go_as_fast_as_the_object() -> None:
    water = Water(depth=8.0, surface_tension=0.0)
    length = transverse_wavelength(6.0, sea(water=water))
    k = 2.0 * math.pi / length
    assert math.sqrt(9.81 * math.tanh(8.0 * k) / k) == pytest.approx(6.0)
    assert transverse_wavelength(0.0, sea()) == 0.0
    assert transverse_wavelength(1e-200, sea()) == 0.0
    assert wake_angle(0.4) == pytest.approx(math.radians(19.47), abs=1e-4)
    assert [wake_angle(froude) * froude for froude in (4.0, 8.0)] == pytest.approx([0.2, 0.2], abs=0.003)


def test_images_and_layers_of_an_area_hold_it(tmp_path, capsys) -> None:
    """The command line tells of it, and its files hold what `surface` gives."""
    given = sea(BOAT, timing=Timing(start_frame=0, fps=10))
    path = tmp_path / "boat.json"
    path.write_text(given.to_json())
    assert main(["info", "--params", str(path)]) == 0
    assert "wake 0: up to 6 m/s" in capsys.readouterr().out
    where = ["--area", "128", "64", "0", "-64"]
    assert (
        main(["bake", "--params", str(path), "--frames=80-81", *where, "--out", str(tmp_path), "--workers=1"])
        == 0
    )
    (folder,) = tmp_path.glob("boat-*/v*")
    image, _ = read_image(folder / "boat_disp.0080.exr")
    expected = Ocean(given).frame(80, on=Area(128.0, 64, (0.0, -64.0))).displacement
    np.testing.assert_allclose(image, expected, atol=2e-5)
    assert main(["bake", "--params", str(path), "--frames=80", "--out", str(tmp_path), "--workers=1"]) == 2
    assert "do not repeat with the domain" in capsys.readouterr().err


def test_the_band_astern_widens_with_the_fifth_root_of_the_distance() -> None:
    """Milgram, Skop, Peltzer & Griffin (1993); as wide as the beam at the stern."""
    track = Track.of([0.0, 100.0], [[0.0, 0.0], [800.0, 0.0]])
    hull = HullFoam(track, 40.0, 8.0, 1.0, 600.0, 9.81)
    y = np.arange(0.0, 15.0, 0.02)
    edges = []
    for beams in (0.0, 4.0, 31.0):
        astern = np.full(y.size, 800.0 - 20.0 - 8.0 * beams - 0.01)
        foam = hull.at(astern, y, 100.0).foam
        edges.append(float(y[np.argmax(foam < 0.02 * foam[0])]))  # farther out are the bow's arms
    assert edges[0] == pytest.approx(4.0, abs=0.05)
    assert edges[1] / edges[0] == pytest.approx(5.0**0.2, abs=0.02)
    assert edges[2] / edges[0] == pytest.approx(32.0**0.2, abs=0.03)
