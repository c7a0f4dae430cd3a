# SPDX-License-Identifier: GPL-3.0-or-later
"""Plans, adds and removes patches."""

import bpy
from bpy.app.translations import pgettext_rpt as translated

from ..core import OceanParameters, ParameterError
from ..core.parameters.patch import MOST_PATCHES
from ..core.sea.patch_editing import with_another_patch, without_patch
from ..core.sea.patch_plan import planned
from ..scene.settings import OceanObjectError, settings_of
from .active_ocean import OfOwnList, nearest, refuse, shown_ocean
from .patch_properties import wish_of
from .resizing import tell_what_stays


class _OfPatches(OfOwnList):
    """Base class of operators that change the whole list, through the parameters."""

    kept = "A library override keeps its patches: make the ocean local first"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Change the list as a whole, or not at all."""
        settings = settings_of(shown_ocean(context))
        try:
            before = settings.to_parameters(context.scene)
            after, active = self.changed(before, context)
            settings.from_parameters(after, context.scene, keep_places=True)
        except (ParameterError, OceanObjectError) as error:
            return refuse(self, error)
        settings.active_patch = active
        tell_what_stays(self, settings)
        if before.trough_damping != after.trough_damping:
            self.report(
                {"INFO"},
                translated("Trough Damping is now 0: a patch cannot be damped by the troughs of another"),
            )
        return {"FINISHED"}

    def changed(self, parameters: OceanParameters, context: bpy.types.Context) -> tuple[OceanParameters, int]:
        """The sea with other patches, and the number of the one that is active then."""
        raise NotImplementedError


class OCEAN_OT_plan_patches(_OfPatches, bpy.types.Operator):
    """Make patches for the finest detail, the area without repetition and the memory that are set."""

    bl_idname = "ocean.plan_patches"
    bl_description = (
        "Replace the patches with as many as needed, up to four, for the finest detail, the area "
        "without repetition and the memory above"
    )
    bl_label = "Plan Patches"
    bl_options = {"REGISTER", "UNDO"}

    def changed(self, parameters: OceanParameters, context: bpy.types.Context) -> tuple[OceanParameters, int]:
        """The patches that the core plans, shown on as many samples as the first has."""
        sea = parameters.without_patches
        return planned(sea, wish_of(settings_of(shown_ocean(context)), context.scene)), 0


class OCEAN_OT_patch_add(_OfPatches, bpy.types.Operator):
    """Add a patch of shorter waves."""

    bl_idname = "ocean.patch_add"
    bl_description = (
        "Add a patch after the last: it takes the shorter half of that one's octaves or, where "
        "these are too few or have no end, continues with shorter waves"
    )
    bl_label = "Add Patch"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There is room for one more."""
        if not super().poll(context):
            return False
        if len(settings_of(shown_ocean(context)).patches) >= MOST_PATCHES:
            cls.poll_message_set("A sea has four patches at most")
            return False
        return True

    def changed(
        self, parameters: OceanParameters, _context: bpy.types.Context
    ) -> tuple[OceanParameters, int]:
        """The new one is active."""
        after = with_another_patch(parameters)
        return after, len(after.patches) - 1


class _OfPresentPatches(_OfPatches):
    """Operators that need patches."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There are some."""
        if not super().poll(context):
            return False
        if not settings_of(shown_ocean(context)).patches:
            cls.poll_message_set("This ocean has no list of patches: plan them, or add one")
            return False
        return True


class OCEAN_OT_patch_remove(_OfPresentPatches, bpy.types.Operator):
    """Remove the active patch."""

    bl_idname = "ocean.patch_remove"
    bl_description = (
        "Remove the active patch; the one before it takes over its waves (the second those of the first)"
    )
    bl_label = "Remove Patch"
    bl_options = {"REGISTER", "UNDO"}

    def changed(self, parameters: OceanParameters, context: bpy.types.Context) -> tuple[OceanParameters, int]:
        """The one that took over is active."""
        index = nearest(settings_of(shown_ocean(context)).active_patch, parameters.patches)
        return without_patch(parameters, index), max(index - 1, 0)


class OCEAN_OT_one_patch(_OfPresentPatches, bpy.types.Operator):
    """Reduce the sea to one patch."""

    bl_idname = "ocean.one_patch"
    bl_description = (
        "Replace all patches with one that holds all waves, with the same size and samples as now"
    )
    bl_label = "One Patch"
    bl_options = {"REGISTER", "UNDO"}

    def changed(
        self, parameters: OceanParameters, _context: bpy.types.Context
    ) -> tuple[OceanParameters, int]:
        """A sea without patches keeps the size and the samples with which it was shown."""
        return parameters.without_patches, 0


CLASSES = (OCEAN_OT_plan_patches, OCEAN_OT_patch_add, OCEAN_OT_patch_remove, OCEAN_OT_one_patch)
