# SPDX-License-Identifier: GPL-3.0-or-later
"""Ocean Camera Surface: geometry nodes that show an ocean on a grid around the camera, up to the horizon.

Vertices at rest are on a fixed lattice and are displaced like the ocean's water there. Where the lattice is
coarse, the displacement is averaged over two cells, blended continuously with the distance, so nothing pops.
The slope variance lost by averaging is passed to the material, so that near and far water are equally rough
(Olano & Baker 2010 keep both moments of the slopes for the same reason).
"""

from __future__ import annotations

from typing import NamedTuple

import bpy

from .building import Builder, Plug, Socket, output
from .camera_foam import CAMERA_FAN, CAMERA_FOAM, RING_FACTS
from .camera_grid import CAMERA_GRID
from .camera_sum import CAMERA_SUM, DEPTH_OVER_BED, HAS_BED, OF_SUM, SUMMED
from .fields import alone, coordinates, named_attribute, sample_index, whole_number
from .foam_pile import FOAM_PILE
from .frame_warnings import joined_text
from .globe import EARTH_RADIUS, curved_normal, reach_of
from .names import (
    BREAKING,
    COAST_DEPTH,
    CUSP,
    DISPLACEMENT,
    FOAM,
    FOAM_AGE,
    OTHERS,
    SHORTEST_WAVE,
    SLOPE_VARIANCE,
    SLOPES,
    TEXTURE_COORDINATES,
    VELOCITY,
)
from .rest_grid import GRID_FACTS
from .sample import OCEAN_INPUT, Spaces
from .versioned import GroupKind, node_group

#: lattice cells per shortest remaining wave
SHORTEST_CELLS = 4.0
#: exponent with which averaging follows larger cells in the viewport, chosen to look most like the render
_FOLLOWED = 0.25
#: smallest cells in the viewport, relative to the camera's height
_CELLS_OF_HEIGHT = 24.0
#: smallest cells per lump of fresh foam
_LUMP_CELLS = 80.0
#: breaking above which foam is piled up: smaller values are the mean of crests too far away to resolve
_LEAST_BREAKING = 0.02
#: inputs of the pile of foam → attributes of the surface
_OF_PILE = {"Displacement": DISPLACEMENT, "Velocity": VELOCITY, "Breaking": BREAKING}
#: attributes of foam around a camera
FOAM_INPUT = "Foam"
#: attributes of fresh foam
PILE_INPUT = "Foam Pile"

INPUTS = (
    OCEAN_INPUT,
    Plug("Camera", "NodeSocketObject", None, "Where the grid is dense; without one, at the scene's camera"),
    Plug("Finest Spacing", "NodeSocketFloat", 0.25, "Size of the cells near the camera, in Blender units"),
    Plug("Vertex Budget", "NodeSocketInt", 200_000, "Vertices of the grid, at most"),
    Plug(
        "Viewport Vertex Budget", "NodeSocketInt", 32_000,
        "Vertices of the grid in the viewport, at most; its cells are larger in proportion, and none is "
        "smaller than a 24th of the camera's height",
    ),
    Plug("To Horizon", "NodeSocketBool", True, "Reach as far as the camera sees from its height"),
    Plug("Reach", "NodeSocketFloat", 5000.0, "How far the grid goes instead, in Blender units"),
    Plug("Curvature", "NodeSocketBool", True, "Curve the water like a globe"),
    Plug("Planet Radius", "NodeSocketFloat", EARTH_RADIUS, "Of that globe, in Blender units"),
    Plug("Fade", "NodeSocketBool", True, "Turn waves that are too short for the grid into roughness"),
    Plug("Material", "NodeSocketMaterial", None, "Of the surface"),
    *OF_SUM,
    Plug(
        FOAM_INPUT, "NodeSocketObject", None,
        "Points with foam around or in front of a camera; without them the foam of the ocean's "
        "mesh is shown",
    ),
    Plug(
        PILE_INPUT, "NodeSocketFloat", 0.0,
        "Height of foam on breaking crests, as a fraction of their elevation; the water keeps its height",
    ),
)  # fmt: skip


