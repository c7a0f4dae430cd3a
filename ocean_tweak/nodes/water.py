# SPDX-License-Identifier: GPL-3.0-or-later
"""The shader group "Ocean Tweak Water": sea water seen from the air, for Cycles and EEVEE.

The surface reflects by Fresnel's equations; its roughness is the slope variance that the mesh cannot hold,
a part of which is drawn as ripples near the camera, and what the mesh says that it has left out. Beneath it,
light comes back from the water and from the bottom. Foam lies over it. Lengths are metres, whatever the
scene's unit scale.

The body is the two-flow model of irradiance: R = 0.33 b/(a + b) over deep water (Morel & Prieur 1977; Gordon
1975), with the bottom R + (bottom - R) exp(-2(a + b) depth) (Maritorena, Morel & Gentili 1994). What of it
leaves the water is (1 - r)R/(1 - rR), r = 0.47 the share that a flat surface throws back down from below
(Saunderson 1942).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import bpy

from .building import Panel, Plug, Socket
from .names import CUSP, FOAM, SHORTEST_WAVE, SLOPE_VARIANCE
from .shading import Shading
from .surface_detail import FEWEST_WAVES, MOST_WAVES
from .versioned import GroupKind
from .water_foam import foam_cover, foam_shader
from .water_pattern import DEPTH, SLOPES, Place, gust, place, slopes, tile

_THROWN_BACK = 0.47
_SURFACE_FACTOR = 0.33

#: ripples: size of their tile in samples of the mesh, turn in rad, share of the slope variance
_RIPPLES = ((16.0, 0.0, 0.36), (8.3, 0.42, 0.27), (3.1, -0.35, 0.17))
#: turns in rad of the tiles for waves that a surface around the camera leaves out: each tile has as many
#: octaves, the first from two samples on
_LEFT_OUT = (0.21, -0.27)
_OCTAVES = math.log2(MOST_WAVES / FEWEST_WAVES)
#: of the largest ripples of an ocean of 400 m and 512 samples, m: Ripple Distance is meant for these
_USUAL_TILE = 12.5
_GUST_SIZE = 240.0  # m
#: what waves that the mesh leaves out add to alpha², of their slope variance σ². Far water is as bright as
#: its slopes along the line of sight are steep in the mean: GGX has E|s| = alpha, and with Gaussian slopes of
#: the variance σ²/2 besides alpha + σ²/4alpha, so alpha² grows by σ²/2 (without other roughness by σ²/π)
_BELL_SHARE = 0.5
#: their wavelengths as a share of the tile, where their speed is taken
_TYPICAL_WAVE = 1.0 / 24.0

WATER_PANEL = Panel(
    "Water",
    (
        ("IOR", "NodeSocketFloat", 1.333, "Index of refraction; 1.333 for water, 1.34 for the sea"),
        (
            "Absorption", "NodeSocketColor", (0.345, 0.067, 0.040, 1.0),
            "Light absorbed in a metre of water, by colour; red far more than blue",
        ),
        (
            "Backscatter", "NodeSocketColor", (0.0016, 0.0022, 0.0035, 1.0),
            "Light that turns back in a metre of water, by colour; particles make the sea brighter",
        ),
        ("Water Depth", "NodeSocketFloat", 0.0, "In metres; 0 takes the depth of the ocean's waves"),
        ("Bottom Color", "NodeSocketColor", (0.42, 0.37, 0.27, 1.0), "What lies under shallow water"),
        ("Bubbles", "NodeSocketFloat", 0.06, "Backscatter in a metre of water under fresh foam"),
        ("Crest Light", "NodeSocketFloat", 0.15, "Share of it in sharp crests, which light shines into"),
        (
            "Transmission", "NodeSocketFloat", 0.0,
            "1 lets the camera see what is under water, with the group's Volume on the material's output",
        ),
    ),
)  # fmt: skip
FOAM_PANEL = Panel(
    "Foam",
    (
        ("Foam Amount", "NodeSocketFloat", 1.0, "Multiplies the ocean's foam"),
        ("Foam Map", "NodeSocketFloat", 0.0, "Foam from an image, instead of or above the ocean's own"),
        ("Foam Color", "NodeSocketColor", (0.83, 0.85, 0.85, 1.0), "Of dense foam"),
        ("Foam Roughness", "NodeSocketFloat", 0.65, "Of foam's own surface"),
        ("Foam Size", "NodeSocketFloat", 6.0, "Of the pattern that foam thins out by, in metres"),
        ("Foam Streaks", "NodeSocketFloat", 0.0, "Thin old foam in lines along the wind, as from 7 Bft on"),
    ),
)  # fmt: skip
SURFACE_PANEL = Panel(
    "Surface",
    (
        ("Slopes", "NodeSocketFloat", 1.0, "Multiplies the slope variance of the waves finer than the mesh"),
        ("Ripples", "NodeSocketFloat", 1.0, "Share of them drawn as waves near the camera, not as roughness"),
        ("Ripple Distance", "NodeSocketFloat", 120.0, "In metres, where half of the ripples are roughness"),
        ("Gusts", "NodeSocketFloat", 0.5, "How unevenly gusts ruffle the water"),
        ("Time", "NodeSocketFloat", 0.0, "Seconds, in which the ripples run on"),
        (
            "Normal Map", "NodeSocketVector", (0.0, 0.0, 0.0),
            "Normal in the ocean's own axes, as the normal files hold it; unlinked, it is the mesh's",
        ),
    ),
)  # fmt: skip
AIR_PANEL = Panel(
    "Air",
    (
        (
            "Visibility", "NodeSocketFloat", 0.0,
            "Distance in metres at which haze leaves a fiftieth of the contrast; 0 for air without haze",
        ),
        ("Haze Color", "NodeSocketColor", (0.6, 0.65, 0.7, 1.0), "The sky's at the horizon"),
    ),
)  # fmt: skip
OUTPUTS = (
    Plug("Surface", "NodeSocketShader", None, "To the material's Surface"),
    Plug("Volume", "NodeSocketShader", None, "To the material's Volume, only for Transmission"),
    Plug("Foam", "NodeSocketFloat", None, "How much foam covers the water, with its pattern"),
)


class _Ripples(NamedTuple):
    """A tile of waves that the mesh has not.

    size : of the tile, m
    turn : rad, away from the wind
    share : of the slope variance
    reach : m, where half of them are roughness
    """

    size: Socket
    turn: float
    share: Socket | float
    reach: Socket


def _build(tree: bpy.types.NodeTree) -> None:
    shade = Shading(tree)
    given = shade.interface(OUTPUTS, (WATER_PANEL, FOAM_PANEL, SURFACE_PANEL, AIR_PANEL)).outputs
    at = place(shade)
    foam = shade.math("MULTIPLY", shade.value(FOAM), given["Foam Amount"])
    foam = shade.math("MAXIMUM", foam, given["Foam Map"], clamp=True)
    normal, roughness = _surface(shade, given, at)
    absorption, backscatter = _coefficients(shade, given, foam)
    through = given["Transmission"]
    inputs = {
        "Base Color": shade.mix_vectors(through, _body(shade, given, absorption, backscatter), (1.0,) * 3),
        "Transmission Weight": through, "Roughness": roughness, "IOR": given["IOR"], "Normal": normal,
    }  # fmt: skip
    water = shade.node("ShaderNodeBsdfPrincipled", inputs, distribution="GGX").outputs[0]
    cover = foam_cover(shade, given, at, foam)
    shown = shade.mix_shaders(cover.amount, water, foam_shader(shade, given, cover, normal))
    hazy = _in_haze(shade, given, at, shown)
    shade.finish({"Surface": hazy, "Volume": _volume(shade, given, at), "Foam": cover.amount})


def _surface(shade: Shading, given: dict[str, Socket], at: Place) -> tuple[Socket, Socket]:
    """The normal with the ripples near the camera, and the roughness of those that are not drawn."""
    variance = shade.math("MULTIPLY", shade.value(SLOPES, "OBJECT"), given["Slopes"])
    uneven = shade.smooth(gust(shade, at, _GUST_SIZE), 0.0, 1.0, 0.25, 1.75)
    variance = shade.math("MULTIPLY", variance, shade.mix(given["Gusts"], 1.0, uneven))
    ripples = []
    for samples, turn, share in _RIPPLES:
        size = shade.math("MULTIPLY", at.spacing, samples)
        reach = shade.math("MULTIPLY", given["Ripple Distance"], samples / _RIPPLES[0][0])
        ripples.append(_Ripples(size, turn, share, reach))
    pattern, left = _drawn(shade, given, at, variance, ripples)
    lost = shade.math("MULTIPLY", shade.value(SLOPE_VARIANCE), given["Slopes"])
    more, lost = _drawn(shade, given, at, lost, _left_out(shade, given, at))
    total = shade.vector("ADD", pattern, more)
    left = shade.math("ADD", left, shade.math("MULTIPLY", lost, _BELL_SHARE))
    roughness = shade.math("POWER", shade.math("MAXIMUM", left, 0.0), 0.25)
    return _normal(shade, given, total), shade.math("MINIMUM", roughness, 1.0)


def _left_out(shade: Shading, given: dict[str, Socket], at: Place) -> list[_Ripples]:
    """The waves that a surface around the camera leaves out: from two samples up to its own shortest.

    Each octave of them has the same slopes, as in the equilibrium range (Phillips 1958).
    """
    shortest = shade.math("MULTIPLY", shade.value(SHORTEST_WAVE), at.metres)
    octaves = shade.math(
        "LOGARITHM", shade.math("DIVIDE", shortest, shade.math("MULTIPLY", at.spacing, 2.0)), 2.0
    )
    whole = shade.math("MAXIMUM", octaves, 1e-3)
    ripples = []
    for number, turn in enumerate(_LEFT_OUT):
        held = shade.math("SUBTRACT", octaves, number * _OCTAVES)
        held = shade.math("MINIMUM", shade.math("MAXIMUM", held, 0.0), _OCTAVES)
        size = shade.math("MULTIPLY", at.spacing, 2.0 * FEWEST_WAVES * 2.0 ** (_OCTAVES * (number + 1)))
        reach = shade.math("MULTIPLY", given["Ripple Distance"], shade.math("DIVIDE", size, _USUAL_TILE))
        ripples.append(_Ripples(size, turn, shade.math("DIVIDE", held, whole), reach))
    return ripples


def _drawn(
    shade: Shading, given: dict[str, Socket], at: Place, variance: Socket, ripples: list[_Ripples]
) -> tuple[Socket, Socket]:
    """The slopes of what is drawn of a variance, and what is left of that for the roughness."""
    total, drawn = None, 0.0
    for size, turn, share, reach in ripples:
        ratio = shade.math("DIVIDE", at.distance, reach)
        near = shade.math("DIVIDE", 1.0, shade.math("MULTIPLY_ADD", ratio, ratio, 1.0))
        part = shade.math("MULTIPLY", shade.math("MULTIPLY", near, share), given["Ripples"], clamp=True)
        strength = shade.math("SQRT", shade.math("MULTIPLY", variance, part))
        pattern = slopes(shade, tile(shade, at, size, turn, _travelled(shade, given, size)), strength)
        total = pattern if total is None else shade.vector("ADD", total, pattern)
        drawn = shade.math("ADD", drawn, part)
    return total, shade.math("MULTIPLY", variance, shade.math("SUBTRACT", 1.0, drawn, clamp=True))


def _travelled(shade: Shading, given: dict[str, Socket], size: Socket) -> Socket:
    """How far typical ripples of a tile have gone, m: deep water, c = √(gλ/2π)."""
    speed = shade.math("SQRT", shade.math("MULTIPLY", size, 9.81 / 6.283 * _TYPICAL_WAVE))
    return shade.math("MULTIPLY", speed, given["Time"])


def _normal(shade: Shading, given: dict[str, Socket], slope: Socket) -> Socket:
    """The mesh's normal, or the map's, tilted by the slopes of the ripples; in world space."""
    mapped = given["Normal Map"]
    is_mapped = shade.math("GREATER_THAN", shade.number("LENGTH", mapped), 0.5)
    to_world = {"convert_from": "OBJECT", "convert_to": "WORLD"}
    turned = shade.node("ShaderNodeVectorTransform", {0: mapped}, vector_type="NORMAL", **to_world)
    own = shade.node("ShaderNodeNewGeometry").outputs["Normal"]
    smooth = shade.mix_vectors(is_mapped, own, turned.outputs[0])
    tilt = shade.node("ShaderNodeVectorTransform", {0: slope}, vector_type="VECTOR", **to_world)
    return shade.vector("NORMALIZE", shade.vector("SUBTRACT", smooth, tilt.outputs[0]))


def _coefficients(shade: Shading, given: dict[str, Socket], foam: Socket) -> tuple[Socket, Socket]:
    """Absorption and backscatter per metre, with the bubbles under foam and in crests."""
    crest = shade.smooth(shade.value(CUSP), 0.15, 0.75)
    bubbles = shade.math("MAXIMUM", foam, shade.math("MULTIPLY", crest, given["Crest Light"]))
    amount = shade.math("MULTIPLY", bubbles, given["Bubbles"])
    return given["Absorption"], shade.vector(
        "ADD", given["Backscatter"], shade.combine(amount, amount, amount)
    )


def _body(shade: Shading, given: dict[str, Socket], absorption: Socket, backscatter: Socket) -> Socket:
    """Colour of the light that comes back out of the water."""
    lost = shade.vector("MAXIMUM", shade.vector("ADD", absorption, backscatter), (1e-9, 1e-9, 1e-9))
    deep = shade.scale(shade.vector("DIVIDE", backscatter, lost), _SURFACE_FACTOR)
    own = shade.value(DEPTH, "OBJECT")
    depth = shade.mix(shade.math("GREATER_THAN", given["Water Depth"], 0.0), own, given["Water Depth"])
    # a mesh that is no ocean has no depth: then it is deep
    depth = shade.mix(shade.math("GREATER_THAN", depth, 0.0), 1e4, depth)
    thickness = shade.separate(shade.scale(lost, shade.math("MULTIPLY", depth, -2.0)))
    seen = shade.combine(*(shade.math("EXPONENT", part) for part in thickness))
    difference = shade.vector("SUBTRACT", given["Bottom Color"], deep)
    below = shade.vector("MULTIPLY_ADD", difference, seen, deep)
    kept = shade.vector("MULTIPLY_ADD", below, (-_THROWN_BACK,) * 3, (1.0,) * 3)
    return shade.vector("DIVIDE", shade.scale(below, 1.0 - _THROWN_BACK), kept)


def _in_haze(shade: Shading, given: dict[str, Socket], at: Place, surface: Socket) -> Socket:
    """The surface behind as much air: contrast falls as exp(-3.9 d/visibility) (Koschmieder 1924)."""
    path = shade.math("DIVIDE", shade.math("MULTIPLY", at.distance, -3.912), given["Visibility"])
    share = shade.math("SUBTRACT", 1.0, shade.math("EXPONENT", path))
    # division by zero gives zero, and then the share is zero
    share = shade.math("MULTIPLY", share, shade.node("ShaderNodeLightPath").outputs[0])
    air = shade.node("ShaderNodeEmission", {0: given["Haze Color"], 1: 1.0}).outputs[0]
    return shade.mix_shaders(share, surface, air)


def _volume(shade: Shading, given: dict[str, Socket], at: Place) -> Socket:
    """The same water as a volume: scattering evenly, half of which turns back; Blender counts by its unit."""
    twice = shade.math("MULTIPLY", at.metres, 2.0)
    inputs = {
        "Absorption Coefficients": shade.scale(given["Absorption"], at.metres),
        "Scatter Coefficients": shade.scale(given["Backscatter"], twice),
        "Anisotropy": 0.0,
    }
    return shade.node("ShaderNodeVolumeCoefficients", inputs).outputs[0]


WATER = GroupKind("Ocean Tweak Water", 3, _build, "ShaderNodeTree")
