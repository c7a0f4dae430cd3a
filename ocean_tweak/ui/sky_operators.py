# SPDX-License-Identifier: GPL-3.0-or-later
"""The sky of a scene: chosen from presets, and given a panorama."""

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import EnumProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from ..scene import panorama, scene_sky, stored_paths
from ..scene.settings import OceanObjectError
from ..scene.skies import SKIES
from .active_ocean import refuse, shown_ocean


def exposure_told(scene: bpy.types.Scene) -> str:
    """What to say of a scene that keeps its own exposure; "" where it follows the sky's."""
    settings = scene_sky.settings_of(scene)
    if settings.use_exposure:
        return ""
    return translated("exposure stays {own:.1f}, this sky is made for {wanted:.1f}").format(
        own=scene.view_settings.exposure, wanted=settings.exposure
    )


class OCEAN_OT_use_sky(bpy.types.Operator):
    """Give the scene a sky."""

    bl_idname = "ocean.use_sky"
    bl_description = (
        "Give the scene a sky with sun, moon and haze, as its camera sees it. A world of your own is kept "
        "in the file"
    )
    bl_label = "Sky"
    bl_options = {"REGISTER", "UNDO"}

    sky: EnumProperty(
        name="Sky",
        items=[(key, preset.label, preset.description) for key, preset in SKIES.items()],
        default="NOON",
        description="Time of day and weather",
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """The scene has an ocean, and is this file's own."""
        if shown_ocean(context) is None:
            cls.poll_message_set("There is no ocean in this scene: add one first")
            return False
        if context.scene.library is not None:
            cls.poll_message_set("The scene is linked from another file: its sky is set there")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Put it, and say what stays as it is."""
        scene, preset = context.scene, SKIES[self.sky]
        scene_sky.keep_world(scene)
        scene_sky.put(scene, scene_sky.preset_sky(self.sky, scene))
        told = [translated(preset.label)]
        if text := exposure_told(scene):
            told.append(text)
        suns = scene_sky.other_suns(scene)
        if suns:
            told.append(translated("also lit by {list}").format(list=", ".join(suns)))
        self.report({"INFO"}, "; ".join(told))
        return {"FINISHED"}


class _OfSky:
    """Operators on a scene that has a sky of ours."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """The scene has one."""
        if not scene_sky.has_sky(context.scene):
            cls.poll_message_set(
                "The scene has no sky of Ocean Tweak: choose one in Sky, for a scene with an ocean"
            )
            return False
        return True


class OCEAN_OT_load_hdri(_OfSky, ImportHelper, bpy.types.Operator):
    """Show a panorama of one's own in the sky's place."""

    bl_idname = "ocean.load_hdri"
    bl_description = "Show an HDRI, a .hdr or .exr panorama, in the place of the sky and its sun"
    bl_label = "Open HDRI"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default="*.hdr;*.exr", options={"HIDDEN"})

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Measure it, then load it."""
        try:
            path = stored_paths.absolute(self.filepath)
            panorama.check(path)
            image = bpy.data.images.load(str(path), check_existing=True)
        except (panorama.PanoramaError, OceanObjectError, RuntimeError) as error:
            return refuse(self, error)
        scene_sky.settings_of(context.scene).hdri = image
        return {"FINISHED"}


class OCEAN_OT_remove_hdri(_OfSky, bpy.types.Operator):
    """Show the sky again."""

    bl_idname = "ocean.remove_hdri"
    bl_description = "Show the sky and its sun again in the place of the HDRI"
    bl_label = "Remove HDRI"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There is one."""
        if not super().poll(context):
            return False
        if scene_sky.settings_of(context.scene).hdri is None:
            cls.poll_message_set("There is no HDRI in the sky's place")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Take it away."""
        scene_sky.settings_of(context.scene).hdri = None
        return {"FINISHED"}


CLASSES = (OCEAN_OT_use_sky, OCEAN_OT_load_hdri, OCEAN_OT_remove_hdri)
