# SPDX-License-Identifier: GPL-3.0-or-later
"""Shots for farms, and the farms' own programs from .tools/farm to try them with."""

from __future__ import annotations

import json
import os
import stat
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from ocean_tweak.cli import main
from tools import environments

ROOT = Path(__file__).parents[2]
HERE = Path(__file__).parent
SEA = {"resolution": 64, "domain_size": 200.0, "seed": 5}

#: what a `blender` program does with the arguments of a render, in the wheel of this Python
WHEEL = """#!{python}
import os, runpy, sys
import bpy
if os.environ.get("WITH_EXTENSION"):
    sys.path.insert(0, {examples!r})
    from extension import enable
    enable()
arguments = sys.argv[1:]
bpy.ops.wm.open_mainfile(filepath=next(word for word in arguments if word.endswith(".blend")))
runpy.run_path(arguments[arguments.index("--python") + 1], run_name="__main__")
"""

Run = Callable[..., subprocess.CompletedProcess[str]]


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    reason = ""
    if sys.version_info[:2] != (3, 13):
        reason = "tried once, with the Python of Blender 5.2"
    elif not environments.program("farm", "openjd").exists():
        reason = "no openjd in .tools/farm: run make setup"
    for item in items:
        if reason and HERE in item.path.parents:
            item.add_marker(pytest.mark.skip(reason=reason))


@pytest.fixture(scope="session")
def environment(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Of programs that find this checkout, and ask no network."""
    home = tmp_path_factory.mktemp("home")
    return {
        **os.environ, "PYTHONPATH": str(ROOT), "HOME": str(home), "DEADLINE_CLOUD_TELEMETRY_OPT_OUT": "true",
        "BLENDER_USER_RESOURCES": str(home / "blender"),
    }  # fmt: skip


@pytest.fixture(scope="session")
def run(environment: dict[str, str]) -> Run:
    """Run a program; what it prints comes in one text."""

    def run_program(*command: str | Path, **more: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [str(word) for word in command], env={**environment, **more}, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, timeout=120,
        )  # fmt: skip

    return run_program


@pytest.fixture(scope="session")
def openjd(run: Run) -> Run:
    return lambda *arguments, **more: run(environments.program("farm", "openjd"), *arguments, **more)


@pytest.fixture(scope="session")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A program that renders as `blender` would, in the wheel."""
    path = tmp_path_factory.mktemp("bin") / "blender"
    path.write_text(WHEEL.format(python=sys.executable, examples=str(ROOT / "examples")))
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path


@dataclass(frozen=True)
class Shot:
    """A folder with storm.json and shot.blend, whose plane shows storm_disp as light."""

    folder: Path

    @property
    def cache(self) -> Path:
        return self.folder / "cache"

    @property
    def pictures(self) -> Path:
        return self.folder / "pictures"

    @property
    def bake(self) -> Path:
        """The folder of the only bake."""
        (folder,) = self.cache.glob("storm-*/v*")
        return folder

    def write(self, name: str, *arguments: str | Path) -> Path:
        """Write a job for frames 1 to 3 into a folder of this name, as the command line does."""
        folder = self.folder / name
        words = [
            "job", "--params", self.folder / "storm.json", "--frames", "1-3", "--chunk", "2",
            "--workers", "1", "--out", folder, "--python", sys.executable, *arguments,
        ]  # fmt: skip
        assert main([str(word) for word in words]) == 0
        return folder


@pytest.fixture(scope="session")
def make_shot(tmp_path_factory: pytest.TempPathFactory, run: Run) -> Callable[[str], Shot]:
    """Make a shot in a folder of its own, with the .blend file that a function of make_blend.py makes."""

    def make(kind: str) -> Shot:
        folder = tmp_path_factory.mktemp("shot")
        (folder / "storm.json").write_text(json.dumps(SEA))
        arguments = ["--", kind, folder / "shot.blend", folder / "storm.json"]
        script = [ROOT / "tools" / "bpy_script.py", HERE / "make_blend.py"]
        answer = run(sys.executable, *script, *arguments)
        assert (folder / "shot.blend").exists(), answer.stdout
        return Shot(folder)

    return make
