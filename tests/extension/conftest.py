# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a real Blender whose fresh profile has the zip installed and enabled."""

import os
import subprocess
from pathlib import Path

import bpy
import pytest

from tests.blender_fixtures import empty_scene, extension, package  # noqa: F401 - fixtures for every test here


@pytest.fixture(scope="session")
def zip_file():
    """The zip that was installed."""
    return Path(os.environ["OCEAN_TWEAK_ZIP"])


@pytest.fixture
def run_blender():
    """Start another Blender on the same profile and return the finished process with its output."""

    def run(*arguments, **environment):
        return subprocess.run(
            [bpy.app.binary_path, *map(str, arguments)],
            env={**os.environ, **environment},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=300,
        )

    return run
