# SPDX-License-Identifier: GPL-3.0-or-later
"""Ocean Camera Surface: geometry nodes that show an ocean on a grid around the camera, up to the horizon.

Vertices at rest stand on a fixed lattice and are moved as the ocean's water there is. Where the lattice is
coarse, the displacement is an average over two of its cells, taken continuously from the distance: nothing
pops. What the averages lack of the slopes' squares goes to the material as slope variance, so that near and
far are equally rough (Olano & Baker 2010 keep both moments of the slopes for the same reason).
"""

from __future__ import annotations

from typing import NamedTuple

import bpy

from ..core.parameters.patch import MOST_PATCHES
from .averaged import AVERAGED
from .averages import CARRIED, OTHERS, SLOPES, ocean_carried
from .building import Builder, Plug, Socket, output
from .camera_foam import CAMERA_FOAM, RING_FACTS
from .camera_grid import CAMERA_GRID
from .camera_patch import CAMERA_PATCH
from .fields import alone, combined, connect, coordinates, named_attribute, sample_index, whole_number
from .frame_warnings import joined_text
from .names import (
    BREAKING,
    CUSP,
    DISPLACEMENT,
    FOAM,
    FOAM_AGE,
    SHORTEST_WAVE,
    SLOPE_VARIANCE,
    TEXTURE_COORDINATES,
    VELOCITY,
    WEIGHT,
)
from .sample import OCEAN_INPUT, Spaces
from .surface import CELL, GRID_FACTS
from .versioned import GroupKind, node_group

EARTH_RADIUS = 6_371_000.0  # m
#: a camera lower than this part of the radius, 2 m, or under water sees as far as from there
_LEAST_HEIGHT = 2.0 / EARTH_RADIUS
#: cells of the lattice in the shortest wave that is left
SHORTEST_CELLS = 4.0
#: of the sea's patches, where it has several; under masks a patch may be several too
PATCH_INPUTS = tuple(f"Patch {number}" for number in range(1, 2 * MOST_PATCHES + 1))
#: of what does not repeat
AREA_INPUT = "Area"
#: of foam on rings around a camera
FOAM_INPUT = "Foam"

INPUTS = (
    OCEAN_INPUT,
    Plug("Camera", "NodeSocketObject", None, "Where the grid is dense; without one, at the scene's camera"),
    Plug("Finest Spacing", "NodeSocketFloat", 0.25, "Size of the cells near the camera, in Blender units"),
    Plug("Vertex Budget", "NodeSocketInt", 200_000, "Vertices of the grid, at most"),
    Plug("To Horizon", "NodeSocketBool", True, "Reach as far as the camera sees from its height"),
    Plug("Reach", "NodeSocketFloat", 5000.0, "How far the grid goes instead, in Blender units"),
    Plug("Curvature", "NodeSocketBool", True, "Let the water fall away as on a globe"),
    Plug("Planet Radius", "NodeSocketFloat", EARTH_RADIUS, "Of that globe, in Blender units"),
    Plug("Fade", "NodeSocketBool", True, "Let waves too short for the grid become roughness"),
    Plug("Material", "NodeSocketMaterial", None, "Of the surface"),
    *(
        Plug(
            name,
            "NodeSocketObject",
            None,
            "Mesh of one patch of a sea of several; none shows the ocean's own",
        )
        for name in PATCH_INPUTS
    ),
    Plug(
        "Weights", "NodeSocketObject", None,
        "Points over the domain with the weights of patches; none takes those of the ocean's mesh",
    ),
    Plug(AREA_INPUT, "NodeSocketObject", None, "Mesh of what does not repeat, and is 0 along its sides"),
    Plug(
        FOAM_INPUT, "NodeSocketObject", None,
        "Points with foam on rings around a camera; none shows that of the ocean's mesh",
    ),
)  # fmt: skip


class _Sea(NamedTuple):
    """The ocean that is shown, in its own space.

    facts : of its mesh
    corner : its first vertex at rest
    eye : the camera, from the corner
    foam : points on rings around the camera
    of_foam : what is known of them
    """

    facts: bpy.types.Node
    corner: Socket
    eye: Socket
    foam: Socket
    of_foam: bpy.types.Node


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, INPUTS)
    spaces = Spaces(build, build.given("Ocean"))
    sea = _sea(build, spaces)
    reach = _reach(build, sea)
    inputs = {name: build.given(name) for name in ("Finest Spacing", "Vertex Budget")}
    grid = build.group(node_group(CAMERA_GRID), {"Center": sea.eye, "Reach": reach, **inputs})
    flat = build.change("GeometryNodeSetShadeSmooth", output(grid, "Geometry"))
    away = build.vector("SUBTRACT", output(build.add("GeometryNodeInputPosition"), "Position"), sea.eye)
    laid = build.store(flat, TEXTURE_COORDINATES, _texture_coordinates(build, sea), "FLOAT2", "CORNER")
    sized = build.add("GeometryNodeCaptureAttribute", {"Geometry": laid}, domain="POINT")
    sized.capture_items.new("FLOAT", "Size")
    build.tree.links.new(_size(build, grid, away), sized.inputs["Size"])
    size = sized.outputs["Size"]
    moving = _summed(build, output(sized, "Geometry"), sea, size)
    shown = _finished(build, moving, spaces, sea, away, size)
    painted = build.change("GeometryNodeSetMaterial", shown, {"Material": build.given("Material")})
    warns = _warnings(build, sea, reach, output(grid, "Reached"))
    # nobody asks a group for its warnings unless something hangs on them
    build.finish(build.switch("GEOMETRY", warns, painted, painted))


