# SPDX-License-Identifier: GPL-3.0-or-later
"""Panoramas of skies, HDR or EXR images all around: measured before Blender loads them, and their horizon."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import BinaryIO

import bpy
import numpy as np

from ..core.numerics.machine import usable_memory
from ..export.images import exr_images
from ..export.images.checks import UnusableError, opened
from .sky import Colour
from .stored_paths import image_file

_BYTES = 16  # a pixel of four floats
_SHARE = 0.5  # of the memory, at most
_HEADER = 4096  # bytes of a Radiance file in which its size stands
_RESOLUTION = re.compile(rb"^[-+]Y (\d+) [-+]X (\d+)\s*$", re.MULTILINE)
#: pixels of the small copy in which the horizon is looked up
_COLUMNS, _ROWS = 64, 32


class PanoramaError(ValueError):
    """A panorama that cannot be used: which, why, and what to do."""


def check(path: Path) -> None:
    """Raise PanoramaError for a file that is missing, no HDR or EXR image, or too large for the memory."""
    try:
        with opened(path) as stream:
            columns, rows = _size(stream)
    except UnusableError as error:
        raise PanoramaError(f"{path.name} {error}. Looked in {path.parent}") from None
    memory, need = usable_memory(), columns * rows * _BYTES
    if memory is not None and need > _SHARE * memory:
        fitting = math.sqrt(_SHARE * memory / _BYTES / 2.0) * 2.0
        raise PanoramaError(
            f"{path.name} has {columns} x {rows} pixels, {need / 2**30:.1f} GB of the machine's "
            f"{memory / 2**30:.1f} GB: scale it to a width of at most {int(fitting)}"
        )


def check_image(image: bpy.types.Image) -> None:
    """As `check`, of the file of an image; one that is packed is there."""
    if image.packed_file is None:
        check(image_file(image))


def horizon(image: bpy.types.Image, azimuth: float, strength: float) -> Colour:
    """Radiance just above the horizon of a panorama, towards an azimuth in rad in its own space."""
    small = image.copy()
    try:
        small.scale(_COLUMNS, _ROWS)
        texels = np.empty(4 * _COLUMNS * _ROWS, np.float32)
        small.pixels.foreach_get(texels)
    finally:
        bpy.data.images.remove(small)
    row = texels.reshape(_ROWS, _COLUMNS, 4)[_ROWS // 2, :, :3]
    # Blender's panoramas have +x in their middle, and +y to the left of it
    column = int((0.5 - azimuth / (2.0 * math.pi)) * _COLUMNS)
    near = row[np.arange(column - 2, column + 3) % _COLUMNS].mean(axis=0)
    return tuple(strength * float(part) for part in near)


def _size(stream: BinaryIO) -> tuple[int, int]:
    """Columns and rows that a file's header says. Raises UnusableError."""
    if exr_images.is_exr(stream):
        return exr_images.size(stream)
    stream.seek(0)
    header = stream.read(_HEADER)
    found = _RESOLUTION.search(header) if header.startswith(b"#?") else None
    if found is None:
        raise UnusableError("is no Radiance (.hdr) or EXR image: choose one of these")
    rows, columns = (int(number) for number in found.groups())
    return columns, rows
