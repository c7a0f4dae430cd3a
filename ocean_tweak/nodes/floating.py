# SPDX-License-Identifier: GPL-3.0-or-later
"""Float on Ocean: geometry nodes that let instances, or a geometry as a whole, ride an ocean's surface.

What rides feels the plane of least squares through the surface over its waterline, a disc; waves shorter than
the disc cancel out. The stencil of points that stands for it is that of `core.sea.waterline`.

A carrier may ride damped: where its hull is then depends on the past, which nodes do not see. Nor do they
see the waves over a bed, which has a mesh of its own. The extension works out where the hull is,
`core.sea.riding`, and gives it to the carrier for one frame; at any other the hull follows the surface.
"""

from __future__ import annotations

import math

import bpy

from ..core.sea.riding import LEAST_DAMPING, USUAL_DAMPING, USUAL_ROLL_DAMPING
from ..core.sea.waterline import POINTS
from .building import Builder, Input, Plug, Socket, output
from .fields import alone, combined, connect, coordinates, sample_index, whole_number
from .sample import OCEAN_INPUT, Spaces
from .surface import SURFACE
from .versioned import GroupKind, node_group

#: point attribute of a carrier: what takes it from its place to the surface, in its own space
TRANSFORM = "float_transform"

#: input that says how far the water has come
CURRENT = "Current"
_CURRENT_INPUT = Plug(
    CURRENT, "NodeSocketVector", None,
    "How far a current has carried the water, in the ocean's space: what drifts goes along",
)  # fmt: skip

RIDE_INPUTS = (
    OCEAN_INPUT,
    Plug(
        "Waterline", "NodeSocketFloat", 0.0,
        "Size of the floating object: shorter waves do not move it. 0 follows the surface at a point",
    ),
    Plug("Draft", "NodeSocketFloat", 0.0, "How deep it sits: from its lowest point up to the surface"),
    Plug("Keel", "NodeSocketFloat", 0.0, "How far below the origin its lowest point is"),
    Plug("Tilt", "NodeSocketFloat", 1.0, "How much it tilts with the surface: 0 stays upright"),
    Plug("Drift", "NodeSocketFloat", 0.0, "How much it moves with the water: 0 stays above its place"),
    Plug(
        "Keep Height", "NodeSocketBool", False,
        "Stay as high above the surface as its place is above calm water, whatever Draft and Keel are",
    ),
)  # fmt: skip
DAMPED_INPUTS = (
    Plug(
        "Damped", "NodeSocketBool", False,
        "Ride with inertia: heave, pitch and roll swing as damped oscillators. Otherwise it follows the "
        "surface at every moment",
    ),
    Plug(
        "Beam", "NodeSocketFloat", 0.0,
        "Of a damped ride: the smaller horizontal size, along y; 0 is as wide as long",
    ),
    Plug("Along Y", "NodeSocketBool", False, "Of a damped ride: its bow or stern is along its y axis, not x"),
    Plug("Heave Period", "NodeSocketFloat", 0.0, "Natural period in seconds; 0 is that of its size"),
    Plug("Pitch Period", "NodeSocketFloat", 0.0, "Natural period in seconds; 0 is that of its size"),
    Plug("Roll Period", "NodeSocketFloat", 0.0, "Natural period in seconds; 0 is that of its size"),
    Plug(
        "Surge Period", "NodeSocketFloat", 0.0,
        "Natural period in seconds with which it swings back and forth, as on a mooring; 0: none",
    ),
    Plug(
        "Sway Period", "NodeSocketFloat", 0.0,
        "Natural period in seconds with which it swings from side to side about its place; 0: none",
    ),
    Plug(
        "Damping", "NodeSocketFloat", USUAL_DAMPING,
        "Of all but roll: 1 does not swing at all, 0.3 is usual for ships",
    ),
    Plug(
        "Roll Damping", "NodeSocketFloat", USUAL_ROLL_DAMPING,
        "Of roll: 1 does not swing at all, 0.1 is usual for ships",
    ),
)  # fmt: skip
#: where a hull is that rides damped or over a bed, and at which frame of the scene
SOLVED_INPUTS = (
    Plug(
        "Solved", "NodeSocketVector", None,
        "Height of a damped hull, or of one over a bed, and its slopes along x and y, in the ocean's space",
        hidden=True,
    ),
    Plug(
        "Solved Way", "NodeSocketVector", None, "How far it is off its place, in the ocean's space",
        hidden=True,
    ),
    Plug("Solved Frame", "NodeSocketFloat", -1e6, "The scene's frame at which it is so", hidden=True),
)  # fmt: skip
_OF_RIDE = (
    Plug("Is Solved", "NodeSocketBool", False, "Height and slopes are those given"),
    Plug("Solved", "NodeSocketVector", None, "Height, and slopes along x and y, in the ocean's space"),
    Plug("Solved Way", "NodeSocketVector", None, "How far it is off its place, in the ocean's space"),
)
AS_ONE = Plug(
    "As One", "NodeSocketBool", False,
    "Move all of the geometry as one around its origin, not each instance by itself",
)  # fmt: skip