class _Sea(NamedTuple):
    """The ocean, in its own space.

    facts : properties of its mesh
    corner : rest position of its first vertex
    eye : the camera, relative to the corner
    foam : points around the camera
    of_foam : properties of these points
    is_fan : whether they are the surface's vertices
    """

    facts: bpy.types.Node
    corner: Socket
    eye: Socket
    foam: Socket
    of_foam: bpy.types.Node
    is_fan: Socket


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, INPUTS)
    spaces = Spaces(build, build.given("Ocean"))
    sea = _sea(build, spaces)
    reach = reach_of(build, sea.eye)
    budget, coarser = _density(build)
    finest = _finest(build, coarser, sea.eye)
    inputs = {"Center": sea.eye, "Reach": reach, "Vertex Budget": budget, "Finest Spacing": finest}
    grid = build.group(node_group(CAMERA_GRID), inputs)
    inputs = {"Foam": sea.foam, "Columns": output(sea.of_foam, "Columns"), "Corner": sea.corner}
    fan = build.group(node_group(CAMERA_FAN), inputs)
    either = build.switch("GEOMETRY", sea.is_fan, *(output(each, "Geometry") for each in (grid, fan)))
    flat = build.change("GeometryNodeSetShadeSmooth", either)
    away = build.vector("SUBTRACT", output(build.add("GeometryNodeInputPosition"), "Position"), sea.eye)
    laid = build.store(flat, TEXTURE_COORDINATES, _texture_coordinates(build, sea), "FLOAT2", "CORNER")
    # averaging does not follow the cell size fully: the viewport shows waves of few cells instead of none
    size = build.math(
        "DIVIDE", _size(build, grid, away, finest), build.math("POWER", coarser, 1.0 - _FOLLOWED)
    )
    size = build.switch("FLOAT", sea.is_fan, size, output(fan, "Size"))
    foam = build.switch("VECTOR", sea.is_fan, _of_rings(build, sea, size), output(fan, "Value"))
    shown = _finished(build, laid, _summed(build, sea, size, foam), spaces, sea, away, size)
    painted = build.change("GeometryNodeSetMaterial", shown, {"Material": build.given("Material")})
    reached = build.switch("FLOAT", sea.is_fan, output(grid, "Reached"), reach)
    warns = _warnings(build, sea, reach, reached)
    # warnings are only evaluated if the output depends on them
    build.finish(build.switch("GEOMETRY", warns, painted, painted))


def _sea(build: Builder, spaces: Spaces) -> _Sea:
    facts = build.group(node_group(GRID_FACTS), {"Geometry": spaces.mesh})
    corner = output(facts, "Corner")
    eye = build.vector("SUBTRACT", spaces.point_of_ocean(_camera(build)), corner)
    given = {"Object": build.given(FOAM_INPUT)}
    foam = output(build.add("GeometryNodeObjectInfo", given, transform_space="ORIGINAL"), "Geometry")
    of_foam = build.group(node_group(RING_FACTS), {"Foam": foam})
    is_fan = build.compare("GREATER_THAN", output(of_foam, "Columns"), 0)
    is_fan = build.logic("AND", output(of_foam, "Is There"), is_fan)
    return _Sea(facts, corner, eye, foam, of_foam, is_fan)


def _camera(build: Builder) -> Socket:
    """Position of the camera: the given one, the scene's, or the object's own."""
    active = output(build.add("GeometryNodeInputActiveCamera"), "Active Camera")
    given, scenes = (
        build.add("GeometryNodeObjectInfo", {"Object": item}, transform_space="RELATIVE")
        for item in (build.given("Camera"), active)
    )
    # there is no node for this, but a missing object has a scale of 0
    is_given = build.compare("GREATER_THAN", alone(build, "LENGTH", output(given, "Scale")), 0.0, "FLOAT")
    return build.switch("VECTOR", is_given, output(scenes, "Location"), output(given, "Location"))


