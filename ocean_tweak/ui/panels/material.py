# SPDX-License-Identifier: GPL-3.0-or-later
"""The look of the active ocean's water: the most important inputs of its material."""

import bpy

from ...scene import water_material
from .. import material_operators
from ..active_ocean import shown_ocean
from .drawing import OceanPanel, split

#: inputs of the water's node, as they are called there
_WATER = ("Crest Light", "Crest Glow", "Bubbles")
_FOAM = ("Foam Amount", "Foam Size", "Foam Color")
_SURFACE = ("Slopes", "Ripples", "Gusts")


class OCEAN_PT_material(OceanPanel, bpy.types.Panel):
    """The look of the active ocean's water."""

    bl_idname = "OCEAN_PT_material"
    bl_label = "Look"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the button that gives it water, and that water's colour, foam and surface."""
        material = shown_ocean(context).active_material
        operator = material_operators.OCEAN_OT_use_water_material.bl_idname
        text = "Water Material" if material is None else material.name
        self.layout.operator_menu_enum(operator, "water", text=text, icon="MATFLUID")
        node = water_material.water_node(material)
        if node is None:
            return
        layout = split(self.layout, animated=True)
        layout.prop(material, "ocean_tweak_water_colour")
        for names in (_WATER, _FOAM, _SURFACE):
            column = layout.column(align=True)
            for socket in (node.inputs[name] for name in names if name in node.inputs):
                column.prop(socket, "default_value", text=socket.name)


CLASSES = (OCEAN_PT_material,)
