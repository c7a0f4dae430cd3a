# SPDX-License-Identifier: GPL-3.0-or-later
"""The attribute `wet` of a sea bed: under water 1, and on land as far as waves ran up of late.

It is on the mesh while the sea is live; of a bake, a modifier writes it from the files.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import bpy
import numpy as np

from ..core import Ocean
from ..core.waves.coast.ground import Ground
from ..core.waves.coast.mesh import CoastMesh
from ..export.frame_files import COAST, files_start
from ..nodes.modifier_inputs import set_inputs
from ..nodes.names import WET
from ..nodes.versioned import is_of_kind
from ..nodes.wet_bed import FILES, WET_BED
from .held_sea import modifier_of
from .patch_points import Points, frame_inputs
from .plan import Plan
from .settings import settings_of

#: custom property of meshes that have the attribute of ours
_MARK = "ocean_tweak_wet"


def refresh(ocean: bpy.types.Object, sea: Ocean, plan: Plan) -> None:
    """Write it for the plan's moment, where the bed is a mesh of this file that is not being edited.

    sea : with a coast
    """
    bed = settings_of(ocean).coast.bed
    assert sea.coast is not None
    if bed is None or bed.data.library is not None or bed.data.is_editmode:
        return
    _read_no_files(bed)
    mesh = bed.data
    attribute = mesh.attributes.get(WET)
    if attribute is None:
        attribute, mesh[_MARK] = mesh.attributes.new(WET, "FLOAT", "POINT"), True
    if (attribute.data_type, attribute.domain) != ("FLOAT", "POINT"):
        return  # it is another's
    places = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes["position"].data.foreach_get("vector", places)
    to_ocean = np.array(ocean.matrix_world.inverted_safe() @ bed.matrix_world)
    x, y = (places.reshape(-1, 3).astype(np.float64) @ to_ocean[:2, :3].T + to_ocean[:2, 3]).T / plan.scale
    attribute.data.foreach_set("value", sea.coast.wet(x, y, plan.time))
    mesh.update_tag()


def read_files(ocean: bpy.types.Object, ground: Ground, grid: CoastMesh, points: Points) -> None:
    """Let the bed, where it is of this file, be wet by baked points.

    ground, grid : whose points they are
    """
    bed = settings_of(ocean).coast.bed
    if bed is None or bed.library is not None:
        return
    if bed.data.library is None and not bed.data.is_editmode:
        _dry(bed.data)
    to_ocean = np.array(ocean.matrix_world.inverted_safe() @ bed.matrix_world)
    c, s = math.cos(ground.turn), math.sin(ground.turn)
    # lines and points of a line in a metre of the ocean's axes
    turned = np.array(((c, s), (-s, c))) / ground.step
    ways = turned @ to_ocean[:2, :3] / points.scale
    origin = turned @ to_ocean[:2, 3] / points.scale - np.array(ground.first) / ground.step
    shown = frame_inputs(points)
    del shown["Scale"], shown["Velocity Scale"]
    set_inputs(
        modifier_of(bed, WET_BED),
        {
            FILES: points.folder + files_start(points.name, COAST),
            "Row": tuple(ways[0]), "Column": tuple(ways[1]), "Origin": (*origin, 0.0),
            "Lines Before": grid.before, "Lines": ground.rows, "Points": grid.columns, **shown,
        },
    )  # fmt: skip
    bed.update_tag()


def keep_only(oceans: Iterable[bpy.types.Object]) -> None:
    """Take it from what is no bed of these oceans any more."""
    wanted = {settings_of(ocean).coast.bed for ocean in oceans} - {None}
    for item in bpy.data.objects:
        if item not in wanted and item.library is None:
            _read_no_files(item)
    meshes = {bed.data for bed in wanted}
    for mesh in bpy.data.meshes:
        if mesh not in meshes and mesh.library is None and not mesh.is_editmode:
            _dry(mesh)


def _read_no_files(item: bpy.types.Object) -> None:
    for modifier in [each for each in item.modifiers if each.type == "NODES"]:
        if is_of_kind(modifier.node_group, WET_BED):
            item.modifiers.remove(modifier)


def _dry(mesh: bpy.types.Mesh) -> None:
    """Take the attribute from a mesh that has it of ours."""
    if _MARK not in mesh:
        return
    if WET in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[WET])
    del mesh[_MARK]
    mesh.update_tag()
