# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays that took long to compute, kept in files: the waves over a coast's bed.

A file is named after all that its arrays follow from. It begins with a line that says what it is, and one of
JSON with the arrays' shapes, kinds of numbers and check sums; then come their numbers. It is measured before
any is read, and nothing in it is executed. One that is not whole, or not ours, is reported and made again.
"""

from __future__ import annotations

import contextlib
import json
import logging
import math
import os
import time
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from ..core.data.errors import ParameterError
from ..core.data.printable import printable, readable_bytes
from ..core.numerics.memo import MEMO
from .files import PART, open_file, whole_file, writable_folder
from .places import SHELF_VARIABLE, environment_cache, path_of

_LOG = logging.getLogger(__name__)

_SUFFIX = ".arrays"
_BEGINNING = b"Ocean Tweak arrays 1\n"
_LONGEST_LINE, _MOST_ARRAYS = 10_000, 16
#: kinds of numbers that may be in a file, little-endian
_KINDS = ("<c8", "<i8")
#: of the folder in a cache of baked frames
_IN_CACHE = "coasts"
#: s after which nobody writes a file that was begun
_ABANDONED = 3600.0
#: bytes of all files in a folder together: the least recently used ones are removed
_MOST = 4 * 10**9


class ArrayFiles:
    """A folder of such files; it is created with the first.

    folder : where
    most : bytes of all of them
    """

    def __init__(self, folder: Path, most: int = _MOST) -> None:
        self.folder, self._most = folder, most

    def find(self, name: str) -> tuple[NDArray[Any], ...] | None:
        """The arrays of a name; None, with a warning, for a file that cannot be used, and None for none."""
        path = self._path(name)
        try:
            with open_file(path) as file:
                arrays = _read(file)
        except FileNotFoundError:
            return None
        except (OSError, ValueError) as error:
            reason = error.strerror if isinstance(error, OSError) else str(error)
            _LOG.warning("%s %s: the waves are computed again", printable(path, 1000), reason)
            return None
        with contextlib.suppress(OSError):
            os.utime(path)  # it was used
        _LOG.info("%s: %s read", path, readable_bytes(sum(array.nbytes for array in arrays)))
        return arrays

    def keep(self, name: str, arrays: tuple[NDArray[Any], ...]) -> None:
        """Write arrays under a name, and remove the least recently used ones beyond the folder's limit. Where
        that fails, a warning says why."""
        path = self._path(name)
        try:
            writable_folder(self.folder)
            with whole_file(path) as beside, beside.open("wb") as file:
                _write(file, arrays)
            self._make_room(path)
        except OSError as error:
            _LOG.warning("%s: %s: the waves will be computed again", printable(path, 1000), error.strerror)

    def _path(self, name: str) -> Path:
        return self.folder / f"{name}{_SUFFIX}"

    def _make_room(self, newest: Path) -> None:
        for part in self.folder.glob(f".*{_SUFFIX}.*{PART}"):  # of a process that was killed
            if time.time() - part.stat().st_mtime > _ABANDONED:
                part.unlink(missing_ok=True)
        files = [(path.stat(), path) for path in self.folder.glob(f"*{_SUFFIX}") if path != newest]
        left = self._most - newest.stat().st_size
        for status, path in sorted(files, key=lambda file: -file[0].st_mtime):
            left -= status.st_size
            if left < 0:
                path.unlink(missing_ok=True)


def use_folder(folder: Path | None) -> None:
    """Let this process keep such arrays in a folder; None: nowhere."""
    MEMO.shelf = None if folder is None else ArrayFiles(folder)


def use_environment(otherwise: Path | None = None) -> None:
    """Use the folder that the environment names, or another, or one in the environment's cache.

    Raises ParameterError for a path of another system.
    """
    text = os.environ.get(SHELF_VARIABLE)
    try:
        if text:
            otherwise = path_of(text).absolute()
        elif otherwise is None and (cache := environment_cache()) is not None:
            otherwise = cache / _IN_CACHE
    except ValueError as error:
        raise ParameterError(SHELF_VARIABLE, text, str(error)) from None
    use_folder(otherwise)


def use_cache(cache: Path) -> None:
    """Use a folder in a cache of baked frames, where the environment names none."""
    if MEMO.shelf is None:
        use_folder(cache / _IN_CACHE)


@contextlib.contextmanager
def nothing_kept() -> Iterator[None]:
    """Context manager in which this process neither keeps nor finds anything: for trials."""
    shelf, MEMO.shelf = MEMO.shelf, None
    try:
        yield
    finally:
        MEMO.shelf = shelf


def _write(file: BinaryIO, arrays: tuple[NDArray[Any], ...]) -> None:
    plain = [np.ascontiguousarray(array, array.dtype.newbyteorder("<")) for array in arrays]
    told = [
        {"shape": array.shape, "kind": array.dtype.str, "sum": zlib.crc32(array.reshape(-1).view(np.uint8))}
        for array in plain
    ]
    file.write(_BEGINNING + json.dumps(told).encode() + b"\n")
    for array in plain:
        file.write(array.reshape(-1).view(np.uint8).data)


def _read(file: BinaryIO) -> tuple[NDArray[Any], ...]:
    """Raises ValueError for a file that is not one of ours, or not whole."""
    if file.readline(len(_BEGINNING)) != _BEGINNING:
        raise ValueError("is no file of Ocean Tweak's arrays")
    told = _told(file.readline(_LONGEST_LINE))
    counts = [math.prod(shape) for shape, _, _ in told]
    needed = sum(count * kind.itemsize for count, (_, kind, _) in zip(counts, told, strict=True))
    found = os.fstat(file.fileno()).st_size - file.tell()
    if found != needed:
        raise ValueError(f"holds {readable_bytes(found)} instead of {readable_bytes(needed)}")
    arrays = []
    for count, (shape, kind, check) in zip(counts, told, strict=True):
        array = np.fromfile(file, kind, count)
        if zlib.crc32(array.view(np.uint8)) != check:
            raise ValueError("holds other numbers than were written")
        arrays.append(array.reshape(shape))
    return tuple(arrays)


def _told(line: bytes) -> list[tuple[tuple[int, ...], np.dtype[Any], int]]:
    """Shapes, kinds and check sums."""
    try:
        told = [(tuple(map(int, each["shape"])), each["kind"], int(each["sum"])) for each in json.loads(line)]
    except (ValueError, TypeError, KeyError, RecursionError):
        raise ValueError("does not say what it holds") from None
    if len(told) > _MOST_ARRAYS or any(
        kind not in _KINDS or min(shape, default=0) < 0 for shape, kind, _ in told
    ):
        raise ValueError("holds what no waves are")
    return [(shape, np.dtype(kind), check) for shape, kind, check in told]
