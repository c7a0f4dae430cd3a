# SPDX-License-Identifier: GPL-3.0-or-later
"""Contact with the water: the wet band on an object, and the collar of foam and ripples around it.

The wet band is a point attribute that geometry nodes write on the object, read by a shader group. The collar
is a shader group in the water's material. It uses the object's coordinates and its waterline as a
superellipse: no mesh reads another, so there are no dependency cycles, and every surface with the material
shows the collar.

Ripples of length λ travel outwards as waves in deep water, ω² = 2πg/λ. The distance from the waterline is to
first order (f - 1)/|∇f|, f being 1 on it (Taubin 1994, ACM Transactions on Graphics 13).

In a strong wind there is white water where waves break on the hull's windward end, and a wash down the wind.
"""

from __future__ import annotations

import math

import bpy

from .building import Builder, Panel, Plug, Socket, output
from .fields import coordinates
from .names import SLOP, WET
from .sample import OCEAN_INPUT, Spaces
from .shading import Shading
from .surface import SURFACE
from .versioned import GroupKind, node_group
from .water_pattern import METRES

_GRAVITY = 9.81  # m/s²
#: wavelengths of ripples relative to the longest, and their slopes
_TRAINS = ((1.0, 0.2), (0.43, 0.13))
_SCATTER = 5.0  # phase variation around the hull, rad
#: reach of the foam where the noise is smallest, and the additional reach where it is largest, in units of
# its width
_NARROW, _WIDE = 0.25, 1.7
#: additional width at the windward end, and the position along the hull where it begins
_BOW_WIDER, _BOW = 2.0, (0.4, 0.9)
#: wash: positions along the hull where it begins and is complete, and the growth of its breadth
_WASH_BEGINS, _WASH_SPREADS = (-0.7, 0.6), 0.14

#: slop: where it begins and is thickest, as `wet`; how often per drip, and by how much, its upper edge rises
_SLOPPY, _LAPS = (0.5, 1.2), ((0.35, 0.9), (1.3, 0.5))
_BELOW_SLOP = (1.2, 1.6)
#: where its thinnest film is seen, as `wet`; shreds per drip, and how far holes open and how soft they are
_THIN_SLOP, _SHREDS, _HOLES, _SOFT_SHREDS = (0.5, 0.9), 6.0, 0.5, 0.08
_SLOP_ROUGHNESS = 0.7

CONTACT_INPUTS = (
    OCEAN_INPUT,
    Plug("Wet Band", "NodeSocketFloat", 0.25, "How high above the water it is wet, in Blender units"),
    Plug("Slop", "NodeSocketFloat", 0.0, "White water that laps at it above the waterline, 0 to 1"),
)
_VERTEX_INPUTS = (
    ("Vector", "NodeSocketVector", (0.0, 0.0, 0.0), "The water's place in the coordinates of the object"),
    ("Location", "NodeSocketVector", (0.0, 0.0, 0.0), "Makes its waterline the origin, in metres"),
    ("Rotation", "NodeSocketVector", (0.0, 0.0, 0.0), "Makes it stand upright"),
    ("Scale", "NodeSocketVector", (1.0, 1.0, 1.0), "Makes metres of its units"),
)
#: inputs of a collar that an artist adjusts
LOOK_INPUTS = (
    ("Foam", "NodeSocketFloat", 0.7, "At the waterline, 0 to 1"),
    ("Foam Width", "NodeSocketFloat", 0.25, "In metres; it is thinned out over about twice as much"),
    ("Ripples", "NodeSocketFloat", 1.0, "Multiplies their height"),
    ("Ripple Length", "NodeSocketFloat", 0.5, "Of the longest, from crest to crest, in metres"),
    ("Wash", "NodeSocketFloat", 0.0, "Length of the white water down the wind, in metres; 0 for none"),
)
_HULL_INPUTS = (
    ("Half Length", "NodeSocketFloat", 1.0, "Of the waterline along x, in metres"),
    ("Half Beam", "NodeSocketFloat", 1.0, "Of the waterline along y, in metres"),
    ("Fullness", "NodeSocketFloat", 2.0, "Of the waterline: 1 is a rhombus, 2 an ellipse, more a box"),
    ("Lee", "NodeSocketVector", (1.0, 0.0, 0.0), "Down the wind, of unit length, in the upright axes"),
)
_CHAIN = (
    ("Foam Map", "NodeSocketFloat", 0.0, "Foam of the collars before"),
    ("Height", "NodeSocketFloat", 0.0, "Ripples of the collars before, in metres"),
    ("Time", "NodeSocketFloat", 0.0, "Seconds"),
)
_COLLAR_OUTPUTS = (
    Plug("Foam Map", "NodeSocketFloat", None, "Foam with that of this collar"),
    Plug("Height", "NodeSocketFloat", None, "Ripples with those of this collar, in metres"),
)


