# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's own preferences."""

import logging

import bpy
from bpy.props import BoolProperty, EnumProperty

from ..export import logs
from ..scene.preferences import preferences

_LEVELS = (
    ("ERROR", "Errors", "What failed"),
    ("WARNING", "Warnings", "Also what may not be as it was meant"),
    ("INFO", "Information", "Also what is done"),
    ("DEBUG", "Details", "Also what is looked at, for a report of a fault"),
)


def apply() -> None:
    """Let the console hear as much as the user chose."""
    chosen = preferences()
    logs.to_console(logging.WARNING if chosen is None else getattr(logging, chosen.log_level))


class OCEAN_AP_preferences(bpy.types.AddonPreferences):
    """Registration gives it the name that Blender knows the extension by."""

    bl_idname = "ocean_tweak"

    log_level: EnumProperty(
        name="Console",
        description="What the extension writes to the console, a line each that begins with ocean_tweak",
        items=_LEVELS,
        default="WARNING",
        update=lambda _self, _context: apply(),
    )
    write_log: BoolProperty(
        name="Log of Bakes",
        description="Write what happens in a bake, with times, into a file beside its folder, vNNN-hash8.log",
    )

    def draw(self, _context: bpy.types.Context) -> None:
        """The choices, below each other."""
        column = self.layout.column()
        column.use_property_split = True
        column.prop(self, "log_level")
        column.prop(self, "write_log")


CLASSES = (OCEAN_AP_preferences,)
