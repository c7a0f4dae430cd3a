# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds an ocean; base class and helpers of such operators."""

import bpy
from bpy.props import EnumProperty

from ..core import OceanParameters, Timing
from ..scene import middle, ocean_object, water_material
from ..scene.settings import METHODS, VIEWPORT_RESOLUTION
from ..scene.units import frame_rate
from .active_ocean import refuse


class InObjectMode:
    """Operators that add an object."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Objects are added in Object Mode."""
        cls.poll_message_set("Switch to Object Mode to add an ocean")
        return context.mode == "OBJECT"


def make_active(item: bpy.types.Object, layer: bpy.types.ViewLayer) -> None:
    """Make an object the only selected one of a view layer, and the active one."""
    layer.update()  # the view layer does not know yet what has just been linked
    for other in tuple(layer.objects.selected):
        other.select_set(False, view_layer=layer)
    # an excluded collection keeps its objects out of the view layer
    if item.name in layer.objects:
        item.select_set(True, view_layer=layer)
        layer.objects.active = item


def default_sea(scene: bpy.types.Scene) -> OceanParameters:
    """The default sea, a strong breeze on the open sea, with time zero at the scene's first frame."""
    return OceanParameters(timing=Timing(fps=frame_rate(scene), start_frame=scene.frame_start))


class MESH_OT_ocean_tweak_add(InObjectMode, bpy.types.Operator):
    """Add a patch of sea that moves on playback."""

    bl_idname = "mesh.ocean_tweak_add"
    bl_description = "Add a patch of sea that moves on playback"
    bl_label = "Ocean Tweak"
    bl_options = {"REGISTER", "UNDO"}

    method: EnumProperty(
        name="Method",
        items=[(key, *texts) for key, texts in METHODS.items()],
        default="NODES",
        description="What moves the mesh",
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add the default sea around the 3D cursor."""
        scene = context.scene
        parameters = default_sea(scene)
        try:
            item = ocean_object.add(
                scene, parameters, method=self.method, collection=context.collection,
                viewport_resolution=VIEWPORT_RESOLUTION,
            )  # fmt: skip
        except ocean_object.EXPECTED_ERRORS as error:
            return refuse(self, error)
        water_material.assign(item, water_material.water_material())
        water_material.describe(item, parameters, scene)
        middle.put(item, scene.cursor.location)
        make_active(item, context.view_layer)
        return {"FINISHED"}


CLASSES = (MESH_OT_ocean_tweak_add,)