def _texture_coordinates(build: Builder, sea: _Sea) -> Socket:
    """Continuation of the ocean's own, from those of its first vertex, the next one, and the one above."""
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


def _density(build: Builder) -> tuple[Socket, Socket]:
    """Largest number of vertices, and the factor of the cell size in the viewport."""
    whole = build.given("Vertex Budget")
    few = build.integer("MINIMUM", whole, build.given("Viewport Vertex Budget"))
    is_viewport = output(build.add("GeometryNodeIsViewport"), "Is Viewport")
    budget = build.switch("INT", is_viewport, whole, few)
    ratio = build.math("DIVIDE", whole, build.integer("MAXIMUM", budget, 1))
    return budget, build.math("MAXIMUM", build.math("SQRT", ratio, None), 1.0)


def _finest(build: Builder, coarser: Socket, eye: Socket) -> Socket:
    """Size of the cells near the camera. In a viewport with fewer vertices, none is finer than a fraction of
    the camera's height: no water is nearer, and cells ahead look larger."""
    wanted = build.math("MULTIPLY", build.given("Finest Spacing"), coarser)
    seen = build.math("DIVIDE", coordinates(build, eye)[2], _CELLS_OF_HEIGHT)
    is_coarser = build.compare("GREATER_THAN", coarser, 1.0, "FLOAT")
    return build.math("MAXIMUM", wanted, build.switch("FLOAT", is_coarser, 0.0, seen))


def _size(build: Builder, grid: bpy.types.Node, away: Socket, finest: Socket) -> Socket:
    """Size of the lattice's cells at a vertex, without steps.

    A level of the lattice begins at a distance of half of its m cells minus half a cell, so 2 distance/(m -
    1) is never less than the cell size, and continuous where levels meet.
    """
    x, y, _ = coordinates(build, alone(build, "ABSOLUTE", away))
    cells = build.integer("SUBTRACT", output(grid, "Half"), 1)
    size = build.math("DIVIDE", build.math("MULTIPLY", build.math("MAXIMUM", x, y), 2.0), cells)
    return build.math("MAXIMUM", size, finest)


def _summed(build: Builder, sea: _Sea, size: Socket, foam: Socket) -> dict[str, Socket]:
    """Values at a vertex: attributes and, in the ocean's axes, slopes with their lost variance, and
    strain."""
    inputs = {plug.name: build.given(plug.name) for plug in (OCEAN_INPUT, *OF_SUM)}
    inputs |= {"Fade": build.given("Fade"), "Size": size, "Foam": foam}
    inputs["Has Foam"] = output(sea.of_foam, "Is There")
    made = build.group(node_group(CAMERA_SUM), inputs)
    values = {name: output(made, socket) for name, socket in SUMMED.items()}
    return {**values, COAST_DEPTH: output(made, DEPTH_OVER_BED), HAS_BED: output(made, HAS_BED)}


def _of_rings(build: Builder, sea: _Sea, size: Socket) -> Socket:
    """Foam, breaking and age on rings around a camera."""
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    inputs = {
        "Foam": sea.foam,
        **{name: output(sea.of_foam, name) for name in ("Rings", "Samples")},
        "Place": build.vector("ADD", position, sea.corner),
        "Size": size,
    }
    return output(build.group(node_group(CAMERA_FOAM), inputs), "Value")


