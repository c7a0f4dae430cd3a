# SPDX-License-Identifier: GPL-3.0-or-later
"""How a scanline EXR file is laid out, as far as it tells whether all of it is there.

OpenEXR does not say so when the disk refuses the last bytes: they wait in a buffer whose loss goes unnoticed.
"""

from __future__ import annotations

import struct
from pathlib import Path
from typing import BinaryIO

_MAGIC = b"\x76\x2f\x31\x01"
_LONGEST_NAME = 256


def is_complete(path: Path) -> bool:
    """Whether a scanline image of one part ends where its table of blocks says.

    The table is written last, so zeros in it mean that the file was given up. Raises OSError.
    """
    with path.open("rb") as file:
        size = file.seek(0, 2)
        file.seek(0)
        if file.read(4) != _MAGIC:
            return False
        file.seek(8)
        try:
            _skip_attributes(file, size)
            return _end(file, size) == size
        except struct.error:  # the file ends too early
            return False


def _skip_attributes(file: BinaryIO, size: int) -> None:
    """To the table: name, type, length and value, until an empty name."""
    while _text(file):
        _text(file)
        (length,) = struct.unpack("<I", file.read(4))
        if file.seek(length, 1) > size:
            raise struct.error


def _text(file: BinaryIO) -> bytes:
    start = file.tell()
    text, zero, _ = file.read(_LONGEST_NAME).partition(b"\0")
    if not zero:
        raise struct.error
    file.seek(start + len(text) + 1)
    return text


def _end(file: BinaryIO, size: int) -> int:
    """Where the last block ends: its place is the table's last entry, the first block follows the table."""
    table = file.tell()
    (first,) = struct.unpack("<Q", file.read(8))
    if not table + 8 <= first < size:
        return -1
    file.seek(first - 8)
    (last,) = struct.unpack("<Q", file.read(8))
    if not first <= last < size:
        return -1
    file.seek(last + 4)
    (length,) = struct.unpack("<I", file.read(4))
    return int(last + 8 + length)
