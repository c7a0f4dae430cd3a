# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh that shows an ocean over its bed, in the place of the ocean's own: fine near the shore."""

from __future__ import annotations

import math
from collections.abc import Callable

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import Ocean, OceanParameters, Places
from ..core.foam.model import Whitecaps
from ..core.sea.memory import ground_of
from ..core.sea.over_bed import OVER_BED_CHANNELS, mesh_over_bed, over_bed, with_whitecaps
from ..core.synthesis.channels import CHANNELS, OF_STATE
from ..core.waves.coast.mesh import CoastMesh, coast_mesh
from ..export.frame_files import COAST as COAST_POINTS
from ..export.frame_files import files_start
from ..nodes.coast import COAST, FILES
from ..nodes.modifier_inputs import reads, set_inputs
from ..nodes.names import COAST_DEPTH, TEXTURE_COORDINATES
from . import bed_points, evaluation, held_sea, patch_points, vertex_attributes, water_material, wet_bed
from .ownership import remove_with_meshes
from .patch_points import Points
from .plan import Plan, camera_surface_of, in_units, sea_over_bed
from .settings import OceanObjectError, all_oceans, link_beside, settings_of, stay_beside

Array = NDArray[np.float64]

_COAST = "ocean_tweak_coast"
#: of its mesh: what its height, breaking and direction are of
_STATE = "ocean_tweak_state"
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
    return coast_of(ocean) is not None or bed_points.points_of(ocean) is not None


def shot_maps(ocean: bpy.types.Object) -> tuple[str, ...]:
    """The maps, besides images, that a bake needs so that the mesh over the bed moves."""
    return () if coast_of(ocean) is None else (COAST_POINTS,)


def is_live(ocean: bpy.types.Object) -> bool:
    """Whether an ocean has a coast that no files move, by a mesh or for what reads the ocean."""
    return bed_points.points_of(ocean) is not None or (coast_of(ocean) is not None and not is_baked(ocean))


def lacks_points(ocean: bpy.types.Object) -> bool:
    """Whether something reads an ocean that has no points over its bed."""
    return coast_of(ocean) is not None and bed_points.points_of(ocean) is None and _is_read(ocean)


def is_baked(ocean: bpy.types.Object) -> bool:
    """Whether files move the mesh over an ocean's bed."""
    return patch_points.has_points(settings_of(ocean), COAST_POINTS)


def _is_read(ocean: bpy.types.Object) -> bool:
    return any(item != ocean and reads(item, (ocean,)) for item in bpy.data.objects)


def points_of(ocean: bpy.types.Object, plan: Plan, scene: bpy.types.Scene) -> Points | None:
    """The baked points that move the mesh over the bed; None where it is live."""
    return patch_points.points_of(settings_of(ocean), plan, scene, COAST_POINTS)


def remove(ocean: bpy.types.Object) -> None:
    """Let an ocean be the open sea again, shown by its own mesh, if it had a coast."""
    if has_bed(ocean):
        _remove_mesh(ocean)
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


