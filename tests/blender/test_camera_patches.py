# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface around the camera shows a sea of several patches: their sum, near and far."""

import dataclasses
import math

import bpy
import numpy as np
import pytest

from . import camera_views
from .camera_views import away, coarseness, faces_along_edges, heights, moved_to, numbers
from .conftest import evaluated_mesh
from .sheets import wave

# fixtures for the tests here
around, camera, sheet = camera_views.around, camera_views.camera, camera_views.sheet

FINEST = 9.0 / 32  # m, of the samples of the last patch
TURN = 0.7


@pytest.fixture
def patched(core, make_parameters):
    """Three patches of different size and turn, and waves in each."""

    def make(**changes):
        layer = core.WaveLayer(wind_speed=8.0, fetch=20e3, wind_direction=0.4)
        patches = (
            core.Patch(domain_size=150.0, shortest_wavelength=15.0, resolution=64),
            core.Patch(
                domain_size=41.0,
                longest_wavelength=15.0,
                shortest_wavelength=4.0,
                rotation=0.97,
                resolution=48,
            ),
            core.Patch(
                domain_size=9.0, longest_wavelength=4.0, shortest_wavelength=1.2, rotation=0.37, resolution=32
            ),
        )
        return make_parameters(layers=(layer,), **{"patches": patches, **changes})

    return make


@pytest.fixture
def shown(extension, ocean_object, patched, camera, empty_scene):
    """An ocean of patches with a surface around the camera: parameters → ocean and surface."""

    def make(parameters=None, **inputs):
        ocean = ocean_object.add(empty_scene, parameters or patched())
        item = extension("scene.camera_surface").add_camera_surface(ocean, empty_scene, budget=20_000)
        settings = {"Finest Spacing": 0.5 * FINEST, "To Horizon": False, "Reach": 300.0, "Curvature": False}
        extension("nodes.modifier_inputs").set_inputs(item.modifiers[0], {**settings, **inputs})
        bpy.context.view_layer.update()
        return ocean, item

    return make


def patch_objects(ocean):
    return sorted((item for item in ocean.children if "Patch" in item.name), key=lambda item: item.name)


def normals(mesh):
    flat = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertex_normals.foreach_get("vector", flat)
    return flat.reshape(-1, 3)


def under_masks(core, parameters):
    """Two wave layers under one mask each, of which one is everywhere, and the last patch under another."""
    harbour = core.Mask(x=40.0, y=40.0, inner_radius=5.0, outer_radius=60.0)
    shore = core.Mask(source="IMAGE", image=core.Raster([[0.2, 1.0, 0.6], [0.0, 0.4, 1.0]]))
    (layer,) = parameters.layers
    lee = core.WaveLayer(wind_speed=5.0, fetch=3e3, wind_direction=-1.0)
    *others, last = parameters.patches
    return parameters.replace(
        layers=(dataclasses.replace(layer, mask=harbour), lee),
        patches=(*others, dataclasses.replace(last, mask=shore)),
    )


@pytest.mark.parametrize("turn", [0.0, TURN])
@pytest.mark.parametrize("masks", [False, True])
def test_near_the_camera_it_is_the_sum(shown, core, patched, camera, empty_scene, turn, masks):
    parameters = under_masks(core, patched()) if masks else patched()
    ocean, item = shown(parameters)
    ocean.rotation_euler.z = turn
    moved_to(ocean, 20.0, 30.0, 4.0)
    eye = np.array(ocean.matrix_world.inverted() @ camera.location)
    for frame in (1, 9):
        empty_scene.frame_set(frame)
        mesh = evaluated_mesh(item)
        displacement = numbers(mesh, "displacement", 3)
        rest = numbers(mesh, "position", 3) - displacement
        off = np.abs(rest - eye)[:, :2].max(axis=1)
        near = off < 0.5 * (coarseness(mesh) - 1) * 0.5 * FINEST
        assert np.count_nonzero(near) > 300
        names = {"displacement", "velocity", "normal"}
        time = parameters.timing.time(frame)
        sea = core.Ocean(parameters).surface(time, names, on=core.Places(rest[near, 0], rest[near, 1]))
        # both are bilinear between the patches' samples; places are rounded to a float
        np.testing.assert_allclose(displacement[near], sea.displacement, atol=1e-3)
        np.testing.assert_allclose(numbers(mesh, "velocity", 3)[near], sea.velocity, atol=3e-3)
        # weights are bilinear between points 0.6 m apart, and their change is one number in each cell
        np.testing.assert_allclose(normals(mesh)[near], sea.normal, atol=4e-3 if masks else 2e-3)


