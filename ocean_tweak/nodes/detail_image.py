# SPDX-License-Identifier: GPL-3.0-or-later
"""The images of the water material, packed into the file: what is finer than any grid, and gusts of wind.

They hold weights of cubic B-splines, which both engines draw alike. With any other interpolation EEVEE
averages the pattern of far water before the shader has made foam of it, and Cycles does not.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.numerics.rounding import rounded
from .surface_detail import foam_lace, gradient, gusts, ripple_slopes, spline_weights

_KEY = "ocean_tweak_image"
_RESOLUTION = 512
_GUST_RESOLUTION = 128
#: of the root mean square: fewer digits than a float has, and the image takes a third of the room in a file
_PRECISION = 1.0 / 64.0


def ripple_image() -> bpy.types.Image:
    """Slopes of ripples in red and green."""
    return _image("Ocean Tweak Ripples", 1, lambda: ripple_slopes(_RESOLUTION))


def lace_image() -> bpy.types.Image:
    """The lace of foam in red, and in green and blue how it changes along x and y over a whole side."""
    return _image("Ocean Tweak Lace", 2, _lace)


def gust_image() -> bpy.types.Image:
    """Where gusts ruffle the water, in red, evenly distributed over 0…1."""
    return _image("Ocean Tweak Gusts", 2, lambda: [gusts(_GUST_RESOLUTION)])


def _lace() -> Iterable[NDArray[np.float64]]:
    lace = foam_lace(_RESOLUTION)
    return lace, *gradient(lace)


def _image(name: str, version: int, make: Callable[[], Iterable[NDArray[np.float64]]]) -> bpy.types.Image:
    """The file's image of this name and version; made when it has none."""
    tag = f"{name} {version}"
    for image in bpy.data.images:
        if image.library is None and image.get(_KEY) == tag:
            return image
    channels = [rounded(spline_weights(field), _PRECISION) for field in make()]
    side = len(channels[0])
    pixels = np.zeros((side, side, 4), np.float32)
    pixels[..., 3] = 1.0
    pixels[..., : len(channels)] = np.stack(channels, axis=-1)
    image = bpy.data.images.new(name, side, side, alpha=False, float_buffer=True, is_data=True)
    image.pixels.foreach_set(pixels.reshape(-1))
    image.update()
    image.pack()
    image[_KEY] = tag
    return image
