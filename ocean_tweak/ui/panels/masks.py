# SPDX-License-Identifier: GPL-3.0-or-later
"""A mask's settings, in the panels of what it masks."""

import bpy

from ...scene import mask_following, source_images
from ..field_drawing import draw_fields
from ..mask_operators import ACTIVE_LAYER, WHOLE_SEA, OCEAN_OT_read_weights
from .drawing import SubPanel, active_settings, message, split


def draw_mask(
    layout: bpy.types.UILayout,
    context: bpy.types.Context,
    group: bpy.types.PropertyGroup,
    patch: int = ACTIVE_LAYER,
) -> None:
    """Draw a mask's settings, and what it lacks: without that the whole sea stands still.

    patch : number of the patch whose mask it is, ACTIVE_LAYER or WHOLE_SEA
    """
    layout.prop(group, "source")
    if group.source == "NONE":
        return
    if group.source == "IMAGE":
        draw_image(layout, group)
    elif group.source == "VERTEX_GROUP":
        _draw_weights(layout, group, patch)
    elif group.source == "NOISE":
        _draw_noise(layout, group)
    else:
        _draw_distance(layout, group)
    for text in (_lacking(group), _standing_still(group)):
        if text:
            message(layout, context, text)
    layout.prop(group, "strength", slider=True)
    layout.prop(group, "inverted")


def draw_image(layout: bpy.types.UILayout, group: bpy.types.PropertyGroup) -> None:
    """Draw the choice of an image, and of its channels where they have names."""
    layout.template_ID(group, "image", new="image.new", open="image.open")
    if group.image is not None and source_images.has_named_channels(group.image):
        layout.prop(group, "image_channels")


def _draw_weights(layout: bpy.types.UILayout, group: bpy.types.PropertyGroup, patch: int) -> None:
    column = layout.column(align=True)
    column.prop(group, "mesh")
    if group.mesh is not None:
        column.prop_search(group, "vertex_group", group.mesh, "vertex_groups")
    button = layout.row()
    button.enabled = _has_weights(group)
    text = "Read Again" if group.image is not None else "Read Weights"
    button.operator(OCEAN_OT_read_weights.bl_idname, text=text, icon="FILE_REFRESH").patch = patch


def _draw_distance(layout: bpy.types.UILayout, group: bpy.types.PropertyGroup) -> None:
    column = layout.column(align=True)
    column.prop(group, "object")
    layout.row().prop(group, "measured_from", expand=True)
    if group.measured_from == "ORIGIN":
        places = layout.column(align=True)
        places.active = group.object is None
        places.prop(group, "x")
        places.prop(group, "y")
    column = layout.column(align=True)
    column.prop(group, "inner_radius")
    column.prop(group, "outer_radius")


def _draw_noise(layout: bpy.types.UILayout, group: bpy.types.PropertyGroup) -> None:
    draw_fields(layout, group, "noise_size", "noise_coverage", "noise_contrast")
    draw_fields(layout.column(align=True), group, "noise_speed", "noise_direction")
    draw_fields(layout, group, "noise_evolution", "noise_seed")


def _lacking(group: bpy.types.PropertyGroup) -> str:
    """What is to be done before the sea can be shown; empty where nothing is."""
    if group.source in ("DISTANCE", "NOISE") or group.image is not None:
        return ""
    if group.source == "IMAGE":
        return "The sea waits for an image: choose one, or no mask"
    if group.mesh is None:
        return "The sea waits for weights: choose a mesh over or under the water"
    if not _has_weights(group):
        return "The sea waits for weights: choose the mesh's vertex group"
    return "The sea waits for weights: press Read Weights"


def _standing_still(group: bpy.types.PropertyGroup) -> str:
    """What a mask does not do that its object does; empty where there is nothing."""
    item, ocean = group.object, group.id_data
    if group.source != "DISTANCE" or item is None or item not in mask_following.moving_objects(ocean):
        return ""
    if mask_following.is_bound(ocean):
        return ""
    return f"{item.name} moves by itself, which masks of a linked ocean do not follow: this one stands still"


def _has_weights(group: bpy.types.PropertyGroup) -> bool:
    return group.mesh is not None and group.vertex_group in group.mesh.vertex_groups


class OCEAN_PT_mask(SubPanel, bpy.types.Panel):
    """The mask that lies over the whole sea."""

    bl_idname = "OCEAN_PT_mask"
    bl_label = "Mask"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw its settings."""
        draw_mask(split(self.layout), context, active_settings(context).mask, WHOLE_SEA)


CLASSES = (OCEAN_PT_mask,)
