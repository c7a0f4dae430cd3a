# SPDX-License-Identifier: GPL-3.0-or-later
"""The shader group "Ocean Tweak Water": sea water seen from the air, for Cycles and EEVEE.

The surface reflects by Fresnel's equations. Its roughness is the slope variance of waves too short for the
mesh, partly drawn as ripples near the camera, plus the variance that the mesh reports as omitted. Below it,
light comes back from the water and from the bottom. Foam lies on top. Lengths are in metres, whatever the
scene's unit scale.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import bpy

from .building import Panel, Plug, Socket
from .names import SHORTEST_WAVE, SLOPE_VARIANCE
from .shading import VISIBILITY, Shading
from .surface_detail import FEWEST_WAVES, MOST_WAVES
from .versioned import GroupKind
from .water_foam import foam_at, foam_cover, foam_shader
from .water_light import body, coefficients, crest_glow, light_through_crests
from .water_pattern import SLOPES, Place, gust, place, ripples

#: ripples: size of their tile in samples of the mesh, turn in rad, share of the slope variance
_RIPPLES = ((16.0, 0.0, 0.44), (8.3, 0.42, 0.34), (3.1, -0.35, 0.22))
#: turns in rad of the tiles for waves that a surface around the camera leaves out: each tile has as many
#: octaves, the first from two samples on
_LEFT_OUT = (0.21, -0.27)
_OCTAVES = math.log2(MOST_WAVES / FEWEST_WAVES)
#: sharpness of the transition from ripples to roughness at their distance
_FALL = 3.0
#: of the largest ripples of an ocean of 400 m and 512 samples, m: Ripple Distance is meant for these
_USUAL_TILE = 12.5
#: sizes of gusts, m, and the share of the largest
_GUSTS = ((1400.0, 0.6), (310.0, 0.4))
#: effect of gusts on the slope variance
_GUSTY = (0.15, 1.85)
#: smallest roughness of water, so that reflections of the sun are not points
_SMOOTHEST = 0.03
#: heights of what a ripple mirrors, as sines, between which it is water and sky; and the share of F0 that
#: stands for two ripples: of grazing light it leaves two thirds
_BELOW, _TWICE = (-0.1, 0.0), 0.4
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
            "Light scattered back in a metre of water, by colour; particles make the sea brighter",
        ),
        ("Water Depth", "NodeSocketFloat", 0.0, "In metres; 0 uses the depth of the ocean's waves"),
        ("Bottom Color", "NodeSocketColor", (0.42, 0.37, 0.27, 1.0), "What lies under shallow water"),
        ("Bubbles", "NodeSocketFloat", 0.06, "Backscatter in a metre of water under fresh foam"),
        ("Crest Light", "NodeSocketFloat", 0.15, "Fraction of it in sharp crests, which light shines into"),
        ("Crest Glow", "NodeSocketFloat", 1.0, "Multiplies the sun's light that shines through sharp crests"),
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
        ("Foam Map", "NodeSocketFloat", 0.0, "From an image: the larger of it and the ocean's own counts"),
        ("Foam Color", "NodeSocketColor", (0.90, 0.91, 0.91, 1.0), "Of dense foam"),
        ("Foam Roughness", "NodeSocketFloat", 0.8, "Of the surface of foam"),
        ("Foam Size", "NodeSocketFloat", 6.0, "Size of the foam pattern, in metres"),
        ("Foam Relief", "NodeSocketFloat", 1.0, "How high fresh foam is piled up"),
        (
            "Foam Streaks", "NodeSocketFloat", -1.0,
            "How far old foam is stretched along the wind, 0 to 1; -1 follows the wind, from 7 Bft on",
        ),
    ),
)  # fmt: skip
SURFACE_PANEL = Panel(
    "Surface",
    (
        ("Slopes", "NodeSocketFloat", 1.0, "Multiplies the slope variance of waves finer than the mesh"),
        ("Ripples", "NodeSocketFloat", 1.0, "Fraction of them drawn as waves near the camera, not as "
        "roughness"),
        ("Ripple Distance", "NodeSocketFloat", 120.0, "Distance in metres at which half of the ripples "
        "have become roughness"),
        ("Gusts", "NodeSocketFloat", 0.5, "How unevenly gusts ruffle the water"),
        ("Time", "NodeSocketFloat", 0.0, "Time in seconds that moves the ripples"),
        (
            "Normal Map", "NodeSocketVector", (0.0, 0.0, 0.0),
            "Normal in the ocean's own axes, as in the normal files; unlinked, the normal of the mesh",
        ),
    ),
)  # fmt: skip
LIGHT_PANEL = Panel(
    "Light",
    (
        (
            "Sun Direction", "NodeSocketVector", (0.0, 0.0, 1.0),
            "Direction to the sun, in the world; an ocean scene links it to its lamp",
        ),
        ("Sun Light", "NodeSocketColor", (0.0, 0.0, 0.0, 1.0), "Irradiance of the sun; black for no glow "
        "in crests"),
        (
            "Pixel Angle", "NodeSocketFloat", 0.0006,
            "Angle of a camera pixel, in radians: smaller patterns fade into their mean",
        ),
    ),
)  # fmt: skip
AIR_PANEL = Panel(
    "Air",
    (
        (
            "Visibility", "NodeSocketFloat", 0.0,
            "Visibility in metres, at which haze leaves a fiftieth of the contrast; 0 for no haze",
        ),
        ("Haze Color", "NodeSocketColor", (0.6, 0.65, 0.7, 1.0), "The sky's at the horizon"),
    ),
)  # fmt: skip
OUTPUTS = (
    Plug("Surface", "NodeSocketShader", None, "Link to the material's Surface"),
    Plug("Volume", "NodeSocketShader", None, "Link to the material's Volume, for Transmission only"),
    Plug("Foam", "NodeSocketFloat", None, "How much foam covers the water, with its pattern"),
)


class _Ripples(NamedTuple):
    """A tile of waves that are not in the mesh.

    size : of the tile, m
    turn : rad, away from the wind
    share : of the slope variance
    reach : distance at which half of them are roughness, m
    """

    size: Socket
    turn: float
    share: Socket | float
    reach: Socket


def _build(tree: bpy.types.NodeTree) -> None:
    shade = Shading(tree)
    given = shade.interface(OUTPUTS, (WATER_PANEL, FOAM_PANEL, SURFACE_PANEL, LIGHT_PANEL, AIR_PANEL)).outputs
    at = place(shade, given)
    foam = foam_at(shade, given)
    slope, roughness = _waves(shade, given, at)
    cover = foam_cover(shade, given, at, foam)
    absorption, backscatter = coefficients(shade, given, foam, cover)
    through = given["Transmission"]
    normal, mirrored = _mirroring(shade, _normal(shade, given, slope))
    below = body(shade, given, absorption, backscatter)
    lit = shade.math("SUBTRACT", 1.0, cover.shaded)
    behind = light_through_crests(shade, given, absorption)
    inputs = {
        "Base Color": shade.mix_vectors(through, shade.scale(below, lit), (1.0,) * 3),
        "Transmission Weight": through, "Roughness": roughness, "IOR": given["IOR"], "Normal": normal,
        "Specular IOR Level": shade.math("MULTIPLY", mirrored, lit),
        "Emission Color": crest_glow(shade, given, behind, normal), "Emission Strength": 1.0,
    }  # fmt: skip
    water = shade.node("ShaderNodeBsdfPrincipled", inputs, distribution="GGX").outputs[0]
    piled = _normal(shade, given, cover.slope)
    foam_shown = foam_shader(shade, given, cover, piled, behind)
    shown = shade.mix_shaders(shade.math("MULTIPLY", cover.amount, cover.density), water, foam_shown)
    hazy = _in_haze(shade, given, at, shown)
    shade.finish({"Surface": hazy, "Volume": _volume(shade, given, at), "Foam": cover.amount})


def _mirroring(shade: Shading, normal: Socket) -> tuple[Socket, Socket]:
    """The normal as it mirrors light, and how much, as the shader takes it: 0.5 for all.

    What a ripple mirrors from below the horizon is the next ripple, which EEVEE cannot see, and that mirrors
    the sky as high above the horizon, but for what it lets in. Seen from below it is the same upside down.
    """
    incoming = shade.node("ShaderNodeNewGeometry").outputs["Incoming"]
    side = shade.math("SIGN", shade.separate(incoming)[2])
    x, y, z = shade.separate(shade.vector("REFLECT", shade.scale(incoming, -1.0), normal))
    away = shade.math("MULTIPLY", z, side)
    mirrored = shade.combine(x, y, shade.math("MULTIPLY", shade.math("ABSOLUTE", z), side))
    halfway = shade.vector("NORMALIZE", shade.vector("ADD", incoming, mirrored))
    return halfway, shade.smooth(away, *_BELOW, 0.5 * _TWICE, 0.5)


def _waves(shade: Shading, given: dict[str, Socket], at: Place) -> tuple[Socket, Socket]:
    """The slopes of the ripples near the camera, and the roughness of those that are not drawn."""
    variance = shade.math("MULTIPLY", shade.value(SLOPES, "OBJECT"), given["Slopes"])
    variance = shade.math("MULTIPLY", variance, shade.mix(given["Gusts"], 1.0, _gusty(shade, at)))
    tiles = []
    for samples, turn, share in _RIPPLES:
        size = shade.math("MULTIPLY", at.spacing, samples)
        reach = shade.math("MULTIPLY", given["Ripple Distance"], samples / _RIPPLES[0][0])
        tiles.append(_Ripples(size, turn, share, reach))
    pattern, left = _drawn(shade, given, at, variance, tiles)
    lost = shade.math("MULTIPLY", shade.value(SLOPE_VARIANCE), given["Slopes"])
    more, lost = _drawn(shade, given, at, lost, _left_out(shade, given, at))
    total = shade.vector("ADD", pattern, more)
    left = shade.math("ADD", left, shade.math("MULTIPLY", lost, _BELL_SHARE))
    roughness = shade.math("POWER", shade.math("MAXIMUM", left, _SMOOTHEST**4), 0.25)
    return total, shade.math("MINIMUM", roughness, 1.0)


def _gusty(shade: Shading, at: Place) -> Socket:
    """Effect of gusts on the slope variance: cat's paws of several sizes on calm water."""
    felt = None
    for size, share in _GUSTS:
        part = shade.math("MULTIPLY", gust(shade, at, size), share)
        felt = part if felt is None else shade.math("ADD", felt, part)
    return shade.smooth(felt, 0.2, 0.8, *_GUSTY)


