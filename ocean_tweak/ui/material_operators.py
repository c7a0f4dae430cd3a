# SPDX-License-Identifier: GPL-3.0-or-later
"""Water materials: on an ocean and, with the node groups, in the asset browser."""

from collections.abc import Sequence

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import EnumProperty

from ..core import ParameterError
from ..scene import asset_library, contact, hull_cut, solid_foam, water_material
from ..scene.camera_surface import camera_surface_of
from ..scene.settings import settings_of
from ..scene.water_colour import BRIGHTEST
from .active_ocean import OfActiveOcean, refuse, shown_ocean


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
        description="What is dissolved and suspended in the water",
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Make the material where the file has none, and assign it."""
        item, scene = shown_ocean(context), context.scene
        try:
            parameters = settings_of(item).to_parameters(scene)
        except ParameterError as error:
            return refuse(self, error)
        material = water_material.water_material(self.water)
        water_material.assign(item, material)
        water_material.describe(item, parameters, scene)
        surface = camera_surface_of(item)
        if surface is not None:
            solid_foam.show(surface, material)
        contact.refresh()
        hull_cut.refresh()
        return {"FINISHED"}


class OCEAN_OT_install_assets(bpy.types.Operator):
    """Put node groups and materials into the asset browser."""

    bl_idname = "ocean.install_assets"
    bl_description = (
        "Write the node groups and water materials into a library in your user folder, and add "
        "it to the asset browser. Disabling the extension removes it"
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


def _colour(material: bpy.types.Material) -> tuple[float, ...]:
    if water_material.water_node(material) is None:
        return (0.0, 0.0, 0.0)
    return tuple(part / BRIGHTEST for part in water_material.colour_of(material))


def _set_colour(material: bpy.types.Material, colour: Sequence[float]) -> None:
    if water_material.water_node(material) is not None:
        water_material.set_colour(material, [part * BRIGHTEST for part in colour])


def register() -> None:
    """Give materials the colour of their water, which holds nothing itself."""
    bpy.types.Material.ocean_tweak_water_colour = bpy.props.FloatVectorProperty(
        name="Water Color", subtype="COLOR", size=3, min=0.0, max=1.0, precision=3, options=set(),
        get=_colour, set=_set_colour,
        description="Colour of deep water; white is the brightest that water can be. The material's "
        "Absorption and Backscatter follow, and can be keyed",
    )  # fmt: skip


def unregister() -> None:
    """Take it back."""
    del bpy.types.Material.ocean_tweak_water_colour


CLASSES = (OCEAN_OT_use_water_material, OCEAN_OT_install_assets)
