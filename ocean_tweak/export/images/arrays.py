# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays in .npy files. The order of their axes follows from their shape, or is given."""

from __future__ import annotations

import math
import tokenize
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from ...core.data.printable import printable
from ...core.data.raster import MOST_CHANNELS
from .checks import UnusableError, check_size

_MAGIC = b"\x93NUMPY"

#: orders of axes that may be asked for; c is the channel
AXES = ("yx", "xy", "yxc", "xyc", "cyx", "cxy", "ycx", "xcy")

#: bytes of the longest header that is looked at: of a plain array it has a hundred
_LONGEST_HEADER = 10_000

#: whole numbers that are grey levels, and the largest: as in images; all others are themselves
_GREYS = {np.dtype(np.uint8): 255.0, np.dtype(np.uint16): 65535.0}

#: of which numbers there are so many: one channel may be the luminance of a colour image
_COUNTS = {1: (1, 3, 4)}


def is_array(stream: BinaryIO) -> bool:
    """Whether the bytes begin as a .npy file does."""
    stream.seek(0)
    return stream.read(len(_MAGIC)) == _MAGIC


def read_array(stream: BinaryIO, channels: int | None, axes: str) -> NDArray[Any]:
    """The numbers [y, x, channel] of a .npy file, the first row with the smallest y.

    channels : how many are wanted; by default what the last axis holds
    axes : one of AXES; "" tells them by the shape, where only one order fits

    Raises UnusableError for what is no array of numbers, is damaged, or whose shape does not tell its axes.
    """
    shape, in_columns, dtype = _header(stream)
    if dtype.hasobject:
        raise UnusableError("is not an array of numbers: it holds objects, which are never loaded")
    if len(shape) not in (2, 3):
        raise UnusableError("must be an array [y, x] or [y, x, channel]")
    if dtype.kind not in "biuf":
        raise UnusableError(f"must hold numbers, not {printable(dtype, 40)}")
    order = axes or ("yx" if len(shape) == 2 else "")
    if order and len(order) != len(shape):
        raise UnusableError(f"has {len(shape)} axes, not {order}")
    fitting = [order] if order else _fitting(shape, channels)
    for name in fitting:
        check_size(shape[name.index("y")], shape[name.index("x")])
        if "c" in name and not 1 <= shape[name.index("c")] <= MOST_CHANNELS:
            raise UnusableError(f"must have from 1 to {MOST_CHANNELS} channels, not {shape[name.index('c')]}")
    values = _values(stream, shape, in_columns, dtype)
    readings = [_ordered(values, name) for name in fitting]
    if any(not np.array_equal(readings[0], reading, equal_nan=True) for reading in readings[1:]):
        raise UnusableError(
            f'has the shape {shape}, which may be {" or ".join(fitting)}: say which with "axes": '
            f'"{fitting[0]}" beside "file"'
        )
    _check_count(readings[0].shape[2], channels)
    return _numbers(readings[0])


def _header(stream: BinaryIO) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    """Shape, whether columns come first, and the kind of numbers."""
    read = {
        (1, 0): np.lib.format.read_array_header_1_0,
        (2, 0): np.lib.format.read_array_header_2_0,
        (3, 0): np.lib.format.read_array_header_2_0,
    }
    stream.seek(0)
    try:
        version = np.lib.format.read_magic(stream)
        return read[version](stream, max_header_size=_LONGEST_HEADER)
    except (
        ValueError, KeyError, TypeError, EOFError, SyntaxError, AttributeError, OverflowError, MemoryError,
        RecursionError, tokenize.TokenError,
    ):  # fmt: skip
        raise UnusableError("is not a NumPy array: its header cannot be read") from None


def _fitting(shape: tuple[int, ...], channels: int | None) -> list[str]:
    """The orders of axes in which an array has as many channels as are wanted."""
    if channels is None:
        return ["yxc"]
    counts = _COUNTS.get(channels, (channels,))
    fitting = [name for name in ("yxc", "cyx") if shape[name.index("c")] in counts]
    if not fitting:
        raise UnusableError(f"has the shape {shape}, in which no axis is {_wanted(channels)}")
    return fitting


def _check_count(found: int, channels: int | None) -> None:
    if channels is not None and found not in _COUNTS.get(channels, (channels,)):
        raise UnusableError(f"must have {_wanted(channels)}, but has {found}")


def _wanted(channels: int) -> str:
    counts = _COUNTS.get(channels, (channels,))
    return f"{' or '.join(map(str, counts))} channel{'s' if counts != (1,) else ''}"


def _values(stream: BinaryIO, shape: tuple[int, ...], in_columns: bool, dtype: np.dtype[Any]) -> NDArray[Any]:
    wanted = math.prod(shape) * dtype.itemsize
    content = stream.read(wanted)
    if len(content) != wanted:
        raise UnusableError(f"is cut off: it holds {len(content)} of {wanted} bytes of numbers")
    return np.frombuffer(content, dtype).reshape(shape, order="F" if in_columns else "C")


def _ordered(values: NDArray[Any], axes: str) -> NDArray[Any]:
    """[y, x, channel]."""
    ordered = values.transpose([axes.index(name) for name in "yxc" if name in axes])
    return ordered if ordered.ndim == 3 else ordered[..., np.newaxis]


def _numbers(values: NDArray[Any]) -> NDArray[Any]:
    largest = _GREYS.get(values.dtype.newbyteorder("="))
    return values if largest is None else values / largest
