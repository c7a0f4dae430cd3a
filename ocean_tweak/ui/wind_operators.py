# SPDX-License-Identifier: GPL-3.0-or-later
"""Where winds and images come from: force fields are recorded, image files read again."""

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import IntProperty

from ..core import ParameterError
from ..scene import source_images, wind_recording
from ..scene.refinement import show
from ..scene.settings import OceanObjectError, settings_of
from . import layer_properties
from .active_ocean import OfActiveOcean, active_layer, refuse, shown_ocean


class OCEAN_OT_record_wind(OfActiveOcean, bpy.types.Operator):
    """Record force fields into the active wind field."""

    bl_idname = "ocean.record_wind"
    bl_description = (
        "Record the force fields of type Wind over the patch from frame to frame; strength 1 is "
        "1 m/s. Waves keep the wind they were born with, so record again after changing a field"
    )
    bl_label = "Record Wind"
    bl_options = {"REGISTER", "UNDO"}

    first: IntProperty(
        name="First Frame",
        default=1,
        description="First frame of the recording; before it, the wind is held",
    )
    last: IntProperty(
        name="Last Frame",
        default=250,
        description="Last frame of the recording; after it, the wind is held",
    )
    step: IntProperty(
        name="Step", default=4, min=1, max=1000,
        description="Record one frame in so many; the wind is linear in between",
    )  # fmt: skip
    samples: IntProperty(
        name="Samples", default=32, min=1, max=256,
        description="Vectors along each side of the patch",
    )  # fmt: skip

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """A wind field is the active layer."""
        if not super().poll(context):
            return False
        if _active_wind(context) is None:
            cls.poll_message_set("Choose a wind field in the list of layers, or add one")
            return False
        return True

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Ask for the frames, by default the scene's."""
        self.first, self.last = context.scene.frame_start, context.scene.frame_end
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Record as a whole, or change nothing."""
        item, scene, group = shown_ocean(context), context.scene, _active_wind(context)
        if self.last < self.first:
            return refuse(self, f"The last frame {self.last} lies before the first one, {self.first}")
        frames = sorted({*range(self.first, self.last + 1, self.step), self.last})
        manager = context.window_manager
        manager.progress_begin(0, len(frames))
        try:
            keys = wind_recording.record(
                item, scene, frames, self.samples, group.objects, manager.progress_update
            )
            _keep(context, group, keys)
        except (ParameterError, OceanObjectError) as error:
            return refuse(self, error)
        finally:
            manager.progress_end()
        self.report(
            {"INFO"},
            translated("Wind of frames {first} to {last} in {count} keys").format(
                first=self.first, last=self.last, count=len(keys)
            ),
        )
        return {"FINISHED"}


class OCEAN_OT_reload_image(OfActiveOcean, bpy.types.Operator):
    """Read the active layer's image again."""

    bl_idname = "ocean.reload_image"
    bl_description = "Read the image's file again, and update the waves"
    bl_label = "Reload Image"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """The active layer has an image."""
        if not super().poll(context):
            return False
        if _active_image(context) is None:
            cls.poll_message_set("The active layer has no image")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Reload, and show; changes that were not saved are lost, as with Blender's own Reload."""
        image = _active_image(context)
        image.reload()
        source_images.forget(image)
        show(shown_ocean(context), context.scene)
        return {"FINISHED"}


def _active_wind(context: bpy.types.Context) -> bpy.types.PropertyGroup | None:
    layer = active_layer(settings_of(shown_ocean(context)))
    return layer.wind_field if layer is not None and layer.kind == "WIND_FIELD" else None


def _active_image(context: bpy.types.Context) -> bpy.types.Image | None:
    layer = active_layer(settings_of(shown_ocean(context)))
    return layer_properties.source_image(layer) if layer is not None else None


def _keep(
    context: bpy.types.Context, group: bpy.types.PropertyGroup, keys: tuple[wind_recording.WindKey, ...]
) -> None:
    """Let a wind field use keys. Raises ParameterError, and changes nothing, where the sea cannot."""
    settings = settings_of(shown_ocean(context))
    before = {name: getattr(group, name) for name in ("recording", "recording_hash", "source")}
    with settings.quiet():
        layer_properties.set_recording(group, keys)
        try:
            settings.to_parameters(context.scene)
        except ParameterError:
            for name, value in before.items():
                setattr(group, name, value)
            raise
    show(shown_ocean(context), context.scene)


CLASSES = (OCEAN_OT_record_wind, OCEAN_OT_reload_image)
