# SPDX-License-Identifier: GPL-3.0-or-later
"""The job type for Flamenco: run as its manager would, and its commands as its workers would."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from ocean_tweak.cli import FileSea, main
from ocean_tweak.core import OceanParameters
from ocean_tweak.core.parameters.shot import Shot as SeaOfShot
from tools import environments

from .conftest import HERE, Run, Shot

ENGINE = (
    "import os, sys; from py_mini_racer import MiniRacer; engine = MiniRacer();"
    "engine.eval(open(sys.argv[1]).read()); engine.eval(open(sys.argv[2]).read());"
    # its threads never let Python end by itself
    "print(engine.eval(sys.argv[3]), flush=True); os._exit(0)"
)


@pytest.fixture(scope="module")
def compile_job(run: Run) -> Callable[..., dict[str, Any]]:
    """Give settings to a job type; what it says of itself and its tasks."""

    def compiled(folder: Path, **settings: object) -> dict[str, Any]:
        (script,) = folder.glob("ocean_tweak_*.js")
        call = f"compiled({json.dumps(settings)})"
        answer = run(environments.program("farm", "python"), "-c", ENGINE, HERE / "manager.js", script, call)
        assert answer.returncode == 0, answer.stdout
        return json.loads(answer.stdout)

    return compiled


def test_tasks_wait_for_what_they_need(compile_job: Callable[..., dict[str, Any]], tmp_path: Path) -> None:
    seas = {
        name: FileSea(SeaOfShot(OceanParameters(resolution=32)), None, tuple(range(1, 9))) for name in "AB"
    }
    blend = tmp_path / "shot.blend"
    blend.touch()
    arguments = ["job", "--form", "flamenco", "--out", str(tmp_path / "job"), "--blend", str(blend)]
    assert main([*arguments, "--chunk", "4", "--render-chunk", "3"], lambda: seas) == 0
    job = compile_job(tmp_path / "job", blendfile=str(blend), frames="1-7,9")
    assert job["type"]["label"] == "Ocean Tweak: shot"
    assert {task["name"]: task["dependencies"] for task in job["tasks"]} == {
        "bake-A-1-4": [], "verify-A-1-4": ["bake-A-1-4"],
        "bake-A-5-7,9": [], "verify-A-5-7,9": ["bake-A-5-7,9"],
        "bake-B-1-4": [], "verify-B-1-4": ["bake-B-1-4"],
        "bake-B-5-7,9": [], "verify-B-5-7,9": ["bake-B-5-7,9"],
        "render-1-3": ["verify-A-1-4", "verify-B-1-4"],
        "render-4-6": ["verify-A-1-4", "verify-B-1-4", "verify-A-5-7,9", "verify-B-5-7,9"],
        "render-7,9": ["verify-A-5-7,9", "verify-B-5-7,9"],
    }  # fmt: skip
    # nobody may wait for what comes later, or is not there
    names = [task["name"] for task in job["tasks"]]
    for index, task in enumerate(job["tasks"]):
        assert set(task["dependencies"]) <= set(names[:index])
    kinds = {task["name"].partition("-")[0]: task["type"] for task in job["tasks"]}
    assert kinds == {"bake": "misc", "verify": "misc", "render": "blender"}
    text = json.dumps(job["tasks"])
    assert "<" not in text
    assert "@SHOT@" not in text


def test_stepped_frames_are_named_one_by_one(
    compile_job: Callable[..., dict[str, Any]], tmp_path: Path
) -> None:
    """Flamenco knows no steps; what it makes of them is what the render's script reads."""
    seas = {"A": FileSea(SeaOfShot(OceanParameters(resolution=32)), None, (1,))}
    blend = tmp_path / "shot.blend"
    blend.touch()
    arguments = ["job", "--form", "flamenco", "--out", str(tmp_path / "job"), "--blend", str(blend)]
    assert main([*arguments, "--frames", "1-9x2", "--chunk", "2", "--render-chunk", "3"], lambda: seas) == 0
    job = compile_job(tmp_path / "job", blendfile=str(blend))
    assert [task["name"] for task in job["tasks"] if task["name"].startswith(("bake", "render"))] == [
        "bake-A-1,3", "bake-A-5,7", "bake-A-9", "render-1,3,5", "render-7,9",
    ]  # fmt: skip
    (render,) = [task for task in job["tasks"] if task["name"] == "render-7,9"]
    assert render["commands"][0]["parameters"]["args"][-1] == "--frames=7,9"
    assert render["dependencies"] == ["verify-A-5,7", "verify-A-9"]


