# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that replace a mesh by a grid of any density, in the layout of `scene.grid_mesh`.

Materials are kept. Vertices are in the same order: x fastest.
"""

from __future__ import annotations

import bpy

from .building import Builder, Plug, Socket, output
from .extension_check import ABSENCE
from .names import TEXTURE_COORDINATES
from .versioned import GroupKind, node_group

#: the inputs besides the geometry
INPUTS = (
    Plug("Size", "NodeSocketFloat", 400.0, "Side of one patch in Blender units"),
    Plug("Quads", "NodeSocketInt", 512, "Along each side of one patch"),
    Plug("Samples", "NodeSocketInt", 512, "Along each side of the image that will move the grid"),
    Plug("Repeats X", "NodeSocketInt", 1, "Patches side by side along x"),
    Plug("Repeats Y", "NodeSocketInt", 1, "Patches side by side along y"),
    Plug(
        "Live", "NodeSocketBool", False,
        "Keep the mesh where the extension, which fills the images, is missing", hidden=True,
    ),
)  # fmt: skip


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, INPUTS)
    quads = build.integer("MAXIMUM", build.given("Quads"), 1)
    columns, rows = (_vertices_along(build, quads, build.given(name)) for name in ("Repeats X", "Repeats Y"))
    # the primitive counts along y first; read along x first, its faces look down
    grid = build.add("GeometryNodeMeshGrid", {"Vertices X": rows, "Vertices Y": columns})
    turned = build.change("GeometryNodeFlipFaces", output(grid, "Mesh"))
    place = _place(build, columns, quads)
    position = build.scaled(place, build.given("Size"))
    placed = build.change("GeometryNodeSetPosition", turned, {"Position": position})
    smooth = build.change("GeometryNodeSetShadeSmooth", placed)
    half = build.math("DIVIDE", 0.5, build.given("Samples"))
    # indices of vertices, not of the corners on which the result is stored
    of_vertex = build.add(
        "GeometryNodeFieldOnDomain", {"Value": build.vector("ADD", place, half)},
        data_type="FLOAT_VECTOR", domain="POINT",
    )  # fmt: skip
    coordinates = output(of_vertex, "Value")
    made = _with_materials(build, build.store(smooth, TEXTURE_COORDINATES, coordinates, "FLOAT2", "CORNER"))
    absent = output(build.group(node_group(ABSENCE), {"Live": build.given("Live")}), "Is Absent")
    build.finish(build.switch("GEOMETRY", absent, made, output(build.input, "Geometry")))


def _vertices_along(build: Builder, quads: Socket, repeats: Socket) -> Socket:
    patches = build.integer("MAXIMUM", repeats, 1)
    return build.integer("ADD", build.integer("MULTIPLY", quads, patches), 1)


def _place(build: Builder, columns: Socket, quads: Socket) -> Socket:
    """Position of a vertex by its index, in patches."""
    index = output(build.add("GeometryNodeInputIndex"), "Index")
    column, row = (build.integer(operation, index, columns) for operation in ("MODULO", "DIVIDE_FLOOR"))
    x, y = (build.math("DIVIDE", number, quads) for number in (column, row))
    return output(build.add("ShaderNodeCombineXYZ", {"X": x, "Y": y}), "Vector")


def _with_materials(build: Builder, grid: Socket) -> Socket:
    """The grid with the materials of the group's geometry.

    Only joining transfers materials, so the geometry is joined and its vertices are deleted again.
    """
    geometry = output(build.input, "Geometry")
    joined = build.add("GeometryNodeJoinGeometry")
    for part in (grid, geometry):  # what is linked last stands first
        build.tree.links.new(part, joined.inputs[0])
    count = output(build.add("GeometryNodeAttributeDomainSize", {"Geometry": geometry}), "Point Count")
    index = output(build.add("GeometryNodeInputIndex"), "Index")
    selection = {"Selection": build.compare("LESS_THAN", index, count)}
    alone = build.change("GeometryNodeDeleteGeometry", joined.outputs[0], selection)
    return build.change("GeometryNodeSetMaterialIndex", alone, {"Material Index": 0})


GRID = GroupKind("Ocean Tweak Grid", 3, _build)
