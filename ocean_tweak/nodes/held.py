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
    "because the Ocean Tweak extension does not run here and the bake does not have them: enable the "
    "extension, or bake the ocean again"
)


def held_still(build: Builder, geometry: Socket, state: str, remedy: str) -> Socket:
    """A mesh as the extension wrote it, in a group with INPUTS: without velocity where nothing will move it,
    as what stands still must not be blurred.

    state, remedy : as `is_absent` has them
    """
    held = build.change("GeometryNodeRemoveAttribute", geometry, {"Name": VELOCITY})
    return build.switch("GEOMETRY", is_absent(build, state, remedy), geometry, held)


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, INPUTS)
    state = "The area of waves that do not repeat stands still as it was in frame"
    build.finish(held_still(build, build.given("Geometry"), state, _REMEDY))


def _note(name: str, state: str, remedy: str, version: int = 1) -> GroupKind:
    """A group that changes nothing and says so where the extension is missing."""

    def build(tree: bpy.types.NodeTree) -> None:
        build = Builder(tree, INPUTS)
        geometry = build.given("Geometry")
        build.finish(build.switch("GEOMETRY", is_absent(build, state, remedy), geometry, geometry))

    return GroupKind(name, version, build)


#: waves around a camera that do not repeat
AREA = GroupKind("Ocean Tweak Area", 2, _build)
#: an ocean whose bake has no spray
DRY = _note(
    "Ocean Tweak Dry",
    "There is no spray as in frame",
    "because the Ocean Tweak extension does not run here and the bake has none: enable the extension, or "
    "bake the ocean again",
)
#: an ocean around a camera, whose bake is without what bows or a coast's breakers throw up
NO_BOWS = _note(
    "Ocean Tweak No Bows",
    "There is no spray of bows and of breakers on a coast as in frame",
    "because the Ocean Tweak extension does not run here and the bake has none of it: enable the extension "
    "and press Back to Live",
    version=2,
)
#: the carrier of what drifts with a current
DRIFTLESS = _note(
    "Ocean Tweak Driftless",
    "What floats here has drifted as far as in frame",
    "because the Ocean Tweak extension, which carries it along with the current, does not run here: enable "
    "the extension, or bake the floating to keys",
)
