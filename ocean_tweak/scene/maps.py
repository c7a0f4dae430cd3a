# SPDX-License-Identifier: GPL-3.0-or-later
"""What a surface consists of: fields of the core, images of maps, attributes of the mesh."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..nodes.names import CUSP, DISPLACEMENT, FOAM, NORMAL, VELOCITY
from .settings import OceanSettings

RealArray = NDArray[np.float32]
#: by output of the core, [y, x]
Fields = Mapping[str, RealArray]


class Map(NamedTuple):
    """One image.

    outputs : fields of the core that it holds
    image : from those to (N, N, 3)
    """

    outputs: frozenset[str]
    image: Callable[[Fields], RealArray]


def _foam_image(fields: Fields) -> RealArray:
    """R foam, G cusp, B nothing."""
    return np.stack((fields["foam"], fields["cusp"], np.zeros_like(fields["foam"])), axis=-1)


#: by name in files
MAPS: dict[str, Map] = {
    "disp": Map(frozenset({"displacement"}), lambda fields: fields["displacement"]),
    "foam": Map(frozenset({"foam", "cusp"}), _foam_image),
    "normal": Map(frozenset({"normal"}), lambda fields: fields["normal"]),
    "vel": Map(frozenset({"velocity"}), lambda fields: fields["velocity"]),
}

#: the mesh's attribute of each field, and whether it is in metres or metres per second
ATTRIBUTES: dict[str, tuple[str, bool]] = {
    "displacement": (DISPLACEMENT, True),
    "velocity": (VELOCITY, True),
    "normal": (NORMAL, False),
    "foam": (FOAM, False),
    "cusp": (CUSP, False),
}


def wanted_maps(settings: OceanSettings) -> tuple[str, ...]:
    """The maps that an ocean's switches ask for."""
    switches = {"foam": settings.use_foam, "normal": settings.use_normals, "vel": settings.use_velocity}
    return tuple(name for name in MAPS if switches.get(name, True))


def outputs_of(maps: tuple[str, ...]) -> frozenset[str]:
    """The fields that maps are made of."""
    return frozenset().union(*(MAPS[name].outputs for name in maps))
