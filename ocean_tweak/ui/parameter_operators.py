# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters of the active ocean from files and to files."""

from pathlib import Path

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import BoolProperty, StringProperty
from bpy_extras.io_utils import ExportHelper, ImportHelper

from ..core import OceanParameters, ParameterError
from ..export.files import LARGEST_JSON, read_bytes
from ..export.sea_files import sea_of_text, write_sea
from ..scene.settings import OceanObjectError, settings_of
from ..scene.shots import animate, check_keys, shot_of
from ..scene.source_images import open_image
from ..scene.units import frame_rate, set_frame_rate, set_time_stretch, time_stretch
from .active_ocean import OfActiveOcean, refuse, shown_ocean


def apply_parameters(context: bpy.types.Context, parameters: OceanParameters, use_frame_rate: bool) -> None:
    """Give the active ocean a sea, or change nothing. Raises OceanObjectError for one it cannot show."""
    scene = context.scene
    before = frame_rate(scene), time_stretch(scene)
    if use_frame_rate:
        set_frame_rate(scene, parameters.timing.fps)
        set_time_stretch(scene, parameters.timing.stretch)
    try:
        settings_of(shown_ocean(context)).from_parameters(parameters, scene)
    except OceanObjectError:
        set_frame_rate(scene, before[0])
        set_time_stretch(scene, before[1])
        raise


class OCEAN_OT_import_parameters(OfActiveOcean, bpy.types.Operator, ImportHelper):
    """Give the active ocean the parameters of a JSON file, and keys where these change during the shot."""

    bl_idname = "ocean.import_parameters"
    bl_description = (
        "Give the active ocean the parameters of a JSON file, with keys where they change during the shot"
    )
    bl_label = "Import Parameters"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ".json"
    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})
    use_frame_rate: BoolProperty(
        name="Set Frame Rate",
        description="Give the scene the frame rate of the file, so that every frame shows its waves",
        default=True,
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Read the file and apply it as a whole, or not at all."""
        try:
            path = Path(self.filepath)
            text = read_bytes(path, LARGEST_JSON).decode("utf-8")
            shot = sea_of_text(text, path.parent, open_image)
            check_keys(shot)
            apply_parameters(context, shot.parameters, self.use_frame_rate)
            animate(shown_ocean(context), context.scene, shot)
        except (ParameterError, OceanObjectError, OSError, UnicodeDecodeError) as error:
            return refuse(self, error)
        return {"FINISHED"}


class OCEAN_OT_export_parameters(OfActiveOcean, bpy.types.Operator, ExportHelper):
    """Write the parameters of the active ocean to a JSON file, a sample a frame where they are animated."""

    bl_idname = "ocean.export_parameters"
    bl_description = (
        "Write the parameters of the active ocean to a JSON file, with a sample per frame where "
        "they are animated"
    )
    bl_label = "Export Parameters"
    bl_options = {"REGISTER"}

    filename_ext = ".json"
    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Write the file; settings that are no sea are refused."""
        try:
            shot = shot_of(shown_ocean(context), context.scene)
            write_sea(self.filepath, shot)
        except (ParameterError, OSError) as error:
            return refuse(self, error)
        self.report({"INFO"}, translated("Parameters written to {file}").format(file=self.filepath))
        return {"FINISHED"}


CLASSES = (OCEAN_OT_import_parameters, OCEAN_OT_export_parameters)