def _build_contact(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, CONTACT_INPUTS)
    spaces = Spaces(build, build.given("Ocean"))
    own = output(build.add("GeometryNodeInputPosition"), "Position")
    place = spaces.point_of_ocean(own)
    surface = build.group(node_group(SURFACE), {"Geometry": spaces.mesh, "Position": place})
    above = build.vector("SUBTRACT", place, output(surface, "Point"))
    part = build.math(
        "DIVIDE", coordinates(build, above)[2], build.math("MAXIMUM", build.given("Wet Band"), 1e-6)
    )
    # not clamped, so that interpolation between distant vertices is correct
    wet = build.store(build.given("Geometry"), WET, build.math("SUBTRACT", 1.0, part), "FLOAT")
    build.finish(build.store(wet, SLOP, build.given("Slop"), "FLOAT"))


def _build_wet(tree: bpy.types.NodeTree) -> None:
    shade = Shading(tree)
    outputs = (
        Plug("Color", "NodeSocketColor", None, "Darker where it is wet"),
        Plug("Roughness", "NodeSocketFloat", None, "Less where it is wet"),
    )
    inputs = (
        ("Color", "NodeSocketColor", (0.8, 0.8, 0.8, 1.0), "Of the dry surface"),
        ("Roughness", "NodeSocketFloat", 0.5, "Of the dry surface"),
        ("Darkening", "NodeSocketFloat", 0.6, "Share of the colour's light that water on it takes"),
        ("Wet Roughness", "NodeSocketFloat", 0.07, "Of the film of water"),
        ("Drips", "NodeSocketFloat", 9.0, "Along the upper edge, in the length of the object"),
        ("Slop", "NodeSocketFloat", 1.0, "Multiplies the white water that laps at it above the waterline"),
        ("Slop Color", "NodeSocketColor", (0.80, 0.83, 0.83, 1.0), "Of that white water"),
    )
    given = shade.interface(outputs, (Panel("Wet Band", inputs),)).outputs
    at = shade.node("ShaderNodeTexCoord").outputs["Generated"]
    ragged = shade.noise(at, given["Drips"], Detail=2.0)
    height = shade.math("MULTIPLY_ADD", shade.math("SUBTRACT", ragged, 0.5), 0.6, shade.value(WET))
    wet = shade.smooth(height, 0.0, 0.45)
    kept = shade.math("SUBTRACT", 1.0, shade.math("MULTIPLY", wet, given["Darkening"]))
    slop = _slop(shade, given, at)
    smooth = shade.mix(wet, given["Roughness"], given["Wet Roughness"])
    shade.finish(
        {
            "Color": shade.mix_vectors(slop, shade.scale(given["Color"], kept), given["Slop Color"]),
            "Roughness": shade.mix(slop, smooth, _SLOP_ROUGHNESS),
        }
    )


def _slop(shade: Shading, given: dict[str, Socket], at: Socket) -> Socket:
    """How much of a hull is hidden by what laps at it: a film in places, torn into shreds as it thins."""
    height = shade.value(WET)
    for often, amount in _LAPS:
        lap = shade.noise(at, shade.math("MULTIPLY", given["Drips"], often), Detail=2.0)
        height = shade.math("MULTIPLY_ADD", shade.math("SUBTRACT", lap, 0.5), amount, height)
    shreds = shade.noise(at, shade.math("MULTIPLY", given["Drips"], _SHREDS), Detail=3.0)
    thick = shade.smooth(height, *_SLOPPY)
    # the thinner the film, the more of it is holes
    holes = shade.math("MULTIPLY_ADD", thick, -_HOLES, 0.5 + 0.5 * _HOLES)
    torn = shade.smooth(shade.math("SUBTRACT", shreds, holes), -_SOFT_SHREDS, _SOFT_SHREDS)
    shown = shade.math("MULTIPLY", torn, shade.smooth(height, *_THIN_SLOP))
    # a hull that is cut out may be dry inside, below the water
    shown = shade.math("MULTIPLY", shown, shade.smooth(shade.value(WET), *_BELOW_SLOP, 1.0, 0.0))
    amount = shade.math("MULTIPLY", shade.value(SLOP), given["Slop"], clamp=True)
    return shade.math("MULTIPLY", shown, amount)