def _left_out(shade: Shading, given: dict[str, Socket], at: Place) -> list[_Ripples]:
    """The waves that a camera surface omits: from two samples up to its own shortest wave.

    Each octave of them has the same slopes, as in the equilibrium range (Phillips 1958).
    """
    shortest = shade.math("MULTIPLY", shade.value(SHORTEST_WAVE), at.metres)
    octaves = shade.math(
        "LOGARITHM", shade.math("DIVIDE", shortest, shade.math("MULTIPLY", at.spacing, 2.0)), 2.0
    )
    whole = shade.math("MAXIMUM", octaves, 1e-3)
    tiles = []
    for number, turn in enumerate(_LEFT_OUT):
        held = shade.math("SUBTRACT", octaves, number * _OCTAVES)
        held = shade.math("MINIMUM", shade.math("MAXIMUM", held, 0.0), _OCTAVES)
        size = shade.math("MULTIPLY", at.spacing, 2.0 * FEWEST_WAVES * 2.0 ** (_OCTAVES * (number + 1)))
        reach = shade.math("MULTIPLY", given["Ripple Distance"], shade.math("DIVIDE", size, _USUAL_TILE))
        tiles.append(_Ripples(size, turn, shade.math("DIVIDE", held, whole), reach))
    return tiles


def _drawn(
    shade: Shading, given: dict[str, Socket], at: Place, variance: Socket, tiles: list[_Ripples]
) -> tuple[Socket, Socket]:
    """The slopes of the drawn part of a variance, and the rest for the roughness."""
    total, drawn = None, 0.0
    for size, turn, share, reach in tiles:
        ratio = shade.math("DIVIDE", at.distance, reach)
        near = shade.math("DIVIDE", 1.0, shade.math("ADD", shade.math("POWER", ratio, _FALL), 1.0))
        part = shade.math("MULTIPLY", shade.math("MULTIPLY", near, share), given["Ripples"], clamp=True)
        strength = shade.math("SQRT", shade.math("MULTIPLY", variance, part))
        pattern = ripples(shade, at, size, turn, _travelled(shade, given, size), strength)
        total = pattern if total is None else shade.vector("ADD", total, pattern)
        drawn = shade.math("ADD", drawn, part)
    return total, shade.math("MULTIPLY", variance, shade.math("SUBTRACT", 1.0, drawn, clamp=True))