def test_masks_part_patches_into_meshes_with_weights(shown, core, patched, empty_scene):
    """Patches times masks; one set of weights, which goes with the masks; too many are told."""
    ocean, _ = shown(under_masks(core, patched()))
    assert len(patch_objects(ocean)) == 6
    (points,) = [child for child in ocean.children if "Weights" in child.name]
    names = [attribute.name for attribute in points.data.attributes if "weight" in attribute.name]
    assert sorted(names) == [f"ocean_tweak_weight_{number}" for number in (2, 4, 5, 6)]
    settings = ocean.ocean_tweak
    settings.layers[0].mask.inner_radius = 20.0
    bpy.context.view_layer.update()
    settings.layers[0].mask.source = "NONE"
    settings.patches[2].mask.source = "NONE"
    assert len(patch_objects(ocean)) == 3
    assert not [child for child in ocean.children if "Weights" in child.name]
    assert not settings.error
    layers = tuple(core.WaveLayer(mask=core.Mask(x=float(number))) for number in range(3))
    settings.from_parameters(patched().replace(layers=layers), empty_scene)
    assert "9" in settings.error
    assert "camera surface" in settings.error


def test_the_edges_are_whole(shown):
    _, item = shown()
    mesh = evaluated_mesh(item)
    faces_of = faces_along_edges(mesh)
    assert set(faces_of) == {1, 2}
    points = numbers(mesh, "position", 3) - numbers(mesh, "displacement", 3)
    ends = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", ends)
    lonely = points[ends.reshape(-1, 2)[faces_of == 1]].reshape(-1, 3)
    at_edge = (np.abs(lonely - points.min(axis=0)) < 1e-2) | (np.abs(lonely - points.max(axis=0)) < 1e-2)
    assert at_edge[:, :2].any(axis=1).all()


def waves_of(sheet, size, samples, count, height, turn=0.0):
    """A patch with one wave along its x axis, with its slope and strain, turned; and the wave number."""
    k = 2.0 * math.pi * count / size

    def slope(rest):
        field = np.zeros(rest.shape)
        field[..., 0] = -height * k * np.sin(k * rest[..., 0])
        return field

    item = sheet(wave(samples, count, height), size, attributes={"slope": slope, "strain": np.zeros_like})
    item.rotation_euler.z = turn
    item.hide_viewport = item.hide_render = True
    return item, k


def test_on_a_flight_heights_stay_within_what_interpolation_allows(around, sheet, camera):
    """The sum of two waves, each off by up to A k² a²/8 between points a apart."""
    first, k1 = waves_of(sheet, 64.0, 64, 3, 0.4)
    second, k2 = waves_of(sheet, 20.0, 64, 4, 0.1, TURN)
    flat = sheet(np.zeros((8, 8, 3)), 64.0)
    item = around(
        flat, patch_1=first, patch_2=second, finest_spacing=0.25, fade=False, curvature=False,
        to_horizon=False, reach=400.0,
    )  # fmt: skip
    generator = np.random.default_rng(3)
    points = generator.uniform((-20.0, -60.0), (120.0, 60.0), (200, 2))
    points[:120, 1] = 0.37 * points[:120, 0] + 0.05 * points[:120, 1]
    along = points[:, 0] * math.cos(TURN) + points[:, 1] * math.sin(TURN)
    truth = 0.4 * np.cos(k1 * points[:, 0]) + 0.1 * np.cos(k2 * along)
    half = coarseness(evaluated_mesh(item))
    for step in range(101):
        moved_to(camera, float(step), 0.37 * step, 6.0)
        off = np.abs(heights(item, points) - truth)
        cell = 2.0 * (away(points, camera) + 0.5) / (half - 2)
        # along the diagonal of a cell the second wave is read over a longer way
        bound = sum(
            np.minimum(height * k**2 / 8.0 * (2.0 * cell**2 + spacing**2), 2.0 * height)
            for height, k, spacing in ((0.4, k1, 1.0), (0.1, k2, 20.0 / 64))
        )
        assert (off <= bound + 1e-4).all()


