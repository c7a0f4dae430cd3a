# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of scenes that change an ocean and call nothing of ours: units and frame rates."""

from __future__ import annotations

import bpy

from .refinement import show
from .settings import shown_oceans

_FOLLOWED = (
    ("UnitSettings", "scale_length"),
    ("RenderSettings", "fps"),
    ("RenderSettings", "fps_base"),
    ("RenderSettings", "frame_map_old"),
    ("RenderSettings", "frame_map_new"),
)
# subscriptions to properties are made and cleared under this owner
_OWNER = object()


def _refresh_all_oceans() -> None:
    """Refresh every ocean of the file in its own scene."""
    for item, scene in shown_oceans().items():
        show(item, scene)


def subscribe() -> None:
    """Follow the settings of the file that is open, once."""
    unsubscribe()
    for owner, name in _FOLLOWED:
        key = (getattr(bpy.types, owner), name)
        bpy.msgbus.subscribe_rna(key=key, owner=_OWNER, args=(), notify=_refresh_all_oceans)


def unsubscribe() -> None:
    """Follow them no more."""
    bpy.msgbus.clear_by_owner(_OWNER)
