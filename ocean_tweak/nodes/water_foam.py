# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam on the water: where it covers, how thick it is, and how it shades.

The ocean says which share F of the water is white, and how old that foam is; laces of several sizes, and
billows in what is fresh, say where. A lace is normally distributed over the water. Independent laces of the
variances v, which add up to 1, have a normally distributed sum S, and foam covers where S is below the normal
quantile of F: it covers F, whatever the variances. Age moves variance from small cells to large ones, and
from 7 Beaufort on to cells that the wind has drawn out: holes grow. A lace whose cells are below a pixel
counts by its variance alone: of S, whose seen part is s and whose unseen part has the variance u, a share
Φ((Φ⁻¹(F) - s)/√u) of the pixel is covered (as Dupuy and Bruneton 2012 do with slopes), so F stays with the
distance.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from .building import Socket
from .names import BREAKING, FOAM, FOAM_AGE
from .shading import Shading
from .water_pattern import WIND_SPEED, Lace, Place, billow, lace

#: laces: length of their cells in Foam Sizes, turn away from the wind in rad, and how much narrower they are
#: across; four for foam as it was made, and two of threads that the wind has drawn out
_LACES = ((0.013, 1.1, 1), (0.04, 0.7, 1), (0.12, 0.3, 1), (0.35, -0.4, 1), (1.0, 0.04, 12), (4.0, 0.0, 24))
#: variances of the laces: of foam that is being made, of some seconds and old; and in a wind that draws it
#: out, down the crests' fronts while it is young
_FRESH = (0.12, 0.14, 0.08, 0.16, 0.0, 0.0)
#: variance of the billows of foam that is being made, so that all are 1; length of the largest in Foam Sizes,
#: turn away from the wind in rad
_BILLOWS, _BILLOW_SIZE, _BILLOW_TURN = 0.5, 0.07, 0.6
_YOUNG, _OLD = (0.02, 0.09, 0.36, 0.53, 0.0, 0.0), (0.01, 0.04, 0.18, 0.77, 0.0, 0.0)
_SPILLED, _DRAWN_OUT = (0.05, 0.12, 0.20, 0.15, 0.32, 0.16), (0.03, 0.09, 0.17, 0.12, 0.32, 0.27)
#: a vector has three numbers
_HALVES = (slice(0, 3), slice(3, 6))
_YOUTH = 0.8  # s, in which foam loses half of what it had while it was made
_BREAKS = 0.2  # strength of breaking from which foam is new
_GROWTH = (0.5, 9.0)  # s, between which holes grow
_FADING = 2.5  # s, half-life of foam that says nothing of its age
#: m/s: from 7 Beaufort on old foam begins to lie in streaks, at 9 all of it does (WMO)
_STREAKS = (13.9, 20.8)
#: standard deviation of what softens the rims of old foam, which is thin, and of fresh foam
_SOFT = (0.20, 0.25)
#: cells in a pixel's footprint from which a lace begins to fade, and with which it is its mean
_FADE = (0.25, 1.0)
#: Φ(x) = 1/(1 + exp(-ax - bx³)), wrong by 1.4e-4 at most (Page 1977)
_PAGE = (1.5976, 0.070566)
#: optical thickness of foam, a standard deviation of the laces inside its rim: over _GROWTH of age; and fresh
#: where the crest breaks weakly and strongly, which it does from _STRONG on
_THICK_OLD, _THICK_FRESH, _STRONG = (2.6, 0.5), (2.4, 8.0), (0.1, 0.7)
#: what of the thickness is left where the wind draws foam out
_TORN = 0.8
#: of the logarithm of the thickness, for a grain of 1; of old and of fresh foam
_UNEVEN = (-1.0, -1.0)
#: relative variance of how deep inside their rims the points of a pixel are, where no lace is seen
_DEEP = 0.57
#: relative variance of a gamma distribution that lets as much light through as one of the variance 1 whose
#: logarithm is normal; fitted
_AS_GAMMA = 0.55
#: weights of the laces in the grain of foam, whose variance is 1: of fresh foam, and of old as it was made
#: and drawn out. Some count the other way than in the cover, so that foam is not thickest in its middle
_FRESH_GRAIN, _BILLOW_GRAIN = (0.40, 0.40, -0.34, 0.24, 0.0, 0.0), -0.71
_GRAIN, _DRAWN_GRAIN = (0.40, 0.55, 0.50, -0.53, 0.0, 0.0), (0.35, 0.5, 0.45, -0.45, -0.35, 0.3)
#: from a rim inwards, in standard deviations of the laces: how far the slope of foam reaches
_SLOPING = 0.6
#: height of foam at its rim in cells, of old and of fresh foam; and what of their slope billows have, as
#: foam scatters light within, which fills its shades
_EDGE, _BILLOW = (0.035, 0.04), 0.5
#: light that creases of fresh foam keep from themselves, and of piles that are too small to be seen
_CREASED, _SHADOW = 0.5, 0.14
#: colour of light in the deepest of them: where it has met more foam, it has also met more water
_IN_SHADE = (0.80, 0.92, 1.0)
#: from a rim outwards, in standard deviations of the laces: where water is shaded by foam, and how much
_BESIDE, _SHADED = 0.25, (0.08, 0.4)
#: of light from behind, what foam of the optical thickness 9 lets through evenly: 1/(1 + ¾(1 - g)τ) with g =
#: 0.85, the two-flow model of a layer that absorbs nothing
_THROUGH = 0.5
#: how far bubbles reach beyond the foam above them, and how softly, in standard deviations of the laces
_HALO, _HALO_SOFT = 0.7, 0.6