def refresh(
    ocean: bpy.types.Object,
    plan: Plan,
    points: Points | None,
    patient: bool = True,
    is_rendered: bool = False,
) -> bool:
    """Make, move or remove what shows the sea over the bed: points in the ocean's geometry, and a mesh where
    no surface around a camera shows these.

    points : the baked ones that move the mesh; those in the ocean's geometry are then only made where
        something reads them
    patient : whether to compute the waves over it, however long that takes; else it stays as it is until they
        are at hand, a new mesh flat. Whitecaps then are without their history where that would take long
    is_rendered : whether whitecaps are to be those of a render, which without a window they always are

    Returns whether it is complete. Raises ParameterError for a bed that waves cannot reach, OceanObjectError
    for a mesh that is linked or edited.
    """
    if plan.over_bed is None:
        remove(ocean)
        return True
    present = coast_of(ocean)
    if ocean.library is not None:  # Blender discards changes to it
        if present is not None and points is not None:
            return True  # files move it
        name = ocean.name if present is None else present.name
        if present is not None:
            held_sea.say_nothing(present, COAST)  # the ocean's panel does
        raise OceanObjectError(f"{name} is linked and its coast stands still: make a library override")
    has_surface = camera_surface_of(ocean) is not None
    is_still = not patient and making(plan) is not None
    if points is not None and not has_surface:
        _read_files(_ready_mesh(ocean, plan), ocean, plan, points)
        return _refresh_for_readers(ocean, plan, is_still)
    if not is_still:
        bed_points.refresh(ocean, sea_over_bed(plan), plan)
        wet_bed.refresh(ocean, sea_over_bed(plan), plan)
    if not has_surface:
        item = _ready_mesh(ocean, plan)
        whitecaps, has_history = _whitecaps(plan, patient, is_rendered or bpy.app.background)
        _show(item, sea_over_bed(plan), plan, whitecaps, is_still)
        return has_history and not is_still
    if not is_still:
        _remove_mesh(ocean)
        held_sea.tell(bed_points.points_of(ocean), COAST, math.floor(plan.frame))
    return not is_still


def _refresh_for_readers(ocean: bpy.types.Object, plan: Plan, is_still: bool) -> bool:
    """Give a baked ocean the points over its bed that something reads. Returns whether they are complete."""
    if not _is_read(ocean):
        bed_points.remove(ocean)
        return True
    if not is_still:
        bed_points.refresh(ocean, sea_over_bed(plan), plan)
        held_sea.tell(bed_points.points_of(ocean), COAST, math.floor(plan.frame))
    return not is_still


def making(plan: Plan) -> Callable[[Callable[[float], None]], object] | None:
    """What computes the waves over a plan's bed, on any thread; None where they are at hand.

    It tells the function that it is given which share is done.
    """
    coast = None if plan.over_bed is None else sea_over_bed(plan).coast
    return None if coast is None or coast.is_made else coast.make


def show_for_render(ocean: bpy.types.Object, plan: Plan, points: Points | None) -> None:
    """Give the mesh the whitecaps of a render, where a window shows others."""
    if plan.over_bed is not None and plan.has_own_render and not bpy.app.background:
        refresh(ocean, plan, points, is_rendered=True)


def _whitecaps(plan: Plan, patient: bool, is_rendered: bool) -> tuple[Whitecaps | None, bool]:
    """Those of the open sea's tile, if foam is wanted, and whether they are final."""
    if "foam" not in plan.channels:
        return None, True
    tile = evaluation.surfaces_of(plan.parameters if is_rendered else plan.viewport_sea())
    wanted = frozenset(Whitecaps._fields) | {"cusp"}
    fields, is_complete = tile.fields(plan.time, wanted, plan.is_whole, patient)
    return Whitecaps(*(fields[name][:-1, :-1] for name in Whitecaps._fields)), is_complete


def _ready_mesh(ocean: bpy.types.Object, plan: Plan) -> bpy.types.Object:
    """The mesh over a bed, made where there is none, with data of its own and the ocean's material."""
    assert plan.over_bed is not None
    item = coast_of(ocean) or _new(ocean, plan.over_bed)
    stay_beside(item, ocean)
    if item.data.is_editmode:
        raise OceanObjectError(f"{item.name} is in Edit Mode: leave Edit Mode to let its waves move")
    if item.data.users > 1:  # of a duplicate, or of what an override is of
        item.data = item.data.copy()
    material = ocean.material_slots[0].material if ocean.material_slots else None
    if material is not None and list(item.data.materials) != [material]:
        item.data.materials.clear()
        item.data.materials.append(material)
    return item


