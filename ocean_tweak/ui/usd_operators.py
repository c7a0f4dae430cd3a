# SPDX-License-Identifier: GPL-3.0-or-later
"""The active ocean as USD layers for other programs, and a sea back from them."""

from pathlib import Path

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import BoolProperty, StringProperty
from bpy_extras.io_utils import ExportHelper, ImportHelper

from ..core.data.frames import format_frames
from ..core.data.printable import readable_bytes
from ..export.usd import library
from ..export.usd.reading import SUFFIXES
from ..scene import ocean_object, usd
from ..scene.portability import neighbours_of
from ..scene.settings import OceanObjectError, settings_of
from ..scene.shots import scene_frames, shot_of
from ..scene.usd import UsdCheck, UsdExport
from .active_ocean import OfActiveOcean, refuse, shown_ocean
from .adding import InObjectMode, make_active
from .background_operator import BackgroundOperator, StopsProcess
from .usd_properties import draw_choices

_FILTER = ";".join(f"*{suffix}" for suffix in SUFFIXES)
_EXTENSION = SUFFIXES[0]


class _NeedsUsd:
    """Operators that need OpenUSD; they say how to get it."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """OpenUSD can be found, and whatever else the operator wants."""
        if not library.is_installed():
            cls.poll_message_set(library.MISSING_IN_BLENDER)
            return False
        return super().poll(context)


class _UsdBackgroundOperator(_NeedsUsd, BackgroundOperator):
    """Operators that export an ocean or check its layers: one at a time."""

    processes = usd
    busy = "This ocean is being exported or checked: wait, or stop it with Esc"


class OCEAN_OT_export_usd(_UsdBackgroundOperator, bpy.types.Operator):
    """Write the active ocean as USD layers."""

    bl_idname = "ocean.export_usd"
    bl_description = (
        "Write the ocean over the scene's frames as USD layers, computed from its settings, with "
        "the patch's corner at the origin wherever the object is. You can go on working; Esc "
        "stops"
    )
    bl_label = "Export USD"
    bl_options = {"REGISTER"}
    doing = "Exporting"

    def begin(self, context: bpy.types.Context) -> UsdExport:
        """Write the scene's frames."""
        item, frames = shown_ocean(context), scene_frames(context.scene)
        return usd.start_export(item, shot_of(item, context.scene, frames), frames)

    def conclude(self, _context: bpy.types.Context) -> set[str]:
        """Say what was written."""
        export: UsdExport = self._process
        if export.is_complete:
            frames, size = format_frames(export.frames), readable_bytes(export.size)
            text = translated("{count} frames, {frames}, {size}: {path}")
            self.report(
                {"INFO"}, text.format(count=len(export.frames), frames=frames, size=size, path=export.path)
            )
            return {"FINISHED"}
        if not export.is_stopped:
            return self.failed()
        self.report({"INFO"}, f"{export.error[:1].upper()}{export.error[1:]}" or translated("Stopped"))
        return {"CANCELLED"}


class OCEAN_OT_export_usd_as(_NeedsUsd, OfActiveOcean, bpy.types.Operator, ExportHelper):
    """Choose a file, then write the active ocean as USD layers."""

    bl_idname = "ocean.export_usd_as"
    bl_description = OCEAN_OT_export_usd.bl_description
    bl_label = "Export Sea as USD"
    bl_options = {"REGISTER"}

    filename_ext = _EXTENSION
    check_extension = False  # any of the three will do
    filter_glob: StringProperty(default=_FILTER, options={"HIDDEN"})

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Open the browser where the ocean goes already."""
        try:
            self.filepath = str(usd.usd_file(shown_ocean(context)))
        except (OceanObjectError, OSError) as error:
            return refuse(self, error)
        return super().invoke(context, event)

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the choices of the panel."""
        item = shown_ocean(context)
        self.layout.use_property_split = True
        draw_choices(self.layout, settings_of(item).usd, neighbours_of(item).has_bake)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Note the file in the ocean, and export."""
        file = Path(self.filepath)
        if file.suffix not in SUFFIXES:  # what stands behind a dot may be a version
            file = file.with_name(file.name + _EXTENSION)
        settings_of(shown_ocean(context)).usd.file = str(file)
        try:
            return bpy.ops.ocean.export_usd("EXEC_DEFAULT" if bpy.app.background else "INVOKE_DEFAULT")
        except RuntimeError as error:  # what the other operator reported
            return refuse(self, str(error).removeprefix("Error: ").strip())


class OCEAN_OT_verify_usd(_UsdBackgroundOperator, bpy.types.Operator):
    """Read the USD layers of the active ocean back."""

    bl_idname = "ocean.verify_usd"
    bl_description = (
        "Check the exported layers at the first, middle and last frame: what is missing, stands "
        "still, or differs from their sea"
    )
    bl_label = "Verify USD"
    bl_options = {"REGISTER"}
    doing = "Checking"

    def begin(self, context: bpy.types.Context) -> UsdCheck:
        """Read what the ocean's settings say."""
        return usd.start_check(shown_ocean(context))

    def conclude(self, _context: bpy.types.Context) -> set[str]:
        """Say what is wrong."""
        check: UsdCheck = self._process
        if check.is_complete:
            self.report({"INFO"}, translated("No errors in {path}").format(path=check.path))
            return {"FINISHED"}
        if check.is_stopped:
            return {"CANCELLED"}
        if not check.problems:
            return self.failed()
        others = len(check.problems) - 1
        more = translated(" (and {count} more)").format(count=others) if others else ""
        return refuse(self, f"{check.path}: {check.problems[0]}{more}")


class OCEAN_OT_stop_usd(StopsProcess, bpy.types.Operator):
    """Stop exporting or checking the active ocean."""

    bl_idname = "ocean.stop_usd"
    bl_description = "Stop after the current frames. Written clips are kept, points are not"
    bl_label = "Stop"
    bl_options = {"INTERNAL"}
    processes = usd
    idle = "The active object is not being exported"


class OCEAN_OT_import_usd(_NeedsUsd, InObjectMode, bpy.types.Operator, ImportHelper):
    """Add the sea that USD layers were made from."""

    bl_idname = "ocean.import_usd"
    bl_description = (
        "Add a live ocean from the parameters in USD layers of Ocean Tweak, with its patch's "
        "corner at the origin, as in the layers"
    )
    bl_label = "Import Sea from USD"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = _EXTENSION
    filter_glob: StringProperty(default=_FILTER, options={"HIDDEN"})
    use_frame_rate: BoolProperty(
        name="Set Frame Rate",
        description="Give the scene the frame rate of the layers, so that every frame shows their waves",
        default=True,
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add it, and make it the active object."""
        try:
            item = usd.add_from_layer(
                context.scene, Path(self.filepath), context.collection, self.use_frame_rate
            )
        except (library.UsdError, OSError, *ocean_object.EXPECTED_ERRORS) as error:
            return refuse(self, error)
        make_active(item, context.view_layer)
        return {"FINISHED"}


def draw_export_menu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    """Draw the entry in File > Export."""
    self.layout.operator(OCEAN_OT_export_usd_as.bl_idname, text="Ocean Tweak Sea (.usd)")


def draw_import_menu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    """Draw the entry in File > Import."""
    self.layout.operator(OCEAN_OT_import_usd.bl_idname, text="Ocean Tweak Sea (.usd)")


CLASSES = (
    OCEAN_OT_export_usd,
    OCEAN_OT_export_usd_as,
    OCEAN_OT_verify_usd,
    OCEAN_OT_stop_usd,
    OCEAN_OT_import_usd,
)
