# SPDX-License-Identifier: GPL-3.0-or-later
"""How an ocean becomes USD layers: properties made of the same table as the command line's arguments."""

import re
from typing import Any

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    IntVectorProperty,
    StringProperty,
)

from ..core.data.validation import Off
from ..export.usd.attributes import ATTRIBUTES
from ..export.usd.options import DEFAULTS, FORM_OPTIONS, OPTIONS
from ..export.usd.package import MOST_TILES, UNITS, UP_AXES
from .field_drawing import draw_switched
from .parameter_properties import path_changed, switch_of

_KEPT = {"options": set(), "override": {"LIBRARY_OVERRIDABLE"}}


def _of(name: str, **more: Any) -> dict[str, Any]:
    """What the table says of an option, as Blender's properties take it."""
    option, default = OPTIONS[name], DEFAULTS[name]
    return {"name": option.label, "description": option.sentence, "default": default, **_KEPT, **more}


_PROXY = OPTIONS["proxy"].sentence.partition(";")[0]


def _title(name: str) -> str:
    """`Display Color` of displayColor."""
    return re.sub(r"(?=[A-Z])", " ", name).title()


class OCEAN_PG_usd(bpy.types.PropertyGroup):
    """See scene.settings.UsdSettings for what the scene needs of them."""

    __annotations__ = {
        "file": StringProperty(
            name="File", subtype="FILE_PATH", update=path_changed("file"),
            **{**_KEPT, "options": {"PATH_SUPPORTS_BLEND_RELATIVE"}},
            description="The asset's layer, .usd, .usda or .usdc; its other layers are written beside "
            "it, so give each ocean its own folder. // is the folder of the file",
        ),
        "form": EnumProperty(
            name="Form", default=DEFAULTS["form"], description="What moves the mesh", **_KEPT,
            items=[(form, option.label, option.sentence) for form, option in FORM_OPTIONS.items()],
        ),
        "use_bake": BoolProperty(
            name="Use the Bake", default=True, **_KEPT,
            description="Use the images that the ocean reads, in place, instead of baking new ones "
            "beside the layers",
        ),
        "up_axis": EnumProperty(**_of("up_axis", items=[(axis, axis, "") for axis in UP_AXES])),
        "metres_per_unit": FloatProperty(
            **_of("metres_per_unit", min=UNITS[0], max=UNITS[1], soft_min=0.001, soft_max=1000.0, precision=4)
        ),
        "subframes": IntProperty(**_of("subframes", min=1, max=1000, soft_max=10)),
        "attributes": EnumProperty(
            **_of(
                "attributes", default=set(DEFAULTS["attributes"]),
                items=[(name, _title(name), "") for name in ATTRIBUTES],
                options={"ENUM_FLAG"},
            )
        ),
        "half": BoolProperty(**_of("half")),
        "tiles": IntVectorProperty(**_of("tiles", size=2, subtype="XYZ", min=1, max=MOST_TILES, soft_max=8)),
        "proxy": IntProperty(**_of("proxy", min=0, soft_max=256)),
        **switch_of("proxy", _PROXY, Off(0, DEFAULTS["proxy"], "is left out")),
        "variants": StringProperty(**_of("variants", default="")),
        "force": BoolProperty(**_of("force")),
    }  # fmt: skip


def draw_choices(layout: bpy.types.UILayout, settings: OCEAN_PG_usd, bake: bool) -> None:
    """Draw what the layers will hold, in the panel and in the file browser.

    bake : whether there are images of a bake that could be used
    """
    layout.prop(settings, "form")
    moves = settings.form != "displacement"
    if bake and not moves:
        layout.prop(settings, "use_bake")
    column = layout.column(align=True)
    column.prop(settings, "up_axis", expand=True)
    layout.prop(settings, "metres_per_unit")
    layout.prop(settings, "subframes")
    if moves:
        layout.column(align=True).prop(settings, "attributes")
        layout.prop(settings, "half")
    layout.prop(settings, "tiles")
    draw_switched(layout, settings, "proxy")
    layout.prop(settings, "variants")
    layout.prop(settings, "force")


CLASSES = (OCEAN_PG_usd,)
