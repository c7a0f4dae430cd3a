# SPDX-License-Identifier: GPL-3.0-or-later
"""A bake of a square that does not repeat: any sea, all maps, whoever makes which frame."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import main
from ocean_tweak.core import Area, Ocean, OceanParameters
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.core.synthesis.channels import HALVED_MAPS, MAPS, MOVING_MAP, image_of
from ocean_tweak.export.cache.estimate import estimate
from ocean_tweak.export.cache.job import Job
from ocean_tweak.export.exr import HALF_ERROR, read_image

#: two patches, one of them turned, under a mask: it has no tile, and no bake but one of an area
SEA = {
    "layers": [
        {"wind_speed": 14.0, "mask": {"x": 100.0, "y": 60.0, "inner_radius": 30.0, "outer_radius": 120.0}}
    ],
    "patches": [
        {"domain_size": 300.0, "resolution": 64, "shortest_wavelength": 30.0},
        {"domain_size": 77.0, "resolution": 32, "longest_wavelength": 30.0, "rotation": 0.5},
    ],
    "foam": {"half_life": 0.5, "coverage": 5.0},
    "timing": {"fps": 24, "start_frame": 0},
}
SQUARE = Area(120.0, 40, (-30.0, 250.0))


@pytest.fixture
def given(tmp_path: Path) -> list[str]:
    params = tmp_path / "sea.json"
    params.write_text(json.dumps(SEA))
    return ["bake", "--params", str(params), "--frames", "10-13", "--maps", ",".join(MAPS)]


def test_all_maps_of_any_sea_whoever_makes_them(
    tmp_path: Path, given: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*given, "--out", str(tmp_path)]) == 2
    assert "masks lie over the sea, not" in capsys.readouterr().err
    one, three = tmp_path / "one", tmp_path / "three"
    for cache, workers in ((one, "1"), (three, "3")):
        own = ["--area", "120", "40", "-30", "250", "--out", str(cache), "--workers", workers]
        assert main([*given, *own]) == 0
    (here,), (there,) = one.glob("sea-*/v*"), three.glob("sea-*/v*")
    assert here.name == there.name
    names = sorted(path.name for path in here.glob("*.exr"))
    assert len(names) == 4 * len(MAPS)
    assert all((here / name).read_bytes() == (there / name).read_bytes() for name in names)
    outputs = frozenset().union(*MAPS.values())
    fields = Ocean(OceanParameters.from_dict(SEA)).frame(12, outputs, SQUARE)
    assert fields.foam.max() > 0.1
    for name in MAPS:
        pixels, header = read_image(here / f"sea_{name}.0012.exr", (40, 40))
        wanted = image_of(name, fields)
        largest = np.abs(wanted).max(axis=(0, 1))
        share, of = (HALF_ERROR, 2.0 * largest) if name in HALVED_MAPS else (2.0**-16, np.abs(wanted))
        error = share * of + 1e-6 * largest.max()
        assert np.all(np.abs(pixels - wanted) <= error), name
        assert header["area"] == {"size": 120.0, "resolution": 40, "corner": [-30.0, 250.0]}
    assert main(["verify", str(here)]) == 0


def test_another_square_is_another_version_and_the_tile_keeps_its_own() -> None:
    shot = Shot.from_dict({"resolution": 16})
    tile = Job("sea", "1", shot)
    jobs = [tile, *(Job("sea", "1", shot, area=area) for area in (SQUARE, Area(120.0, 40), Area(120.0, 41)))]
    assert len({job.fingerprint for job in jobs}) == len({job.frame_fingerprint(1) for job in jobs}) == 4
    assert "area" not in tile.to_dict()
    for job in jobs:
        assert Job.from_dict(json.loads(json.dumps(job.to_dict()))) == job
    for wrong in ({"size": 1}, [1, 2], {"size": -1, "resolution": 4, "corner": [0, 0]}, "x", None):
        with pytest.raises(ValueError, match="has the area"):
            Job.from_dict(sealed({**jobs[1].to_dict(), "area": wrong}))


def sealed(data: dict) -> dict:
    from ocean_tweak.export.cache import job

    return job.sealed({key: value for key, value in data.items() if key != "sha256"})


def test_its_estimate_is_of_its_own_samples(tmp_path: Path) -> None:
    shot = Shot.from_dict({"resolution": 64, "layers": [{"wind_speed": 14.0}]})
    frames = (1, 2)
    job = Job("sea", "1", shot, area=Area(1000.0, 256), frames=frames)
    told = estimate(tmp_path, job, frames).bytes
    fields = Ocean(shot.parameters).frame(1, {"displacement"}, job.on)
    written = len(job.sequence(tmp_path, 1).encoded(1, fields, MOVING_MAP))
    assert 0.8 * written < told / len(frames) < 2.0 * written
