# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields as OpenEXR images: one map per file, plain channel names, data instead of colour.

With lossy compression, maps that need less precision have 16 bits, all others 32.

Row 0 of an EXR image is its top row, so arrays [y, x] are written with their rows reversed.
"""

from __future__ import annotations

import contextlib
import io
import json
import math
import os
import threading
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.data import formats
from ..core.data.errors import ParameterError
from ..core.data.frames import Frame
from ..core.data.plain_data import to_plain
from ..core.data.printable import printable
from ..core.numerics.threads import row_blocks
from ..core.parameters.ocean_parameters import OceanParameters, Patch
from ..core.sea.regions import Area
from ..core.synthesis.channels import HALVED_MAPS, MOVING_MAP, SurfaceFields, channels_of, image_of, unit_of
from .files import open_file, whole_file
from .frame_files import frame_file

METADATA_ATTRIBUTE = "oceanTweak"

#: largest number of values in all channels, which OpenEXR reads at once: a gigabyte
MOST_NUMBERS = 2**28

#: largest relative error of a stored value, by compression
COMPRESSION_ERROR = {"PXR24": 2.0**-16, "ZIP": 0.0, "ZIPS": 0.0, "NONE": 0.0, "HTJ2K": 0.0}

#: the lossy compression, and the one used for its maps in 16 bits
COMPACT, _OF_HALVES = "PXR24", "PIZ"
#: largest error of a value in 16 bits, relative to the power of two above its channel's maximum: finer detail
# would be noise for the codec
HALF_ERROR = 2.0**-11
_LARGEST_HALF, _SMALLEST_HALF = (
    float(np.finfo(np.float16).max),
    float(np.finfo(np.float16).smallest_subnormal),
)

#: errors raised by damaged images: wrong bytes, undecodable text, invalid or too deeply nested JSON
_UNREADABLE = (RuntimeError, KeyError, ValueError, TypeError, OSError, RecursionError)

#: OpenEXR's names that differ from ours
_OPENEXR_NAMES = {"NONE": "NO", "HTJ2K": "HTJ2K256"}


class ExrError(RuntimeError):
    """An image that cannot be written or read, with its path and the reason."""


class NewerExrError(ExrError):
    """An image of a newer version of the program."""


@contextlib.contextmanager
def silenced() -> Iterator[None]:
    """Suppress what libraries print about unreadable files, as the error says it in one line.

    On other threads than the main one, messages are not suppressed: standard error is shared by all threads,
    and two at once could not restore it.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    with contextlib.ExitStack() as stack:
        # Python's own output may be parsed by programs
        stack.enter_context(contextlib.redirect_stdout(io.StringIO()))
        with contextlib.suppress(OSError):  # a graphical program may have no standard error
            kept = os.dup(2)
            stack.callback(os.close, kept)
            stack.callback(os.dup2, kept, 2)
            nothing = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nothing, 2)
            os.close(nothing)
        yield


def load_openexr() -> Any:
    """Import the OpenEXR package. Raises ExrError, with the remedy, if it is missing."""
    try:
        import OpenEXR
    except ImportError as error:
        raise ExrError(
            f"the OpenEXR package cannot be loaded ({error}): install it with 'pip install OpenEXR', "
            "or in Blender install the extension from its zip, which brings it along"
        ) from error
    return OpenEXR


