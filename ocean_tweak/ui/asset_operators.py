# SPDX-License-Identifier: GPL-3.0-or-later
"""Node groups and material for the asset browser."""

import bpy
from bpy.app.translations import pgettext_rpt as translated

from ..scene import asset_library
from .active_ocean import refuse


class OCEAN_OT_install_assets(bpy.types.Operator):
    """Put node groups and materials into the asset browser."""

    bl_idname = "ocean.install_assets"
    bl_description = (
        "Write the node groups and water materials into a library in your own folder, and add it to the "
        "asset browser. Disabling the extension takes it out again"
    )
    bl_label = "Install Ocean Assets"
    bl_options = {"REGISTER"}

    def execute(self, _context: bpy.types.Context) -> set[str]:
        """Write the library; a second time brings it up to date."""
        try:
            path = asset_library.install()
        except OSError as error:
            return refuse(self, error)
        self.report(
            {"INFO"},
            translated("Assets of {library} are in {folder}").format(
                library=asset_library.LIBRARY, folder=path
            ),
        )
        return {"FINISHED"}


CLASSES = (OCEAN_OT_install_assets,)
