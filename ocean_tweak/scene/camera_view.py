# SPDX-License-Identifier: GPL-3.0-or-later
"""The view of a camera over an ocean."""

from __future__ import annotations

import math

import bpy
import numpy as np
from mathutils import Matrix

from ..core.sea.foam_fan import View
from ..nodes.globe import LEAST_HEIGHT
from ..nodes.modifier_inputs import get_input
from .plan import camera_matrix, camera_of, surface_modifier

#: height in m above which a camera counts as aerial; lower ones are among the waves, which come as near as
# that
AERIAL, _NEAR = 20.0, 5.0
#: rad below the horizon, between which the lowest line of sight is for a fan to be before the camera
_LOWEST = math.radians(2.0), math.radians(60.0)
#: rad, of the picture to each side at the most
_WIDEST = math.radians(100.0)
#: places along each side of the picture that are looked at
_ALONG = 9


def view_of(surface: bpy.types.Object, scene: bpy.types.Scene, scale: float) -> View | None:
    """The view of a surface's camera over the water at rest, in m, in the ocean's space.

    None for a camera that looks down or up, or is not perspective.

    scale : Blender units in a metre
    """
    camera = camera_of(surface, scene)
    if camera.type != "CAMERA" or camera.data.type != "PERSP":
        return None
    matrix = surface.parent.matrix_world.inverted_safe() @ camera_matrix(surface, scene)
    x, y, height = matrix.translation / scale
    sight = _sight(camera, matrix, scene)
    lowest = math.asin(-min(sight[:, 2].min(), 0.0))
    is_low = height < AERIAL
    if lowest > _LOWEST[1] or (lowest < _LOWEST[0] and not is_low):
        return None
    middle = sight.mean(axis=0)
    azimuth = math.atan2(middle[1], middle[0])
    # crests rise above the horizon of a camera among them
    on_water = sight if is_low else sight[sight[:, 2] <= 0.0]
    aside = np.angle((on_water[:, 0] + 1j * on_water[:, 1]) * np.exp(-1j * azimuth))
    half_angle = float(np.abs(aside).max())
    if half_angle > _WIDEST:
        return None
    near = _NEAR if is_low else height / math.tan(lowest)
    reach = _reach(surface, max(height, LEAST_HEIGHT), scale)
    return View(x, y, near, azimuth, half_angle, reach, is_low)


def _sight(camera: bpy.types.Object, matrix: Matrix, scene: bpy.types.Scene) -> np.ndarray:
    """(lines, 3) unit vectors through the edge of the picture."""
    corners = np.array(camera.data.view_frame(scene=scene))
    share = np.linspace(0.0, 1.0, _ALONG, endpoint=False)[:, np.newaxis]
    edge = np.concatenate(
        [a + share * (b - a) for a, b in zip(corners, np.roll(corners, -1, 0), strict=True)]
    )
    lines = edge @ np.array(matrix.to_3x3().normalized()).T
    return np.asarray(lines / np.linalg.norm(lines, axis=1, keepdims=True))


def _reach(surface: bpy.types.Object, height: float, scale: float) -> float:
    """As far as the surface is asked to go, m: to the horizon, √(2Rh), or what is given instead."""
    modifier = surface_modifier(surface)
    if not get_input(modifier, "To Horizon"):
        return float(get_input(modifier, "Reach") / scale)
    return math.sqrt(2.0 * height * get_input(modifier, "Planet Radius") / scale)
