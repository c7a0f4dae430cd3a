# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh that shows an ocean over its bed, in the place of the ocean's own: fine near the shore."""

from __future__ import annotations

import math
import zlib

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import Ocean, OceanParameters, Places
from ..core.numerics.memo import MEMO, total_bytes
from ..core.synthesis.channels import CHANNELS
from ..nodes.held import COAST
from ..nodes.names import COAST_DEPTH, TEXTURE_COORDINATES
from . import held_sea, vertex_attributes, water_material, wet_bed
from .plan import Plan, camera_surface_of
from .settings import OceanObjectError, all_oceans, link_beside

Array = NDArray[np.float64]

_COAST = "ocean_tweak_coast"
#: of an ocean that another mesh shows: its own Render and Display As
_SHOWN_AS = "ocean_tweak_shown_as"
_USUALLY = {"hide_render": False, "display_type": "TEXTURED"}
#: what the material reads of the waves
_CHANNELS = ("displacement", "velocity", "cusp")
#: m offshore that the mesh goes on, and how much longer each step is there than the one before
_OFFSHORE, _GROWS = 2500.0, 1.06
#: m of land behind the farthest waterline that it covers
_BEHIND = 10.0

#: m of water that is drawn where there is none
_FILM = 0.02

_MESHES = "meshes of coasts"


def coast_of(ocean: bpy.types.Object) -> bpy.types.Object | None:
    """The mesh that shows an ocean over its bed; None where there is none."""
    return next((child for child in ocean.children if is_ours(child)), None)


def is_ours(item: bpy.types.Object) -> bool:
    """Whether an object is the mesh over a bed, of whichever ocean."""
    return _COAST in item


def remove(ocean: bpy.types.Object) -> None:
    """Show an ocean by its own mesh again, if it had one over its bed."""
    item = coast_of(ocean)
    if item is not None:
        mesh = item.data
        bpy.data.objects.remove(item)
        if not mesh.users:
            bpy.data.meshes.remove(mesh)
        make_room(ocean)
        dry_other_beds()


def dry_other_beds() -> None:
    """Let no mesh be wet that is no bed of a coast any more."""
    wet_bed.keep_only(ocean for ocean in all_oceans() if coast_of(ocean) is not None)


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


def refresh(ocean: bpy.types.Object, plan: Plan) -> None:
    """Make, move or remove the mesh over the bed.

    Raises ParameterError for a bed that waves cannot reach, OceanObjectError for a mesh that is linked or
    edited, or beside a camera surface.
    """
    if plan.over_bed is None:
        remove(ocean)
        return
    surface = camera_surface_of(ocean)
    if surface is not None:
        raise OceanObjectError(f"{surface.name} would lie over the coast: remove the camera surface")
    present = coast_of(ocean)
    if ocean.library is not None:  # Blender discards changes to it
        name = ocean.name if present is None else present.name
        if present is not None:
            held_sea.say_nothing(present, COAST)  # the ocean's panel does
        raise OceanObjectError(f"{name} is linked and its coast stands still: make a library override")
    item = present or _new(ocean, plan.over_bed)
    if item.data.is_editmode:
        raise OceanObjectError(f"{item.name} is in Edit Mode: leave Edit Mode to let its waves move")
    if item.data.users > 1:  # of a duplicate, or of what an override is of
        item.data = item.data.copy()
    material = ocean.material_slots[0].material if ocean.material_slots else None
    if material is not None and list(item.data.materials) != [material]:
        item.data.materials.clear()
        item.data.materials.append(material)
    sea = MEMO.get("seas over beds", plan.over_bed, lambda: Ocean(plan.over_bed))
    grid = MEMO.get(_MESHES, (sea.coast.ground, plan.scale), lambda: _Grid(sea))
    fits = len(item.data.vertices) == grid.x.size and TEXTURE_COORDINATES in item.data.uv_layers
    if not fits or item.get(_COAST) != grid.tag:
        _fill(item.data, grid)
        item[_COAST] = grid.tag
    _move(item.data, sea, grid, plan)
    held_sea.tell(item, COAST, math.floor(plan.frame))
    wet_bed.refresh(ocean, sea, plan)


