# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes for the values on a grid around the camera: the sum of an ocean's patches, or its mesh.

Foam is taken from the points around the camera if there are any, otherwise from the ocean's mesh and from
that of what does not repeat, if it is baked. Over a bed
the sum is weighted and added to, `over_bed`; what does not repeat, such as wakes, is on top.
"""

from __future__ import annotations

import bpy

from ..core.parameters.patch import MOST_PATCHES
from .averaged import AVERAGED, SOCKETS
from .averages import AVERAGES, ocean_carried
from .building import Builder, Plug, Socket, output
from .camera_patch import CAMERA_PATCH, Values, is_over, weighted_by
from .fields import alone, combined, coordinates, named_attribute
from .names import BREAKING, CUSP, DISPLACEMENT, FOAM, FOAM_AGE, OTHERS, SLOPES, VELOCITY, WEIGHT
from .over_bed import DEPTH, FOAM_OVER_BED, IS_THERE, OVER_BED, SHARE, whitecaps_left
from .rest_grid import CELL, GRID_FACTS
from .sample import OCEAN_INPUT
from .versioned import GroupKind, node_group

#: meshes of the sea's patches, if it has several; with masks, a patch may have several too
PATCH_INPUTS = tuple(f"Patch {number}" for number in range(1, 2 * MOST_PATCHES + 1))
#: of what does not repeat
AREA_INPUT = "Area"
#: values that add up
OF_SUM = (
    *(
        Plug(
            name,
            "NodeSocketObject",
            None,
            "Mesh of one patch of a sea of several; without one the ocean's own mesh is shown",
        )
        for name in PATCH_INPUTS
    ),
    Plug(
        "Weights",
        "NodeSocketObject",
        None,
        "Points over the domain with the weights of patches; without them those of the ocean's mesh are used",
    ),
    Plug(AREA_INPUT, "NodeSocketObject", None, "Mesh of what does not repeat, 0 along its sides"),
)
#: attributes, and values in the ocean's axes → sockets
SUMMED = {**SOCKETS, FOAM: "Foam", BREAKING: "Breaking", FOAM_AGE: "Foam Age", CUSP: "Cusp"}
#: output with the depth of still water, and whether there is a bed
DEPTH_OVER_BED, HAS_BED = "Depth", "Has Bed"

_INPUTS = (
    OCEAN_INPUT,
    *OF_SUM,
    Plug("Size", "NodeSocketFloat", 1.0, "Of the grid's cells where a vertex is"),
    Plug("Fade", "NodeSocketBool", True, "Average by the size of the cells"),
    Plug("Foam", "NodeSocketVector", None, "Foam, breaking and age around the camera"),
    Plug("Has Foam", "NodeSocketBool", False, "Whether there is some"),
)
_OUTPUTS = (
    *(Plug(socket, "NodeSocketVector", None, "In the ocean's axes") for socket in SOCKETS.values()),
    *(
        Plug(socket, "NodeSocketFloat", None, "At the vertex")
        for name, socket in SUMMED.items()
        if name not in SOCKETS
    ),
    Plug(DEPTH_OVER_BED, "NodeSocketFloat", None, "Of still water over a bed, m"),
    Plug(HAS_BED, "NodeSocketBool", None, "Whether there is a bed"),
)


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, _INPUTS, _OUTPUTS)
    ocean = {"Object": build.given("Ocean")}
    mesh = output(build.add("GeometryNodeObjectInfo", ocean, transform_space="ORIGINAL"), "Geometry")
    facts = build.group(node_group(GRID_FACTS), {"Geometry": mesh})
    info = build.add("GeometryNodeObjectInfo", {"Object": build.given(PATCH_INPUTS[0])})
    is_one = build.compare("LESS_EQUAL", alone(build, "LENGTH", output(info, "Scale")), 0.0, "FLOAT")
    own = _of_mesh(build, facts, is_one)
    around = dict(zip((FOAM, BREAKING, FOAM_AGE), coordinates(build, build.given("Foam")), strict=True))
    own_foam = _more_foam(build, {name: own[name] for name in around}, _foam_of_area(build, facts))
    foam = {
        name: build.switch("FLOAT", build.given("Has Foam"), own_foam[name], value)
        for name, value in around.items()
    }
    sums = {
        socket: build.switch("VECTOR", is_one, (0.0, 0.0, 0.0), own[name]) for name, socket in SOCKETS.items()
    }
    whole = {**_weights(build, facts), "Corner": output(facts, "Corner")}
    whole |= {name: build.given(name) for name in ("Ocean", "Size", "Fade")}
    for number, name in enumerate(PATCH_INPUTS, start=1):
        inputs = {**whole, "Weight": WEIGHT.format(number), **sums, "Patch": build.given(name)}
        patch = build.group(node_group(CAMERA_PATCH), inputs)
        sums = {socket: output(patch, socket) for socket in sums}
    bed = _bed(build, mesh, output(facts, "Corner"))
    values = _over_bed(build, bed, {name: sums[socket] for name, socket in SOCKETS.items()})
    foam = _foam_over_bed(build, bed, foam)
    sums = {socket: values[name] for name, socket in SOCKETS.items()}
    inputs = {**whole, "Repeats": False, **sums, "Patch": build.given(AREA_INPUT)}
    area = build.group(node_group(CAMERA_PATCH), inputs)
    values = {name: output(area, socket) for name, socket in SOCKETS.items()}
    # of a mesh's own motion there is no strain to add the bed's to
    strained = _cusp(build, values[OTHERS])
    left, _, _ = coordinates(build, output(bed, SHARE))
    over_bed = build.math("MAXIMUM", build.math("MULTIPLY", own[CUSP], left), strained)
    of_mesh = build.switch("FLOAT", output(bed, IS_THERE), own[CUSP], over_bed)
    cusp = build.switch("FLOAT", is_one, strained, of_mesh)
    shown = {**values, **foam, CUSP: cusp}
    told = {DEPTH_OVER_BED: output(bed, DEPTH), HAS_BED: output(bed, IS_THERE)}
    build.finish_with({**{socket: shown[name] for name, socket in SUMMED.items()}, **told})


def _bed(build: Builder, ocean: Socket, corner: Socket) -> bpy.types.Node:
    """What a bed adds to the open sea at the grid's vertices."""
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    inputs = {"Geometry": ocean, "Place": build.vector("ADD", position, corner)}
    inputs |= {name: build.given(name) for name in ("Size", "Fade")}
    return build.group(node_group(OVER_BED), inputs)


