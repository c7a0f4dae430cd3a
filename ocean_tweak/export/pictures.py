# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures and arrays in files, as rasters that parameters can hold.

Their numbers are data: no colour space is applied. Transparency is left out.
"""

from __future__ import annotations

import contextlib
import dataclasses
import io
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import ParameterError
from ..core.raster import LARGEST_SIDE, Raster
from .exr import ExrError, load_openexr

#: what a JSON file may say in place of a raster; `offset` is taken away before `scale` multiplies
REFERENCE_KEYS = frozenset({"file", "offset", "scale"})

#: shares of red, green and blue in a grey that looks as bright (ITU-R BT.709)
_LUMINANCE = (0.2126, 0.7152, 0.0722)

_TOO_LARGE = f"must have at most {LARGEST_SIDE} samples a side: make it smaller"


def read_picture(path: Path, channels: int | None = None) -> Raster:
    """The numbers of a picture (EXR, PNG, JPEG, … by what reads it) or of an array (.npy).

    The top row of a picture has the largest y; the first row of an array [y, x] the smallest. Whole numbers
    of 8 bits are divided by 255 and those of 16 by 65535; decimals are themselves.

    channels : how many are wanted: the first so many; one of a colour picture is its luminance. By default
        all: 1 of a grey picture, 3 of one in colour.

    Raises ParameterError, naming the file, for one that cannot be read, is too large or lacks channels.
    """
    path = Path(path)
    values = _READERS.get(path.suffix.lower(), _by_pillow)(path)
    if values.ndim == 2:
        values = values[..., np.newaxis]
    found = values.shape[-1] if values.ndim == 3 else 0
    if channels is not None and found < channels:
        raise _refused(path, f"must have {channels} channels, but has {found}")
    if channels == 1 and found >= 3:
        values = (values[..., :3].astype(np.float64) @ np.array(_LUMINANCE))[..., np.newaxis]
    elif channels is not None:
        values = values[..., :channels]
    return Raster(values, path.name)


#: from a file and how many channels are wanted of it to its raster; as `read_picture`
Reader = Callable[[Path, int], Raster]


def with_pictures(kind: type, data: Any, folder: Path, read: Reader = read_picture) -> Any:
    """Plain data of a dataclass in which each reference to a file has become the raster's plain data.

    kind : the dataclass; its fields of rasters say how many channels they want
    data : as it stands in JSON; {"file": "wind.exr"} may stand for a raster, with "offset" and "scale" where
        the numbers are to become scale · (number - offset)
    folder : what relative paths are relative to
    read : what reads a file

    Raises ParameterError with the path of what is wrong. Data of another form is left for validation.
    """
    if not isinstance(data, dict):
        return data
    result = dict(data)
    for field in dataclasses.fields(kind):
        if field.name not in data:
            continue
        try:
            result[field.name] = _resolved(field.metadata, data[field.name], folder, read)
        except ParameterError as error:
            raise error.inside(field.name) from None
    return result


def _resolved(metadata: Any, value: Any, folder: Path, read: Reader) -> Any:
    nested = metadata.get("nested")
    if metadata.get("kind") is Raster and isinstance(value, dict) and "file" in value:
        return _referred(value, metadata["channels"], folder, read).to_plain()
    if nested is None:
        return value
    if not metadata.get("many"):
        return with_pictures(nested, value, folder, read)
    if not isinstance(value, list):
        return value
    items = []
    for index, item in enumerate(value):
        try:
            items.append(with_pictures(nested, item, folder, read))
        except ParameterError as error:
            raise error.inside(str(index)) from None
    return items


def _referred(reference: dict[str, Any], channels: int, folder: Path, read: Reader) -> Raster:
    unknown = sorted(set(reference) - REFERENCE_KEYS)
    if unknown:
        known = ", ".join(sorted(REFERENCE_KEYS))
        raise ParameterError(str(unknown[0]), reference[unknown[0]], f"unknown key; Known keys: {known}")
    if not isinstance(reference["file"], str) or not reference["file"]:
        raise ParameterError("file", reference["file"], "must be the path of a file")
    numbers = {"offset": 0.0, "scale": 1.0}
    for key in numbers:
        value = reference.get(key, numbers[key])
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= 1e6:
            raise ParameterError(key, value, "must be a number from -1e6 to 1e6")
        numbers[key] = float(value)
    picture = read(folder / reference["file"], channels)
    if numbers == {"offset": 0.0, "scale": 1.0}:
        return picture
    values = numbers["scale"] * (picture.values.astype(np.float64) - numbers["offset"])
    return Raster(values, picture.name)


def _refused(path: Path, reason: str) -> ParameterError:
    return ParameterError("file", str(path), reason)


def _checked_size(path: Path, rows: int, columns: int) -> None:
    if not (1 <= rows <= LARGEST_SIDE and 1 <= columns <= LARGEST_SIDE):
        raise _refused(path, f"has {columns} x {rows} samples; {_TOO_LARGE}")


def _array(path: Path) -> NDArray[Any]:
    try:
        values = np.load(path, mmap_mode="r", allow_pickle=False)
    except OSError as error:
        raise _refused(path, f"cannot be read: {error.strerror or error}") from None
    except (ValueError, EOFError, SyntaxError) as error:
        raise _refused(path, f"is not an array of NumPy: {error}") from None
    if not isinstance(values, np.ndarray) or values.ndim not in (2, 3):
        raise _refused(path, "must be an array [y, x] or [y, x, channel]")
    _checked_size(path, *values.shape[:2])
    if values.dtype.kind not in "fiu":
        raise _refused(path, f"must hold numbers, not {values.dtype}")
    return _normalised(np.array(values))


def _normalised(values: NDArray[Any]) -> NDArray[Any]:
    """Whole numbers of 8 and 16 bits as shares of their largest; others as they are."""
    largest = {np.dtype(np.uint8): 255.0, np.dtype(np.uint16): 65535.0}.get(values.dtype.newbyteorder("="))
    return values if largest is None else values / largest


def _by_openexr(path: Path) -> NDArray[np.float32]:
    try:
        library = load_openexr()
    except ExrError as error:
        raise _refused(path, str(error)) from None
    try:
        # OpenEXR prints its warnings, and what is printed may be read by machines
        with contextlib.redirect_stdout(io.StringIO()), path.open("rb") as stream:
            with library.File(stream, header_only=True) as file:
                low, high = file.header()["dataWindow"]
            _checked_size(path, int(high[1]) - int(low[1]) + 1, int(high[0]) - int(low[0]) + 1)
            stream.seek(0)
            with library.File(stream, separate_channels=True) as file:
                planes = {name: channel.pixels for name, channel in file.channels().items()}
    except ParameterError:
        raise
    except OSError as error:
        raise _refused(path, f"cannot be read: {error.strerror or error}") from None
    except (RuntimeError, KeyError, ValueError, TypeError) as error:
        raise _refused(path, f"is not a readable EXR image: {error}") from None
    names = [name for name in "RGB" if name in planes] or [name for name in "XYZ" if name in planes]
    if not names or len({planes[name].shape for name in names}) > 1:
        raise _refused(path, f"must have channels R, G, B or Y; it has {', '.join(sorted(planes)) or 'none'}")
    return np.stack([planes[name] for name in names], axis=-1).astype(np.float32)[::-1]


def _by_pillow(path: Path) -> NDArray[Any]:
    try:
        from PIL import Image, UnidentifiedImageError
    except ImportError:
        raise _refused(
            path, "is read by the Pillow package: install it with 'pip install Pillow', or save it as .exr"
        ) from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # its size is checked here
            with Image.open(path) as picture:
                columns, rows = picture.size
                _checked_size(path, rows, columns)
                deep = picture.mode not in ("I;16", "I") and "16" in str(picture.tile)
                if deep:
                    raise _refused(path, "has 16 bits a colour, of which Pillow reads 8: save it as .exr")
                return _plain_channels(picture)[::-1]
    except ParameterError:
        raise
    except Image.DecompressionBombError:
        raise _refused(path, _TOO_LARGE) from None
    except UnidentifiedImageError:
        raise _refused(path, "is not a picture of a kind that Pillow reads") from None
    except (OSError, ValueError, SyntaxError, EOFError, IndexError) as error:
        reason = getattr(error, "strerror", None) or error
        raise _refused(path, f"cannot be read: {reason}") from None


def _plain_channels(picture: Any) -> NDArray[Any]:
    """Grey or red, green and blue, without transparency, as shares of the largest whole number."""
    if picture.mode == "F":
        return np.asarray(picture, np.float32)
    if picture.mode.startswith("I"):  # Pillow's modes of 16-bit pictures in grey
        return np.asarray(picture).astype(np.float64) / 65535.0
    grey = picture.mode in ("1", "L", "LA", "La")
    return np.asarray(picture.convert("L" if grey else "RGB")) / 255.0


#: reader of a file by the end of its name; Pillow's for all others
_READERS: dict[str, Callable[[Path], NDArray[Any]]] = {".npy": _array, ".exr": _by_openexr}