#: of an input: subtype, least and greatest value
_RANGES = {
    "Waterline": ("DISTANCE", 0.0, 1e6),
    "Draft": ("DISTANCE", -1e6, 1e6),
    "Keel": ("DISTANCE", -1e6, 1e6),
    "Tilt": ("FACTOR", 0.0, 1.0),
    "Drift": ("FACTOR", 0.0, 1.0),
    "Beam": ("DISTANCE", 0.0, 1e6),
    "Heave Period": ("TIME_ABSOLUTE", 0.0, 1e3),
    "Pitch Period": ("TIME_ABSOLUTE", 0.0, 1e3),
    "Roll Period": ("TIME_ABSOLUTE", 0.0, 1e3),
    "Surge Period": ("TIME_ABSOLUTE", 0.0, 1e3),
    "Sway Period": ("TIME_ABSOLUTE", 0.0, 1e3),
    "Damping": ("FACTOR", LEAST_DAMPING, 1.0),
    "Roll Damping": ("FACTOR", LEAST_DAMPING, 1.0),
}
#: frames by which a moment is another one
_SAME_FRAME = 1e-3


def _build_stencil(tree: bpy.types.NodeTree) -> None:
    build = Builder(
        tree,
        (Plug("Number", "NodeSocketInt", 0, "Of the point, from 0 in the middle"),),
        (Plug("Offset", "NodeSocketVector", None, "On a disc of radius 1"),),
    )
    number = build.given("Number")
    # ring m holds the numbers from 1 + 3m(m - 1) on; the middle is a ring of radius 0 and would be its own
    inner = build.math("DIVIDE", build.math("SUBTRACT", number, 1), 3.0)
    root = alone(build, "SQRT", build.math("ADD", inner, 0.25), "ShaderNodeMath")
    ring = whole_number(build, build.math("ADD", root, 0.5), "FLOOR")
    first = build.integer("MULTIPLY", ring, build.integer("SUBTRACT", ring, 1))
    place = build.math("SUBTRACT", number, build.math("ADD", build.math("MULTIPLY", first, 3), 1))
    angle = build.math("MULTIPLY", build.math("DIVIDE", place, ring), math.pi / 3)
    square = build.math("ADD", build.math("MULTIPLY", build.math("MULTIPLY", ring, ring), 3), 1)
    radius = alone(build, "SQRT", build.math("DIVIDE", square, POINTS), "ShaderNodeMath")
    cosine, sine = (alone(build, name, angle, "ShaderNodeMath") for name in ("COSINE", "SINE"))
    direction = combined(build, cosine, sine)
    outside = build.compare("GREATER_THAN", number, 0)
    offset = build.switch("VECTOR", outside, (0.0, 0.0, 0.0), build.scaled(direction, radius))
    build.finish_with({"Offset": offset})


def _build_ride(tree: bpy.types.NodeTree) -> None:
    build = Builder(
        tree,
        (
            Plug("Places", "NodeSocketGeometry", None, "Points"),
            *RIDE_INPUTS,
            _CURRENT_INPUT,
            *_OF_RIDE,
        ),
        (
            Plug(
                "Stencil", "NodeSocketGeometry", None, "The points around each place, one place after another"
            ),
            Plug("Points", "NodeSocketInt", None, "How many each place has"),
            Plug("Position", "NodeSocketVector", None, "On the stencil: where its place is now"),
            Plug("Rotation", "NodeSocketRotation", None, "On the stencil: how its place tilts"),
        ),
    )
    spaces = Spaces(build, build.given("Ocean"))
    size = spaces.size_of_ocean((1.0, 0.0, 0.0))
    radius = build.math("MULTIPLY", build.math("MULTIPLY", build.given("Waterline"), 0.5), size)
    is_disc = build.compare("GREATER_THAN", radius, 0.0, "FLOAT")
    discs = _Discs(build, build.switch("INT", is_disc, 1, POINTS), radius)
    stencil, point, along_x, along_y, above = _on_the_surface(build, spaces, discs)
    # the slopes of the plane: sums of offset · height over sums of offset²
    moment = discs.mean(build.scaled(discs.offset, coordinates(build, point)[2]))
    square = discs.mean(build.vector("MULTIPLY", discs.offset, discs.offset))
    slope_x, slope_y, _ = coordinates(build, build.vector("DIVIDE", moment, square))
    is_solved = build.given("Is Solved")
    solved, solved_x, solved_y = coordinates(build, build.given("Solved"))
    tangents = (
        build.switch(
            "VECTOR", is_solved,
            build.switch("VECTOR", is_disc, along_x, combined(build, 1.0, 0.0, slope_x)),
            combined(build, 1.0, 0.0, solved_x),
        ),
        build.switch(
            "VECTOR", is_solved,
            build.switch("VECTOR", is_disc, along_y, combined(build, 0.0, 1.0, slope_y)),
            combined(build, 0.0, 1.0, solved_y),
        ),
    )  # fmt: skip
    felt = discs.mean(point)
    felt_x, felt_y, _ = coordinates(build, felt)
    there = build.vector("ADD", combined(build, felt_x, felt_y, solved), build.given("Solved Way"))
    where = build.switch("VECTOR", is_solved, felt, there)
    origin = build.math("SUBTRACT", build.given("Keel"), build.given("Draft"))
    settled = build.math("MULTIPLY", origin, size)
    height = combined(build, 0.0, 0.0, build.switch("FLOAT", build.given("Keep Height"), settled, above))
    build.finish_with(
        {
            "Stencil": stencil,
            "Points": discs.points,
            "Position": spaces.point_of_asker(build.vector("ADD", where, height)),
            "Rotation": _tilt(build, spaces.normal_of_asker(), spaces.normal_of_asker(*tangents)),
        }
    )