def test_a_weight_on_the_ocean_s_mesh_multiplies_its_patch(around, sheet, camera):
    first, k1 = waves_of(sheet, 64.0, 64, 3, 0.4)
    second, k2 = waves_of(sheet, 20.0, 64, 4, 0.1, TURN)

    def weight(rest):
        return np.where(rest[..., :1] < 32.0, 0.25, 1.0)

    flat = sheet(np.zeros((64, 64, 3)), 64.0, attributes={"ocean_tweak_weight_2": weight})
    item = around(
        flat, patch_1=first, patch_2=second, finest_spacing=0.15, curvature=False, to_horizon=False,
        reach=1500.0, vertex_budget=20_000,
    )  # fmt: skip
    mesh = evaluated_mesh(item)
    displacement, slopes = numbers(mesh, "displacement", 3), normals(mesh)
    rest = numbers(mesh, "position", 3) - displacement
    near = away(rest, camera) < 0.5 * (coarseness(mesh) - 1) * 0.15
    x, y = rest[near, :2].T
    known = (x % 64.0 < 31.0) | ((x % 64.0 > 32.5) & (x % 64.0 < 63.0))
    share = np.where(x % 64.0 < 32.0, 0.25, 1.0)
    along = x * math.cos(TURN) + y * math.sin(TURN)
    truth = 0.4 * np.cos(k1 * x) + share * 0.1 * np.cos(k2 * along)
    assert np.count_nonzero(known & (share < 1.0)) > 100
    assert np.count_nonzero(known & (share == 1.0)) > 20
    np.testing.assert_allclose(displacement[near, 2][known], truth[known], atol=6e-3)
    steep = -share * 0.1 * k2 * np.sin(k2 * along)
    expected = -0.4 * k1 * np.sin(k1 * x) + steep * math.cos(TURN)
    of_x = -slopes[near, 0] / slopes[near, 2]
    np.testing.assert_allclose(of_x[known], expected[known], atol=1e-2)
    # far away all of it is slope variance: in the mean half of (A k)², times the weight's square
    far = away(rest, camera) > 1000.0
    lost = numbers(mesh, "slope_variance", 1)[:, 0]
    for side, share in ((rest[:, 0] % 64.0 < 31.0, 0.25), ((rest[:, 0] - 32.5) % 64.0 < 30.5, 1.0)):
        squares = 0.5 * (0.4 * k1) ** 2 + 0.5 * (share * 0.1 * k2) ** 2
        np.testing.assert_allclose(lost[far & side], squares, rtol=0.01)


