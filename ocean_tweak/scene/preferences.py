# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user has chosen for this extension, in Blender's preferences."""

from __future__ import annotations

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
