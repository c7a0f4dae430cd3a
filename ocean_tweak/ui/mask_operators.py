# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading the weights of a vertex group into a mask."""

from contextlib import suppress
from typing import Any

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import IntProperty

from ..core import ParameterError, Raster
from ..scene.settings import OceanObjectError, settings_of
from ..scene.vertex_weights import WeightsReading
from . import mask_properties
from .active_ocean import OfActiveOcean, active_layer, refuse, shown_ocean
from .stepped_operator import SteppedOperator

#: in the place of a patch's number: whose mask it is
ACTIVE_LAYER, WHOLE_SEA = -1, -2


class OCEAN_OT_read_weights(OfActiveOcean, SteppedOperator, bpy.types.Operator):
    """Read the weights of a mesh over or under the water into a mask."""

    bl_idname = "ocean.read_weights"
    bl_description = (
        "Read the weights of the mask's mesh, seen from above the domain, into an image. Read "
        "them again after painting or moving"
    )
    bl_label = "Read Weights"
    bl_options = {"REGISTER", "UNDO"}

    patch: IntProperty(
        name="Patch", default=ACTIVE_LAYER, min=WHOLE_SEA, options={"SKIP_SAVE"},
        description="Number of the patch with the mask, from 0; -1: the active layer, -2: the sea",
    )  # fmt: skip
    samples: IntProperty(
        name="Samples", default=128, min=2, max=1024,
        description="Samples of the image along each side of the domain",
    )  # fmt: skip

    doing = "Reading the weights"

    def begin(self, context: bpy.types.Context) -> WeightsReading:
        """Look for the mask and its mesh."""
        mask = self._mask(context)
        if mask is None:
            raise OceanObjectError("The active layer has no mask: choose waves, an image or a wind field")
        self._ocean, self._path = mask.id_data, mask.path_from_id()
        self._known = _known(mask)
        return mask_properties.reading_of(mask, context.scene, self.samples)

    def conclude(self, _context: bpy.types.Context, seen: Raster) -> set[str]:
        """Let the mask have the weights, and tell what they come to."""
        try:
            mask_properties.take_weights(self._same_mask(), seen)
        except (OceanObjectError, ParameterError) as error:
            return refuse(self, error)
        self.report(
            {"INFO"},
            translated("The weights let {share:.0f} % of the waves through").format(
                share=100.0 * float(seen.values.mean())
            ),
        )
        return {"FINISHED"}

    def _mask(self, context: bpy.types.Context) -> bpy.types.PropertyGroup | None:
        settings = settings_of(shown_ocean(context))
        if self.patch == WHOLE_SEA:
            return settings.mask
        if self.patch >= 0:
            return settings.patches[self.patch].mask if self.patch < len(settings.patches) else None
        layer = active_layer(settings)
        return None if layer is None else getattr(layer.group, "mask", None)

    def _same_mask(self) -> bpy.types.PropertyGroup:
        """The mask for which the weights were read, whatever is active now.

        Raises OceanObjectError where it is gone, or wants other weights by now.
        """
        with suppress(ValueError):  # of a path that leads nowhere
            mask = self._ocean.path_resolve(self._path)
            if _known(mask) == self._known:
                return mask
        raise OceanObjectError("The mask was removed or changed while its weights were read: read them again")


def _known(mask: bpy.types.PropertyGroup) -> tuple[Any, ...]:
    """What differs where a path leads to another's mask by now, or to one that wants other weights."""
    settings = settings_of(mask.id_data)
    return mask.mesh, mask.vertex_group, len(settings.layers), len(settings.patches)


CLASSES = (OCEAN_OT_read_weights,)