def _sea(build: Builder, spaces: Spaces) -> _Sea:
    facts = build.group(node_group(GRID_FACTS), {"Geometry": spaces.mesh})
    corner = output(facts, "Corner")
    eye = build.vector("SUBTRACT", spaces.point_of_ocean(_camera(build)), corner)
    given = {"Object": build.given(FOAM_INPUT)}
    foam = output(build.add("GeometryNodeObjectInfo", given, transform_space="ORIGINAL"), "Geometry")
    return _Sea(facts, corner, eye, foam, build.group(node_group(RING_FACTS), {"Foam": foam}))


def _camera(build: Builder) -> Socket:
    """Where the camera is: the given one, the scene's, or the object's own place."""
    active = output(build.add("GeometryNodeInputActiveCamera"), "Active Camera")
    given, scenes = (
        build.add("GeometryNodeObjectInfo", {"Object": item}, transform_space="RELATIVE")
        for item in (build.given("Camera"), active)
    )
    # there is no node for it, but an object that is not there has no scale
    is_given = build.compare("GREATER_THAN", alone(build, "LENGTH", output(given, "Scale")), 0.0, "FLOAT")
    return build.switch("VECTOR", is_given, output(scenes, "Location"), output(given, "Location"))


def _reach(build: Builder, sea: _Sea) -> Socket:
    """The distance √(2Rh) of the horizon, or the one that is asked for."""
    radius = build.given("Planet Radius")
    height = build.math(
        "MAXIMUM", coordinates(build, sea.eye)[2], build.math("MULTIPLY", radius, _LEAST_HEIGHT)
    )
    horizon = build.math("MULTIPLY", build.math("MULTIPLY", radius, 2.0), height)
    horizon = build.math("SQRT", horizon, None)
    return build.switch("FLOAT", build.given("To Horizon"), build.given("Reach"), horizon)


def _texture_coordinates(build: Builder, sea: _Sea) -> Socket:
    """As the ocean's own go on: told by its first vertex, the next one, and the one above."""
    facts = sea.facts
    st = output(named_attribute(build, TEXTURE_COORDINATES, "FLOAT_VECTOR"), "Attribute")
    first, right, above = (
        sample_index(build, output(facts, "Geometry"), st, index, "FLOAT_VECTOR")
        for index in (0, 1, output(facts, "Columns"))
    )
    step = build.vector("ADD", *(build.vector("SUBTRACT", other, first) for other in (right, above)))
    place = output(build.add("GeometryNodeInputPosition"), "Position")
    in_cells = build.vector("DIVIDE", place, output(facts, "Spacing"))
    result = build.vector("ADD", first, build.vector("MULTIPLY", in_cells, step))
    of_point = build.add(
        "GeometryNodeFieldOnDomain", {"Value": result}, data_type="FLOAT_VECTOR", domain="POINT"
    )
    return output(of_point, "Value")


def _size(build: Builder, grid: bpy.types.Node, away: Socket) -> Socket:
    """Of the lattice's cells where a vertex is, without steps.

    A level of the lattice begins where the distance is half of its m cells, less half a cell: so
    2 distance/(m - 1) is never less than the cells' size, and has no step where the levels meet.
    """
    x, y, _ = coordinates(build, alone(build, "ABSOLUTE", away))
    cells = build.integer("SUBTRACT", output(grid, "Half"), 1)
    size = build.math("DIVIDE", build.math("MULTIPLY", build.math("MAXIMUM", x, y), 2.0), cells)
    return build.math("MAXIMUM", size, build.given("Finest Spacing"))