@dataclass(frozen=True)
class ExrSequence:
    """Writes frames as NAME_map.####.exr into a folder, one file per map; for a patch, NAME_p1_map.####.exr.

    parameters : of the frames; stored in every header
    patch : index of the patch, from 0, in a sea of several
    compression : a key of COMPRESSION_ERROR
    maps : keys of `core.synthesis.channels.MAPS`
    area : the square that is shown; None for the tile of the sea or of the patch
    encoding : version of `core.data.formats.ENCODING`
    """

    directory: Path
    name: str
    parameters: OceanParameters
    compression: str = COMPACT
    maps: tuple[str, ...] = (MOVING_MAP,)
    patch: int | None = None
    area: Area | None = None
    encoding: int = formats.ENCODING

    @property
    def outputs(self) -> frozenset[str]:
        """The fields that a frame must have."""
        return channels_of(self.maps)

    def path(self, frame: Frame, map_name: str = MOVING_MAP) -> Path:
        """Path of a frame's map."""
        patch = None if self.patch is None else self.patch + 1
        return self.directory / frame_file(self.name, map_name, frame, patch)

    @property
    def domain_size(self) -> float:
        """Side of the square in an image, m."""
        if self.area is not None:
            return self.area.size
        return self.parameters.domain_size if self.patch is None else self._patch.domain_size

    @property
    def resolution(self) -> int:
        """Texels along each side."""
        if self.area is not None:
            return self.area.resolution
        return self.parameters.resolution if self.patch is None else self._patch.resolution

    @property
    def _patch(self) -> Patch:
        assert self.patch is not None
        return self.parameters.patches[self.patch]

    def write(self, frame: Frame, fields: SurfaceFields) -> tuple[Path, ...]:
        """Write the frame's maps, in object space. Returns the files' paths."""
        return tuple(self.write_map(frame, fields, name) for name in self.maps)

    def write_map(self, frame: Frame, fields: SurfaceFields, name: str) -> Path:
        """Write one of the frame's maps. Returns its path."""
        path = self.path(frame, name)
        content, fps = self._content(frame, fields, name), self.parameters.timing.fps
        write_image(path, *content, fps, self.compression, self.is_halved(name))
        return path

    def encoded(self, frame: Frame, fields: SurfaceFields, name: str) -> bytes:
        """The bytes of one of a frame's maps. Raises ExrError for a value that is not finite."""
        image, metadata = self._content(frame, fields, name)
        path, fps = self.path(frame, name), self.parameters.timing.fps
        return _encoded(path, image, metadata, fps, self.compression, self.is_halved(name))

    def is_halved(self, name: str) -> bool:
        """Whether a map is stored in 16 bits."""
        return self.encoding > 1 and name in halved_maps(self.maps, self.compression)

    def _content(
        self, frame: Frame, fields: SurfaceFields, name: str
    ) -> tuple[NDArray[np.floating], dict[str, Any]]:
        """A map's image and its header."""
        metadata = {
            "format": formats.IMAGE,
            "map": name,
            "unit": unit_of(name),
            "frame": to_plain(frame),
            "time": fields.time,
            "domain_size": self.domain_size,
            "compression": self.compression,
            "parameters": {"format": formats.SEA, **self.parameters.to_dict(brief=True)},
        }
        if self.area is not None:
            metadata["area"] = self.area.to_dict()
        if self.patch is not None:
            count = len(self.parameters.patches)
            metadata["patch"] = {"number": self.patch + 1, "of": count, "rotation": self._patch.rotation}
        return image_of(name, fields), metadata


def halved_maps(maps: Iterable[str], compression: str) -> frozenset[str]:
    """The maps stored in 16 bits with a compression."""
    return HALVED_MAPS.intersection(maps) if compression == COMPACT else frozenset()


def write_image(
    path: Path,
    image: NDArray[np.floating],
    metadata: dict[str, Any],
    fps: Fraction,
    compression: str = "PXR24",
    halved: bool = False,
) -> None:
    """Write an (N, M, 3) array [y, x] as R, G, B; the file appears complete or not at all.

    halved : whether to store 16 bits

    Raises ExrError for a value that is not finite, and OSError if it cannot be written.
    """
    encoded = _encoded(path, image, metadata, fps, compression, halved)
    # not written by OpenEXR, which does not report a disk that refuses the last bytes
    with whole_file(path) as beside:
        beside.write_bytes(encoded)


def _encoded(
    path: Path,
    image: NDArray[np.floating],
    metadata: dict[str, Any],
    fps: Fraction,
    compression: str,
    halved: bool = False,
) -> bytes:
    openexr = load_openexr()
    if not np.all(np.isfinite(image)):
        raise ExrError(f"{path}: the image holds values that are not finite")
    codec = _OF_HALVES if halved else _OPENEXR_NAMES.get(compression, compression)
    header = {
        "compression": getattr(openexr, f"{codec}_COMPRESSION"),
        "type": openexr.scanlineimage,
        "colorInteropID": "data",
        "framesPerSecond": fps,
        METADATA_ATTRIBUTE: json.dumps(metadata),
    }
    # OpenEXR silently writes non-contiguous arrays wrongly
    rows = np.asarray(image, np.float32)[::-1]
    channels = {name: np.ascontiguousarray(rows[..., index]) for index, name in enumerate("RGB")}
    if halved:
        channels = {name: _halved(path, channel) for name, channel in channels.items()}
    encoded = io.BytesIO()
    try:
        openexr.File(header, channels).write(encoded)
    except RuntimeError as error:
        raise ExrError(f"{path}: {error}") from error
    return encoded.getvalue()


