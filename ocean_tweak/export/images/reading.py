# SPDX-License-Identifier: GPL-3.0-or-later
"""An image or array of any kind that is read, as a raster."""

from __future__ import annotations

from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from ...core.data.errors import ParameterError
from ...core.data.raster import LUMINANCE, Raster
from . import arrays, exr_images
from .by_pillow import read_by_pillow
from .checks import UnusableError, opened


def read_raster(path: Path, channels: int | None = None, names: str = "", axes: str = "") -> Raster:
    """The numbers of an image (EXR, PNG, TIFF, JPEG, …) or of an array (.npy), by what is in the file.

    The top row of an image has the largest y; the first row of an array [y, x] the smallest. Whole numbers
    of images, and unsigned ones of 8 and 16 bits in arrays, are shares of the largest of their kind;
    decimals, and all other whole numbers in arrays, are themselves; truth values are 0 and 1.

    channels : how many are wanted: the first so many; one of a colour image is its luminance. By default
        all: 1 of a grey image, 3 of one in colour
    names : channels of an EXR image between commas, or a layer of it; by default R, G, B or Y
    axes : order of an array's axes, of y, x and c; by default as its shape tells

    Raises ParameterError, naming the file, for one that cannot be read, is too large or lacks channels.
    """
    path = Path(path)
    try:
        with opened(path) as stream:
            return raster_in(stream, path.name, channels, names, axes)
    except UnusableError as error:
        raise ParameterError("file", str(path), str(error)) from None


def raster_in(stream: BinaryIO, name: str, channels: int | None, names: str = "", axes: str = "") -> Raster:
    """As `read_raster`, of the bytes of a file of this name. Raises UnusableError, not naming it."""
    suffix = Path(name).suffix.lower()
    is_array, is_exr = arrays.is_array(stream), exr_images.is_exr(stream)
    if not is_array and not is_exr:  # then its name tells what was expected
        is_array, is_exr = suffix == ".npy", suffix == ".exr"
    if names and not is_exr:
        raise UnusableError(f"is not an EXR image: only those have named channels, such as {names[:40]!r}")
    if axes and not is_array:
        raise UnusableError("is not a .npy array: only for those can the order of axes be given")
    if is_array:
        values = arrays.read_array(stream, channels, axes)
    elif is_exr:
        values = exr_images.read_exr(stream, channels, names)
    else:
        values = read_by_pillow(stream)
    return Raster(_with_channels(values if values.ndim == 3 else values[..., np.newaxis], channels), name)


def _with_channels(values: NDArray[Any], channels: int | None) -> NDArray[Any]:
    """As many channels as are wanted; all by default."""
    found = values.shape[2]
    if channels is not None and found < channels:
        raise UnusableError(f"must have {channels} channels, but has {found}")
    if channels == 1 and found == 2:
        raise UnusableError('has 2 channels where one is needed: say which with "channels"')
    if channels == 1 and found >= 3:
        return (values[..., :3].astype(np.float64) @ LUMINANCE)[..., np.newaxis]
    return values[..., :channels]
