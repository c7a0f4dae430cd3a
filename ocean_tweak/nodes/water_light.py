# SPDX-License-Identifier: GPL-3.0-or-later
"""Light from the water body: backscatter of water and bubbles, the bottom, and light through crests.

The body is the two-flow model of irradiance: R = 0.33 b/(a + b) over deep water (Morel & Prieur 1977; Gordon
1975), with the bottom R + (bottom - R) exp(-2(a + b) depth) (Maritorena, Morel & Gentili 1994). What of it
leaves the water is (1 - r)R/(1 - rR), r = 0.47 the share that a flat surface throws back down from below
(Saunderson 1942).

A crest between the eye and a low sun scatters its light forward, by the phase function of Blasi, Le Saëc &
Schlick (1993). Its back, as steep as its front, meets the sun at an angle. A crest is a wedge: ways through
it are as often short as long, up to a longest one that is shorter the sharper the crest is, so a mean of what
water leaves of the light comes through: (1 - exp(-a s))/(a s). What meets the front from inside partly
stays (Fresnel).
"""

from __future__ import annotations

from .building import Socket
from .names import COAST_DEPTH, CUSP
from .shading import Shading
from .water_foam import Cover, Foam
from .water_pattern import DEPTH

#: fraction of light that a flat surface reflects back down from below, and factor of the two-flow model
THROWN_BACK = 0.47
SURFACE_FACTOR = 0.33

#: bubbles of old foam relative to fresh foam
_OLD_BUBBLES = 0.55
#: how many more bubbles there are right under fresh foam, relative to those around it: water is milky there
_MILK = 5.0
#: cusps between which a crest is sharp
_SHARP = (0.12, 0.42)
#: cusps between which the sun shines through a crest: the rest of it is too thick
_THIN = (0.16, 0.52)
#: longest path of light in m through a thick and through a thin crest
_WAYS = (11.0, 2.2)
#: how much more of the light goes on forward than aside: k of the phase function
_FORWARD = 0.72
#: sine of the slope away from the sun between which light comes through
_AWAY = (0.05, 0.45)
#: share of the light on a crest's back that is scattered in it
_SCATTERED = 0.35


def coefficients(shade: Shading, given: dict[str, Socket], foam: Foam, cover: Cover) -> tuple[Socket, Socket]:
    """Absorption and backscatter per metre, with the bubbles under foam and in crests."""
    left = shade.math("MULTIPLY", cover.bubbles, shade.mix(foam.youth, _OLD_BUBBLES, 1.0))
    dense = shade.math("MULTIPLY", shade.math("POWER", cover.bubbles, 3.0), foam.youth)
    left = shade.math("MULTIPLY", left, shade.math("MULTIPLY_ADD", dense, _MILK, 1.0))
    bubbles = shade.math("MAXIMUM", left, shade.math("MULTIPLY", sharpness(shade), given["Crest Light"]))
    amount = shade.math("MULTIPLY", bubbles, given["Bubbles"])
    return given["Absorption"], shade.vector(
        "ADD", given["Backscatter"], shade.combine(amount, amount, amount)
    )


def sharpness(shade: Shading) -> Socket:
    """Sharpness of a crest, 0…1."""
    return shade.smooth(shade.value(CUSP), *_SHARP)