def _travelled(shade: Shading, given: dict[str, Socket], size: Socket) -> Socket:
    """Distance that typical ripples of a tile have travelled, m: deep water, c = √(gλ/2π)."""
    speed = shade.math("SQRT", shade.math("MULTIPLY", size, 9.81 / 6.283 * _TYPICAL_WAVE))
    return shade.math("MULTIPLY", speed, given["Time"])


def _normal(shade: Shading, given: dict[str, Socket], slope: Socket) -> Socket:
    """The mesh's normal, or the map's, tilted by slopes along the ocean's x and y; in world space."""
    mapped = given["Normal Map"]
    is_mapped = shade.math("GREATER_THAN", shade.number("LENGTH", mapped), 0.5)
    to_world = {"convert_from": "OBJECT", "convert_to": "WORLD"}
    turned = shade.node("ShaderNodeVectorTransform", {0: mapped}, vector_type="NORMAL", **to_world)
    own = shade.node("ShaderNodeNewGeometry").outputs["Normal"]
    smooth = shade.mix_vectors(is_mapped, own, turned.outputs[0])
    tilt = shade.node("ShaderNodeVectorTransform", {0: slope}, vector_type="VECTOR", **to_world)
    return shade.vector("NORMALIZE", shade.vector("SUBTRACT", smooth, tilt.outputs[0]))


def _in_haze(shade: Shading, given: dict[str, Socket], at: Place, surface: Socket) -> Socket:
    """The surface seen through air: contrast falls as exp(-3.9 d/visibility) (Koschmieder 1924)."""
    path = shade.math("DIVIDE", shade.math("MULTIPLY", at.distance, -VISIBILITY), given["Visibility"])
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


WATER = GroupKind("Ocean Tweak Water", 20, _build, "ShaderNodeTree")