class Foam(NamedTuple):
    """White water at a point.

    share : 0…1, of the water that is white
    youth : 1 where foam is being made, towards 0 with age
    age : s
    breaking : 0…1, how strongly the crest breaks
    streaks : 0…1, how far the wind draws it out
    """

    share: Socket
    youth: Socket
    age: Socket
    breaking: Socket
    streaks: Socket


class Cover(NamedTuple):
    """Foam as it is drawn.

    amount : 0…1, how much of the point is covered
    density : 0…1, how much of the water under it it hides
    light : 0…1, what creases, and piles too small to be seen, leave of its brightness
    shaded : 0…1, how much of the light on water beside it it keeps away
    slope : of its piles, along the ocean's x and y
    bubbles : 0…1, of those in the water below, which reach beyond it
    """

    amount: Socket
    density: Socket
    light: Socket
    shaded: Socket
    slope: Socket
    bubbles: Socket


def foam_at(shade: Shading, given: dict[str, Socket]) -> Foam:
    """What the mesh says of foam.

    Foam whose age is not told (an older bake, or a collar's beyond the mesh's own) has the age
    that has thinned it out.
    """
    own = shade.math("MULTIPLY", shade.value(FOAM), given["Foam Amount"])
    share = shade.math("MAXIMUM", own, given["Foam Map"], clamp=True)
    told = shade.value(FOAM_AGE)
    halvings = shade.math("LOGARITHM", shade.math("MAXIMUM", share, 1e-3), 0.5)
    is_told = shade.math("GREATER_THAN", told, 0.0)
    meshes = shade.math("DIVIDE", own, shade.math("MAXIMUM", share, 1e-3))
    is_told = shade.math("MULTIPLY", is_told, meshes, clamp=True)
    age = shade.mix(is_told, shade.math("MULTIPLY", halvings, _FADING), told)
    by_age = shade.math("POWER", 0.5, shade.math("DIVIDE", age, _YOUTH))
    breaking = shade.value(BREAKING)
    by_birth = shade.smooth(breaking, 0.0, _BREAKS)
    youth = shade.math("MAXIMUM", by_age, by_birth)
    return Foam(share, youth, age, breaking, _streaks(shade, given))


class _Laid(NamedTuple):
    """All laces at a point.

    height : sum of what is seen of them
    slope : of that, over the size of their cells
    unseen : variance of the rest
    grain : sum of what is seen by other weights
    grain_unseen : variance of the rest of that
    billows : what is seen of them
    """

    height: Socket
    slope: Socket
    unseen: Socket
    grain: Socket
    grain_unseen: Socket
    billows: Lace


