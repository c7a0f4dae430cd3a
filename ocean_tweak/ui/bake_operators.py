# SPDX-License-Identifier: GPL-3.0-or-later
"""Baking the active ocean beside Blender, and taking a bake along to another folder."""

import bpy
from bpy.props import BoolProperty

from ..core import ParameterError
from ..scene import bake_process, cache_place, ocean_object
from ..scene.bake_process import BakeProcess
from ..scene.image_sequence import find_sequence
from ..scene.settings import OceanObjectError, settings_of
from ..scene.shots import scene_frames, shot_of
from .active_ocean import OfActiveOcean, refuse

_LOOK = 0.1  # s


class OCEAN_OT_bake(OfActiveOcean, bpy.types.Operator):
    """Bake the active ocean over the scene's frames."""

    bl_idname = "ocean.bake"
    bl_description = (
        "Write the scene's frames as EXR images into the cache; frames that are there already stay. "
        "The window stays free, Esc stops after a whole frame"
    )
    bl_label = "Bake"
    bl_options = {"REGISTER"}

    use_result: BoolProperty(
        name="Use the Result",
        default=True,
        description="Let the baked frames move the ocean when all are there",
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """An ocean of this file that is not being baked."""
        if not super().poll(context):
            return False
        if bake_process.running(context.active_object):
            cls.poll_message_set("This ocean is being baked: wait, or stop it with Esc")
            return False
        return True

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Start, and look at it from time to time."""
        if not self._start(context):
            return {"CANCELLED"}
        self._timer = context.window_manager.event_timer_add(_LOOK, window=context.window)
        context.window_manager.modal_handler_add(self)
        self._tell(context)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show the progress; Esc stops."""
        if event.type == "ESC" and event.value == "PRESS" and not self._bake.is_stopped:
            self._bake.stop()
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if not self._bake.has_ended():
            self._tell(context)
            return {"PASS_THROUGH"}
        context.window_manager.event_timer_remove(self._timer)
        context.workspace.status_text_set(None)
        return self._finish(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Bake, and wait for it."""
        if not self._start(context):
            return {"CANCELLED"}
        self._bake.wait()
        return self._finish(context)

    def _start(self, context: bpy.types.Context) -> bool:
        item, scene = context.active_object, context.scene
        frames = scene_frames(scene)
        try:
            self._bake = bake_process.start(item, shot_of(item, scene, frames), frames)
        except (ParameterError, OceanObjectError, OSError) as error:
            refuse(self, error)
            return False
        self._item, self._scene = item.name, scene.name
        return True

    def _tell(self, context: bpy.types.Context) -> None:
        bake = self._bake
        doing = "Finishing the frame" if bake.is_stopped else f"Baking {bake.name}"
        context.workspace.status_text_set(f"{doing}: {bake.done} of {bake.left or '…'}   |   Esc: stop")
        _redraw(context)

    def _finish(self, context: bpy.types.Context) -> set[str]:
        bake: BakeProcess = self._bake
        bake_process.forget(bake)
        _redraw(context)
        item, scene = bpy.data.objects.get(self._item), bpy.data.scenes.get(self._scene)
        if item is None or scene is None:
            return refuse(self, f"{bake.name} is gone; its frames are in {bake.folder}")
        settings = settings_of(item)
        settings.bake_total = len(bake.frames)
        settings.bake_done = len(bake.frames) - bake.left + bake.done if bake.left else len(bake.frames)
        if not bake.is_complete:
            if bake.is_stopped:
                self.report({"INFO"}, f"Stopped after {bake.done} frames: bake again to go on")
                return {"CANCELLED"}
            settings.bake_done = min(settings.bake_done, settings.bake_total - 1)
            return refuse(self, bake.error or "The bake failed without a word")
        if self.use_result and bake.folder is not None:
            try:
                ocean_object.use_sequence(item, scene, find_sequence(bake.folder))
            except ocean_object.EXPECTED_ERRORS as error:
                return refuse(self, error)
            if not bpy.app.background:
                bpy.ops.ed.undo_push(message="Bake")
        self.report({"INFO"}, f"{len(bake.frames)} frames in {bake.folder}")
        return {"FINISHED"}


class OCEAN_OT_stop_bake(bpy.types.Operator):
    """Stop baking the active ocean."""

    bl_idname = "ocean.stop_bake"
    bl_description = "Stop after the frames that are under way; a later bake goes on from there"
    bl_label = "Stop"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """It is being baked."""
        item = context.active_object
        if item is None or bake_process.running(item) is None:
            cls.poll_message_set("The active object is not being baked")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Ask for the end; the running operator sees it."""
        bake_process.running(context.active_object).stop()
        return {"FINISHED"}


class OCEAN_OT_take_cache_along(OfActiveOcean, bpy.types.Operator):
    """Copy the bake that the active ocean reads beside the file."""

    bl_idname = "ocean.take_cache_along"
    bl_description = "Copy the baked frames that the ocean reads into its cache folder, and read them there"
    bl_label = "Copy Bake Here"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """The bake lies elsewhere."""
        if not super().poll(context):
            return False
        if not cache_place.is_left_behind(context.active_object):
            cls.poll_message_set("The ocean reads no bake from outside its cache folder")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Copy, then switch over."""
        item = context.active_object
        try:
            ocean_object.use_sequence(item, context.scene, cache_place.take_along(item))
        except (OSError, *ocean_object.EXPECTED_ERRORS) as error:
            return refuse(self, error)
        self.report({"INFO"}, f"The bake is in {cache_place.shown_bake(item)}")
        return {"FINISHED"}


def _redraw(context: bpy.types.Context) -> None:
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


CLASSES = (OCEAN_OT_bake, OCEAN_OT_stop_bake, OCEAN_OT_take_cache_along)
