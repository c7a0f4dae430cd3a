# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves of moving objects, against Kelvin (1887), dispersion, and what sums of waves must do."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from ocean_tweak.core import wake_elevation

G = 9.81
#: m/s, and 2π U²/g
SPEED, TRANSVERSE = 8.0, 40.99
#: asin(1/3), Kelvin's
KELVIN = 19.47


def bump(deviation: float, elongation: float = 1.0, samples: int = 17) -> dict[str, object]:
    """A Gaussian of 1 m draught, `elongation` times longer than wide."""
    spacing = 0.5 * deviation
    y, x = np.mgrid[: samples * elongation, : samples * elongation] * spacing
    bell = np.exp(-0.5 * ((y - y.mean()) ** 2 + ((x - x.mean()) / elongation) ** 2) / deviation**2)
    return {"footprint": bell, "spacing": spacing}


def ahead(time: float = 0.0, speed: float = SPEED, **more: object) -> np.ndarray:
    """Of what goes along x for ever and is in the middle at 0 s."""
    given = {"area": 2048.0, "resolution": 1024, **bump(2.0), **more}
    return wake_elevation([0.0, 1.0], [[0.0, 0.0], [speed, 0.0]], time, **given)


def along(area: float = 2048.0, resolution: int = 1024) -> np.ndarray:
    return (np.arange(resolution) - resolution // 2) * (area / resolution)


def rms_by_angle(h: np.ndarray, angles: np.ndarray, near: float, far: float) -> np.ndarray:
    """Of the waves along rays astern, each distance weighted as Kelvin's cusps fall off, by d^(-1/3)."""
    step, middle = 2.0, len(h) // 2
    distance = np.arange(near, far, 0.5)
    found = []
    for angle in np.radians(angles):
        column, row = middle - distance / step, middle + distance * np.tan(angle) / step
        j, i = column.astype(int), row.astype(int)
        u, v = column - j, row - i
        value = (h[i, j] * (1 - u) + h[i, j + 1] * u) * (1 - v) + (
            h[i + 1, j] * (1 - u) + h[i + 1, j + 1] * u
        ) * v
        found.append(np.sqrt(np.mean(value**2 * distance ** (2.0 / 3.0))))
    return np.array(found)


def test_transverse_waves_are_as_long_as_a_wave_of_that_speed() -> None:
    line = ahead(**bump(4.0))[512, : 512 - 50][::-1]  # from 100 m astern on
    down = np.flatnonzero((line[:-1] < 0.0) & (line[1:] >= 0.0))
    down = down[down < 250]
    crossings = 2.0 * (down - line[down] / (line[down + 1] - line[down]))
    assert np.diff(crossings).mean() == pytest.approx(TRANSVERSE, rel=0.01)
    assert pytest.approx(TRANSVERSE, abs=0.01) == 2.0 * np.pi * SPEED**2 / G


@pytest.mark.parametrize("deviation", [2.0, 4.0, 8.0])
def test_highest_waves_stand_on_kelvins_wedge(deviation: float) -> None:
    h, angles = ahead(**bump(deviation)), np.arange(12.0, 24.0, 0.1)
    peaks = []
    for near, far in ((150.0, 400.0), (400.0, 800.0), (800.0, 980.0)):
        rms = rms_by_angle(h, angles, near, far)
        peaks.append(angles[rms.argmax()])
    assert 17.3 <= np.median(peaks) <= 19.5
    assert all(a < b < KELVIN for a, b in pairwise(peaks))  # nearer with distance
    rms = rms_by_angle(h, angles, 400.0, 900.0)
    outside = angles[rms.argmax() :][rms[rms.argmax() :] < 0.5 * rms.max()]
    assert 19.5 <= outside[0] <= 20.5
    assert np.allclose(h[513:], h[511:0:-1], atol=1e-5 * np.abs(h).max())  # both sides are alike


def test_above_froude_one_half_the_wake_is_narrower() -> None:
    angles, found = np.arange(4.0, 24.0, 0.1), []
    for froude in (0.5, 1.0, 1.5):  # after Rabaud & Moisy (2013), whose hulls make waves as long as they are
        length = SPEED**2 / (G * froude**2)
        rms = rms_by_angle(ahead(**bump(length / np.pi / 2.0)), angles, 300.0, 900.0)
        found.append(angles[rms.argmax()])
    assert found[0] > found[1] > found[2]
    assert found[0] == pytest.approx(KELVIN, abs=2.0)
    for froude, angle in ((1.0, found[1]), (1.5, found[2])):
        expected = np.sqrt(2.0 * np.pi * froude**2 - 1.0) / (4.0 * np.pi * froude**2 - 1.0)
        assert np.tan(np.radians(angle)) == pytest.approx(expected, rel=0.3)


def test_nothing_is_ahead_in_deep_water() -> None:
    h = ahead(**bump(4.0), decay=0.03)  # which fades before it comes around the area
    x = along()
    front, behind = (np.abs(h[:, (x * side > 30.0) & (x * side < 300.0)]).max() for side in (1.0, -1.0))
    assert front < 0.01 * behind


def test_faster_than_any_wave_of_the_depth_there_are_no_transverse_waves() -> None:
    """√(gh) is 7 m/s in 5 m: at 6 m/s waves follow on the path, at 9 m/s none do."""
    x = along(1024.0, 512)
    behind = (x < -60.0) & (x > -300.0)
    given = {"area": 1024.0, "resolution": 512, "depth": 5.0, "decay": 0.02, **bump(4.0)}
    slow, fast = (ahead(speed=speed, **given) for speed in (6.0, 9.0))
    on_path = [
        np.ptp(h[256, behind] - np.convolve(h[256], np.ones(15) / 15, "same")[behind]) for h in (slow, fast)
    ]
    assert on_path[0] > 5.0 * on_path[1]


def test_a_frame_alone_has_the_bytes_of_any_other_order() -> None:
    times = np.linspace(0.0, 10.0, 11)
    places = np.stack((6.0 * times, 3.0 * np.sin(times)), axis=-1)
    given = {"area": 256.0, "resolution": 128, **bump(2.0)}
    first = [wake_elevation(times, places, time, **given).tobytes() for time in (3.3, 7.0, 10.0)]
    again = [wake_elevation(times, places, time, **given).tobytes() for time in (10.0, 7.0, 3.3)]
    assert first == again[::-1]
    longer = wake_elevation(times[:9], places[:9], 7.0, **given)
    assert longer.dtype == np.float64
    assert longer.tobytes() == first[1]  # the future has no part in it


def test_pieces_that_go_straight_on_are_one() -> None:
    given = {"area": 512.0, "resolution": 128, **bump(4.0)}
    ends = wake_elevation([0.0, 20.0], [[-160.0, 0.0], [0.0, 0.0]], 20.0, **given)
    times = np.linspace(0.0, 20.0, 6)
    many = wake_elevation(times, np.stack((-160.0 + 8.0 * times, 0.0 * times), -1), 20.0, **given)
    np.testing.assert_allclose(many, ends, atol=1e-5 * np.abs(ends).max())


def test_before_the_first_sample_it_has_moved_for_ever() -> None:
    given = {"area": 512.0, "resolution": 128, **bump(4.0)}
    long_ago = wake_elevation([-2000.0, 0.0], [[-16000.0, 0.0], [0.0, 0.0]], 0.0, **given)
    np.testing.assert_allclose(ahead(**given), long_ago, atol=2e-5 * np.abs(long_ago).max())
    np.testing.assert_allclose(
        ahead(-3.0, **given), wake_elevation([-9.0, -3.0], [[-72.0, 0.0], [-24.0, 0.0]], -3.0, **given),
        atol=1e-4 * np.abs(long_ago).max(),
    )  # fmt: skip


def test_what_stops_leaves_waves_that_fade_by_the_decay_alone() -> None:
    """All waves of two seas that differ in γ alone turn alike: their ratio is that of e^(-γt)."""
    times, places = [0.0, 1.0, 2.0, 3.0], [[0.0, 0.0], [0.0, 0.0], [4.0, 0.0], [4.0, 0.0]]
    given = {"area": 256.0, "resolution": 128, **bump(2.0)}

    def energy(time: float, decay: float) -> float:
        still = wake_elevation([0.0], [[4.0, 0.0]], 0.0, decay=decay, **given)
        return float(np.std(wake_elevation(times, places, time, decay=decay, **given) - still))

    slow, quick = ([energy(time, decay) for time in (10.0, 20.0)] for decay in (0.01, 0.1))
    assert (quick[1] / quick[0]) / (slow[1] / slow[0]) == pytest.approx(np.exp(-0.9), rel=0.01)


def test_waves_of_two_add() -> None:
    given = {"area": 256.0, "resolution": 128}
    path = [[-40.0, 0.0], [40.0, 10.0]]
    small, large = bump(2.0), bump(2.0)
    large["footprint"] = 3.0 * large["footprint"]
    one, three = (wake_elevation([0.0, 10.0], path, 9.0, **given, **each) for each in (small, large))
    np.testing.assert_allclose(three, 3.0 * one, atol=1e-5 * np.abs(three).max())


def test_a_wake_that_turns_with_its_object() -> None:
    """A quarter turn of path, heading and sea is the same picture turned."""
    given = {"area": 256.0, "resolution": 128, **bump(2.0, elongation=3.0)}
    times = np.linspace(0.0, 12.0, 13)
    x, y = 40.0 * np.sin(0.15 * times), 40.0 * (1.0 - np.cos(0.15 * times))
    east = wake_elevation(times, np.stack((x, y), -1), 12.0, **given)
    north = wake_elevation(times, np.stack((-y, x), -1), 12.0, **given)
    turned = np.rot90(east, -1)  # rows go up: a turn to the left of x and y is one to the right of rows
    np.testing.assert_allclose(
        north[1:, 1:], np.roll(turned, 1, axis=1)[1:, 1:], atol=1e-4 * np.abs(east).max()
    )
    assert np.abs(east - east[::-1]).max() > 0.1 * np.abs(east).max()  # it is curved


def test_between_samples_an_object_points_half_way_the_shorter_way_around() -> None:
    given = {"area": 64.0, "resolution": 64, **bump(1.0, elongation=3.0)}

    def pointing(*headings: float) -> np.ndarray:
        return wake_elevation([0.0, 2.0], [[-6.0, 0.0], [6.0, 0.0]], 2.0, headings=headings, **given)

    for between, middle in (((0.1, 0.9), 0.5), ((-3.0, 3.1), np.pi + 0.05), ((7.0, 0.5), 3.75 - np.pi)):
        np.testing.assert_allclose(pointing(*between), pointing(middle, middle), atol=1e-5)
    assert np.abs(pointing(0.1, 0.1) - pointing(0.5, 0.5)).max() > 0.1


def test_around_a_drop_the_water_is_quiet_where_the_slowest_waves_have_left() -> None:
    """With surface tension no group in water is slower than 0.177 m/s: behind it the water is calm."""
    slowest = 0.177
    given = {"area": 4.0, "resolution": 512, "surface_tension": 0.074, "decay": 1e-3, **bump(0.006)}
    times = [0.0, 0.02, 0.04, 0.06]
    places = [[-50.0, 0.0], [0.0, 0.0], [0.0, 0.0], [50.0, 0.0]]
    r = np.hypot(along(4.0, 512), along(4.0, 512)[:, np.newaxis])
    for time in (2.0, 4.0):
        h = wake_elevation(times, places, time, **given)
        quiet, ring = (
            h[(r > near * slowest * time) & (r < far * slowest * time)].std() for near, far in DISCS
        )
        assert quiet < 0.15 * ring


#: within which water is quiet, and beyond which it is not, in the way of the slowest group
DISCS = ((0.0, 0.7), (1.0, 1.5))

BAD = {
    "times: must ascend": {"times": [0.0, 2.0, 1.0]},
    "times: must be finite": {"times": [0.0, np.nan, 2.0]},
    "positions: must be finite": {"positions": [[0.0, 0.0], [np.inf, 0.0], [2.0, 0.0]]},
    r"positions: must have the shape \(3, 2\)": {"positions": [[0.0, 0.0]]},
    "headings: must have the shape": {"headings": [0.0]},
    "headings: must be finite": {"headings": [0.0, np.nan, 0.0]},
    "times: must be one row": {"times": [[0.0, 1.0, 2.0]]},
    "footprint: must be rows": {"footprint": [1.0, 2.0]},
    "footprint: must be finite": {"footprint": [[np.nan]]},
    "footprint: is 64 m wide in an area of 32 m": {"footprint": np.ones((64, 64)), "spacing": 1.0},
    r"footprint: must be square, not of shape \(4, 9\): fill it up with zeros": {
        "footprint": np.ones((4, 9))
    },
    "depth = nan": {"depth": np.nan},
    "spacing = 0.0": {"spacing": 0.0},
    "area = -1.0": {"area": -1.0},
    "resolution = 33": {"resolution": 33},
    "depth = 0.0": {"depth": 0.0},
    "gravity = 0.0": {"gravity": 0.0},
    "decay = 0.0": {"decay": 0.0},
    "surface_tension = -1.0": {"surface_tension": -1.0},
    "time = nan": {"time": np.nan},
    "time = '3'": {"time": "3"},
    "resolution = 16.0: must be an even": {"resolution": 16.0},
    "resolution = 100000: must be an even number from 4 to 8192": {"resolution": 100_000},
    "gravity = inf": {"gravity": np.inf},
    "surface_tension = inf": {"surface_tension": np.inf},
    "decay = inf": {"decay": np.inf},
    "decay = 1e-300": {"decay": 1e-300},
    "footprint: must be finite, of draughts up to": {"footprint": [[1e300]]},
    "footprint = 'list': must hold real numbers": {"footprint": [[1.0, 2.0], [3.0]]},
    "positions = 'list': must hold real numbers": {"positions": [[0j, 0.0], [1.0, 0.0], [2.0, 0.0]]},
    "begin the path after it": {"positions": [[0.0, 0.0], [1e300, 0.0], [1e300, 0.0]]},
}


@pytest.mark.parametrize(("message", "changes"), BAD.items())
def test_what_cannot_be_is_refused_by_name(message: str, changes: dict[str, object]) -> None:
    given = {
        "times": [0.0, 1.0, 2.0], "positions": [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], "time": 1.0,
        "area": 32.0, "resolution": 32, **bump(1.0), **changes,
    }  # fmt: skip
    with pytest.raises(ValueError, match=message):
        wake_elevation(**given)


@pytest.mark.parametrize("times", [[0.0], [0.0, 1.0]])
def test_what_never_moves_presses_the_water_down_and_makes_no_waves(times: list[float]) -> None:
    """At rest a draught is a hole as deep, less its mean, which no wave holds."""
    dent = bump(4.0)
    h = wake_elevation(times, [[0.0, 0.0]] * len(times), 50.0, area=128.0, resolution=64, decay=1e-3, **dent)
    x = along(128.0, 64)
    expected = -np.exp(-0.5 * (x**2 + x[:, np.newaxis] ** 2) / 16.0)
    np.testing.assert_allclose(h - h.mean(), expected - expected.mean(), atol=2e-3)


def test_lists_whole_numbers_and_every_other_sample_are_what_they_hold() -> None:
    times, places, footprint = np.arange(4.0), np.arange(8.0).reshape(4, 2), np.ones((3, 3))
    given = {"area": 64.0, "resolution": 32, "spacing": 2.0, "footprint": footprint, "depth": 5.0}
    expected = wake_elevation(times, places, 3.0, **given)
    of_lists = {
        "area": 64,
        "resolution": 32,
        "spacing": 2,
        "footprint": footprint.astype(int).tolist(),
        "depth": 5,
    }
    lists = wake_elevation([0, 1, 2, 3], places.astype(int).tolist(), 3, **of_lists)
    wide = np.asfortranarray(np.repeat(np.repeat(places, 2, axis=0), 2, axis=1))[::2, ::2]
    apart = wake_elevation(np.repeat(times, 2)[::2], wide, 3.0, **given)
    assert lists.tobytes() == apart.tobytes() == expected.tobytes()
    assert np.abs(expected).max() > 0.1


def test_steps_shorter_than_a_frame_add_up_to_the_whole_way() -> None:
    """A wave that keeps pace with the object: what a step adds is a difference of almost equal numbers."""
    area, waves = 128.0, 4
    pace = np.sqrt(G * area / (2.0 * np.pi * waves))
    times = np.concatenate(([-1.0], np.arange(0.0, 2.001, 1.0 / 240.0)))  # it rests, and sets off
    places = np.stack((pace * np.maximum(times, 0.0), np.zeros(len(times))), -1)
    given = {"area": area, "resolution": 64, "decay": 1e-6, **bump(3.0)}
    whole = wake_elevation([-1.0, 0.0, 2.0], places[[0, 1, -1]], 2.0, **given)
    turning = np.resize([0.0, 0.0, 1e-3, 1e-3], len(times))  # what is round, so that no step goes straight on
    steps = wake_elevation(times, places, 2.0, headings=turning, **given)
    np.testing.assert_allclose(steps, whole, atol=1e-3 * np.abs(whole).max())