class _Discs:
    """Fields on the stencil points of all places.

    points : of each place
    place : number of a point's place
    offset : from its place, in the ocean's space
    """

    def __init__(self, build: Builder, points: Socket, radius: Socket) -> None:
        self._build = build
        self.points = points
        index = output(build.add("GeometryNodeInputIndex"), "Index")
        self.place = build.integer("DIVIDE_FLOOR", index, points)
        number = build.integer("FLOORED_MODULO", index, points)
        shape = build.group(node_group(STENCIL), {"Number": number})
        self.offset = build.scaled(output(shape, "Offset"), radius)

    def mean(self, value: Socket) -> Socket:
        """Of a vector over the points of a place."""
        build = self._build
        total = build.add("GeometryNodeAccumulateField", data_type="FLOAT_VECTOR", domain="POINT")
        for name, given in (("Value", value), ("Group ID", self.place)):
            connect(build, next(each for each in total.inputs if each.name == name and each.enabled), given)
        return build.scaled(output(total, "Total"), build.math("DIVIDE", 1.0, self.points))


def _on_the_surface(build: Builder, spaces: Spaces, discs: _Discs) -> tuple[Socket, ...]:
    """The stencil's points, and on them: where the surface is, its two tangents, the height of its place."""
    places = build.given("Places")
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    place = sample_index(build, places, position, discs.place, "FLOAT_VECTOR")
    gone = build.vector("MULTIPLY", build.given(CURRENT), (1.0, 1.0, 0.0))
    inside = build.vector("ADD", spaces.point_of_ocean(place), build.scaled(gone, build.given("Drift")))
    around = build.vector("ADD", inside, discs.offset)

    def surface(where: Socket, at_rest: bool) -> bpy.types.Node:
        inputs = {"Geometry": spaces.mesh, "Position": where, "At Rest": at_rest}
        return build.group(node_group(SURFACE), inputs)

    carried = discs.mean(output(surface(around, True), "Displacement"))
    level = build.vector("MULTIPLY", build.scaled(carried, build.given("Drift")), (1.0, 1.0, 0.0))
    drifts = build.compare("NOT_EQUAL", build.given("Drift"), 0.0, "FLOAT")
    drifted = build.switch("VECTOR", drifts, around, build.vector("ADD", around, level))
    found = surface(drifted, False)
    count = build.add("GeometryNodeAttributeDomainSize", {"Geometry": places}, component="POINTCLOUD")
    all_points = build.integer("MULTIPLY", output(count, "Point Count"), discs.points)
    # kept on the points: fields are evaluated anew wherever they are used
    names = ("Point", "Along X", "Along Y")
    kept = build.add("GeometryNodeCaptureAttribute", domain="POINT")
    for name in names:
        kept.capture_items.new("VECTOR", name)
        connect(build, kept.inputs[name], output(found, name))
    connect(build, kept.inputs[0], build.add("GeometryNodePoints", {"Count": all_points}).outputs[0])
    return kept.outputs[0], *(kept.outputs[name] for name in names), coordinates(build, inside)[2]


def _tilt(build: Builder, up: Socket, normal: Socket) -> Socket:
    """The shortest rotation from one direction to another, or a part of it: a heading stays."""
    axis = build.vector("CROSS_PRODUCT", up, normal)
    sine = alone(build, "LENGTH", axis)
    angle = build.math("ARCTAN2", sine, build.vector("DOT_PRODUCT", up, normal))
    part = build.math("MULTIPLY", angle, build.given("Tilt"))
    turned = build.add("FunctionNodeAxisAngleToRotation", {"Axis": axis, "Angle": part})
    return output(turned, "Rotation")


