# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam on the water: where it covers, how thick it is, and how it shades.

The ocean says which share F of the water is white, and how old that foam is; laces of several sizes say
where. Foam is what all laces leave: the holes of each are cut out of the others. A lace of weight a covers
F^a; weights add up to 1 and laces are independent, so together they cover F, whatever the age. Age moves
weight from small cells to large ones, and from 7 Beaufort on to cells that the wind has drawn out: holes
grow. A lace whose cells are below a pixel fades into its mean F^a (as in Dupuy and Bruneton 2012), so F stays
with the distance.
"""

from __future__ import annotations

from typing import NamedTuple

from .building import Socket
from .names import BREAKING, FOAM, FOAM_AGE
from .shading import Shading
from .water_pattern import WIND_SPEED, Lace, Place, lace

#: laces: length of their cells in Foam Sizes, turn away from the wind in rad, and how much narrower they are
#: across; three for foam as it was made, and two for what the wind has drawn out
_LACES = ((0.04, 0.7, 1), (0.17, 0.15, 2), (0.5, -0.4, 1), (0.7, 0.04, 3), (1.5, 0.0, 5))
#: weights of the laces: of foam that is being made, of some seconds, old, and old in streaks
_FRESH = (0.48, 0.44, 0.08, 0.0, 0.0)
_YOUNG = (0.35, 0.45, 0.20, 0.0, 0.0)
_OLD = (0.12, 0.28, 0.60, 0.0, 0.0)
_DRAWN_OUT = (0.10, 0.14, 0.05, 0.33, 0.38)
_YOUTH = 0.8  # s, in which foam loses half of what it had while it was made
_BREAKS = 0.2  # strength of breaking from which foam is new
_GROWTH = (0.5, 9.0)  # s, between which holes grow
_FADING = 2.5  # s, half-life of foam that says nothing of its age
_STREAKS = (
    13.9,
    20.8,
)  # m/s: from 7 Beaufort on old foam begins to lie in streaks, at 9 all of it does (WMO)
#: width of a lace's rim as a share of its heights, of old and of fresh foam
_RIM = (0.14, 0.07)
#: cells in a pixel's footprint from which a lace begins to fade, and with which it is its mean
_FADE = (0.5, 2.0)
#: height of a pile of fresh foam in cells, and what old foam has of it
_PILE, _FLAT = 0.4, 0.12
#: light that fresh piles keep from themselves, a cell of height; measured under an even sky
_SHADOW = 0.37
#: brightness of a rim, which is thin and wet, of old and of fresh foam
_RIM_LIGHT = (0.62, 0.92)


class Foam(NamedTuple):
    """White water at a point.

    share : 0…1, of the water that is white
    youth : 1 where foam is being made, towards 0 with age
    age : s
    """

    share: Socket
    youth: Socket
    age: Socket


class Cover(NamedTuple):
    """Foam as it is drawn.

    amount : 0…1, how much of the point is covered
    light : 0…1, what rims and creases, and piles too small to be seen, leave of its brightness
    slope : of its piles, along the ocean's x and y
    """

    amount: Socket
    light: Socket
    slope: Socket


def foam_at(shade: Shading, given: dict[str, Socket]) -> Foam:
    """What the mesh says of foam.

    Foam whose age is not told (an older bake, one without the map) has the age that has thinned it out.
    """
    own = shade.math("MULTIPLY", shade.value(FOAM), given["Foam Amount"])
    share = shade.math("MAXIMUM", own, given["Foam Map"], clamp=True)
    told = shade.value(FOAM_AGE)
    halvings = shade.math("LOGARITHM", shade.math("MAXIMUM", share, 1e-3), 0.5)
    is_told = shade.math("GREATER_THAN", told, 0.0)
    age = shade.mix(is_told, shade.math("MULTIPLY", halvings, _FADING), told)
    by_age = shade.math("POWER", 0.5, shade.math("DIVIDE", age, _YOUTH))
    by_birth = shade.smooth(shade.value(BREAKING), 0.0, _BREAKS)
    return Foam(share, shade.math("MAXIMUM", by_age, by_birth), age)


def foam_cover(shade: Shading, given: dict[str, Socket], at: Place, foam: Foam) -> Cover:
    """Foam with its laces."""
    rim = shade.mix(foam.youth, *_RIM)
    high = shade.math("MULTIPLY", shade.mix(foam.youth, _PILE * _FLAT, _PILE), given["Foam Relief"])
    amount: Socket | float = 1.0
    thickness: Socket | float = 0.0
    unseen: Socket | float = 0.0
    slope: Socket | tuple[float, float, float] = (0.0, 0.0, 0.0)
    for weight, (size, turn, stretch) in zip(_weights(shade, given, foam), _LACES, strict=True):
        cell = shade.math("MULTIPLY", given["Foam Size"], size)
        layer = lace(shade, at, cell, turn, stretch)
        share = shade.math("POWER", foam.share, weight)
        cells = shade.math("DIVIDE", shade.math("MULTIPLY", at.footprint, float(stretch)), cell)
        far = shade.smooth(cells, *_FADE)
        hidden = shade.math("MULTIPLY", weight, far)
        amount = shade.math("MULTIPLY", amount, _covered(shade, layer, share, rim, far))
        depth = _depth(shade, layer, share, foam.youth, far)
        thickness = shade.math("MULTIPLY_ADD", depth, weight, thickness)
        pile = _pile(shade, layer, share, foam.youth, shade.math("SUBTRACT", weight, hidden))
        slope = shade.vector("ADD", slope, pile)
        unseen = shade.math("ADD", unseen, hidden)
    # heights between samples may be a little below 0
    has_any = shade.math("GREATER_THAN", foam.share, 1e-4)
    shadow = shade.math("MULTIPLY", shade.math("MULTIPLY", unseen, foam.youth), -_SHADOW)
    light = shade.mix(thickness, shade.mix(foam.youth, *_RIM_LIGHT), 1.0)
    return Cover(
        amount=shade.math("MULTIPLY", amount, has_any),
        light=shade.math("MULTIPLY", light, shade.math("MULTIPLY_ADD", shadow, high, 1.0, clamp=True)),
        slope=shade.scale(slope, high),
    )


def _weights(shade: Shading, given: dict[str, Socket], foam: Foam) -> tuple[Socket, ...]:
    """Of each lace; their sum is 1."""
    by_wind = shade.smooth(shade.value(WIND_SPEED, "OBJECT"), *_STREAKS)
    asked = given["Foam Streaks"]
    streaks = shade.mix(shade.math("LESS_THAN", asked, 0.0), asked, by_wind)
    grown = shade.smooth(foam.age, *_GROWTH)
    weights = []
    for part in (slice(0, 3), slice(2, 5)):
        old = shade.mix_vectors(streaks, _OLD[part], _DRAWN_OUT[part])
        aged = shade.mix_vectors(grown, _YOUNG[part], old)
        weights.append(shade.separate(shade.mix_vectors(foam.youth, aged, _FRESH[part])))
    return *weights[0], *weights[1][1:]


def _covered(shade: Shading, layer: Lace, share: Socket, rim: Socket, far: Socket) -> Socket:
    """How much a lace leaves at a point; in the mean the share, as its rim is as wide to both sides of it."""
    room = shade.math("MINIMUM", share, shade.math("SUBTRACT", 1.0, share))
    half = shade.math("MAXIMUM", shade.math("MINIMUM", rim, room), 1e-3)
    outer, inner = shade.math("ADD", share, half), shade.math("SUBTRACT", share, half)
    return shade.mix(far, shade.smooth(layer.height, inner, outer, 1.0, 0.0), share)


def _depth(shade: Shading, layer: Lace, share: Socket, youth: Socket, far: Socket) -> Socket:
    """How much foam lies above a point, 0…1; one half in the mean where there is any.

    Old foam is highest along its walls, and fresh foam billows between them.
    """
    risen = shade.math("DIVIDE", layer.height, shade.math("MAXIMUM", share, 1e-3), clamp=True)
    near = shade.mix(youth, shade.math("SUBTRACT", 1.0, risen), risen)
    return shade.mix(far, near, 0.5)


def _pile(shade: Shading, layer: Lace, share: Socket, youth: Socket, weight: Socket) -> Socket:
    """Slope of foam that is flat where it is highest.

    By the lace's height r in its share, old foam is 1 - r² high, and fresh foam 1 - (1 - r)².
    """
    risen = shade.math("DIVIDE", layer.height, shade.math("MAXIMUM", share, 0.05), clamp=True)
    inside = shade.math("MULTIPLY", shade.math("LESS_THAN", risen, 1.0), 2.0)
    steep = shade.math("SUBTRACT", youth, risen)
    return shade.scale(layer.slope, shade.math("MULTIPLY", shade.math("MULTIPLY", steep, inside), weight))


def foam_shader(shade: Shading, given: dict[str, Socket], cover: Cover, normal: Socket) -> Socket:
    """Bubbles scatter all light that meets them; a thin, wet rim keeps some."""
    inputs = {
        "Base Color": shade.scale(given["Foam Color"], cover.light), "Roughness": given["Foam Roughness"],
        "IOR": given["IOR"], "Normal": normal,
    }  # fmt: skip
    return shade.node("ShaderNodeBsdfPrincipled", inputs).outputs[0]
