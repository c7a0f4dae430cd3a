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

from . import averages
from .averages import AVERAGES, CARRIED, SLOPES, WHITE, read, with_carried
from .building import Builder, Plug, Socket, output
from .camera_grid import CAMERA_GRID
from .fields import alone, combined, connect, coordinates, named_attribute, sample_index, whole_number
from .frame_warnings import joined_text
from .names import CUSP, DISPLACEMENT, FOAM, SLOPE_VARIANCE, TEXTURE_COORDINATES, VELOCITY
from .sample import OCEAN_INPUT, Spaces
from .surface import GRID_FACTS
from .versioned import GroupKind, node_group

EARTH_RADIUS = 6_371_000.0  # m
#: a camera lower than this part of the radius, 2 m, or under water sees as far as from there
_LEAST_HEIGHT = 2.0 / EARTH_RADIUS
#: cells of the lattice in a cell of the averages: what is left is at least four cells long
_LATTICE_CELLS = 2.0

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
)


class _Sea(NamedTuple):
    """The ocean that is shown, in its own space.

    facts : of its mesh
    corner : its first vertex at rest
    period : its size along x and y, and 1
    eye : the camera, from the corner
    """

    facts: bpy.types.Node
    corner: Socket
    period: Socket
    eye: Socket


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
    moving = _averaged(build, laid, sea, _level(build, sea, grid, away))
    shown = _finished(build, moving, spaces, sea, away)
    painted = build.change("GeometryNodeSetMaterial", shown, {"Material": build.given("Material")})
    warns = _warnings(build, sea, reach, output(grid, "Reached"))
    # nobody asks a group for its warnings unless something hangs on them
    build.finish(build.switch("GEOMETRY", warns, painted, painted))


def _sea(build: Builder, spaces: Spaces) -> _Sea:
    facts = build.group(node_group(GRID_FACTS), {"Geometry": spaces.mesh})
    corner = output(facts, "Corner")
    counts = averages.cells(build, output(facts, "Columns"), output(facts, "Rows"))
    period = build.vector("MULTIPLY", output(facts, "Spacing"), counts)
    eye = build.vector("SUBTRACT", spaces.point_of_ocean(_camera(build)), corner)
    return _Sea(facts, corner, period, eye)


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


def _level(build: Builder, sea: _Sea, grid: bpy.types.Node, away: Socket) -> Socket:
    """How often the surface is halved where a vertex is: a fraction, 0 where the lattice is fine enough.

    A level of the lattice begins where the distance is half of its m cells, less half a cell: so
    2 distance/(m - 1) is never less than the cells' size, and has no step where the levels meet.
    """
    x, y, _ = coordinates(build, alone(build, "ABSOLUTE", away))
    cells = build.integer("SUBTRACT", output(grid, "Half"), 1)
    size = build.math("DIVIDE", build.math("MULTIPLY", build.math("MAXIMUM", x, y), 2.0), cells)
    size = build.math("MAXIMUM", size, build.given("Finest Spacing"))
    step_x, step_y, _ = coordinates(build, output(sea.facts, "Spacing"))
    ratio = build.math("DIVIDE", size, build.math("MINIMUM", step_x, step_y))
    level = build.math("LOGARITHM", build.math("MULTIPLY", ratio, _LATTICE_CELLS), 2.0)
    most = _most_levels(build, sea)
    held = build.math("MINIMUM", build.math("MAXIMUM", level, 0.0), most)
    return build.switch("FLOAT", build.given("Fade"), 0.0, held)


def _most_levels(build: Builder, sea: _Sea) -> Socket:
    return averages.halvings(build, *(output(sea.facts, name) for name in ("Columns", "Rows")))