class _Grid:
    """Places over a bed and before it, in lines across the march."""

    def __init__(self, sea: Ocean) -> None:
        assert sea.coast is not None
        ground = sea.coast.ground
        wet = np.flatnonzero((ground.depth > 0.0).any(axis=1))
        last = min(wet[-1] + 1 + math.ceil(_BEHIND / ground.step), ground.rows - 1)
        along = ground.step * np.arange(last + 1, dtype=np.float64)
        steps = ground.step * _GROWS ** np.arange(1, 400)
        before = -np.cumsum(steps)
        along = np.concatenate((before[before > -_OFFSHORE][::-1], along))
        across = ground.step * np.arange(ground.columns + 1, dtype=np.float64)
        self.rows, self.columns = len(along), len(across)
        along, across = np.meshgrid(along + ground.first[0], across + ground.first[1], indexing="ij")
        c, s = math.cos(ground.turn), math.sin(ground.turn)
        self.x, self.y = (c * along - s * across).ravel(), (s * along + c * across).ravel()
        depth = ground.between(self.x, self.y).read(ground.depth)
        # what is drawn on land is a film of water
        self.depth = np.maximum(depth, _FILM).astype(np.float32)
        places = np.stack((self.x, self.y), axis=-1) / sea.parameters.domain_size
        # as on the ocean's own mesh
        self.texture_coordinates = (places + 0.5 / sea.parameters.resolution).astype(np.float32)
        self.tag = (
            f"{self.rows} {self.columns} {ground.step!r} {ground.first!r} {ground.turn!r} "
            f"{zlib.crc32(self.depth)}"
        )

    @property
    def nbytes(self) -> int:
        """Bytes of the places."""
        return total_bytes((self.x, self.y, self.depth, self.texture_coordinates))

    def corners(self) -> NDArray[np.int32]:
        """(quads, 4) vertices of each quad, counter-clockwise from above."""
        number = np.arange(self.rows * self.columns, dtype=np.int32).reshape(self.rows, self.columns)
        quads = (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:])
        return np.stack(quads, axis=-1).reshape(-1, 4)


def _fill(mesh: bpy.types.Mesh, grid: _Grid) -> None:
    corners = grid.corners()
    mesh.clear_geometry()
    mesh.vertices.add(grid.x.size)
    mesh.loops.add(corners.size)
    mesh.polygons.add(len(corners))
    mesh.loops.foreach_set("vertex_index", corners.reshape(-1))
    mesh.polygons.foreach_set("loop_start", np.arange(0, corners.size, 4, dtype=np.int32))
    mesh.update(calc_edges=True)
    mesh.shade_smooth()
    uv_map = mesh.uv_layers.new(name=TEXTURE_COORDINATES, do_init=False)
    uv_map.uv.foreach_set("vector", grid.texture_coordinates[corners.reshape(-1)].reshape(-1))
    mesh.attributes.new(COAST_DEPTH, "FLOAT", "POINT").data.foreach_set("value", grid.depth)


def _move(mesh: bpy.types.Mesh, sea: Ocean, grid: _Grid, plan: Plan) -> None:
    """Put the sea of the plan's moment on the vertices."""
    assert sea.coast is not None
    wanted = [name for name in _CHANNELS if name == "displacement" or name in plan.channels]
    surface = sea.surface(plan.time, wanted, Places(grid.x, grid.y))
    fields = {name: surface[name] for name in wanted}
    scale = np.float32(plan.scale)
    moved = fields["displacement"] * scale
    if "velocity" in fields:
        fields["velocity"] = fields["velocity"] * np.float32(plan.scale * plan.rate)
    if "foam" in plan.channels:
        foam, breaking, age = sea.coast.foam(grid.x, grid.y, plan.time)
        fields |= {"foam": foam, "breaking": breaking, "foam_age": age}
    fields["displacement"] = moved
    for name, field in fields.items():
        vertex_attributes.put(mesh, CHANNELS[name], field)
    places = np.stack((grid.x * plan.scale, grid.y * plan.scale, np.zeros(grid.x.size)), axis=-1)
    places = (places + moved).astype(np.float32)
    mesh.attributes["position"].data.foreach_set("vector", places.reshape(-1))
    mesh.update_tag()


def _new(ocean: bpy.types.Object, parameters: OceanParameters) -> bpy.types.Object:
    name = f"{ocean.name} Coast"
    item = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    item[_COAST] = ""
    item.parent = ocean
    link_beside(item, ocean)
    water_material.describe_near(item, parameters)
    make_room(ocean)
    return item
