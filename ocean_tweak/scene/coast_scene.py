# SPDX-License-Identifier: GPL-3.0-or-later
"""A ready scene with a coast: a sea over its bed, the ground above it, sky and camera."""

from __future__ import annotations

import math

import bpy
import numpy as np
from mathutils import Vector

from ..core import Coast, Raster, Timing
from ..core.waves.coast.beds import BEDS, SPACING, grid
from . import ocean_object, startup_file, water_material
from .afloat import let_float
from .beacon import new_beacon
from .camera_surface import add_camera_surface
from .ground import add_ground
from .hinterland import add_hinterland
from .moods import COASTS, VIEW
from .refresh import refresh
from .settings import VIEWPORT_RESOLUTION, settings_of
from .sheds import new_sheds
from .surroundings import Made, Wishes, new_camera, set_up
from .units import frame_rate, metres_per_unit


def build(
    scene: bpy.types.Scene, coast: str, wishes: Wishes, collection: bpy.types.Collection | None = None
) -> Made:
    """Make a coast of COASTS, with all that makes a picture of it.

    Raises what `ocean_object.add` raises; then nothing is made.
    """
    mood, target = COASTS[coast], collection or scene.collection
    shore = mood.shore
    assert shore is not None
    left = startup_file.untouched_objects(scene)
    is_empty = len(left) == len(scene.objects)
    metres = float(metres_per_unit(scene))
    parameters = mood.sea(Timing(fps=frame_rate(scene), start_frame=scene.frame_start))
    depth = Raster(-BEDS[shore.bed](*grid()), f"{mood.label} depth")
    over_bed = parameters.replace(coast=Coast(depth=depth, spacing=SPACING))
    ocean = ocean_object.add(scene, over_bed, collection=target, viewport_resolution=VIEWPORT_RESOLUTION)
    replaced = tuple(item.name for item in left)
    startup_file.remove(left)
    ground = add_ground(f"{mood.label} Ground", shore.bed, target, 1.0 / metres)
    settings_of(ocean).coast.bed = ground
    if shore.bed == "HARBOUR":
        add_hinterland(f"{mood.label} Hinterland", target, 1.0 / metres)
    way = Vector(shore.target) - Vector(shore.eye)
    view = math.atan2(way.y, way.x)
    material = water_material.water_material(mood.water)
    water_material.set_air(material, mood.sky.visibility, mood.sky.turned(view - VIEW).haze(view))
    water_material.assign(ocean, material)
    water_material.describe(ocean, parameters, scene)
    refresh(ocean, scene)
    camera = new_camera(mood, np.array(shore.eye), ocean, scene)
    camera.rotation_euler = way.to_track_quat("-Z", "Y").to_euler()
    target.objects.link(camera)
    if wishes.camera or scene.camera is None:
        scene.camera = camera
    kept = set_up(scene, mood, wishes, target, is_empty, view)
    add_camera_surface(ocean, scene, budget=mood.vertices)
    if wishes.afloat and shore.boat is not None:
        let_float("BOAT", *shore.boat, ocean, scene, target)
    for is_port, place in zip((True, False), shore.beacons, strict=False):
        beacon = new_beacon(is_port, metres)
        beacon.location = Vector(place) / metres
        target.objects.link(beacon)
    if shore.sheds:
        target.objects.link(new_sheds(shore.sheds, metres))
    return Made(ocean, camera, kept, replaced)
