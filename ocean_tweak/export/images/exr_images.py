# SPDX-License-Identifier: GPL-3.0-or-later
"""EXR images of any program: channels by name, each number where it was painted.

An image's display window is the image. Its data window is the part of it that is stored: what lies outside
the image is cropped, what is missing is 0.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from itertools import takewhile
from typing import Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.data.printable import printable
from ..exr import MOST_NUMBERS, ExrError, load_openexr, silenced
from .checks import UnusableError, check_size, listed

_MAGIC = b"\x76\x2f\x31\x01"

#: default channel names: as many of a group as exist, from its first
_GROUPS = (("R", "G", "B"), ("X", "Y", "Z"), ("U", "V"), ("u", "v"), ("Y",))

#: what damaged images give
_DAMAGED = (RuntimeError, KeyError, ValueError, TypeError, IndexError, OverflowError, AttributeError)


class _Window(NamedTuple):
    """Pixels from `low` up to but without `high`, (x, y) with y downwards."""

    low: tuple[int, int]
    high: tuple[int, int]

    @classmethod
    def of(cls, box: Any) -> _Window:
        low, high = (tuple(map(int, corner)) for corner in box)
        return cls((low[0], low[1]), (high[0] + 1, high[1] + 1))

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.high[1] - self.low[1], self.high[0] - self.low[0]


def is_exr(stream: BinaryIO) -> bool:
    """Whether the bytes begin as an EXR image does."""
    stream.seek(0)
    return stream.read(len(_MAGIC)) == _MAGIC


def read_exr(stream: BinaryIO, channels: int | None, names: str) -> NDArray[np.float32]:
    """The numbers [y, x, channel] of an EXR image, the first row with the smallest y.

    channels : how many are wanted; only for the message where there are fewer
    names : of channels, between commas, or of a layer; "" for R, G, B or what stands for these

    Raises UnusableError for what is damaged, too large, or has no such channels.
    """
    labels, display = _measured(stream)
    wanted = _chosen(labels, names, channels)
    with _file(stream, separate_channels=True) as file:
        parts = {labels[name][0] for name in wanted}
        if len(parts) > 1:
            raise UnusableError(f"holds {listed(wanted)} in several parts: choose channels of one part")
        part = file.parts[parts.pop()]
        planes = [part.channels[labels[name][1]].pixels for name in wanted]
        window = _Window.of(part.header["dataWindow"])
        if any(plane.shape != window.shape for plane in planes):
            raise UnusableError(f"stores {listed(wanted)} at reduced resolution: save it as R, G, B")
        return _placed(np.stack(planes, axis=-1).astype(np.float32), window, display)[::-1]


def in_image(stream: BinaryIO, texels: NDArray[np.float32]) -> NDArray[np.float32]:
    """Texels [y, x, channel] of what an image stores, bottom row first, where this lies in the image.

    Raises UnusableError for an image that cannot be used or stores another number of texels.
    """
    _, display = _measured(stream)
    with _file(stream, header_only=True) as file:
        data = _Window.of(file.parts[0].header["dataWindow"])
    if texels.shape[:2] != data.shape:
        raise UnusableError("was changed on disk while it was being painted: save it or reload it")
    return _placed(texels[::-1], data, display)[::-1]


def channel_names(stream: BinaryIO) -> tuple[str, ...]:
    """What `names` may hold. Raises UnusableError for an image that cannot be used."""
    return tuple(_measured(stream)[0])


def size(stream: BinaryIO) -> tuple[int, int]:
    """Columns and rows of an image of any size, by its header. Raises UnusableError for what is none."""
    with _file(stream, header_only=True) as file:
        rows, columns = _Window.of(file.parts[0].header["displayWindow"]).shape
    return columns, rows


@contextlib.contextmanager
def _file(stream: BinaryIO, **options: bool) -> Iterator[Any]:
    try:
        library = load_openexr()
    except ExrError as error:
        raise UnusableError(str(error)) from None
    try:
        stream.seek(0)
        with silenced(), library.File(stream, **options) as file:
            yield file
    except UnusableError:
        raise
    except _DAMAGED as error:
        raise UnusableError(f"is not a readable EXR image: {printable(error, 120)}") from None


def _measured(stream: BinaryIO) -> tuple[dict[str, tuple[int, str]], _Window]:
    """From the name of each channel to its part's number and its name there, and the image's window."""
    labels: dict[str, tuple[int, str]] = {}
    numbers = 0
    with _file(stream, header_only=True) as file:
        display = _Window.of(file.parts[0].header["displayWindow"])
        check_size(*display.shape)
        plain = (load_openexr().scanlineimage, load_openexr().tiledimage)
        for index, part in enumerate(file.parts):
            header = part.header
            if header["type"] not in plain:
                raise UnusableError("is a deep image: flatten it")
            rows, columns = _Window.of(header["dataWindow"]).shape
            numbers += max(rows, 0) * max(columns, 0) * len(header["channels"])
            for channel in header["channels"]:
                label = _label(index, str(header.get("name", "")), channel.name)
                labels.setdefault(label, (index, channel.name))
    if numbers > MOST_NUMBERS:
        raise UnusableError(
            f"has {numbers} numbers in {len(labels)} channels; must have at most {MOST_NUMBERS}: "
            "save only the channels you need"
        )
    return labels, display


def _label(part: int, part_name: str, channel: str) -> str:
    """Channels of parts after the first stand behind the part's name, as layers do."""
    is_named = part == 0 or not part_name or channel.startswith(f"{part_name}.")
    return channel if is_named else f"{part_name}.{channel}"


def _chosen(labels: Sequence[str] | dict[str, Any], names: str, channels: int | None) -> list[str]:
    """Names of the channels that are meant."""
    asked = [name.strip() for name in names.split(",")]
    if names and all(name in labels for name in asked):
        return asked
    layer = f"{asked[0]}." if names else ""
    if len(asked) == 1:
        inside = [name.removeprefix(layer) for name in labels if name.startswith(layer)]
        for group in _GROUPS:
            found = list(takewhile(inside.__contains__, group))
            # a Y beside an X is not a brightness, an X alone no pair
            if len(found) > 1 or found == ["R"] or found == ["Y"]:
                return [layer + name for name in found]
        if layer and channels == len(inside) == 1:
            return [layer + inside[0]]
    what = f"no channel or layer {listed([names])}" if names else "no channels R, G, B or Y"
    raise UnusableError(f'has {what}; it has {listed(labels)}: name the channels to use with "channels"')


def _placed(pixels: NDArray[np.float32], data: _Window, display: _Window) -> NDArray[np.float32]:
    """Pixels of the data window in the image, 0 where there are none; row 0 at the top."""
    if data == display:
        return pixels
    low = [max(data.low[axis], display.low[axis]) for axis in (0, 1)]
    high = [min(data.high[axis], display.high[axis]) for axis in (0, 1)]
    if low[0] >= high[0] or low[1] >= high[1]:
        raise UnusableError("shows nothing: its data window lies outside its display window")
    image = np.zeros((*display.shape, pixels.shape[2]), np.float32)

    def inside(window: _Window) -> tuple[slice, slice]:
        return (
            slice(low[1] - window.low[1], high[1] - window.low[1]),
            slice(low[0] - window.low[0], high[0] - window.low[0]),
        )

    image[inside(display)] = pixels[inside(data)]
    return image
