# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: results, messages and exit codes."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import FileSea, info, main
from ocean_tweak.core import Ocean, OceanParameters, WaveLayer
from ocean_tweak.core.numerics.memo import MEMO
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.core.sea import memory
from ocean_tweak.export.exr import read_image

ROOT = Path(__file__).parents[2]
NOWHERE = Path("/nowhere")  # with the system's separators
NO_PROC = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no folder where nobody may write")
HAS_DRIVES = pytest.mark.skipif(sys.platform == "win32", reason="on Windows, D: is a place like any other")
SMALL = {"resolution": 32, "domain_size": 200.0, "seed": 5, "timing": {"fps": 25, "start_frame": 1001}}


def only_folder(cache: Path) -> Path:
    """The folder of the only bake in a cache."""
    (folder,) = cache.glob("*/v*")
    return folder


def image_names(cache: Path) -> list[str]:
    return sorted(path.name for path in cache.glob("*/v*/*.exr"))


@pytest.fixture
def params(tmp_path: Path) -> Path:
    path = tmp_path / "small.json"
    path.write_text(json.dumps(SMALL))
    return path


def test_bake_gives_the_array_of_python(
    params: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "new" / "folder"
    code = main(
        ["bake", "--params", str(params), "--frames", "1003,1001", "--out", str(out), "--compression", "ZIP"]
    )
    assert code == 0
    assert image_names(out) == ["small_disp.1001.exr", "small_disp.1003.exr"]
    parameters = OceanParameters.from_json(params.read_text())
    pixels, _ = read_image(only_folder(out) / "small_disp.1003.exr")
    np.testing.assert_array_equal(pixels, Ocean(parameters).surface(2 / 25).displacement)
    lines = capsys.readouterr().out.splitlines()
    assert "2 frames of disp: 2 missing" in lines[1]
    assert "(1/2)" in lines[2]


def test_a_missing_wheel_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "OpenEXR", None)
    assert main(["bake", "--frames", "1", "--out", str(tmp_path), "--set", "resolution=16"]) == 1
    message = capsys.readouterr().err
    assert "pip install OpenEXR" in message
    assert message.count("\n") == 1
    assert not image_names(tmp_path)


