# SPDX-License-Identifier: GPL-3.0-or-later
"""A whole scene at one press."""

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import BoolProperty, EnumProperty

from ..scene import coast_scene, ocean_object, scene_sky, surroundings
from ..scene.moods import COASTS, MOODS
from ..scene.settings import settings_of
from .active_ocean import OfActiveOcean, refuse, shown_ocean
from .adding import InObjectMode, make_active
from .sky_operators import exposure_told

_ENGINES = [
    ("CYCLES", "Cycles", "Path tracing, with motion blur from the water's velocity"),
    ("EEVEE", "EEVEE", "Fast; its motion blur uses the steps between frames"),
]


class OCEAN_OT_add_scene(InObjectMode, bpy.types.Operator):
    """Add a sea with all that makes a picture of it."""

    bl_idname = "ocean.add_scene"
    bl_description = (
        "Add a sea with foam, water material, sky, sun, camera and something afloat. The cube, "
        "light and camera of Blender's start-up file are removed, unless the scene was changed"
    )
    bl_label = "Ocean Scene"
    bl_options = {"REGISTER", "UNDO"}

    mood: EnumProperty(
        name="Mood",
        items=[(key, mood.label, mood.description) for key, mood in (MOODS | COASTS).items()],
        default="FRESH_BREEZE",
        description="The sea, with its sky and water",
    )
    engine: EnumProperty(
        name="Render Engine", items=_ENGINES, default="CYCLES", description="Render engine of the scene"
    )
    use_new_scene: BoolProperty(
        name="New Scene",
        description="Make everything in a new scene, and leave this one unchanged",
        default=False,
    )
    use_new_camera: BoolProperty(
        name="Replace Camera",
        description="Look through the new camera even if the scene has one. The old camera is kept",
        default=False,
    )
    use_new_world: BoolProperty(
        name="Replace World",
        description="Give the scene a new sky even if it has one. The old world is kept in the file",
        default=False,
    )
    use_buoy: BoolProperty(
        name="Something Afloat",
        description=(
            "Let something of known size float in front of the camera: a boat in the storm, otherwise a buoy"
        ),
        default=True,
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Build the scene, and report what was kept."""
        old = context.scene
        scene = _new_scene(old) if self.use_new_scene else old
        wishes = surroundings.Wishes(
            engine=self.engine, camera=self.use_new_camera, world=self.use_new_world, afloat=self.use_buoy
        )
        if self.use_new_world and not self.use_new_scene:
            scene_sky.keep_world(old)
        collection = scene.collection if self.use_new_scene else context.collection
        try:
            build = coast_scene.build if self.mood in COASTS else surroundings.build
            made = build(scene, self.mood, wishes, collection)
        except ocean_object.EXPECTED_ERRORS as error:
            if self.use_new_scene:
                bpy.data.scenes.remove(scene)
            return refuse(self, error)
        if self.use_new_scene and context.window is not None:
            context.window.scene = scene
        layer = scene.view_layers[0] if scene != context.scene else context.view_layer
        make_active(made.ocean, layer)
        if scene.camera == made.camera and isinstance(context.space_data, bpy.types.SpaceView3D):
            context.space_data.region_3d.view_perspective = "CAMERA"
        self.report({"INFO"}, self._told(made, scene))
        return {"FINISHED"}

    def _told(self, made: surroundings.Made, scene: bpy.types.Scene) -> str:
        """Report what was created, kept and removed, and how to see the sea if the scene has another
        camera."""
        parts = [
            translated("{mood}: {engine}, motion blur on").format(
                mood=translated((MOODS | COASTS)[self.mood].label), engine=self.engine.title()
            )
        ]
        if made.replaced:
            parts.append(
                translated("removed the start-up file's {list}").format(list=", ".join(made.replaced))
            )
        if scene.camera != made.camera:
            parts.append(
                translated(
                    "the scene looks through {own}: to see the sea, select {new} and press Ctrl Numpad 0, "
                    "or choose Replace Camera"
                ).format(own=scene.camera.name, new=made.camera.name)
            )
        if made.kept:
            parts.append(translated("kept the scene's {list}").format(list=", ".join(made.kept)))
        return "; ".join(parts)


class OCEAN_OT_change_mood(OfActiveOcean, bpy.types.Operator):
    """Give the ocean and its scene another mood."""

    bl_idname = "ocean.change_mood"
    bl_description = (
        "Replace the sea of this ocean, the scene's sky and its camera by those of another mood. A camera "
        "and a world of your own are kept in the file; what you let float stays"
    )
    bl_label = "Change Mood"
    bl_options = {"REGISTER", "UNDO"}

    mood: EnumProperty(
        name="Mood",
        items=[(key, mood.label, mood.description) for key, mood in MOODS.items()],
        default="FRESH_BREEZE",
        description="The sea, with its sky and water",
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There is an ocean of this file, and objects can be added."""
        if not super().poll(context):
            return False
        cls.poll_message_set("Switch to Object Mode to change the mood")
        return context.mode == "OBJECT"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Change it, as a whole or not at all."""
        ocean, scene = shown_ocean(context), context.scene
        camera = scene.camera
        scene_sky.keep_world(scene)
        try:
            surroundings.change(ocean, self.mood, scene)
        except ocean_object.EXPECTED_ERRORS as error:
            return refuse(self, error)
        settings_of(ocean).preset = ""
        make_active(ocean, context.view_layer)
        told = [translated(MOODS[self.mood].label)]
        if camera is not None and camera != scene.camera:
            told.append(
                translated("the scene looks through a new camera, {own} is kept").format(own=camera.name)
            )
        if text := exposure_told(scene):
            told.append(text)
        self.report({"INFO"}, "; ".join(told))
        return {"FINISHED"}


def draw_add_menu(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    """Draw the entry in Add > Mesh."""
    text = "Ocean Scene" if shown_ocean(context) is None else "Ocean Scene (Another Ocean)"
    self.layout.operator_menu_enum(OCEAN_OT_add_scene.bl_idname, "mood", text=text, icon="SCENE_DATA")


def _new_scene(like: bpy.types.Scene) -> bpy.types.Scene:
    """An empty scene with the frame rate and the units of another."""
    scene = bpy.data.scenes.new("Ocean")
    scene.render.fps, scene.render.fps_base = like.render.fps, like.render.fps_base
    scene.unit_settings.scale_length = like.unit_settings.scale_length
    scene.unit_settings.system = like.unit_settings.system
    return scene


CLASSES = (OCEAN_OT_add_scene, OCEAN_OT_change_mood)