def _summed(build: Builder, grid: Socket, sea: _Sea, size: Socket) -> Socket:
    """The grid with what it shows: the patches, or the ocean's mesh; foam on rings, or that of the mesh.

    Under the names of what is averaged are, in the ocean's axes, displacement, velocity, slopes with the
    variance that they lack, and strain.
    """
    info = build.add("GeometryNodeObjectInfo", {"Object": build.given(PATCH_INPUTS[0])})
    is_one = build.compare("LESS_EQUAL", alone(build, "LENGTH", output(info, "Scale")), 0.0, "FLOAT")
    facts = {name: output(sea.facts, name) for name in ("Columns", "Rows", "Spacing")}
    shared = {**facts, "Size": size, "Fade": build.given("Fade")}
    own = _of_mesh(build, grid, sea, shared, is_one)
    has_rings = build.logic("NIMPLY", output(sea.of_foam, "Is There"), is_one)
    grid = build.switch("GEOMETRY", has_rings, own, _of_rings(build, grid, sea, size))
    whole = {**shared, **_weights(build, sea), "Ocean": build.given("Ocean"), "Corner": sea.corner}
    for number, name in enumerate(PATCH_INPUTS, start=1):
        inputs = {**whole, "Patch": build.given(name), "Weight": WEIGHT.format(number)}
        grid = output(build.group(node_group(CAMERA_PATCH), {"Geometry": grid, **inputs}), "Geometry")
    inputs = {**whole, "Patch": build.given(AREA_INPUT), "Repeats": False}
    grid = output(build.group(node_group(CAMERA_PATCH), {"Geometry": grid, **inputs}), "Geometry")
    return build.switch("GEOMETRY", is_one, build.store(grid, CUSP, _cusp(build), "FLOAT"), grid)


def _of_mesh(build: Builder, grid: Socket, sea: _Sea, shared: dict[str, Socket], is_moving: Socket) -> Socket:
    """The grid with the foam of the ocean's mesh, and where that moves it, how."""
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    mesh = ocean_carried(build, output(sea.facts, "Geometry"), is_moving)
    own = {"Surface": mesh, "Place": position, "Moving": is_moving}
    grid = output(build.group(node_group(AVERAGED), {"Geometry": grid, **shared, **own}), "Geometry")
    values = coordinates(build, _told(build, OTHERS))
    for name, value in zip((FOAM, CUSP, BREAKING), values, strict=True):
        grid = build.store(grid, name, value, "FLOAT")
    # a mean of births would be the age of none of them
    read_there = {
        "Geometry": output(sea.facts, "Geometry"),
        "Value": output(named_attribute(build, FOAM_AGE, "FLOAT"), "Attribute"),
        "Place": build.vector("DIVIDE", position, shared["Spacing"]),
        **{name: shared[name] for name in ("Columns", "Rows")},
    }
    age, _, _ = coordinates(build, output(build.group(node_group(CELL), read_there), "Value"))
    grid = build.store(grid, FOAM_AGE, age, "FLOAT")
    x, y, squares = coordinates(build, _told(build, SLOPES))
    held = build.math("ADD", *(build.math("MULTIPLY", part, part) for part in (x, y)))
    lost = build.math("MAXIMUM", build.math("SUBTRACT", squares, held), 0.0)
    grid = build.store(grid, SLOPES, combined(build, x, y, lost), "FLOAT_VECTOR")
    # a mesh's normals are of its present shape already
    return build.store(grid, OTHERS, (0.0, 0.0, 0.0), "FLOAT_VECTOR")


def _of_rings(build: Builder, grid: Socket, sea: _Sea, size: Socket) -> Socket:
    """The grid with foam on rings, and without any waves so far."""
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    inputs = {
        "Foam": sea.foam,
        "Rings": output(sea.of_foam, "Rings"),
        "Place": build.vector("ADD", position, sea.corner),
        "Size": size,
    }
    grid = output(build.group(node_group(CAMERA_FOAM), {"Geometry": grid, **inputs}), "Geometry")
    for name in CARRIED:
        grid = build.store(grid, name, (0.0, 0.0, 0.0), "FLOAT_VECTOR")
    return grid


def _cusp(build: Builder) -> Socket:
    """How far the sum of the strains compresses the surface: what a cusp is, `core.synthesis.channels`."""
    xx, yy, shear = coordinates(build, _told(build, OTHERS))
    half_sum, half_difference = (
        build.math("MULTIPLY", build.math(operation, xx, yy), 0.5) for operation in ("ADD", "SUBTRACT")
    )
    root = alone(build, "LENGTH", combined(build, half_difference, shear))
    return build.math("MAXIMUM", build.math("SUBTRACT", root, half_sum), 0.0)


def _weights(build: Builder, sea: _Sea) -> dict[str, Socket]:
    """Points that have the patches' weights, and how they lie."""
    given = build.add(
        "GeometryNodeObjectInfo", {"Object": build.given("Weights")}, transform_space="ORIGINAL"
    )
    count = build.add("GeometryNodeAttributeDomainSize", {"Geometry": output(given, "Geometry")})
    none = build.compare("EQUAL", output(count, "Point Count"), 0)
    own = output(sea.facts, "Geometry")
    points = build.switch("GEOMETRY", none, output(given, "Geometry"), own)
    facts = build.group(node_group(GRID_FACTS), {"Geometry": points})
    lie = {name: output(facts, name) for name in ("Spacing", "Columns", "Rows")}
    return {"Weights": output(facts, "Geometry"), **lie}


