# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh that shows an ocean over its bed, in the place of the ocean's own: fine near the shore."""

from __future__ import annotations

import math
from collections.abc import Callable

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import Ocean, OceanParameters
from ..core.sea.over_bed import OVER_BED_CHANNELS, mesh_over_bed, over_bed
from ..core.synthesis.channels import CHANNELS
from ..core.waves.coast.mesh import CoastMesh
from ..nodes.held import COAST
from ..nodes.names import COAST_DEPTH, TEXTURE_COORDINATES
from . import bed_points, held_sea, vertex_attributes, water_material, wet_bed
from .ownership import remove_with_meshes
from .plan import Plan, camera_surface_of, sea_over_bed
from .settings import OceanObjectError, all_oceans, link_beside

Array = NDArray[np.float64]

_COAST = "ocean_tweak_coast"
#: of an ocean that another mesh shows: its own Render and Display As
_SHOWN_AS = "ocean_tweak_shown_as"
_USUALLY = {"hide_render": False, "display_type": "TEXTURED"}


def coast_of(ocean: bpy.types.Object) -> bpy.types.Object | None:
    """The mesh that shows an ocean over its bed; None where there is none."""
    return next((child for child in ocean.children if is_ours(child)), None)


def is_ours(item: bpy.types.Object) -> bool:
    """Whether an object is the mesh over a bed, of whichever ocean."""
    return _COAST in item


def has_bed(ocean: bpy.types.Object) -> bool:
    """Whether an ocean shows a coast, by a mesh over its bed or around a camera."""
    return bed_points.points_of(ocean) is not None


def remove(ocean: bpy.types.Object) -> None:
    """Let an ocean be the open sea again, shown by its own mesh, if it had a coast."""
    _remove_mesh(ocean)
    if has_bed(ocean):
        bed_points.remove(ocean)
        dry_other_beds()


def _remove_mesh(ocean: bpy.types.Object) -> None:
    item = coast_of(ocean)
    if item is not None:
        remove_with_meshes([item])
        make_room(ocean)


def dry_other_beds() -> None:
    """Let no mesh be wet that is no bed of a coast any more."""
    wet_bed.keep_only(ocean for ocean in all_oceans() if has_bed(ocean))


def make_room(ocean: bpy.types.Object) -> None:
    """Draw an ocean's own mesh as a box, and in no render, while a coast or a camera surface shows it; as it
    was before where none does any more."""
    if coast_of(ocean) is not None or camera_surface_of(ocean) is not None:
        if _SHOWN_AS not in ocean:
            ocean[_SHOWN_AS] = {name: getattr(ocean, name) for name in _USUALLY}
        ocean.hide_render, ocean.display_type = True, "BOUNDS"
    else:
        for name, value in (_USUALLY | dict(ocean.pop(_SHOWN_AS, {}))).items():
            setattr(ocean, name, value)


def refresh(ocean: bpy.types.Object, plan: Plan, patient: bool = True) -> bool:
    """Make, move or remove what shows the sea over the bed: points in the ocean's geometry, and a mesh where
    no surface around a camera shows these.

    patient : whether to compute the waves over it, however long that takes; else it stays as it is until they
        are at hand, a new mesh flat

    Returns whether it is complete. Raises ParameterError for a bed that waves cannot reach, OceanObjectError
    for a mesh that is linked or edited.
    """
    if plan.over_bed is None:
        remove(ocean)
        return True
    present = coast_of(ocean)
    if ocean.library is not None:  # Blender discards changes to it
        name = ocean.name if present is None else present.name
        if present is not None:
            held_sea.say_nothing(present, COAST)  # the ocean's panel does
        raise OceanObjectError(f"{name} is linked and its coast stands still: make a library override")
    sea, is_still = sea_over_bed(plan), not patient and making(plan) is not None
    if not is_still:
        bed_points.refresh(ocean, sea, plan)
    if camera_surface_of(ocean) is None:
        _show(present or _new(ocean, plan.over_bed), ocean, sea, plan, is_still)
    elif not is_still:
        _remove_mesh(ocean)
        held_sea.tell(bed_points.points_of(ocean), COAST, math.floor(plan.frame))
    if not is_still:
        wet_bed.refresh(ocean, sea, plan)
    return not is_still


