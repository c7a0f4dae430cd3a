# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder in which the user's own files of this extension lie."""

from __future__ import annotations

from pathlib import Path

import bpy

from .preferences import extension_name


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
