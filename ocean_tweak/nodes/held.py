# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes of meshes that the extension moves and no bake in Blender has: without it, they say that
they stand still. As they have a modifier, Blender exports their motion to USD and Alembic.
"""

from __future__ import annotations

import bpy

from .building import Builder
from .extension_check import INPUTS, is_absent
from .names import VELOCITY
from .versioned import GroupKind


def _kind(name: str, subject: str, remedy: str) -> GroupKind:
    def build(tree: bpy.types.NodeTree) -> None:
        build = Builder(tree, INPUTS)
        geometry = build.given("Geometry")
        # what stands still must not be blurred
        held = build.change("GeometryNodeRemoveAttribute", geometry, {"Name": VELOCITY})
        build.finish(build.switch("GEOMETRY", is_absent(build, subject, remedy), geometry, held))

    return GroupKind(name, 1, build)


#: the mesh over a bed
COAST = _kind(
    "Ocean Tweak Coast",
    "The coast",
    "because the Ocean Tweak extension does not run here and no bake in Blender has a coast: enable the "
    "extension",
)
#: waves around a camera that do not repeat
AREA = _kind(
    "Ocean Tweak Area",
    "The area of waves that do not repeat",
    "because the Ocean Tweak extension does not run here and a bake of the tile does not have them: enable "
    "the extension, or mute their layers",
)
