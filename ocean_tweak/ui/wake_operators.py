# SPDX-License-Identifier: GPL-3.0-or-later
"""Make Waves: what the artist presses to let objects leave wakes on an ocean."""

from collections.abc import Callable

import bpy
from bpy.app.translations import pgettext_rpt as translated

from ..core import ParameterError, WakeLayer
from ..scene import floating
from ..scene.camera_surface import add_camera_surface
from ..scene.plan import camera_surface_of
from ..scene.settings import OceanObjectError, settings_of
from ..scene.wake_recording import new_wake
from .active_ocean import refuse
from .float_operators import OnOcean, floatable


class OBJECT_OT_ocean_wake(OnOcean, bpy.types.Operator):
    """Let the selected objects make waves."""

    bl_idname = "object.ocean_tweak_wake"
    bl_description = (
        "Let the selected objects leave wakes and foam on the ocean, along their keyed or recorded paths. A "
        "camera surface shows them, and is added where there is none. Use it again after a change of the "
        "object's size, or of a motion that is not keyed"
    )
    bl_label = "Make Waves"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Give the ocean a layer for each of them, or the one it has a new size and path."""
        done, told = 0, []
        try:
            ocean = self.chosen_ocean(context)
            if ocean.library is not None or ocean.override_library is not None:
                raise OceanObjectError(f"{ocean.name} is of another file: make it local first")
            for item in floating.outermost(floatable(context)):
                try:
                    _make(item, ocean, context.scene, told.append)
                    done += 1
                except (OceanObjectError, ParameterError) as error:
                    told.append(f"{item.name}: {error}" if item.name not in str(error) else str(error))
        except (OceanObjectError, ParameterError) as error:
            return refuse(self, error)
        if told:
            self.report({"WARNING" if done else "ERROR"}, "; ".join(told))
        else:
            text = translated("Objects that make waves on {ocean}: {count}")
            self.report({"INFO"}, text.format(ocean=ocean.name, count=done))
        return {"FINISHED"} if done else {"CANCELLED"}


def _make(
    item: bpy.types.Object, ocean: bpy.types.Object, scene: bpy.types.Scene, warn: Callable[[str], None]
) -> None:
    """Give an ocean the wake of an object, and a surface that can show it."""
    settings = settings_of(ocean)
    makers = {maker: number for number, maker in settings.wake_makers()}
    sea = settings.to_parameters(scene)
    layers, number = list(sea.layers), makers.get(item, len(sea.layers))
    known = layers[number] if item in makers else None
    known = known if isinstance(known, WakeLayer) else None
    layers[number : number + 1] = [new_wake(item, ocean, scene, known, warn)]
    changed = sea.replace(layers=tuple(layers))
    if camera_surface_of(ocean) is None:
        add_camera_surface(ocean, scene)
    settings.from_parameters(changed, scene)
    settings.set_wake_maker(number, item)
    settings.active_layer = number


CLASSES = (OBJECT_OT_ocean_wake,)
