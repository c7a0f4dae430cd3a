# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface around the camera that shows an ocean up to the horizon, instead of the ocean's own mesh."""

from __future__ import annotations

import bpy

from ..core import OceanParameters
from ..core.sea.placed_waves import repeating
from ..nodes.camera_grid import finest_spacing
from ..nodes.camera_surface import CAMERA_SURFACE, PILE_INPUT
from ..nodes.globe import EARTH_RADIUS
from ..nodes.modifier_inputs import set_inputs
from ..nodes.versioned import node_group
from . import coast_surface, patch_objects, portability, solid_foam, water_material
from .ownership import remove_with_meshes
from .plan import camera_surface_of
from .refinement import show_new
from .refresh import AROUND_CAMERA, Wanted
from .settings import OceanObjectError, is_ocean, link_beside, settings_of
from .units import metres_per_unit

__all__ = ["add_camera_surface", "camera_surface_of", "remove_camera_surface"]

_BUDGET = 200_000
_PILE = 0.025  # of foam on breaking crests, as a share of their elevation
#: cells that a ring of the surface keeps from its middle to its edge, up to the horizon of a camera at 125 m
_LEAST_CELLS = 32
_FARTHEST = 40e3  # m


def add_camera_surface(
    ocean: bpy.types.Object,
    scene: bpy.types.Scene,
    camera: bpy.types.Object | None = None,
    budget: int = _BUDGET,
) -> bpy.types.Object:
    """Show an ocean around a camera, instead of by its own mesh and its horizon.

    Both are hidden in renders. In the viewport the ocean is drawn as a box, so that it can still be selected.

    The surface is the ocean's child, in the same collections, with the same material. Near the camera it
    has two cells a sample of the ocean, or of the finest of its patches: all of its waves. Where the budget
    is too small for that and the horizon, its cells are larger, up to two a sample of the first patch.

    camera : None for the scene's active camera
    budget : largest number of vertices

    Raises OceanObjectError if the object is not an ocean.
    """
    if not is_ocean(ocean):
        raise OceanObjectError(f"{ocean.name} is not an ocean: choose one to show around the camera")
    parameters = settings_of(ocean).to_parameters(scene)
    metres = float(metres_per_unit(scene))
    name = f"{ocean.name} Camera Surface"
    surface = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    surface.parent = ocean
    link_beside(surface, ocean)
    water_material.describe_near(surface, parameters, scene)
    modifier = surface.modifiers.new(name, "NODES")
    modifier.node_group = node_group(CAMERA_SURFACE)
    inputs = {
        "Ocean": ocean,
        "Finest Spacing": _finest_spacing(parameters, budget) / metres,
        "Vertex Budget": budget,
        "Planet Radius": EARTH_RADIUS / metres,
        PILE_INPUT: _PILE,
        "Material": ocean.material_slots[0].material if ocean.material_slots else None,
    }
    set_inputs(modifier, {**inputs, "Camera": camera} if camera is not None else inputs)
    if inputs["Material"] is not None:
        solid_foam.show(surface, inputs["Material"])
    _make_room(ocean)
    # its own mesh no longer has waves that do not repeat
    own = Wanted.SURFACE if repeating(parameters) is not parameters else Wanted(0)
    show_new(ocean, scene, own | AROUND_CAMERA | Wanted.NEIGHBOURS)
    return surface


def _finest_spacing(parameters: OceanParameters, budget: int) -> float:
    """Of the surface near the camera, m."""
    first = parameters.domain_size / parameters.resolution
    finest = min((first, *(patch.spacing for patch in parameters.patches)))
    return min(finest_spacing(0.5 * finest, budget, _FARTHEST, _LEAST_CELLS), 0.5 * first)


def remove_camera_surface(ocean: bpy.types.Object) -> None:
    """Show an ocean by its own mesh and horizon again."""
    surface = camera_surface_of(ocean)
    if surface is not None:
        remove_with_meshes([surface])
    patch_objects.remove(ocean)
    portability.look_at(ocean)
    _make_room(ocean, is_there=False)


def _make_room(ocean: bpy.types.Object, is_there: bool = True) -> None:
    coast_surface.make_room(ocean)
    for child in ocean.children:
        if water_material.is_far(child):
            child.hide_render = child.hide_viewport = is_there