def test_settings_are_of_kinds_that_flamenco_knows(
    compile_job: Callable[..., dict[str, Any]], make_shot: Callable[[str], Shot], wheel: Path, run: Run
) -> None:
    shot = make_shot("images")
    blend = shot.folder / "shot.blend"
    cache, pictures = ("--cache", shot.cache), ("--pictures", shot.pictures)
    folder = shot.write("job", "--form", "flamenco", "--blend", blend, *cache, *pictures)
    job = compile_job(folder, blendfile=str(blend))
    settings = {setting["key"]: setting for setting in job["type"]["settings"]}
    assert {setting["type"] for setting in settings.values()} <= {"string", "int32", "float", "bool"}
    assert {setting.get("subtype", "dir_path") for setting in settings.values()} == {"dir_path"}
    assert settings["frames"]["default"] == "1-3"
    assert settings["cache"]["default"] == str(shot.cache)

    for task in job["tasks"]:
        (command,) = task["commands"]
        answer = run_as_worker(command, wheel, run)
        assert answer.returncode == 0, answer.stdout
    assert len(list(shot.bake.glob("*.exr"))) == 3
    assert len(list(shot.pictures.glob("shot_000?.exr"))) == 3


def test_paths_and_names_stay_as_they_are(compile_job: Callable[..., dict[str, Any]], tmp_path: Path) -> None:
    """Whatever they hold: names of other settings, quotes, ends of scripts, or a minus at the front."""
    seas = {"-<cache>\u2028": FileSea(SeaOfShot(OceanParameters(resolution=32)), None, (1,))}
    blend = tmp_path / "'\"\\ <script> é海 `${x}`.blend"
    blend.touch()
    cache, pictures = tmp_path / "<pictures>$&<frames></script>", tmp_path / "<cache>"
    arguments = ["job", "--form", "flamenco", "--out", str(tmp_path / "<job_folder>"), "--blend", str(blend)]
    assert main([*arguments, f"--cache={cache}", f"--pictures={pictures}"], lambda: seas) == 0
    (script,) = (tmp_path / "<job_folder>").glob("ocean_tweak_*.js")
    assert script.name.isascii()
    job = compile_job(tmp_path / "<job_folder>", blendfile=str(blend))
    tasks = {task["name"].partition("-")[0]: task["commands"][0]["parameters"] for task in job["tasks"]}
    for name in ("bake", "verify"):
        assert f"--out={cache}" in tasks[name]["args"]
        assert "--name=-_cache_" in tasks[name]["args"]
        assert f"--params={tmp_path}/<job_folder>/seas/-_cache_.json" in tasks[name]["args"]
    assert f"--cache={cache}" in tasks["render"]["args"]
    assert f"--pictures={pictures}" in tasks["render"]["args"]
    assert tasks["render"]["blendfile"] == str(blend)


def run_as_worker(command: dict[str, Any], blender: Path, run: Run) -> subprocess.CompletedProcess[str]:
    """As Flamenco's worker does it, with the manager's variables filled in."""
    parameters = command["parameters"]
    if command["name"] == "exec":
        return run(parameters["exe"], *parameters["args"])
    assert command["name"] == "blender-render"
    assert (parameters["exe"], parameters["exeArgs"]) == ("{blender}", "{blenderArgs}")
    before = ["-b", "-y", *parameters["argsBefore"]]
    return run(blender, *before, parameters["blendfile"], *parameters["args"])
