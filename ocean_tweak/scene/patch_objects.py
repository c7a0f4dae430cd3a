# SPDX-License-Identifier: GPL-3.0-or-later
"""Hidden meshes with the patches of a sea, one each, for the surface around the camera.

They consist of points, which are not rendered. Each contains samples of its patch in the patch's own axes and
is rotated like the patch: all samples for a render, half as many along each side for the viewport, few while
a value is dragged. They are live, or are read by nodes from baked files, if the ocean's bake has them.

With masks, a patch has one mesh per mask, and the weights are on points over the domain. Waves that do not
repeat are on a further mesh, over a square around the camera, and foam is on rings.
"""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import bpy
import numpy as np

from ..core import OceanParameters, ParameterError
from ..core.data.plain_data import to_plain
from ..core.masks.noise import ANY_TIME, SeaTime
from ..core.masks.parameters import Mask
from ..core.masks.weights import move, weights
from ..core.numerics.machine import usable_cores
from ..core.parameters.fingerprint import fingerprint
from ..core.parameters.patch_seas import Part, parts
from ..core.sea.placed_waves import placed_fields, placed_waves
from ..core.statistics.unresolved_slopes import unresolved_slope_variance
from ..core.synthesis.channels import ADDING, CHANNELS, Channel
from ..export.frame_files import POINTS, WAKES, files_start
from ..nodes.camera_sum import AREA_INPUT, PATCH_INPUTS
from ..nodes.camera_surface import FOAM_INPUT
from ..nodes.held import AREA
from ..nodes.modifier_inputs import get_input, set_inputs
from ..nodes.names import DISPLACEMENT, WEIGHT
from ..nodes.versioned import is_of_kind
from ..nodes.wake_points import FILES as WAKE_FILES
from ..nodes.wake_points import WAKE_POINTS
from . import evaluation, foam_rings, held_sea, patch_averages, patch_points, vertex_attributes
from .grid_mesh import Grid
from .ownership import remove_with_meshes
from .patch_points import Points
from .plan import COARSE, Plan, camera_surface_of, in_units, in_window, sea_over_bed, surface_modifier
from .settings import OceanObjectError, is_ocean, link_beside, scene_of, settings_of
from .vertex_attributes import RealArray

_NUMBER, _MASKS, _AREA, _FOAM = (f"ocean_tweak_{name}" for name in ("patch", "masks", "area", "foam_rings"))
# contents of the meshes, by session uid
_shown: dict[int, Hashable] = {}
#: cells of the weights along each side of the domain
_WEIGHTS = 256


def shot_maps(ocean: bpy.types.Object) -> tuple[str, ...]:
    """The maps, besides images, that a bake needs so that everything in the file that shows the ocean
    moves."""
    if camera_surface_of(ocean) is None:
        return ()
    points = (POINTS,) if len(settings_of(ocean).patches) else ()
    return (*points, WAKES) if has_wakes_to_bake(ocean) else points


def has_wakes_to_bake(ocean: bpy.types.Object) -> bool:
    """Whether a bake holds waves around a camera that do not repeat: not over a bed, which is in none."""
    if camera_surface_of(ocean) is None:
        return False
    try:
        parameters = settings_of(ocean).to_parameters(scene_of(ocean))
    except ParameterError:
        return False  # the ocean tells
    return not parameters.has_coast and bool(placed_waves(parameters))


def patches_of(ocean: bpy.types.Object) -> dict[int, bpy.types.Object]:
    """The meshes of an ocean's patches by number, from 1."""
    return dict(sorted((child[_NUMBER], child) for child in reversed(ocean.children) if _NUMBER in child))