def making(plan: Plan) -> Callable[[Callable[[float], None]], object] | None:
    """What computes the waves over a plan's bed, on any thread; None where they are at hand.

    It tells the function that it is given which share is done.
    """
    coast = None if plan.over_bed is None else sea_over_bed(plan).coast
    return None if coast is None or coast.is_made else coast.make


def _show(item: bpy.types.Object, ocean: bpy.types.Object, sea: Ocean, plan: Plan, is_still: bool) -> None:
    """Let a mesh show the sea over its bed; if still, as it was, or flat where there is none yet."""
    assert sea.coast is not None
    if item.data.is_editmode:
        raise OceanObjectError(f"{item.name} is in Edit Mode: leave Edit Mode to let its waves move")
    if item.data.users > 1:  # of a duplicate, or of what an override is of
        item.data = item.data.copy()
    material = ocean.material_slots[0].material if ocean.material_slots else None
    if material is not None and list(item.data.materials) != [material]:
        item.data.materials.clear()
        item.data.materials.append(material)
    grid = mesh_over_bed(sea)
    fits = len(item.data.vertices) == grid.vertices and TEXTURE_COORDINATES in item.data.uv_layers
    if not fits or item.get(_COAST) != grid.tag:
        _fill(item.data, grid)
        item[_COAST] = grid.tag
        _place(item.data, _at_rest(grid, plan))
    if is_still:
        return
    _move(item.data, sea, grid, plan)
    held_sea.tell(item, COAST, math.floor(plan.frame))


def _fill(mesh: bpy.types.Mesh, grid: CoastMesh) -> None:
    corners = grid.corners()
    mesh.clear_geometry()
    mesh.vertices.add(grid.vertices)
    mesh.loops.add(corners.size)
    mesh.polygons.add(len(corners))
    mesh.loops.foreach_set("vertex_index", corners.reshape(-1))
    mesh.polygons.foreach_set("loop_start", np.arange(0, corners.size, 4, dtype=np.int32))
    mesh.update(calc_edges=True)
    mesh.shade_smooth()
    uv_map = mesh.uv_layers.new(name=TEXTURE_COORDINATES, do_init=False)
    uv_map.uv.foreach_set("vector", grid.texture_coordinates[corners.reshape(-1)].reshape(-1))
    mesh.attributes.new(COAST_DEPTH, "FLOAT", "POINT").data.foreach_set("value", grid.depth)


def _move(mesh: bpy.types.Mesh, sea: Ocean, grid: CoastMesh, plan: Plan) -> None:
    """Put the sea of the plan's moment on the vertices."""
    wanted = plan.channels & set(OVER_BED_CHANNELS) | {"displacement"}
    x, y = grid.x[: grid.vertices], grid.y[: grid.vertices]
    fields = over_bed(sea, x, y, plan.time, wanted)
    if "velocity" in fields:
        fields["velocity"] = fields["velocity"] * np.float32(plan.scale * plan.rate)
    fields["displacement"] = fields["displacement"] * np.float32(plan.scale)
    for name, field in fields.items():
        vertex_attributes.put(mesh, CHANNELS[name], field)
    _place(mesh, _at_rest(grid, plan) + fields["displacement"])


def _place(mesh: bpy.types.Mesh, places: Array) -> None:
    mesh.attributes["position"].data.foreach_set("vector", places.astype(np.float32).reshape(-1))
    mesh.update_tag()


def _at_rest(grid: CoastMesh, plan: Plan) -> Array:
    """(vertices, 3) places of the vertices on still water, Blender units."""
    x, y = grid.x[: grid.vertices], grid.y[: grid.vertices]
    return np.stack((x * plan.scale, y * plan.scale, np.zeros(grid.vertices)), axis=-1)


def _new(ocean: bpy.types.Object, parameters: OceanParameters) -> bpy.types.Object:
    name = f"{ocean.name} Coast"
    item = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    item[_COAST] = ""
    item.parent = ocean
    link_beside(item, ocean)
    water_material.describe_near(item, parameters)
    make_room(ocean)
    return item
