# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes of meshes that the extension moves: without it, they say that they stand still. As they
have a modifier, Blender exports their motion to USD and Alembic.
"""

from __future__ import annotations

import bpy

from .building import Builder, Socket
from .extension_check import INPUTS, is_absent
from .names import VELOCITY
from .versioned import GroupKind

_REMEDY = (
    "because the Ocean Tweak extension does not run here and a bake of the tile does not have them: enable "
    "the extension, or mute their layers"
)


def held_still(build: Builder, geometry: Socket, subject: str, remedy: str) -> Socket:
    """A mesh as the extension wrote it, in a group with INPUTS: without velocity where nothing will move it,
    as what stands still must not be blurred.

    subject, remedy : as `is_absent` has them
    """
    held = build.change("GeometryNodeRemoveAttribute", geometry, {"Name": VELOCITY})
    return build.switch("GEOMETRY", is_absent(build, subject, remedy), geometry, held)


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, INPUTS)
    subject = "The area of waves that do not repeat"
    build.finish(held_still(build, build.given("Geometry"), subject, _REMEDY))


#: waves around a camera that do not repeat
AREA = GroupKind("Ocean Tweak Area", 1, _build)