def _finished(
    build: Builder,
    grid: Socket,
    values: dict[str, Socket],
    spaces: Spaces,
    sea: _Sea,
    away: Socket,
    size: Socket,
) -> Socket:
    """The grid with its attributes and normals, moved to where the water is."""
    node = build.add("GeometryNodeCaptureAttribute", {"Geometry": grid}, domain="POINT")
    fade, drop, normal = (
        build.given("Fade"),
        *curved_normal(build, (values[SLOPES], values[OTHERS]), spaces, away),
    )
    lost = coordinates(build, values[SLOPES])[2]
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    place = build.vector("ADD", build.vector("ADD", position, sea.corner), drop)
    place = build.vector("ADD", place, values[DISPLACEMENT])
    shown = {
        **{name: ("FLOAT", values[name]) for name in (FOAM, BREAKING, FOAM_AGE, CUSP)},
        SLOPE_VARIANCE: ("FLOAT", build.switch("FLOAT", fade, 0.0, lost)),
        SHORTEST_WAVE: (
            "FLOAT", build.switch("FLOAT", fade, 0.0, build.math("MULTIPLY", size, SHORTEST_CELLS))
        ),
        **{name: ("FLOAT_VECTOR", values[name]) for name in (DISPLACEMENT, VELOCITY)},
    }  # fmt: skip
    moved = {
        name: ("FLOAT_VECTOR", value)
        for name, value in (("Normal", normal), ("Place", spaces.point_of_asker(place)), ("Rest", position))
    }
    moved[COAST_DEPTH] = "FLOAT", values[COAST_DEPTH]
    # all at once, so that shared inputs are computed once
    for name, (data_type, value) in {**shown, **moved}.items():
        node.capture_items.new(data_type.removeprefix("FLOAT_"), name)
        build.tree.links.new(value, node.inputs[name])
    grid = output(node, "Geometry")
    for name, (data_type, _) in shown.items():
        is_vector = data_type == "FLOAT_VECTOR"
        own = spaces.direction_of_asker(node.outputs[name]) if is_vector else node.outputs[name]
        grid = build.store(grid, name, own, data_type)
    deep = build.store(grid, COAST_DEPTH, node.outputs[COAST_DEPTH], "FLOAT")
    grid = build.switch("GEOMETRY", values[HAS_BED], grid, deep)
    inputs = {"Custom Normal": node.outputs["Normal"]}
    grid = build.change("GeometryNodeSetMeshNormal", grid, inputs, mode="FREE", domain="POINT")
    piled = _piled(build, grid, node)
    raised = spaces.direction_of_asker(build.vector("SUBTRACT", position, node.outputs["Rest"]))
    return build.change(
        "GeometryNodeSetPosition", piled, {"Position": build.vector("ADD", node.outputs["Place"], raised)}
    )


def _piled(build: Builder, grid: Socket, captured: bpy.types.Node) -> Socket:
    """The grid at rest, raised by fresh foam.

    Only where there is some, as lumps at every vertex would take as long as a patch of the sea.
    """
    inputs = {name: captured.outputs[attribute] for name, attribute in _OF_PILE.items()}
    inputs |= {
        "Height": build.given(PILE_INPUT),
        "Lump": build.math("MULTIPLY", build.given("Finest Spacing"), _LUMP_CELLS),
    }
    offset = output(build.group(node_group(FOAM_PILE), inputs), "Offset")
    breaks = build.compare("GREATER_THAN", captured.outputs[BREAKING], _LEAST_BREAKING, "FLOAT")
    is_high = build.compare("GREATER_THAN", build.given(PILE_INPUT), 0.0, "FLOAT")
    inputs = {"Selection": build.logic("AND", breaks, is_high), "Offset": offset}
    return build.change("GeometryNodeSetPosition", grid, inputs)


def _warnings(build: Builder, sea: _Sea, reach: Socket, reached: Socket) -> Socket:
    """Whether there is a warning: a small budget, a camera under water, foam of another frame."""
    whole = [whole_number(build, value, "ROUND") for value in (reached, reach)]
    short = joined_text(
        build,
        "The vertices of the budget reach", whole[0], "units instead of", whole[1],
        "units: raise Vertex Budget or Finest Spacing, or ask for less Reach",
    )  # fmt: skip
    below = (
        "The camera is below the mean sea level, in a trough or under water: the surface reaches as far as "
        "it is seen from 2 m above"
    )
    old = joined_text(
        build,
        "Foam around the camera is that of frame", output(sea.of_foam, "Frame"),
        "as the Ocean Tweak extension does not run here: the foam of the ocean's own mesh is "
        "shown, on coarser samples",
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


CAMERA_SURFACE = GroupKind("Ocean Camera Surface", 13, _build)
