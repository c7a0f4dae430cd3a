# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of wave layers: add, remove, duplicate, solo."""

import dataclasses

import bpy

from ..core import OceanParameters, ParameterError, WaveLayer
from ..scene.settings import OceanObjectError, settings_of
from .active_ocean import OfActiveOcean, refuse


class _OfLayers(OfActiveOcean):
    """Operators that change the list as a whole, through the parameters."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """The list can be changed."""
        if not super().poll(context):
            return False
        if context.active_object.override_library:
            cls.poll_message_set("A library override keeps its layers: make the ocean local first")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Change the list, and keep a layer active."""
        settings = settings_of(context.active_object)
        try:
            parameters = settings.to_parameters(context.scene)
            layers, active = self.changed(parameters, min(settings.active_layer, len(parameters.layers) - 1))
            settings.from_parameters(parameters.replace(layers=layers), context.scene)
        except (ParameterError, OceanObjectError) as error:
            return refuse(self, error)
        settings.active_layer = active
        return {"FINISHED"}


class OCEAN_OT_layer_add(_OfLayers, bpy.types.Operator):
    """Add a wave layer."""

    bl_idname = "ocean.layer_add"
    bl_description = "Add a wave layer, for example a swell from another direction"
    bl_label = "Add Layer"
    bl_options = {"REGISTER", "UNDO"}

    def changed(self, parameters: OceanParameters, _active: int) -> tuple[tuple[WaveLayer, ...], int]:
        """A default layer at the end."""
        return (*parameters.layers, WaveLayer()), len(parameters.layers)


class OCEAN_OT_layer_duplicate(_OfLayers, bpy.types.Operator):
    """Duplicate the active layer."""

    bl_idname = "ocean.layer_duplicate"
    bl_description = "Duplicate the active layer; the copy has waves of its own"
    bl_label = "Duplicate Layer"
    bl_options = {"REGISTER", "UNDO"}

    def changed(self, parameters: OceanParameters, active: int) -> tuple[tuple[WaveLayer, ...], int]:
        """A copy with another identity behind the active one."""
        copy = dataclasses.replace(parameters.layers[active], id=-1)
        layers = parameters.layers
        return (*layers[: active + 1], copy, *layers[active + 1 :]), active + 1


class OCEAN_OT_layer_remove(_OfLayers, bpy.types.Operator):
    """Remove the active layer."""

    bl_idname = "ocean.layer_remove"
    bl_description = "Remove the active layer; the others keep their waves"
    bl_label = "Remove Layer"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """One must stay."""
        if not super().poll(context):
            return False
        if len(settings_of(context.active_object).layers) < 2:
            cls.poll_message_set("A sea has at least one layer: mute it for flat water")
            return False
        return True

    def changed(self, parameters: OceanParameters, active: int) -> tuple[tuple[WaveLayer, ...], int]:
        """The others."""
        layers = parameters.layers
        return (*layers[:active], *layers[active + 1 :]), max(active - 1, 0)


class OCEAN_OT_layer_solo(_OfLayers, bpy.types.Operator):
    """Hear the active layer alone."""

    bl_idname = "ocean.layer_solo"
    bl_description = "Mute all layers but the active one; again, to have all of them back"
    bl_label = "Solo Layer"
    bl_options = {"REGISTER", "UNDO"}

    def changed(self, parameters: OceanParameters, active: int) -> tuple[tuple[WaveLayer, ...], int]:
        """The active layer alone, or all."""
        alone = tuple(index != active for index in range(len(parameters.layers)))
        is_alone = tuple(layer.muted for layer in parameters.layers) == alone
        muted = (False,) * len(alone) if is_alone else alone
        return (
            tuple(
                dataclasses.replace(layer, muted=is_muted)
                for layer, is_muted in zip(parameters.layers, muted, strict=True)
            ),
            active,
        )


#: buttons beside the list, and their icons
BUTTONS = (
    (OCEAN_OT_layer_add, "ADD"),
    (OCEAN_OT_layer_remove, "REMOVE"),
    (OCEAN_OT_layer_duplicate, "DUPLICATE"),
    (OCEAN_OT_layer_solo, "SOLO_ON"),
)

CLASSES = tuple(operator for operator, _ in BUTTONS)
