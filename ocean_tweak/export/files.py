# SPDX-License-Identifier: GPL-3.0-or-later
"""Atomic writing of files, also by several machines at once, and safe reading: a file from elsewhere may be a
link, a pipe or endless.
"""

from __future__ import annotations

import contextlib
import errno
import os
import stat
import time
import uuid
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import BinaryIO

#: suffix of unfinished files
PART = ".part"

#: largest size of a JSON file in bytes: far more than any sea with its images
LARGEST_JSON = 64_000_000

#: time in s for which replacing a file is retried: on Windows it fails while another process reads the old
# one
_REPLACE_PATIENCE = 5.0 if os.name == "nt" else 0.0
#: time in s to wait for a file lock, longer than any process holds one
_LOCK_PATIENCE = 10.0

#: errors of file systems that cannot sync folders
_NO_FOLDER_SYNC = {errno.EINVAL, errno.ENOTSUP, errno.EBADF, errno.EACCES, errno.EISDIR}


#: unique part of the names that this process writes, different on every machine and in every process
_OWN = uuid.uuid4().hex


def _beside(path: Path) -> Path:
    """A unique name beside a path, even if process ids are equal."""
    return path.with_name(f".{path.name}.{_OWN[:16]}{uuid.uuid4().hex[:16]}{PART}")


def remove_begun(folder: Path) -> None:
    """Remove unfinished files of this process in a folder, before it ends."""
    for part in folder.glob(f".*.{_OWN[:16]}*{PART}"):
        with contextlib.suppress(OSError):
            part.unlink()


def is_link(path: Path) -> bool:
    """Whether a path is a symbolic link or a Windows junction."""
    try:
        status = path.lstat()
    except OSError:
        return False
    junction = getattr(stat, "IO_REPARSE_TAG_MOUNT_POINT", None)
    return stat.S_ISLNK(status.st_mode) or (
        junction is not None and getattr(status, "st_reparse_tag", None) == junction
    )


def open_file(path: Path) -> BinaryIO:
    """Open a file for reading. Raises OSError if it is not a regular file."""
    # opening a pipe could block for ever
    descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise OSError(None, "is no file", str(path))
    return open(descriptor, "rb")  # noqa: PTH123


def read_bytes(path: Path, most: int) -> bytes:
    """A file's bytes. Raises OSError if it is not a regular file, or larger than `most`."""
    with open_file(path) as file:
        content = file.read(most + 1)
    if len(content) > most:
        raise OSError(None, f"is larger than {most / 1e6:g} MB", str(path))
    return content


def begun_file(part: Path) -> str:
    """The final name of an unfinished file."""
    return part.name[1:].rsplit(".", 2)[0]


@contextlib.contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Context manager for a temporary path beside `path`; on success it is synced and replaces `path`.

    On any error the old file is kept and the new one removed; an OSError names `path`.
    """
    beside = _beside(path)
    try:
        yield beside
        with beside.open("rb+") as file:
            os.fsync(file.fileno())
        _replace(beside, path)
    except BaseException as error:
        with contextlib.suppress(OSError):
            beside.unlink(missing_ok=True)
        if isinstance(error, OSError):
            error.filename = str(path)
        raise


def write_text(path: Path, text: str) -> None:
    """Write a file atomically; on any error the old one is kept."""
    write_texts({path: text})


def write_texts(texts: Mapping[Path, str]) -> list[Path]:
    """Write files that belong together: none is replaced before all have been written.

    Returns their paths.
    """
    with contextlib.ExitStack() as stack:
        for path, text in texts.items():
            with stack.enter_context(whole_file(path)).open("wb") as file:
                file.write(text.encode())
                file.flush()
                os.fsync(file.fileno())
    return list(texts)


def _replace(source: Path, target: Path) -> None:
    until = time.monotonic() + _REPLACE_PATIENCE
    while True:
        try:
            source.replace(target)
        except PermissionError:
            if time.monotonic() >= until:
                raise
            time.sleep(0.05)
        else:
            return


def new_file(path: Path, text: str) -> bool:
    """Create a file atomically unless it exists. Returns whether this call created it.

    If several processes try at the same time, one succeeds.
    """
    beside = _beside(path)
    try:
        with beside.open("w", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        return _claim(beside, path)
    except OSError as error:
        error.filename = str(path)
        raise
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
        _replace(beside, path)
    return True


@contextlib.contextmanager
def alone(path: Path) -> Iterator[None]:
    """Context manager for exclusive access by a short file lock.

    The system releases the lock of a process that dies. On a disk without file locks, or if one is held for
    much too long, access is granted anyway: callers must not rely on it alone.
    """
    # links are not followed
    flags = os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0)
    with open(os.open(path, flags, 0o666), "r+b") as file:  # noqa: PTH123
        until = time.monotonic() + _LOCK_PATIENCE
        while not _locked(file) and time.monotonic() < until:
            time.sleep(0.01)
        yield  # closing the file releases the lock


def _locked(file: BinaryIO) -> bool:
    """Try to lock a file; also True if this disk has no file locks."""
    try:
        if os.name == "nt":
            import msvcrt

            file.seek(0)
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined]
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (BlockingIOError, PermissionError):
        return False
    except OSError:
        return True
    return True


def sync_folder(path: Path) -> None:
    """Sync a folder's entries to disk, if the system can."""
    if os.name == "nt":
        return
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in _NO_FOLDER_SYNC:
            raise
    finally:
        os.close(descriptor)


def writable_folder(path: Path) -> Path:
    """The folder, created if missing. Raises OSError, with its name, if files cannot be written there."""
    path.mkdir(parents=True, exist_ok=True)
    probe = _beside(path / "ocean_tweak")
    try:
        probe.touch()
    finally:
        with contextlib.suppress(OSError):
            probe.unlink()
    return path
