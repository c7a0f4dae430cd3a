# SPDX-License-Identifier: GPL-3.0-or-later
r"""The paths that a .blend file keeps for its oceans and skies: relative to it wherever there is a way, so
that a project may be moved, copied, reached through a link and opened on another system.

Links and mapped drives are never replaced by what they lead to. `//` is the folder of the file, as in
Blender, and a backslash separates as `/` does, on every system: a file may come from Windows.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import bpy

from ..export.places import is_foreign, path_of
from ..nodes.coast import COAST
from ..nodes.coast import FILES as COAST_FILES
from ..nodes.modifier_inputs import get_input, set_input
from ..nodes.names import MAP_INPUTS
from ..nodes.patch_points import FILES, PATCH_POINTS
from ..nodes.spray import FILES as SPRAY_FILES
from ..nodes.spray import SPRAY
from ..nodes.versioned import is_of_kind
from ..nodes.wake_points import FILES as WAKE_FILES
from ..nodes.wake_points import WAKE_POINTS
from ..nodes.wet_bed import FILES as BED_FILES
from ..nodes.wet_bed import WET_BED
from .settings import OceanObjectError, all_oceans, settings_of

_BESIDE = "//"

#: groups whose input has a path where they read files
_MAYBE_FILES = ((SPRAY, SPRAY_FILES), (COAST, COAST_FILES), (WET_BED, BED_FILES), (WAKE_POINTS, WAKE_FILES))


class Kept(NamedTuple):
    """A path that the file keeps, as a property.

    follows : whether Blender itself makes it relative to the new place when the file is saved elsewhere, or
        what has it is appended to another file
    """

    owner: Any
    name: str
    follows: bool


def _of_settings() -> Iterator[Kept]:
    for item in all_oceans():
        settings = settings_of(item)
        # what was never chosen is beside the file, wherever that is
        for group, name in ((settings, "cache_folder"), (settings.usd, "file")):
            if item.library is None and getattr(group, name) != group.bl_rna.properties[name].default:
                yield Kept(group, name, follows=False)


def _of_images() -> Iterator[Kept]:
    images = {image for item in all_oceans() for image in images_of(item)}
    panoramas = {scene.ocean_tweak_sky.hdri for scene in bpy.data.scenes if scene.library is None}
    images |= {image for image in panoramas if image is not None and image.filepath}
    # raw: a file that is not there, while the .blend file is not where it will be, must not be looked for
    yield from (Kept(image, "filepath_raw", follows=True) for image in images if image.library is None)


class _Input:
    """An input of a modifier, as a property."""

    def __init__(self, modifier: bpy.types.NodesModifier, name: str) -> None:
        self._modifier, self._name = modifier, name
        self.id_data = modifier.id_data

    @property
    def value(self) -> str:
        return str(get_input(self._modifier, self._name))

    @value.setter
    def value(self, value: str) -> None:
        set_input(self._modifier, self._name, value)
        self.id_data.update_tag()


def _of_points() -> Iterator[Kept]:
    for item in (item for item in bpy.data.objects if item.library is None):
        for modifier in item.modifiers:
            group = modifier.node_group if modifier.type == "NODES" else None
            names = FILES if is_of_kind(group, PATCH_POINTS) else ()
            for kind, name in _MAYBE_FILES:
                if is_of_kind(group, kind) and get_input(modifier, name):
                    names = (name,)
            yield from (Kept(_Input(modifier, name), "value", follows=False) for name in names)


#: all that keeps paths
_KEEPERS: tuple[Callable[[], Iterator[Kept]], ...] = (_of_settings, _of_images, _of_points)


def images_of(item: bpy.types.Object) -> set[bpy.types.Image]:
    """The images of files that an ocean reads: those of its bake, of its layers and of its masks."""
    settings = settings_of(item)
    images = {
        getattr(maps, name) for maps in (settings.sequence_maps, settings.early_maps) for name in MAP_INPUTS
    }
    images |= {source.image for source in settings.source_images()}
    return {image for image in images if image is not None and image.filepath}


def absolute(path: str | Path, library: bpy.types.Library | None = None) -> Path:
    """Where a path leads. Raises OceanObjectError for one of another system.

    library : the file that keeps the path, where it is not the open one
    """
    try:
        return Path(os.path.abspath(path_of(_led(str(path), library))))  # noqa: PTH100  # takes `..` away
    except ValueError as error:
        raise OceanObjectError(str(error)) from None


def image_file(image: bpy.types.Image) -> Path:
    """Where an image looks for its file, or for the first of them; on another system that may be nowhere."""
    return Path(os.path.normpath(_led(image.filepath, image.library).replace("\\", "/")))


def relative(path: str | Path, folder: str | None = None) -> str:
    """A path as the file keeps it: relative to the file's folder, where it has one and there is a way.

    A path that says no place, such as cache, is beside the file; one that begins with ~ stays.

    folder : by default that of the open file; "" while there is none
    """
    text = _tidy(str(path))
    folder = _folder() if folder is None else folder
    if not text or text.startswith("~") or is_foreign(text):
        return text
    if not os.path.isabs(text) and not text.startswith(_BESIDE):  # noqa: PTH117
        text = _BESIDE + text
    if not folder:
        return text
    way = _way(folder, _join(folder, text) if text.startswith(_BESIDE) else text)
    return text if way is None else _BESIDE + way


def make_relative(path: str) -> list[tuple[Kept, str]]:
    """Make all paths of the open file relative to it, just before it is saved at `path`.

    Returns those that were changed and what they were.
    """
    here, there = _folder(), str(absolute(path).parent)
    changed = []
    for kept in [kept for keeper in _KEEPERS for kept in keeper()]:
        before = wanted = getattr(kept.owner, kept.name)
        if here and not kept.follows and before.startswith(_BESIDE):
            wanted = _join(here, _tidy(before))
        wanted = relative(wanted, (here or there) if kept.follows else there)
        if wanted != before:
            setattr(kept.owner, kept.name, wanted)
            changed.append((kept, before))
    return changed


def follow_import(imported: bpy.types.BlendImportContext) -> None:
    """Let the paths of what was appended lead where they led in the file that it is from."""
    folders = {
        item.id: _folder(item.source_library)
        for item in imported.import_items
        if item.id is not None and item.id.library is None and item.source_library is not None
    }
    for kept in [kept for keeper in _KEEPERS for kept in keeper()]:
        path = getattr(kept.owner, kept.name)
        if not kept.follows and path.startswith(_BESIDE) and kept.owner.id_data in folders:
            setattr(kept.owner, kept.name, relative(_join(folders[kept.owner.id_data], _tidy(path))))


def is_saved_beside(path: str) -> bool:
    """Whether the open file lies in the folder of this path: not after only a copy was saved there."""
    return _folder() == str(absolute(path).parent)


def _led(path: str, library: bpy.types.Library | None = None) -> str:
    text = _tidy(path)
    return _join(_folder(library), text) if text.startswith(_BESIDE) else text


def _tidy(path: str) -> str:
    r"""A path with the separators of this system; one of a drive or of \\\\server stays as it is."""
    is_other = is_foreign(path) or (os.name == "nt" and not path.startswith(_BESIDE))
    return path if is_other else path.replace("\\", "/")


def _folder(library: bpy.types.Library | None = None) -> str:
    """The folder of the open file or of a library; "" for a file that was never saved."""
    if library is not None:
        return str(Path(_led(library.filepath, library.parent)).parent)
    return str(Path(bpy.data.filepath).parent) if bpy.data.filepath else ""


def _join(folder: str, path: str) -> str:
    return os.path.normpath(f"{folder}/{path.removeprefix(_BESIDE)}")


def _way(folder: str, path: str) -> str | None:
    """The way from a folder to a path; None where there is none, from one drive to another."""
    straight = _relpath(folder, path)
    if straight is not None and not _climbs(straight):
        return straight
    # both may lie below one folder that has two names, by a link or a mapped drive
    real = os.path.realpath(path)
    inside = _relpath(os.path.realpath(folder), real)
    is_better = inside is not None and (straight is None or _climbs(inside) < _climbs(straight))
    # above a link is not above what it leads to
    return inside if is_better and os.path.realpath(_join(folder, inside)) == real else straight


def _relpath(folder: str, path: str) -> str | None:
    try:
        way = os.path.relpath(path, folder)
    except ValueError:
        return None
    return "" if way == os.curdir else way.replace(os.sep, "/")


def _climbs(way: str) -> int:
    """How often a way goes up."""
    return way.split("/").count(os.pardir)
