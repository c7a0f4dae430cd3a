# SPDX-License-Identifier: GPL-3.0-or-later
"""`blender -b --command ocean_tweak ...` with the installed extension: same results, same exit codes."""

import json

import numpy as np
import pytest

SEA = {"resolution": 32, "domain_size": 200, "seed": 3, "timing": {"fps": 25, "start_frame": 1001}}


@pytest.fixture
def ocean_tweak(run_blender):
    """Run one command of the extension in a new Blender."""
    return lambda *arguments: run_blender("--background", "--command", "ocean_tweak", *arguments)


@pytest.fixture
def params(tmp_path):
    path = tmp_path / "sea.json"
    path.write_text(json.dumps(SEA))
    return path


def test_info_is_what_python_says(ocean_tweak, extension, params):
    answer = ocean_tweak("info", "--json", "--params", params, "--set", "layers.0.wind_speed=9")
    assert answer.returncode == 0, answer.stderr
    report = json.loads(answer.stdout[answer.stdout.index("{") : answer.stdout.rindex("}") + 1])["sea"]
    core = extension("core")
    parameters = core.OceanParameters.from_dict({**SEA, "layers": [{"wind_speed": 9}]})
    assert core.OceanParameters.from_dict(report["parameters"]) == parameters
    assert report["statistics"] == json.loads(json.dumps(core.Ocean(parameters).statistics().to_dict()))


def test_bake_writes_what_python_computes(ocean_tweak, extension, params, tmp_path):
    out = tmp_path / "frames"
    answer = ocean_tweak(
        "bake", "--params", params, "--frames", "1001-1003x2", "--out", out, "--compression", "ZIP"
    )
    assert answer.returncode == 0, answer.stderr
    (folder,) = out.glob("*/v*")
    assert sorted(file.name for file in folder.glob("*.exr")) == ["sea_disp.1001.exr", "sea_disp.1003.exr"]
    pixels, _ = extension("export.exr").read_image(folder / "sea_disp.1003.exr")
    core = extension("core")
    surface = core.Ocean(core.OceanParameters.from_dict(SEA)).surface(2 / 25)
    np.testing.assert_array_equal(pixels, surface.displacement)


@pytest.mark.parametrize("form", ["openjd", "flamenco"])
def test_job_is_written_with_all_that_it_needs(ocean_tweak, params, tmp_path, form):
    out, blend = tmp_path / "job", tmp_path / "shot.blend"
    blend.touch()
    answer = ocean_tweak(
        "job", "--form", form, "--params", params, "--frames", "1-3", "--out", out, "--blend", blend
    )
    assert answer.returncode == 0, answer.stdout + answer.stderr
    assert json.loads((out / "seas" / "sea.json").read_text())["resolution"] == 32
    (job,) = [path for path in out.iterdir() if path.name in ("template.json", "ocean_tweak_sea.js")]
    assert "render_baked.py" in job.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (["info", "--params", "PARAMS", "--set", "water.depth=-1"], 2, "water.depth = -1"),
        (["info", "--object", "Lake"], 2, "no ocean"),
        (["sail"], 2, "sail"),
        (["bake", "--frames", "1", "--out", "/proc/nowhere/x", "--params", "PARAMS"], 1, "/proc/nowhere"),
    ],
)
def test_failure_is_one_line_and_an_exit_code(ocean_tweak, params, arguments, code, said):
    answer = ocean_tweak(*(str(params) if argument == "PARAMS" else argument for argument in arguments))
    assert answer.returncode == code, answer.stdout + answer.stderr
    assert said in answer.stdout + answer.stderr
    assert "Traceback" not in answer.stdout + answer.stderr
