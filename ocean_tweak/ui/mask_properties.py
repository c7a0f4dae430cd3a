# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks as properties: an image, a vertex group that was read, or the distance to an object."""

from __future__ import annotations

from fractions import Fraction

import bpy
from bpy.props import EnumProperty, PointerProperty, StringProperty

from ..core import Mask, ParameterError
from ..core.data.plain_data import to_plain
from ..scene import source_images
from ..scene.source_images import ImageSource
from . import parameter_properties
from .parameter_properties import changed

_OVERRIDE = {"override": {"LIBRARY_OVERRIDABLE"}}
_SHOWN = {"options": set(), "update": changed, **_OVERRIDE}

SOURCES = {
    "NONE": ("None", "Waves everywhere"),
    "IMAGE": ("Image", "Waves as high as the image is bright; it covers the domain"),
    "VERTEX_GROUP": ("Vertex Group", "Waves as high as the weights of a mesh over or under the water"),
    "DISTANCE": ("Distance", "No waves near an object, all of them far from it"),
}
#: those that end as an image
_IMAGES = ("IMAGE", "VERTEX_GROUP")


def _placed(group: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    place(group)
    changed(group, context)


def _is_mesh(_group: bpy.types.PropertyGroup, item: bpy.types.Object) -> bool:
    return item.type == "MESH"


def _known_channels(
    group: bpy.types.PropertyGroup, _context: bpy.types.Context, _text: str
) -> tuple[str, ...]:
    return () if group.image is None else source_images.channel_names(group.image)


def channels_property() -> StringProperty:
    """Which channels of the group's `image` are read."""
    return StringProperty(
        name="Channels", **_SHOWN, search=_known_channels, search_options={"SUGGESTION"},
        description="Channels of the EXR image, such as Z or mask.R, several between commas, or a layer; "
        "empty for R, G and B, or Y",
    )  # fmt: skip


class OCEAN_PG_mask(bpy.types.PropertyGroup):
    """Where the waves of a layer or patch are."""

    __annotations__ = {
        **parameter_properties.annotations(Mask, changed, ("source",)),
        "source": EnumProperty(
            name="Mask", default="NONE", **_SHOWN, items=[(key, *texts) for key, texts in SOURCES.items()],
            description="Where these waves are",
        ),
        "image": PointerProperty(
            name="Image", type=bpy.types.Image, **_SHOWN,
            description="White lets all waves through, black none; it covers the domain, and repeats with it",
        ),
        "image_channels": channels_property(),
        "object": PointerProperty(
            name="Object", type=bpy.types.Object, options=set(), update=_placed, **_OVERRIDE,
            description="Waves are told by the distance to it. It is followed when it is moved by hand",
        ),
        "mesh": PointerProperty(
            name="Mesh", type=bpy.types.Object, options=set(), poll=_is_mesh, **_OVERRIDE,
            description="A mesh that lies over or under the water, with the weights",
        ),
        "vertex_group": StringProperty(
            name="Vertex Group", options=set(), **_OVERRIDE,
            description="Weight 1 lets all waves through; beside the mesh there are none",
        ),
    }  # fmt: skip


def image_source(group: bpy.types.PropertyGroup) -> ImageSource | None:
    """The image that gives the weights, if one does."""
    return source_images.source_of(group) if group.source in _IMAGES else None


def place(group: bpy.types.PropertyGroup) -> None:
    """Measure from where the mask's object is now, if it has one."""
    if group.object is None:
        return
    ocean = group.id_data
    x, y, _ = ocean.matrix_world.inverted_safe() @ group.object.matrix_world.translation
    for name, value in (("x", x), ("y", y)):
        if abs(getattr(group, name) - value) > 1e-5 * max(1.0, abs(value)):
            setattr(group, name, value)


def read(group: bpy.types.PropertyGroup, metres: Fraction) -> Mask | None:
    """The mask; None where waves are everywhere. Raises ParameterError for one that cannot be."""
    if group.source == "NONE":
        return None
    values = parameter_properties.read(group, Mask, metres, ("source",))
    try:
        if group.source not in _IMAGES:
            return Mask(**{**values, "source": "DISTANCE"})
        source = source_images.source_of(group)
        if source is None:
            remedy = "choose one, or no mask" if group.source == "IMAGE" else "press Read Weights"
            raise ParameterError("image", "", remedy)
        image = source_images.raster_of(source, 1)
        return source_images.made_layer(Mask, (*values.items(), ("source", "IMAGE"), ("image", image)))
    except ParameterError as error:
        raise error.inside("mask") from None


def write(
    group: bpy.types.PropertyGroup, mask: Mask | None, metres: Fraction, known_images: set[ImageSource]
) -> None:
    """Take over a mask; an image that holds the same numbers stays, and so does what it was read from."""
    if mask is None:
        group.source = "NONE"
        return
    parameter_properties.write(group, Mask, to_plain(mask, brief=True), metres, ("source",))
    if mask.source == "DISTANCE":
        if group.object is not None and not _is_at(group, mask, metres):
            group.object = None
        group.source = "DISTANCE"
        return
    source = source_images.source_with(mask.image, known_images)
    known_images.add(source)
    if group.source not in _IMAGES or group.image != source.image:
        group.source = "IMAGE"
    source_images.choose(group, source)


def _is_at(group: bpy.types.PropertyGroup, mask: Mask, metres: Fraction) -> bool:
    """Whether the group's object is where a mask measures from."""
    local = group.id_data.matrix_world.inverted_safe() @ group.object.matrix_world.translation
    return all(
        abs(there - at / float(metres)) < 1e-3 for there, at in zip(local[:2], (mask.x, mask.y), strict=True)
    )


CLASSES = (OCEAN_PG_mask,)
