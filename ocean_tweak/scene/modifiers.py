# SPDX-License-Identifier: GPL-3.0-or-later
"""The modifiers that move the grid: geometry nodes, or Displace and nodes that write what shots read.

If a render is finer than the viewport, it has modifiers of its own. All methods give the same vertices and
attributes. Displace reads image textures.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import bpy

from ..core.synthesis.channels import MOVING_MAP
from ..nodes.grid import GRID
from ..nodes.modifier_inputs import get_input, set_inputs
from ..nodes.names import MAP_INPUTS, TEXTURE_COORDINATES
from ..nodes.ocean import ocean_group
from ..nodes.shown_frame import frame_values
from ..nodes.versioned import is_of_kind, node_group
from .grid_mesh import Grid

Images = Mapping[str, bpy.types.Image]

OCEAN = ocean_group(1)

#: purpose of a modifier → its name and type
_PURPOSES = {
    "NODES": ("Ocean Tweak", "NODES"),
    "NODES_RENDER": ("Ocean Tweak Render", "NODES"),
    "GRID": ("Ocean Tweak Render Grid", "NODES"),
    "VIEW": ("Ocean Tweak", "DISPLACE"),
    "RENDER": ("Ocean Tweak Render", "DISPLACE"),
    "MAPS": ("Ocean Tweak Maps", "NODES"),
    "MAPS_RENDER": ("Ocean Tweak Render Maps", "NODES"),
}
#: purpose in the viewport → its counterpart in renders
_IN_RENDER = {"NODES": "NODES_RENDER", "VIEW": "RENDER", "MAPS": "MAPS_RENDER"}


@dataclass(frozen=True)
class Shown:
    """Input of the modifiers.

    images : by map; None if the surface is in the mesh's attributes
    frames : of a sequence, ascending; None for live images
    grid : of the mesh, with the samples of the images
    render_images, render_grid : the same for renders; None if they use the viewport's
    scale : Blender units per metre
    velocity_scale : Blender units per second per m/s of the velocity image
    warn : warn about frames without a file
    early_images : by map, for frames before 0
    files_per_frame : files of a sequence per frame of the animation
    seconds_per_file : scene time from one file to the next; 0 for live images
    """

    images: Images | None
    frames: tuple[int, ...] | None
    grid: Grid
    render_images: Images | None
    render_grid: Grid | None
    scale: float
    velocity_scale: float
    warn: bool
    early_images: Images | None = None
    files_per_frame: float = 1.0
    seconds_per_file: float = 0.0

    @property
    def render_is_alike(self) -> bool:
        """Whether renders read the same images, on their own grid."""
        return self.render_images == self.images

    @property
    def suits_displace(self) -> bool:
        """Whether a Displace modifier can show it: it only supports an offset and a length of a sequence, and
        frames from 0 upwards."""
        frames = self.frames
        if frames is None:
            return True
        is_whole = 1 < len(frames) == frames[-1] - frames[0] + 1
        return is_whole and frames[0] >= 0 and self.files_per_frame == 1.0


@dataclass(frozen=True)
class Textures:
    """The textures of an ocean's Displace modifiers, by which these are recognised."""

    view: bpy.types.Texture | None
    render: bpy.types.Texture | None


def own_modifiers(item: bpy.types.Object, textures: Textures) -> list[tuple[str, bpy.types.Modifier]]:
    """The object's modifiers created by this module, with their purposes, whatever their present names."""
    purposes = [(_purpose(modifier, textures), modifier) for modifier in item.modifiers]
    return [(purpose, modifier) for purpose, modifier in purposes if purpose is not None]


def is_moved(item: bpy.types.Object, textures: Textures) -> bool:
    """Whether the object has our modifier that moves it in the viewport."""
    return any(_purpose(modifier, textures) in ("NODES", "VIEW") for modifier in item.modifiers)


def remove_own(item: bpy.types.Object, textures: Textures) -> None:
    """Remove our modifiers, except those of a library."""
    own = own_modifiers(item, textures)
    for name in [modifier.name for _, modifier in own if not is_of_library(modifier)]:
        item.modifiers.remove(item.modifiers[name])


def _purpose(modifier: bpy.types.Modifier, textures: Textures) -> str | None:
    if modifier.type == "NODES":
        if is_of_kind(modifier.node_group, GRID):
            return "GRID"
        if is_of_kind(modifier.node_group, OCEAN):
            purpose = _given_purpose(modifier)
            return purpose if purpose in _PURPOSES else None
    if modifier.type == "DISPLACE" and modifier.texture is not None:
        if modifier.texture == textures.view:
            return "VIEW"
        if modifier.texture == textures.render:
            return "RENDER"
    return None


