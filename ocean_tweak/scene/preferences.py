# SPDX-License-Identifier: GPL-3.0-or-later
"""The user's preferences, and the folder for the extension's own files."""

from __future__ import annotations

from pathlib import Path

import bpy

_EXTENSIONS = "bl_ext"


def extension_name() -> str | None:
    """Blender's name for this extension; None in a script that uses a checkout."""
    parts = __package__.split(".")
    return ".".join(parts[:3]) if parts[0] == _EXTENSIONS else None  # bl_ext.REPOSITORY.EXTENSION. …


def preferences() -> bpy.types.AddonPreferences | None:
    """The user's preferences, such as `log_level` and `write_log`; None if Blender has none."""
    addon = bpy.context.preferences.addons.get(extension_name() or "")
    return addon.preferences if addon is not None else None


def user_folder(name: str) -> Path:
    """A folder for the user's files, created if missing; it survives updates of the extension.

    name : `presets`, `assets`, …

    Raises OSError if it cannot be created.
    """
    extension = extension_name()
    if extension is not None:
        folder = bpy.utils.extension_path_user(extension, path=name, create=True)
    else:
        folder = bpy.utils.user_resource("SCRIPTS", path=f"ocean_tweak/{name}", create=True)
    return Path(folder)
