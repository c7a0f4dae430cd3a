# SPDX-License-Identifier: GPL-3.0-or-later
"""The bake that a command's arguments describe, and where it is."""

from __future__ import annotations

import argparse
import os
from collections.abc import Mapping
from pathlib import Path

from ..core.frames import Frame
from ..export.cache.job import CacheError, Job, find_folder, safe_name, uid_of
from .outcome import UsageError
from .seas import Sea

CACHE_VARIABLE = "OCEAN_TWEAK_CACHE"


def jobs_of(arguments: argparse.Namespace, seas: Mapping[str, Sea]) -> dict[str, Job]:
    """What would be baked of each sea, by its name in the file. Raises UsageError or ParameterError."""
    if arguments.name and len(seas) > 1:
        raise UsageError("--name: the file has several oceans; choose one with --object")
    if arguments.uid and len(seas) > 1:
        raise UsageError("--uid: the file has several oceans; choose one with --object")
    return {name: _job(arguments, name, sea) for name, sea in seas.items()}


def _job(arguments: argparse.Namespace, name: str, sea: Sea) -> Job:
    frames: tuple[Frame, ...] = arguments.frames or sea.frames
    if frames:
        sea.shot.check(frames)
    name = safe_name(arguments.name or name)
    uid = arguments.uid or sea.uid or uid_of(name)
    return Job(name, uid, sea.shot, arguments.maps, arguments.compression, frames)


def cache_of(arguments: argparse.Namespace, sea: Sea) -> Path:
    """The folder of all bakes. Raises UsageError where nobody said which."""
    cache = known_cache(arguments.out, sea)
    if cache is None:
        raise UsageError(f"--out: say where the frames go, or set the environment variable {CACHE_VARIABLE}")
    return cache


def known_cache(chosen: Path | None, sea: Sea) -> Path | None:
    """The folder of all bakes: the chosen one, else the .blend file's, else the environment's."""
    variable = os.environ.get(CACHE_VARIABLE)
    return chosen or sea.cache or (Path(variable) if variable else None)


def existing_folder(cache: Path, job: Job) -> Path:
    """The folder of a bake. Raises CacheError where there is none."""
    folder = find_folder(cache, job)
    if folder is None:
        raise CacheError(
            f"{cache / job.home} holds no bake of this sea (v…-{job.hash8}): "
            "bake it with the same parameters, maps and compression"
        )
    return folder
