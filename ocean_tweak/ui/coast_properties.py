# SPDX-License-Identifier: GPL-3.0-or-later
"""A coast as properties: the mesh of its bed, and the image of depths that was read from it or chosen."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, PointerProperty

from ..core import Coast, ParameterError
from ..core.data.plain_data import to_plain
from ..core.waves.coast.parameters import SHORES
from ..scene import source_images
from ..scene.coast_bed import Bed
from ..scene.refinement import redraw_views
from ..scene.source_images import ImageSource
from . import parameter_properties
from .mask_properties import channels_property
from .parameter_properties import changed

_OVERRIDE = {"override": {"LIBRARY_OVERRIDABLE"}}
_SHOWN = {"options": set(), "update": changed, **_OVERRIDE}
_TEXTS = {
    "+X": ("East", "Waves run ashore along +x of the ocean"),
    "+Y": ("North", "Waves run ashore along +y of the ocean"),
    "-X": ("West", "Waves run ashore along -x of the ocean"),
    "-Y": ("South", "Waves run ashore along -y of the ocean"),
}


def _is_mesh(_group: bpy.types.PropertyGroup, item: bpy.types.Object) -> bool:
    return item.type == "MESH"


def _redraw(_group: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
    redraw_views()


class OCEAN_PG_coast(bpy.types.PropertyGroup):
    """A bed over which waves run ashore."""

    __annotations__ = {
        **parameter_properties.annotations(Coast, changed, ("shore",)),
        "use": BoolProperty(
            name="Coast", **_SHOWN, description="Let waves run over a bed, turn, rise and break on it"
        ),
        "shore": EnumProperty(
            name="Shore", items=[(key, *_TEXTS[key]) for key in SHORES], **_SHOWN,
            description="Side of the bed where the shore is, towards which waves run",
        ),
        "bed": PointerProperty(
            name="Sea Bed", type=bpy.types.Object, options=set(), poll=_is_mesh, **_OVERRIDE,
            description="Mesh of the bed and of the land behind it: still water stands at the ocean's height",
        ),
        "image": PointerProperty(
            name="Depths", type=bpy.types.Image, **_SHOWN,
            description="Depth of the bed below still water in metres, 0 and less on land",
        ),
        "image_channels": channels_property(),
        "show_height": BoolProperty(
            name="Wave Height", options=set(), update=_redraw, **_OVERRIDE,
            description="Draw a map of the significant wave height over the bed while the ocean is active",
        ),
        "show_direction": BoolProperty(
            name="Direction", options=set(), update=_redraw, **_OVERRIDE,
            description="Draw arrows of the mean direction of waves over the bed while the ocean is active",
        ),
    }  # fmt: skip


def read(group: bpy.types.PropertyGroup, metres: Fraction) -> Coast | None:
    """The coast; None where there is none. Raises ParameterError for one that cannot be."""
    if not group.use:
        return None
    try:
        source = source_images.source_of(group)
        if source is None:
            raise ParameterError("depth", "", "choose a mesh as Sea Bed and press Make Coast")
        values = parameter_properties.read(group, Coast, metres, ("shore",))
        depth = source_images.raster_of(source, 1)
        made = source_images.made_layer(Coast, (*values.items(), ("shore", group.shore), ("depth", depth)))
    except ParameterError as error:
        raise error.inside("coast") from None
    assert isinstance(made, Coast)
    return made


def write(
    group: bpy.types.PropertyGroup, coast: Coast | None, metres: Fraction, candidates: set[ImageSource]
) -> None:
    """Take over a coast, or none."""
    group.use = coast is not None
    if coast is None:
        return
    data: dict[str, Any] = to_plain(coast, brief=True)
    parameter_properties.write(group, Coast, data, metres, ("shore",))
    group.shore = coast.shore
    assert coast.depth is not None
    source_images.choose(group, source_images.source_with(coast.depth, candidates))


def image_source(group: bpy.types.PropertyGroup) -> ImageSource | None:
    """The image of depths, if there is one."""
    return source_images.source_of(group) if group.use else None


def take_bed(group: bpy.types.PropertyGroup, bed: Bed, metres: Fraction) -> None:
    """Let waves run over a bed that was read, and show them."""
    before, settings = group.image, group.id_data.ocean_tweak
    with settings.quiet():
        candidates = [] if before is None else [ImageSource(before)]
        source_images.choose(group, source_images.source_with(bed.depth, candidates))
        group.spacing, group.x, group.y = (value / float(metres) for value in (bed.spacing, bed.x, bed.y))
        group.use, group.muted = True, False
    if before is not None and before != group.image and before.users == 0:
        bpy.data.images.remove(before)
    changed(group, bpy.context)