def test_memory_is_told_and_guarded(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert main(["info", "--json"]) == 0
    need = json.loads(capsys.readouterr().out)["ocean"]["memory"]
    assert need["surface"] > 12 * 512**2
    monkeypatch.setattr(memory, "usable_memory", lambda: need["state"])
    assert main(["bake", "--frames", "1", "--out", str(tmp_path / "out")]) == 1
    assert "lower the resolution" in capsys.readouterr().err
    assert not image_names(tmp_path / "out")


def test_info_says_before_what_a_large_sea_takes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """And does not begin one that would be killed for its memory."""
    sea = {"resolution": 8192, "layers": [{"id": number, "wind_speed": 5 + number} for number in range(20)]}
    (tmp_path / "sea.json").write_text(json.dumps(sea))
    begun = []
    monkeypatch.setattr(info, "seconds_of_statistics", lambda parameters: 3723.0)
    monkeypatch.setattr(info.Ocean, "statistics", lambda self: begun.append(self) or 1 / 0)
    with pytest.raises(ZeroDivisionError):
        main(["info", "--params", str(tmp_path / "sea.json")])
    told = re.fullmatch(
        r"ocean_tweak: sea: 8192² samples and 20 layers take about 1:02:03 and (\d\.\d+) GB of memory; .*\n",
        capsys.readouterr().err,
    )
    assert told
    assert (
        5.0 < float(told[1]) < 8.0
    )  # two planes of random numbers for each of four layers, 2 GB, and the waves
    monkeypatch.setattr(memory, "usable_memory", lambda: 4 * 2**30)
    assert main(["info", "--params", str(tmp_path / "sea.json")]) == 1
    printed = capsys.readouterr()
    assert printed.out == ""
    assert re.match(
        r"ocean_tweak: sea: 8192² samples and 20 layers needs \d\.\d GB of memory and", printed.err
    )
    assert len(begun) == 1
    monkeypatch.undo()
    assert main(["info", "--set", "resolution=64"]) == 0
    assert capsys.readouterr().err == ""


def test_the_range_never_moves_time(params: Path, tmp_path: Path) -> None:
    for name, frames in (("whole", "1001-1003"), ("part", "1003")):
        assert main(["bake", "--params", str(params), "--frames", frames, "--out", str(tmp_path / name)]) == 0
    file = "small_disp.1003.exr"
    whole, part = (only_folder(tmp_path / name) / file for name in ("whole", "part"))
    assert whole.read_bytes() == part.read_bytes()


def test_slow_motion_is_the_sea_between_two_frames(params: Path, tmp_path: Path) -> None:
    command = ["bake", "--params", str(params), "--maps", "disp,vel", "--out", str(tmp_path)]
    assert main([*command, "--frames", "7", "--set", "timing.stretch=4", "--start-frame", "1"]) == 0
    pixels, metadata = read_image(only_folder(tmp_path) / "small_disp.0007.exr")
    assert metadata["parameters"]["timing"] == {"fps": 25, "start_frame": 1, "stretch": 4}
    fields = Ocean(OceanParameters.from_dict(SMALL)).surface((7 / 4 - 1) / 25, {"displacement", "velocity"})
    np.testing.assert_allclose(pixels, fields.displacement, atol=1e-3)
    velocity, _ = read_image(only_folder(tmp_path) / "small_vel.0007.exr")
    np.testing.assert_allclose(velocity, fields.velocity / 4, atol=1e-3)


def test_set_fps_and_start_frame(params: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["info", "--json", "--params", str(params), "--set", "layers.0.wind_speed=25",
                 "--set", "dispersion=DEEP", "--fps", "24000/1001", "--start-frame", "7"]  # fmt: skip
    assert main(arguments) == 0
    report = json.loads(capsys.readouterr().out)["small"]
    changed = OceanParameters.from_dict(report["parameters"])
    expected = OceanParameters.from_dict(
        {**SMALL, "dispersion": "DEEP", "timing": {"fps": "24000/1001", "start_frame": 7},
         "layers": [{"wind_speed": 25.0}]}
    )  # fmt: skip
    assert changed == expected
    assert report["statistics"]["spectrum"]["significant_wave_height"] > 5.0


def test_info_says_what_the_sea_will_be(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info"]) == 0
    text = capsys.readouterr().out
    assert "3.15 m" in text  # the default sea
    assert "7.58 s" in text
    assert main(["info", "--set", "domain_size=100", "--set", "resolution=32"]) == 0
    assert "warning: The domain of 100 m holds only 1.1" in capsys.readouterr().out
    assert main(["info", "--set", "layers.0.wind_speed=0"]) == 0
    calm = capsys.readouterr().out
    assert "sea state 0, calm (glassy)" in calm
    assert "nan" not in calm


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (["info", "--set", "layers.0.wind_speed=-3"], 2, "wind_speed = -3: must be from 0 to 100 m/s"),
        (["info", "--set", "layers.0.wind_speed=NaN"], 2, "finite"),
        (["info", "--set", "layers.0.wind_sped=3"], 2, "did you mean wind_speed?"),
        (["info", "--set", "layers.4.wind_speed=3"], 2, "from 0 to 0"),
        (["info", "--set", f"layers.{'9' * 5000}.wind_speed=3"], 2, "from 0 to 0"),
        (["info", "--set", "water.depth.x=3"], 2, "water.depth.x"),
        (["info", "--set", "resolution"], 2, "must look like"),
        (["info", "--params", "absent.json"], 2, "absent.json"),
        (["info", "--params", "."], 2, "--params"),
        (["info", "--fps", "0"], 2, "timing.fps = 0"),
        (["bake", "--frames", "3-1", "--out", "x"], 2, "'3-1' 3-1 holds no frames"),
        (["bake", "--frames", "1"], 2, "--out"),
        (["bake", "--frames", "1", "--out", "x", "--workers", "0"], 2, "'0' must be a whole number from 1"),
        pytest.param(
            ["bake", "--frames", "1", "--out", "/proc/nowhere/x"], 1, "/proc/nowhere", marks=NO_PROC
        ),
        (["bake", "--frames", "1", "--out", "x", "--maps", "disp,heat"], 2, "'heat' is not a map"),
        (["bake", "--frames", "1-4", "--only", "4-5", "--out", "x"], 2, "--only 4-5: must be some of"),
        pytest.param(
            ["bake", "--frames", "1", "--out", "D:\\water"], 2, "is a Windows path", marks=HAS_DRIVES
        ),
        (["usd-verify", "~nobody_here/x.usd"], 2, "write ./~nobody_here/x.usd"),
        (["bake", "--frames", "1-2x0.25", "--out", "x"], 2, "1.25 lies between two frames, and file names"),
        (["bake", "--frames", "1-2x0.25", "--out", "x"], 2, "or 4 for each with --set timing.stretch=4"),
        (["verify", "/nowhere"], 1, f"{NOWHERE / 'bake.json'}: No such file"),
        (["resume", "/nowhere"], 1, f"{NOWHERE / 'bake.json'} cannot be read"),
        (["clean", "/nowhere"], 2, f"{NOWHERE}: is not a folder"),
        (["sail"], 2, "sail"),
        ([], 2, "COMMAND"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_in_one_line(
    arguments: list[str], code: int, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == code
    captured = capsys.readouterr()
    assert said in captured.err.splitlines()[-1]
    assert "Traceback" not in captured.err
    assert not captured.out


def test_a_bad_file_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "bad.json"
    for content in (b"{", b"\xff\xfe\x00", b'{"depth": 3}'):
        path.write_bytes(content)
        assert main(["bake", "--params", str(path), "--frames", "1", "--out", str(tmp_path / "out")]) == 2
        assert capsys.readouterr().err.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_folder_that_is_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "file"
    target.write_text("mine")
    assert main(["bake", "--frames", "1", "--out", str(target), "--set", "resolution=16"]) == 1
    assert str(target) in capsys.readouterr().err
    assert target.read_text() == "mine"


def test_a_tilde_is_the_home_without_a_shell(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    home = tmp_path / "home"
    home.mkdir()
    monkeypatch.chdir(tmp_path)
    for name in ("HOME", "USERPROFILE"):  # of Windows
        monkeypatch.setenv(name, str(home))
    monkeypatch.setenv("OCEAN_TWEAK_CACHE", "~/water")
    sea = ["--set", "resolution=16", "--frames", "1"]
    assert main(["bake", *sea]) == 0
    assert main(["bake", *sea, "--out", "~/more", "--name", "bay"]) == 0
    assert main(["verify", *sea]) == 0
    assert [path.name for path in sorted(home.glob("*/*/*/*.exr"))] == [
        "bay_disp.0001.exr",
        "ocean_disp.0001.exr",
    ]
    assert [path.name for path in tmp_path.iterdir()] == ["home"]


@HAS_DRIVES
def test_a_cache_of_another_system_is_refused(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("OCEAN_TWEAK_CACHE", "D:\\water")
    assert main(["bake", "--set", "resolution=16", "--frames", "1"]) == 2
    assert "OCEAN_TWEAK_CACHE: 'D:" in capsys.readouterr().err


def test_scene_oceans(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    oceans = {
        "Bay.001": FileSea(Shot(OceanParameters(resolution=16)), "0123abcd", (5, 6)),
        "Open/Sea": FileSea(Shot(OceanParameters(resolution=32, layers=(WaveLayer(wind_speed=20.0),)))),
    }
    assert main(["bake", "--frames", "2", "--out", str(tmp_path)], lambda: oceans) == 0
    assert image_names(tmp_path) == ["Bay_001_disp.0002.exr", "Open_Sea_disp.0002.exr"]
    assert (tmp_path / "Bay_001-0123abcd").is_dir()
    assert main(["bake", "--object", "Bay.001", "--out", str(tmp_path / "scene")], lambda: oceans) == 0
    assert image_names(tmp_path / "scene") == ["Bay_001_disp.0005.exr", "Bay_001_disp.0006.exr"]
    assert main(["info", "--object", "Bay.001"], lambda: oceans) == 0
    capsys.readouterr()
    assert main(["info", "--object", "Lake"], lambda: oceans) == 2
    assert "Bay.001, Open/Sea" in capsys.readouterr().err
    assert main(["info"], dict) == 2
    assert main(["bake", "--frames", "2", "--out", str(tmp_path), "--name", "x"], lambda: oceans) == 2


def test_as_a_program(params: Path) -> None:
    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "ocean_tweak", *arguments]
        return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)

    assert run("--version").stdout.startswith("Ocean Tweak ")
    good = run("info", "--params", str(params))
    assert (good.returncode, good.stderr) == (0, "")
    assert run("info", "--set", "seed=-1").returncode == 2


def test_info_tells_what_is_kept_and_of_how_much(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(MEMO, "_budget", None)
    monkeypatch.setenv("OCEAN_TWEAK_MEMORY", "3GB")
    MEMO.drop()
    arguments = ["info", "--set", "resolution=512"]
    assert main([*arguments, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)["ocean"]["memory"]
    assert told["budget"] == 3_000_000_000
    # 512 x 257 waves of 40 bytes: four coefficients and two frequencies
    assert told["kept"]["waves"] == 512 * 257 * 40
    assert main(arguments) == 0
    said = capsys.readouterr().out
    assert re.search(r"\nmemory for all seas: .* MB of 3 GB is used: waves 5\.26 MB, ", said)


def test_a_budget_below_one_sea_is_a_warning(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(MEMO, "_budget", None)
    monkeypatch.setenv("OCEAN_TWEAK_MEMORY", "1MB")
    assert main(["info", "--set", "resolution=512"]) == 0
    said = capsys.readouterr().out
    # 512 x 257 waves of 40 bytes, and the 16 of their random phases
    assert "  warning: This sea needs 7.37 MB, and the memory for all seas is 1 MB: " in said
    assert "OCEAN_TWEAK_MEMORY) to 11.1 MB" in said


def test_a_budget_that_is_none_is_refused_in_a_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(MEMO, "_budget", None)
    monkeypatch.setenv("OCEAN_TWEAK_MEMORY", "8 bananas")
    for arguments in (["info"], ["bake", "--frames", "1", "--set", "resolution=16", "--out", str(tmp_path)]):
        assert main(arguments) == 2
        said = capsys.readouterr().err
        assert said.count("\n") == 1
        assert "OCEAN_TWEAK_MEMORY = '8 bananas': must be a size" in said