def _build_collar(tree: bpy.types.NodeTree) -> None:
    shade = Shading(tree)
    panels = (
        Panel("Look", LOOK_INPUTS),
        Panel("Hull", (*_VERTEX_INPUTS, *_HULL_INPUTS)),
        Panel("Chain", _CHAIN),
    )
    given = shade.interface(_COLLAR_OUTPUTS, panels).outputs
    # if the object was deleted, Blender returns the water's own coordinates
    own = shade.node("ShaderNodeTexCoord").outputs["Object"]
    is_there = shade.math("GREATER_THAN", shade.number("DISTANCE", own, given["Vector"]), 1e-4)
    mapped = {name: given[name] for name, *_ in _VERTEX_INPUTS}
    place = shade.node("ShaderNodeMapping", mapped, vector_type="POINT").outputs[0]
    away = _distance(shade, given, place)
    uneven = _uneven(shade, given, place)
    foam = shade.math("MULTIPLY", is_there, _foam(shade, given, place, away, uneven))
    ripples = shade.math("MULTIPLY", is_there, _ripples(shade, given, away, uneven))
    shade.finish(
        {
            "Foam Map": shade.math("MAXIMUM", given["Foam Map"], foam),
            "Height": shade.math("ADD", given["Height"], ripples),
        }
    )


def _distance(shade: Shading, given: dict[str, Socket], place: Socket) -> Socket:
    """Distance from the waterline in m, negative inside."""
    full = given["Fullness"]
    sizes = given["Half Length"], given["Half Beam"]
    shares = [
        shade.math("DIVIDE", shade.math("ABSOLUTE", part), size)
        for part, size in zip(shade.separate(place), sizes, strict=False)
    ]
    powers = [shade.math("POWER", share, full) for share in shares]
    total = shade.math("MAXIMUM", shade.math("ADD", *powers), 1e-6)
    form = shade.math("POWER", total, shade.math("DIVIDE", 1.0, full))
    less = shade.math("SUBTRACT", full, 1.0)
    outer = shade.math("POWER", form, less)
    slopes = [
        shade.math("DIVIDE", shade.math("DIVIDE", shade.math("POWER", share, less), size), outer)
        for share, size in zip(shares, sizes, strict=True)
    ]
    steep = shade.math("SQRT", shade.math("ADD", *(shade.math("MULTIPLY", each, each) for each in slopes)))
    return shade.math("DIVIDE", shade.math("SUBTRACT", form, 1.0), shade.math("MAXIMUM", steep, 1e-6))


def _uneven(shade: Shading, given: dict[str, Socket], place: Socket) -> Socket:
    """Noise, 0…1, that varies around the hull and in time."""
    x, y, _ = shade.separate(shade.scale(place, shade.math("DIVIDE", 0.6, given["Ripple Length"])))
    moving = shade.combine(x, y, shade.math("MULTIPLY", given["Time"], 0.35))
    return shade.smooth(shade.noise(moving, 1.0, Detail=2.0), 0.3, 0.7)


