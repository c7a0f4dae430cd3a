# SPDX-License-Identifier: GPL-3.0-or-later
"""The versions of an ocean's bake on disk, and an estimate of the next one, updated on events and cached for
the panel."""

from __future__ import annotations

import stat
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

import bpy

from ..core.sea.placed_waves import has_tile
from ..export.cache import clean
from ..export.cache.estimate import Estimate, estimate, fitting_workers, with_spray
from ..export.cache.folders import bakes_in
from ..export.cache.job import Job
from ..export.cache.locks import claimed
from ..export.cache.records import recorded_frames
from ..export.files import is_link
from ..export.spray import SpraySequence
from .baked_spray import spray_to_bake
from .cache_place import bake_name, cache_folder, own_uid
from .image_sequence import folder_of
from .settings import OceanObjectError, all_oceans, maps_of, settings_of, wanted_channels
from .shots import bake_shot_of, needed_maps, scene_frames


class Version(NamedTuple):
    """A bake on disk.

    frames, bytes : that it has, and takes
    time : of its last change, s since 1970
    """

    folder: Path
    frames: int
    bytes: int
    time: float


class Listing(NamedTuple):
    """What was found of an ocean's bakes.

    versions : from the oldest number to the newest
    to_come : estimate of its next bake; None if the settings have changed since
    """

    versions: tuple[Version, ...]
    to_come: Estimate | None


# by session uid, as the state of the disk and the time per frame are not data of the file
_listings: dict[int, Listing] = {}


def known(item: bpy.types.Object) -> Listing | None:
    """The listing of the last look at the disk."""
    return _listings.get(item.session_uid)


def look(item: bpy.types.Object) -> None:
    """List an ocean's bakes on disk. Raises OSError."""
    before = known(item)
    versions = tuple(map(_version, _own(item)))
    _listings[item.session_uid] = Listing(versions, None if before is None else before.to_come)


def foresee(item: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Estimate the next bake by computing a frame, and list the bakes on disk.

    Raises ParameterError for settings that are no sea, OSError.
    """
    frames = scene_frames(scene)
    shot = bake_shot_of(item, scene, frames)
    maps = (*maps_of(wanted_channels(settings_of(item))), *needed_maps(item))
    job = Job(bake_name(item), own_uid(item), shot, maps, frames=frames)
    place = cache_folder(item)
    while not place.is_dir() and place != place.parent:
        place = place.parent
    to_come = estimate(place, job, frames, fitting_workers(job, len(frames)))
    spray = spray_to_bake(item, scene)
    if spray is not None and (spray.place is not None or has_tile(shot.parameters)):
        to_come = with_spray(to_come, SpraySequence(place, job.name, shot, spray.spray, spray.place), frames)
    look(item)
    _listings[item.session_uid] = _listings[item.session_uid]._replace(to_come=to_come)


def settings_changed(item: bpy.types.Object) -> None:
    """Discard the estimate, as the settings have changed."""
    listing = known(item)
    if listing is not None and listing.to_come is not None:
        _listings[item.session_uid] = listing._replace(to_come=None)


def shown_folders() -> dict[Path, str]:
    """The folders that oceans of the file read, each with the name of one that does."""
    found = {folder_of(settings_of(item)): item.name for item in all_oceans()}
    return {folder.resolve(): name for folder, name in found.items() if folder is not None}


def delete(item: bpy.types.Object, names: Iterable[str] = ()) -> clean.Cleaned:
    """Delete versions of an ocean's bakes by the names of their folders; without names, all that no ocean
    shows.

    Only files listed in records are deleted, as by the command `clean`. Raises OceanObjectError for a version
    that is missing or shown, CacheError, Held if it is being baked, OSError.
    """
    shown = shown_folders()
    versions = {folder.name: folder for folder in _own(item)}
    wanted = list(names) or [name for name, folder in versions.items() if folder.resolve() not in shown]
    for name in wanted:
        if name not in versions:
            raise OceanObjectError(f"{_home(item)} has no bake {name}: refresh the list")
        reader = shown.get(versions[name].resolve())
        if reader is not None:
            raise OceanObjectError(f"{reader} shows {name}: choose another bake there, or go back to live")
    files, size, left = 0, 0, []
    try:
        for folder in map(versions.__getitem__, wanted):
            frames = clean.cleanable_frames(folder)
            with claimed(folder, frames):
                cleaned = clean.clean(folder, frames)
            files, size = files + cleaned.files, size + cleaned.bytes
            left += [*cleaned.left, *(() if cleaned.left else clean.remove_rest(folder))]
    finally:
        look(item)
    return clean.Cleaned(files, size, tuple(left))


def _home(item: bpy.types.Object) -> Path:
    """The folder of all bakes of an ocean."""
    return cache_folder(item) / f"{bake_name(item)}-{own_uid(item)}"


def _own(item: bpy.types.Object) -> list[Path]:
    """The folders of an ocean's bakes, without links, which lead to bakes of others."""
    return [folder for folder in bakes_in(_home(item)) if not is_link(folder)]


def _version(folder: Path) -> Version:
    size, time = 0, 0.0
    for path in folder.rglob("*"):
        with suppress(OSError):  # files deleted meanwhile count as 0
            found = path.lstat()
            size += found.st_size if stat.S_ISREG(found.st_mode) else 0
            time = max(time, found.st_mtime)
    return Version(folder, len(recorded_frames(folder)), size, time)