def _set_ranges(tree: bpy.types.NodeTree) -> None:
    for item in tree.interface.items_tree:
        if item.name in _RANGES:
            item.subtype, item.min_value, item.max_value = _RANGES[item.name]


def _ride(build: Builder, places: Socket, solved: dict[str, Input] | None = None) -> bpy.types.Node:
    inputs: dict[str, Input] = {plug.name: build.given(plug.name) for plug in (*RIDE_INPUTS, _CURRENT_INPUT)}
    return build.group(node_group(RIDE), {"Places": places, **inputs, **(solved or {})})


def _of_place(build: Builder, ride: bpy.types.Node, place: Input) -> tuple[Socket, Socket]:
    """Position and rotation of a place by its number."""
    stencil = output(ride, "Stencil")
    first = build.integer("MULTIPLY", place, output(ride, "Points"))
    return (
        sample_index(build, stencil, output(ride, "Position"), first, "FLOAT_VECTOR"),
        sample_index(build, stencil, output(ride, "Rotation"), first, "QUATERNION"),
    )


def _build_float(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, (*RIDE_INPUTS, _CURRENT_INPUT, AS_ONE))
    _set_ranges(tree)
    geometry = build.given("Geometry")
    count = build.add("GeometryNodeAttributeDomainSize", {"Geometry": geometry}, component="INSTANCES")
    none = build.compare("EQUAL", output(count, "Instance Count"), 0)
    as_one = build.logic("OR", build.given("As One"), none)
    points = build.change("GeometryNodeInstancesToPoints", geometry)
    ride = _ride(build, build.switch("GEOMETRY", as_one, points, _origin(build)))
    build.finish(
        build.switch("GEOMETRY", as_one, _each_moved(build, ride, geometry), _moved(build, ride, geometry))
    )


def _origin(build: Builder) -> Socket:
    """A single point."""
    return build.add("GeometryNodePoints", {"Count": 1}).outputs[0]


def _moved(build: Builder, ride: bpy.types.Node, geometry: Socket) -> Socket:
    """The geometry moved as one thing."""
    position, rotation = _of_place(build, ride, 0)
    inputs = {"Translation": position, "Rotation": rotation}
    return build.change("GeometryNodeTransform", geometry, inputs)


def _each_moved(build: Builder, ride: bpy.types.Node, geometry: Socket) -> Socket:
    """Each instance moved and turned about its own origin."""
    index = output(build.add("GeometryNodeInputIndex"), "Index")
    position, rotation = _of_place(build, ride, index)
    before = output(build.add("GeometryNodeInstanceTransform"), "Transform")
    place = output(build.add("FunctionNodeSeparateTransform", {"Transform": before}), "Translation")
    turned = _product(
        build,
        _transform(build, rotation=rotation),
        _product(build, _transform(build, translation=build.scaled(place, -1.0)), before),
    )
    now = _product(build, _transform(build, translation=position), turned)
    return build.change("GeometryNodeSetInstanceTransform", geometry, {"Transform": now})


def _transform(build: Builder, **parts: Socket) -> Socket:
    inputs = {name.title(): value for name, value in parts.items()}
    return output(build.add("FunctionNodeCombineTransform", inputs), "Transform")


def _product(build: Builder, first: Socket, second: Socket) -> Socket:
    """What applies the second transform and then the first."""
    node = build.add("FunctionNodeMatrixMultiply")
    for socket, value in zip(node.inputs, (first, second), strict=True):
        connect(build, socket, value)
    return output(node, "Matrix")


def _build_carrier(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, (*RIDE_INPUTS, _CURRENT_INPUT, *DAMPED_INPUTS, *SOLVED_INPUTS))
    _set_ranges(tree)
    frame = output(build.add("GeometryNodeInputSceneTime"), "Frame")
    away = alone(
        build, "ABSOLUTE", build.math("SUBTRACT", frame, build.given("Solved Frame")), "ShaderNodeMath"
    )
    is_solved = build.compare("LESS_THAN", away, _SAME_FRAME, "FLOAT")
    solved = {name: build.given(name) for name in ("Solved", "Solved Way")}
    ride = _ride(build, _origin(build), {"Is Solved": is_solved, **solved})
    position, rotation = _of_place(build, ride, 0)
    moved = _moved(build, ride, build.given("Geometry"))
    there = _transform(build, translation=position, rotation=rotation)
    build.finish(build.store(moved, TRANSFORM, there, "FLOAT4X4"))


STENCIL = GroupKind("Ocean Tweak Stencil", 1, _build_stencil)
RIDE = GroupKind("Ocean Tweak Ride", 6, _build_ride)
FLOAT = GroupKind("Float on Ocean", 6, _build_float)
CARRIER = GroupKind("Float on Ocean Carrier", 7, _build_carrier)