def _foam(shade: Shading, given: dict[str, Socket], place: Socket, away: Socket, uneven: Socket) -> Socket:
    x, y, _ = shade.separate(place)
    lee_x, lee_y, _ = shade.separate(given["Lee"])
    length, beam = given["Half Length"], given["Half Beam"]
    down = _dot(shade, x, y, lee_x, lee_y)
    # half of the hull's extent down the wind and across it
    extent = _dot(shade, length, beam, *(shade.math("ABSOLUTE", part) for part in (lee_x, lee_y)))
    breadth = _dot(shade, length, beam, *(shade.math("ABSOLUTE", part) for part in (lee_y, lee_x)))
    share = shade.math("DIVIDE", down, extent)
    is_washed = shade.math("GREATER_THAN", given["Wash"], 0.0)
    bow = shade.smooth(shade.math("MULTIPLY", share, -1.0), *_BOW, 1.0, 1.0 + _BOW_WIDER)
    wide = shade.math("MULTIPLY", shade.mix(uneven, _NARROW, _WIDE), shade.mix(is_washed, 1.0, bow))
    reach = shade.math("MULTIPLY", given["Foam Width"], wide)
    outside = shade.math("DIVIDE", shade.math("MAXIMUM", away, 0.0), shade.math("MAXIMUM", reach, 1e-6))
    around = shade.math("EXPONENT", shade.math("MULTIPLY", outside, -1.0))
    # the wash: a stripe that grows wider and fades
    along = shade.math("MAXIMUM", down, 0.0)
    aside = shade.math("SUBTRACT", shade.math("MULTIPLY", y, lee_x), shade.math("MULTIPLY", x, lee_y))
    aside = shade.math("DIVIDE", aside, shade.math("MULTIPLY_ADD", along, _WASH_SPREADS, breadth))
    fades = shade.math("DIVIDE", along, shade.math("MAXIMUM", given["Wash"], 1e-6))
    lost = shade.math("MULTIPLY_ADD", aside, aside, fades)
    wash = shade.math("EXPONENT", shade.math("MULTIPLY", lost, -1.0))
    wash = shade.math("MULTIPLY", wash, shade.smooth(share, *_WASH_BEGINS, 0.0, is_washed))
    return shade.math("MULTIPLY", given["Foam"], shade.math("MAXIMUM", around, wash))


def _dot(shade: Shading, x: Socket, y: Socket, of_x: Socket, of_y: Socket) -> Socket:
    return shade.math("MULTIPLY_ADD", x, of_x, shade.math("MULTIPLY", y, of_y))


def _ripples(shade: Shading, given: dict[str, Socket], away: Socket, uneven: Socket) -> Socket:
    """Height of the ripples, m."""
    longest = shade.math("MAXIMUM", given["Ripple Length"], 1e-3)
    total: Socket | float = 0.0
    for share, slope in _TRAINS:
        length = shade.math("MULTIPLY", longest, share)
        number = shade.math("DIVIDE", 2.0 * math.pi, length)
        frequency = shade.math("SQRT", shade.math("MULTIPLY", number, _GRAVITY))
        phase = shade.math("MULTIPLY_ADD", number, away, shade.math("MULTIPLY", uneven, _SCATTER))
        phase = shade.math("SUBTRACT", phase, shade.math("MULTIPLY", frequency, given["Time"]))
        height = shade.math("MULTIPLY", shade.math("COSINE", phase), shade.math("DIVIDE", slope, number))
        total = shade.math("ADD", total, height)
    reach = shade.math("DIVIDE", shade.math("MAXIMUM", away, 0.0), shade.math("MULTIPLY", longest, -2.5))
    near = shade.math("MULTIPLY", shade.math("EXPONENT", reach), given["Ripples"])
    return shade.math("MULTIPLY", total, near)


def _build_ripple_normal(tree: bpy.types.NodeTree) -> None:
    shade = Shading(tree)
    outputs = (Plug("Normal Map", "NodeSocketVector", None, "In the ocean's own axes"),)
    inputs = (("Height", "NodeSocketFloat", 0.0, "Of the ripples, in metres"),)
    given = shade.interface(outputs, (Panel("Ripples", inputs),)).outputs
    metres = shade.math("MAXIMUM", shade.value(METRES, "OBJECT"), 1e-6)
    bumps = {"Height": given["Height"], "Distance": shade.math("DIVIDE", 1.0, metres), "Strength": 1.0}
    bent = shade.node("ShaderNodeBump", bumps).outputs[0]
    to_ocean = {"vector_type": "NORMAL", "convert_from": "WORLD", "convert_to": "OBJECT"}
    shade.finish({"Normal Map": shade.node("ShaderNodeVectorTransform", {0: bent}, **to_ocean).outputs[0]})


CONTACT = GroupKind("Ocean Contact", 2, _build_contact)
WET_BAND = GroupKind("Ocean Tweak Wet Band", 4, _build_wet, "ShaderNodeTree")
COLLAR = GroupKind("Ocean Tweak Collar", 2, _build_collar, "ShaderNodeTree")
RIPPLE_NORMAL = GroupKind("Ocean Tweak Ripple Normal", 1, _build_ripple_normal, "ShaderNodeTree")
