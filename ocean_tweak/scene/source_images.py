# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of the file as the rasters that parameters hold, and the other way.

An image's numbers are taken as they are in its file: whole numbers as shares of the largest of their kind,
decimals as decimals. Row 0 is the bottom row in both. EXR images are read here as they are outside Blender:
its own reader takes what is stored of one for the whole image, and no other channels than R, G, B.
"""

from __future__ import annotations

import contextlib
import io
import time
import zlib
from collections.abc import Hashable, Iterable, Iterator
from pathlib import Path
from typing import BinaryIO, NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import ParameterError, Raster
from ..core.data.raster import LARGEST_SIDE
from ..core.numerics.memo import MEMO, remembered
from ..export.images import exr_images, read_raster, tiff
from ..export.images.checks import UnusableError, opened
from ..export.images.reading import raster_in
from .live_image import mark_as_data
from .stored_paths import image_file, relative

#: how an image's numbers become a wind: the number that is calm, and the factor
WIND_VALUES = {
    "PLAIN": ("Plain", "1 is the wind speed, 0 is calm, as in float images", 0.0, 1.0),
    "CENTRED": (
        "Around Grey", "Half grey is calm, 0 and 1 are the wind speed in either direction, as in painted "
            "images",
        0.5, 2.0,
    ),
}  # fmt: skip

_SINGLE = ("FILE", "GENERATED")
# interval in s at which the texels of an image being painted are compared
_LOOK = 0.25


class ImageSource(NamedTuple):
    """An image that gives numbers, and which of its channels are meant: "" for R, G, B or grey."""

    image: bpy.types.Image
    channels: str = ""


class _Known(NamedTuple):
    """What an image was like, the hash of its raster, a sum of its texels while they are unsaved, and when it
    was seen."""

    likeness: Hashable
    raster: str
    sum: int
    seen: float


# What is known of images, by their session uid, the number of channels and their names. Their rasters are in
# the memory of all, by their hash.
_known: dict[tuple[int, int, str], _Known] = {}
_RASTERS = "images"


def forget_all() -> None:
    """Take no image's texels for granted: a file was opened, or a step undone."""
    _known.clear()


def forget(image: bpy.types.Image) -> None:
    """The image has changed."""
    for key in [key for key in _known if key[0] == image.session_uid]:
        del _known[key]


def source_of(group: bpy.types.PropertyGroup) -> ImageSource | None:
    """What is chosen in properties `image` and `image_channels`, if something is."""
    if group.image is None:
        return None
    # the choice may be of an image that was there before
    return ImageSource(group.image, group.image_channels if has_named_channels(group.image) else "")


def choose(group: bpy.types.PropertyGroup, source: ImageSource) -> None:
    """Set these properties."""
    group.image_channels = source.channels
    group.image = source.image


def has_named_channels(image: bpy.types.Image) -> bool:
    """Whether it is an EXR image, whose channels may be chosen."""
    if image.source != "FILE" or image.size is None:  # its size makes Blender look what it is
        return False
    return image.type == "MULTILAYER" or image.file_format == "OPEN_EXR"


def channel_names(image: bpy.types.Image) -> tuple[str, ...]:
    """The channels that its file has; none for other files than EXR images."""
    with _opened_file(image) as stream, contextlib.suppress(UnusableError):
        if stream is not None and exr_images.is_exr(stream):
            return exr_images.channel_names(stream)
    return ()


def raster_of(source: ImageSource, channels: int) -> Raster:
    """The image's numbers: 1 channel of a colour image is its luminance, otherwise the first so many.

    Read anew only where the image has changed: painting and reloading are seen, by Blender's own notes and,
    while changes are unsaved, by the texels.

    Raises ParameterError, naming it, for an image that is missing, too large, constant where it should hold
    waves, or not finite.
    """
    image, names = source
    key, likeness = (image.session_uid, channels, names), _likeness(image)
    known = _known.get(key)
    before = None if known is None or known.likeness != likeness else MEMO.find(_RASTERS, known.raster)
    if before is not None and not _is_painted(image, known):
        return before
    if not image.is_dirty:
        raster, summed = _saved_raster(image, channels, names), 0
    else:
        texels = _texels(image)
        summed = _sum(texels)
        is_same = before is not None and known.sum == summed
        raster = before if is_same else _painted_raster(image, texels, channels, names)
    _known[key] = _Known(likeness, raster.sha256, summed, time.monotonic())
    return MEMO.get(_RASTERS, raster.sha256, lambda: raster)


def source_with(raster: Raster, candidates: Iterable[ImageSource]) -> ImageSource:
    """What among the candidates gives this raster, or else a new image, packed into the file.

    An image of the file by the raster's name is a candidate too.
    """
    named = bpy.data.images.get(raster.name) if raster.name else None
    for source in (*candidates, *([ImageSource(named)] if named is not None else [])):
        try:
            if raster_of(source, raster.shape[2]) == raster:
                return source
        except ParameterError:
            continue
    return ImageSource(_new_image(raster))


