# SPDX-License-Identifier: GPL-3.0-or-later
"""Images that the Pillow package reads, as numbers without colour space and transparency."""

from __future__ import annotations

import io
import struct
import sys
import warnings
import zlib
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from ...core.data.printable import printable
from ..exr import silenced
from . import tiff
from .checks import UnusableError, check_size

#: kinds of files; others may start programs (PostScript), and Blender reads them otherwise or not at all
FORMATS = ("PNG", "TIFF", "JPEG", "BMP", "TGA", "WEBP", "GIF")

#: of a file: more than decimals of the largest size, in four channels
_MOST_BYTES = 300_000_000

_GREY, _COLOUR = ("1", "L"), ("P", "PA", "CMYK", "YCbCr")
#: order of the bytes of a 16-bit number in Pillow's names, and the other one
_ORDERS = {"B": "L", "L": "B", "N": "B" if sys.byteorder == "little" else "L"}


def read_by_pillow(stream: BinaryIO) -> NDArray[Any]:
    """The numbers [y, x] or [y, x, channel] of an image, the first row with the smallest y.

    Whole numbers are shares of the largest of their kind, decimals are themselves.

    Raises UnusableError for what is damaged, too large or of another kind.
    """
    try:
        from PIL import Image, UnidentifiedImageError
    except ImportError:
        raise UnusableError(
            "needs the Pillow package: install it with 'pip install Pillow', or save the image as .exr"
        ) from None
    stream.seek(0)
    # of a file Pillow would ask for as many bytes as a chunk claims to have
    stream = io.BytesIO(stream.read(_MOST_BYTES + 1))
    if len(stream.getbuffer()) > _MOST_BYTES:
        raise UnusableError(f"is larger than {_MOST_BYTES / 1e6:g} MB")
    is_tiff = tiff.is_tiff(stream)
    kind = tiff.number_kind(stream) if is_tiff else (tiff.UNSIGNED, 16)
    try:
        with silenced(), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # its size is checked here
            return _numbers(stream, *kind)[::-1]
    except UnusableError:
        raise
    except Image.DecompressionBombError:
        raise UnusableError("has too many samples: make it smaller") from None
    except UnidentifiedImageError:
        raise UnusableError(
            "is a TIFF with a number format that Pillow does not read: save it as .exr"
            if is_tiff
            else f"is not an image of a supported kind: {', '.join(FORMATS)}, EXR"
        ) from None
    except (
        OSError, ValueError, SyntaxError, EOFError, IndexError, KeyError, TypeError, AttributeError,
        ZeroDivisionError, OverflowError, AssertionError, RuntimeError, struct.error, zlib.error,
    ) as error:  # fmt: skip
        reason = getattr(error, "strerror", None) or str(error) or type(error).__name__
        raise UnusableError(f"cannot be read: {printable(reason, 120)}") from None


def _numbers(stream: BinaryIO, kind: int, bits: int) -> NDArray[Any]:
    """Kind and bits are those of a number where a pixel has one of more than 8 bits."""
    with _opened(stream) as image:
        mode, raw = image.mode, _raw_mode(image)
        if ";16" in raw and not mode.startswith("I"):
            return _of_16_bits(stream, raw)
        if raw == "RGBa":  # the numbers as they stand in the file, not divided by transparency
            _set_raw_mode(image, "RGBA")
        if mode == "F":
            return np.asarray(image, np.float32)
        if mode.startswith("I"):
            values = np.asarray(image)
            if bits == 32 and kind == tiff.UNSIGNED:
                values = values.view(np.uint32)  # Pillow takes them for signed
            return np.maximum(values / tiff.largest(kind, bits), -1.0)
        if mode in _GREY:
            return np.asarray(image.convert("L")) / 255.0
        if mode in ("LA", "La"):
            return np.asarray(image)[..., 0] / 255.0
        if mode in ("RGB", "RGBA", "RGBX", *_COLOUR):
            return np.asarray(image.convert("RGB") if mode in _COLOUR else image)[..., :3] / 255.0
        raise UnusableError(f"has the colour channels {mode}: save it as grey or as RGB")


def _opened(stream: BinaryIO) -> Any:
    from PIL import Image

    stream.seek(0)
    image = Image.open(stream, formats=FORMATS)
    check_size(image.height, image.width)
    return image


def _raw_mode(image: Any) -> str:
    """How numbers lie in the file, in Pillow's words; "" where it does not say."""
    arguments = image.tile[0].args if image.tile else ""
    first = arguments[0] if isinstance(arguments, tuple) and arguments else arguments
    return first if isinstance(first, str) else ""


def _set_raw_mode(image: Any, raw: str) -> None:
    image.tile = [
        tile._replace(args=raw if isinstance(tile.args, str) else (raw, *tile.args[1:]))
        for tile in image.tile
    ]


def _of_16_bits(stream: BinaryIO, raw: str) -> NDArray[Any]:
    """Numbers of 16 bits in several channels, of which Pillow keeps 8: read twice, each half once."""
    layout, _, order = raw.partition(";16")
    if layout == "LA" and order == "B":  # a PNG's; as four channels of 8 bits its bytes are these
        with _opened(stream) as image:
            _set_raw_mode(image, "RGBA")
            pairs = np.asarray(image).astype(np.uint16)
        return (pairs[..., 0] * 256 + pairs[..., 1]) / 65535.0
    if layout.upper() not in ("RGB", "RGBA", "RGBX") or order not in _ORDERS:
        raise UnusableError(f"holds numbers as {raw}, of which only 8 bits would be read: save it as .exr")
    halves = []
    for half in (order, _ORDERS[order]):
        with _opened(stream) as image:
            _set_raw_mode(image, f"{layout.upper()};16{half}")
            halves.append(np.asarray(image)[..., :3].astype(np.uint16))
    return (halves[0] * 256 + halves[1]) / 65535.0
