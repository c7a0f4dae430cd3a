# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands `usd` and `usd-verify`, and parameters from layers."""

from __future__ import annotations

import json
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from pxr import Sdf, Usd, Vt

from ocean_tweak.cli import FileSea, main
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.export.usd.package import with_samples_between
from ocean_tweak.export.usd.verify import verify

from .conftest import SEA, shot, write


@pytest.fixture
def params(tmp_path: Path) -> str:
    path = tmp_path / "parameters.json"
    path.write_text(json.dumps(SEA))
    return str(path)


def problems(top: Path) -> list[str]:
    return [text for _, text in verify(top)]


@pytest.mark.parametrize("form", ["points", "clips", "displacement"])
def test_one_command(params, tmp_path, capsys, form):
    top = tmp_path / "asset" / "wave.usd"
    arguments = ["usd", "--params", params, "--frames", "1001-1003", "--form", form, "--out", str(top)]
    assert main(arguments) == 0
    said = capsys.readouterr().out
    assert "(3/3)" in said
    assert f"usd-verify {top}" in said
    assert main(["usd-verify", str(top)]) == 0
    assert "all is well" in capsys.readouterr().out
    assert Usd.Stage.Open(str(top)).GetDefaultPrim().GetName() == "wave"


@pytest.mark.parametrize("form", ["points", "clips", "displacement"])
@pytest.mark.parametrize(
    ("file", "prim", "clip"),
    [
        ("sea.v001.usd", "sea_v001", "sea.v001.1001.usdc"),
        ("2.sea@(fx)[1].v2.usda", "__sea_fx_1__v2", "2.sea_fx_1_.v2.1001.usdc"),
    ],
)
def test_names_with_a_version(params, tmp_path, capsys, form, file, prim, clip):
    top = tmp_path / "asset" / file
    command = ["usd", "--params", params, "--frames", "1001-1003", "--form", form, "--out", str(top)]
    for _ in range(2):  # what is there is known as one's own
        assert main(command) == 0
    assert problems(top) == []
    stage = Usd.Stage.Open(str(top))
    assert stage.GetDefaultPrim().GetName() == prim
    assert Sdf.Path.IsValidIdentifier(prim)
    if form == "clips":
        assert (top.parent / "clips" / clip).is_file()
    assert not [path for path in top.parent.rglob("*") if path.name.startswith(".")]


def test_clips_in_any_order_then_the_top(params, tmp_path, capsys):
    top = tmp_path / "asset" / "sea.usd"
    command = ["usd", "--params", params, "--frames", "1001-1004", "--form", "clips", "--out", str(top)]
    assert main([*command, "--only", "1003-1004"]) == 0
    assert not top.exists()
    assert main([*command, "--stitch"]) == 1
    assert "frames 1001-1002 have no clip of this sea" in capsys.readouterr().err
    assert main([*command, "--only", "1001-1002"]) == 0
    together = (top.parent / "clips" / "sea.1003.usdc").read_bytes()
    assert main([*command, "--stitch"]) == 0
    assert problems(top) == []
    alone = tmp_path / "alone" / "sea.usd"
    command[-1] = str(alone)
    assert main(command) == 0
    assert (alone.parent / "clips" / "sea.1003.usdc").read_bytes() == together


def test_displacement_by_a_bake(params, tmp_path, capsys):
    bake = ["bake", "--params", params, "--frames", "1001-1003", "--out", str(tmp_path / "cache")]
    assert main([*bake, "--workers", "1"]) == 0
    (folder,) = (tmp_path / "cache").glob("*/v*")
    top = tmp_path / "asset" / "sea.usd"
    command = ["usd", "--form", "displacement", "--bake", str(folder), "--out", str(top)]
    assert main(command) == 0
    assert problems(top) == []
    assert not (top.parent / "textures").exists()
    layer = Sdf.Layer.FindOrOpen(str(top.parent / "mtl.usd"))
    assert all(path.startswith("../cache/") for path in layer.GetExternalAssetDependencies())
    capsys.readouterr()
    assert main([*command, "--frames", "1002-1006"]) == 1
    assert "frames 1004-1006 are not in this bake" in capsys.readouterr().err
    assert main([*command, "--params", params]) == 2
    assert main([*command[:2], "points", *command[3:]]) == 2
    (folder / "sea_disp.1002.exr").unlink(missing_ok=True)
    (folder / "parameters_disp.1002.exr").unlink(missing_ok=True)
    assert any("1002.exr is missing" in text for text in problems(top))


