# SPDX-License-Identifier: GPL-3.0-or-later
"""`ocean_tweak.read_sea` reads what the command line reads, and every example of the documentation."""

import json
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from PIL import Image

import ocean_tweak
from ocean_tweak import cli, read_sea, write_sea
from ocean_tweak.core import OceanParameters, ParameterError, WaveLayer
from ocean_tweak.core.parameters.shot import Animation, Shot

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTS = sorted([ROOT / "README.md", *(ROOT / "docs").rglob("*.md")])
EXAMPLES = {
    f"{path.relative_to(ROOT)} {number}": text
    for path in DOCUMENTS
    for number, text in enumerate(re.findall(r"^```json\n(.*?)^```", path.read_text("utf-8"), re.M | re.S), 1)
}
SHOT = Shot(
    OceanParameters(resolution=32, domain_size=90.0, layers=(WaveLayer(wind_speed=8.0),)),
    Animation(1, (("layers.0.wind_speed", (8.0, 9.0, 10.0)),)),
)


@pytest.fixture
def images(tmp_path):
    """A folder with the images that examples name."""
    grey = np.linspace(0, 255, 64, dtype=np.uint8).reshape(8, 8)
    for name in ("lee.png", "sea.png"):
        Image.fromarray(grey).save(tmp_path / name)
    Image.fromarray(np.stack([grey] * 3, axis=-1)).save(tmp_path / "wind.png")
    beach = np.tile(np.linspace(20.0, -2.0, 256, dtype=np.float32), (256, 1))
    OpenEXR.File({}, {"Y": beach}).write(str(tmp_path / "bed.exr"))
    return tmp_path


@pytest.mark.parametrize("name", EXAMPLES)
def test_examples_of_the_documentation(name, images):
    text = EXAMPLES[name]
    path = images / "sea.json"
    path.write_text(text if text.startswith("{") else f"{{{text}}}")
    shot = read_sea(path)
    given = json.loads(path.read_text())
    assert (shot.animation is not None) == ("animation" in given)
    for key in given.keys() & {"resolution", "domain_size"}:
        assert getattr(shot.parameters, key) == given[key]
    assert shot.parameters != OceanParameters()


def test_there_are_examples_of_each_kind():
    assert {name.partition(" ")[0] for name in EXAMPLES} >= {
        f"docs/{name}.md" for name in ("batch", "cascades", "hero-waves", "masks", "images", "wind-fields")
    }


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.json")), ids=lambda path: path.name)
def test_files_of_the_examples(path):
    shot = read_sea(str(path))
    assert isinstance(shot.parameters, OceanParameters)
    assert shot.parameters != OceanParameters()


@pytest.mark.parametrize("sea", [SHOT, SHOT.parameters], ids=["shot", "parameters"])
def test_what_is_written_is_read(tmp_path, sea):
    write_sea(tmp_path / "sea.json", sea)
    assert read_sea(tmp_path / "sea.json") == (sea if isinstance(sea, Shot) else Shot(sea))


def test_images_are_read_beside_the_file_and_written_into_it(images):
    (images / "a.json").write_text('{"pictures": [{"image": {"file": "sea.png"}}]}')
    shot = read_sea(images / "a.json")
    (images / "other").mkdir()
    write_sea(images / "other" / "b.json", shot)
    assert read_sea(images / "other" / "b.json") == shot
    shutil.copy(images / "a.json", images / "other" / "a.json")
    with pytest.raises(ParameterError, match=r"layers\.1\.image"):
        read_sea(images / "other" / "a.json")


def test_layers_of_usd(tmp_path):
    pytest.importorskip("pxr")
    write_sea(tmp_path / "sea.json", SHOT)
    asset = tmp_path / "sea.usd"
    command = ["usd", "--params", str(tmp_path / "sea.json"), "--frames", "1-2", "--form", "points", "--out"]
    assert cli.main([*command, str(asset)]) == 0
    assert read_sea(asset) == SHOT


def test_nothing_is_left_of_a_file_that_could_not_be_written(tmp_path, monkeypatch):
    path = tmp_path / "sea.json"
    write_sea(path, SHOT)
    before = path.read_bytes()

    def full(_file):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(OSError, match="No space left"):
        write_sea(path, SHOT.parameters)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_what_cannot_be_read_or_written_is_told(tmp_path):
    with pytest.raises(FileNotFoundError):
        read_sea(tmp_path / "none.json")
    (tmp_path / "bytes.json").write_bytes(b"\xff")
    with pytest.raises(UnicodeDecodeError):
        read_sea(tmp_path / "bytes.json")
    (tmp_path / "sea.json").write_text('{"choppines": 1}')
    with pytest.raises(ParameterError, match="choppines = 1: unknown key; did you mean choppiness"):
        read_sea(tmp_path / "sea.json")
    (tmp_path / "newer.json").write_text('{"pictures": [{"image": {"file": "none.png"}}], "format": 7}')
    with pytest.raises(ParameterError, match=r"format = 7: .* update the extension"):
        read_sea(tmp_path / "newer.json")
    with pytest.raises(ParameterError, match="must be that of a JSON file"):
        write_sea(tmp_path / "sea.usda", SHOT)


def test_the_package_is_typed_and_light():
    assert (ROOT / "ocean_tweak" / "py.typed").read_bytes() == b""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert "py.typed" in project["tool"]["setuptools"]["package-data"]["ocean_tweak"]
    script = "import sys, ocean_tweak; sys.exit('numpy' in sys.modules or len(sys.modules) > 500)"
    subprocess.run([sys.executable, "-S", "-c", script], cwd=ROOT, check=True, timeout=60)
    assert set(ocean_tweak.__all__) == {"read_sea", "write_sea"}
    with pytest.raises(AttributeError, match="has no attribute 'read_seas'"):
        _ = ocean_tweak.read_seas
