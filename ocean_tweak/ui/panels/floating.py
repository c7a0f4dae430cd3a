# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's Float on Ocean: how the active object floats, and the buttons."""

import bpy

from ...nodes.floating import RIDE_INPUTS
from ...nodes.modifier_inputs import input_property
from ...scene import floating
from .. import float_operators
from .drawing import SidebarPanel, split


class OCEAN_PT_float(SidebarPanel, bpy.types.Panel):
    """How the active object floats."""

    bl_idname = "OCEAN_PT_float"
    bl_label = "Float on Ocean"
    bl_order = 100
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the inputs of the active object's carrier, or the button that gives it one."""
        layout = split(self.layout)
        item = context.active_object
        carrier = item if item is None or floating.is_carrier(item) else floating.carrier_of(item)
        modifier = floating.carrier_modifier(carrier) if carrier is not None else None
        if modifier is None:
            layout.operator(float_operators.OBJECT_OT_ocean_float.bl_idname, icon="OUTLINER_DATA_EMPTY")
        else:
            if carrier != item:
                layout.label(text=f"Move {carrier.name}", icon="INFO")
            column = layout.column()
            for plug in RIDE_INPUTS:
                owner, name = input_property(modifier, plug.name)
                if plug.socket_type == "NodeSocketObject":
                    column.prop_search(owner, name, bpy.data, "objects", text=plug.name, icon="MOD_OCEAN")
                else:
                    column.prop(owner, name, text=plug.name)
        column = layout.column(align=True)
        bake, remove = (
            float_operators.OBJECT_OT_ocean_float_bake, float_operators.OBJECT_OT_ocean_float_remove,
        )  # fmt: skip
        column.operator(bake.bl_idname, text="Bake to Keyframes", icon="KEYINGSET")
        column.operator(remove.bl_idname, text="Remove", icon="X")


CLASSES = (OCEAN_PT_float,)