def _averaged(build: Builder, grid: Socket, sea: _Sea, level: Socket) -> Socket:
    """The grid with what it shows of the ocean: between two averages where the level is a fraction."""
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    periods = alone(build, "FRACTION", build.vector("DIVIDE", position, sea.period))
    once = build.add("GeometryNodeCaptureAttribute", {"Geometry": grid}, domain="POINT")
    for kind, name, value in (("FLOAT", "Level", level), ("VECTOR", "Periods", periods)):
        once.capture_items.new(kind, name)
        build.tree.links.new(value, once.inputs[name])
    end = build.add("GeometryNodeRepeatOutput")
    end.repeat_items.clear()
    counts = [output(sea.facts, name) for name in ("Columns", "Rows")]
    before = {"Geometry": with_carried(build, output(sea.facts, "Geometry"))}
    before |= dict(zip(("Columns", "Rows"), counts, strict=True))
    kinds = {"Geometry": "GEOMETRY", "Columns": "INT", "Rows": "INT", "Grid": "GEOMETRY"}
    for name, kind in kinds.items():
        end.repeat_items.new(kind, name)
    begin = build.add("GeometryNodeRepeatInput")
    begin.pair_with_output(end)
    for name, value in {**before, "Grid": output(once, "Geometry")}.items():
        connect(build, begin.inputs[name], value)
    fading = build.integer("ADD", whole_number(build, _most_levels(build, sea), "ROUND"), 1)
    connect(build, begin.inputs["Iterations"], build.switch("INT", build.given("Fade"), 1, fading))

    mesh = {name: begin.outputs[name] for name in before}
    off = build.math(
        "ABSOLUTE", build.math("SUBTRACT", once.outputs["Level"], begin.outputs["Iteration"]), None
    )
    share = build.math("SUBTRACT", 1.0, off)
    place = _place(build, once.outputs["Periods"], counts, mesh)
    part = begin.outputs["Grid"]
    for name in CARRIED:
        told = output(named_attribute(build, name, "FLOAT_VECTOR"), "Attribute")
        more = build.scaled(read(build, mesh, name, place), share)
        inputs = {
            "Name": name, "Value": build.vector("ADD", told, more),
            "Selection": build.compare("GREATER_THAN", share, 0.0, "FLOAT"),
        }  # fmt: skip
        part = build.change(
            "GeometryNodeStoreNamedAttribute", part, inputs, data_type="FLOAT_VECTOR", domain="POINT"
        )
    after = build.group(node_group(AVERAGES), mesh)
    for name in before:
        connect(build, end.inputs[name], output(after, name))
    connect(build, end.inputs["Grid"], part)
    return end.outputs["Grid"]


def _place(build: Builder, periods: Socket, counts: list[Socket], mesh: dict[str, Socket]) -> Socket:
    """A vertex in cells of a mesh of averages, whose samples stand for places half a cell in."""
    half = build.vector("DIVIDE", (0.5, 0.5, 0.0), averages.cells(build, *counts))
    number = averages.cells(build, mesh["Columns"], mesh["Rows"])
    middle = build.vector("MULTIPLY", build.vector("ADD", periods, half), number)
    return build.vector("SUBTRACT", middle, (0.5, 0.5, 0.0))


def _finished(build: Builder, grid: Socket, spaces: Spaces, sea: _Sea, away: Socket) -> Socket:
    """The grid with its attributes and normals, moved to where the water is."""

    def told(name: str) -> Socket:
        return output(named_attribute(build, name, "FLOAT_VECTOR"), "Attribute")

    x, y, squares = coordinates(build, told(SLOPES))
    held = build.math("ADD", *(build.math("MULTIPLY", part, part) for part in (x, y)))
    lost = build.math("MAXIMUM", build.math("SUBTRACT", squares, held), 0.0)
    lost = build.switch("FLOAT", build.given("Fade"), 0.0, lost)
    foam, cusp, _ = coordinates(build, told(WHITE))
    for name, value in ((SLOPE_VARIANCE, lost), (FOAM, foam), (CUSP, cusp)):
        grid = build.store(grid, name, value, "FLOAT")
    drop, tilt = _curved(build, away)
    tilt_x, tilt_y, _ = coordinates(build, tilt)
    tangents = (
        combined(build, 1.0, 0.0, build.math("ADD", x, tilt_x)),
        combined(build, 0.0, 1.0, build.math("ADD", y, tilt_y)),
    )
    normal = {"Custom Normal": spaces.normal_of_asker(*tangents)}
    grid = build.change("GeometryNodeSetMeshNormal", grid, normal, mode="FREE", domain="POINT")
    place = build.vector("ADD", output(build.add("GeometryNodeInputPosition"), "Position"), sea.corner)
    place = build.vector("ADD", build.vector("ADD", place, drop), told(DISPLACEMENT))
    grid = build.change("GeometryNodeSetPosition", grid, {"Position": spaces.point_of_asker(place)})
    for name in (DISPLACEMENT, VELOCITY):
        grid = build.store(grid, name, spaces.direction_of_asker(told(name)), "FLOAT_VECTOR")
    for name in (SLOPES, WHITE):
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
    is_below = build.compare("LESS_THAN", coordinates(build, sea.eye)[2], 0.0, "FLOAT")
    shown = [
        output(build.add("GeometryNodeWarning", {"Show": show, "Message": text}, warning_type=kind), "Show")
        for show, text, kind in (
            (build.compare("LESS_THAN", reached, reach, "FLOAT"), short, "WARNING"),
            (build.logic("AND", is_below, build.given("To Horizon")), below, "INFO"),
        )
    ]
    return build.logic("OR", *shown)


CAMERA_SURFACE = GroupKind("Ocean Camera Surface", 1, _build)
