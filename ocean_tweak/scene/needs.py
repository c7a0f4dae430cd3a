# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands still in a Blender without the extension, told before a farm finds out."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import bpy

from ..nodes.modifier_inputs import all_inputs
from . import floating, patch_objects
from .settings import settings_of


class Need(NamedTuple):
    """An object that only the extension moves.

    name : of the object
    """

    name: str
    reason: str
    remedy: str

    @property
    def text(self) -> str:
        """In a line."""
        return f"{self.name} {self.reason}: {self.remedy}"


def needs_of(ocean: bpy.types.Object) -> tuple[Need, ...]:
    """The ocean and what reads it, as far as these need the extension; none where all of it is baked."""
    surface = patch_objects.camera_surface_of(ocean)
    if settings_of(ocean).source == "LIVE":
        return (_live(ocean), *_readers(ocean))
    patches = patch_objects.patches_of(ocean)
    if surface is not None and patches and not patch_objects.are_baked(ocean):
        reason = f"shows the patches of {ocean.name}, of which its bake has no points"
        return (Need(surface.name, reason, f"bake {ocean.name} again"),)
    return ()


def _live(ocean: bpy.types.Object) -> Need:
    if ocean.library is not None:
        where = bpy.path.basename(ocean.library.filepath)
        return Need(ocean.name, "is linked and computed live", f"bake it in {where}")
    return Need(ocean.name, "is computed live", "bake it")


def _readers(ocean: bpy.types.Object) -> Iterator[Need]:
    """Objects whose modifiers read a live ocean, and those that float on it."""
    for item in bpy.data.objects:
        nodes = (each for each in item.modifiers if each.type == "NODES" and each.node_group is not None)
        if item == ocean or not any(ocean in all_inputs(modifier).values() for modifier in nodes):
            continue
        if not floating.is_carrier(item):
            yield Need(item.name, f"reads {ocean.name}, which is computed live", f"bake {ocean.name}")
            continue
        for other in floating.carried_by(item):
            remedy = f"bake {ocean.name}, or its floating to keys"
            yield Need(other.name, f"floats on {ocean.name}, which is computed live", remedy)
