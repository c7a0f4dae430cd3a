# SPDX-License-Identifier: GPL-3.0-or-later
"""Switches the active ocean between baked files and a live sea."""

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import BoolProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from ..core.data.frames import format_frames
from ..export.exr import ExrError
from ..scene import bake_state, ocean_object
from ..scene.image_sequence import find_sequence
from ..scene.refinement import show
from ..scene.refresh import Wanted
from ..scene.settings import settings_of
from ..scene.shots import animate, check_keys
from .active_ocean import OfActiveOcean, refuse, shown_ocean
from .parameter_operators import apply_parameters


class OCEAN_OT_use_sequence(OfActiveOcean, bpy.types.Operator, ImportHelper):
    """Let baked files move the active ocean."""

    bl_idname = "ocean.use_sequence"
    bl_description = "Show baked files on the active ocean: choose any file NAME_disp.####.exr, or a folder"
    bl_label = "Use Baked Sequence"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ".exr"
    filter_glob: StringProperty(default="*_disp.*.exr", options={"HIDDEN"})
    use_parameters: BoolProperty(
        name="Use Its Parameters",
        description="Use the sea that the files were baked from, with its domain size and frame rate",
        default=True,
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Find the sequence and switch to it."""
        item, scene = shown_ocean(context), context.scene
        try:
            sequence = find_sequence(self.filepath)
            if self.use_parameters:
                first = sequence.frames[0]
                parameters = bake_state.parameters_of(sequence.path(first), first)
                apply_parameters(context, parameters, use_frame_rate=True)
            ocean_object.use_sequence(item, scene, sequence)
        except (ExrError, *ocean_object.EXPECTED_ERRORS) as error:
            return refuse(self, error)
        self.report(
            {"INFO"},
            translated("{name}: frames {frames}").format(
                name=sequence.name, frames=format_frames(sequence.frames)
            ),
        )
        return {"FINISHED"}


class OCEAN_OT_use_live(OfActiveOcean, bpy.types.Operator):
    """Compute the active ocean on every frame again."""

    bl_idname = "ocean.use_live"
    bl_description = "Compute the active ocean live again"
    bl_label = "Back to Live"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Switch the source; what is wrong with the settings stands in the panel."""
        settings_of(shown_ocean(context)).source = "LIVE"
        return {"FINISHED"}


class OCEAN_OT_settings_from_bake(OfActiveOcean, bpy.types.Operator):
    """Give the active ocean the settings of the bake that it shows."""

    bl_idname = "ocean.settings_from_bake"
    bl_description = "Give the ocean the settings, keys and frame rate of the bake that it shows"
    bl_label = "Settings From Bake"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """A bake moves the ocean."""
        if not super().poll(context):
            return False
        if settings_of(shown_ocean(context)).source != "SEQUENCE":
            cls.poll_message_set("The ocean shows no bake")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Take over the sea, or change nothing."""
        item, scene = shown_ocean(context), context.scene
        shot = bake_state.baked_shot(settings_of(item))
        if shot is None:
            return refuse(self, "The files do not say which sea they were baked from")
        try:
            check_keys(shot)
            apply_parameters(context, shot.parameters, use_frame_rate=True)
        except ocean_object.EXPECTED_ERRORS as error:
            return refuse(self, error)
        animate(item, scene, shot)
        show(item, scene, Wanted.BAKE)
        return {"FINISHED"}


CLASSES = (OCEAN_OT_use_sequence, OCEAN_OT_use_live, OCEAN_OT_settings_from_bake)
