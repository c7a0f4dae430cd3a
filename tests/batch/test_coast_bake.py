# SPDX-License-Identifier: GPL-3.0-or-later
"""A bake of a sea with its coast: the tile of the open sea, and points over the bed."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import main
from ocean_tweak.core import (
    Area,
    Ocean,
    ParameterError,
    Places,
)
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.core.sea.bake import ShotSeas
from ocean_tweak.core.sea.over_bed import mesh_over_bed
from ocean_tweak.export.cache.estimate import estimate, process_memory
from ocean_tweak.export.cache.job import Job
from ocean_tweak.export.coast_points import COLUMNS
from ocean_tweak.export.exr import read_image
from ocean_tweak.export.ply import read_ply
from tests.batch.bakery import only_folder
from tests.coasts import BEACH, SIDE
from tests.coasts import SMALL_SEA as SEA


@pytest.fixture(scope="module")
def baked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three frames. Not to be changed."""
    return bake(tmp_path_factory.mktemp("coast"), "1")


def bake(place: Path, workers: str) -> Path:
    (place / "sea.json").write_text(json.dumps(SEA.to_dict()))
    arguments = ["--frames", "4-6", "--maps", "disp,coast", "--compression", "NONE", "--workers", workers]
    assert main(["bake", "--params", str(place / "sea.json"), *arguments, "--out", str(place)]) == 0
    return only_folder(place)


def test_points_are_the_sea_and_the_tile_is_the_open_one(baked: Path) -> None:
    points, sea = read_ply(baked / "sea_coast.0005.ply", (COLUMNS,)), Ocean(SEA)
    assert len(points["x"]) > 1000
    image, _ = read_image(baked / "sea_disp.0005.exr")
    open_sea = Ocean(SEA.replace(coast=replace(SEA.coast, muted=True)))
    np.testing.assert_allclose(image, open_sea.frame(5).displacement, atol=1e-6)
    # the place at rest from which water came is not in the file: it is found by going back
    present = np.stack([points[axis] for axis in "xyz"], axis=-1).astype(np.float64)
    rest = present[:, :2].copy()
    for _ in range(60):
        moved = sea.frame(5, on=Places(rest[:, 0], rest[:, 1])).displacement
        rest += 0.7 * (present[:, :2] - moved[:, :2] - rest)
    found = sea.frame(5, {"displacement", "velocity"}, Places(rest[:, 0], rest[:, 1]))
    missed = np.abs(found.displacement[:, :2] + rest - present[:, :2]).max(axis=1)
    settled = missed < 1e-3
    assert settled.mean() > 0.95
    np.testing.assert_allclose(found.displacement[settled, 2], present[settled, 2], atol=0.02)
    velocity = np.stack([points[f"velocity_{axis}"] for axis in "xyz"], axis=-1)
    np.testing.assert_allclose(found.velocity[settled], velocity[settled], atol=0.05)
    assert np.ptp(present[settled, 2]) > 0.5


def test_sand_is_wet_on_land_and_foam_is_where_it_is_shallow(baked: Path) -> None:
    points = read_ply(baked / "sea_coast.0005.ply", (COLUMNS,))
    depth = np.interp(points["x"], np.linspace(0.0, SIDE, 101), BEACH[0])
    assert (points["wet"][depth > 0.5] == 1.0).all()
    on_land = points["wet"][depth < 0.0]
    assert on_land.min() == 0.0
    assert 0.0 < on_land.max() <= 1.0
    assert points["foam"][(depth < 2.0) & (depth > 0.2)].max() > 0.3


def test_whitecaps_before_the_bed_are_those_of_the_open_sea(baked: Path) -> None:
    points, sea = read_ply(baked / "sea_coast.0005.ply", (COLUMNS,)), Ocean(SEA)
    open_sea = Ocean(SEA.replace(coast=replace(SEA.coast, muted=True)))
    places = mesh_over_bed(sea)
    offshore, on_land = places.x < -170.0, places.x > 190.0
    tile = open_sea.foam_history.whitecaps(SEA.timing.time(5))
    expected = tile.at(places.x[offshore], places.y[offshore], 200.0)
    assert expected.foam.max() > 0.1
    for column, field in zip(("foam", "breaking", "foam_age"), expected, strict=True):
        np.testing.assert_allclose(points[column][offshore], field, atol=1e-6)
    assert points["foam"][on_land].max() == 0.0


def test_workers_do_not_matter_and_what_is_lost_is_made_again(
    baked: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = bake(tmp_path, "2")
    assert folder.name == baked.name
    for path in baked.glob("*.ply"):
        assert (folder / path.name).read_bytes() == path.read_bytes()
    assert main(["verify", str(folder)]) == 0
    lost = folder / "sea_coast.0005.ply"
    whole = lost.read_bytes()
    lost.write_bytes(whole[:-4])
    assert main(["verify", str(folder)]) == 1
    assert lost.name in capsys.readouterr().out
    assert main(["resume", str(folder)]) == 0
    assert lost.read_bytes() == whole
    assert main(["clean", str(folder)]) == 0
    assert not folder.exists()


def test_what_has_no_coast_is_refused() -> None:
    for sea, area, reason in (
        (SEA.replace(coast=None), None, "needs a sea with a coast"),
        (SEA, Area(200.0, 32), "an area shows the bed by itself"),
    ):
        with pytest.raises(ParameterError, match=reason):
            Job("sea", "1", Shot(sea), ("disp", "coast"), area=area)
    with pytest.raises(ParameterError, match="--maps disp,coast"):
        Job("sea", "1", Shot(SEA))


def test_its_bytes_are_foreseen(baked: Path, tmp_path: Path) -> None:
    job = Job("sea", "1", Shot(SEA), ("disp", "coast"), "NONE")
    foreseen = estimate(tmp_path, job, (4, 5, 6))
    actual = sum(path.stat().st_size for path in baked.rglob("*") if path.is_file())
    assert 0.9 * actual < foreseen.bytes < 1.2 * actual + 3 * 20_000
    assert foreseen.seconds > 0.0
    fine = SEA.replace(coast=replace(SEA.coast, step=0.5))
    open_sea = Job("sea", "1", Shot(SEA.replace(coast=None)))
    # 721 × 400 samples of complex single precision, for each of some dozens of frequencies
    more = process_memory(Job("sea", "1", Shot(fine), ("disp", "coast"))) - process_memory(open_sea)
    assert more > 10 * 8 * 721 * 400


def test_bytes_of_an_area_are_those_of_waves_over_the_bed(tmp_path: Path) -> None:
    """In the open sea, height and direction are the same everywhere, and pack to nothing."""
    sea = SEA.replace(coast=replace(SEA.coast, step=2.0))
    job = Job("sea", "1", Shot(sea), ("hs", "qb", "direction"), "ZIP", area=Area(240.0, 256, (-40.0, 0.0)))
    foreseen = estimate(tmp_path, job, (4,)).bytes
    assert not list(tmp_path.iterdir())
    fields = ShotSeas(job.shot, job.on).frames(4, job.outputs)
    actual = sum(path.stat().st_size for path in job.write(tmp_path, 4, fields))
    assert 0.9 * actual < foreseen < 1.3 * actual + 5 * 4096
