# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks follow the hand: at once where the object that they are told by is moved or edited, and a moment
after each stroke where they are painted weights.

These are read in a window only, where somebody paints, and by a timer: reading looks at the evaluated mesh,
which has to be there.
"""

from __future__ import annotations

from collections.abc import Set

import bpy

from ..core import ParameterError
from .refinement import has_window
from .refresh import tell
from .settings import OceanObjectError, oceans_in, settings_of, shown_oceans

Objects = Set[bpy.types.Object]

# s without a stroke after which weights are read
_PAUSE = 0.3


def follow(scene: bpy.types.Scene, moved: Objects, edited: Objects) -> None:
    """Let masks of a scene's oceans follow what was moved, edited or painted: these or the masks' objects."""
    for item in oceans_in(scene) if moved or edited else ():
        settings = settings_of(item)
        objects = settings.mask_objects()
        if item.library is None and objects and (item in moved or objects & (moved | edited)):
            settings.place_masks()
        painted = settings.painted_meshes()
        if painted and (item in moved or any(is_painted(mesh, moved, edited) for mesh in painted)):
            read_soon()


def is_painted(mesh: bpy.types.Object, moved: Objects, edited: Objects) -> bool:
    """Whether a mesh's weights may lie otherwise on the water now.

    One that changes by itself does not count: it may read the sea.
    """
    return mesh in moved or (mesh in edited and mesh.mode == "WEIGHT_PAINT")


def read_soon() -> None:
    """Read all weights of masks once nothing has been painted for a moment."""
    forget_all()
    if has_window():
        bpy.app.timers.register(read, first_interval=_PAUSE)


def forget_all() -> None:
    """Read nothing: another file is opened, or the extension is disabled."""
    if bpy.app.timers.is_registered(read):
        bpy.app.timers.unregister(read)


def read() -> float | None:
    """The timer: read the weights of all masks that have read them before. The same ones change nothing."""
    if bpy.app.is_job_running("RENDER"):
        return _PAUSE
    for item, scene in shown_oceans().items():
        settings = settings_of(item)
        if item.library is None and settings.painted_meshes():
            try:
                settings.read_masks(scene)
            except (OceanObjectError, ParameterError) as error:
                tell(item, error)
    return None
