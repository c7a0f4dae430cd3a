# SPDX-License-Identifier: GPL-3.0-or-later
"""What a bed adds to an ocean's own mesh, the open sea: points that its geometry has besides, for whatever
reads it.

They are the vertices of a hidden child, in the layout that `nodes.over_bed` reads; the ocean's last modifier
takes them into its geometry.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import Ocean, OceanParameters
from ..core.numerics.interpolation import wrapped
from ..core.sea.coast_waves import CoastWaves
from ..core.synthesis.channels import CHANNELS
from ..core.waves.coast.mesh import FILM
from ..nodes.modifier_inputs import get_input, set_inputs
from ..nodes.names import BED_FOAM, COAST_DEPTH, OPEN_SHARE
from ..nodes.over_bed import BED_POINTS
from ..nodes.versioned import is_of_kind, is_stale, node_group
from . import patch_averages
from .modifiers import is_of_library
from .ownership import remove_with_meshes
from .plan import Plan, in_units
from .settings import link_beside, stay_beside

RealArray = NDArray[np.float32]

_MARK = "ocean_tweak_bed_points"
_NAME = "Ocean Tweak Bed"

# by the session uid of a mesh: of which sea, and in which units, it holds what does not change with time
_written: dict[int, tuple[OceanParameters | None, float]] = {}


def forget_all() -> None:
    """Another file is opened, or a step undone."""
    _written.clear()


def is_ours(item: bpy.types.Object) -> bool:
    """Whether an object holds what a bed adds to an ocean."""
    return _MARK in item


def points_of(ocean: bpy.types.Object) -> bpy.types.Object | None:
    """The object that holds what a bed adds to an ocean; None where there is none."""
    return next((child for child in ocean.children if is_ours(child)), None)


def remove(ocean: bpy.types.Object) -> None:
    """Let an ocean be the open sea."""
    remove_with_meshes(child for child in ocean.children if is_ours(child))
    for modifier in _modifiers(ocean):
        if not is_of_library(modifier):
            ocean.modifiers.remove(modifier)


def refresh(ocean: bpy.types.Object, sea: Ocean, plan: Plan) -> None:
    """Put the plan's moment on the points of an ocean, and make them where there are none.

    sea : with a coast
    """
    assert sea.coast is not None
    item = points_of(ocean) or _new(ocean)
    stay_beside(item, ocean)
    if item.data.users > 1:  # of a duplicate, or of what an override is of
        item.data = item.data.copy()
    _write(item.data, sea.coast, plan)
    modifier = next(iter(_modifiers(ocean)), None) or ocean.modifiers.new(_NAME, "NODES")
    if modifier.node_group is None or is_stale(modifier.node_group, BED_POINTS):
        modifier.node_group = node_group(BED_POINTS)
    if get_input(modifier, "Points") != item:
        set_inputs(modifier, {"Points": item})
        ocean.update_tag()


def _write(mesh: bpy.types.Mesh, coast: CoastWaves, plan: Plan) -> None:
    fields = {name: _laid(field) for name, field in coast.on_samples(plan.time).items()}
    for name, field in fields.items():
        field *= np.float32(in_units(CHANNELS[name], plan))
    has_levels = patch_averages.write(mesh, fields)
    still = plan.over_bed, plan.scale
    if not has_levels or _written.get(mesh.session_uid) != still:
        _write_still(mesh, coast, plan.scale)
        _written[mesh.session_uid] = still
    if "foam" in plan.channels:
        foam = np.stack(coast.foam_on_samples(plan.time), axis=-1)
        patch_averages.put_samples(mesh, BED_FOAM, _laid(foam))
    elif BED_FOAM in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[BED_FOAM])


def _write_still(mesh: bpy.types.Mesh, coast: CoastWaves, scale: float) -> None:
    """Write what does not change with time."""
    x, y = coast.ground.places
    shares = coast.shares(x.ravel(), y.ravel())
    share = np.stack((shares.value, shares.by_x / scale, shares.by_y / scale), axis=-1)
    places = scale * np.stack((x, y, np.zeros_like(x)), axis=-1)
    patch_averages.put_samples(mesh, "position", _laid(places))
    patch_averages.put_samples(mesh, OPEN_SHARE, _laid(share.reshape(places.shape)))
    patch_averages.put_samples(mesh, COAST_DEPTH, _laid(np.maximum(coast.ground.depth, FILM)))


def _laid(field: NDArray[np.floating]) -> RealArray:
    """A field (rows, columns, …) of a bed in the layout of points: lines along the march one after another,
    with the first samples of each, and of each line across, again at the end."""
    return wrapped(np.swapaxes(field, 0, 1), np.float32)


def _modifiers(ocean: bpy.types.Object) -> list[bpy.types.Modifier]:
    return [
        each for each in ocean.modifiers if each.type == "NODES" and is_of_kind(each.node_group, BED_POINTS)
    ]


def _new(ocean: bpy.types.Object) -> bpy.types.Object:
    name = f"{ocean.name} Bed"
    item = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    item[_MARK] = ""
    item.parent = ocean
    item.hide_viewport = item.hide_render = item.hide_select = True
    link_beside(item, ocean)
    return item
