# SPDX-License-Identifier: GPL-3.0-or-later
"""What the artist can do: add an ocean, take parameters in and out, switch between live and baked."""

from pathlib import Path
from typing import Any

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import BoolProperty, EnumProperty, StringProperty
from bpy_extras.io_utils import ExportHelper, ImportHelper

from ..core import OceanParameters, ParameterError, Timing
from ..core.parameters import parse_json
from ..core.shot import Shot
from ..export.cache.job import CacheError, read_job
from ..export.exr import ExrError, read_image
from ..export.pictures import with_pictures
from ..scene import ocean_object
from ..scene.image_sequence import ImageSequence, SequenceError, find_sequence
from ..scene.settings import METHODS, VIEWPORT_RESOLUTION, OceanObjectError, settings_of
from ..scene.shots import animate, shot_of
from ..scene.source_images import open_image
from ..scene.units import frame_rate, metres_per_unit, set_frame_rate
from .active_ocean import OfActiveOcean, refuse

# far beyond any sea with its pictures; keeps a file chosen by mistake from filling the memory
_LARGEST_JSON = 64_000_000


def default_sea(scene: bpy.types.Scene) -> OceanParameters:
    """The core's default, a strong breeze on the open sea, with time zero at the scene's first frame."""
    return OceanParameters(timing=Timing(fps=frame_rate(scene), start_frame=scene.frame_start))