def _given_purpose(modifier: bpy.types.NodesModifier) -> str | None:
    try:
        return get_input(modifier, "Purpose")
    except KeyError:  # a group that was modified
        return None


def apply_nodes(item: bpy.types.Object, textures: Textures, shown: Shown) -> None:
    """Move the object by geometry nodes, and remove our Displace modifiers."""
    purposes = ["NODES"] if shown.render_grid is None else ["NODES", "NODES_RENDER"]
    made = _only_modifiers(item, textures, purposes)
    _set_group(made["NODES"], _sea_inputs(shown))
    if "NODES_RENDER" in made:
        _set_group(made["NODES_RENDER"], {**_render_inputs(shown), **_grid_inputs(shown.render_grid)})
    item.update_tag()


def apply_displace(item: bpy.types.Object, textures: Textures, shown: Shown) -> None:
    """Move the object by Displace modifiers with these textures; nodes after them write the attributes."""
    purposes = ["VIEW", "MAPS"]
    if shown.render_grid is not None:
        # a baked sequence moves either grid, so the grid comes before
        purposes = ["GRID", *purposes]
        if not shown.render_is_alike:
            purposes = ["GRID", "VIEW", "RENDER", "MAPS", "MAPS_RENDER"]
    made = _only_modifiers(item, textures, purposes)
    if "GRID" in made:
        grid = _grid_inputs(shown.render_grid)
        del grid["Make Grid"]
        values = {"Samples": shown.render_grid.samples, "Live": shown.frames is None}
        _set_group(made["GRID"], {**grid, **values})
    _set_texture(made["VIEW"], textures.view, shown.images, shown)
    behind = {"Move": False, "Displaced": True}
    _set_group(made["MAPS"], {**_sea_inputs(shown), **behind})
    if "RENDER" in made:
        _set_texture(made["RENDER"], textures.render, shown.render_images, shown)
        _set_group(made["MAPS_RENDER"], {**_render_inputs(shown), **behind})
    item.update_tag()


def tell_held_frame(item: bpy.types.Object, textures: Textures, frame: int) -> None:
    """Store the frame of the saved sea, which is shown without the extension."""
    for _, modifier in own_modifiers(item, textures):
        if modifier.type == "NODES" and is_of_kind(modifier.node_group, OCEAN):
            set_inputs(modifier, {"Held Frame": frame})


def _sea_inputs(shown: Shown) -> dict[str, Any]:
    frames = shown.frames or (1,)
    return {
        "Use Attributes": shown.images is None,
        "Live": shown.frames is None,
        "Scale": shown.scale,
        "Velocity Scale": shown.velocity_scale,
        "Warn Out of Range": shown.warn,
        "Domain Size": shown.grid.size,
        "Resolution": shown.grid.samples,
        **frame_values(frames, shown.files_per_frame, shown.seconds_per_file),
        **_image_inputs(shown.images),
        **_early_image_inputs(shown.early_images),
    }


def _render_inputs(shown: Shown) -> dict[str, Any]:
    return {
        **_sea_inputs(shown),
        "Use Attributes": False,
        "Resolution": shown.render_grid.samples,
        **_image_inputs(shown.render_images),
    }


def _image_inputs(images: Images | None) -> dict[str, bpy.types.Image | None]:
    return {socket: (images or {}).get(name) for name, socket in MAP_INPUTS.items()}


def _early_image_inputs(images: Images | None) -> dict[str, bpy.types.Image | None]:
    return {f"{socket} Before 0": image for socket, image in _image_inputs(images).items()}


def _grid_inputs(grid: Grid) -> dict[str, Any]:
    repeats_x, repeats_y = grid.repeats
    return {
        "Make Grid": True,
        "Size": grid.size,
        "Quads": grid.quads,
        "Repeats X": repeats_x,
        "Repeats Y": repeats_y,
    }


def _set_group(modifier: bpy.types.NodesModifier, values: dict[str, Any]) -> None:
    kind = GRID if is_of_kind(modifier.node_group, GRID) else OCEAN
    if modifier.node_group != node_group(kind):
        purpose = _given_purpose(modifier)
        modifier.node_group = node_group(kind)
        if kind is OCEAN:
            set_inputs(modifier, {"Purpose": purpose})
    if modifier.node_group.library is not None and values.get("Live"):
        # a linked group cannot be marked as running; this is not saved, so the sea moves as long as the
        # extension sets it
        values = {**values, "Live": False}
    set_inputs(modifier, values)


