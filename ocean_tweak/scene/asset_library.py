# SPDX-License-Identifier: GPL-3.0-or-later
"""Node groups and material as assets, in a library in the user's folder."""

from __future__ import annotations

from pathlib import Path

import bpy

from ..nodes.contact import WET_BAND
from ..nodes.floating import FLOAT
from ..nodes.ocean import ocean_group
from ..nodes.sample import SAMPLE
from ..nodes.versioned import node_group
from ..nodes.water import WATER
from . import contact, water_material
from .preferences import user_folder

#: what Blender's asset browser calls it
LIBRARY = "Ocean Tweak"
_FILE = "ocean_tweak.blend"
_GROUPS = {
    ocean_group(): "Moves a grid by displacement images, and writes foam, velocity and normals",
    SAMPLE: "Height, normal, foam and motion of an ocean above any position",
    FLOAT: "Lets instances, or a geometry as a whole, ride an ocean",
    WATER: "Shader of sea water with foam",
    WET_BAND: "Shader values of what the water has made wet",
}


def is_installed() -> bool:
    """Whether the preferences list the library."""
    return _listed() is not None


def install() -> Path:
    """Write the library and add its folder to the preferences; the open file stays as it is.

    Raises OSError for what the disk refuses.
    """
    path = user_folder("assets") / _FILE
    kept = {*bpy.data.node_groups, *bpy.data.materials}
    assets = {node_group(kind): description for kind, description in _GROUPS.items()}
    for water, (label, *_) in water_material.WATERS.items():
        assets[water_material.water_material(water)] = f"Sea water: {label}"
    marked = [block for block in assets if block.asset_data is None]
    try:
        for block in marked:
            block.asset_mark()
            block.asset_data.description, block.asset_data.author = assets[block], LIBRARY
        with contact.set_aside():
            bpy.data.libraries.write(str(path), set(assets), fake_user=True, compress=True)
    except RuntimeError as error:
        raise OSError(f"{path}: {error}") from error
    finally:
        for block in marked:
            block.asset_clear()
        for blocks in (bpy.data.materials, bpy.data.node_groups):
            for block in set(blocks) - kept:
                blocks.remove(block)
    if not is_installed():
        bpy.context.preferences.filepaths.asset_libraries.new(name=LIBRARY, directory=str(path.parent))
    return path


def remove() -> None:
    """Take the folder out of the preferences; the files stay, for scenes that link them."""
    libraries, listed = bpy.context.preferences.filepaths.asset_libraries, _listed()
    if listed is not None:
        libraries.remove(listed)


def _listed() -> bpy.types.UserAssetLibrary | None:
    libraries = bpy.context.preferences.filepaths.asset_libraries
    return next((library for library in libraries if library.name == LIBRARY), None)
