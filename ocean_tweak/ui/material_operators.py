# SPDX-License-Identifier: GPL-3.0-or-later
"""The water material for an ocean."""

import bpy
from bpy.props import EnumProperty

from ..core import ParameterError
from ..scene import water_material
from ..scene.settings import settings_of
from .active_ocean import OfActiveOcean, refuse


class OCEAN_OT_use_water_material(OfActiveOcean, bpy.types.Operator):
    """Put the water material on the active ocean."""

    bl_idname = "ocean.use_water_material"
    bl_description = "Put the water material on the active ocean's first slot"
    bl_label = "Water Material"
    bl_options = {"REGISTER", "UNDO"}

    water: EnumProperty(
        name="Water",
        items=[(key, label, description) for key, (label, description, _) in water_material.WATERS.items()],
        default="OCEANIC",
        description="What is dissolved and afloat in the water",
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Make the material where the file has none, and assign it."""
        item, scene = context.active_object, context.scene
        try:
            parameters = settings_of(item).to_parameters(scene)
        except ParameterError as error:
            return refuse(self, error)
        water_material.assign(item, water_material.water_material(self.water))
        water_material.describe(item, parameters, scene)
        return {"FINISHED"}


CLASSES = (OCEAN_OT_use_water_material,)
