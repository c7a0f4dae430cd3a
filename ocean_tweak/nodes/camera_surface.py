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

from .building import Builder, Plug, Socket, output
from .camera_foam import CAMERA_FAN, CAMERA_FOAM, RING_FACTS
from .camera_grid import CAMERA_GRID
from .camera_sum import CAMERA_SUM, OF_SUM, SUMMED
from .fields import alone, coordinates, named_attribute, sample_index, whole_number
from .foam_pile import FOAM_PILE
from .frame_warnings import joined_text
from .globe import EARTH_RADIUS, curved_normal, reach_of
from .names import (
    BREAKING,
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
from .sample import OCEAN_INPUT, Spaces
from .surface import GRID_FACTS
from .versioned import GroupKind, node_group

#: cells of the lattice in the shortest wave that is left
SHORTEST_CELLS = 4.0
#: power of how much larger cells are in a viewport that averages follow: what it shows differs least from
#: what a render does
_FOLLOWED = 0.25
#: smallest cells in a viewport, in the height of the camera
_CELLS_OF_HEIGHT = 24.0
#: of the smallest cells in a lump of fresh foam
_LUMP_CELLS = 80.0
#: breaking from which on foam lies on the water: less is the mean of crests too far away to be seen
_LEAST_BREAKING = 0.02
#: inputs of the pile of foam → attributes of the surface
_OF_PILE = {"Displacement": DISPLACEMENT, "Velocity": VELOCITY, "Breaking": BREAKING}
#: of foam on rings around a camera
FOAM_INPUT = "Foam"
#: of fresh foam on it
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
    """The ocean that is shown, in its own space.

    facts : of its mesh
    corner : its first vertex at rest
    eye : the camera, from the corner
    foam : points around the camera
    of_foam : what is known of them
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
    # averages do not follow all of what cells are larger: the viewport rather shows waves of few cells than
    # none
    size = build.math(
        "DIVIDE", _size(build, grid, away, finest), build.math("POWER", coarser, 1.0 - _FOLLOWED)
    )
    size = build.switch("FLOAT", sea.is_fan, size, output(fan, "Size"))
    foam = build.switch("VECTOR", sea.is_fan, _of_rings(build, sea, size), output(fan, "Value"))
    shown = _finished(build, laid, _summed(build, sea, size, foam), spaces, sea, away, size)
    painted = build.change("GeometryNodeSetMaterial", shown, {"Material": build.given("Material")})
    reached = build.switch("FLOAT", sea.is_fan, output(grid, "Reached"), reach)
    warns = _warnings(build, sea, reach, reached)
    # nobody asks a group for its warnings unless something hangs on them
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
    """Where the camera is: the given one, the scene's, or the object's own place."""
    active = output(build.add("GeometryNodeInputActiveCamera"), "Active Camera")
    given, scenes = (
        build.add("GeometryNodeObjectInfo", {"Object": item}, transform_space="RELATIVE")
        for item in (build.given("Camera"), active)
    )
    # there is no node for it, but an object that is not there has no scale
    is_given = build.compare("GREATER_THAN", alone(build, "LENGTH", output(given, "Scale")), 0.0, "FLOAT")
    return build.switch("VECTOR", is_given, output(scenes, "Location"), output(given, "Location"))


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


def _density(build: Builder) -> tuple[Socket, Socket]:
    """Vertices of the grid, at most, and how much larger cells are in the viewport."""
    whole = build.given("Vertex Budget")
    few = build.integer("MINIMUM", whole, build.given("Viewport Vertex Budget"))
    is_viewport = output(build.add("GeometryNodeIsViewport"), "Is Viewport")
    budget = build.switch("INT", is_viewport, whole, few)
    ratio = build.math("DIVIDE", whole, build.integer("MAXIMUM", budget, 1))
    return budget, build.math("MAXIMUM", build.math("SQRT", ratio, None), 1.0)


def _finest(build: Builder, coarser: Socket, eye: Socket) -> Socket:
    """Size of the cells near the camera. In a viewport of fewer vertices, none is finer than a share of the
    camera's height: no water is nearer, and cells ahead look larger."""
    wanted = build.math("MULTIPLY", build.given("Finest Spacing"), coarser)
    seen = build.math("DIVIDE", coordinates(build, eye)[2], _CELLS_OF_HEIGHT)
    is_coarser = build.compare("GREATER_THAN", coarser, 1.0, "FLOAT")
    return build.math("MAXIMUM", wanted, build.switch("FLOAT", is_coarser, 0.0, seen))


def _size(build: Builder, grid: bpy.types.Node, away: Socket, finest: Socket) -> Socket:
    """Of the lattice's cells where a vertex is, without steps.

    A level of the lattice begins where the distance is half of its m cells, less half a cell: so
    2 distance/(m - 1) is never less than the cells' size, and has no step where the levels meet.
    """
    x, y, _ = coordinates(build, alone(build, "ABSOLUTE", away))
    cells = build.integer("SUBTRACT", output(grid, "Half"), 1)
    size = build.math("DIVIDE", build.math("MULTIPLY", build.math("MAXIMUM", x, y), 2.0), cells)
    return build.math("MAXIMUM", size, finest)


def _summed(build: Builder, sea: _Sea, size: Socket, foam: Socket) -> dict[str, Socket]:
    """What is shown at a vertex: attributes, and in the ocean's axes slopes with the variance that they lack,
    and strain."""
    inputs = {plug.name: build.given(plug.name) for plug in (OCEAN_INPUT, *OF_SUM)}
    inputs |= {"Fade": build.given("Fade"), "Size": size, "Foam": foam}
    inputs["Has Foam"] = output(sea.of_foam, "Is There")
    made = build.group(node_group(CAMERA_SUM), inputs)
    return {name: output(made, socket) for name, socket in SUMMED.items()}


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
    # all at once: what several of them are made of is computed once
    for name, (data_type, value) in {**shown, **moved}.items():
        node.capture_items.new(data_type.removeprefix("FLOAT_"), name)
        build.tree.links.new(value, node.inputs[name])
    grid = output(node, "Geometry")
    for name, (data_type, _) in shown.items():
        is_vector = data_type == "FLOAT_VECTOR"
        own = spaces.direction_of_asker(node.outputs[name]) if is_vector else node.outputs[name]
        grid = build.store(grid, name, own, data_type)
    inputs = {"Custom Normal": node.outputs["Normal"]}
    grid = build.change("GeometryNodeSetMeshNormal", grid, inputs, mode="FREE", domain="POINT")
    piled = _piled(build, grid, node)
    raised = spaces.direction_of_asker(build.vector("SUBTRACT", position, node.outputs["Rest"]))
    return build.change(
        "GeometryNodeSetPosition", piled, {"Position": build.vector("ADD", node.outputs["Place"], raised)}
    )


def _piled(build: Builder, grid: Socket, captured: bpy.types.Node) -> Socket:
    """The grid at rest with what fresh foam adds to it.

    Only where there is some: its lumps would take as long at every vertex as a patch of the sea.
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
    """Whether something is told: a short budget, a camera under water, foam of another frame."""
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


CAMERA_SURFACE = GroupKind("Ocean Camera Surface", 12, _build)