def test_a_weight_that_changes_is_a_part_of_the_normals(around, sheet, camera):
    """Water moved alike everywhere, by D: its gradient is D ∂w, whose shear is the mean of both."""
    moved, by_x, by_y = np.array([20.0, -30.0, 10.0]), 0.005, 0.006

    def weight(rest):
        return 0.1 + by_x * rest[..., :1] + by_y * rest[..., 1:2]

    still = {"slope": np.zeros_like, "strain": np.zeros_like}
    patch = sheet(np.broadcast_to(moved, (32, 32, 3)), 64.0, attributes=still)
    patch.hide_viewport = patch.hide_render = True
    flat = sheet(np.zeros((64, 64, 3)), 64.0, attributes={"ocean_tweak_weight_1": weight})
    item = around(flat, patch_1=patch, finest_spacing=0.5, curvature=False, to_horizon=False, reach=60.0)
    mesh = evaluated_mesh(item)
    rest = numbers(mesh, "position", 3) - numbers(mesh, "displacement", 3)
    inside = np.all((rest[:, :2] % 64.0 > 2.0) & (rest[:, :2] % 64.0 < 62.0), axis=1)
    shear = 0.5 * (moved[0] * by_y + moved[1] * by_x)
    along_x = np.array([1.0 + moved[0] * by_x, shear, moved[2] * by_x])
    along_y = np.array([shear, 1.0 + moved[1] * by_y, moved[2] * by_y])
    normal = np.cross(along_x, along_y)
    assert np.count_nonzero(inside) > 100
    np.testing.assert_allclose(normals(mesh)[inside] - normal / np.linalg.norm(normal), 0.0, atol=2e-3)


def test_slopes_are_in_the_geometry_or_told_as_variance(shown, core, patched, camera):
    """Near and far the squares of what the normals show and what is told are those of all patches."""
    parameters = patched(choppiness=0.01)
    _, item = shown(parameters, **{"Reach": 6000.0})
    mesh = evaluated_mesh(item)
    facing = normals(mesh).astype(np.float64)
    held = ((facing[:, :2] / facing[:, 2:]) ** 2).sum(axis=1)
    lost = numbers(mesh, "slope_variance", 1)[:, 0]
    off = away(numbers(mesh, "position", 3), camera)
    total = sum(
        (patch.surface(0.0, {"slope"}).slope.astype(np.float64) ** 2).sum(axis=-1).mean()
        for patch in core.Ocean(parameters).patches
    )
    far = off > 5000.0
    assert lost[far].mean() == pytest.approx(total, rel=0.02)
    assert held[far].max() < 1e-3 * total
    middle = (off > 4.0) & (off < 75.0)
    # vertices stand for the more water the farther they are
    mean = np.average((held + lost)[middle], weights=off[middle] ** 2)
    assert mean == pytest.approx(total, rel=0.05)
    between = (off > 4.0) & (off < 15.0)
    assert 0.1 * total < held[between].mean() < 0.9 * total
    near = off < 0.5 * (coarseness(mesh) - 1) * 0.5 * FINEST
    assert held[near].mean() > 3.0 * lost[near].mean()


def test_patches_come_and_go_with_the_surface(shown, extension, patched, empty_scene):
    ocean, item = shown()
    found = patch_objects(ocean)
    tables = [numbers(each.data, "ocean_tweak_averages", 3) for each in found]
    assert [tuple(table[0, :2]) for table in tables] == [(65, 65), (49, 49), (33, 33)]
    # their averages follow, down to one cell, which has four points
    assert [table[round(-table[0, 2]) - 1, 2] for table in tables] == [len(table) - 4 for table in tables]
    assert all(each.hide_viewport and each.hide_render and each.hide_select for each in found)
    assert [each.rotation_euler.z for each in found] == pytest.approx([0.0, 0.97, 0.37])
    count = len(bpy.data.meshes)
    settings = extension("scene.settings").settings_of(ocean)
    # fewer, of another size and resolution
    last = patched().patches[2]
    others = (
        extension("core").Patch(domain_size=150.0, shortest_wavelength=4.0, resolution=96),
        extension("core").Patch(
            domain_size=12.0, longest_wavelength=4.0, shortest_wavelength=1.0, rotation=1.1, resolution=48
        ),
    )
    settings.from_parameters(patched(patches=others), empty_scene)
    found = patch_objects(ocean)
    assert [numbers(each.data, "ocean_tweak_averages", 3)[0, 0] for each in found] == [97, 49]
    assert found[1].rotation_euler.z == pytest.approx(1.1)
    assert len(bpy.data.meshes) == count - 1
    get = extension("nodes.modifier_inputs").get_input
    assert [get(item.modifiers[0], f"Patch {number}") for number in (1, 2, 3)] == [*found, None]
    # a sea of one patch needs none
    settings.from_parameters(patched(patches=()), empty_scene)
    assert patch_objects(ocean) == []
    assert get(item.modifiers[0], "Patch 1") is None
    settings.from_parameters(patched(patches=(*others[:1], last.__class__(
        domain_size=9.0, longest_wavelength=4.0, resolution=32))), empty_scene)  # fmt: skip
    assert len(patch_objects(ocean)) == 2
    extension("scene.camera_surface").remove_camera_surface(ocean)
    assert patch_objects(ocean) == []
    assert len(bpy.data.meshes) == 1


