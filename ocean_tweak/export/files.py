# SPDX-License-Identifier: GPL-3.0-or-later
"""Writing files so that nobody ever sees half of one."""

from __future__ import annotations

import contextlib
import os
import threading
from collections.abc import Iterator
from pathlib import Path


@contextlib.contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """A path beside `path` to write to; on success it is synced and takes the place of `path`.

    On any error the old file stays as it was and what was written is removed.
    """
    beside = path.with_name(f".{path.name}.{os.getpid()}.{threading.get_ident()}.part")
    try:
        yield beside
        with beside.open("rb+") as file:
            os.fsync(file.fileno())
        beside.replace(path)
    except BaseException:
        with contextlib.suppress(OSError):
            beside.unlink(missing_ok=True)
        raise


def new_file(path: Path, text: str) -> bool:
    """Write a file that appears whole, unless there is one. Returns whether this one is there now.

    Of several that try at the same time, one succeeds.
    """
    beside = path.with_name(f".{path.name}.{os.getpid()}.{threading.get_ident()}.part")
    try:
        with beside.open("w", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        return _claim(beside, path)
    finally:
        with contextlib.suppress(OSError):
            beside.unlink(missing_ok=True)


def _claim(beside: Path, path: Path) -> bool:
    try:
        path.hardlink_to(beside)
    except FileExistsError:
        return False
    except OSError:  # a file system without links
        if path.exists():
            return False
        beside.replace(path)
    return True


def sync_folder(path: Path) -> None:
    """Make the names in a folder last, where the system can."""
    if os.name == "nt":
        return
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def writable_folder(path: Path) -> Path:
    """The folder, made if it is missing. Raises OSError naming it when files cannot be written there."""
    path.mkdir(parents=True, exist_ok=True)
    probe = path / f".ocean_tweak.{os.getpid()}.part"
    try:
        probe.touch()
    finally:
        with contextlib.suppress(OSError):
            probe.unlink()
    return path
