# SPDX-License-Identifier: GPL-3.0-or-later
"""The cache folder of an ocean, and the uid that identifies its bakes."""

from __future__ import annotations

import logging
import shutil
import uuid
from pathlib import Path

import bpy

from ..export.cache.folders import JOB_FILE, is_bake
from ..export.cache.job import UID, safe_name, uid_of
from ..export.files import is_link
from ..export.places import environment_cache
from . import stored_paths
from .image_sequence import ImageSequence, find_sequence, folder_of
from .preferences import user_folder
from .settings import OceanObjectError, all_oceans, settings_of

_log = logging.getLogger(__name__)

#: beside the .blend file
DEFAULT_CACHE = "//cache"


def cache_folder(item: bpy.types.Object) -> Path:
    """The cache of an ocean: what its settings say, or the environment, or beside its .blend file.

    A path that begins with // is relative to the file in which the ocean is stored, which may be a library.
    If that file has never been saved, the user's folder is used instead. Raises OSError if that cannot be
    created, OceanObjectError for a path of another system.
    """
    path = settings_of(item).cache_folder or DEFAULT_CACHE
    if path == DEFAULT_CACHE:
        try:
            named = environment_cache()
        except ValueError as error:
            raise OceanObjectError(str(error)) from None
        if named is not None:
            return named
    if path.startswith("//") and item.library is None and not bpy.data.filepath:
        return user_folder("cache")
    return stored_paths.absolute(path, item.library)


def own_uid(item: bpy.types.Object) -> str:
    """The ocean's uid: a duplicate gets a different one from the original.

    It is derived from data stored in the file, so that every machine of a farm finds the same. One that could
    lead to another folder, as in a manipulated file, counts as taken.
    """
    settings = settings_of(item)
    taken = {
        settings_of(other).uid
        for other in all_oceans()
        if other != item and other.session_uid < item.session_uid
    }
    if UID.fullmatch(settings.uid) and settings.uid not in taken:
        return settings.uid
    uid = uid_of(f"{settings.uid} {item.name_full}")
    if item.library is None:
        settings.uid = uid
    return uid


def new_uid() -> str:
    """A new, globally unique uid."""
    return uuid.uuid4().hex[:8]


def bake_name(item: bpy.types.Object) -> str:
    """The name of the ocean's files."""
    return safe_name(item.name)


def shown_bake(item: bpy.types.Object) -> Path | None:
    """The folder of the bake that the ocean reads; None if it reads none of ours."""
    folder = folder_of(settings_of(item))
    return folder if folder is not None and (folder / JOB_FILE).is_file() else None


def is_left_behind(item: bpy.types.Object) -> bool:
    """Whether the ocean reads a bake that is not in its cache: its file was saved elsewhere."""
    folder = shown_bake(item)
    if folder is None or not bpy.data.filepath:
        return False
    try:
        return cache_folder(item) not in folder.parents
    except OceanObjectError:  # a bake will tell
        return False


def find_moved(item: bpy.types.Object) -> bool:
    """Let an ocean read its bake from its cache, where it is not where the file says: by an absolute path of
    an older file, or on another machine. Returns whether anything was found."""
    found = False
    for image in stored_paths.images_of(item):
        file = stored_paths.image_file(image)
        if image.source != "SEQUENCE" or file.parent.is_dir():
            continue
        try:
            there = cache_folder(item).joinpath(*file.parts[-3:])
        except (OceanObjectError, OSError):
            continue
        if is_bake(there.parent) and there.is_file():
            _log.warning(
                "%s: %s is not there; its frames are read from %s", item.name, file.parent, there.parent
            )
            image.filepath = stored_paths.relative(there)
            found = True
    return found


def take_along(item: bpy.types.Object) -> ImageSequence:
    """Copy the bake that the ocean reads into its cache. Returns the copy's folder.

    Raises OceanObjectError if there is nothing to copy or the bake contains links, OSError if it cannot be
    copied.
    """
    folder = shown_bake(item)
    if folder is None:
        raise OceanObjectError("The ocean reads no bake that can be copied")
    goal = cache_folder(item) / folder.parent.name / folder.name
    if not goal.exists():
        _refuse_foreign(folder)
        beside = goal.with_name(f".{goal.name}.part")
        shutil.rmtree(beside, ignore_errors=True)
        beside.parent.mkdir(parents=True, exist_ok=True)
        try:
            # a link created meanwhile is copied as a link
            shutil.copytree(folder, beside, symlinks=True, ignore=shutil.ignore_patterns("*.lock", ".*"))
            beside.rename(goal)
        except BaseException:
            shutil.rmtree(beside, ignore_errors=True)
            raise
    return find_sequence(goal)


def _refuse_foreign(folder: Path) -> None:
    """Raise OceanObjectError for a link or a pipe in a bake: what a link leads to may be private."""
    for path in folder.rglob("*"):
        if is_link(path) or not (path.is_file() or path.is_dir()):
            raise OceanObjectError(f"{path} is a link or not a file, and is not copied: remove it")
