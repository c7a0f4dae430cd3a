# SPDX-License-Identifier: GPL-3.0-or-later
"""What moves the active ocean: baked files, or a live sea again."""

from typing import Any

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import BoolProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from ..core import OceanParameters, ParameterError
from ..core.frames import format_frames
from ..export.cache.job import CacheError, read_job
from ..export.exr import ExrError, read_header
from ..scene import ocean_object
from ..scene.image_sequence import ImageSequence, SequenceError, find_sequence
from ..scene.settings import settings_of
from .active_ocean import OfActiveOcean, refuse
from .parameter_operators import apply_parameters


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
                apply_parameters(context, _baked_parameters(sequence), use_frame_rate=True)
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
    bl_description = "Compute the active ocean on every frame again"
    bl_label = "Back to Live"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Switch the source; what is wrong with the settings stands in the panel."""
        settings_of(context.active_object).source = "LIVE"
        return {"FINISHED"}


def _baked_parameters(sequence: ImageSequence) -> OceanParameters:
    path = sequence.path(sequence.frames[0])
    metadata = read_header(path)
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
        parameters = read_job(path.parent).shot.at(sequence.frames[0]).parameters
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


CLASSES = (OCEAN_OT_use_sequence, OCEAN_OT_use_live)
