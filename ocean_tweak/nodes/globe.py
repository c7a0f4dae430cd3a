# SPDX-License-Identifier: GPL-3.0-or-later
"""The globe under a surface around a camera: distance of the horizon, and curvature."""

from __future__ import annotations

from .building import Builder, Socket, output
from .fields import combined, connect, coordinates
from .sample import Spaces

EARTH_RADIUS = 6_371_000.0  # m
#: least height of the camera in m for the distance of the horizon
LEAST_HEIGHT = 2.0


def reach_of(build: Builder, eye: Socket) -> Socket:
    """The distance √(2Rh) of the horizon from an eye above the water, or the requested distance."""
    radius = build.given("Planet Radius")
    height = build.math(
        "MAXIMUM", coordinates(build, eye)[2], build.math("MULTIPLY", radius, LEAST_HEIGHT / EARTH_RADIUS)
    )
    horizon = build.math("MULTIPLY", build.math("MULTIPLY", radius, 2.0), height)
    horizon = build.math("SQRT", horizon, None)
    return build.switch("FLOAT", build.given("To Horizon"), build.given("Reach"), horizon)


def curved_normal(
    build: Builder, shape: tuple[Socket, Socket], spaces: Spaces, away: Socket
) -> tuple[Socket, Socket]:
    """Offset of the globe at a place relative to the eye, and the normal of the water on it.

    shape : slopes along x and y, and strains xx, yy and xy, of the water in the ocean's axes
    """
    drop, tilt = _curved(build, away)
    tilt_x, tilt_y, _ = coordinates(build, tilt)
    x, y, _ = coordinates(build, shape[0])
    xx, yy, shear = coordinates(build, shape[1])
    tangents = (
        combined(build, build.math("ADD", xx, 1.0), shear, build.math("ADD", x, tilt_x)),
        combined(build, shear, build.math("ADD", yy, 1.0), build.math("ADD", y, tilt_y)),
    )
    return drop, spaces.normal_of_asker(*tangents)


def _curved(build: Builder, away: Socket) -> tuple[Socket, Socket]:
    """Drop of a globe at a distance d, d²/2R, and its slopes."""
    flat = build.vector("MULTIPLY", away, (1.0, 1.0, 0.0))
    radius = build.math("MAXIMUM", build.given("Planet Radius"), 1e-3)
    amount = build.switch("FLOAT", build.given("Curvature"), 0.0, build.math("DIVIDE", -1.0, radius))
    tilt = build.scaled(flat, amount)
    square = build.add("ShaderNodeVectorMath", operation="DOT_PRODUCT")
    for socket, value in zip(square.inputs, (flat, tilt), strict=False):
        connect(build, socket, value)
    down = build.math("MULTIPLY", output(square, "Value"), 0.5)
    return combined(build, 0.0, 0.0, down), tilt
