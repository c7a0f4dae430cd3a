# SPDX-License-Identifier: GPL-3.0-or-later
"""A finished bake that tests copy and damage."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from ocean_tweak.cli import main
from tests.batch.bakery import only_folder, write_sea


@pytest.fixture(scope="session")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of six whole frames with two maps. Not to be changed."""
    place = tmp_path_factory.mktemp("finished")
    sea = write_sea(place / "sea.json")
    arguments = ["--frames", "1-6", "--maps", "disp,vel", "--workers", "1", "--out", str(place / "cache")]
    assert main(["bake", "--params", str(sea), *arguments]) == 0
    return only_folder(place / "cache")


@pytest.fixture
def copy(finished: Path, tmp_path: Path) -> Path:
    """A copy of it, with the times of the original."""
    home = tmp_path / "cache" / finished.parent.name
    shutil.copytree(finished.parent, home)
    return home / finished.name
