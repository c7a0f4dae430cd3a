# SPDX-License-Identifier: GPL-3.0-or-later
"""The active ocean's material."""

import bpy

from .. import material_operators
from .drawing import OceanPanel


class OCEAN_PT_material(OceanPanel, bpy.types.Panel):
    """The active ocean's material."""

    bl_idname = "OCEAN_PT_material"
    bl_label = "Material"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw what the ocean has, and the button that gives it water."""
        material = context.active_object.active_material
        if material is not None:
            self.layout.label(text=material.name, icon="MATERIAL")
        operator = material_operators.OCEAN_OT_use_water_material.bl_idname
        self.layout.operator_menu_enum(operator, "water", text="Water Material", icon="MATFLUID")


CLASSES = (OCEAN_PT_material,)
