# SPDX-License-Identifier: GPL-3.0-or-later
"""A whole scene at one press, and the water material for an ocean."""

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import BoolProperty, EnumProperty

from ..core import ParameterError
from ..scene import ocean_object, stage, water_material
from ..scene.moods import MOODS
from ..scene.settings import is_ocean, settings_of
from .active_ocean import OfActiveOcean, refuse

_ENGINES = [
    ("CYCLES", "Cycles", "Path tracing, with motion blur from the water's velocity"),
    ("EEVEE", "EEVEE", "Quick; its motion blur takes the steps between frames"),
]


class OCEAN_OT_add_scene(bpy.types.Operator):
    """Add a sea with all that makes a picture of it."""

    bl_idname = "ocean.add_scene"
    bl_description = "Add a sea with foam, water material, sky, sun, camera and a floating buoy"
    bl_label = "Ocean Scene"
    bl_options = {"REGISTER", "UNDO"}

    mood: EnumProperty(
        name="Mood",
        items=[(key, mood.label, mood.description) for key, mood in MOODS.items()],
        default="FRESH_BREEZE",
        description="The sea, and the sky and water that go with it",
    )
    engine: EnumProperty(
        name="Render Engine", items=_ENGINES, default="CYCLES", description="What renders the scene"
    )
    use_new_scene: BoolProperty(
        name="New Scene",
        description="Make everything in a scene of its own, and leave this one alone",
        default=False,
    )
    use_new_camera: BoolProperty(
        name="Replace Camera",
        description="Look through the new camera also where the scene has one. The old one stays an object",
        default=False,
    )
    use_new_world: BoolProperty(
        name="Replace World",
        description="Give the scene a new sky also where it has one. The old one stays in the file",
        default=False,
    )
    use_buoy: BoolProperty(name="Buoy", description="Let a buoy float before the camera", default=True)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Objects are added in Object Mode."""
        cls.poll_message_set("Switch to Object Mode to add an ocean")
        return context.mode == "OBJECT"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Make it, and say what the scene has kept."""
        old = context.scene
        scene = _new_scene(old) if self.use_new_scene else old
        wishes = stage.Wishes(
            engine=self.engine, camera=self.use_new_camera, world=self.use_new_world, buoy=self.use_buoy
        )
        if self.use_new_world and old.world is not None and not self.use_new_scene:
            old.world.use_fake_user = True
        collection = scene.collection if self.use_new_scene else context.collection
        try:
            made = stage.build(scene, self.mood, wishes, collection)
        except ocean_object.EXPECTED_ERRORS as error:
            if self.use_new_scene:
                bpy.data.scenes.remove(scene)
            return refuse(self, error)
        if self.use_new_scene and context.window is not None:
            context.window.scene = scene
        _select(context, scene, made.ocean)
        if scene.camera == made.camera and isinstance(context.space_data, bpy.types.SpaceView3D):
            context.space_data.region_3d.view_perspective = "CAMERA"
        said = translated("{mood}: {engine}, motion blur on").format(
            mood=translated(MOODS[self.mood].label), engine=self.engine.title()
        )
        if made.kept:
            said += "; " + translated("kept the scene's {list}").format(list=", ".join(made.kept))
        self.report({"INFO"}, said)
        return {"FINISHED"}


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
        description="What is dissolved and afloat in the water",
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Make the material where the file has none, and assign it."""
        item, scene = context.active_object, context.scene
        try:
            parameters = settings_of(item).to_parameters(scene)
        except ParameterError as error:
            return refuse(self, error)
        water_material.assign(item, water_material.water_material(self.water))
        water_material.describe(item, parameters, scene)
        return {"FINISHED"}


class _SidebarPanel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Ocean Tweak"


class OCEAN_PT_start_scene(_SidebarPanel, bpy.types.Panel):
    """A whole scene, where no ocean is active."""

    bl_idname = "OCEAN_PT_start_scene"
    bl_label = "Scene"
    bl_parent_id = "OCEAN_PT_start"
    bl_options = {"HIDE_HEADER"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw one button a mood."""
        self.layout.label(text="With sky and camera:")
        column = self.layout.column(align=True)
        for key, mood in MOODS.items():
            column.operator(OCEAN_OT_add_scene.bl_idname, text=mood.label, icon="SCENE_DATA").mood = key


class OCEAN_PT_material(_SidebarPanel, bpy.types.Panel):
    """The active ocean's material."""

    bl_idname = "OCEAN_PT_material"
    bl_label = "Material"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Shown for an active ocean."""
        return is_ocean(context.active_object)

    def draw(self, context: bpy.types.Context) -> None:
        """Draw what the ocean has, and the button that gives it water."""
        material = context.active_object.active_material
        if material is not None:
            self.layout.label(text=material.name, icon="MATERIAL")
        operator = OCEAN_OT_use_water_material.bl_idname
        self.layout.operator_menu_enum(operator, "water", text="Water Material", icon="MATFLUID")


def draw_add_menu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    """Draw the entry in Add > Mesh."""
    self.layout.operator_menu_enum(OCEAN_OT_add_scene.bl_idname, "mood", icon="SCENE_DATA")


def _new_scene(like: bpy.types.Scene) -> bpy.types.Scene:
    """An empty scene with the frame rate and the units of another."""
    scene = bpy.data.scenes.new("Ocean")
    scene.render.fps, scene.render.fps_base = like.render.fps, like.render.fps_base
    scene.unit_settings.scale_length = like.unit_settings.scale_length
    scene.unit_settings.system = like.unit_settings.system
    return scene


def _select(context: bpy.types.Context, scene: bpy.types.Scene, item: bpy.types.Object) -> None:
    layer = scene.view_layers[0] if scene != context.scene else context.view_layer
    layer.update()  # it does not know yet what has just been linked
    for other in layer.objects:
        other.select_set(False, view_layer=layer)
    # an excluded collection keeps its objects out of the view layer
    if item.name in layer.objects:
        item.select_set(True, view_layer=layer)
        layer.objects.active = item


CLASSES = (OCEAN_OT_add_scene, OCEAN_OT_use_water_material, OCEAN_PT_start_scene, OCEAN_PT_material)
