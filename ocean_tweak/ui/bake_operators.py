# SPDX-License-Identifier: GPL-3.0-or-later
"""Bakes the active ocean in the background, deletes bakes, and copies a bake to another folder."""

from contextlib import suppress

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import BoolProperty, StringProperty

from ..core.data.printable import readable_bytes
from ..export.cache.job import CacheError
from ..export.cache.locks import Held
from ..scene import bake_process, bake_versions, cache_place, ocean_object
from ..scene.bake_process import BakeProcess
from ..scene.float_riding import undamped
from ..scene.image_sequence import find_sequence
from ..scene.portability import needs_of
from ..scene.settings import OceanObjectError, settings_of
from ..scene.shots import bake_shot_of, scene_frames
from .active_ocean import OfActiveOcean, refuse, shown_ocean
from .background_operator import BackgroundOperator, StopsProcess


class OCEAN_OT_bake(BackgroundOperator, bpy.types.Operator):
    """Bake the active ocean over the scene's frames."""

    bl_idname = "ocean.bake"
    bl_description = (
        "Write the scene's frames as EXR images into the cache; existing frames are kept. You "
        "can go on working; Esc stops after a complete frame"
    )
    bl_label = "Bake"
    bl_options = {"REGISTER"}
    processes = bake_process
    doing = "Baking"
    busy = "This ocean is being baked: wait, or stop it with Esc"

    use_result: BoolProperty(
        name="Use the Result",
        default=True,
        description="Show the baked frames when all are there",
    )

    def begin(self, context: bpy.types.Context) -> BakeProcess:
        """Bake the scene's frames."""
        item, frames = shown_ocean(context), scene_frames(context.scene)
        return bake_process.start(item, bake_shot_of(item, context.scene, frames), frames)

    def conclude(self, _context: bpy.types.Context) -> set[str]:
        """Report the result, and use the frames."""
        bake: BakeProcess = self._process
        item, scene = bpy.data.objects.get(self._item), bpy.data.scenes.get(self._scene)
        if item is None or scene is None:
            return refuse(self, f"{bake.name} is gone; its frames are in {bake.folder}")
        with suppress(OSError, OceanObjectError):  # the panel's list of versions is optional
            bake_versions.look(item)
        settings = settings_of(item)
        settings.bake_total = len(bake.frames)
        settings.bake_done = len(bake.frames) - bake.left + bake.done if bake.left else len(bake.frames)
        if not bake.is_complete:
            settings.bake_done = min(settings.bake_done, settings.bake_total - 1)
            if bake.is_stopped:
                self.report(
                    {"INFO"},
                    translated("Stopped after {done} frames{of}: bake again to continue").format(
                        done=bake.done, of=f" of {bake.phase}" if bake.phase else ""
                    ),
                )
                return {"CANCELLED"}
            return self.failed()
        if self.use_result and bake.folder is not None:
            try:
                ocean_object.use_sequence(item, scene, find_sequence(bake.folder))
            except ocean_object.EXPECTED_ERRORS as error:
                return refuse(self, error)
            if not bpy.app.background:
                bpy.ops.ed.undo_push(message="Bake")
        self.report(
            {"INFO"},
            translated("{count} frames in {folder}").format(count=len(bake.frames), folder=bake.folder),
        )
        for need in needs_of(item):
            text = translated("Needs Ocean Tweak where it is rendered: {need}")
            self.report({"WARNING"}, text.format(need=need.text))
        for floating in undamped(item):
            text = translated(
                "{name} follows the surface of the bake and is damped no longer: press Bake to Keyframes"
            )
            self.report({"WARNING"}, text.format(name=floating.name))
        return {"FINISHED"}


class OCEAN_OT_stop_bake(StopsProcess, bpy.types.Operator):
    """Stop baking the active ocean."""

    bl_idname = "ocean.stop_bake"
    bl_description = "Stop after the current frames; a later bake continues from there"
    bl_label = "Stop"
    bl_options = {"INTERNAL"}
    processes = bake_process
    idle = "The active object is not being baked"


class OCEAN_OT_look_at_bakes(OfActiveOcean, bpy.types.Operator):
    """List the active ocean's bakes on disk, and estimate the next one."""

    bl_idname = "ocean.look_at_bakes"
    bl_description = "List the bakes of this ocean with their sizes, and estimate the next one"
    bl_label = "Show Sizes"
    bl_options = {"INTERNAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Store the result for the panel."""
        try:
            bake_versions.foresee(shown_ocean(context), context.scene)
        except (OSError, *ocean_object.EXPECTED_ERRORS) as error:
            return refuse(self, error)
        return {"FINISHED"}


class OCEAN_OT_delete_bake(OfActiveOcean, bpy.types.Operator):
    """Delete old bakes of the active ocean from the disk."""

    bl_idname = "ocean.delete_bake"
    bl_description = "Delete the baked frames of this version from the disk; this cannot be undone"
    bl_label = "Delete Bake"
    bl_options = {"INTERNAL"}

    version: StringProperty(
        name="Version", options={"SKIP_SAVE"},
        description="Name of the bake's folder; empty for all bakes that no ocean of the file shows",
    )  # fmt: skip

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for confirmation."""
        listing = bake_versions.known(shown_ocean(context))
        frames = {version.folder.name: version.frames for version in listing.versions} if listing else {}
        what = f"{self.version}, frames: {frames.get(self.version, 0)}"
        if not self.version:
            what = translated("All bakes of this ocean that are not shown")
        return context.window_manager.invoke_confirm(
            self, event, title=translated("Delete from the disk?"), message=what, icon="WARNING"
        )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Delete, and report what was kept."""
        try:
            cleaned = bake_versions.delete(shown_ocean(context), [self.version] if self.version else [])
        except (OSError, CacheError, Held, *ocean_object.EXPECTED_ERRORS) as error:
            return refuse(self, error)
        size = readable_bytes(cleaned.bytes)
        if cleaned.left:
            return refuse(self, f"{cleaned.files} files deleted, {size}; left: {cleaned.left[0]}")
        self.report(
            {"INFO"}, translated("{count} files deleted, {size}").format(count=cleaned.files, size=size)
        )
        return {"FINISHED"}


class OCEAN_OT_take_cache_along(OfActiveOcean, bpy.types.Operator):
    """Copy the bake that the active ocean reads beside the file."""

    bl_idname = "ocean.take_cache_along"
    bl_description = (
        "Copy the baked frames that the ocean reads into its cache folder, and read them from there"
    )
    bl_label = "Copy Bake Here"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """The bake is in another folder."""
        if not super().poll(context):
            return False
        if not settings_of(shown_ocean(context)).bake_is_elsewhere:
            cls.poll_message_set("The ocean reads no bake from outside its cache folder")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Copy, then switch over."""
        item = shown_ocean(context)
        try:
            ocean_object.use_sequence(item, context.scene, cache_place.take_along(item))
        except (OSError, *ocean_object.EXPECTED_ERRORS) as error:
            return refuse(self, error)
        self.report(
            {"INFO"}, translated("The bake is in {folder}").format(folder=cache_place.shown_bake(item))
        )
        return {"FINISHED"}


CLASSES = (
    OCEAN_OT_bake,
    OCEAN_OT_stop_bake,
    OCEAN_OT_look_at_bakes,
    OCEAN_OT_delete_bake,
    OCEAN_OT_take_cache_along,
)