def open_image(path: Path, channels: int, names: str = "", axes: str = "") -> Raster:
    """The raster of a file, which becomes an image of this .blend file; arrays and chosen channels do not.

    Raises ParameterError, naming the file.
    """
    if path.suffix.lower() == ".npy" or names or axes:
        return read_raster(path, channels, names, axes)
    try:
        image = bpy.data.images.load(relative(path), check_existing=True)
    except RuntimeError:
        raise ParameterError("file", str(path), "cannot be read as an image") from None
    if image.users == 0:  # otherwise something else shows it in its colours
        mark_as_data(image)
    try:
        return raster_of(ImageSource(image), channels)
    except ParameterError:
        if image.users == 0:
            bpy.data.images.remove(image)
        raise


@remembered("wind rasters")
def wind_raster(raster: Raster, values: str, speed: float) -> Raster:
    """Vectors in m/s from an image's numbers.

    values : a key of WIND_VALUES
    speed : m/s
    """
    _, _, calm, factor = WIND_VALUES[values]
    if calm == 0.0 and factor * speed == 1.0:
        return raster
    return Raster((raster.values.astype(np.float64) - calm) * (factor * speed), raster.name)


@remembered("layers")
def made_layer(kind: type, values: tuple[tuple[str, Hashable], ...]) -> object:
    """A layer of the parameters, made once: to check its rasters takes longer than a frame may.

    Raises ParameterError for values that are none.
    """
    return kind(**dict(values))


def _likeness(image: bpy.types.Image) -> Hashable:
    if image.source not in _SINGLE:
        raise ParameterError("image", image.name, "must be a single image, not a movie, sequence or tiles")
    space = image.colorspace_settings
    return *image.size, image.source, image.filepath, image.is_float, space.name, space.is_data


def _is_painted(image: bpy.types.Image, known: _Known) -> bool:
    """Whether to look at the texels of an image with unsaved changes; in a window not for each frame."""
    if not image.is_dirty:
        return known.sum != 0
    return bpy.app.background or time.monotonic() - known.seen > _LOOK


def _sum(texels: NDArray[np.float32]) -> int:
    return zlib.crc32(texels) or 1


@contextlib.contextmanager
def _opened_file(image: bpy.types.Image) -> Iterator[BinaryIO | None]:
    """The bytes of an image's file, packed or on disk; None where there are none."""
    with contextlib.ExitStack() as stack:
        stream: BinaryIO | None = None
        if image.source == "FILE" and image.packed_file is not None:
            stream = io.BytesIO(image.packed_file.data)
        elif image.source == "FILE":
            with contextlib.suppress(UnusableError):
                stream = stack.enter_context(opened(image_file(image)))
        yield stream


def _saved_raster(image: bpy.types.Image, channels: int, names: str) -> Raster:
    """Of an image without unsaved changes: by its file where Blender would give other numbers."""
    with _opened_file(image) as stream:
        try:
            if stream is not None and exr_images.is_exr(stream):
                return raster_in(stream, image.name, channels, names)
            if stream is not None and tiff.is_tiff(stream):
                tiff.number_kind(stream)
        except UnusableError as error:
            raise _refused(image, str(error)) from None
    if has_named_channels(image):
        raise _unreadable(image)
    return _raster(_texels(image), image.name, channels, names)


def _painted_raster(image: bpy.types.Image, texels: NDArray[np.float32], channels: int, names: str) -> Raster:
    """Of an image with unsaved changes: as Blender has it, but where its file says that this lies."""
    with _opened_file(image) as stream:
        try:
            if stream is not None and exr_images.is_exr(stream):
                texels = exr_images.in_image(stream, texels)
        except UnusableError as error:
            raise _refused(image, str(error)) from None
    return _raster(texels, image.name, channels, names)


def _refused(image: bpy.types.Image, reason: str) -> ParameterError:
    return ParameterError("image", image.name, reason)


def _unreadable(image: bpy.types.Image) -> ParameterError:
    return _refused(image, f"its file cannot be read: {image.filepath or 'it has none'}")


def _texels(image: bpy.types.Image) -> NDArray[np.float32]:
    """(rows, columns, channels), the bottom row first."""
    columns, rows = image.size
    if not (columns and rows):
        raise _unreadable(image)
    if max(columns, rows) > LARGEST_SIDE:
        raise _refused(image, f"has {columns} x {rows} samples: make it at most {LARGEST_SIDE} a side")
    texels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(texels)
    if not texels.size:
        raise _unreadable(image)
    return texels.reshape(rows, columns, -1)


def _raster(texels: NDArray[np.float32], name: str, channels: int, names: str) -> Raster:
    if names:
        raise ParameterError("image", name, f"has no channels with names such as {names!r}")
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
        raster.name or "Image", columns, rows, alpha=False, float_buffer=True, is_data=True
    )
    mark_as_data(image)
    texels = np.zeros((rows, columns, 4), np.float32)
    texels[..., : 3 if channels == 1 else channels] = raster.values
    texels[..., 3] = 1.0
    image.pixels.foreach_set(texels.reshape(-1))
    image.update()
    image.pack()  # otherwise neither saved with the file nor kept by undo
    return image