def refresh(
    ocean: bpy.types.Object,
    plan: Plan,
    points: Points | None,
    scene: bpy.types.Scene,
    patient: bool,
    coarse: bool = False,
) -> bool:
    """Create, update, move or remove the meshes of an ocean's patches, and connect them to its camera
    surface.

    points : the baked points to read
    patient : otherwise foam is shown without its history where that would take long
    coarse : with few samples, and the previous foam

    Returns whether they are complete.

    Raises MemoryError for a patch too large, OceanObjectError if masks split the sea into too many parts.
    """
    # a linked ocean shows the data of its own file, as Blender discards changes to it
    if ocean.library is not None:
        return True
    surface = camera_surface_of(ocean)
    parameters = plan.parameters if points is None else points.parameters
    made: dict[int, bpy.types.Object] = {}
    weighted, is_complete = None, True
    if surface is None:
        remove(ocean)
    elif not parameters.patches:
        remove_with_meshes(child for child in ocean.children if _NUMBER in child or _MASKS in child)
    else:
        of_sea = parts(parameters)
        if len(of_sea) > len(PATCH_INPUTS):
            raise OceanObjectError(
                f"Masks divide this sea's patches into {len(of_sea)}, and a camera surface shows "
                f"at most {len(PATCH_INPUTS)}: remove masks, patches or the camera surface"
            )
        made = _refreshed(ocean, plan, points, of_sea, coarse)
        when = SeaTime(plan.time, parameters.loop_duration)
        weighted = _weights(ocean, parameters.domain_size, plan.scale, of_sea, when)
    if surface is not None:
        inputs = {name: made.get(number) for number, name in enumerate(PATCH_INPUTS, 1)}
        wakes = patch_points.points_of(settings_of(ocean), plan, scene, WAKES)
        inputs |= {"Weights": weighted, AREA_INPUT: _refreshed_area(ocean, plan, wakes)}
        wanted = foam_rings.around(surface, plan, points, scene)
        inputs[FOAM_INPUT] = foam = _foam_object(ocean, wanted is not None)
        modifier = surface_modifier(surface)
        if any(get_input(modifier, name) != inputs[name] for name in (AREA_INPUT, FOAM_INPUT)):
            surface.update_tag()  # Blender does not notice that its display has changed
        set_inputs(modifier, inputs)
        # foam is kept at subframes, as going back in time would restart its history
        is_needed = plan.is_whole or (foam is not None and not foam.data.vertices)
        if wanted is not None and foam.data.library is None and is_needed and not coarse:
            is_complete = wanted.write(foam.data, patient)
            _shown[foam.data.session_uid] = patient
    _keep_out_of_files(ocean)
    return is_complete


def _keep_out_of_files(ocean: bpy.types.Object) -> None:
    """Exclude generated objects from saved files: the ocean's own mesh replaces them.

    Waves that do not repeat have no replacement, and points moved by files need the weights.
    """
    is_live = lack_points(ocean)
    for child in ocean.children:
        if _FOAM in child or _NUMBER in child or _MASKS in child:
            held_sea.keep_out(child, is_live or _FOAM in child)


def show_for_render(
    ocean: bpy.types.Object, plan: Plan, points: Points | None, scene: bpy.types.Scene
) -> None:
    """Give live patches the samples that a render wants, and foam all of its places and its history; nothing
    is done where they have them already.

    points : baked ones that the patches read
    """
    if ocean.library is not None:
        return
    live = {
        number: item for number, item in patches_of(ocean).items() if patch_points.modifier_of(item) is None
    }
    wanted = list[_Filling]()
    for number, part in enumerate(parts(plan.parameters) if live else (), 1):
        if number in live and live[number].data.library is None:
            wanted.append(_Filling(live[number].data, part.parameters, part.parameters.resolution))
    _fill(wanted, plan)
    foam = next((child for child in ocean.children if _FOAM in child), None)
    if foam is not None and foam.data.library is None and not _shown.get(foam.data.session_uid):
        around = foam_rings.around(camera_surface_of(ocean), plan, points, scene)
        if around is not None:
            _shown[foam.data.session_uid] = around.write(foam.data, True)


def seas_in_window(plan: Plan) -> tuple[OceanParameters, ...]:
    """The patches of a sea as a window shows them."""
    whole = (part.parameters for part in parts(plan.parameters))
    return tuple(sea.at_resolution(in_window(sea.resolution)) for sea in whole)


def forget_all() -> None:
    """Forget the contents of all meshes: a file was opened, or a step undone."""
    _shown.clear()


def are_live(ocean: bpy.types.Object) -> bool:
    """Whether an ocean has live patches or waves that do not repeat, or foam around a camera."""
    return shows_area(ocean) or has_foam(ocean) or lack_points(ocean)


def lack_points(ocean: bpy.types.Object) -> bool:
    """Whether an ocean has live patches."""
    return any(patch_points.modifier_of(item) is None for item in patches_of(ocean).values())


def has_foam(ocean: bpy.types.Object) -> bool:
    """Whether foam is computed around a camera, also for a baked sea."""
    return any(_FOAM in child for child in ocean.children)


def shows_area(ocean: bpy.types.Object) -> bool:
    """Whether live waves that do not repeat are shown around a camera."""
    return any(_AREA in child and not _reads_files(child) for child in ocean.children)


def remove(ocean: bpy.types.Object) -> None:
    """Remove the meshes of an ocean's patches and their weights."""
    remove_with_meshes(child for child in ocean.children if is_ours(child))


def remove_left() -> None:
    """Remove those of deleted oceans, which users cannot select."""
    own = (item for item in bpy.data.objects if is_ours(item))
    remove_with_meshes(item for item in own if not is_ocean(item.parent))


