# SPDX-License-Identifier: GPL-3.0-or-later
"""Making a coast of the mesh of a sea bed."""

from __future__ import annotations

import time

import bpy

from ..scene import coast_bed, coast_surface, refinement
from ..scene.settings import settings_of
from ..scene.units import metres_per_unit
from . import coast_properties
from .active_ocean import OfActiveOcean, shown_ocean
from .stepped_operator import SteppedOperator

#: s until it is looked again how far the waves are
_LOOK = 0.02


class _Awaited:
    """The waves over a bed, which another thread computes; in percent."""

    steps = 100

    def __init__(self, ocean: bpy.types.Object) -> None:
        self._ocean = ocean

    @property
    def done(self) -> int:
        """How many percent there are; all where no more is computed."""
        if not refinement.is_unfinished(self._ocean):
            return self.steps
        progress = refinement.progress_of(self._ocean)
        return 0 if progress is None else min(int(self.steps * progress.share), self.steps - 1)

    def advance(self) -> None:
        """Let the other thread work."""
        time.sleep(_LOOK)

    def finish(self) -> None:
        """They are shown already."""

    def cancel(self) -> None:
        """Show the open sea, so that no more is computed."""
        settings_of(self._ocean).coast.muted = True

    def abandon(self) -> None:
        """The thread ends with the file."""


class OCEAN_OT_make_coast(OfActiveOcean, SteppedOperator, bpy.types.Operator):
    """Let the ocean's waves run ashore over a mesh."""

    bl_idname = "ocean.make_coast"
    bl_description = (
        "Read the depths of the mesh chosen as Sea Bed, and let waves turn, rise and break over it. Read "
        "them again after the mesh was changed or moved"
    )
    bl_label = "Make Coast"
    bl_options = {"REGISTER", "UNDO"}

    doing = "Computing the waves over the bed"
    cancelled = "Cancelled: the open sea is shown. Switch Muted off in the Coast panel to go on"

    def begin(self, context: bpy.types.Context) -> _Awaited:
        """Read the bed, and have the sea over it computed."""
        ocean = shown_ocean(context)
        group, metres = settings_of(ocean).coast, metres_per_unit(context.scene)
        bed = coast_bed.read_bed(ocean, group.bed, context.scene, float(1 / metres))
        coast_properties.take_bed(group, bed, metres)
        return _Awaited(ocean)

    def conclude(self, context: bpy.types.Context, _result: object) -> set[str]:
        """Say what keeps it from being shown."""
        coast_surface.dry_other_beds()
        error = settings_of(shown_ocean(context)).error
        if error:
            self.report({"WARNING"}, error)
        return {"FINISHED"}


CLASSES = (OCEAN_OT_make_coast,)
