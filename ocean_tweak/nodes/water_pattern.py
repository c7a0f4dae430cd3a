# SPDX-License-Identifier: GPL-3.0-or-later
"""Placement and sampling of the fine patterns on the water.

Patterns are functions of the rest position, so they move with the waves. A tile's axes in periods of the
domain are integers (a, b) and (-b, a), so the pattern has no seam where the domain repeats, for any size and
direction.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import bpy

from .building import Panel, Plug, Socket
from .detail_image import billow_image, gust_image, lace_image, ripple_image
from .names import TEXTURE_COORDINATES
from .shading import Shading
from .surface_detail import BILLOW_CELLS, LACE_CELLS
from .versioned import GroupKind, node_group

#: custom properties of an ocean, read by the material; lengths in metres
DOMAIN = "ocean_tweak_domain_size"
SPACING = "ocean_tweak_sample_spacing"
SLOPES = "ocean_tweak_slope_variance"
WIND = "ocean_tweak_wind_direction"
WIND_SPEED = "ocean_tweak_wind_speed"
DEPTH = "ocean_tweak_water_depth"
METRES = "ocean_tweak_metres_per_unit"

#: defaults for a mesh that is not an ocean, m
_OTHER_DOMAIN = 100.0
_OTHER_SPACING = 0.5
#: cosine of the angle between normal and view, below which a footprint grows no more
_LEAST_FACING = 0.02


def _number(name: str, description: str) -> Plug:
    return Plug(name, "NodeSocketFloat", 1.0, description)


#: inputs of what is laid over the water
_LIES = (
    Plug("Rest", "NodeSocketVector", (0.0, 0.0, 0.0), "Point of the water at rest, in periods of the domain"),
    _number("Domain", "Length of a period, m"),
    _number("Angle", "Of the tile's x axis, rad counter-clockwise from x"),
)


class Place(NamedTuple):
    """Properties of a shaded point; lengths in m.

    rest : point of the water at rest, in periods of the domain
    world : point of the world
    domain, spacing : of the domain and of its samples
    wind : rad, of the wind, counter-clockwise from x
    metres : in a Blender unit
    distance : from the camera
    footprint : what a pixel of the camera covers here, as a length
    """

    rest: Socket
    world: Socket
    domain: Socket
    spacing: Socket
    wind: Socket
    metres: Socket
    distance: Socket
    footprint: Socket


class Tile(NamedTuple):
    """A pattern sampled at a point.

    colour : of its image
    along : the tile's x axis in the ocean's, unit length
    """

    colour: Socket
    along: Socket


def place(shade: Shading, given: dict[str, Socket]) -> Place:
    """The shaded point's."""
    domain = shade.value(DOMAIN, "OBJECT")
    is_ocean = shade.math("GREATER_THAN", domain, 0.0)
    own = shade.value(METRES, "OBJECT")
    metres = shade.mix(shade.math("GREATER_THAN", own, 0.0), 1.0, own)
    position = shade.node("ShaderNodeTexCoord").outputs["Object"]
    otherwise = shade.scale(position, shade.math("DIVIDE", metres, _OTHER_DOMAIN))
    rest = shade.mix_vectors(is_ocean, otherwise, shade.attribute(TEXTURE_COORDINATES).outputs["Vector"])
    distance = shade.math("MULTIPLY", shade.node("ShaderNodeCameraData").outputs["View Distance"], metres)
    geometry = shade.node("ShaderNodeNewGeometry").outputs
    facing = shade.number("DOT_PRODUCT", geometry["Normal"], geometry["Incoming"])
    facing = shade.math("MAXIMUM", shade.math("ABSOLUTE", facing), _LEAST_FACING)
    across = shade.math("MULTIPLY", distance, given["Pixel Angle"])
    return Place(
        # tiles repeat with the period, so the position within it suffices, and is precise at any distance
        rest=shade.vector("FRACTION", rest),
        world=shade.scale(geometry["Position"], metres),
        domain=shade.mix(is_ocean, _OTHER_DOMAIN, domain),
        spacing=shade.mix(is_ocean, _OTHER_SPACING, shade.value(SPACING, "OBJECT")),
        wind=shade.value(WIND, "OBJECT"),
        metres=metres,
        distance=distance,
        footprint=shade.math("DIVIDE", across, shade.math("SQRT", facing)),
    )


def ripples(shade: Shading, at: Place, size: Socket, turn: float, travel: Socket, strength: Socket) -> Socket:
    """Slopes of a tile of ripples along the ocean's x and y, as a vector.

    size : of the tile along the wind, m, as near as whole numbers come
    turn : rad, away from the wind
    travel : m that the pattern has gone along its x axis
    strength : root mean square of the slopes
    """
    inputs = {**_lies(shade, at, turn), "Size": size, "Travel": travel, "Strength": strength}
    return shade.node("ShaderNodeGroup", inputs, node_tree=node_group(RIPPLES)).outputs[0]


def _build_ripples(tree: bpy.types.NodeTree) -> None:
    shade = Shading(tree)
    inputs = (*_LIES, _number("Size", "Of the tile, m"), _number("Travel", "m"), _number("Strength", "Slope"))
    outputs = (Plug("Slope", "NodeSocketVector", None, "Along the ocean's x and y"),)
    given = shade.interface(outputs, (Panel("Ripples", inputs),)).outputs
    laid = _tile(shade, given, ripple_image(), given["Size"], given["Travel"])
    along, across, _ = shade.separate(laid.colour)
    shade.finish({"Slope": shade.scale(_turned(shade, laid.along, along, across), given["Strength"])})


