# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's Float on Ocean: how the active object floats, and the buttons."""

import bpy

from ...nodes.contact import LOOK_INPUTS
from ...nodes.floating import DAMPED_INPUTS, RIDE_INPUTS
from ...nodes.modifier_inputs import get_input, input_property, input_sockets
from ...scene import contact, float_carrier, float_riding, floating, hull_cut
from .. import float_operators, wake_operators
from .drawing import SidebarPanel, split


class OCEAN_PT_float(SidebarPanel, bpy.types.Panel):
    """How the active object floats."""

    bl_idname = "OCEAN_PT_float"
    bl_label = "Float on Ocean"
    bl_order = 100
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw how the active object floats, or the button that lets it."""
        layout = split(self.layout)
        item = context.active_object
        carrier = floating.carrier_of(item) if item is not None else None
        modifier = float_carrier.modifier_of(carrier) if carrier is not None else None
        float_operator = float_operators.OBJECT_OT_ocean_float.bl_idname
        if modifier is None:
            layout.operator(float_operator, icon="MOD_OCEAN")
        else:
            layout.operator_menu_enum(float_operator, "ride", text="Float As", icon="PRESET")
            known = input_sockets(modifier.node_group)  # of a linked one perhaps not all
            column = layout.column()
            is_damped = "Damped" in known and get_input(modifier, "Damped")
            for plug in (*RIDE_INPUTS, *(DAMPED_INPUTS if is_damped else DAMPED_INPUTS[:1])):
                if plug.name not in known:
                    continue
                owner, name = input_property(modifier, plug.name)
                if plug.socket_type == "NodeSocketObject":
                    column.prop_search(owner, name, bpy.data, "objects", text=plug.name, icon="MOD_OCEAN")
                else:
                    column.prop(owner, name, text=plug.name)
            if is_damped and (text := float_riding.why_not(carrier)):
                column.label(text=text, icon="INFO")
        if item is not None:
            _contact(layout, item)
        layout.operator(wake_operators.OBJECT_OT_ocean_wake.bl_idname, icon="MOD_DYNAMICPAINT")
        column = layout.column(align=True)
        bake, remove = (
            float_operators.OBJECT_OT_ocean_float_bake, float_operators.OBJECT_OT_ocean_float_remove,
        )  # fmt: skip
        column.operator(bake.bl_idname, text="Bake to Keyframes", icon="KEYINGSET")
        column.operator(remove.bl_idname, text="Remove", icon="X")


def _contact(layout: bpy.types.UILayout, item: bpy.types.Object) -> None:
    """Draw the collar and the wet band of an object, and the buttons that make, take or cut."""
    touches = contact.touches(item)
    if touches:
        for collar in contact.collars_of(item):
            column = layout.column(align=True)
            column.label(text="Foam and Ripples Around It")
            for name, *_ in LOOK_INPUTS:
                column.prop(collar.inputs[name], "default_value", text=name)
        modifier = contact.modifier_of(item)
        if modifier is not None:
            column = layout.column(align=True)
            for text in ("Wet Band", "Slop"):
                owner, name = input_property(modifier, text)
                column.prop(owner, name, text=text)
    text = "Leave Water Alone" if touches else float_operators.OBJECT_OT_ocean_contact.bl_label
    button = layout.operator(float_operators.OBJECT_OT_ocean_contact.bl_idname, text=text, icon="MOD_OCEAN")
    button.use_contact = not touches
    is_cut, cut_out = hull_cut.is_cut(item), float_operators.OBJECT_OT_ocean_cut_out
    text = "Let Water In" if is_cut else cut_out.bl_label
    layout.operator(cut_out.bl_idname, text=text, icon="SELECT_SUBTRACT").use_cut = not is_cut


CLASSES = (OCEAN_PT_float,)
