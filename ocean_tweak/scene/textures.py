# SPDX-License-Identifier: GPL-3.0-or-later
"""Image textures that Displace modifiers read."""

from __future__ import annotations

from collections.abc import Sequence

import bpy


def new_texture(name: str) -> bpy.types.Texture:
    """An image texture that reads texels as they are: bilinear, repeating, not clamped."""
    texture = bpy.data.textures.new(name, "IMAGE")
    texture.extension = "REPEAT"
    texture.use_interpolation = True
    texture.use_clamp = False
    # any other size blurs or shifts the texels
    texture.filter_size = 1.0
    if hasattr(texture, "filter_type"):  # until 4.5
        texture.filter_type = "BOX"
        texture.use_mipmap = False
    return texture


def show(texture: bpy.types.Texture, image: bpy.types.Image, frames: Sequence[int] | None) -> None:
    """Let a texture read an image; `frames` are those that a sequence has, ascending and without a gap."""
    assign(texture, image=image)
    if frames is None:
        return
    first, last = frames[0], frames[-1]
    # File number = frame_offset + frame - frame_start + 1, and what is added to the offset is held between
    # 0 and the duration. To begin at 0 rather than 1 holds the first frame too; a single file has no 0.
    begin = 0 if last > first else 1
    assign(
        texture.image_user,
        frame_start=first + 1 - begin, frame_offset=first - begin, frame_duration=last - first + begin,
        use_auto_refresh=True, use_cyclic=False,
    )  # fmt: skip
    texture.update_tag()


def assign(item: bpy.types.bpy_struct, **values: object) -> None:
    """Set what differs: a value set again would tag the object for evaluation on every frame."""
    for name, value in values.items():
        if getattr(item, name) != value:
            setattr(item, name, value)
