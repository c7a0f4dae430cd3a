# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/batch.md: its commands run, in their order, and its shot is one."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from ocean_tweak.cli import main
from ocean_tweak.core.parameters.shot import Shot as SeaOfShot
from tools import environments

from .conftest import ROOT, SEA, Run, Shot

TEXT = (ROOT / "docs" / "batch.md").read_text(encoding="utf-8")
COMMANDS = [
    line
    for block in re.findall(r"^```sh\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)
    for line in block.splitlines()
]


def test_commands_run_in_their_order(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, openjd: Run, run: Run
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("storm.json").write_text(json.dumps({**SEA, "resolution": 16}))
    Path("shot.blend").touch()
    programs = {
        "python": lambda *words: main([*words[2:], *(["--workers", "1"] if "bake" in words else [])]),
        "openjd": lambda *words: openjd(*words).returncode,
        "deadline": lambda *words: run(environments.program("farm", "deadline"), *words).returncode,
    }
    # what renders or sends a job away is tried elsewhere, or cannot be
    left_out = {"blender": 1, "openjd": 1, "deadline": 2}
    skipped: dict[str, int] = {}
    for command in COMMANDS:
        # fewer frames prove as much
        program, *words = command.replace("1-250", "1-30").replace("26-50", "26-30").split()
        if program == "blender" or "Render" in words or "submit" in words or "gui-submit" in words:
            skipped[program] = skipped.get(program, 0) + 1
            continue
        if program == "openjd" and "run" in words:
            words += ["-p", f"Python={sys.executable}"]
        assert programs[program](*words) == 0, command
    assert skipped == left_out
    assert len(list(tmp_path.glob("cache/storm-*/v001-*/storm_vel.*.exr"))) == 30
    assert Path("jobs/flamenco/ocean_tweak_storm.js").exists()


def test_the_animated_shot_is_one() -> None:
    (block,) = re.findall(r"^```json\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)
    shot = SeaOfShot.from_json(block)
    assert shot.at(5).parameters.layers[0].wind_speed == 12.0
    shot.check((1, 2, 3, 4, 5))


def test_options_exist(capsys: pytest.CaptureFixture[str]) -> None:
    told = ""
    for command in ("bake", "verify", "resume", "clean", "job"):
        assert main([command, "--help"]) == 0
        told += capsys.readouterr().out
    foreign = {"--background", "--command", "--render-output", "--render-anim", "--step", "--task-param",
               "--run-dependencies"}  # fmt: skip
    named = set(re.findall(r"(?<![\w-])--[a-z][a-z-]+", TEXT)) - foreign
    assert len(named) > 12
    assert [option for option in sorted(named) if option not in told] == []


def test_the_folder_is_as_it_is_told(make_shot: Callable[[str], Shot]) -> None:
    (block,) = re.findall(r"^```\n(cache/.*?)^```", TEXT, re.MULTILINE | re.DOTALL)
    shot = make_shot("images")
    assert main(["bake", "--params", str(shot.folder / "storm.json"), "--frames", "1",
                 "--out", str(shot.cache)]) == 0  # fmt: skip
    made = sorted(path.name for path in shot.bake.iterdir())
    assert made == ["bake.json", "locks", "records", "storm_disp.0001.exr"]
    for name in (*made, "0001.json", f"{shot.bake.parent.name}/", f"{shot.bake.name}/"):
        assert name in block
