# SPDX-License-Identifier: GPL-3.0-or-later
"""Files written so that nobody ever sees half of one, also from several machines at once, and read with care:
what somebody sent may be a link, a pipe or without end.
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

#: ending of what is not whole yet
PART = ".part"

#: bytes of a JSON file: far more than any sea has with its images
LARGEST_JSON = 64_000_000

#: s for which a file is replaced again and again: on Windows that fails while somebody reads the old one
_REPLACE_PATIENCE = 5.0 if os.name == "nt" else 0.0
#: s to wait for a file lock, which nobody alive holds as long
_LOCK_PATIENCE = 10.0

#: what file systems without synced folders answer
_NO_FOLDER_SYNC = {errno.EINVAL, errno.ENOTSUP, errno.EBADF, errno.EACCES, errno.EISDIR}


#: of the names of what this process writes: no other has it, on this machine or another
_OWN = uuid.uuid4().hex


def _beside(path: Path) -> Path:
    """A name that nobody else has, even where process numbers agree."""
    return path.with_name(f".{path.name}.{_OWN[:16]}{uuid.uuid4().hex[:16]}{PART}")


def remove_begun(folder: Path) -> None:
    """Remove what this process has begun to write in a folder; it is about to end."""
    for part in folder.glob(f".*.{_OWN[:16]}*{PART}"):
        with contextlib.suppress(OSError):
            part.unlink()


def is_link(path: Path) -> bool:
    """Whether a name leads elsewhere: a symbolic link, or a junction of Windows."""
    try:
        status = path.lstat()
    except OSError:
        return False
    junction = getattr(stat, "IO_REPARSE_TAG_MOUNT_POINT", None)
    return stat.S_ISLNK(status.st_mode) or (
        junction is not None and getattr(status, "st_reparse_tag", None) == junction
    )


def open_file(path: Path) -> BinaryIO:
    """A file's bytes, to be read. Raises OSError for what is no plain file."""
    # a pipe would keep whoever opens it waiting for ever
    descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise OSError(None, "is no file", str(path))
    return open(descriptor, "rb")  # noqa: PTH123


def read_bytes(path: Path, most: int) -> bytes:
    """A file's bytes. Raises OSError for what is no plain file, or has more of them than `most`."""
    with open_file(path) as file:
        content = file.read(most + 1)
    if len(content) > most:
        raise OSError(None, f"is larger than {most / 1e6:g} MB", str(path))
    return content


def begun_file(part: Path) -> str:
    """The name that an unfinished file was to get."""
    return part.name[1:].rsplit(".", 2)[0]


@contextlib.contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """A path beside `path` to write to; on success it is synced and takes the place of `path`.

    On any error the old file stays as it was and what was written is removed; an OSError names `path`.
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
    """Write a file that appears whole; on any error the old one stays as it was."""
    write_texts({path: text})


def write_texts(texts: Mapping[Path, str]) -> list[Path]:
    """Write files that belong together: none of them is replaced before the disk has taken all.

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
    """Write a file that appears whole, unless there is one. Returns whether this one is there now.

    Of several that try at the same time, one succeeds.
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
    """Nobody else in here who asks for the same file; for a moment only.

    The system lets go of the lock of a process that dies. On a disk without file locks, or when one is held
    for much too long, everybody gets in: what is done in here must not rely on it alone.
    """
    # no link is followed to whatever it leads to
    flags = os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0)
    with open(os.open(path, flags, 0o666), "r+b") as file:  # noqa: PTH123
        until = time.monotonic() + _LOCK_PATIENCE
        while not _locked(file) and time.monotonic() < until:
            time.sleep(0.01)
        yield  # closing the file lets go


def _locked(file: BinaryIO) -> bool:
    """Whether the file's lock is held now, or there are none on this disk."""
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
    """Make the names in a folder last, where the system can."""
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
    """The folder, made if it is missing. Raises OSError naming it when files cannot be written there."""
    path.mkdir(parents=True, exist_ok=True)
    probe = _beside(path / "ocean_tweak")
    try:
        probe.touch()
    finally:
        with contextlib.suppress(OSError):
            probe.unlink()
    return path
