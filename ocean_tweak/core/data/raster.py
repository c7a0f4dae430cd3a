# SPDX-License-Identifier: GPL-3.0-or-later
"""Images and vector grids as values: immutable, compared by content, and stored in JSON as text.

Parameters that contain one are still equal if and only if their seas are, and complete, so that a bake on
another machine needs no further file.
"""

from __future__ import annotations

import base64
import binascii
import dataclasses
import hashlib
import math
import zlib
from collections.abc import Iterator
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import ParameterError
from .printable import shown

#: largest number of samples along a side, and of channels
LARGEST_SIDE, MOST_CHANNELS = 4096, 4

#: largest number of values in all rasters of a sea together: half a gigabyte
MOST_NUMBERS = 8 * LARGEST_SIDE**2

#: weights of red, green and blue in luminance (ITU-R BT.709)
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])

#: encodings, smallest first, with the factor by which values are multiplied before encoding
_ENCODINGS: dict[str, tuple[np.dtype[Any], float]] = {
    "uint8": (np.dtype("<u1"), 255.0),
    "uint16": (np.dtype("<u2"), 65535.0),
    "float16": (np.dtype("<f2"), 1.0),
    "float32": (np.dtype("<f4"), 1.0),
}


class Raster:
    """Read-only float32 samples [row, column, channel]; the first row has the smallest y.

    values : (rows, columns) or (rows, columns, channels), 1 to 4096 a side, 1 to 4 channels
    name : used in messages, for example the file's name; not part of the comparison

    Raises ParameterError, naming it, for another shape or numbers that are not finite in float32.

    Examples
    --------
    >>> Raster([[0.0, 0.5], [1.0, 0.25]], name="ramp").shape
    (2, 2, 1)
    """

    def __init__(self, values: ArrayLike, name: str = "") -> None:
        self.name = str(name)
        self.values = _checked_values(values, self.name)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Rows, columns and channels."""
        rows, columns, channels = self.values.shape
        return rows, columns, channels

    @property
    def nbytes(self) -> int:
        """Size of the values in bytes, plus that of their text form once it exists."""
        return self.values.nbytes + len(vars(self).get("_as_text", ("", ""))[1])

    @cached_property
    def sha256(self) -> str:
        """Hash of shape and values, 64 hexadecimal digits, the same on every platform."""
        head = "x".join(map(str, self.shape)).encode()
        return hashlib.sha256(head + b":" + self.values.astype("<f4").tobytes()).hexdigest()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Raster) and self.sha256 == other.sha256

    def __hash__(self) -> int:
        return hash(self.sha256)

    def __repr__(self) -> str:
        rows, columns, channels = self.shape
        return f"Raster({self.name!r}, {rows} x {columns} x {channels}, {self.sha256[:8]})"

    def grey(self) -> Raster:
        """One channel: the luminance of a colour image; alpha is ignored.

        Rasters of one or two channels stay as they are.
        """
        if self.shape[2] not in (3, 4):
            return self
        return Raster(self.values[..., :3].astype(np.float64) @ LUMINANCE, self.name)

    def brief(self) -> dict[str, Any]:
        """Identifies the raster without its values, for headers, where these would be too long."""
        return {"name": self.name, "shape": list(self.shape), "sha256": self.sha256}

    def to_plain(self) -> dict[str, Any]:
        """The values as compressed text, lossless, in the smallest encoding that can hold them."""
        encoding, text = self._as_text
        return {"name": self.name, "shape": list(self.shape), "encoding": encoding, "data": text}

    @cached_property
    def _as_text(self) -> tuple[str, str]:
        """Cached, as every frame's fingerprint needs it."""
        encoding, packed = self._smallest()
        return encoding, base64.b64encode(zlib.compress(packed.tobytes(), 9)).decode()

    def _smallest(self) -> tuple[str, NDArray[Any]]:
        for encoding in ("uint8", "uint16", "float16"):
            dtype, factor = _ENCODINGS[encoding]
            packed = _packed(self.values, dtype, factor)
            if np.array_equal(_unpacked(packed, factor), self.values):
                return encoding, packed
        return "float32", _packed(self.values, *_ENCODINGS["float32"])

    @classmethod
    def from_plain(cls, data: object) -> Raster:
        """Read the output of `to_plain`, or {"values": rows of numbers or of lists of numbers, "name": …}.

        Raises ParameterError for anything else.
        """
        if not isinstance(data, dict):
            raise ParameterError("raster", data, "must be a JSON object with values, or with shape and data")
        name = data.get("name", "")
        if not isinstance(name, str):
            raise ParameterError("name", name, "must be text")
        if set(data) <= {"name", "values"} and "values" in data:
            return cls(data["values"], name)
        if set(data) == {"name", "shape", "sha256"}:
            raise ParameterError(
                "sha256",
                data["sha256"],
                f"names the raster {shown(name)} but holds none of its numbers",
            )
        if set(data) - {"name"} != {"shape", "encoding", "data"}:
            known = "name, values; or name, shape, encoding, data"
            raise ParameterError("raster", ", ".join(map(str, data)), f"must have the keys {known}")
        return cls(_decoded(data["shape"], data["encoding"], data["data"]), name)


