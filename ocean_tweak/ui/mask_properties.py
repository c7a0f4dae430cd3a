# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks as properties: an image, a vertex group that was read, the distance to an object, or a noise."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import bpy
import numpy as np
from bpy.props import EnumProperty, PointerProperty, StringProperty

from ..core import Mask, ParameterError, Raster
from ..core.data.plain_data import to_plain
from ..core.masks.parameters import MOST_GUSTS
from ..scene import floating, mask_lines, source_images
from ..scene.source_images import ImageSource
from ..scene.vertex_weights import WeightsReading, weights_seen
from . import parameter_properties
from .parameter_properties import changed

_OVERRIDE = {"override": {"LIBRARY_OVERRIDABLE"}}
_SHOWN = {"options": set(), "update": changed, **_OVERRIDE}

SOURCES = {
    "NONE": ("None", "Waves everywhere"),
    "IMAGE": ("Image", "Wave height follows the brightness of an image that covers the domain"),
    "VERTEX_GROUP": ("Vertex Group", "Wave height follows the weights of a mesh above or below the water"),
    "DISTANCE": ("Distance", "No waves near an object, full waves far from it"),
    "NOISE": ("Noise", "Gusts: waves in patches that move along and change"),
}
MEASURED_FROM = {
    "ORIGIN": ("Origin", "Distance from the object's origin, or from a place"),
    "SHAPE": (
        "Shape",
        "Distance from the nearest edge of the mesh, or from the curve: a breakwater, a coast",
    ),
}
#: those that end as an image
_IMAGES = ("IMAGE", "VERTEX_GROUP")


def _placed(group: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    place(group)
    changed(group, context)


def _source_chosen(group: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    settings = group.id_data.ocean_tweak
    if group.source == "NOISE" and not settings.is_quiet:
        with settings.quiet():
            _fit_noise(group, settings)
    changed(group, context)


def _fit_noise(group: bpy.types.PropertyGroup, settings: bpy.types.PropertyGroup) -> None:
    """Let a noise that was just chosen go with the strongest wind, and be of a size that the domain holds."""
    winds = [layer.group for layer in settings.layers if hasattr(layer.group, "wind_speed")]
    if winds:
        wind = max(winds, key=lambda each: each.wind_speed)
        group.noise_speed, group.noise_direction = wind.wind_speed, wind.wind_direction
    side = settings.patches[0].domain_size if settings.patches else settings.domain_size
    group.noise_size = min(max(group.noise_size, side / MOST_GUSTS), side)


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
            name="Mask", default="NONE", options=set(), update=_source_chosen, **_OVERRIDE,
            items=[(key, *texts) for key, texts in SOURCES.items()],
            description="Where these waves are",
        ),
        "image": PointerProperty(
            name="Image", type=bpy.types.Image, **_SHOWN,
            description="White lets all waves through, black none; it covers the domain, and repeats with it",
        ),
        "image_channels": channels_property(),
        "object": PointerProperty(
            name="Object", type=bpy.types.Object, options=set(), update=_placed, **_OVERRIDE,
            description="Falloff is measured from this object, and follows it by hand and by animation",
        ),
        "measured_from": EnumProperty(
            name="Measured From", default="ORIGIN", options=set(), update=_placed, **_OVERRIDE,
            items=[(key, *texts) for key, texts in MEASURED_FROM.items()],
            description="Which part of the object the distance is measured from, seen from above",
        ),
        # of the object's shape, in the ocean's axes and Blender units
        "lines": StringProperty(options={"HIDDEN"}, **_OVERRIDE),
        "mesh": PointerProperty(
            name="Mesh", type=bpy.types.Object, options=set(), poll=_is_mesh, **_OVERRIDE,
            description="A mesh above or below the water, with the weights",
        ),
        "vertex_group": StringProperty(
            name="Vertex Group", options=set(), **_OVERRIDE,
            description="Weight 1 lets all waves through; outside the mesh there are none",
        ),
    }  # fmt: skip


def image_source(group: bpy.types.PropertyGroup) -> ImageSource | None:
    """The image that gives the weights, if one does."""
    return source_images.source_of(group) if group.source in _IMAGES else None


def place(group: bpy.types.PropertyGroup) -> None:
    """Measure from where the mask's object is now, if it has one."""
    if group.object is None:
        return
    measured = _measured(group)
    if "lines" in measured:
        if measured["lines"] != group.lines:
            group.lines = measured["lines"]
            changed(group, bpy.context)
        return
    for name, value in measured.items():
        if abs(getattr(group, name) - value) > 1e-5 * max(1.0, abs(value)):
            setattr(group, name, value)


def take_place(group: bpy.types.PropertyGroup, evaluated: bpy.types.PropertyGroup) -> None:
    """Measure from where an evaluation has the mask's object, exactly."""
    if evaluated.object is None:
        return
    for name, value in _measured(evaluated).items():
        if getattr(group, name) != value:
            setattr(group, name, value)


def _measured(group: bpy.types.PropertyGroup) -> dict[str, Any]:
    """The properties that tell where the mask's object is: as evaluated where the group is."""
    to_ocean = group.id_data.matrix_world.inverted_safe()
    if group.measured_from == "SHAPE":
        return {"lines": mask_lines.to_text(mask_lines.lines_of(group.object, to_ocean))}
    x, y, _ = to_ocean @ group.object.matrix_world.translation
    return {"x": x, "y": y}


