# SPDX-License-Identifier: GPL-3.0-or-later
"""The one image of the water material: slopes of ripples in red and green, the lace of foam in blue."""

from __future__ import annotations

import bpy
import numpy as np

from ..core.surface_detail import foam_lace, ripple_slopes

_KEY = "ocean_tweak_detail"
_VERSION = 1
RESOLUTION = 512


def detail_image() -> bpy.types.Image:
    """The image, packed into the file; made when the file has none."""
    for image in bpy.data.images:
        if image.library is None and image.get(_KEY) == _VERSION:
            return image
    image = bpy.data.images.new(
        "Ocean Tweak Detail", RESOLUTION, RESOLUTION, alpha=False, float_buffer=True, is_data=True
    )
    pixels = np.ones((RESOLUTION, RESOLUTION, 4), np.float32)
    pixels[..., :2] = np.moveaxis(ripple_slopes(RESOLUTION), 0, -1)
    pixels[..., 2] = foam_lace(RESOLUTION)
    image.pixels.foreach_set(pixels.reshape(-1))
    image.update()
    image.pack()
    image[_KEY] = _VERSION
    return image
