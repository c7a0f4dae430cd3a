# SPDX-License-Identifier: GPL-3.0-or-later
"""Notes that a saved file has for a Blender without the extension: what of a baked ocean it does not show.

They are modifiers that change nothing and warn there. While the file is open they are not in it.
"""

from __future__ import annotations

import bpy

from ..nodes.held import DRIFTLESS, DRY, NO_BOWS
from ..nodes.versioned import is_of_kind
from . import float_current, held_sea, spray
from .baked_spray import left_out
from .settings import settings_of, shown_oceans

_KINDS = (DRY, NO_BOWS, DRIFTLESS)


def write() -> None:
    """Put them into the file that is about to be saved."""
    baked = [
        (ocean, scene)
        for ocean, scene in shown_oceans().items()
        if settings_of(ocean).source != "LIVE" and ocean.library is None
    ]
    for ocean, scene in baked:
        frame = scene.frame_current
        if spray.waits_for_bake(ocean, scene):
            held_sea.tell(ocean, DRY, frame)
        if any(left_out(ocean, scene)):
            held_sea.tell(ocean, NO_BOWS, frame)
        for carrier in float_current.carriers_in_current(ocean):
            held_sea.tell(carrier, DRIFTLESS, frame)


def take_back() -> None:
    """Take them out of the open file."""
    groups = [group for group in bpy.data.node_groups if any(is_of_kind(group, kind) for kind in _KINDS)]
    if not groups:
        return
    for item in bpy.data.objects:
        for modifier in [each for each in item.modifiers if each.type == "NODES"]:
            if modifier.node_group in groups and item.library is None:
                item.modifiers.remove(modifier)
    for group in groups:
        if group.library is None and not group.users:
            bpy.data.node_groups.remove(group)
