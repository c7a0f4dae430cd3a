# SPDX-License-Identifier: GPL-3.0-or-later
"""Float on Ocean: what the artist presses to let objects ride the sea, live or baked to keyframes."""

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from ..scene import contact, float_recording, floating, hull_cut
from ..scene.float_bake import FloatBake
from ..scene.float_keys import is_baked
from ..scene.floating import FloatError, Ride
from ..scene.portability import has_ocean
from ..scene.settings import OceanObjectError, is_ocean
from .active_ocean import refuse, shown_ocean
from .stepped_operator import SteppedOperator


def floatable(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The selected objects that are no oceans."""
    return [item for item in context.selected_objects if not is_ocean(item)]


#: what the object may say
_OF_OBJECT = ("waterline", "draft", "tilt", "keep_height")


class OnOcean:
    """Operators on the selected objects and an ocean."""

    ocean: StringProperty(
        name="Ocean", description="The ocean that is meant; empty for the one that the sidebar shows"
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There is an ocean, and something else is selected."""
        if context.mode != "OBJECT":
            cls.poll_message_set("Switch to Object Mode")
        elif not has_ocean(context.scene):
            cls.poll_message_set("There is no ocean in this scene: add one first")
        elif not context.selected_objects:
            cls.poll_message_set("Nothing is selected: select one or more objects")
        elif not floatable(context):
            cls.poll_message_set("Only oceans are selected: select other objects")
        else:
            return True
        return False

    def chosen_ocean(self, context: bpy.types.Context) -> bpy.types.Object:
        """The ocean of that name, else the one that is shown. Raises FloatError."""
        return floating.chosen_ocean(context.scene, shown_ocean(context), self.ocean)


class _Rides(OnOcean):
    """Operators that let the selected objects float."""

    ride: EnumProperty(
        name="Float As",
        items=[(key, *texts) for key, texts in floating.RIDES.items()],
        default="OBJECT",
        description="What sets waterline, draft and tilt",
    )
    riding: EnumProperty(
        name="Riding",
        items=[
            ("KINEMATIC", "Kinematic", "Follows the surface at every moment"),
            (
                "DAMPED",
                "Damped",
                "Has inertia: heave, pitch and roll swing as damped oscillators whose natural periods are "
                "those of its size. On live oceans, and in every bake to keyframes",
            ),
        ],
        default="KINEMATIC",
        description="How it answers to the waves",
    )
    waterline: FloatProperty(
        name="Waterline",
        min=0.0,
        soft_max=1000.0,
        unit="LENGTH",
        description="Size of the floating object: shorter waves do not move it. 0 follows the surface at the "
        "object's origin",
    )
    draft: FloatProperty(
        name="Draft",
        unit="LENGTH",
        soft_min=-100.0,
        soft_max=100.0,
        description="How deep it sits: from its lowest point up to the surface",
    )
    tilt: FloatProperty(
        name="Tilt",
        default=1.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
        description="How much it tilts with the surface: 0 stays upright",
    )
    drift: FloatProperty(
        name="Drift",
        min=0.0,
        max=1.0,
        subtype="FACTOR",
        description="How much it moves back and forth with the water: 0 stays above its place",
    )
    keep_height: BoolProperty(
        name="Keep Height",
        description="Stay as high above the surface as it is above calm water, whatever the draft is: for "
        "cameras and lights",
    )
    use_contact: BoolProperty(
        name="Contact with Water",
        default=True,
        description="Put a collar of foam and ripples on the water around it, and mark where its meshes "
        "are wet",
    )
    shown = ("ride", "riding", "waterline", "draft", "tilt", "drift", "keep_height", "use_contact")

    def ride_of(self, item: bpy.types.Object) -> Ride:
        """How an object shall float; what a script gives goes before the object, unless it asks for both."""
        hull, asked = floating.own_hull(item), self.properties.is_property_set
        damped = self.riding == "DAMPED"
        values = vars(floating.usual_ride(self.ride, item, hull, damped)) | {"drift": self.drift}
        for name in _OF_OBJECT:
            if self.ride == "CUSTOM" or (asked(name) and not asked("ride")):
                values[name] = getattr(self, name)
        return Ride(**values)

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the settings."""
        layout = self.layout
        layout.use_property_split = True
        layout.prop_search(self, "ocean", context.scene, "objects", icon="MOD_OCEAN")
        for name in self.shown:
            row = layout.row()
            row.active = self.ride == "CUSTOM" or name not in _OF_OBJECT
            row.prop(self, name)


class OBJECT_OT_ocean_float(_Rides, bpy.types.Operator):
    """Let the selected objects ride the ocean's surface."""

    bl_idname = "object.ocean_tweak_float"
    bl_description = (
        "Let the selected objects ride the waves. Move, rotate, parent and animate them as "
        "before: they float where you put them"
    )
    bl_label = "Float on Ocean"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Let each of them float; children of others go along as they are."""
        carriers, refused = [], []
        try:
            ocean = self.chosen_ocean(context)
        except FloatError as error:
            return refuse(self, error)
        for item in floating.outermost(floatable(context)):
            try:
                ride = self.ride_of(item)
                carriers.append(floating.float_on(item, ocean, ride, self.use_contact))
            except FloatError as error:
                refused.append(str(error))
        float_recording.record(carriers, context.scene)
        done = len(carriers)
        if refused:
            self.report({"WARNING" if done else "ERROR"}, "; ".join(refused))
        else:
            self.report(
                {"INFO"}, translated("Objects on {ocean}: {count}").format(ocean=ocean.name, count=done)
            )
        return {"FINISHED"} if done else {"CANCELLED"}


class OBJECT_OT_ocean_float_bake(_Rides, SteppedOperator, bpy.types.Operator):
    """Bake the floating of the selected objects to keyframes."""

    bl_idname = "object.ocean_tweak_float_bake"
    bl_description = (
        "Bake the floating of the selected objects to keyframes of location and rotation, on the "
        "sea of the render. Objects that already float keep their ocean and settings. Esc cancels"
    )
    bl_label = "Bake Float to Keyframes"
    bl_options = {"REGISTER", "UNDO"}

    frame_start: IntProperty(
        name="First Frame", description="First frame to key; by default that of the scene"
    )
    frame_end: IntProperty(name="Last Frame", description="Last frame to key; by default that of the scene")
    shown = ("frame_start", "frame_end", *_Rides.shown)

    doing = "Baking the float to keyframes"

    def begin(self, context: bpy.types.Context) -> FloatBake:
        """Look at all objects, and move none."""
        for name in ("frame_start", "frame_end"):
            if not self.properties.is_property_set(name):
                setattr(self, name, getattr(context.scene, name))
        frames = range(self.frame_start, self.frame_end + 1)
        ocean = self.chosen_ocean(context)
        return FloatBake(context.scene, floatable(context), ocean, self.ride_of, frames, self.use_contact)

    def conclude(self, _context: bpy.types.Context, baked: int) -> set[str]:
        """Tell how many objects have keys."""
        self.report(
            {"INFO"},
            translated("Objects baked, frames {first} to {last}: {count}").format(
                first=self.frame_start, last=self.frame_end, count=baked
            ),
        )
        return {"FINISHED"}


class OBJECT_OT_ocean_float_remove(bpy.types.Operator):
    """Stop floating the selected objects."""

    bl_idname = "object.ocean_tweak_float_remove"
    bl_description = (
        "Stop floating the selected objects, live or baked: they stay where they were placed, "
        "without waves and with their own animation"
    )
    bl_label = "Remove Float"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Something selected floats."""
        if not any(map(_floats, context.selected_objects)):
            cls.poll_message_set("None of the selected objects floats on an ocean")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Put them back."""
        items = [item for item in floatable(context) if _floats(item)]
        for item in items:
            floating.sink(item)
        self.report({"INFO"}, translated("Objects back in place: {count}").format(count=len(items)))
        return {"FINISHED"}


class OBJECT_OT_ocean_contact(OnOcean, bpy.types.Operator):
    """Let the selected objects touch the water that they stand or float in."""

    bl_idname = "object.ocean_tweak_contact"
    bl_description = (
        "Put a collar of foam and ripples on the water around the selected objects, floating or "
        "not, and mark where their meshes are wet. Use it again to refit the collars after a "
        "change"
    )
    bl_label = "Contact with Water"
    bl_options = {"REGISTER", "UNDO"}

    use_contact: BoolProperty(name="Touch", default=True, description="Off removes collar and wet band")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Touch or part."""
        try:
            ocean = self.chosen_ocean(context)
        except FloatError as error:
            return refuse(self, error)
        items = floating.outermost(floatable(context))
        if not self.use_contact:
            for item in items:
                contact.part(item)
            return {"FINISHED"}
        dry = [item.name for item in items if not floating.touch_water(item, ocean)]
        if dry:
            text = f"The water of {ocean.name} does not cut {', '.join(dry)}: move it into the water"
            self.report({"WARNING" if len(dry) < len(items) else "ERROR"}, text)
        return {"FINISHED"} if len(dry) < len(items) else {"CANCELLED"}


class OBJECT_OT_ocean_cut_out(OnOcean, bpy.types.Operator):
    """Let no water be inside the selected hulls."""

    bl_idname = "object.ocean_tweak_cut_out"
    bl_description = (
        "Make the water transparent inside the selected hulls, floating or not, open boats too, in "
        "Cycles and EEVEE. Use it again after changing a hull"
    )
    bl_label = "Cut Out Hull"
    bl_options = {"REGISTER", "UNDO"}

    use_cut: BoolProperty(name="Cut Out", default=True, description="Off lets the water in again")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Cut out or let in."""
        items = floating.outermost(floatable(context))
        if not self.use_cut:
            for item in items:
                hull_cut.let_in(item)
            return {"FINISHED"}
        refused, dry = [], []
        try:
            ocean = self.chosen_ocean(context)
        except FloatError as error:
            return refuse(self, error)
        for item in items:
            try:
                if not floating.cut_out(item, ocean):
                    dry.append(item.name)
            except OceanObjectError as error:
                refused.append(str(error))
        if refused:
            self.report({"WARNING" if len(refused) < len(items) else "ERROR"}, "; ".join(refused))
        elif text := hull_cut.why_unseen(ocean):
            self.report({"WARNING"}, text)
        elif dry:
            text = f"The water of {ocean.name} does not cut {', '.join(dry)}: move it into the water"
            self.report({"WARNING"}, text)
        return {"FINISHED"} if len(refused) < len(items) else {"CANCELLED"}


def draw_object_menu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    """Draw the entries in the Object menu."""
    self.layout.separator()
    for operator in CLASSES:
        self.layout.operator(operator.bl_idname)


def _floats(item: bpy.types.Object) -> bool:
    return floating.carrier_of(item) is not None or is_baked(item)


CLASSES = (
    OBJECT_OT_ocean_float, OBJECT_OT_ocean_float_bake, OBJECT_OT_ocean_float_remove, OBJECT_OT_ocean_contact,
    OBJECT_OT_ocean_cut_out,
)  # fmt: skip
