# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's Float on Ocean: how the active object floats, and the buttons."""

import bpy

from ...nodes.contact import LOOK_INPUTS
from ...nodes.floating import RIDE_INPUTS
from ...nodes.modifier_inputs import input_property
from ...scene import contact, floating
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
        if item is not None:
            _contact(layout, item if carrier != item else next(floating.carried_by(item), item))
        column = layout.column(align=True)
        bake, remove = (
            float_operators.OBJECT_OT_ocean_float_bake, float_operators.OBJECT_OT_ocean_float_remove,
        )  # fmt: skip
        column.operator(bake.bl_idname, text="Bake to Keyframes", icon="KEYINGSET")
        column.operator(remove.bl_idname, text="Remove", icon="X")


def _contact(layout: bpy.types.UILayout, item: bpy.types.Object) -> None:
    """Draw the collar and the wet band of an object, and the button that makes or takes them."""
    touches = contact.touches(item)
    if touches:
        for collar in contact.collars_of(item):
            column = layout.column(align=True)
            column.label(text="Foam and Ripples Around It")
            for name, *_ in LOOK_INPUTS:
                column.prop(collar.inputs[name], "default_value", text=name)
        modifier = contact.modifier_of(item)
        if modifier is not None:
            owner, name = input_property(modifier, "Wet Band")
            layout.prop(owner, name, text="Wet Band")
    text = "Leave Water Alone" if touches else float_operators.OBJECT_OT_ocean_contact.bl_label
    button = layout.operator(float_operators.OBJECT_OT_ocean_contact.bl_idname, text=text, icon="MOD_OCEAN")
    button.use_contact = not touches


CLASSES = (OCEAN_PT_float,)