def _told(build: Builder, name: str) -> Socket:
    return output(named_attribute(build, name, "FLOAT_VECTOR"), "Attribute")


def _finished(build: Builder, grid: Socket, spaces: Spaces, sea: _Sea, away: Socket, size: Socket) -> Socket:
    """The grid with its attributes and normals, moved to where the water is."""
    x, y, lost = coordinates(build, _told(build, SLOPES))
    lost = build.switch("FLOAT", build.given("Fade"), 0.0, lost)
    shortest = build.math("MULTIPLY", size, SHORTEST_CELLS)
    shortest = build.switch("FLOAT", build.given("Fade"), 0.0, shortest)
    for name, value in ((SLOPE_VARIANCE, lost), (SHORTEST_WAVE, shortest)):
        grid = build.store(grid, name, value, "FLOAT")
    drop, tilt = _curved(build, away)
    tilt_x, tilt_y, _ = coordinates(build, tilt)
    xx, yy, shear = coordinates(build, _told(build, OTHERS))
    tangents = (
        combined(build, build.math("ADD", xx, 1.0), shear, build.math("ADD", x, tilt_x)),
        combined(build, shear, build.math("ADD", yy, 1.0), build.math("ADD", y, tilt_y)),
    )
    normal = {"Custom Normal": spaces.normal_of_asker(*tangents)}
    grid = build.change("GeometryNodeSetMeshNormal", grid, normal, mode="FREE", domain="POINT")
    place = build.vector("ADD", output(build.add("GeometryNodeInputPosition"), "Position"), sea.corner)
    place = build.vector("ADD", build.vector("ADD", place, drop), _told(build, DISPLACEMENT))
    grid = build.change("GeometryNodeSetPosition", grid, {"Position": spaces.point_of_asker(place)})
    for name in (DISPLACEMENT, VELOCITY):
        grid = build.store(grid, name, spaces.direction_of_asker(_told(build, name)), "FLOAT_VECTOR")
    for name in (SLOPES, OTHERS):
        grid = build.change("GeometryNodeRemoveAttribute", grid, {"Name": name})
    return grid


def _curved(build: Builder, away: Socket) -> tuple[Socket, Socket]:
    """How far a globe has fallen at a distance d, d²/2R downwards, and the slopes of that."""
    flat = build.vector("MULTIPLY", away, (1.0, 1.0, 0.0))
    radius = build.math("MAXIMUM", build.given("Planet Radius"), 1e-3)
    amount = build.switch("FLOAT", build.given("Curvature"), 0.0, build.math("DIVIDE", -1.0, radius))
    tilt = build.scaled(flat, amount)
    square = build.add("ShaderNodeVectorMath", operation="DOT_PRODUCT")
    for socket, value in zip(square.inputs, (flat, tilt), strict=False):
        connect(build, socket, value)
    down = build.math("MULTIPLY", output(square, "Value"), 0.5)
    return combined(build, 0.0, 0.0, down), tilt


def _warnings(build: Builder, sea: _Sea, reach: Socket, reached: Socket) -> Socket:
    """Whether something is told: a budget that does not reach, a camera under water."""
    whole = [whole_number(build, value, "ROUND") for value in (reached, reach)]
    short = joined_text(
        build,
        "The vertices of the budget reach", whole[0], "units instead of", whole[1],
        "units: raise Vertex Budget or Finest Spacing, or ask for less Reach",
    )  # fmt: skip
    below = "The camera is under water: the surface reaches as far as it is seen from 2 m above"
    old = joined_text(
        build,
        "Foam around the camera is that of frame", output(sea.of_foam, "Frame"),
        "as the Ocean Tweak extension does not run here: shown is that of the ocean's own mesh, on coarser "
        "samples",
    )  # fmt: skip
    is_below = build.compare("LESS_THAN", coordinates(build, sea.eye)[2], 0.0, "FLOAT")
    shown = [
        output(build.add("GeometryNodeWarning", {"Show": show, "Message": text}, warning_type=kind), "Show")
        for show, text, kind in (
            (build.compare("LESS_THAN", reached, reach, "FLOAT"), short, "WARNING"),
            (build.logic("AND", is_below, build.given("To Horizon")), below, "INFO"),
            (output(sea.of_foam, "Is Of Another Frame"), old, "WARNING"),
        )
    ]
    return build.logic("OR", build.logic("OR", *shown[:2]), shown[2])


CAMERA_SURFACE = GroupKind("Ocean Camera Surface", 4, _build)