def foam_cover(shade: Shading, given: dict[str, Socket], at: Place, foam: Foam) -> Cover:
    """Foam with its laces."""
    laid = _laid(shade, given, at, foam)
    soft = shade.mix(foam.youth, *(value**2 for value in _SOFT))
    kept = shade.math("SUBTRACT", 1.0, soft)
    height = shade.math("MULTIPLY", laid.height, shade.math("SQRT", kept))
    inwards = shade.math("SUBTRACT", _quantile(shade, foam.share), height)
    spread = shade.math("SQRT", shade.math("MULTIPLY_ADD", laid.unseen, kept, soft))
    ratio = shade.math("DIVIDE", inwards, spread)
    amount = _normal_share(shade, ratio)
    depth = _depth(shade, inwards, spread, ratio, amount)
    # a share of 0 has no quantile, and heights between samples may be a little below 0
    has_any = shade.math("GREATER_THAN", foam.share, 1e-4)
    return Cover(
        amount=shade.math("MULTIPLY", amount, has_any),
        density=_density(shade, foam, laid, depth),
        light=_light(shade, foam, laid),
        shaded=shade.math("MULTIPLY", _shaded(shade, foam, laid, inwards), has_any),
        slope=_relief(shade, given, foam, laid, inwards),
        bubbles=shade.math("MULTIPLY", _bubbles(shade, laid, kept, inwards), has_any),
    )


def _depth(shade: Shading, inwards: Socket, spread: Socket, ratio: Socket, amount: Socket) -> Socket:
    """Mean of how deep inside its rim foam lies where it covers, in standard deviations of the laces.

    Of a normal distribution of the mean m and the deviation s, what is above 0 has the mean
    m + s φ(m/s)/Φ(m/s).
    """
    square = shade.math("MULTIPLY", shade.math("MULTIPLY", ratio, ratio), -0.5)
    bell = shade.math("MULTIPLY", shade.math("EXPONENT", square), 1.0 / math.sqrt(2.0 * math.pi))
    hazard = shade.math("DIVIDE", bell, shade.math("MAXIMUM", amount, 1e-5))
    return shade.math("MAXIMUM", shade.math("MULTIPLY_ADD", spread, hazard, inwards), 0.0)


def _bubbles(shade: Shading, laid: _Laid, kept: Socket, inwards: Socket) -> Socket:
    """As foam that covers a little more, with rims that are softer."""
    spread = shade.math("SQRT", shade.math("MULTIPLY_ADD", laid.unseen, kept, _HALO_SOFT**2))
    return _normal_share(shade, shade.math("DIVIDE", shade.math("ADD", inwards, _HALO), spread))


def _laid(shade: Shading, given: dict[str, Socket], at: Place, foam: Foam) -> _Laid:
    height: Socket | float = 0.0
    unseen: Socket | float = 0.0
    slope: Socket | tuple[float, float, float] = (0.0, 0.0, 0.0)
    grain: Socket | float = 0.0
    grain_unseen: Socket | float = 0.0
    variances = _variances(shade, foam)
    weights = _weights(shade, foam)
    for number, (size, turn, stretch) in enumerate(_LACES):
        variance = variances[number]
        cell = shade.math("MULTIPLY", given["Foam Size"], size)
        layer = lace(shade, at, cell, turn, stretch)
        cells = shade.math("DIVIDE", shade.math("MULTIPLY", at.footprint, float(stretch)), cell)
        fading = shade.smooth(cells, *_FADE)
        hidden = shade.math("MULTIPLY", variance, fading)
        weight = shade.math("SQRT", shade.math("SUBTRACT", variance, hidden))
        height = shade.math("MULTIPLY_ADD", layer.height, weight, height)
        slope = shade.vector("ADD", slope, shade.scale(layer.slope, weight))
        unseen = shade.math("ADD", unseen, hidden)
        seen = shade.math("MULTIPLY", weights[number], shade.math("SUBTRACT", 1.0, fading))
        grain = shade.math("MULTIPLY_ADD", layer.height, seen, grain)
        grain_unseen = shade.math("MULTIPLY_ADD", weights[number], weights[number], grain_unseen)
        grain_unseen = shade.math("SUBTRACT", grain_unseen, shade.math("MULTIPLY", seen, seen))
    shown, hidden = _billows(shade, given, at)
    # foam covers where the sum is low, on domes first, and is thick where the grain is low
    variance, heavy = (shade.math("MULTIPLY", foam.youth, each) for each in (_BILLOWS, _BILLOW_GRAIN))
    weight = shade.math("MULTIPLY", shade.math("SQRT", variance), -1.0)
    height = shade.math("MULTIPLY_ADD", shown.height, weight, height)
    unseen = shade.math("MULTIPLY_ADD", variance, hidden, unseen)
    grain = shade.math("MULTIPLY_ADD", shown.height, heavy, grain)
    square = shade.math("MULTIPLY", heavy, heavy)
    grain_unseen = shade.math("MULTIPLY_ADD", square, hidden, grain_unseen)
    return _Laid(height, slope, unseen, grain, grain_unseen, shown)


