# SPDX-License-Identifier: GPL-3.0-or-later
"""The enabled extension, for tests that run inside Blender.

In a real Blender it is the zip, installed and enabled by the test run in a fresh profile; in a bpy wheel it
is this checkout, seen by Blender as an extension in a repository of its own. Tests reach the code through
these fixtures alone, so that one test holds for both: `import ocean_tweak` would be a second copy.
"""

import importlib
import os
from pathlib import Path

import bpy
import pytest

ROOT = Path(__file__).resolve().parent.parent
INSTALLED = "bl_ext.user_default.ocean_tweak"
FROM_SOURCE = "bl_ext.ocean_dev.ocean_tweak"


@pytest.fixture(scope="session")
def package(tmp_path_factory):
    """The extension's name in Blender's preferences; it is enabled."""
    if "OCEAN_TWEAK_ZIP" in os.environ:
        name = INSTALLED
    else:
        name = FROM_SOURCE
        enable_from_source(tmp_path_factory.mktemp("repository"))
    enabled = [addon.module for addon in bpy.context.preferences.addons]
    assert name in enabled, f"{name} is not enabled; enabled are {enabled}"
    return name


def enable_from_source(repository):
    """Make this checkout an extension of Blender's and enable it."""
    import addon_utils  # can be found only after `import bpy`

    # waves over coasts that an earlier version of the code made must not be found
    os.environ["OCEAN_TWEAK_COASTS"] = str(repository / "coasts")
    (repository / "ocean_tweak").symlink_to(ROOT, target_is_directory=True)
    bpy.context.preferences.extensions.repos.new(
        name="Source", module="ocean_dev", custom_directory=str(repository), remote_url="", source="USER"
    )
    assert addon_utils.enable(FROM_SOURCE, default_set=True) is not None


@pytest.fixture(scope="session")
def extension(package):
    """Import a module of the enabled extension: `extension("core.parameters.ocean_parameters")`."""
    home = Path(os.environ["BLENDER_USER_RESOURCES"]) if "OCEAN_TWEAK_ZIP" in os.environ else ROOT

    def import_module(name):
        module = importlib.import_module(f"{package}.ocean_tweak.{name}")
        file = Path(module.__file__).resolve()
        assert home.resolve() in file.parents, f"{file} is not in {home}"
        return module

    return import_module


@pytest.fixture
def empty_scene(package):
    """The scene of a new file without objects."""
    bpy.ops.wm.read_homefile(use_empty=True)
    return bpy.context.scene
