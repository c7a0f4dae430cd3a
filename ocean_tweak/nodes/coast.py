# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes of the mesh over a bed, which the extension moves: without it, the mesh says that it stands
still. As it has a modifier, Blender exports its motion to USD and Alembic.
"""

from __future__ import annotations

import bpy

from .building import Builder
from .extension_check import INPUTS, is_absent
from .names import VELOCITY
from .versioned import GroupKind

_REMEDY = (
    "because the Ocean Tweak extension does not run here and no bake in Blender has a coast: enable the "
    "extension"
)


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, INPUTS)
    geometry = build.given("Geometry")
    # what stands still must not be blurred
    held = build.change("GeometryNodeRemoveAttribute", geometry, {"Name": VELOCITY})
    build.finish(build.switch("GEOMETRY", is_absent(build, "The coast", _REMEDY), geometry, held))


COAST = GroupKind("Ocean Tweak Coast", 1, _build)
