# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of the file as the rasters that parameters hold, and the other way.

An image's numbers are taken as they are in its file: 8 bits divided by 255, decimals as decimals. Row 0 is
the bottom row in both.
"""

from __future__ import annotations

import time
import zlib
from collections.abc import Hashable, Iterable
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import ParameterError, Raster
from ..core.raster import LARGEST_SIDE
from ..export.pictures import read_picture
from .live_image import mark_as_data

#: how an image's numbers become a wind: the number that is calm, and the factor
WIND_VALUES = {
    "PLAIN": ("Plain", "A number of 1 is the wind's speed, 0 is calm, as in decimal images", 0.0, 1.0),
    "CENTRED": (
        "Around Grey", "Half grey is calm, 0 and 1 are the wind's speed either way, as in painted images",
        0.5, 2.0,
    ),
}  # fmt: skip

_SINGLE = ("FILE", "GENERATED")
# s between two looks at an image that somebody paints: its texels are compared
_LOOK = 0.25


class _Known(NamedTuple):
    """A raster, what its image was like, a sum of its texels while they are unsaved, and when it was seen."""

    likeness: Hashable
    raster: Raster
    sum: int
    seen: float


# What images hold, by their session uid and the number of channels. Nothing that cannot be read again.
_known: dict[tuple[int, int], _Known] = {}


def forget_all() -> None:
    """Take no image's texels for granted: a file was opened, or a step undone."""
    _known.clear()
    made_layer.cache_clear()


def forget(image: bpy.types.Image) -> None:
    """The image has changed."""
    for key in [key for key in _known if key[0] == image.session_uid]:
        del _known[key]


def raster_of(image: bpy.types.Image, channels: int) -> Raster:
    """The image's numbers: 1 channel of a colour image is its luminance, otherwise the first so many.

    Read anew only where the image has changed: painting and reloading are seen, by Blender's own notes and,
    while changes are unsaved, by the texels.

    Raises ParameterError, naming it, for an image that is missing, too large, constant where it should hold
    waves, or not finite.
    """
    key, likeness = (image.session_uid, channels), _likeness(image)
    known = _known.get(key)
    if known is not None and known.likeness == likeness and not _is_painted(image, known):
        return known.raster
    texels = _texels(image)
    summed = _sum(texels) if image.is_dirty else 0
    if known is None or known.likeness != likeness or known.sum != summed or not image.is_dirty:
        known = _Known(likeness, _raster(texels, image.name, channels), summed, 0.0)
    _known[key] = known._replace(seen=time.monotonic())
    return known.raster


def image_of(raster: Raster, candidates: Iterable[bpy.types.Image]) -> bpy.types.Image:
    """The image among the candidates that holds this raster, or a new one, packed into the file."""
    channels = raster.shape[2]
    for image in candidates:
        try:
            if raster_of(image, channels) == raster:
                return image
        except ParameterError:
            continue
    return _new_image(raster)


def open_image(path: Path, channels: int) -> Raster:
    """The raster of a file, which becomes an image of this .blend file; arrays of NumPy do not.

    Raises ParameterError, naming the file.
    """
    if path.suffix.lower() == ".npy":
        return read_picture(path, channels)
    try:
        image = bpy.data.images.load(str(path), check_existing=True)
    except RuntimeError:
        raise ParameterError("file", str(path), "cannot be read as an image") from None
    if image.users == 0:  # otherwise something else shows it in its colours
        mark_as_data(image)
    try:
        return raster_of(image, channels)
    except ParameterError:
        if image.users == 0:
            bpy.data.images.remove(image)
        raise


@lru_cache(maxsize=8)
def wind_raster(raster: Raster, values: str, speed: float) -> Raster:
    """Vectors in m/s from an image's numbers.

    values : a key of WIND_VALUES
    speed : m/s
    """
    _, _, calm, factor = WIND_VALUES[values]
    if calm == 0.0 and factor * speed == 1.0:
        return raster
    return Raster((raster.values.astype(np.float64) - calm) * (factor * speed), raster.name)


@lru_cache(maxsize=16)
def made_layer(kind: type, values: tuple[tuple[str, Hashable], ...]) -> object:
    """A layer of the parameters, made once: to check its rasters takes longer than a frame may.

    Raises ParameterError for values that are none.
    """
    return kind(**dict(values))


def _likeness(image: bpy.types.Image) -> Hashable:
    if image.source not in _SINGLE:
        raise ParameterError("image", image.name, "must be a single picture, not a movie, sequence or tiles")
    columns, rows = image.size
    if not (columns and rows):
        raise ParameterError(
            "image", image.name, f"its file cannot be read: {image.filepath or 'it has none'}"
        )
    if max(columns, rows) > LARGEST_SIDE:
        raise ParameterError(
            "image", image.name, f"has {columns} x {rows} samples: make it at most {LARGEST_SIDE} a side"
        )
    space = image.colorspace_settings
    return columns, rows, image.source, image.filepath, image.is_float, space.name, space.is_data


def _is_painted(image: bpy.types.Image, known: _Known) -> bool:
    """Whether to look at the texels of an image with unsaved changes; in a window not for each frame."""
    if not image.is_dirty:
        return known.sum != 0
    return bpy.app.background or time.monotonic() - known.seen > _LOOK


def _sum(texels: NDArray[np.float32]) -> int:
    return zlib.crc32(texels) or 1


def _texels(image: bpy.types.Image) -> NDArray[np.float32]:
    """(rows, columns, channels), the bottom row first."""
    columns, rows = image.size
    texels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(texels)
    if not texels.size:
        raise ParameterError("image", image.name, f"its file cannot be read: {image.filepath}")
    return texels.reshape(rows, columns, -1)


def _raster(texels: NDArray[np.float32], name: str, channels: int) -> Raster:
    if channels != 1:
        if texels.shape[2] < channels:
            raise ParameterError("image", name, f"must have {channels} channels, but is grey")
        return Raster(texels[..., :channels], name)
    colour = texels[..., :3]
    is_grey = bool((colour == colour[..., :1]).all())
    return Raster(colour[..., :1] if is_grey or texels.shape[2] < 3 else colour, name).grey()


def _new_image(raster: Raster) -> bpy.types.Image:
    rows, columns, channels = raster.shape
    image = bpy.data.images.new(
        raster.name or "Picture", columns, rows, alpha=False, float_buffer=True, is_data=True
    )
    mark_as_data(image)
    texels = np.zeros((rows, columns, 4), np.float32)
    texels[..., : 3 if channels == 1 else channels] = raster.values
    texels[..., 3] = 1.0
    image.pixels.foreach_set(texels.reshape(-1))
    image.update()
    image.pack()  # otherwise neither saved with the file nor kept by undo
    return image
