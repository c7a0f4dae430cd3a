# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a real Blender whose fresh profile has the zip installed and enabled."""

import importlib
import os
import subprocess
from pathlib import Path

import bpy
import pytest

PACKAGE = "bl_ext.user_default.ocean_tweak"


@pytest.fixture(scope="session")
def package():
    """The installed extension's name, as Blender's preferences have it."""
    enabled = [addon.module for addon in bpy.context.preferences.addons]
    assert PACKAGE in enabled, f"{PACKAGE} is not enabled; enabled are {enabled}"
    return PACKAGE


@pytest.fixture(scope="session")
def installed(package):
    """Import a module of the installed extension: `installed("core")`."""

    def import_installed(name=""):
        module = importlib.import_module(f"{package}.ocean_tweak{'.' if name else ''}{name}")
        profile = Path(os.environ["BLENDER_USER_RESOURCES"]).resolve()
        assert profile in Path(module.__file__).resolve().parents, f"{module.__file__} is not in {profile}"
        return module

    return import_installed


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


@pytest.fixture
def empty_scene():
    """A new file without objects."""
    bpy.ops.wm.read_homefile(use_empty=True)
    return bpy.context.scene
