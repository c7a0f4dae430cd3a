# SPDX-License-Identifier: GPL-3.0-or-later
"""Making a coast of the mesh of a sea bed."""

import bpy

from ..scene import coast_bed, coast_surface
from ..scene.refresh import EXPECTED_ERRORS
from ..scene.settings import settings_of
from ..scene.units import metres_per_unit
from . import coast_properties
from .active_ocean import OfActiveOcean, refuse, shown_ocean


class OCEAN_OT_make_coast(OfActiveOcean, bpy.types.Operator):
    """Let the ocean's waves run ashore over a mesh."""

    bl_idname = "ocean.make_coast"
    bl_description = (
        "Read the depths of the mesh chosen as Sea Bed, and let waves turn, rise and break over it. Read "
        "them again after the mesh was changed or moved"
    )
    bl_label = "Make Coast"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Read the bed, and show the sea over it."""
        ocean = shown_ocean(context)
        group, metres = settings_of(ocean).coast, metres_per_unit(context.scene)
        try:
            bed = coast_bed.read_bed(ocean, group.bed, context.scene, float(1 / metres))
        except EXPECTED_ERRORS as error:
            return refuse(self, error)
        coast_properties.take_bed(group, bed, metres)
        coast_surface.dry_other_beds()
        if settings_of(ocean).error:
            self.report({"WARNING"}, settings_of(ocean).error)
        return {"FINISHED"}


CLASSES = (OCEAN_OT_make_coast,)
