# SPDX-License-Identifier: GPL-3.0-or-later
"""The bed over which waves run ashore."""

import bpy

from ...scene import refinement
from ..active_ocean import shown_ocean
from ..coast_operators import OCEAN_OT_make_coast
from ..field_drawing import draw_fields
from .drawing import SubPanel, active_settings, split
from .masks import draw_image


class OCEAN_PT_coast(SubPanel, bpy.types.Panel):
    """The coast of the ocean."""

    bl_idname = "OCEAN_PT_coast"
    bl_label = "Coast"

    def draw_header(self, context: bpy.types.Context) -> None:
        """Draw its switch."""
        self.layout.prop(active_settings(context).coast, "use", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """Draw its settings."""
        layout, group = split(self.layout), active_settings(context).coast
        layout.prop(group, "bed")
        layout.prop(group, "shore")
        text = "Make Coast" if group.image is None else "Read Again"
        layout.operator(OCEAN_OT_make_coast.bl_idname, text=text, icon="FILE_REFRESH")
        if not group.use:
            return
        progress = refinement.progress_of(shown_ocean(context))
        if progress is not None:
            layout.progress(factor=progress.share, text=progress.doing)
        draw_image(layout, group)
        draw_fields(layout.column(align=True), group, "spacing", "x", "y")
        shown = layout.column(align=True, heading="Show")
        draw_fields(shown, group, "show_height", "show_direction")
        draw_fields(layout, group, "rim", "shortest_wavelength", "step", "mirror", "breaking", "muted")


CLASSES = (OCEAN_PT_coast,)