def test_baked_oceans_have_live_patches(shown, extension, make_parameters, bake, patched, empty_scene):
    parameters = patched()
    ocean, item = shown(parameters)
    other = make_parameters()
    extension("scene.ocean_object").use_sequence(ocean, empty_scene, bake(other, 1, 3))
    first = numbers(evaluated_mesh(item), "displacement", 3)
    empty_scene.frame_set(3)
    moved = numbers(evaluated_mesh(item), "displacement", 3)
    assert np.abs(first).max() > 0.1
    assert np.abs(moved - first).max() > 0.01


def test_a_duplicate_has_patches_of_its_own(shown, extension, empty_scene, window):
    ocean, item = shown()
    members = [ocean, item, *patch_objects(ocean)]
    for each in members:
        each.hide_viewport = each.hide_select = False
    bpy.context.view_layer.update()
    with window.override():
        for each in members:
            each.select_set(True)
        bpy.context.view_layer.objects.active = ocean
        bpy.ops.object.duplicate(linked=True)
    other = bpy.context.view_layer.objects.active
    assert other != ocean
    empty_scene.frame_set(2)
    found = patch_objects(other)
    assert len(found) == len(patch_objects(ocean)) == 3
    meshes = {each.data for each in (*found, *patch_objects(ocean))}
    assert len(meshes) == 6
    surface = extension("scene.camera_surface").camera_surface_of(other)
    get = extension("nodes.modifier_inputs").get_input
    assert [get(surface.modifiers[0], f"Patch {number}") for number in (1, 2, 3)] == found


def test_undo_and_what_is_left_of_a_deleted_ocean(shown, extension, empty_scene, window, tmp_path, patched):
    ocean, _ = shown()
    bpy.context.view_layer.objects.active = ocean
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        assert bpy.ops.ocean.remove_camera_surface() == {"FINISHED"}
        bpy.ops.ed.undo_push(message="removed")
        assert patch_objects(bpy.data.objects[ocean.name]) == []
        bpy.ops.ed.undo()
        ocean = bpy.data.objects["Ocean"]
        assert len(patch_objects(ocean)) == 3
        bpy.ops.ed.redo()
        assert patch_objects(bpy.data.objects["Ocean"]) == []
        bpy.ops.ed.undo()
    bpy.data.objects.remove(bpy.data.objects["Ocean"])
    file = str(tmp_path / "left.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=file)
    assert not [item for item in bpy.data.objects if "Patch" in item.name]


def test_a_linked_ocean_shows_the_merged_sea(shown, extension, tmp_path):
    shown()
    file = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(file, link=True) as (there, here):
        here.objects = list(there.objects)
    scene = bpy.context.scene
    for item in here.objects:
        scene.collection.objects.link(item)
    scene.frame_set(5)
    surface = next(item for item in here.objects if "Surface" in item.name)
    assert np.abs(numbers(evaluated_mesh(surface), "displacement", 3)).max() > 0.1
    # that of its own mesh: files are without patches that are live
    assert not [item for item in bpy.data.objects if "Patch" in item.name]
