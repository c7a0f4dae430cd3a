# SPDX-License-Identifier: GPL-3.0-or-later
"""What panels share: where they stand, rows of label and text, and texts that wrap."""

import json
import re
import textwrap
from functools import lru_cache
from typing import Any

import bpy
from bpy.app.translations import pgettext_iface as translated

from ...core.spectral.equaliser import GAINS
from ...scene.command_process import CommandProcess
from ...scene.settings import OceanSettings, settings_of
from ..active_ocean import active_layer, shown_ocean
from ..field_drawing import draw_fields

CATEGORY = "Ocean Tweak"
_LABEL_SHARE = 0.4  # of the width, as Blender's own split layouts
_LETTER = 7.0  # pixels, at a scale of 1
# a number and its unit stay in one line
_NO_BREAK = "\N{NO-BREAK SPACE}"
_BEFORE_UNIT = re.compile(r"(?<=\d) (?=(?:[kcm]?m|s|%|m/s)(?![^\W_]))")


class SidebarPanel:
    """Stands in the tab of this extension."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = CATEGORY


class OceanPanel(SidebarPanel):
    """Shown where the scene has an ocean."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """The scene has an ocean."""
        return shown_ocean(context) is not None


class SubPanel(OceanPanel):
    """Inside the sea's panel, closed at first."""

    bl_parent_id = "OCEAN_PT_sea"
    bl_options = {"DEFAULT_CLOSED"}


def split(layout: bpy.types.UILayout, animated: bool = False) -> bpy.types.UILayout:
    """The layout with labels on the left, as Blender's own panels.

    animated : with room for the dots that set keys
    """
    layout.use_property_split = True
    layout.use_property_decorate = animated
    return layout


def draw_equaliser(layout: bpy.types.UILayout, group: bpy.types.PropertyGroup) -> None:
    """Draw the bands, long waves first, and the wavelength that they are counted from."""
    bands = layout.column(align=True)
    for name in GAINS:
        bands.prop(group, name, slider=True)
    draw_fields(layout, group, "wavelength")


def active_settings(context: bpy.types.Context) -> OceanSettings:
    """Settings of the ocean that is shown."""
    return settings_of(shown_ocean(context))


def active_waves(settings: OceanSettings) -> bpy.types.PropertyGroup | None:
    """The active layer where it is a wave system."""
    layer = active_layer(settings)
    return layer if layer is not None and layer.kind == "WAVES" else None


@lru_cache(maxsize=16)
def parsed(text: str) -> Any:
    """Parse a JSON text of the settings; cached, as it is drawn often. Must not be modified."""
    return json.loads(text)


def row(layout: bpy.types.UILayout, label: str, text: str) -> None:
    """Draw a label and its text in line with Blender's split properties."""
    parts = layout.split(factor=_LABEL_SHARE)
    left = parts.row()
    left.alignment = "RIGHT"
    left.label(text=label)
    parts.label(text=text, translate=False)


def message(layout: bpy.types.UILayout, context: bpy.types.Context, text: str, alert: bool = False) -> None:
    """Draw a text in a box, wrapped to the region: Blender's labels do not wrap."""
    width = context.region.width / context.preferences.system.ui_scale
    box = layout.box().column(align=True)
    box.alert = alert
    box.scale_y = 0.8
    whole = _BEFORE_UNIT.sub(_NO_BREAK, translated(text))
    for index, line in enumerate(textwrap.wrap(whole, max(int(width / _LETTER) - 9, 16))):
        icon = ("ERROR" if alert else "INFO") if index == 0 else "BLANK1"
        box.label(text=line.replace(_NO_BREAK, " "), icon=icon, translate=False)


def progress_bar(layout: bpy.types.UILayout, process: CommandProcess, stop: str) -> None:
    """Draw how far a process is and how long it will take.

    stop : the operator that ends it
    """
    left = process.seconds_left
    time = "" if left is None else f", {int(left) // 60}:{int(left) % 60:02d}"
    count = f"{process.phase.capitalize()} {process.done} / {process.left or '…'}{time}".lstrip()
    text = translated("Stopping…") if process.is_stopped else count
    line = layout.row(align=True)
    line.progress(factor=process.factor, text=text, translate=False)
    line.operator(stop, text="", icon="CANCEL")


def length_text(scene: bpy.types.Scene, metres: float) -> str:
    """A length in the scene's system of units."""
    system = "IMPERIAL" if scene.unit_settings.system == "IMPERIAL" else "METRIC"
    return bpy.utils.units.to_string(system, "LENGTH", metres, precision=3)


def speed_text(scene: bpy.types.Scene, metres_per_second: float) -> str:
    """A speed in the scene's system of units."""
    system = "IMPERIAL" if scene.unit_settings.system == "IMPERIAL" else "METRIC"
    return bpy.utils.units.to_string(system, "VELOCITY", metres_per_second, precision=3)