def _billows(shade: Shading, given: dict[str, Socket], at: Place) -> tuple[Lace, Socket]:
    """What is seen of the billows, and the variance of the rest."""
    cell = shade.math("MULTIPLY", given["Foam Size"], _BILLOW_SIZE)
    whole = billow(shade, at, cell, _BILLOW_TURN)
    kept = shade.smooth(shade.math("DIVIDE", at.footprint, cell), *_FADE, 1.0, 0.0)
    shown = Lace(shade.math("MULTIPLY", whole.height, kept), shade.scale(whole.slope, kept))
    return shown, shade.math("SUBTRACT", 1.0, shade.math("MULTIPLY", kept, kept))


def _streaks(shade: Shading, given: dict[str, Socket]) -> Socket:
    """0…1, how far old foam is drawn out along the wind."""
    by_wind = shade.smooth(shade.value(WIND_SPEED, "OBJECT"), *_STREAKS)
    asked = given["Foam Streaks"]
    return shade.mix(shade.math("LESS_THAN", asked, 0.0), asked, by_wind)


def _variances(shade: Shading, foam: Foam) -> tuple[Socket, ...]:
    """Of each lace; their sum is 1."""
    grown = shade.smooth(foam.age, *_GROWTH)
    variances: list[Socket] = []
    for part in _HALVES:
        young = shade.mix_vectors(foam.streaks, _YOUNG[part], _SPILLED[part])
        old = shade.mix_vectors(foam.streaks, _OLD[part], _DRAWN_OUT[part])
        aged = shade.mix_vectors(grown, young, old)
        variances += shade.separate(shade.mix_vectors(foam.youth, aged, _FRESH[part]))
    return tuple(variances)


def _weights(shade: Shading, foam: Foam) -> tuple[Socket, ...]:
    """Of each lace in the grain."""
    weights: list[Socket] = []
    for part in _HALVES:
        old = shade.mix_vectors(foam.streaks, _GRAIN[part], _DRAWN_GRAIN[part])
        weights += shade.separate(shade.mix_vectors(foam.youth, old, _FRESH_GRAIN[part]))
    return tuple(weights)


def _normal_share(shade: Shading, value: Socket) -> Socket:
    """Share of a normal distribution that lies below a value, Φ."""
    a, b = _PAGE
    held = shade.math("MAXIMUM", shade.math("MINIMUM", value, 9.0), -9.0)
    steep = shade.math("MULTIPLY_ADD", shade.math("MULTIPLY", held, held), -b, -a)
    return shade.math(
        "DIVIDE", 1.0, shade.math("ADD", shade.math("EXPONENT", shade.math("MULTIPLY", held, steep)), 1.0)
    )


def _quantile(shade: Shading, share: Socket) -> Socket:
    """The value below which a share of a normal distribution lies: where ax + bx³ = ln(F/(1 - F)).

    x = 2√(a/3b) sinh(asinh(y)/3) with y = 3/(2a) √(3b/a) ln(F/(1 - F)).
    """
    a, b = _PAGE
    held = shade.math("MAXIMUM", shade.math("MINIMUM", share, 1.0 - 1e-4), 1e-5)
    odds = shade.math("DIVIDE", held, shade.math("SUBTRACT", 1.0, held))
    y = shade.math("MULTIPLY", shade.math("LOGARITHM", odds, math.e), 1.5 / a * math.sqrt(3.0 * b / a))
    root = shade.math("SQRT", shade.math("MULTIPLY_ADD", y, y, 1.0))
    third = shade.math("MULTIPLY", shade.math("LOGARITHM", shade.math("ADD", y, root), math.e), 1.0 / 3.0)
    return shade.math("MULTIPLY", shade.math("SINH", third), 2.0 * math.sqrt(a / (3.0 * b)))


