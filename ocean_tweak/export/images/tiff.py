# SPDX-License-Identifier: GPL-3.0-or-later
"""What the numbers of a TIFF mean, by its own tags: readers give them without saying.

Whole numbers are shares of the largest of their kind, decimals are themselves.
"""

from __future__ import annotations

import struct
from typing import BinaryIO

from .checks import UnusableError

_MAGICS = (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")

_BITS, _ORIENTATION, _FORMAT = 258, 274, 339
UNSIGNED, SIGNED, DECIMAL = 1, 2, 3

#: kinds of numbers that Blender and Pillow read without losing any
_KNOWN = {UNSIGNED: (1, 2, 4, 8, 16, 32), SIGNED: (16, 32), DECIMAL: (16, 32)}
_NAMES = {UNSIGNED: "whole numbers", SIGNED: "signed whole numbers", DECIMAL: "decimals"}
_MOST_TAGS = 4096


def is_tiff(stream: BinaryIO) -> bool:
    """Whether the bytes begin as a TIFF does."""
    stream.seek(0)
    return stream.read(4) in _MAGICS


def number_kind(stream: BinaryIO) -> tuple[int, int]:
    """UNSIGNED, SIGNED or DECIMAL, and the bits of a number.

    Raises UnusableError for a file that is damaged, and for kinds of which readers lose some.
    """
    try:
        tags = _first_tags(stream)
    except (struct.error, OSError, OverflowError, ValueError) as error:
        raise UnusableError(f"is not a readable TIFF: {error}") from None
    if tags.get(_ORIENTATION, 1) != 1:  # Pillow turns it, Blender does not
        raise UnusableError("has an Orientation tag that turns or mirrors it: save it upright")
    kind, bits = tags.get(_FORMAT, UNSIGNED), tags.get(_BITS, 1)
    kind = UNSIGNED if kind == 4 else kind  # nobody has said what they are
    if bits not in _KNOWN.get(kind, ()):
        what = f"{_NAMES.get(kind, 'numbers of another kind')} of {bits} bits"
        raise UnusableError(f"holds {what}, which are not supported: save it with 32-bit floats, or as .exr")
    return kind, bits


def largest(kind: int, bits: int) -> float:
    """What a whole number is divided by."""
    return float(2 ** (bits - 1 if kind == SIGNED else bits) - 1)


def _first_tags(stream: BinaryIO) -> dict[int, int]:
    """The first value of the tags that say what numbers are and where."""
    stream.seek(0)
    head = stream.read(16)
    order = "<" if head[:1] == b"I" else ">"
    is_big = head[2:4] in (b"+\0", b"\0+")
    entry = struct.Struct(order + ("HHQ8s" if is_big else "HHI4s"))
    (place,) = struct.unpack_from(order + ("Q" if is_big else "I"), head, 8 if is_big else 4)
    count_of = struct.Struct(order + ("Q" if is_big else "H"))
    stream.seek(place)
    (count,) = count_of.unpack(stream.read(count_of.size))
    content = stream.read(entry.size * min(count, _MOST_TAGS))
    tags = {}
    for tag, form, values, inline in entry.iter_unpack(content[: len(content) // entry.size * entry.size]):
        if tag in (_BITS, _ORIENTATION, _FORMAT) and form == 3 and values:  # short numbers
            if 2 * values > len(inline):
                stream.seek(struct.unpack(order + ("Q" if is_big else "I"), inline)[0])
                inline = stream.read(2)
            tags[tag] = struct.unpack_from(order + "H", inline)[0]
    return tags
