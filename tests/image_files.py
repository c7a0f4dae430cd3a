# SPDX-License-Identifier: GPL-3.0-or-later
"""Images written byte by byte from the specifications of their formats, for tests of what reads them."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Mapping
from pathlib import Path

import numpy as np


def png(path: Path, depth: int, colour: int, rows: list[bytes], columns: int) -> Path:
    """A PNG file: no filter, one block of data. The top row first."""

    def chunk(kind: bytes, content: bytes) -> bytes:
        return (
            struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
        )

    head = struct.pack(">IIBBBBB", columns, len(rows), depth, colour, 0, 0, 0)
    data = zlib.compress(b"".join(b"\0" + row for row in rows))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b""))
    return path


def tiff(path: Path, values: np.ndarray, order: str = "<", **tags: int) -> Path:
    """A TIFF file without compression, (rows, columns) or (rows, columns, channels), the top row first.

    order : of bytes, "<" or ">"
    tags : orientation
    """
    rows, columns, *more = values.shape
    channels = more[0] if more else 1
    bits, kind = values.itemsize * 8, {"u": 1, "i": 2, "f": 3}[values.dtype.kind]
    entries = {
        256: (4, [columns]), 257: (4, [rows]), 258: (3, [bits] * channels), 259: (3, [1]),
        262: (3, [2 if channels > 2 else 1]), 273: (4, [0]), 274: (3, [tags.get("orientation", 1)]),
        277: (3, [channels]), 278: (4, [rows]), 279: (4, [values.nbytes]), 339: (3, [kind] * channels),
    }  # fmt: skip
    beyond = 8 + 2 + 12 * len(entries) + 4
    packed = {
        tag: (form, len(numbers), struct.pack(f"{order}{len(numbers)}{'HI'[form - 3]}", *numbers))
        for tag, (form, numbers) in entries.items()
    }
    elsewhere = sum(len(content) for _, _, content in packed.values() if len(content) > 4)
    packed[273] = (4, 1, struct.pack(order + "I", beyond + elsewhere))
    directory, outside = struct.pack(order + "H", len(entries)), b""
    for tag, (form, count, content) in packed.items():
        directory += struct.pack(order + "HHI", tag, form, count)
        if len(content) > 4:
            directory += struct.pack(order + "I", beyond + len(outside))
            outside += content
        else:
            directory += content.ljust(4, b"\0")
    head = (b"II*\0" if order == "<" else b"MM\0*") + struct.pack(order + "I", 8)
    pixels = values.astype(values.dtype.newbyteorder(order)).tobytes()
    path.write_bytes(head + directory + bytes(4) + outside + pixels)
    return path


def exr(
    path: Path,
    channels: Mapping[str, np.ndarray],
    at: tuple[int, int] = (0, 0),
    display: tuple[int, int] | None = None,
    sampling: Mapping[str, int] | None = None,
) -> Path:
    """An EXR file without compression, the top row first.

    channels : arrays of float32, float16 or uint32
    at : x and y in the image, downwards, of the first pixel that is stored
    display : columns and rows of the image, which begins at 0, 0; by default those of the channels
    sampling : of channels that have a pixel for so many of the others along both axes
    """
    sampling = dict.fromkeys(channels, 1) | dict(sampling or {})
    names = sorted(channels)
    rows, columns = max(plane.shape for plane in channels.values())
    kinds = {np.dtype(np.uint32): 0, np.dtype(np.float16): 1, np.dtype(np.float32): 2}

    def attribute(name: str, kind: str, content: bytes) -> bytes:
        return b"\0".join((name.encode(), kind.encode(), b"")) + struct.pack("<i", len(content)) + content

    def box(x: int, y: int, wide: int, high: int) -> bytes:
        return struct.pack("<4i", x, y, x + wide - 1, y + high - 1)

    listed = b"".join(
        name.encode() + b"\0" + struct.pack("<iB3xii", kinds[channels[name].dtype], 0, *2 * [sampling[name]])
        for name in names
    )
    head = b"v/1\x01" + struct.pack("<i", 2) + attribute("channels", "chlist", listed + b"\0")
    head += attribute("compression", "compression", b"\0") + attribute("lineOrder", "lineOrder", b"\0")
    head += attribute("dataWindow", "box2i", box(*at, columns, rows))
    head += attribute("displayWindow", "box2i", box(0, 0, *(display or (columns, rows))))
    head += attribute("pixelAspectRatio", "float", struct.pack("<f", 1.0))
    head += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0.0, 0.0))
    head += attribute("screenWindowWidth", "float", struct.pack("<f", 1.0)) + b"\0"
    table, body = b"", b""
    for row in range(rows):
        table += struct.pack("<Q", len(head) + 8 * rows + len(body))
        stored = [name for name in names if row % sampling[name] == 0]
        line = b"".join(channels[name][row // sampling[name]].tobytes() for name in stored)
        body += struct.pack("<ii", at[1] + row, len(line)) + line
    path.write_bytes(head + table + body)
    return path
