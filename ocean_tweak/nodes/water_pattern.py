# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the fine patterns lie on the water, and what they say there.

Patterns are laid over the water at rest, so they ride with the waves. A tile's axes in periods of the
domain are whole numbers (a, b) and (-b, a): whatever its size and direction, the pattern has no seam where
the domain repeats.
"""

from __future__ import annotations

from typing import NamedTuple

import bpy

from .building import Socket
from .detail_image import detail_image, gust_image
from .names import TEXTURE_COORDINATES
from .shading import Shading

#: custom properties of an ocean, read by the material; lengths in metres
DOMAIN = "ocean_tweak_domain_size"
SPACING = "ocean_tweak_sample_spacing"
SLOPES = "ocean_tweak_slope_variance"
WIND = "ocean_tweak_wind_direction"
DEPTH = "ocean_tweak_water_depth"
METRES = "ocean_tweak_metres_per_unit"

#: what is taken for a mesh that is no ocean, m
_OTHER_DOMAIN = 100.0
_OTHER_SPACING = 0.5


class Place(NamedTuple):
    """What a shaded point knows of its ocean; lengths in m.

    rest : point of the water at rest, in periods of the domain
    domain, spacing : of the domain and of its samples
    wind : rad, of the wind, counter-clockwise from x
    metres : in a Blender unit
    distance : from the camera
    """

    rest: Socket
    domain: Socket
    spacing: Socket
    wind: Socket
    metres: Socket
    distance: Socket


class Tile(NamedTuple):
    """A pattern as it lies at a point.

    red_green : of the detail image
    lace : blue
    along : the tile's x axis in the ocean's, unit length
    """

    red_green: Socket
    lace: Socket
    along: Socket


def place(shade: Shading) -> Place:
    """The shaded point's."""
    domain = shade.value(DOMAIN, "OBJECT")
    is_ocean = shade.math("GREATER_THAN", domain, 0.0)
    own = shade.value(METRES, "OBJECT")
    metres = shade.mix(shade.math("GREATER_THAN", own, 0.0), 1.0, own)
    position = shade.node("ShaderNodeTexCoord").outputs["Object"]
    otherwise = shade.scale(position, shade.math("DIVIDE", metres, _OTHER_DOMAIN))
    distance = shade.node("ShaderNodeCameraData").outputs["View Distance"]
    return Place(
        rest=shade.mix_vectors(is_ocean, otherwise, shade.attribute(TEXTURE_COORDINATES).outputs["Vector"]),
        domain=shade.mix(is_ocean, _OTHER_DOMAIN, domain),
        spacing=shade.mix(is_ocean, _OTHER_SPACING, shade.value(SPACING, "OBJECT")),
        wind=shade.value(WIND, "OBJECT"),
        metres=metres,
        distance=shade.math("MULTIPLY", distance, metres),
    )


def tile(
    shade: Shading,
    at: Place,
    size: Socket | float,
    turn: float,
    travel: Socket | float = 0.0,
    stretch: float = 1.0,
) -> Tile:
    """The detail image laid over the water.

    size : of the tile along the wind, m, as near as whole numbers come
    turn : rad, away from the wind
    travel : m that the pattern has gone along its x axis
    stretch : whole number, by which the tile is narrower across
    """
    axis, (u, v) = _laid(shade, at, size, turn)
    u = shade.math("SUBTRACT", u, shade.math("DIVIDE", travel, size))
    colour = _read(shade, detail_image(), u, shade.math("MULTIPLY", v, stretch))
    return Tile(colour, shade.separate(colour)[2], shade.vector("NORMALIZE", axis))


def gust(shade: Shading, at: Place, size: float) -> Socket:
    """How much of a gust there is, 0…1; the pattern's bumps are an eighth to a third of `size` m."""
    _, (u, v) = _laid(shade, at, size, 0.9)
    return shade.separate(_read(shade, gust_image(), u, v))[0]


def _laid(
    shade: Shading, at: Place, size: Socket | float, turn: float
) -> tuple[Socket, tuple[Socket, Socket]]:
    """A tile's x axis in periods of the domain, and the point in tiles."""
    periods = shade.math("MAXIMUM", shade.math("DIVIDE", at.domain, size), 1.0)
    angle = shade.math("ADD", at.wind, turn)
    a, b = (
        shade.math("ROUND", shade.math("MULTIPLY", periods, shade.math(name, angle)))
        for name in ("COSINE", "SINE")
    )
    axis, across = shade.combine(a, b), shade.combine(shade.math("MULTIPLY", b, -1.0), a)
    return axis, (
        shade.number("DOT_PRODUCT", at.rest, axis),
        shade.number("DOT_PRODUCT", at.rest, across),
    )


def _read(shade: Shading, image: bpy.types.Image, u: Socket, v: Socket) -> Socket:
    inputs = {"Vector": shade.combine(u, v)}
    settings = {"image": image, "interpolation": "Linear", "extension": "REPEAT"}
    return shade.node("ShaderNodeTexImage", inputs, **settings).outputs[0]


def slopes(shade: Shading, of: Tile, strength: Socket) -> Socket:
    """The ripples' slopes along the ocean's x and y, as a vector; `strength` is their root mean square."""
    along, across, _ = shade.separate(of.red_green)
    x, y, _ = shade.separate(of.along)
    side = shade.combine(shade.math("MULTIPLY", y, -1.0), x)
    both = shade.vector("ADD", shade.scale(of.along, along), shade.scale(side, across))
    return shade.scale(both, strength)