def _density(shade: Shading, foam: Foam, laid: _Laid, depth: Socket) -> Socket:
    """How much of the light foam keeps from the water: by Beer and Lambert's law, of a thickness that grows
    inwards from nothing, and varies: its logarithm is normally distributed.

    Thickness that is too small to be seen counts as if it had a gamma distribution, of the relative
    variance v, by which exp(-t) becomes (1 + vt)^(-1/v) in the mean (Barker 1996).
    """
    old = shade.smooth(foam.age, *_GROWTH, *_THICK_OLD)
    fresh = shade.smooth(foam.breaking, *_STRONG, *_THICK_FRESH)
    thick = shade.math("MULTIPLY", shade.mix(foam.youth, old, fresh), shade.mix(foam.streaks, 1.0, _TORN))
    uneven = shade.mix(foam.youth, *_UNEVEN)
    hidden = shade.math("MULTIPLY", shade.math("MULTIPLY", uneven, uneven), laid.grain_unseen)
    grown = shade.math("MULTIPLY_ADD", hidden, 0.5, shade.math("MULTIPLY", laid.grain, uneven))
    thick = shade.math("MULTIPLY", shade.math("MULTIPLY", thick, shade.math("EXPONENT", grown)), depth)
    spread = shade.math("SUBTRACT", shade.math("EXPONENT", hidden), 1.0)
    spread = shade.math("MULTIPLY_ADD", laid.unseen, _DEEP, spread)
    variance = shade.math("MULTIPLY_ADD", spread, _AS_GAMMA, 0.02)
    base = shade.math("MULTIPLY_ADD", variance, thick, 1.0)
    through = shade.math("POWER", base, shade.math("DIVIDE", -1.0, variance))
    return shade.math("SUBTRACT", 1.0, through)


def _light(shade: Shading, foam: Foam, laid: _Laid) -> Socket:
    """What is left of the brightness: fresh foam has deep creases between its billows."""
    creased = shade.smooth(laid.billows.height, 0.5, -2.4, 0.0, _CREASED)
    lost = shade.mix(laid.unseen, creased, _SHADOW)
    return shade.math("MULTIPLY_ADD", lost, shade.math("MULTIPLY", foam.youth, -1.0), 1.0)


def _shaded(shade: Shading, foam: Foam, laid: _Laid, inwards: Socket) -> Socket:
    """Water beside foam that is piled up lies in its shade."""
    part = shade.math("DIVIDE", inwards, _BESIDE)
    bell = shade.math("EXPONENT", shade.math("MULTIPLY", shade.math("MULTIPLY", part, part), -1.0))
    seen = shade.math("MULTIPLY", bell, shade.math("SUBTRACT", 1.0, laid.unseen))
    return shade.math("MULTIPLY", seen, shade.mix(foam.youth, *_SHADED))


def _relief(shade: Shading, given: dict[str, Socket], foam: Foam, laid: _Laid, inwards: Socket) -> Socket:
    """Slope of foam: it falls off towards its rim, where laces rise, and fresh foam billows within."""
    part = shade.math("DIVIDE", inwards, _SLOPING)
    bell = shade.math("EXPONENT", shade.math("MULTIPLY", shade.math("MULTIPLY", part, part), -1.0))
    edge = shade.math("MULTIPLY", bell, shade.mix(foam.youth, *_EDGE))
    falls = shade.scale(laid.slope, shade.math("MULTIPLY", edge, -1.0))
    piled = shade.math("MULTIPLY", foam.youth, shade.smooth(inwards, -0.2, _SLOPING, 0.0, _BILLOW))
    slope = shade.vector("ADD", falls, shade.scale(laid.billows.slope, piled))
    return shade.scale(slope, given["Foam Relief"])


def foam_shader(
    shade: Shading, given: dict[str, Socket], cover: Cover, normal: Socket, behind: Socket
) -> Socket:
    """Bubbles scatter all light that meets them, also what comes through a crest from behind."""
    left = shade.scale(given["Foam Color"], cover.light)
    through = shade.scale(shade.vector("MULTIPLY", left, behind), _THROUGH / math.pi)
    colour = shade.vector("MULTIPLY", left, shade.mix_vectors(cover.light, _IN_SHADE, (1.0,) * 3))
    inputs = {
        "Base Color": colour, "Roughness": given["Foam Roughness"],
        "IOR": given["IOR"], "Normal": normal, "Emission Color": through, "Emission Strength": 1.0,
    }  # fmt: skip
    return shade.node("ShaderNodeBsdfPrincipled", inputs).outputs[0]
