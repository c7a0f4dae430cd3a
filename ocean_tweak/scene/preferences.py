# SPDX-License-Identifier: GPL-3.0-or-later
"""What is the user's: the choices in Blender's preferences, and the folder of the extension's own files."""

from __future__ import annotations

from pathlib import Path

import bpy

_EXTENSIONS = "bl_ext"


def extension_name() -> str | None:
    """The name that Blender knows this extension by; None in a script that uses a checkout."""
    parts = __package__.split(".")
    return ".".join(parts[:3]) if parts[0] == _EXTENSIONS else None  # bl_ext.REPOSITORY.EXTENSION. …


def preferences() -> bpy.types.AddonPreferences | None:
    """The user's choices, None where Blender keeps none: `log_level` and `write_log` are among them."""
    addon = bpy.context.preferences.addons.get(extension_name() or "")
    return addon.preferences if addon is not None else None


def user_folder(name: str) -> Path:
    """A folder for the user's files, made where it is missing; it outlives updates of the extension.

    name : `presets`, `assets`, …

    Raises OSError where it cannot be made.
    """
    extension = extension_name()
    if extension is not None:
        folder = bpy.utils.extension_path_user(extension, path=name, create=True)
    else:
        folder = bpy.utils.user_resource("SCRIPTS", path=f"ocean_tweak/{name}", create=True)
    return Path(folder)
