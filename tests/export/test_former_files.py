# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of the program as it was when each kind of layers had a list of its own: read, and not made again."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

from ocean_tweak.cli import main
from ocean_tweak.core import HeroWave, ImageLayer, Ocean, OceanParameters, WaveLayer, WindFieldLayer
from ocean_tweak.core.parameters.fingerprint import frame_fingerprint
from ocean_tweak.core.parameters.former_json import former, modern
from ocean_tweak.core.parameters.shot import Animation, Shot
from ocean_tweak.export.cache.job import Job
from ocean_tweak.export.sea_files import read_sea, write_sea

FORMER = Path(__file__).parents[1] / "former"


@pytest.fixture
def shot() -> Shot:
    return read_sea(FORMER / "sea.json")


@pytest.fixture
def version(tmp_path: Path) -> Path:
    """A copy of the bake."""
    return Path(shutil.copytree(FORMER / "sea-61248de5", tmp_path / "sea-61248de5")) / "v001-4597cf95"


def test_lists_of_kinds_become_one(shot: Shot) -> None:
    data = json.loads((FORMER / "sea.json").read_text())
    layers = shot.parameters.layers
    kinds = (WaveLayer, WaveLayer, WindFieldLayer, ImageLayer, ImageLayer, HeroWave)
    assert tuple(map(type, layers)) == kinds
    assert [layer.id for layer in layers] == [0, 4, 0, 0, 1, -1]
    assert (layers[0].fetch, layers[1].mask.outer_radius, layers[5].crest_height) == (30e3, 30.0, 0.8)
    assert [key.time for key in layers[2].keys] == [0.0, 2.0]
    assert layers[4].image.values[1, 3, 0] == 7.0
    assert shot.animation is not None
    assert {*data["animation"]["samples"]} == {path for path, _ in shot.animation.samples}
    assert OceanParameters.from_dict({"pictures": [{"amplitude_scale": 2.0}]}).layers[0] == WaveLayer(id=0)
    assert Shot.from_json(shot.to_json()) == shot


def test_former_and_modern_are_inverse(shot: Shot) -> None:
    data = shot.to_dict()
    before = former(data)
    assert [len(before[name]) for name in ("layers", "wind_fields", "pictures", "hero_waves")] == [2, 1, 2, 1]
    assert modern(before) == data
    # in whatever order the kinds stand, the second of the waves is the second of the former list
    changing = Animation(1, (("layers.5.wind_speed", (1.0, 2.0)),))
    mixed = former(Shot(shot.parameters.replace(layers=shot.parameters.layers[::-1]), changing).to_dict())
    assert [len(mixed[name]) for name in ("layers", "hero_waves")] == [2, 1]
    assert mixed["layers"][1]["fetch"] == 30e3
    assert [*mixed["animation"]["samples"]] == ["layers.1.wind_speed"]


def test_a_bake_is_known_as_that_sea(shot: Shot, version: Path, tmp_path: Path) -> None:
    told = json.loads((version / "records" / "0002.json").read_text())["fingerprint"]
    assert frame_fingerprint(shot, 2) == told
    images = sorted(version.glob("*.exr"))
    before = [image.stat().st_mtime_ns for image in images]
    assert len(before) == 2
    write_sea(tmp_path / "sea.json", shot)
    for params in (FORMER / "sea.json", tmp_path / "sea.json"):
        own = ["--params", str(params), "--maps", "disp", "--compression", "ZIP", "--frames", "1-2"]
        assert main(["bake", *own, "--out", str(tmp_path)]) == 0
        assert main(["verify", *own, "--out", str(tmp_path)]) == 0
    assert [path.name for path in version.parent.glob("v*")] == [version.name]
    assert [image.stat().st_mtime_ns for image in images] == before


def test_layers_of_usd_hold_that_sea(shot: Shot, tmp_path: Path) -> None:
    pytest.importorskip("pxr")
    asset = Path(shutil.copytree(FORMER / "usd", tmp_path / "usd")) / "sea.usda"
    assert read_sea(asset) == shot
    assert main(["usd-verify", str(asset)]) == 0


def test_a_bake_whose_maps_all_have_32_bits_goes_on_so(tmp_path: Path) -> None:
    """As version 1 of the encoding made it: its hash is the one that version 1 gave."""
    now = Job("sea", "1", Shot.from_dict({"resolution": 16}), ("disp", "vel"))
    before = replace(now, encoding=1)
    assert before.fingerprint.startswith("2ed089dfcb9afa8d")
    assert now.fingerprint != before.fingerprint
    assert "encoding" not in before.to_dict()
    assert Job.from_dict(before.to_dict()).encoding == 1
    assert Job.from_dict(now.to_dict()).encoding == 2
    fields = [Ocean(now.shot.parameters).frame(1, now.outputs)]
    for job, kind in ((before, np.float32), (now, np.float16)):
        disp, vel = job.write(tmp_path, 1, fields)
        for path, dtype in ((disp, np.float32), (vel, kind)):
            with OpenEXR.File(str(path), separate_channels=True) as file:
                assert file.channels()["G"].pixels.dtype == dtype
    exact = Job("sea", "1", now.shot, now.maps, "ZIP", encoding=1)
    assert exact == Job("sea", "1", now.shot, now.maps, "ZIP")  # nothing of it has 16 bits in any version
