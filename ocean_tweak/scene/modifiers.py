# SPDX-License-Identifier: GPL-3.0-or-later
"""The modifiers that move the grid: geometry nodes, or Displace with a finer grid and image for renders.

All give the same vertices.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from ..nodes.displace import DISPLACE
from ..nodes.grid import GRID, UV_MAP
from ..nodes.modifier_inputs import set_input
from ..nodes.versioned import is_of_kind, node_group
from .grid_mesh import Grid

_NAMES = {"NODES": "Ocean Tweak", "VIEW": "Ocean Tweak", "GRID": "Ocean Tweak Render Grid"}
_NAMES["RENDER"] = "Ocean Tweak Render"
_TYPES = {"NODES": "NODES", "VIEW": "DISPLACE", "GRID": "NODES", "RENDER": "DISPLACE"}


@dataclass(frozen=True)
class Displacement:
    """What the modifiers have to show.

    image : metres; None where the mesh's attribute has the displacement
    frames : first and last file number of a sequence, None for a live image
    grid : the mesh and the samples of the image
    render_image, render_grid : what a render reads instead; None where it shows what the viewport shows
    scale : Blender units in a metre
    """

    image: bpy.types.Image | None
    frames: tuple[int, int] | None
    grid: Grid
    render_image: bpy.types.Image | None
    render_grid: Grid | None
    scale: float


@dataclass(frozen=True)
class Textures:
    """Those of an ocean's Displace modifiers, by which they are recognised."""

    view: bpy.types.Texture | None
    render: bpy.types.Texture | None


def own_modifiers(item: bpy.types.Object, textures: Textures) -> list[tuple[str, bpy.types.Modifier]]:
    """The object's modifiers that this module made and what each is for, whatever they are called now."""
    purposes = [(_purpose(modifier, textures), modifier) for modifier in item.modifiers]
    return [(purpose, modifier) for purpose, modifier in purposes if purpose is not None]


def _purpose(modifier: bpy.types.Modifier, textures: Textures) -> str | None:
    if modifier.type == "NODES":
        kinds = {"NODES": DISPLACE, "GRID": GRID}
        return next((key for key, kind in kinds.items() if is_of_kind(modifier.node_group, kind)), None)
    if modifier.type == "DISPLACE" and modifier.texture is not None:
        if modifier.texture == textures.view:
            return "VIEW"
        if modifier.texture == textures.render:
            return "RENDER"
    return None


def apply_nodes(item: bpy.types.Object, textures: Textures, shown: Displacement) -> None:
    """Let geometry nodes move the object; Displace modifiers of ours go."""
    modifier = _only_modifiers(item, textures, ["NODES"])["NODES"]
    _assign(modifier, node_group=node_group(DISPLACE))
    first, last = shown.frames or (1, 1)
    render = shown.render_grid
    for name, value in (
        ("Use Attribute", shown.image is None),
        ("Image", shown.image),
        ("Domain Size", shown.grid.size),
        ("Resolution", shown.grid.samples),
        ("Scale", shown.scale),
        ("First Frame", first),
        ("Last Frame", last),
        ("Render Quads", render.quads if render else 0),
        ("Render Image", shown.render_image),
        ("Render Resolution", render.samples if render else shown.grid.samples),
    ):
        set_input(modifier, name, value)
    item.update_tag()


def apply_displace(item: bpy.types.Object, textures: Textures, shown: Displacement) -> None:
    """Let Displace modifiers with these textures move the object; geometry nodes of ours go."""
    purposes = ["VIEW"]
    if shown.render_grid is not None:
        # a baked sequence moves either grid, so the grid comes before
        purposes = ["GRID", "VIEW"] if shown.render_image == shown.image else ["GRID", "VIEW", "RENDER"]
    had = {purpose for purpose, _ in own_modifiers(item, textures)}
    made = _only_modifiers(item, textures, purposes)
    if ("RENDER" in made) != ("RENDER" in had):  # otherwise it is the user's to switch
        made["VIEW"].show_render = "RENDER" not in made
    if "GRID" in made:
        _apply_grid(made["GRID"], shown.render_grid, is_new="GRID" not in had)
    _apply_texture(made["VIEW"], textures.view, shown.image, shown)
    if "RENDER" in made:
        if "RENDER" not in had:
            made["RENDER"].show_viewport = False
        _apply_texture(made["RENDER"], textures.render, shown.render_image, shown)


def _apply_grid(modifier: bpy.types.NodesModifier, grid: Grid, is_new: bool) -> None:
    if is_new:
        modifier.show_viewport = False
    _assign(modifier, node_group=node_group(GRID))
    for name, value in (("Size", grid.size), ("Quads", grid.quads), ("Samples", grid.samples)):
        set_input(modifier, name, value)


def _apply_texture(
    modifier: bpy.types.DisplaceModifier,
    texture: bpy.types.Texture,
    image: bpy.types.Image,
    shown: Displacement,
) -> None:
    if texture.image != image:
        # whether the modifier depends on time is found out only when its texture is assigned
        modifier.texture = None
    _set_texture(texture, image, shown.frames)
    _assign(
        modifier,
        texture=texture, direction="RGB_TO_XYZ", space="LOCAL", mid_level=0.0, strength=shown.scale,
        texture_coords="UV", uv_layer=UV_MAP,
    )  # fmt: skip


def _only_modifiers(
    item: bpy.types.Object, textures: Textures, purposes: list[str]
) -> dict[str, bpy.types.Modifier]:
    """The object's modifiers of ours for these purposes, at the place in the stack where ours were."""
    own = own_modifiers(item, textures)
    place = min((list(item.modifiers).index(modifier) for _, modifier in own), default=0)
    names: dict[str, str] = {}
    for purpose, modifier in own:
        if purpose in purposes and purpose not in names:
            names[purpose] = modifier.name
    for name in [modifier.name for _, modifier in own if modifier.name not in names.values()]:
        item.modifiers.remove(item.modifiers[name])
    for purpose in purposes:
        if purpose in names:
            place = item.modifiers.find(names[purpose]) + 1
            continue
        names[purpose] = _new_modifier(item, purpose, place)
        place += 1
    # by name: adding and moving modifiers makes references to them stale
    return {purpose: item.modifiers[name] for purpose, name in names.items()}


def _new_modifier(item: bpy.types.Object, purpose: str, place: int) -> str:
    modifier = item.modifiers.new(_NAMES[purpose], _TYPES[purpose])
    if purpose == "GRID":  # recognised by its group from now on
        modifier.node_group = node_group(GRID)
    name = modifier.name
    item.modifiers.move(len(item.modifiers) - 1, place)
    return name


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


def _set_texture(texture: bpy.types.Texture, image: bpy.types.Image, frames: tuple[int, int] | None) -> None:
    _assign(texture, image=image)
    if frames is None:
        return
    first, last = frames
    # File number = frame_offset + frame - frame_start + 1, and what is added to the offset is held between
    # 0 and the duration. To begin at 0 rather than 1 holds the first frame too; a single file has no 0.
    begin = 0 if last > first else 1
    _assign(
        texture.image_user,
        frame_start=first + 1 - begin, frame_offset=first - begin, frame_duration=last - first + begin,
        use_auto_refresh=True, use_cyclic=False,
    )  # fmt: skip
    texture.update_tag()


def _assign(item: bpy.types.bpy_struct, **values: object) -> None:
    """Set what differs: a value set again would tag the object for evaluation on every frame."""
    for name, value in values.items():
        if getattr(item, name) != value:
            setattr(item, name, value)