def _over_bed(build: Builder, bed: bpy.types.Node, open_sea: Values) -> Values:
    """Values that add up, over a bed."""
    weighted = weighted_by(build, open_sea, output(bed, SHARE))
    result = {}
    for name, socket in SOCKETS.items():
        whole = build.vector("ADD", weighted[name], output(bed, socket))
        result[name] = build.switch("VECTOR", output(bed, IS_THERE), open_sea[name], whole)
    return result


def _foam_over_bed(build: Builder, bed: bpy.types.Node, foam: dict[str, Socket]) -> dict[str, Socket]:
    """Foam, breaking and age with those over a bed: the age of that of which there is more."""
    share = whitecaps_left(build, bed)
    of_bed = dict(
        zip((FOAM, BREAKING, FOAM_AGE), coordinates(build, output(bed, FOAM_OVER_BED)), strict=True)
    )
    left = {name: build.math("MULTIPLY", foam[name], share) for name in (FOAM, BREAKING)}
    whole = _more_foam(build, {**left, FOAM_AGE: foam[FOAM_AGE]}, of_bed)
    return {name: build.switch("FLOAT", output(bed, IS_THERE), foam[name], whole[name]) for name in foam}


def _more_foam(build: Builder, one: dict[str, Socket], other: dict[str, Socket]) -> dict[str, Socket]:
    """The most of two foams and of how they break, with the age of that of which there is more."""
    more = build.compare("GREATER_THAN", other[FOAM], one[FOAM], "FLOAT")
    most = {name: build.math("MAXIMUM", one[name], other[name]) for name in (FOAM, BREAKING)}
    return {**most, FOAM_AGE: build.switch("FLOAT", more, one[FOAM_AGE], other[FOAM_AGE])}