@pytest.mark.parametrize(
    ("more", "code", "said"),
    [
        (["--form", "points"], 2, "--frames: say which frames"),
        (["--form", "points", "--frames", "1-4", "--only", "2"], 2, "is for clips"),
        (["--form", "clips", "--frames", "1-4", "--only", "4-5"], 2, "must be some of the frames 1-4"),
        (["--form", "points", "--frames", "1-4", "--stitch"], 2, "--stitch: is for --form clips"),
        (["--form", "points", "--frames", "1-4", "--tiles", "3"], 2, "must look like 3x3"),
        (["--form", "points", "--frames", "1-4", "--subframes", "3"], 2, "such as 2, 4, 5, 8 or 10"),
        (["--form", "sail", "--frames", "1"], 2, "sail"),
        (["--form", "points", "--frames", "1", "--out", "sea.obj"], 2, "must end in .usd"),
        (["--form", "points", "--frames", "1", "--out", "/proc/nowhere/sea.usd"], 1, "/proc/nowhere"),
        (["--form", "displacement", "--bake", "/nowhere"], 1, "/nowhere/bake.json"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said(more, code, said, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["usd", "--out", "sea.usd", *more]) == code
    captured = capsys.readouterr()
    assert said in captured.err.splitlines()[-1]
    assert "Traceback" not in captured.err
    assert not list(tmp_path.rglob("*.usd*"))


def test_without_openusd(tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "pxr", None)
    command = ["usd", "--form", "points", "--frames", "1", "--out", str(tmp_path / "sea.usd")]
    assert main(command) == 1
    assert "pip install usd-core" in capsys.readouterr().err
    assert main(["info", "--set", "resolution=16"]) == 0


def test_subframes(tmp_path):
    assert with_samples_between((1, 2, 5), 2) == (1, 1.5, 2, 5)
    assert with_samples_between((1, 2), 1) == (1, 2)
    top = tmp_path / "sea.usd"
    arguments = ["usd", "--set", "resolution=16", "--set", "foam.half_life=0", "--form", "clips"]
    assert main([*arguments, "--frames", "1-2", "--subframes", "4", "--out", str(top)]) == 0
    names = sorted(path.name for path in (tmp_path / "clips").iterdir())
    assert names == [f"sea.{label}.usdc" for label in ("0001.25", "0001.5", "0001.75", "0001", "0002")]
    assert problems(top) == []


def test_parameters_from_a_layer(exported, tmp_path, capsys):
    def parameters(path: Path) -> dict:
        assert main(["info", "--json", "--params", str(path)]) == 0
        ((_, report),) = json.loads(capsys.readouterr().out).items()
        return report["parameters"]

    assert Shot.from_dict(parameters(exported(form="clips"))) == shot()
    stage = Usd.Stage.CreateNew(str(tmp_path / "shot.usda"))
    stage.DefinePrim("/set/ocean").GetReferences().AddReference(str(exported(form="points")))
    stage.Save()
    assert Shot.from_dict(parameters(tmp_path / "shot.usda")) == shot()
    stage.DefinePrim("/set/other").GetReferences().AddReference(str(exported(form="points")))
    stage.Save()
    assert main(["info", "--params", str(tmp_path / "shot.usda")]) == 1
    assert "several seas, /set/ocean, /set/other" in capsys.readouterr().err
    empty = tmp_path / "empty.usda"
    Usd.Stage.CreateNew(str(empty)).Save()
    for path, said in ((empty, "holds no sea"), (tmp_path / "absent.usd", "no such file")):
        assert main(["info", "--params", str(path)]) == 1
        assert said in capsys.readouterr().err


def test_a_changed_record_is_refused(exported, tmp_path, capsys):
    shutil.copytree(exported(form="points").parent, tmp_path / "copy")
    top = tmp_path / "copy" / "sea.usd"
    top.write_text(top.read_text().replace('"seed": 3', '"seed": 4'))
    assert main(["info", "--params", str(top)]) == 1
    assert "was changed" in capsys.readouterr().err


def test_the_oceans_of_a_file(tmp_path, capsys):
    oceans = {"Bay": FileSea(shot(), frames=(1001, 1002)), "Pond": FileSea(shot())}
    command = ["usd", "--form", "points", "--out", str(tmp_path / "bay.usd")]
    assert main(command, lambda: oceans) == 2
    assert "choose one with --object, of Bay, Pond" in capsys.readouterr().err
    assert main([*command, "--object", "Bay"], lambda: oceans) == 0
    assert Usd.Stage.Open(str(tmp_path / "bay.usd")).GetEndTimeCode() == 1002.0


def test_verify_names_what_is_lost(tmp_path, capfd):
    top = tmp_path / "sea.usd"
    write(top, frames="1001-1008", form="clips")
    for frame in (1003, 1004, 1006):
        (tmp_path / "clips" / f"sea.{frame}.usdc").unlink()
    assert main(["usd-verify", str(top)]) == 1
    said = capfd.readouterr().out
    for frame in (1003, 1004, 1006):
        assert f"frame {frame}: {tmp_path / 'clips' / f'sea.{frame}.usdc'} is missing" in said
    assert "frames 1003-1004,1006 have no sample" in said


def test_verify_finds_clips_of_another_sea_and_damaged_ones(tmp_path, quiet):
    top, other = tmp_path / "a" / "sea.usd", tmp_path / "b" / "sea.usd"
    write(top, form="clips")
    write(other, form="clips", up_axis="Y")
    shutil.copy(other.parent / "clips" / "sea.1002.usdc", top.parent / "clips" / "sea.1002.usdc")
    damaged = top.parent / "clips" / "sea.1003.usdc"
    damaged.write_bytes(damaged.read_bytes()[:-2000])
    found = problems(top)
    assert any("sea.1002.usdc belongs to another sea" in text for text in found)
    assert any("sea.1003.usdc is damaged" in text for text in found)


@pytest.mark.parametrize("form", ["points", "clips", "displacement"])
def test_a_calm_does_not_move_and_is_well(params, tmp_path, form):
    top = tmp_path / "calm.usd"
    arguments = ["--params", params, "--set", "layers.0.wind_speed=0", "--frames", "1001-1002"]
    assert main(["usd", *arguments, "--form", form, "--out", str(top)]) == 0
    assert problems(top) == []


def test_verify_finds_a_sea_that_stands_still(tmp_path):
    """Defaults in the layer that anchors the clips win over them: every validator is content with that."""
    top = tmp_path / "sea.usd"
    write(top, form="clips")
    stage = Usd.Stage.Open(str(tmp_path / "geo.usd"))
    points = stage.GetPrimAtPath("/sea/surface").GetAttribute("points")
    points.Set(points.Get(1001))
    stage.Save()
    assert any("nothing moves" in text for text in problems(top))


@pytest.mark.parametrize("name", ["points", "velocities", "normals", "primvars:foam", "extent"])
def test_verify_finds_a_changed_value(tmp_path, name):
    top = tmp_path / "sea.usd"
    write(top, form="points")
    layer = Sdf.Layer.FindOrOpen(str(tmp_path / "geo.usdc"))
    path = Sdf.Path(f"/sea/surface.{name}")
    values = np.array(layer.QueryTimeSample(path, 1004.0))
    values[:] = 0.5 * values + 0.01
    kind = Vt.FloatArray if values.ndim == 1 else Vt.Vec3fArray
    layer.SetTimeSample(path, 1004.0, kind.FromNumpy(values))
    layer.Save()
    del layer
    found = [(frame, text) for frame, text in verify(top) if frame is not None]
    assert {frame for frame, _ in found} == {1004}
    assert any(name in text for _, text in found)


def test_verify_finds_another_frame_rate(tmp_path):
    top = tmp_path / "sea.usd"
    write(top)
    layer = Sdf.Layer.FindOrOpen(str(top))
    layer.timeCodesPerSecond = 24
    layer.Save()
    del layer
    assert "timeCodesPerSecond is 24.0, and the sea was exported with 25.0" in problems(top)


def test_verify_refuses_frames_that_are_not_there(exported, capsys):
    assert main(["usd-verify", str(exported(form="points")), "--frames", "7"]) == 1
    assert "holds the frames 1001-1004, not 7" in capsys.readouterr().err