def raster_bytes(value: object) -> int:
    """Total size in bytes of the rasters in parameters, or in a tuple of parameters."""
    if isinstance(value, Raster):
        return value.nbytes
    if isinstance(value, tuple):
        return sum(map(raster_bytes, value))
    if dataclasses.is_dataclass(value):
        return sum(raster_bytes(getattr(value, field.name)) for field in dataclasses.fields(value))
    return 0


def check_numbers(count: int) -> None:
    """Raise ParameterError if this total number of raster values is more than one sea may hold."""
    if count > MOST_NUMBERS:
        raise ParameterError(
            "rasters", f"{count} numbers",
            f"must hold at most {MOST_NUMBERS} together: use fewer or smaller images and wind grids",
        )  # fmt: skip


def numbers_in(data: object) -> int:
    """Number of values of the rasters in plain data, without decoding them."""
    return sum(math.prod(item["shape"]) for item in _rasters_in(data) if "data" in item)


def has_brief_rasters(data: object) -> bool:
    """Whether plain data refers to rasters without containing their values."""
    return any("sha256" in item for item in _rasters_in(data))


def _rasters_in(data: object) -> Iterator[dict[str, Any]]:
    rest = [data]
    while rest:
        item = rest.pop()
        if isinstance(item, list):
            rest += item
        elif isinstance(item, dict):
            if ("data" in item or "sha256" in item) and _is_shape(item.get("shape")):
                yield item
            else:
                rest += item.values()


def _is_shape(shape: Any) -> bool:
    return (
        isinstance(shape, list)
        and len(shape) == 3
        and all(type(side) is int for side in shape)
        and all(1 <= side <= LARGEST_SIDE for side in shape[:2])
        and 1 <= shape[2] <= MOST_CHANNELS
    )


def with_holes(values: ArrayLike) -> ArrayLike:
    """The same values, with NaN where an array is masked: NumPy would show what is under the mask."""
    if not isinstance(values, np.ma.MaskedArray):
        return values
    return np.where(np.ma.getmaskarray(values), np.nan, values.data)


def _checked_values(values: ArrayLike, name: str) -> NDArray[np.float32]:
    what = f"raster {shown(name)}" if name else "raster"
    try:
        with np.errstate(over="ignore"):
            array = np.array(with_holes(values), dtype=np.float32, order="C")
    except OverflowError:  # an integer beyond the range of floats
        raise ParameterError(what, values, "must hold numbers that are finite in 32 bits") from None
    except (TypeError, ValueError):
        raise ParameterError(what, values, "must be rows of the same number of numbers") from None
    if array.ndim == 2:
        array = array[..., np.newaxis]
    fits = array.ndim == 3 and all(1 <= side <= LARGEST_SIDE for side in array.shape[:2])
    if not fits or not 1 <= array.shape[2] <= MOST_CHANNELS:
        limits = f"must have from 1 to {LARGEST_SIDE} rows and columns and from 1 to {MOST_CHANNELS} channels"
        raise ParameterError(what, f"shape {array.shape}", limits)
    if not np.isfinite(array).all():
        row, column = (int(index) for index in np.argwhere(~np.isfinite(array))[0][:2])
        raise ParameterError(
            what, float(array[row, column][~np.isfinite(array[row, column])][0]),
            f"must be finite everywhere, but is not in row {row}, column {column}",
        )  # fmt: skip
    array += np.float32(0.0)  # -0.0 and 0.0 are the same sea
    array.flags.writeable = False
    return array


def _packed(values: NDArray[np.float32], dtype: np.dtype[Any], factor: float) -> NDArray[Any]:
    if dtype.kind == "f":
        with np.errstate(over="ignore"):
            return values.astype(dtype)
    scaled = np.rint(values.astype(np.float64) * factor)
    return np.clip(scaled, 0, factor).astype(dtype)


def _unpacked(packed: NDArray[Any], factor: float) -> NDArray[np.float32]:
    if factor == 1.0:
        return packed.astype(np.float32)
    return (packed.astype(np.float64) / factor).astype(np.float32)


def _decoded(shape: Any, encoding: object, text: object) -> NDArray[np.float32]:
    if not _is_shape(shape):
        raise ParameterError(
            "shape", shape, f"must be [rows, columns, channels], up to {LARGEST_SIDE} a side"
        )
    if not isinstance(encoding, str) or encoding not in _ENCODINGS:
        raise ParameterError("encoding", encoding, "must be one of " + ", ".join(_ENCODINGS))
    if not isinstance(text, str):
        raise ParameterError("data", text, "must be text")
    dtype, factor = _ENCODINGS[encoding]
    size = math.prod(shape) * dtype.itemsize
    try:
        unpacker = zlib.decompressobj()
        content = unpacker.decompress(base64.b64decode(text, validate=True), size + 1)
    except (binascii.Error, ValueError, zlib.error) as error:
        raise ParameterError("data", text, f"is not compressed numbers in base64: {error}") from None
    if len(content) != size:
        raise ParameterError("data", text, f"must hold {size} bytes for shape {shape} in {encoding}")
    return _unpacked(np.frombuffer(content, dtype).reshape(shape), factor)
