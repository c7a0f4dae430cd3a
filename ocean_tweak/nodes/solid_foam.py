# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that give the faces which foam covers a material of their own, for the Solid view."""

from __future__ import annotations

import bpy

from .building import Builder, Plug, output
from .names import FOAM
from .versioned import GroupKind

MATERIAL_INPUT = "Foam Material"

_COVERED = 0.5  # foam of a face from which on it is white


def _build(tree: bpy.types.NodeTree) -> None:
    plug = Plug(MATERIAL_INPUT, "NodeSocketMaterial", None, "Of the faces that foam covers")
    build = Builder(tree, (plug,))
    foam = build.add("GeometryNodeInputNamedAttribute", {"Name": FOAM}, data_type="FLOAT")
    covered = build.compare("GREATER_THAN", output(foam, "Attribute"), _COVERED, "FLOAT")
    inputs = {"Selection": covered, "Material": build.given(MATERIAL_INPUT)}
    build.finish(build.change("GeometryNodeSetMaterial", build.given("Geometry"), inputs))


SOLID_FOAM = GroupKind("Ocean Tweak Solid View Foam", 1, _build)
