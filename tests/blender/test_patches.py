# SPDX-License-Identifier: GPL-3.0-or-later
"""The node group by itself: it makes a grid or moves a mesh, and adds patches by the stated rules."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from .conftest import evaluated_mesh
from .surfaces import read

SPACING = 6.25  # Blender units between samples; exact in floats
NAMES = ("Displacement", "Foam", "Normal", "Velocity")


@pytest.fixture
def inputs(extension):
    return extension("nodes.modifier_inputs")


@pytest.fixture
def sea(extension, empty_scene, inputs):
    """An object with the group for some patches of random texels: resolutions → object, modifier, texels."""

    def make(*resolutions, mesh=None, **values):
        chance = np.random.default_rng(5)
        item = bpy.data.objects.new("Sea", mesh or bpy.data.meshes.new("Sea"))
        empty_scene.collection.objects.link(item)
        modifier = item.modifiers.new("Sea", "NODES")
        kind = extension("nodes.ocean").ocean_group(len(resolutions))
        modifier.node_group = extension("nodes.versioned").node_group(kind)
        patches = []
        for number, samples in enumerate(resolutions, start=1):
            suffix = "" if number == 1 else f" {number}"
            patches.append({})
            for name in NAMES:
                texels = chance.uniform(-1.0, 1.0, (samples, samples, 4)).astype(np.float32)
                if name in ("Foam", "Normal"):
                    texels = np.abs(texels)
                patches[-1][name] = texels[..., :3].astype(np.float64)
                image = bpy.data.images.new(name, samples, samples, float_buffer=True, is_data=True)
                image.alpha_mode = "NONE"
                image.pixels.foreach_set(texels.reshape(-1))
                image.update_tag()
                inputs.set_input(modifier, name + suffix, image)
            inputs.set_input(modifier, "Domain Size" + suffix, samples * SPACING)
            inputs.set_input(modifier, "Resolution" + suffix, samples)
        inputs.set_inputs(modifier, values)
        item.update_tag()
        return SimpleNamespace(item=item, modifier=modifier, patches=patches)

    return make


def over(texels, rows, columns):
    """Texels [y, x] over a grid that starts at the first one."""
    return texels[np.ix_(np.arange(rows) % len(texels), np.arange(columns) % len(texels))]


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def test_one_patch_over_repeats_of_its_own_grid(sea):
    made = sea(16, **{"Make Grid": True, "Size": 100.0, "Quads": 16, "Repeats X": 3, "Repeats Y": 2})
    rows, columns = 2 * 16 + 1, 3 * 16 + 1
    found = read(evaluated_mesh(made.item), rows, columns)
    texels = {name: over(values, rows, columns) for name, values in made.patches[0].items()}
    np.testing.assert_array_equal(found["displacement"], texels["Displacement"])
    np.testing.assert_array_equal(found["velocity"], texels["Velocity"])
    np.testing.assert_array_equal(found["foam"][..., 0], texels["Foam"][..., 0])
    np.testing.assert_array_equal(found["cusp"][..., 0], texels["Foam"][..., 1])
    np.testing.assert_allclose(found["normal"], unit(texels["Normal"]), atol=1e-6)
    flat = found["position"] - found["displacement"]
    np.testing.assert_allclose(
        flat[..., 0], np.broadcast_to(np.arange(columns) * SPACING, (rows, columns)), atol=1e-4
    )
    np.testing.assert_allclose(
        flat[..., 1].T, np.broadcast_to(np.arange(rows) * SPACING, (columns, rows)), atol=1e-4
    )


@pytest.mark.parametrize("by_position", [True, False])
def test_patches_add(sea, inputs, by_position, extension):
    values = {"Make Grid": True, "Size": 100.0, "Quads": 16}
    mesh = None
    if by_position:
        mesh = bpy.data.meshes.new("Grid")
        extension("scene.grid_mesh").fill(mesh, extension("scene.grid_mesh").Grid(100.0, 16, 16))
        mesh.uv_layers.remove(mesh.uv_layers["st"])
        values = {}
    made = sea(16, 8, 4, mesh=mesh, **values)
    parts = [{name: over(texels, 17, 17) for name, texels in patch.items()} for patch in made.patches]
    found = read(evaluated_mesh(made.item), 17, 17)

    def total(name):
        return sum(part[name] for part in parts)

    np.testing.assert_allclose(found["displacement"], total("Displacement"), atol=1e-5)
    np.testing.assert_allclose(found["velocity"], total("Velocity"), atol=1e-5)
    np.testing.assert_allclose(found["cusp"][..., 0], total("Foam")[..., 1], atol=1e-5)
    uncovered = np.prod([1.0 - part["Foam"][..., 0] for part in parts], axis=0)
    np.testing.assert_allclose(found["foam"][..., 0], 1.0 - uncovered, atol=1e-5)
    normals = [unit(part["Normal"]) for part in parts]
    slope = sum(normal[..., :2] / np.maximum(normal[..., 2:], 0.01) for normal in normals)
    wanted = unit(np.concatenate([slope, np.ones((17, 17, 1))], axis=-1))
    np.testing.assert_allclose(found["normal"], wanted, atol=1e-4)


def test_a_mesh_that_was_moved_already_is_read_where_it_was_at_rest(sea, extension):
    """As behind a Displace modifier: `st` tells."""
    grid_mesh = extension("scene.grid_mesh")
    mesh = bpy.data.meshes.new("Grid")
    grid_mesh.fill(mesh, grid_mesh.Grid(100.0, 16, 16))
    for vertex in mesh.vertices:
        vertex.co += type(vertex.co)((0.7, -0.4, 2.0))
    made = sea(16, 8, mesh=mesh, Move=False)
    found = read(evaluated_mesh(made.item), 17, 17)
    parts = [over(patch["Displacement"], 17, 17) for patch in made.patches]
    np.testing.assert_allclose(found["displacement"], sum(parts), atol=1e-5)
    assert found["position"][3, 4] == pytest.approx((4 * SPACING + 0.7, 3 * SPACING - 0.4, 2.0), abs=1e-4)


def test_scales_make_blender_units(sea):
    made = sea(8, **{"Make Grid": True, "Size": 50.0, "Quads": 8, "Scale": 2.0, "Velocity Scale": 3.0})
    found = read(evaluated_mesh(made.item), 9, 9)
    np.testing.assert_allclose(found["displacement"], 2.0 * over(made.patches[0]["Displacement"], 9, 9))
    np.testing.assert_allclose(found["velocity"], 3.0 * over(made.patches[0]["Velocity"], 9, 9), rtol=1e-6)


def test_faces_of_any_mesh_become_smooth_with_normals(sea, extension):
    grid_mesh = extension("scene.grid_mesh")
    mesh = bpy.data.meshes.new("Grid")
    grid_mesh.fill(mesh, grid_mesh.Grid(50.0, 8, 8))
    mesh.shade_flat()
    found = read(evaluated_mesh(sea(8, mesh=mesh).item), 9, 9)
    assert "normal" in found


@pytest.mark.parametrize(
    "values",
    [{"Make Grid": True, "Repeats X": 0, "Repeats Y": -3, "Quads": 0},
     {"Make Grid": True, "Quads": 8, "Size": 0.0},
     {"Make Grid": True, "Quads": 8, "Domain Size": 0.0},
     {"Make Grid": True, "Quads": 8, "Resolution": 0},
     {"Make Grid": False}],
)  # fmt: skip
def test_values_that_make_no_sense_make_no_trouble(sea, values):
    mesh = evaluated_mesh(sea(8, **values).item)
    positions = np.array([tuple(vertex.co) for vertex in mesh.vertices])
    quads = max(values.get("Quads", 1), 1)
    assert len(positions) == ((quads + 1) ** 2 if values["Make Grid"] else 0)
    assert np.isfinite(positions).all()