def is_ours(item: bpy.types.Object) -> bool:
    """Whether an object was created for an ocean's camera surface."""
    return any(key in item for key in (_NUMBER, _MASKS, _AREA, _FOAM))


def _refreshed(
    ocean: bpy.types.Object, plan: Plan, points: Points | None, of_sea: Sequence[Part], coarse: bool
) -> dict[int, bpy.types.Object]:
    """The patches by number; surplus ones are removed."""
    present = patches_of(ocean)
    kept = {present[number].name for number in range(1, len(of_sea) + 1) if number in present}
    remove_with_meshes(child for child in ocean.children if _NUMBER in child and child.name not in kept)
    made = dict[int, bpy.types.Object]()
    wanted = list[_Filling]()
    for number, part in enumerate(of_sea, 1):
        item = present.get(number) or _new(ocean, f"Patch {number}", _NUMBER, number)
        if item.rotation_euler.z != np.float32(part.rotation):
            item.rotation_euler.z = part.rotation
        if item.data.users > 1:  # of a duplicate
            item.data = item.data.copy()
        if points is not None:
            _shown.pop(item.data.session_uid, None)
            patch_points.read_points(item, number, part, points)
        elif item.data.library is None:
            patch_points.read_none(item)
            samples = in_window(part.parameters.resolution)
            samples = min(COARSE, samples) if coarse else samples
            wanted.append(_Filling(item.data, part.parameters, samples))
        made[number] = item
    _fill(wanted, plan)
    return made


class _Filling(NamedTuple):
    """A mesh, its patch, and the number of samples along each side."""

    mesh: bpy.types.Mesh
    patch: OceanParameters
    samples: int

    @property
    def is_coarse(self) -> bool:
        """Whether these are fewer than the viewport shows at rest."""
        return self.samples < in_window(self.patch.resolution)


def _fill(wanted: Iterable[_Filling], plan: Plan) -> None:
    """Write patches to points if they have changed, computed on all cores."""
    moment = (plan.time, plan.rate, plan.scale)
    lacking = [each for each in wanted if _shown.get(each.mesh.session_uid) != (moment, *each[1:])]
    if not lacking:
        return
    seas = [each.patch.at_resolution(each.samples) for each in lacking]
    surfaces = [evaluation.surfaces_of(sea) for sea in seas]
    with ThreadPoolExecutor(usable_cores()) as pool:
        made = pool.map(lambda each: each.fields(plan.time, ADDING, plan.is_whole)[0], surfaces)
        # one is written while the next one is computed
        for each, sea, fields in zip(lacking, seas, made, strict=True):
            lost = 0.0 if each.is_coarse else _lost(each, sea)
            grid = Grid(each.patch.domain_size * plan.scale, each.samples, each.samples)
            scaled = {name: _in_units(CHANNELS[name], field, plan) for name, field in fields.items()}
            patch_averages.write_patch(each.mesh, grid, scaled, lost)
            _shown[each.mesh.session_uid] = (moment, *each[1:])


def _lost(filling: _Filling, sea: OceanParameters) -> float:
    """Mean square slope of the waves that the sea of a mesh's samples lacks. To find it takes longer than the
    patch where it is not known."""
    return max(unresolved_slope_variance(sea) - unresolved_slope_variance(filling.patch), 0.0)


def _reads_files(item: bpy.types.Object) -> bool:
    """Whether baked points are what a mesh of waves that do not repeat shows."""
    return any(
        each.type == "NODES" and each.show_render and is_of_kind(each.node_group, WAKE_POINTS)
        for each in item.modifiers
    )


def _refreshed_area(ocean: bpy.types.Object, plan: Plan, points: Points | None) -> bpy.types.Object | None:
    """The mesh of waves that do not repeat; None if there are none.

    points : the baked ones to read
    """
    present = next((child for child in ocean.children if _AREA in child), None)
    if plan.placed is None and points is None:
        remove_with_meshes((present,) if present is not None else ())
        return None
    item = present or _new(ocean, "Area", _AREA, "")
    if item.data.users > 1:  # of a duplicate
        item.data = item.data.copy()
    if points is not None:
        _read_area(item, points, "foam" in plan.channels)
    elif item.data.library is None:
        assert plan.placed is not None
        held_sea.drop(item, WAKE_POINTS)
        area = plan.placed.area
        cells = area.resolution - 1
        grid = Grid(area.size * cells / area.resolution * plan.scale, cells, cells)
        coast = None if plan.over_bed is None else sea_over_bed(plan).coast
        afloat = None if coast is None else coast.afloat
        fields = placed_fields(plan.placed.whole, area, plan.time, afloat)
        _write(item.data, grid, fields, plan, area.corner)
        held_sea.tell(item, AREA, math.floor(plan.frame))
    return item


