# SPDX-License-Identifier: GPL-3.0-or-later
"""What is known of a sea at the places of the mesh over its bed."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from ..foam.model import Whitecaps
from ..synthesis.channels import CHANNELS, OF_MEMORY
from ..waves.coast.breakers import whitecaps_left
from ..waves.coast.mesh import CoastMesh, coast_mesh
from .ocean import Ocean
from .regions import Places

Array = NDArray[np.float64]
RealArray = NDArray[np.floating]

#: how wet the bed is, 0…1
WET = "wet"
#: all of it, in the order of files
OVER_BED_CHANNELS = ("displacement", "velocity", "foam", "breaking", "foam_age", "cusp", WET)


def mesh_over_bed(sea: Ocean) -> CoastMesh:
    """The mesh over the bed of a sea that has a coast."""
    assert sea.coast is not None
    return coast_mesh(sea.coast.ground, sea.parameters.domain_size, sea.parameters.resolution)


def over_bed(
    sea: Ocean, x: Array, y: Array, time: float | Fraction, wanted: Collection[str] = OVER_BED_CHANNELS
) -> dict[str, RealArray]:
    """Some of OVER_BED_CHANNELS of a sea with a coast, at rest positions in m, of one flat shape.

    Foam is that of waves which break for lack of depth; see `with_whitecaps`.
    """
    assert sea.coast is not None
    waves = [name for name in OVER_BED_CHANNELS if name in wanted and name in CHANNELS.keys() - OF_MEMORY]
    surface = sea.surface(time, waves, Places(x, y))
    fields: dict[str, RealArray] = {name: surface[name] for name in waves}
    if OF_MEMORY.intersection(wanted):
        foam, breaking, age = sea.coast.foam(x, y, time)
        found = {"foam": foam, "breaking": breaking, "foam_age": age}
        fields |= {name: field for name, field in found.items() if name in wanted}
    if WET in wanted:
        fields[WET] = sea.coast.wet(x, y, time)
    return fields


def with_whitecaps(
    sea: Ocean, fields: Mapping[str, RealArray], x: Array, y: Array, tile: Whitecaps
) -> dict[str, RealArray]:
    """Fields of `over_bed`, those of foam among them, with the open sea's whitecaps.

    tile : whitecaps of the open sea's tile
    """
    assert sea.coast is not None
    open_sea = tile.at(x, y, sea.parameters.domain_size)
    share = whitecaps_left(sea.coast.shares(x, y).value).astype(np.float32)
    left = Whitecaps(open_sea.foam * share, open_sea.breaking * share, open_sea.foam_age)
    return {**fields, **left.over(*(fields[name] for name in Whitecaps._fields))._asdict()}