def _set_texture(
    modifier: bpy.types.DisplaceModifier, texture: bpy.types.Texture, images: Images, shown: Shown
) -> None:
    image = images[MOVING_MAP]
    if texture.image != image:
        # whether the modifier depends on time is found out only when its texture is assigned
        modifier.texture = None
    _show_image(texture, image, shown.frames)
    set_changed(
        modifier,
        texture=texture, direction="RGB_TO_XYZ", space="LOCAL", mid_level=0.0, strength=shown.scale,
        texture_coords="UV", uv_layer=TEXTURE_COORDINATES,
    )  # fmt: skip


def _only_modifiers(
    item: bpy.types.Object, textures: Textures, purposes: list[str]
) -> dict[str, bpy.types.Modifier]:
    """Our modifiers for these purposes, at their position in the stack; others of ours are removed.

    Modifiers of a library cannot be removed, and Blender loses most changes to them: others replace them.
    """
    own = own_modifiers(item, textures)
    place = min((list(item.modifiers).index(modifier) for _, modifier in own), default=0)
    for modifier in [modifier for _, modifier in own if is_of_library(modifier)]:
        set_changed(modifier, show_viewport=False, show_render=False)
        place += 1
    own = [(purpose, modifier) for purpose, modifier in own if not is_of_library(modifier)]
    # one that was replaced before the object was made local comes last
    own.sort(key=lambda each: not (each[1].show_viewport or each[1].show_render))
    names: dict[str, str] = {}
    for purpose, modifier in own:
        if purpose in purposes and purpose not in names:
            names[purpose] = modifier.name
    had = set(names) | {purpose for purpose, _ in own}
    for name in [modifier.name for _, modifier in own if modifier.name not in names.values()]:
        item.modifiers.remove(item.modifiers[name])
    for purpose in purposes:
        if purpose in names:
            place = item.modifiers.find(names[purpose]) + 1
            continue
        names[purpose] = _new_modifier(item, purpose, place)
        place += 1
    # by name: adding and moving modifiers makes references to them stale
    made = {purpose: item.modifiers[name] for purpose, name in names.items()}
    _share_out(made, had)
    return made


def is_of_library(modifier: bpy.types.Modifier) -> bool:
    """Whether a modifier of a library override comes from its library."""
    return modifier.id_data.override_library is not None and modifier.is_override_data


def _share_out(made: dict[str, bpy.types.Modifier], had: set[str]) -> None:
    """Set which modifiers the viewport and renders show, when that changes; otherwise the user may switch
    them."""
    for view, render in _IN_RENDER.items():
        if view in made and (render in made) != (render in had):
            made[view].show_render = render not in made
    for purpose in ("GRID", *_IN_RENDER.values()):
        if purpose in made and purpose not in had:
            made[purpose].show_viewport = False


def _new_modifier(item: bpy.types.Object, purpose: str, place: int) -> str:
    name, kind = _PURPOSES[purpose]
    modifier = item.modifiers.new(name, kind)
    if purpose == "GRID":  # it is recognised by its group
        modifier.node_group = node_group(GRID)
    elif kind == "NODES":
        modifier.node_group = node_group(OCEAN)
        set_inputs(modifier, {"Purpose": purpose})
    name = modifier.name
    item.modifiers.move(len(item.modifiers) - 1, place)
    return name


def new_texture(name: str) -> bpy.types.Texture:
    """An image texture without filtering: bilinear, repeating, not clamped."""
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


def _show_image(texture: bpy.types.Texture, image: bpy.types.Image, frames: Sequence[int] | None) -> None:
    """Set a texture's image; `frames` are those of a sequence, ascending and without gaps."""
    set_changed(texture, image=image)
    if frames is None:
        return
    first, last = frames[0], frames[-1]
    # File number = frame_offset + frame - frame_start + 1, and what is added to the offset is held between
    # 0 and the duration. To begin at 0 rather than 1 holds the first frame too; a single file has no 0.
    begin = 0 if last > first else 1
    set_changed(
        texture.image_user,
        frame_start=first + 1 - begin, frame_offset=first - begin, frame_duration=last - first + begin,
        use_auto_refresh=True, use_cyclic=False,
    )  # fmt: skip
    texture.update_tag()


def set_changed(target: object, **values: object) -> None:
    """Set properties that differ, as setting one marks the file as changed and its owner for evaluation."""
    for name, value in values.items():
        if getattr(target, name) != value:
            setattr(target, name, value)
