# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea with spray, and what nodes make of it."""

import bpy
import numpy as np

from ocean_tweak.core import Ocean, OceanParameters, Spray, WaveLayer
from ocean_tweak.core.sea.spray import TileSpray

SEA = OceanParameters(
    resolution=64, domain_size=100.0, seed=2, layers=(WaveLayer(wind_speed=22.0, fetch=300e3),), spray=Spray()
)


def points(item):
    """What nodes make of the spray of an ocean: its attributes by name, (points, …)."""
    graph = bpy.context.evaluated_depsgraph_get()
    geometry = item.evaluated_get(graph).evaluated_geometry()
    cloud, found = geometry.pointcloud, {}
    for name in ("position", "velocity", "radius", "kind", "left", "mist_density"):
        size = 3 if name in ("position", "velocity") else 1
        values = np.empty(len(cloud.points) * size, np.float32)
        cloud.attributes[name].data.foreach_get("vector" if size == 3 else "value", values)
        found[name] = values.reshape(-1, size) if size == 3 else values
    return found


def spray_of(ocean):
    return next((child for child in ocean.children if child.name.endswith("Spray")), None)


def made(time):
    """The core's particles."""
    return TileSpray(Ocean(SEA)).at(time, Spray())
