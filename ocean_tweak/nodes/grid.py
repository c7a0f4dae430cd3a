# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that put a grid of any density in the place of a mesh, as `scene.grid_mesh` would make it.

It keeps the materials. Vertices stand in the same order: x fastest.
"""

from __future__ import annotations

import bpy

from .building import Builder, Socket, output
from .versioned import GroupKind

UV_MAP = "st"


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(
        tree,
        (
            ("Size", "NodeSocketFloat", 400.0, "Side of the patch in Blender units"),
            ("Quads", "NodeSocketInt", 512, "Along each side"),
            ("Samples", "NodeSocketInt", 512, "Along each side of the image that will move the grid"),
        ),
    )
    side = build.math("ADD", output(build.input, "Quads"), 1, "FunctionNodeIntegerMath")
    grid = build.add("GeometryNodeMeshGrid", {"Vertices X": side, "Vertices Y": side})
    place = _place(build, side)
    # the primitive counts along y first; read along x first, its faces look down
    turned = build.change("GeometryNodeFlipFaces", output(grid, "Mesh"))
    placed = build.change("GeometryNodeSetPosition", turned, {"Position": place})
    smooth = build.change("GeometryNodeSetShadeSmooth", placed)
    half = build.math("DIVIDE", 0.5, output(build.input, "Samples"))
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    fraction = build.math("DIVIDE", position, output(build.input, "Size"), "ShaderNodeVectorMath")
    coordinates = build.math("ADD", fraction, half, "ShaderNodeVectorMath")
    mapped = build.change(
        "GeometryNodeStoreNamedAttribute", smooth, {"Name": UV_MAP, "Value": coordinates},
        data_type="FLOAT2", domain="CORNER",
    )  # fmt: skip
    build.finish(_with_materials(build, mapped))


def _place(build: Builder, side: Socket) -> Socket:
    """Where a vertex lies by its number."""
    index = output(build.add("GeometryNodeInputIndex"), "Index")
    step = build.math("DIVIDE", output(build.input, "Size"), output(build.input, "Quads"))
    column = build.math("MODULO", index, side, "FunctionNodeIntegerMath")
    row = build.math("DIVIDE_FLOOR", index, side, "FunctionNodeIntegerMath")
    x, y = build.math("MULTIPLY", column, step), build.math("MULTIPLY", row, step)
    return output(build.add("ShaderNodeCombineXYZ", {"X": x, "Y": y}), "Vector")


def _with_materials(build: Builder, grid: Socket) -> Socket:
    """The grid with the materials of the group's geometry.

    Only joining brings materials over, so the geometry is joined and its vertices are taken away again.
    """
    geometry = output(build.input, "Geometry")
    joined = build.add("GeometryNodeJoinGeometry")
    for part in (grid, geometry):  # what is linked last stands first
        build.tree.links.new(part, joined.inputs[0])
    count = output(build.add("GeometryNodeAttributeDomainSize", {"Geometry": geometry}), "Point Count")
    index = output(build.add("GeometryNodeInputIndex"), "Index")
    before = build.add(
        "FunctionNodeCompare", {"A": index, "B": count}, data_type="INT", operation="LESS_THAN"
    )
    selection = {"Selection": output(before, "Result")}
    alone = build.change("GeometryNodeDeleteGeometry", joined.outputs[0], selection)
    return build.change("GeometryNodeSetMaterialIndex", alone, {"Material Index": 0})


GRID = GroupKind("Ocean Tweak Grid", 1, _build)
