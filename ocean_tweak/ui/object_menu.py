# SPDX-License-Identifier: GPL-3.0-or-later
"""What can be done with the active ocean, in the Object menu, where F3 finds it too."""

import bpy

from . import (
    bake_operators,
    camera_operators,
    mask_operators,
    material_operators,
    parameter_operators,
    patch_operators,
    sea_operators,
    sequence_operators,
    usd_operators,
    wind_operators,
)

#: in groups
_OPERATORS = (
    (
        sea_operators.OCEAN_OT_convert,
        sea_operators.OCEAN_OT_match_sea_state,
        patch_operators.OCEAN_OT_plan_patches,
        wind_operators.OCEAN_OT_record_wind,
        mask_operators.OCEAN_OT_read_weights,
    ),
    (
        camera_operators.OCEAN_OT_add_camera_surface,
        camera_operators.OCEAN_OT_remove_camera_surface,
        material_operators.OCEAN_OT_use_water_material,
    ),
    (
        bake_operators.OCEAN_OT_bake,
        sequence_operators.OCEAN_OT_use_sequence,
        sequence_operators.OCEAN_OT_use_live,
        usd_operators.OCEAN_OT_verify_usd,
    ),
    (parameter_operators.OCEAN_OT_import_parameters, parameter_operators.OCEAN_OT_export_parameters),
)


class OCEAN_MT_object(bpy.types.Menu):
    """The operators of the active ocean."""

    bl_idname = "OCEAN_MT_object"
    bl_label = "Ocean Tweak"

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw them; those that cannot be used now are grey and say why."""
        for index, group in enumerate(_OPERATORS):
            if index:
                self.layout.separator()
            for operator in group:
                self.layout.operator(operator.bl_idname)


def draw_object_menu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    """Draw the entry in the Object menu."""
    self.layout.menu(OCEAN_MT_object.bl_idname, icon="MOD_OCEAN")


CLASSES = (OCEAN_MT_object,)
