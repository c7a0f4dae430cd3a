# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own Alembic exporter takes an ocean along, with its velocities."""

import bpy
import numpy as np
import pytest

from .conftest import vertices

TOLERANCE = 1e-4  # m


@pytest.mark.skipif(not bpy.app.build_options.alembic, reason="this Blender was built without Alembic")
@pytest.mark.parametrize("method", ["NODES", "DISPLACE"])
def test_an_ocean_survives_alembic(
    ocean_object, make_parameters, expected, core, empty_scene, tmp_path, method
):
    parameters = make_parameters()
    ocean = ocean_object.add(empty_scene, parameters, method, "LIVE", None)
    path = str(tmp_path / "sea.abc")
    bpy.ops.wm.alembic_export(filepath=path, start=1, end=4, as_background_job=False)
    bpy.data.objects.remove(ocean)
    bpy.ops.wm.alembic_import(filepath=path, as_background_job=False)
    (item,) = (item for item in empty_scene.objects if item.type == "MESH")
    for frame in (1, 4):
        empty_scene.frame_set(frame)
        assert np.abs(vertices(item) - expected(parameters, frame)).max() < TOLERANCE
        mesh = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        velocity = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.attributes["velocity"].data.foreach_get("vector", velocity)
        wanted = core.Ocean(parameters).frame(frame, {"velocity"}).velocity
        side = parameters.resolution
        found = velocity.reshape(side + 1, side + 1, 3)[:side, :side]
        assert np.abs(found - wanted).max() < TOLERANCE
