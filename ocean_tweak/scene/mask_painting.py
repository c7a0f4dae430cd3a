# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks of painted weights follow the brush: they are read again a moment after each stroke, or move.

Only in a window, where somebody paints, and by a timer: reading looks at the evaluated mesh, which has to be
there.
"""

from __future__ import annotations

from collections.abc import Container

import bpy

from ..core import ParameterError
from .refinement import has_window
from .refresh import tell
from .settings import OceanObjectError, settings_of, shown_oceans

# s without a stroke after which weights are read
_PAUSE = 0.3


def is_painted(
    mesh: bpy.types.Object, moved: Container[bpy.types.Object], edited: Container[bpy.types.Object]
) -> bool:
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