def _foam_of_area(build: Builder, of_ocean: bpy.types.Node) -> dict[str, Socket]:
    """Foam, breaking and age of what does not repeat, at the grid's vertices; live it has none of its own."""
    area = {"Object": build.given(AREA_INPUT)}
    mesh = output(build.add("GeometryNodeObjectInfo", area, transform_space="ORIGINAL"), "Geometry")
    facts = build.group(node_group(GRID_FACTS), {"Geometry": mesh})
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    in_ocean = build.vector("ADD", position, output(of_ocean, "Corner"))
    place = build.vector("SUBTRACT", in_ocean, output(facts, "Corner"))
    lies = {name: output(facts, name) for name in ("Columns", "Rows", "Spacing")}
    names = (FOAM, BREAKING, FOAM_AGE)
    values = (output(named_attribute(build, name, "FLOAT"), "Attribute") for name in names)
    read = {
        "Geometry": output(facts, "Geometry"),
        "Value": combined(build, *values),
        "Place": build.vector("DIVIDE", place, lies["Spacing"]),
        **{name: lies[name] for name in ("Columns", "Rows")},
    }
    found = output(build.group(node_group(CELL), read), "Value")
    there = build.scaled(found, build.switch("FLOAT", is_over(build, place, lies), 0.0, 1.0))
    return dict(zip(names, coordinates(build, there), strict=True))


def _of_mesh(build: Builder, facts: bpy.types.Node, is_moving: Socket) -> dict[str, Socket]:
    """The foam of the ocean's mesh and, if it moves the surface, its motion."""
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    mesh = output(facts, "Geometry")
    counts = {name: output(facts, name) for name in ("Columns", "Rows")}
    fade, spacing = {"Fade": build.given("Fade")}, output(facts, "Spacing")
    carried = {"Geometry": ocean_carried(build, mesh, is_moving), "Moving": is_moving}
    averages = build.group(node_group(AVERAGES), {**carried, **counts, **fade})
    inputs = {"Averages": output(averages, "Geometry"), "Levels": output(averages, "Levels")}
    at = {"Spacing": spacing, "Place": position, "Size": build.given("Size")}
    read = build.group(node_group(AVERAGED), {**inputs, **at, **counts, **fade})
    x, y, squares = coordinates(build, output(read, SOCKETS[SLOPES]))
    held = build.math("ADD", *(build.math("MULTIPLY", part, part) for part in (x, y)))
    lost = build.math("MAXIMUM", build.math("SUBTRACT", squares, held), 0.0)
    foam, cusp, breaking = coordinates(build, output(read, SOCKETS[OTHERS]))
    # the mean of several ages would be none of them
    read_there = {
        "Geometry": mesh,
        "Value": output(named_attribute(build, FOAM_AGE, "FLOAT"), "Attribute"),
        "Place": build.vector("DIVIDE", position, spacing),
        **counts,
    }
    age, _, _ = coordinates(build, output(build.group(node_group(CELL), read_there), "Value"))
    return {
        DISPLACEMENT: output(read, SOCKETS[DISPLACEMENT]),
        VELOCITY: output(read, SOCKETS[VELOCITY]),
        SLOPES: combined(build, x, y, lost),
        # a mesh's normals belong to its present shape
        OTHERS: build.scaled(output(read, SOCKETS[OTHERS]), 0.0),
        FOAM: foam,
        CUSP: cusp,
        BREAKING: breaking,
        FOAM_AGE: age,
    }


def _cusp(build: Builder, strain: Socket) -> Socket:
    """Compression of the surface by the summed strains: the cusp of `core.synthesis.channels`."""
    xx, yy, shear = coordinates(build, strain)
    half_sum, half_difference = (
        build.math("MULTIPLY", build.math(operation, xx, yy), 0.5) for operation in ("ADD", "SUBTRACT")
    )
    root = alone(build, "LENGTH", combined(build, half_difference, shear))
    return build.math("MAXIMUM", build.math("SUBTRACT", root, half_sum), 0.0)


def _weights(build: Builder, own: bpy.types.Node) -> dict[str, Socket]:
    """Points with the patches' weights, and their layout."""
    given = build.add(
        "GeometryNodeObjectInfo", {"Object": build.given("Weights")}, transform_space="ORIGINAL"
    )
    count = build.add("GeometryNodeAttributeDomainSize", {"Geometry": output(given, "Geometry")})
    none = build.compare("EQUAL", output(count, "Point Count"), 0)
    points = build.switch("GEOMETRY", none, output(given, "Geometry"), output(own, "Geometry"))
    facts = build.group(node_group(GRID_FACTS), {"Geometry": points})
    lie = {name: output(facts, name) for name in ("Spacing", "Columns", "Rows")}
    return {"Weights": output(facts, "Geometry"), **lie}


CAMERA_SUM = GroupKind("Ocean Tweak Camera Sum", 4, _build)
