# SPDX-License-Identifier: GPL-3.0-or-later
"""A bake of a sea with a wake: the tile of its other waves, and points of the wake around the camera."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import main
from ocean_tweak.core import (
    Area,
    Foam,
    Ocean,
    OceanParameters,
    ParameterError,
    PathSample,
    Places,
    WakeLayer,
    WaveLayer,
)
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.core.parameters.surroundings import Surroundings
from ocean_tweak.export.cache.estimate import estimate, process_memory
from ocean_tweak.export.cache.job import Job
from ocean_tweak.export.exr import read_image
from ocean_tweak.export.ply import read_ply
from ocean_tweak.export.wake_points import COLUMNS
from tests.batch.bakery import only_folder

SHIP = WakeLayer(
    path=(PathSample(0.0), PathSample(30.0, x=240.0)), length=30.0, beam=6.0, draught=2.0,
    area_size=512.0, area_resolution=256,
)  # fmt: skip
SEA = OceanParameters(
    resolution=64, domain_size=200.0, layers=(WaveLayer(wind_speed=9.0), SHIP), foam=Foam(half_life=1.0)
)
#: the ship is in the middle of it at frame 5
AROUND = Surroundings(200.0, 100, ((-99.0, -100.0), (-98.0, -100.0), (-97.0, -100.0)), 4)
SHOT = Shot(SEA, around=AROUND)


@pytest.fixture(scope="module")
def baked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three frames. Not to be changed."""
    return bake(tmp_path_factory.mktemp("wake"), "1")


def bake(place: Path, workers: str, frames: str = "4-6") -> Path:
    (place / "sea.json").write_text(json.dumps(SHOT.to_dict()))
    arguments = ["--frames", frames, "--maps", "disp,wakes", "--compression", "NONE", "--workers", workers]
    assert main(["bake", "--params", str(place / "sea.json"), *arguments, "--out", str(place)]) == 0
    return only_folder(place)


def test_tile_and_points_together_are_the_sea(baked: Path) -> None:
    """At the samples of the square's inner part, from where its edge fades out, as at any place."""
    points, sea = read_ply(baked / "sea_wakes.0005.ply", (COLUMNS,)), Ocean(SEA)
    image, _ = read_image(baked / "sea_disp.0005.exr")
    np.testing.assert_allclose(image, Ocean(SEA.replace(layers=SEA.layers[:1])).frame(5).displacement)
    x, y = points["x"] - points["moved_x"], points["y"] - points["moved_y"]
    wanted_x, wanted_y = Area(200.0, 100, (-98.0, -100.0)).rest_positions()
    np.testing.assert_allclose(x, wanted_x.ravel(), atol=1e-4)
    np.testing.assert_allclose(y, wanted_y.ravel(), atol=1e-4)
    inner = (abs(x - 1.0) < 75.0) & (abs(y) < 75.0)
    names = {"displacement", "velocity", "slope"}
    at = Places(wanted_x.ravel()[inner], wanted_y.ravel()[inner])
    whole = sea.frame(5, names, at)
    bare = Ocean(SEA.replace(layers=SEA.layers[:1])).frame(5, names, at)
    moved = np.stack((points["moved_x"], points["moved_y"], points["z"]), axis=-1)[inner]
    assert np.ptp(moved[:, 2]) > 1.0
    np.testing.assert_allclose(moved, whole.displacement - bare.displacement, atol=1e-5)
    velocity = np.stack([points[f"velocity_{axis}"] for axis in "xyz"], axis=-1)[inner]
    np.testing.assert_allclose(velocity, whole.velocity - bare.velocity, atol=1e-5)
    slope = np.stack([points[f"slope_{axis}"] for axis in "xy"], axis=-1)[inner]
    np.testing.assert_allclose(slope, whole.slope - bare.slope, atol=1e-5)


def test_the_foam_is_that_of_the_hull_and_nothing_is_left_at_the_edge(baked: Path) -> None:
    points = read_ply(baked / "sea_wakes.0006.ply", (COLUMNS,))
    grid = {name: points[name].reshape(100, 100) for name in COLUMNS}
    astern = grid["foam"][49:52, 20:40]  # 10 to 50 m behind the stern
    assert astern.max() > 0.3
    assert grid["foam"][80:].max() == 0.0
    for name in ("z", "foam", "moved_x"):
        edges = grid[name][[0, -1]], grid[name][:, [0, -1]]
        assert max(abs(edge).max() for edge in edges) == 0.0


