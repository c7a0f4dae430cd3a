# SPDX-License-Identifier: GPL-3.0-or-later
"""Deletes baked frames: files inside the folder that their records list, and their spray; nothing else."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from ...core.data.frames import Frame
from ..files import PART, is_link
from ..frame_files import BAKED, POINTS, SPRAY, frame_file
from ..spray import ASKED, remove_empty, spray_files
from .folders import ENTRY, JOB_FILE, LOCKS, RECORDS, is_bake, log_file, read_job, record_path, refuse_links
from .job import CacheError
from .locks import claims
from .records import FileEntry, read_record, recorded_frames


class Cleaned(NamedTuple):
    """The result of `clean`.

    left : files that records list but that were kept, and why
    """

    files: int
    bytes: int
    left: tuple[str, ...]


def clean(folder: Path, frames: Iterable[Frame]) -> Cleaned:
    """Delete frames of a bake's folder; the caller must hold their locks.

    Raises CacheError if the folder is not a bake, OSError if something cannot be deleted.
    """
    home = folder.resolve()
    if not is_bake(home):
        raise CacheError(f"{folder}: is not a bake's folder, so nothing in it is deleted")
    refuse_links(home)
    count, size, left, spray = 0, 0, [], _spray(home)
    for frame in frames:
        try:
            record = read_record(home, frame)
        except ValueError as error:
            left.append(f"{record_path(folder, frame)}: {error}, so its files are not known")
            continue
        problems, going = [], [spray[frame]] if frame in spray else []
        for entry in () if record is None else record.files:
            problem = _why_not(home, frame, entry)
            if problem:
                problems.append(f"{folder / entry.name}: {problem}")
            else:
                going.append(home / entry.name)
        for path in going:
            with contextlib.suppress(FileNotFoundError):
                length = path.lstat().st_size
                path.unlink()
                count, size = count + 1, size + length
        left += problems
        if record is not None and not problems:
            record_path(home, frame).unlink()
    remove_empty(home)
    return Cleaned(count, size, tuple(left))


def cleanable_frames(folder: Path) -> tuple[Frame, ...]:
    """All frames of which a bake's folder contains anything."""
    return tuple(sorted({*recorded_frames(folder), *_spray(folder.resolve())}))


def remove_rest(folder: Path) -> tuple[str, ...]:
    """Delete the job, the lock files and the folders of a bake without frames, unless they are in use.

    Returns what else is in the folder, which is kept.
    """
    home = folder.resolve()
    if not claims(home / LOCKS):
        _remove_rest(home)
    return tuple(_foreign(home))


def _spray(home: Path) -> dict[Frame, Path]:
    """The files of a bake's spray by frame."""
    try:
        name = read_job(home).name
    except CacheError:  # from its folder
        name = home.parent.name.rpartition("-")[0]
    return {frame: path for frame, path in spray_files(home, name).items() if not path.is_dir()}


def _why_not(home: Path, frame: Frame, entry: FileEntry) -> str:
    """Why a file listed by a record is not deleted; "" if it is."""
    what = "points are" if entry.map == POINTS else "image is"
    if entry.map not in BAKED or not entry.name.endswith(frame_file("", entry.map, frame)):
        return f"is not named like a frame's {what}"
    path = home / entry.name
    if is_link(path) or path.resolve().parent != home:
        return "is a link, or lies outside the folder"
    return "is a folder" if path.is_dir() else ""


def _remove_rest(home: Path) -> None:
    """Delete the job, the lock files and the folders, unless they contain something else."""
    for part in (home / LOCKS, home / RECORDS):
        if not is_link(part):
            for begun in part.glob(f".*{PART}"):  # left by killed processes
                begun.unlink(missing_ok=True)
    (home / LOCKS / ENTRY).unlink(missing_ok=True)
    for part in (home / LOCKS, home / RECORDS):
        with contextlib.suppress(OSError):
            part.rmdir()
    if any(path.name != JOB_FILE for path in home.iterdir()):
        return
    (home / JOB_FILE).unlink(missing_ok=True)
    home.rmdir()
    with contextlib.suppress(OSError):
        log_file(home).unlink()
    if [path.name for path in home.parent.iterdir()] == [ENTRY]:
        (home.parent / ENTRY).unlink(missing_ok=True)
        with contextlib.suppress(OSError):  # another version has just been started
            home.parent.rmdir()


def foreign_images(folder: Path) -> list[str]:
    """Images and points in a bake's folder that are in no record."""
    return [name for name in _foreign(folder) if name.endswith((".exr", ".ply"))]


def _foreign(home: Path) -> Iterator[str]:
    """Files in the folder that are in no record."""
    if not home.is_dir():
        return
    own = {JOB_FILE, LOCKS, RECORDS}
    listed: set[str] = set()
    for frame in recorded_frames(home):
        with contextlib.suppress(ValueError):
            record = read_record(home, frame)
            listed.update(entry.name for entry in (record.files if record is not None else ()))
    for path in sorted(home.iterdir()):
        if path.name == SPRAY and path.is_dir():
            spray = {file.name for file in _spray(home).values()}
            yield from (
                f"{SPRAY}/{each.name}" for each in sorted(path.iterdir()) if each.name not in spray | {ASKED}
            )
        elif path.name not in own | listed:
            yield path.name
