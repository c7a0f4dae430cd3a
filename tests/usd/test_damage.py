# SPDX-License-Identifier: GPL-3.0-or-later
"""Layers that are missing, damaged, or of somebody who means no good: a line that says so, and a code."""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path

import pytest
from pxr import Gf, Sdf, Usd, UsdGeom, Vt

from ocean_tweak.cli import main
from ocean_tweak.core import OceanParameters
from ocean_tweak.core.data import formats
from ocean_tweak.core.foam import threshold
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.export.usd import isolated
from ocean_tweak.export.usd.export import Export
from ocean_tweak.export.usd.package import Package

from .conftest import FORMS, SEA, write

LAYERS = {
    "points": ("geo.usdc", "payload.usd", "mtl.usd"),
    "clips": ("geo.usd", "topology.usd", "manifest.usda", "clips/sea.1001.usdc"),
    "displacement": ("geo.usd", "mtl.usd"),
}


@pytest.fixture(scope="module")
def assets(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """A folder of each form. Not to be changed."""
    folders = {form: tmp_path_factory.mktemp(form) for form in FORMS}
    for form, folder in folders.items():
        write(folder / "sea.usd", form=form, frames="1001-1002")
    return folders


@pytest.fixture
def in_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is known to end OpenUSD in no other way is read more quickly here."""
    monkeypatch.setattr(isolated, "lines", lambda _path, asked: isolated.answer(asked))


@pytest.fixture
def copy(assets: dict[str, Path], tmp_path: Path, request: pytest.FixtureRequest) -> Path:
    return Path(shutil.copytree(assets[getattr(request, "param", "points")], tmp_path / "copy"))


@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize("damage", ["gone", "half", "text"])
@pytest.mark.parametrize(("copy", "layer"), [(f, n) for f in FORMS for n in LAYERS[f]], indirect=["copy"])
def test_a_layer_under_the_asset_that_cannot_be_read(
    copy: Path, layer: str, damage: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = copy / layer
    content = path.read_bytes()
    path.unlink()
    if damage != "gone":
        path.write_bytes({"half": content[: len(content) // 2], "text": b"#usda 1.0\nx\xff"}[damage])
    code = main(["usd-verify", str(copy / "sea.usd")])
    said = capsys.readouterr()
    assert code == 1
    assert re.search(r"missing|damaged|cannot be read|no clip|no points|no sample", said.out + said.err)


@pytest.mark.usefixtures("in_this_process")
def test_text_that_is_none(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asset = copy / "sea.usd"
    asset.write_bytes(asset.read_bytes().replace(b"upAxis", b"up\xff\xfeis"))
    for command in (["usd-verify"], ["info", "--params"]):
        assert main([*command, str(asset)]) == 1
        assert capsys.readouterr().err.count("\n") == 1


@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("format", "1"), ("name", 3), ("name", "../sea"), ("shot", "["), ("shot", "{}"), ("frames", 7),
        ("frames", "1-2000000000"), ("metersPerUnit", "x"), ("metersPerUnit", float("nan")),
        ("variants", 2.0),        ("tiles", "3"), ("tiles", "0x0"), ("proxy", float("inf")),
        ("attributes", 1), ("form", "other"),
    ],
)  # fmt: skip
def test_a_record_of_other_values(
    copy: Path, capsys: pytest.CaptureFixture[str], key: str, value: object
) -> None:
    layer = Sdf.Layer.FindOrOpen(str(copy / "sea.usd"))
    prim = layer.GetPrimAtPath("/sea")
    record = prim.customData["ocean_tweak"]
    record[key] = value
    prim.customData = {"ocean_tweak": record}
    layer.Save()
    for command in (["usd-verify"], ["info", "--params"]):
        assert main([*command, str(copy / "sea.usd")]) == 1
        assert capsys.readouterr().err.count("\n") <= 1


@pytest.mark.usefixtures("in_this_process")
def test_a_record_of_a_newer_version(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    layer = Sdf.Layer.FindOrOpen(str(copy / "sea.usd"))
    prim = layer.GetPrimAtPath("/sea")
    prim.customData = {"ocean_tweak": {**prim.customData["ocean_tweak"], "format": 2}}
    layer.Save()
    assert main(["info", "--params", str(copy / "sea.usd")]) == 1
    told = "format = 2: was written by a newer Ocean Tweak, and this one reads up to 1: update the extension"
    assert told in capsys.readouterr().err


@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize("copy", ["points", "clips"], indirect=True)
@pytest.mark.parametrize(
    ("name", "kind", "value"),
    [
        ("points", "string", "x"), ("points", "point3f[]", Vt.Vec3fArray()), ("points", "float", 1.0),
        ("points", "int[]", Vt.IntArray([1])), ("extent", "float3[]", Vt.Vec3fArray([Gf.Vec3f(1)])),
        ("velocities", "token", "x"), ("velocities", "vector3f[]", Vt.Vec3fArray(4)),
    ],
)  # fmt: skip
def test_values_of_another_type(
    copy: Path, capsys: pytest.CaptureFixture[str], name: str, kind: str, value: object
) -> None:
    stage = Usd.Stage.Open(str(copy / "sea.usd"))
    (mesh,) = (prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh))
    path = mesh.GetPath()
    stage.GetRootLayer().Import(str(copy / "sea.usd"))
    over = Sdf.CreatePrimInLayer(stage.GetRootLayer(), path)
    attribute = Sdf.AttributeSpec(over, name, Sdf.ValueTypeNames.Find(kind))
    for frame in (1001, 1002):
        stage.GetRootLayer().SetTimeSample(attribute.path, frame, value)
    stage.GetRootLayer().Save()
    assert main(["usd-verify", str(copy / "sea.usd")]) == 1
    said = capsys.readouterr().out
    assert name in said or "a layer cannot be read" in said


def test_openusd_that_breaks_off_ends_nobody_else(
    copy: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Some damaged layers end the process that reads them, by a signal."""
    crash = [sys.executable, "-c", "import os; os.abort()"]
    monkeypatch.setattr(isolated, "module_command", lambda _module: crash)
    for command in (["usd-verify"], ["info", "--params"]):
        assert main([*command, str(copy / "sea.usd")]) == 1
        said = capsys.readouterr().err
        assert said.startswith(f"ocean_tweak: {copy / 'sea.usd'}: OpenUSD crashes on it")
        assert said.count("\n") == 1


@pytest.mark.usefixtures("in_this_process")
def test_foam_in_windrows_of_an_earlier_version_is_not_compared(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """They lay elsewhere; of the present version they must be where this program lays them."""
    storm = {**SEA, "domain_size": 400.0, "layers": [{"wind_speed": 25.0}]}
    for version, code in ((1, 0), (formats.WINDROWS, 1)):
        top = tmp_path / str(version) / "sea.usd"
        top.parent.mkdir()
        shot = Shot(OceanParameters.from_dict(storm))
        export = Export(Package("sea", shot, (1001,), proxy=0, windrows=version), top)
        with monkeypatch.context() as former:
            former.setattr(threshold, "windrows", lambda *_: None)
            for _ in export.make((1001,)):
                pass
            export.finish()
        assert main(["usd-verify", str(top)]) == code
    assert "foam differs" in capsys.readouterr().out
