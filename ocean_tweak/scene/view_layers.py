# SPDX-License-Identifier: GPL-3.0-or-later
"""View layers: whether one shows an object, and evaluations of objects that none shows.

Blender evaluates what a view layer shows, with its dependencies. The animation of an object that is excluded
from the layer, hidden, or only in another one silently stands still.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy


def is_in_view_layer(item: bpy.types.Object, scene: bpy.types.Scene) -> bool:
    """Whether a rendered view layer contains an object of the scene, by its collections."""
    if item.name not in scene.collection.all_objects:
        return True  # an instance shows it
    return any(item.name in layer.objects for layer in scene.view_layers if layer.use)


def evaluated(scene: bpy.types.Scene) -> bpy.types.Depsgraph:
    """The evaluated scene at its present frame, in the open view layer, or its first one."""
    is_open = scene == bpy.context.scene
    depsgraph = (bpy.context.view_layer if is_open else scene.view_layers[0]).depsgraph
    depsgraph.update()
    return depsgraph


@contextmanager
def taking_part(scene: bpy.types.Scene, *items: bpy.types.Object, geometry: bool = False) -> Iterator[None]:
    """Context manager during which evaluations of the scene include settings and transforms of these objects,
    even if hidden.

    geometry : include their modifiers
    """
    followers = [_follower(item, geometry) for item in items]
    for follower in followers:
        scene.collection.objects.link(follower)  # in every view layer
    try:
        yield
    finally:
        for follower in followers:
            bpy.data.objects.remove(follower)


def _follower(item: bpy.types.Object, geometry: bool) -> bpy.types.Object:
    """An empty that depends on the object: by a constraint for its transform, by a driver for its
    settings."""
    follower = bpy.data.objects.new(f"{item.name} is evaluated", None)
    follower.constraints.new("SHRINKWRAP" if geometry else "COPY_LOCATION").target = item
    driver = follower.driver_add("empty_display_size").driver
    driver.type = "SUM"  # of no Python, which may be forbidden
    target = driver.variables.new().targets[0]
    target.id, target.data_path = item, "ocean_tweak.is_ocean"
    return follower
