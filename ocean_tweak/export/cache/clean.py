# SPDX-License-Identifier: GPL-3.0-or-later
"""Deletes baked frames: what their records list and lies inside the folder, nothing else."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from ...core.frames import Frame
from .job import JOB_FILE, LOCKS, RECORDS, record_path
from .locks import claims
from .records import read_record, recorded_frames


class Cleaned(NamedTuple):
    """What was deleted, and what was left and why."""

    files: int
    bytes: int
    left: tuple[str, ...]


def clean(folder: Path, frames: Iterable[Frame] | None = None) -> Cleaned:
    """Delete frames of a bake's folder; all of them, with the job and the empty folders, by default.

    Raises OSError where something cannot be deleted.
    """
    home = folder.resolve()
    count, size, left = 0, 0, []
    for frame in recorded_frames(folder) if frames is None else frames:
        try:
            record = read_record(folder, frame)
        except ValueError as error:
            left.append(f"{record_path(folder, frame)}: {error}, so what it lists is not known")
            continue
        if record is None:
            continue
        for entry in record.files:
            path = folder / entry.name
            if path.is_symlink() or path.resolve().parent != home:
                left.append(f"{path}: lies outside the folder")
                continue
            with contextlib.suppress(FileNotFoundError):
                size += path.stat().st_size
                path.unlink()
                count += 1
        record_path(folder, frame).unlink()
    if frames is None and not left:
        _remove_rest(folder)
    return Cleaned(count, size, tuple(left))


def _remove_rest(folder: Path) -> None:
    """The job, the lock files and the folders, as far as nothing else is in them."""
    if claims(folder / LOCKS):
        return
    (folder / LOCKS / "entry").unlink(missing_ok=True)
    for part in (folder / LOCKS, folder / RECORDS):
        with contextlib.suppress(OSError):
            part.rmdir()
    if not any(path.name != JOB_FILE for path in folder.iterdir()):
        (folder / JOB_FILE).unlink(missing_ok=True)
        for empty in (folder, folder.parent):
            with contextlib.suppress(OSError):
                empty.rmdir()