def has_read(group: bpy.types.PropertyGroup) -> bool:
    """Whether the weights of a mesh that is still there have been read."""
    return group.source == "VERTEX_GROUP" and None not in (group.mesh, group.image)


def reading_of(group: bpy.types.PropertyGroup, scene: bpy.types.Scene, samples: int) -> WeightsReading:
    """A reading of the weights of the mask's mesh, not yet begun. Raises OceanObjectError without any."""
    return WeightsReading(group.id_data, group.mesh, group.vertex_group, scene, samples)


def read_weights(group: bpy.types.PropertyGroup, scene: bpy.types.Scene, samples: int) -> None:
    """Read the weights of the mask's mesh into its image, all at once.

    Raises OceanObjectError for a mesh that has none over or under the domain, ParameterError for a damaged
    image of before; then nothing is changed.
    """
    take_weights(group, weights_seen(reading_of(group, scene, samples)))


def take_weights(group: bpy.types.PropertyGroup, seen: Raster) -> None:
    """Let weights that were read be the mask's image. Raises ParameterError for a damaged one of before."""
    # an image of an earlier reading without other users is replaced
    before = group.image
    candidates = [] if before is None else [ImageSource(before)]
    source_images.choose(group, source_images.source_with(seen, candidates))
    if before is not None and before != group.image and before.users == 0:
        bpy.data.images.remove(before)
    if group.source != "VERTEX_GROUP":
        group.source = "VERTEX_GROUP"


def read(group: bpy.types.PropertyGroup, metres: Fraction) -> Mask | None:
    """The mask; None where waves are everywhere. Raises ParameterError for one that cannot be."""
    if group.source == "NONE":
        return None
    is_seen = group.source == "DISTANCE" and group.id_data.is_evaluated and group.object is not None
    seen = _measured(group) if is_seen else {}
    values = parameter_properties.read(group, Mask, metres, ("source",), seen)
    try:
        if group.source == "NOISE":
            return Mask(**{**values, "source": "NOISE"})
        # a default is in Blender units: it is no number of a mask that has nothing to do with it
        values = {
            name: value for name, value in values.items()
            if not name.startswith("noise_") or group.is_property_set(name)
        }  # fmt: skip
        if group.source not in _IMAGES:
            return Mask(
                **{
                    **values,
                    "source": "DISTANCE",
                    "lines": _lines(group, seen.get("lines", group.lines), metres),
                }
            )
        source = source_images.source_of(group)
        if source is None:
            remedy = "choose one, or no mask" if group.source == "IMAGE" else "press Read Weights"
            raise ParameterError("image", "", remedy)
        image = source_images.raster_of(source, 1)
        return source_images.made_layer(Mask, (*values.items(), ("source", "IMAGE"), ("image", image)))
    except ParameterError as error:
        raise error.inside("mask") from None


def _lines(group: bpy.types.PropertyGroup, text: str, metres: Fraction) -> Raster | None:
    """Those that a distance is measured from; None for a place. Raises ParameterError for none."""
    item = group.object
    if item is not None and floating.floats(item.original):
        raise ParameterError(
            "object",
            item.name,
            "it floats on this water, which would follow itself: choose one that does not float",
        )
    if group.measured_from == "ORIGIN":
        return None
    lines = mask_lines.from_text(text)
    if not len(lines):
        name = "" if item is None else item.name
        raise ParameterError(
            "object", name, "it has no edges to measure from: choose a mesh with edges, or a curve"
        )
    return Raster(lines[np.newaxis] * float(metres), "lines")


def write(
    group: bpy.types.PropertyGroup, mask: Mask | None, metres: Fraction, known_images: set[ImageSource]
) -> None:
    """Take over a mask; an image that holds the same numbers stays, and so does what it was read from."""
    if mask is None:
        group.source = "NONE"
        return
    parameter_properties.write(group, Mask, to_plain(mask, brief=True), metres, ("source",))
    if mask.source != "IMAGE":
        if mask.source == "DISTANCE":
            _write_distance(group, mask, metres)
        group.source = mask.source
        return
    source = source_images.source_with(mask.image, known_images)
    known_images.add(source)
    if group.source not in _IMAGES or group.image != source.image:
        group.source = "IMAGE"
    source_images.choose(group, source)


def _write_distance(group: bpy.types.PropertyGroup, mask: Mask, metres: Fraction) -> None:
    """The object stays where the mask measures from it as it is."""
    if mask.lines is None:
        group.measured_from, group.lines = "ORIGIN", ""
        if group.object is not None and not _is_at(group, mask, metres):
            group.object = None
        return
    lines = mask_lines.to_text(mask.lines.values.reshape(-1, 4) / float(metres))
    if group.object is not None and lines != group.lines:
        group.object = None
    group.measured_from, group.lines = "SHAPE", lines


def _is_at(group: bpy.types.PropertyGroup, mask: Mask, metres: Fraction) -> bool:
    """Whether the group's object is where a mask measures from."""
    local = group.id_data.matrix_world.inverted_safe() @ group.object.matrix_world.translation
    return all(
        abs(there - at / float(metres)) < 1e-3 for there, at in zip(local[:2], (mask.x, mask.y), strict=True)
    )


CLASSES = (OCEAN_PG_mask,)