def _show(
    item: bpy.types.Object, sea: Ocean, plan: Plan, whitecaps: Whitecaps | None, is_still: bool
) -> None:
    """Let a mesh show the sea over its bed; if still, as it was, or flat where there is none yet."""
    grid = mesh_over_bed(sea)
    _shape(item, grid, plan)
    if is_still:
        return
    _move(item.data, sea, plan, whitecaps)
    held_sea.tell(item, COAST, math.floor(plan.frame))
    set_inputs(held_sea.modifier_of(item, COAST), {FILES: ""})


def _read_files(item: bpy.types.Object, ocean: bpy.types.Object, plan: Plan, points: Points) -> None:
    """Let baked points move a mesh, and wet the sand."""
    baked = points.parameters
    ground = ground_of(baked)
    grid = coast_mesh(ground, baked.domain_size, baked.resolution)
    _shape(item, grid, plan)
    _rest(item.data, grid, plan)
    files = {
        FILES: points.folder + files_start(points.name, COAST_POINTS),
        **patch_points.frame_inputs(points),
    }
    warn = settings_of(ocean).out_of_range == "WARN"
    set_inputs(held_sea.modifier_of(item, COAST), {"Live": False, "Warn Out of Range": warn, **files})
    item.update_tag()
    wet_bed.read_files(ocean, ground, grid, points)


def _shape(item: bpy.types.Object, grid: CoastMesh, plan: Plan) -> None:
    """Let the mesh have the grid's vertices; new ones are on still water."""
    fits = len(item.data.vertices) == grid.vertices and TEXTURE_COORDINATES in item.data.uv_layers
    if not fits or item.get(_COAST) != grid.tag:
        _fill(item.data, grid)
        item[_COAST] = grid.tag
        _place(item.data, _at_rest(grid, plan))


def _rest(mesh: bpy.types.Mesh, grid: CoastMesh, plan: Plan) -> None:
    """Let the vertices be on still water, as files move them."""
    vertex_attributes.remove(mesh)
    wanted, found = _at_rest(grid, plan), np.empty(3 * grid.vertices, np.float32)
    mesh.attributes["position"].data.foreach_get("vector", found)
    if not np.array_equal(found, wanted.astype(np.float32).reshape(-1)):
        _place(mesh, wanted)


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


def _move(mesh: bpy.types.Mesh, sea: Ocean, plan: Plan, whitecaps: Whitecaps | None) -> None:
    """Put the sea of the plan's moment on the vertices, with the open sea's whitecaps."""
    grid = mesh_over_bed(sea)
    wanted = plan.channels & set(OVER_BED_CHANNELS) | {"displacement"}
    x, y = grid.x[: grid.vertices], grid.y[: grid.vertices]
    fields = over_bed(sea, x, y, plan.time, wanted)
    if whitecaps is not None:
        fields = with_whitecaps(sea, fields, x, y, whitecaps)
    if "velocity" in fields:
        fields["velocity"] = fields["velocity"] * np.float32(plan.scale * plan.rate)
    fields["displacement"] = fields["displacement"] * np.float32(plan.scale)
    for name, field in fields.items():
        vertex_attributes.put(mesh, CHANNELS[name], field)
    _place(mesh, _at_rest(grid, plan) + fields["displacement"])
    _describe(mesh, sea, grid, plan)


def _describe(mesh: bpy.types.Mesh, sea: Ocean, grid: CoastMesh, plan: Plan) -> None:
    """Put height, breaking and direction on the vertices, which no time changes."""
    assert sea.coast is not None
    tag = f"{sea.coast.state_tag} {grid.tag} {plan.scale!r}"
    if mesh.get(_STATE) == tag and all(CHANNELS[name].attribute in mesh.attributes for name in OF_STATE):
        return
    fields = sea.surface(plan.time, OF_STATE, Places(grid.x[: grid.vertices], grid.y[: grid.vertices]))
    for name in sorted(OF_STATE):
        vertex_attributes.put(mesh, CHANNELS[name], fields[name] * np.float32(in_units(CHANNELS[name], plan)))
    mesh[_STATE] = tag


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
