# SPDX-License-Identifier: GPL-3.0-or-later
"""Computes where an object floats from the samples of a sea, like the node groups, but without a mesh.

The sea is that of renders, whatever the viewport shows.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix, Quaternion, Vector
from numpy.typing import NDArray

from ..core.sea.query import find_points
from ..core.sea.surfaces import bilinear
from ..core.sea.waterline import fitted_plane, stencil
from ..export.exr import ExrError, read_image
from . import evaluation, float_current
from .animated import shown_settings
from .float_riding import Solved
from .floating import FloatError, Ride
from .image_sequence import SequenceError, file_of, shown_frame, since_shown
from .plan import Plan, plan_for, seconds_per_file, velocity_scale
from .settings import OceanSettings, is_ocean
from .stored_paths import image_file

RealArray = NDArray[np.float32]
Array = NDArray[np.float64]

#: minimum eigenvalue below which several sheets of the surface are looked for
_NEARLY_FOLDED = 0.1


@dataclass(frozen=True)
class Water:
    """A sea at one frame.

    displacement : (N, N, 3) [y, x], m
    spacing : of the samples, m
    come : x and y in m that a current has carried it
    """

    displacement: RealArray
    spacing: float
    come: tuple[float, float] = (0.0, 0.0)

    def carried(self, x: Array, y: Array) -> Array:
        """(points, 2) how far the water of these places at rest has gone, m."""
        values, _ = bilinear(self.displacement, None, self.spacing)(x, y, False)
        return values.value[:, :2]

    def surface(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Heights in m above places in m, and (points, 3) normals."""
        folded = _least_eigenvalue(self.displacement, self.spacing) < _NEARLY_FOLDED
        found = find_points(x, y, self.displacement, None, self.spacing, folded)
        return found.height, found.normal


def water_at(
    ocean: bpy.types.Object, scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph, frame: int
) -> Water:
    """The sea of an ocean at the scene's present frame.

    depsgraph : that includes the ocean

    Raises ParameterError, OceanObjectError or MemoryError for an ocean without a surface.
    """
    if not is_ocean(ocean):
        raise FloatError(f"{ocean.name} is no longer an ocean: its modifier was applied or removed")
    settings = shown_settings(ocean, depsgraph)
    plan = plan_for(ocean, settings, scene)
    if settings.source == "LIVE":
        displacement = evaluation.surfaces_of(plan.parameters).ocean.surface(plan.time).displacement
    else:
        displacement = _baked(settings, plan, scene, frame)
    come = float_current.come(plan.parameters.current, float(plan.time))
    return Water(displacement, plan.parameters.domain_size / len(displacement), come)


def place_on(
    water: Water, place: Matrix, ocean: Matrix, ride: Ride, metres: float, solved: Solved | None = None
) -> Matrix:
    """World rotation and location of a floating object, from its transform without waves.

    place, ocean : world matrices, Blender units
    metres : in a Blender unit
    solved : where it is if it rides damped
    """
    to_ocean = ocean.inverted_safe() @ place
    size = (to_ocean.to_3x3() @ Vector((1.0, 0.0, 0.0))).length
    middle = np.array(to_ocean.translation)[:2] * metres
    height, normal, drift = _settled(water, middle, ride, 0.5 * ride.waterline * size * metres)
    if solved is not None:
        height, normal = solved.height, _normal(solved.slope_x, solved.slope_y)
        drift = drift + np.array([solved.off_x, solved.off_y])
    level = Vector((*(middle + drift), height)) / metres
    level.z += to_ocean.translation.z if ride.keep_height else -ride.level * size
    up = _world_normal(ocean, Vector((0.0, 0.0, 1.0)))
    tilt = up.rotation_difference(_world_normal(ocean, Vector(normal)))
    turned = Quaternion().slerp(tilt, ride.tilt) @ place.to_quaternion()
    return Matrix.Translation(ocean @ level) @ turned.to_matrix().to_4x4()


def _settled(water: Water, middle: Array, ride: Ride, radius: float) -> tuple[float, Array, Array]:
    """Height in m, unit normal, and drift (x, y) in m, of a disc of this radius."""
    offsets = radius * stencil() if radius > 0.0 else np.zeros((1, 2))
    drift = np.zeros(2)
    if ride.drift != 0.0:
        gone = ride.drift * np.array(water.come)
        drift = gone + ride.drift * water.carried(*(middle + gone + offsets).T).mean(axis=0)
    heights, normals = water.surface(*(middle + drift + offsets).T)
    if not radius > 0.0:
        return float(heights[0]), normals[0], drift
    plane = fitted_plane(heights, radius)
    return float(plane.height), _normal(float(plane.slope_x), float(plane.slope_y)), drift


def _normal(slope_x: float, slope_y: float) -> Array:
    normal: Array = np.array([-slope_x, -slope_y, 1.0])
    return normal / np.linalg.norm(normal)


def _world_normal(ocean: Matrix, normal: Vector) -> Vector:
    """The ocean's normal in the world: an inverse transposed, for an ocean may be scaled."""
    turned = ocean.to_3x3().inverted_safe().transposed() @ normal
    return turned.normalized()


def _baked(settings: OceanSettings, plan: Plan, scene: bpy.types.Scene, frame: int) -> RealArray:
    """(N, N, 3) in m of the file that this frame shows, moved on by velocity where it shows none exactly."""
    image = settings.sequence_maps.disp
    if image is None:
        raise SequenceError("No image sequence is chosen: choose a baked one, or go back to live")
    shown, since = shown_frame(settings, scene, frame), since_shown(settings, scene, frame)
    moving = file_of(settings, shown, "vel") if since else None
    try:
        displacement = read_image(file_of(settings, shown) or image_file(image))[0]
        if moving is None:
            return displacement
        seconds = float(since) * seconds_per_file(settings, scene)
        factor = seconds * velocity_scale(settings, plan, scene) / plan.scale
        return displacement + np.float32(factor) * read_image(moving)[0]
    except ExrError as error:
        raise FloatError(str(error)) from error


def _least_eigenvalue(displacement: RealArray, spacing: float) -> Array:
    """(N, N) of the map from rest to surface, between neighbouring samples."""
    level = displacement[..., :2].astype(np.float64)
    by_x, by_y = ((np.roll(level, -1, axis) - level) / spacing for axis in (1, 0))
    xx, yy = 1.0 + by_x[..., 0], 1.0 + by_y[..., 1]
    xy = 0.5 * (by_x[..., 1] + by_y[..., 0])
    return 0.5 * (xx + yy) - np.hypot(0.5 * (xx - yy), xy)