def _halved(path: Path, channel: NDArray[np.float32]) -> NDArray[np.float16]:
    """A channel in 16 bits, within HALF_ERROR. Raises ExrError for numbers that are too large."""
    largest = max(float(np.max(channel)), -float(np.min(channel)))
    if largest > _LARGEST_HALF:
        raise ExrError(f"{path}: the image holds {largest:g}, and 16 bits hold at most {_LARGEST_HALF:g}")
    result = np.zeros(channel.shape, np.float16)
    if largest < _SMALLEST_HALF / 2.0:
        return result
    # there are so few different values that a lookup table is much faster than NumPy's conversion
    most = round(0.5 / HALF_ERROR)
    step = 2.0 ** math.ceil(math.log2(largest)) / most
    numbers = np.clip(step * np.arange(-most, most + 1), -_LARGEST_HALF, _LARGEST_HALF)
    table = numbers.astype(np.float16)
    for rows in row_blocks(*channel.shape):
        number = channel[rows] * np.float32(1.0 / step)
        np.rint(number, out=number)
        number += np.float32(most)
        result[rows] = np.take(table, number.astype(np.intp), mode="wrap")
    return result


def read_image(
    path: Path, shape: tuple[int, int] | None = None
) -> tuple[NDArray[np.float32], dict[str, Any]]:
    """The (N, M, 3) array [y, x] and the metadata of an image written by `write_image`.

    shape : (N, M) that it must have; if not, its pixels, which may be very many, are not read

    Raises ExrError for a file that is damaged, not one of ours or of another shape.
    """
    openexr = load_openexr()
    metadata, found = _header(path)
    if shape is not None and found != shape:
        raise ExrError(f"{path}: has {found[1]} x {found[0]} texels, not {shape[1]} x {shape[0]}")
    try:
        with silenced(), open_file(path) as stream, openexr.File(stream, separate_channels=True) as file:
            channels = file.channels()
            rows = np.stack([channels[name].pixels for name in "RGB"], axis=-1)
    except _UNREADABLE as error:
        raise ExrError(f"{path}: not a readable image of Ocean Tweak ({printable(error, 200)})") from error
    return np.ascontiguousarray(rows[::-1], np.float32), metadata


def read_header(path: Path) -> dict[str, Any]:
    """The metadata of an image written by `write_image`, without its pixels. Raises ExrError."""
    return _header(path)[0]


def read_size(path: Path) -> tuple[int, int]:
    """Rows and columns of any EXR image, from its header. Raises ExrError."""
    return _size(_raw_header(path))


def _header(path: Path) -> tuple[dict[str, Any], tuple[int, int]]:
    """The metadata of one of our images, and rows and columns. Raises ExrError."""
    header = _raw_header(path)
    try:
        metadata = json.loads(header[METADATA_ATTRIBUTE])
    except _UNREADABLE as error:
        raise ExrError(f"{path}: not a readable image of Ocean Tweak ({printable(error, 200)})") from error
    rows, columns = _size(header)
    numbers = rows * columns * len(header.get("channels", ()))
    if (
        not isinstance(metadata, dict)
        or header["type"] != load_openexr().scanlineimage
        or numbers > MOST_NUMBERS
    ):
        raise ExrError(f"{path}: not a readable image of Ocean Tweak")
    try:
        formats.check_format(metadata, formats.IMAGE)
    except ParameterError as error:
        kind = NewerExrError if isinstance(error, formats.NewerFormatError) else ExrError
        raise kind(f"{path}: {error}") from None
    return metadata, (rows, columns)


def _raw_header(path: Path) -> dict[str, Any]:
    openexr = load_openexr()
    try:
        with silenced(), open_file(path) as stream, openexr.File(stream, header_only=True) as file:
            header = dict(file.header())  # copied, as the file frees its own when it is closed
    except _UNREADABLE as error:
        raise ExrError(f"{path}: not a readable image of Ocean Tweak ({printable(error, 200)})") from error
    if not {"type", "dataWindow"} <= header.keys():
        raise ExrError(f"{path}: not a readable image of Ocean Tweak")
    return header


def _size(header: dict[str, Any]) -> tuple[int, int]:
    low, high = header["dataWindow"]
    columns, rows = (int(end) - int(start) + 1 for start, end in zip(low, high, strict=True))
    return rows, columns