def body(shade: Shading, given: dict[str, Socket], absorption: Socket, backscatter: Socket) -> Socket:
    """Colour of the light that comes back out of the water."""
    lost = shade.vector("MAXIMUM", shade.vector("ADD", absorption, backscatter), (1e-9, 1e-9, 1e-9))
    deep = shade.scale(shade.vector("DIVIDE", backscatter, lost), SURFACE_FACTOR)
    # the local depth over a bed, else that of the sea
    here = shade.value(COAST_DEPTH)
    own = shade.mix(shade.math("GREATER_THAN", here, 0.0), shade.value(DEPTH, "OBJECT"), here)
    depth = shade.mix(shade.math("GREATER_THAN", given["Water Depth"], 0.0), own, given["Water Depth"])
    # a mesh that is not an ocean has no depth, and counts as deep
    depth = shade.mix(shade.math("GREATER_THAN", depth, 0.0), 1e4, depth)
    seen = _left_after(shade, lost, shade.math("MULTIPLY", depth, 2.0))
    difference = shade.vector("SUBTRACT", given["Bottom Color"], deep)
    below = shade.vector("MULTIPLY_ADD", difference, seen, deep)
    kept = shade.vector("MULTIPLY_ADD", below, (-THROWN_BACK,) * 3, (1.0,) * 3)
    return shade.vector("DIVIDE", shade.scale(below, 1.0 - THROWN_BACK), kept)


def light_through_crests(shade: Shading, given: dict[str, Socket], absorption: Socket) -> Socket:
    """Irradiance of the sun on the side of a crest that is turned away from it, through the crest."""
    x, y, high = shade.separate(_to_sun(shade, given))
    normal = shade.node("ShaderNodeNewGeometry").outputs["Normal"]
    turned_away = shade.math("MULTIPLY", shade.number("DOT_PRODUCT", normal, shade.combine(x, y)), -1.0)
    through = shade.smooth(turned_away, *_AWAY)
    # cosine of the sun's angle to the back's normal, which is the front's turned about the vertical
    met = shade.math("MULTIPLY_ADD", shade.separate(normal)[2], high, turned_away)
    met = shade.math("MAXIMUM", met, 0.0)
    thin = shade.smooth(shade.value(CUSP), *_THIN)
    share = shade.math("MULTIPLY", shade.math("MULTIPLY", through, met), thin)
    share = shade.math("MULTIPLY", share, given["Crest Glow"])
    left = _left_in_wedge(shade, absorption, shade.mix(thin, *_WAYS))
    return shade.scale(shade.vector("MULTIPLY", given["Sun Light"], left), share)


def crest_glow(shade: Shading, given: dict[str, Socket], through: Socket, normal: Socket) -> Socket:
    """Radiance towards the eye of light that comes through a crest, and out where its normal is this."""
    incoming = shade.node("ShaderNodeNewGeometry").outputs["Incoming"]
    towards = shade.math("MULTIPLY", shade.number("DOT_PRODUCT", incoming, _to_sun(shade, given)), -1.0)
    nearer = shade.math("MULTIPLY_ADD", towards, -_FORWARD, 1.0)
    phase = shade.math("DIVIDE", (1.0 - _FORWARD**2) / 12.566, shade.math("MULTIPLY", nearer, nearer))
    stays = shade.node("ShaderNodeFresnel", {"IOR": given["IOR"], "Normal": normal}).outputs[0]
    leaves = shade.math("MULTIPLY", shade.math("SUBTRACT", 1.0, stays), _SCATTERED)
    return shade.scale(through, shade.math("MULTIPLY", phase, leaves))


def _to_sun(shade: Shading, given: dict[str, Socket]) -> Socket:
    return shade.vector("NORMALIZE", given["Sun Direction"])


def _left_after(shade: Shading, lost: Socket, way: Socket) -> Socket:
    """Fraction of light that remains after a path in m, for an attenuation per metre, by colour."""
    parts = shade.separate(shade.scale(lost, shade.math("MULTIPLY", way, -1.0)))
    return shade.combine(*(shade.math("EXPONENT", part) for part in parts))


def _left_in_wedge(shade: Shading, lost: Socket, longest: Socket) -> Socket:
    """Mean of what remains after paths of all lengths up to one in m, by colour."""
    depth = shade.vector("MAXIMUM", shade.scale(lost, longest), (1e-3,) * 3)
    gone = shade.vector("SUBTRACT", (1.0,) * 3, _left_after(shade, depth, 1.0))
    return shade.vector("DIVIDE", gone, depth)
