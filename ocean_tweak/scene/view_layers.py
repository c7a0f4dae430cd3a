# SPDX-License-Identifier: GPL-3.0-or-later
"""View layers: whether one shows an object, and evaluations of objects that none shows.

Blender evaluates what a view layer shows, and what that needs. Of an object that is excluded from the layer,
hidden, or only in another one, animation stands still, without a word.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy


def is_in_view_layer(item: bpy.types.Object, scene: bpy.types.Scene) -> bool:
    """Whether a view layer that is rendered has an object of the scene, as far as collections say."""
    if item.name not in scene.collection.all_objects:
        return True  # an instance shows it
    return any(item.name in layer.objects for layer in scene.view_layers if layer.use)


def evaluated(scene: bpy.types.Scene) -> bpy.types.Depsgraph:
    """The scene at its present frame, in the view layer that is open, or else its first."""
    is_open = scene == bpy.context.scene
    depsgraph = (bpy.context.view_layer if is_open else scene.view_layers[0]).depsgraph
    depsgraph.update()
    return depsgraph


@contextmanager
def taking_part(scene: bpy.types.Scene, *items: bpy.types.Object, geometry: bool = False) -> Iterator[None]:
    """While this is open, evaluations of the scene have settings and place of these objects at every frame,
    whatever hides them.

    geometry : also what their modifiers make
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
    """An empty that needs the object: for its place a constraint, for its settings a driver."""
    follower = bpy.data.objects.new(f"{item.name} is evaluated", None)
    follower.constraints.new("SHRINKWRAP" if geometry else "COPY_LOCATION").target = item
    driver = follower.driver_add("empty_display_size").driver
    driver.type = "SUM"  # of no Python, which may be forbidden
    target = driver.variables.new().targets[0]
    target.id, target.data_path = item, "ocean_tweak.is_ocean"
    return follower
