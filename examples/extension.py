# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds Ocean Tweak inside Blender: installed from its zip or, failing that, as this checkout."""

from __future__ import annotations

import importlib
import tempfile
from pathlib import Path
from types import ModuleType

import addon_utils
import bpy

INSTALLED = "bl_ext.user_default.ocean_tweak"
FROM_SOURCE = "bl_ext.ocean_tweak_source.ocean_tweak"
CHECKOUT = Path(__file__).resolve().parent.parent


class Extension:
    """The enabled extension, whose modules are imported by their names inside `ocean_tweak`."""

    def __init__(self, package: str) -> None:
        self.package = package

    def module(self, name: str) -> ModuleType:
        """A module such as "scene.ocean_object"."""
        return importlib.import_module(f"{self.package}.ocean_tweak.{name}")


def enable() -> Extension:
    """Enable the extension in this session. Raises RuntimeError if it cannot be."""
    package = INSTALLED if _is_installed() else FROM_SOURCE
    if package == FROM_SOURCE:
        _add_checkout()
    if addon_utils.enable(package) is None:
        raise RuntimeError(f"{package} cannot be enabled: the reason stands above")
    print(f"Ocean Tweak: {package}", flush=True)
    return Extension(package)


def _is_installed() -> bool:
    return any(
        (Path(repository.directory) / "ocean_tweak" / "blender_manifest.toml").exists()
        for repository in bpy.context.preferences.extensions.repos
        if repository.module == "user_default"
    )


def _add_checkout() -> None:
    """Show Blender the checkout as an extension in a repository of its own."""
    repository = Path(tempfile.mkdtemp(prefix="ocean_tweak_"))
    (repository / "ocean_tweak").symlink_to(CHECKOUT, target_is_directory=True)
    bpy.context.preferences.extensions.repos.new(
        name="Ocean Tweak source", module="ocean_tweak_source", custom_directory=str(repository),
        remote_url="", source="USER",
    )  # fmt: skip
