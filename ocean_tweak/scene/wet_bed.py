# SPDX-License-Identifier: GPL-3.0-or-later
"""The attribute `wet` on the mesh of a sea bed: under water 1, and on land as far as waves ran up of late."""

from __future__ import annotations

from collections.abc import Iterable

import bpy
import numpy as np

from ..core import Ocean
from ..nodes.names import WET
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


def keep_only(oceans: Iterable[bpy.types.Object]) -> None:
    """Take it from meshes that are no bed of these oceans any more."""
    beds = {settings_of(ocean).coast.bed for ocean in oceans}
    wanted = {bed.data for bed in beds if bed is not None}
    for mesh in bpy.data.meshes:
        if _MARK in mesh and mesh not in wanted and mesh.library is None and not mesh.is_editmode:
            if WET in mesh.attributes:
                mesh.attributes.remove(mesh.attributes[WET])
            del mesh[_MARK]
            mesh.update_tag()
