# SPDX-License-Identifier: GPL-3.0-or-later
"""The modifier that moves the grid by an image: Displace or geometry nodes.

Both read the same image and give the same vertices.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from ..nodes.displace import DISPLACE, UV_MAP
from ..nodes.modifier_inputs import set_input
from ..nodes.versioned import is_of_kind, node_group

_NAME = "Ocean Tweak"


@dataclass(frozen=True)
class Displacement:
    """What a modifier has to show.

    image : metres
    frames : first and last file number of a sequence, None for a live image
    size : side of the patch in Blender units
    samples : along each side of the image
    scale : Blender units in a metre
    """

    image: bpy.types.Image
    frames: tuple[int, int] | None
    size: float
    samples: int
    scale: float


def own_modifiers(item: bpy.types.Object, texture: bpy.types.Texture | None) -> list[bpy.types.Modifier]:
    """The object's modifiers that this module made, whatever they are called now."""
    return [
        modifier
        for modifier in item.modifiers
        if (modifier.type == "NODES" and is_of_kind(modifier.node_group, DISPLACE))
        or (modifier.type == "DISPLACE" and texture is not None and modifier.texture == texture)
    ]


def apply_displace(item: bpy.types.Object, texture: bpy.types.Texture, shown: Displacement) -> None:
    """Let a Displace modifier with this texture move the object; geometry nodes of ours go."""
    modifier = _only_modifier(item, texture, "DISPLACE")
    if texture.image != shown.image:
        # whether the modifier depends on time is found out only when its texture is assigned
        modifier.texture = None
    _set_texture(texture, shown)
    _assign(
        modifier,
        texture=texture, direction="RGB_TO_XYZ", space="LOCAL", mid_level=0.0, strength=shown.scale,
        texture_coords="UV", uv_layer=UV_MAP,
    )  # fmt: skip


def apply_nodes(item: bpy.types.Object, texture: bpy.types.Texture | None, shown: Displacement) -> None:
    """Let geometry nodes move the object; a Displace modifier of ours goes."""
    modifier = _only_modifier(item, texture, "NODES")
    _assign(modifier, node_group=node_group(DISPLACE))
    first, last = shown.frames or (1, 1)
    for name, value in (
        ("Image", shown.image),
        ("Domain Size", shown.size),
        ("Resolution", shown.samples),
        ("Scale", shown.scale),
        ("First Frame", first),
        ("Last Frame", last),
    ):
        set_input(modifier, name, value)
    item.update_tag()


def _only_modifier(
    item: bpy.types.Object, texture: bpy.types.Texture | None, kind: str
) -> bpy.types.Modifier:
    """The object's one modifier of ours, of this kind, at the place in the stack where ours was."""
    own = own_modifiers(item, texture)
    kept = next((modifier for modifier in own if modifier.type == kind), None)
    place = min((list(item.modifiers).index(modifier) for modifier in own), default=0)
    for name in [modifier.name for modifier in own if modifier != kept]:
        item.modifiers.remove(item.modifiers[name])
    if kept is not None:
        return kept
    item.modifiers.new(_NAME, kind)
    item.modifiers.move(len(item.modifiers) - 1, place)
    # moving a modifier makes the reference to it stale
    return item.modifiers[place]


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


def _set_texture(texture: bpy.types.Texture, shown: Displacement) -> None:
    _assign(texture, image=shown.image)
    if shown.frames is None:
        return
    first, last = shown.frames
    # file number = frame - frame_start + 1 + frame_offset: with both set it is the frame itself
    _assign(
        texture.image_user,
        frame_start=first, frame_offset=first - 1, frame_duration=last - first + 1,
        use_auto_refresh=True, use_cyclic=False,
    )  # fmt: skip
    texture.update_tag()


def _assign(item: bpy.types.bpy_struct, **values: object) -> None:
    """Set what differs: a value set again would tag the object for evaluation on every frame."""
    for name, value in values.items():
        if getattr(item, name) != value:
            setattr(item, name, value)
