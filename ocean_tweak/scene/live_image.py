# SPDX-License-Identifier: GPL-3.0-or-later
"""Generated float images with a map of a sea: displacement, foam, normals or velocity."""

from __future__ import annotations

from collections.abc import Hashable

import bpy
import numpy as np
from numpy.typing import NDArray


def new_image(name: str, samples: int) -> bpy.types.Image:
    """A float image of samples x samples texels, data rather than colour."""
    image = bpy.data.images.new(name, samples, samples, alpha=False, float_buffer=True, is_data=True)
    mark_as_data(image)
    return image


def mark_as_data(image: bpy.types.Image) -> None:
    """Keep Blender from converting the image's values.

    Sets `is_data` instead of a colour space by name, as a studio's OCIO configuration may lack "Non-Color".
    """
    image.colorspace_settings.is_data = True
    image.alpha_mode = "NONE"


def prepare(image: bpy.types.Image, samples: int) -> None:
    """Resize the image to samples x samples texels, keeping its users."""
    if image.source != "GENERATED":
        # it was packed when Blender quit with "save modified images"
        if image.packed_file is not None:
            image.unpack(method="REMOVE")
        image.source = "GENERATED"
        image.use_generated_float = True
        mark_as_data(image)
    if tuple(image.size) != (samples, samples):
        image.generated_width = image.generated_height = samples


# What images show, by their session uid; forgotten whenever Blender may have dropped the texels
_shown: dict[int, Hashable] = {}


def shows(image: bpy.types.Image, content: Hashable) -> bool:
    """Whether this content was last written to the image."""
    return _shown.get(image.session_uid) == content and image.source == "GENERATED"


def forget_all() -> None:
    """Forget the contents of all images: a file was opened, or a step undone."""
    _shown.clear()


def write(image: bpy.types.Image, field: NDArray[np.floating], content: Hashable = None) -> None:
    """Put an (N, N, 3) field [y, x] into the image; row 0 is the bottom row in both.

    content : for `shows`
    """
    _shown[image.session_uid] = content
    texels = np.empty((*field.shape[:2], 4), np.float32)
    texels[..., :3] = field
    texels[..., 3] = 1.0
    image.pixels.foreach_set(texels.reshape(-1))
    # without the tag the dependency graph does not see the new texels
    image.update_tag()
