# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder in which the user's own files of this extension lie."""

from __future__ import annotations

from pathlib import Path

import bpy

_EXTENSIONS = "bl_ext"


def user_folder(name: str) -> Path:
    """A folder for the user's files, made where it is missing; it outlives updates of the extension.

    name : `presets`, `assets`, …

    Raises OSError where it cannot be made.
    """
    parts = __package__.split(".")
    if parts[0] == _EXTENSIONS:  # bl_ext.REPOSITORY.EXTENSION. …
        folder = bpy.utils.extension_path_user(".".join(parts[:3]), path=name, create=True)
    else:  # a script that uses a checkout
        folder = bpy.utils.user_resource("SCRIPTS", path=f"ocean_tweak/{name}", create=True)
    return Path(folder)