def _read_area(item: bpy.types.Object, points: Points, with_foam: bool) -> None:
    """Let the mesh of waves that do not repeat read baked points; its own are removed."""
    if len(item.data.vertices) and item.data.library is None:
        item.data.clear_geometry()
        item.data.update_tag()
    held_sea.drop(item, AREA)
    files = points.folder + files_start(points.name, WAKES)
    inputs = {WAKE_FILES: files, "Foam": with_foam, **patch_points.frame_inputs(points)}
    set_inputs(held_sea.modifier_of(item, WAKE_POINTS), inputs)
    item.update_tag()


def _foam_object(ocean: bpy.types.Object, is_wanted: bool) -> bpy.types.Object | None:
    """The points of foam around the camera, or None."""
    present = next((child for child in ocean.children if _FOAM in child), None)
    if not is_wanted:
        remove_with_meshes((present,) if present is not None else ())
        return None
    item = present or _new(ocean, "Foam", _FOAM, "")
    if item.data.users > 1:  # of a duplicate
        item.data = item.data.copy()
    return item


def _weights(
    ocean: bpy.types.Object, size: float, scale: float, of_sea: Sequence[Part], when: SeaTime
) -> bpy.types.Object | None:
    """Points over the domain with the weights of masked parts; None if there are none."""
    present = next((child for child in ocean.children if _MASKS in child), None)
    masked = {WEIGHT.format(number): part.masks for number, part in enumerate(of_sea, 1) if part.masks}
    if not masked:
        remove_with_meshes((present,) if present is not None else ())
        return None
    values = {name: [to_plain(mask, brief=True) for mask in masks] for name, masks in masked.items()}
    if not any(map(move, masked.values())):
        when = ANY_TIME
    content = fingerprint({"size": size, "scale": scale, "time": str(when.time), **values})
    item = present or _new(ocean, "Weights", _MASKS, "")
    if item[_MASKS] != content and item.data.library is None:
        _write_weights(item, masked, size, Grid(size * scale, _WEIGHTS, _WEIGHTS), when)
        item[_MASKS] = content
    return item


def _write_weights(
    item: bpy.types.Object, masked: Mapping[str, Sequence[Mask]], size: float, grid: Grid, when: SeaTime
) -> None:
    if item.data.users > 1:  # of a duplicate
        item.data = item.data.copy()
    mesh = item.data
    mesh.clear_geometry()
    mesh.vertices.add(grid.vertices)
    mesh.attributes["position"].data.foreach_set("vector", grid.positions().reshape(-1))
    mesh.attributes.new(DISPLACEMENT, "FLOAT_VECTOR", "POINT")  # by which nodes know a sea's grid; they rest
    along = size / _WEIGHTS * np.arange(_WEIGHTS + 1)
    for name, masks in masked.items():
        values = weights(masks, size, along, along[:, np.newaxis], when).value
        attribute = mesh.attributes.new(name, "FLOAT", "POINT")
        attribute.data.foreach_set("value", values.astype(np.float32).ravel())
    mesh.update_tag()


def _new(ocean: bpy.types.Object, role: str, key: str, value: object) -> bpy.types.Object:
    name = f"{ocean.name} {role}"
    item = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    item[key] = value
    item.parent = ocean
    item.hide_viewport = item.hide_render = item.hide_select = True
    link_beside(item, ocean)
    return item


def _write(
    mesh: bpy.types.Mesh,
    grid: Grid,
    fields: Mapping[str, RealArray],
    plan: Plan,
    corner: tuple[float, float],
) -> None:
    """Write the fields ADDING at the plan's time to points.

    corner : rest position (x, y) of the first one, m
    """
    if len(mesh.vertices) != grid.vertices:
        mesh.clear_geometry()
        mesh.vertices.add(grid.vertices)
    values = {name: _in_units(CHANNELS[name], fields[name], plan) for name in sorted(ADDING)}
    for name, value in values.items():
        vertex_attributes.put(mesh, CHANNELS[name], value)
    places: RealArray = grid.positions()
    places[:, :2] += np.float32(plan.scale) * np.array(corner, np.float32)
    places += values["displacement"].reshape(-1, 3)
    mesh.attributes["position"].data.foreach_set("vector", places.reshape(-1))
    mesh.update_tag()


def _in_units(channel: Channel, field: RealArray, plan: Plan) -> RealArray:
    """A field in Blender units, per second of the scene."""
    factor = in_units(channel, plan)
    return field if factor == 1.0 else field * np.float32(factor)