class Lace(NamedTuple):
    """The lace of foam as it lies at a point.

    height : normally distributed, with mean 0 and variance 1
    slope : its gradient along the ocean's x and y, over the size of a cell
    """

    height: Socket
    slope: Socket


def lace(shade: Shading, at: Place, cell: Socket | float, turn: float, stretch: int = 1) -> Lace:
    """The lace with cells of this length along the wind, in m; they are `stretch` times as narrow across."""
    inputs = {**_lies(shade, at, turn), "Cell": cell, "Stretch": float(stretch)}
    made = shade.node("ShaderNodeGroup", inputs, node_tree=node_group(LACE)).outputs
    return Lace(made["Height"], made["Slope"])


def _build_lace(tree: bpy.types.NodeTree) -> None:
    shade = Shading(tree)
    inputs = (
        *_LIES,
        _number("Cell", "Length, m"),
        _number("Stretch", "How much narrower across; a whole number"),
    )
    outputs = (
        Plug("Height", "NodeSocketFloat", None, "Normally distributed"),
        Plug("Slope", "NodeSocketVector", None, "Along the ocean's x and y, over the size of a cell"),
    )
    given = shade.interface(outputs, (Panel("Lace", inputs),)).outputs
    size, stretch = shade.math("MULTIPLY", given["Cell"], float(LACE_CELLS)), given["Stretch"]
    laid = _tile(shade, given, lace_image(), size, 0.0, stretch)
    height, along, across = shade.separate(laid.colour)
    slope = _turned(shade, laid.along, along, shade.math("MULTIPLY", across, stretch))
    # the narrow side of a cell is what a pile of foam is high by
    narrow = shade.math("DIVIDE", 1.0 / LACE_CELLS, stretch)
    shade.finish({"Height": height, "Slope": shade.scale(slope, narrow)})


def billow(shade: Shading, at: Place, cell: Socket, turn: float) -> Lace:
    """The billows of foam, whose largest are as long as a cell, in m; slope is theirs as they are."""
    inputs = {**_lies(shade, at, turn), "Cell": cell}
    made = shade.node("ShaderNodeGroup", inputs, node_tree=node_group(BILLOWS)).outputs
    return Lace(made["Height"], made["Slope"])


def _build_billows(tree: bpy.types.NodeTree) -> None:
    shade = Shading(tree)
    inputs = (*_LIES, _number("Cell", "Length of the largest, m"))
    outputs = (
        Plug("Height", "NodeSocketFloat", None, "Normally distributed"),
        Plug("Slope", "NodeSocketVector", None, "Along the ocean's x and y"),
    )
    given = shade.interface(outputs, (Panel("Billows", inputs),)).outputs
    size = shade.math("MULTIPLY", given["Cell"], float(BILLOW_CELLS))
    laid = _tile(shade, given, billow_image(), size, 0.0)
    height, along, across = shade.separate(laid.colour)
    shade.finish({"Height": height, "Slope": _turned(shade, laid.along, along, across)})


def gust(shade: Shading, at: Place, size: float) -> Socket:
    """How much of a gust there is, 0…1; the pattern's bumps are an eighth to a third of `size` m.

    Gusts are the air's: they lie on the world, and do not repeat with the domain.
    """
    return shade.separate(_read(shade, gust_image(), shade.scale(at.world, 1.0 / size)))[0]


def _lies(shade: Shading, at: Place, turn: float) -> dict[str, Socket]:
    """Where a tile lies that is turned away from the wind by an angle."""
    return {"Rest": at.rest, "Domain": at.domain, "Angle": shade.math("ADD", at.wind, turn)}


def _tile(
    shade: Shading,
    given: Mapping[str, Socket],
    image: bpy.types.Image,
    size: Socket,
    travel: Socket | float,
    stretch: Socket | float = 1.0,
) -> Tile:
    """An image laid over the water; `stretch` is a whole number, by which it is narrower across."""
    periods = shade.math("MAXIMUM", shade.math("DIVIDE", given["Domain"], size), 1.0)
    a, b = (
        shade.math("ROUND", shade.math("MULTIPLY", periods, shade.math(name, given["Angle"])))
        for name in ("COSINE", "SINE")
    )
    axis, across = shade.combine(a, b), shade.combine(shade.math("MULTIPLY", b, -1.0), a)
    u, v = (shade.number("DOT_PRODUCT", given["Rest"], each) for each in (axis, across))
    u = shade.math("SUBTRACT", u, shade.math("DIVIDE", travel, size))
    point = shade.combine(u, shade.math("MULTIPLY", v, stretch))
    return Tile(_read(shade, image, point), shade.vector("NORMALIZE", axis))


def _read(shade: Shading, image: bpy.types.Image, point: Socket) -> Socket:
    settings = {"image": image, "interpolation": "Cubic", "extension": "REPEAT"}
    return shade.node("ShaderNodeTexImage", {"Vector": point}, **settings).outputs[0]


def _turned(shade: Shading, axis: Socket, along: Socket, across: Socket) -> Socket:
    """A vector along the ocean's x and y from its parts along an axis and across."""
    x, y, _ = shade.separate(axis)
    side = shade.combine(shade.math("MULTIPLY", y, -1.0), x)
    return shade.vector("ADD", shade.scale(axis, along), shade.scale(side, across))


# a tree of nodes is the slower to build the larger it is: what is laid several times is a group
RIPPLES = GroupKind("Ocean Tweak Ripples", 1, _build_ripples, "ShaderNodeTree")
LACE = GroupKind("Ocean Tweak Lace", 1, _build_lace, "ShaderNodeTree")
BILLOWS = GroupKind("Ocean Tweak Billows", 1, _build_billows, "ShaderNodeTree")
