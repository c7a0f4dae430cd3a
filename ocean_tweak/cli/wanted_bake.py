# SPDX-License-Identifier: GPL-3.0-or-later
"""The bake described by a command's arguments, and its folder."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path

from ..core.data.frames import Frame, format_frames
from ..export.cache.folders import bakes_in, find_folder
from ..export.cache.job import CacheError, Job, maps_for, safe_name, uid_of
from ..export.cache.records import recorded_frames
from ..export.places import CACHE_VARIABLE, environment_cache
from .outcome import UsageError
from .progress import Progress
from .seas import FileSea


def jobs_of(arguments: argparse.Namespace, seas: Mapping[str, FileSea]) -> dict[str, Job]:
    """The bake job of each sea, by its name in the file. Raises UsageError or ParameterError."""
    if arguments.name and len(seas) > 1:
        raise UsageError("--name: the file has several oceans; choose one with --object")
    if arguments.uid and len(seas) > 1:
        raise UsageError("--uid: the file has several oceans; choose one with --object")
    return {name: _job(arguments, name, sea) for name, sea in seas.items()}


def _job(arguments: argparse.Namespace, name: str, sea: FileSea) -> Job:
    frames: tuple[Frame, ...] = arguments.frames or sea.frames
    if frames:
        sea.shot.check(frames)
    name = safe_name(arguments.name or name)
    uid = arguments.uid or sea.uid or uid_of(name)
    # not needed if --set reduced it to one patch, or took its coast away
    needed = () if arguments.area is not None else set(sea.maps).intersection(maps_for(sea.shot.parameters))
    maps = (*arguments.maps, *needed)
    return Job(name, uid, sea.shot, maps, arguments.compression, frames, arguments.area)


def cache_of(arguments: argparse.Namespace, sea: FileSea) -> Path:
    """The cache folder. Raises UsageError if none was given."""
    cache = known_cache(arguments.out, sea)
    if cache is None:
        raise UsageError(f"--out: say where the frames go, or set the environment variable {CACHE_VARIABLE}")
    return cache


def known_cache(chosen: Path | None, sea: FileSea) -> Path | None:
    """The cache folder: the chosen one, or the .blend file's, or the environment's.

    Raises UsageError if that of the environment is a path of another system.
    """
    if chosen or sea.cache:
        return chosen or sea.cache
    try:
        return environment_cache()
    except ValueError as error:
        raise UsageError(str(error)) from None


def existing_folder(cache: Path, job: Job) -> Path:
    """The folder of a bake. Raises CacheError if it does not exist."""
    folder = find_folder(cache, job)
    if folder is None:
        raise CacheError(
            f"{cache / job.home} holds no bake of this sea (v…-{job.hash8}): "
            "bake it with the same parameters, maps and compression"
        )
    return folder


def only_bake(place: Path, machine: bool) -> Path:
    """The only bake in a folder, which may be the bake itself or the folder given to `--out`.

    machine : list several as JSON

    If there are several, lists them and raises UsageError. If there is none, returns the folder itself.
    """
    found = bakes_in(place)
    if len(found) < 2:
        return found[0] if found else place
    for folder in found:
        home, version, frames = folder.parent.name, folder.name, format_frames(recorded_frames(folder))
        text = f"{folder}, frames {frames}" if frames else f"{folder}, no frames yet"
        Progress(home.rpartition("-")[0], machine).say(
            text, folder=str(folder), version=int(version[1:].partition("-")[0]), frames=frames
        )
    raise UsageError(f"{place}: holds {len(found)} bakes: give the folder of one of them")
