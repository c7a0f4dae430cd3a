# SPDX-License-Identifier: GPL-3.0-or-later
"""Node groups and material as assets, in a library in the user's folder."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.parameters.presets import built_in
from ..export.files import write_text
from ..nodes.contact import WET_BAND
from ..nodes.floating import FLOAT
from ..nodes.ocean import ocean_group
from ..nodes.sample import SAMPLE
from ..nodes.versioned import node_group
from ..nodes.water import WATER
from . import contact, hull_cut, water_material
from .preferences import user_folder
from .sea_picture import SIZE, SeaView, draw_ball

#: what Blender's asset browser calls it
LIBRARY = "Ocean Tweak"
_FILE = "ocean_tweak.blend"
#: catalogues: name and permanent UUID
_NODES = ("Nodes", "0e0a7c52-6f0b-4f0e-9d0a-5a2f1c6b7e01")
_WATERS = ("Water", "0e0a7c52-6f0b-4f0e-9d0a-5a2f1c6b7e02")
_CATALOGUES = "blender_assets.cats.txt"
_ABOUT = f"# Catalogues of {LIBRARY}. Written anew with its assets\n\nVERSION 1\n\n"
_GROUPS = {
    ocean_group(): "Moves a grid with displacement images, and writes foam, velocity and normals",
    SAMPLE: "Height, normal, foam and motion of an ocean above any position",
    FLOAT: "Lets instances, or a geometry as a whole, ride an ocean",
    WATER: "Shader of sea water with foam",
    WET_BAND: "Shader values for wet surfaces",
}
#: the ball in a group's picture: colour, and its wet fraction
_MARKS = {
    SAMPLE: ((0.85, 0.12, 0.08), 0.0), FLOAT: ((0.95, 0.45, 0.05), 0.35), WET_BAND: ((0.60, 0.58, 0.55), 0.6),
}  # fmt: skip


class _Asset(NamedTuple):
    """A datablock with its data for the asset browser."""

    description: str
    catalogue: str
    picture: NDArray[np.float64]


def is_installed() -> bool:
    """Whether the preferences list the library."""
    return _listed() is not None


def install() -> Path:
    """Write the library and add its folder to the preferences; the open file is not changed.

    Raises OSError for what the disk refuses.
    """
    path = user_folder("assets") / _FILE
    write_text(path.with_name(_CATALOGUES), _ABOUT + "".join(
        f"{uuid}:{LIBRARY}/{name}:{LIBRARY}-{name}\n" for name, uuid in (_NODES, _WATERS)
    ))  # fmt: skip
    kept = {*bpy.data.node_groups, *bpy.data.materials}
    assets = _assets()
    marked = [block for block in assets if block.asset_data is None]
    try:
        for block in marked:
            _mark(block, assets[block])
        with contact.set_aside(), hull_cut.set_aside():
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
    _refresh_browsers()
    return path


def _assets() -> dict[bpy.types.ID, _Asset]:
    """The contents of the library: node groups, and a material for each kind of water."""
    view = SeaView(built_in()["open_sea"].parameters)
    assets: dict[bpy.types.ID, _Asset] = {}
    for kind, description in _GROUPS.items():
        picture = view.picture()
        if kind in _MARKS:
            draw_ball(picture, *_MARKS[kind])
        assets[node_group(kind)] = _Asset(description, _NODES[1], picture)
    for water, (label, *_) in water_material.WATERS.items():
        material = water_material.water_material(water)
        picture = view.picture(water_material.colour_of(material))
        assets[material] = _Asset(f"Sea water: {label}", _WATERS[1], picture)
    return assets


def _mark(block: bpy.types.ID, asset: _Asset) -> None:
    block.asset_mark()
    data, preview = block.asset_data, block.preview_ensure()
    data.description, data.author, data.catalog_id = asset.description, LIBRARY, asset.catalogue
    preview.image_size = (SIZE, SIZE)
    preview.image_pixels_float.foreach_set(np.ascontiguousarray(asset.picture, np.float32).ravel())


def _refresh_browsers() -> None:
    """Refresh open asset browsers."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.ui_type == "ASSETS":
                with bpy.context.temp_override(window=window, area=area):
                    bpy.ops.asset.library_refresh()


def remove() -> None:
    """Remove the folder from the preferences; the files are kept, as scenes may link them."""
    libraries, listed = bpy.context.preferences.filepaths.asset_libraries, _listed()
    if listed is not None:
        libraries.remove(listed)


def _listed() -> bpy.types.UserAssetLibrary | None:
    libraries = bpy.context.preferences.filepaths.asset_libraries
    return next((library for library in libraries if library.name == LIBRARY), None)