def test_a_killed_bake_goes_on_and_frames_alone_are_those_of_the_sequence(
    baked: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = bake(tmp_path, "1", "6")  # alone, by itself
    assert folder.name == baked.name
    bake(tmp_path, "2")
    for path in baked.glob("*.ply"):
        assert (folder / path.name).read_bytes() == path.read_bytes()
    assert main(["verify", str(folder)]) == 0
    lost = folder / "sea_wakes.0005.ply"
    whole = lost.read_bytes()
    lost.write_bytes(whole[:-4])
    assert main(["verify", str(folder)]) == 1
    assert lost.name in capsys.readouterr().out
    assert main(["resume", str(folder)]) == 0
    assert lost.read_bytes() == whole
    (folder / "bake.json").unlink()  # of which images tell all but the place of the square
    assert main(["resume", str(folder)]) == 1
    assert "bake with the same arguments as before" in capsys.readouterr().err
    bake(tmp_path, "1")
    assert main(["clean", str(folder)]) == 0
    assert not folder.exists()


def test_what_no_bake_can_hold_is_refused() -> None:
    tile = SEA.replace(layers=SEA.layers[:1])
    for shot, area, reason in (
        (Shot(tile, around=AROUND), None, "needs a sea with wakes"),
        (Shot(SEA), None, '"around": '),
        (SHOT, Area(200.0, 32), "an area shows them by itself"),
    ):
        with pytest.raises(ParameterError, match=reason):
            Job("sea", "1", shot, ("disp", "wakes"), area=area)
    with pytest.raises(ParameterError, match="do not repeat"):
        Job("sea", "1", SHOT, ("disp",))


def test_another_place_is_another_bake_but_only_of_wakes() -> None:
    elsewhere = Shot(SEA, around=Surroundings(200.0, 100, ((0.0, 0.0),)))
    one, other = (Job("sea", "1", shot, ("disp", "wakes")) for shot in (SHOT, elsewhere))
    assert one.fingerprint != other.fingerprint
    assert one.frame_fingerprint(4) != one.frame_fingerprint(5)
    tile = SEA.replace(layers=SEA.layers[:1])
    plain, told = (Job("sea", "1", Shot(tile, around=around)) for around in (None, AROUND))
    assert plain.fingerprint == told.fingerprint
    assert Shot.from_json(SHOT.to_json()) == SHOT


@pytest.mark.parametrize(
    ("around", "reason"),
    [
        ({"size": 0, "resolution": 8, "corners": [[0, 0]]}, "around.size"),
        ({"size": 10, "resolution": 1, "corners": [[0, 0]]}, "around.resolution"),
        ({"size": 10, "resolution": 5000, "corners": [[0, 0]]}, "around.resolution"),
        ({"size": 10, "resolution": 8, "corners": []}, "around.corners"),
        ({"size": 10, "resolution": 8, "corners": [[0, 1e400]]}, "around.corners.0"),
        ({"size": 10, "resolution": 8, "corners": [[0, True]]}, "around.corners.0"),
        ({"size": 10, "resolution": 8, "corners": [[0, 0]], "first_frame": 1.5}, "around.first_frame"),
        ({"size": 10, "resolution": 8}, "around"),
        ([], "around"),
    ],
)
def test_what_is_no_square_is_told(around: object, reason: str) -> None:
    with pytest.raises(ParameterError) as error:
        Shot.from_dict({**SEA.to_dict(), "around": around})
    assert error.value.field == reason


def test_its_bytes_and_memory_are_foreseen(baked: Path, tmp_path: Path) -> None:
    job = Job("sea", "1", SHOT, ("disp", "wakes"), "NONE")
    foreseen = estimate(tmp_path, job, (4, 5, 6))
    actual = sum(path.stat().st_size for path in baked.rglob("*") if path.is_file())
    assert 0.9 * actual < foreseen.bytes < 1.2 * actual + 3 * 20_000
    assert foreseen.seconds > 0.0
    large = Shot(SEA, around=Surroundings(4000.0, 2000, ((0.0, 0.0),)))
    more = process_memory(Job("sea", "1", large, ("disp", "wakes"))) - process_memory(job)
    assert more > 4 * 2000**2 * len(COLUMNS)
