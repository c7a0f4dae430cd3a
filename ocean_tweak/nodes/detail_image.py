# SPDX-License-Identifier: GPL-3.0-or-later
"""The images of the water material, packed into the file: what is finer than any grid, and gusts of wind."""

from __future__ import annotations

from collections.abc import Callable

import bpy
import numpy as np
from numpy.typing import NDArray

from .surface_detail import foam_lace, gusts, ripple_slopes

_KEY = "ocean_tweak_image"
_RESOLUTION = 512
_GUST_RESOLUTION = 128


def detail_image() -> bpy.types.Image:
    """Slopes of ripples in red and green, the lace of foam in blue."""
    return _image("Ocean Tweak Detail", 1, _detail)


def gust_image() -> bpy.types.Image:
    """Where gusts ruffle the water, evenly distributed over 0…1, in all channels."""
    return _image("Ocean Tweak Gusts", 1, _gusts)


def _detail() -> NDArray[np.float32]:
    pixels = np.ones((_RESOLUTION, _RESOLUTION, 4), np.float32)
    pixels[..., :2] = np.moveaxis(ripple_slopes(_RESOLUTION), 0, -1)
    pixels[..., 2] = foam_lace(_RESOLUTION)
    return pixels


def _gusts() -> NDArray[np.float32]:
    pixels = np.ones((_GUST_RESOLUTION, _GUST_RESOLUTION, 4), np.float32)
    pixels[..., :3] = gusts(_GUST_RESOLUTION)[..., np.newaxis]
    return pixels


def _image(name: str, version: int, make: Callable[[], NDArray[np.float32]]) -> bpy.types.Image:
    """The file's image of this name and version; made when it has none."""
    tag = f"{name} {version}"
    for image in bpy.data.images:
        if image.library is None and image.get(_KEY) == tag:
            return image
    pixels = make()
    side = len(pixels)
    image = bpy.data.images.new(name, side, side, alpha=False, float_buffer=True, is_data=True)
    image.pixels.foreach_set(pixels.reshape(-1))
    image.update()
    image.pack()
    image[_KEY] = tag
    return image