class MESH_OT_ocean_tweak_add(bpy.types.Operator):
    """Add a patch of sea that moves on playback."""

    bl_idname = "mesh.ocean_tweak_add"
    bl_description = "Add a patch of sea that moves on playback"
    bl_label = "Ocean Tweak"
    bl_options = {"REGISTER", "UNDO"}

    method: EnumProperty(
        name="Method",
        items=[(key, *texts) for key, texts in METHODS.items()],
        default="NODES",
        description="What moves the mesh",
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Objects are added in Object Mode."""
        cls.poll_message_set("Switch to Object Mode to add an ocean")
        return context.mode == "OBJECT"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add the default sea around the 3D cursor."""
        scene = context.scene
        parameters = default_sea(scene)
        try:
            item = ocean_object.add(
                scene, parameters, method=self.method, collection=context.collection,
                viewport_resolution=VIEWPORT_RESOLUTION,
            )  # fmt: skip
        except ocean_object.EXPECTED_ERRORS as error:
            return refuse(self, error)
        half = 0.5 * parameters.domain_size / float(metres_per_unit(scene))
        item.location = scene.cursor.location
        item.location.x -= half
        item.location.y -= half
        for other in context.selected_objects:
            other.select_set(False)
        # an excluded collection keeps its objects out of the view layer
        if item.name in context.view_layer.objects:
            item.select_set(True)
            context.view_layer.objects.active = item
        return {"FINISHED"}


class OCEAN_OT_import_parameters(OfActiveOcean, bpy.types.Operator, ImportHelper):
    """Give the active ocean the parameters of a JSON file, and keys where these change during the shot."""

    bl_idname = "ocean.import_parameters"
    bl_description = (
        "Give the active ocean the parameters of a JSON file, and keys where these change during the shot"
    )
    bl_label = "Import Parameters"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ".json"
    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})
    use_frame_rate: BoolProperty(
        name="Set Frame Rate",
        description="Give the scene the file's frame rate, so that every frame shows the file's waves",
        default=True,
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Read the file and apply it as a whole, or not at all."""
        try:
            path = Path(self.filepath)
            data = with_pictures(OceanParameters, parse_json(_read_text(path)), path.parent, open_image)
            shot = Shot.from_dict(data)
            _apply(context, shot.parameters, self.use_frame_rate)
            animate(context.active_object, context.scene, shot)
        except (ParameterError, OceanObjectError, OSError, UnicodeDecodeError) as error:
            return refuse(self, error)
        return {"FINISHED"}


class OCEAN_OT_export_parameters(OfActiveOcean, bpy.types.Operator, ExportHelper):
    """Write the parameters of the active ocean to a JSON file, a sample a frame where they are animated."""

    bl_idname = "ocean.export_parameters"
    bl_description = (
        "Write the parameters of the active ocean to a JSON file, a sample a frame where they are animated"
    )
    bl_label = "Export Parameters"
    bl_options = {"REGISTER"}

    filename_ext = ".json"
    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Write the file; settings that are no sea are refused."""
        try:
            shot = shot_of(context.active_object, context.scene)
            Path(self.filepath).write_text(shot.to_json() + "\n", encoding="utf-8")
        except (ParameterError, OSError) as error:
            return refuse(self, error)
        self.report({"INFO"}, translated("Parameters written to {file}").format(file=self.filepath))
        return {"FINISHED"}


class OCEAN_OT_use_sequence(OfActiveOcean, bpy.types.Operator, ImportHelper):
    """Let baked files move the active ocean."""

    bl_idname = "ocean.use_sequence"
    bl_description = "Let baked files move the active ocean: choose any file NAME_disp.####.exr, or a folder"
    bl_label = "Use Baked Sequence"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ".exr"
    filter_glob: StringProperty(default="*_disp.*.exr", options={"HIDDEN"})
    use_parameters: BoolProperty(
        name="Use Its Parameters",
        description="Take over the sea that the files were baked from, with its domain size and frame rate",
        default=True,
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Find the sequence and switch to it."""
        item, scene = context.active_object, context.scene
        try:
            sequence = find_sequence(self.filepath)
            if self.use_parameters:
                _apply(context, _baked_parameters(sequence), use_frame_rate=True)
            ocean_object.use_sequence(item, scene, sequence)
        except (ExrError, *ocean_object.EXPECTED_ERRORS) as error:
            return refuse(self, error)
        self.report(
            {"INFO"},
            translated("{name}: frames {first} to {last}").format(
                name=sequence.name, first=sequence.first, last=sequence.last
            ),
        )
        return {"FINISHED"}


class OCEAN_OT_use_live(OfActiveOcean, bpy.types.Operator):
    """Compute the active ocean on every frame again."""

    bl_idname = "ocean.use_live"
    bl_description = "Compute the active ocean on every frame again"
    bl_label = "Back to Live"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Switch the source; what is wrong with the settings stands in the panel."""
        settings_of(context.active_object).source = "LIVE"
        return {"FINISHED"}


def _apply(context: bpy.types.Context, parameters: OceanParameters, use_frame_rate: bool) -> None:
    scene = context.scene
    before = frame_rate(scene)
    if use_frame_rate:
        set_frame_rate(scene, parameters.timing.fps)
    try:
        settings_of(context.active_object).from_parameters(parameters, scene)
    except OceanObjectError:
        set_frame_rate(scene, before)
        raise


def _baked_parameters(sequence: ImageSequence) -> OceanParameters:
    path = sequence.path(sequence.first)
    _, metadata = read_image(path)
    if "parameters" not in metadata:
        raise SequenceError(f"{path} does not say what it was baked from: switch off Use Its Parameters")
    told = metadata["parameters"]
    try:
        return OceanParameters.from_dict(told)
    except ParameterError:
        if not _has_brief_pictures(told):
            raise
    # images name their pictures and winds, which stand in the job beside them
    try:
        parameters = read_job(path.parent).shot.at(sequence.first).parameters
    except (CacheError, ParameterError) as error:
        raise SequenceError(
            f"{path} names the pictures or winds of its sea, but does not hold them, and the bake's job does "
            f"not either ({error}): switch off Use Its Parameters"
        ) from None
    if parameters.to_dict(brief=True) != told:
        raise SequenceError(f"{path} is of another sea than the job beside it: switch off Use Its Parameters")
    return parameters


def _has_brief_pictures(told: Any) -> bool:
    return isinstance(told, dict) and bool(told.get("pictures") or told.get("wind_fields"))


def _read_text(path: Path) -> str:
    with path.open("rb") as file:
        data = file.read(_LARGEST_JSON + 1)
    if len(data) > _LARGEST_JSON:
        raise ParameterError("file", str(path), f"is larger than {_LARGEST_JSON // 10**6} MB: not parameters")
    return data.decode("utf-8")


CLASSES = (
    MESH_OT_ocean_tweak_add,
    OCEAN_OT_import_parameters,
    OCEAN_OT_export_parameters,
    OCEAN_OT_use_sequence,
    OCEAN_OT_use_live,
)
