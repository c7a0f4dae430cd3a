# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface around the camera: closed, steady, within its budget, and the ocean's own."""

import math

import bpy
import numpy as np
import pytest

from . import camera_views
from .camera_views import (
    BUDGET,
    away,
    coarseness,
    faces_along_edges,
    flat_sheet,
    heights,
    moved_to,
    numbers,
    places,
)
from .conftest import DOMAIN, SAMPLES, evaluated_mesh
from .sheets import wave

# fixtures for the tests here
around, camera, sheet = camera_views.around, camera_views.camera, camera_views.sheet

RADIUS = 6_371_000.0  # m


@pytest.mark.parametrize("place", [(0.0, 0.0), (3.1, -2.2), (0.49, 5.01), (-1000.3, 777.7)])
@pytest.mark.parametrize("budget", [1500, 20_000])
def test_no_crack_and_no_more_vertices_than_allowed(around, sheet, camera, place, budget):
    item = around(flat_sheet(sheet), vertex_budget=budget, curvature=False)
    moved_to(camera, *place, 10.0)
    mesh = evaluated_mesh(item)
    assert 0.8 * budget < len(mesh.vertices) <= budget
    points = numbers(mesh, "position", 3)
    assert len(np.unique(points, axis=0)) == len(points)
    faces_of = faces_along_edges(mesh)
    assert set(faces_of) == {1, 2}
    # only around the square are edges of one face, and the square is full
    ends = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", ends)
    lonely = points[ends.reshape(-1, 2)[faces_of == 1]].reshape(-1, 3)
    low, high = points.min(axis=0), points.max(axis=0)
    at_edge = (np.abs(lonely - low) < 1e-2) | (np.abs(lonely - high) < 1e-2)
    assert at_edge[:, :2].any(axis=1).all()
    areas = np.empty(len(mesh.polygons), np.float32)
    mesh.polygons.foreach_get("area", areas)
    assert areas.min() > 0.02  # half of a cell of a quarter
    assert areas.astype(np.float64).sum() == pytest.approx(np.prod((high - low)[:2]), rel=1e-5)
    assert all(face.normal.z > 0.0 for face in mesh.polygons)


def test_no_crack_far_away_where_cells_are_small(around, sheet, camera):
    item = around(flat_sheet(sheet), vertex_budget=20_000, finest_spacing=0.01, curvature=False)
    moved_to(camera, 31.3, -17.2, 10.0)
    mesh = evaluated_mesh(item)
    points = numbers(mesh, "position", 3)
    assert away(points, camera).max() > 10e3
    assert len(np.unique(points, axis=0)) == len(points)
    assert not item.modifiers[0].node_warnings


def test_it_reaches_the_horizon(around, sheet, camera):
    item = around(flat_sheet(sheet))
    for height in (2.0, 40.0):
        moved_to(camera, 100.0, 50.0, height)
        points = places(item)
        horizon = math.sqrt(2.0 * RADIUS * height)
        for side in (points.min(axis=0), points.max(axis=0)):
            distance = np.abs(side - camera.location)[:2]
            assert ((distance >= horizon) & (distance < 2.5 * horizon)).all()
    under = around(flat_sheet(sheet))
    moved_to(camera, 100.0, 50.0, -5.0)
    assert away(places(under), camera).max() > math.sqrt(2.0 * RADIUS * 2.0)


def test_the_water_falls_away_as_on_a_globe(around, sheet, camera):
    moved_to(camera, 10.0, 20.0, 30.0)
    ocean = flat_sheet(sheet)
    for item, radius in ((around(ocean), RADIUS), (around(ocean, planet_radius=9e5), 9e5)):
        points = places(item)
        distance = np.hypot(*(points[:, :2] - (10.0, 20.0)).T)
        np.testing.assert_allclose(points[:, 2], -(distance**2) / (2.0 * radius), rtol=1e-4, atol=1e-4)
    flat = places(around(ocean, curvature=False))
    np.testing.assert_array_equal(flat[:, 2], 0.0)


def test_a_budget_that_is_too_small_ends_the_surface_early(around, sheet, camera):
    ocean = flat_sheet(sheet)
    moved_to(camera, 0.0, 0.0, 100.0)
    for budget in (0, 25, 100, 700, 1300):
        item = around(ocean, vertex_budget=budget)
        points = places(item)
        assert len(points) <= max(budget, 25)
        assert away(points, camera).max() < math.sqrt(2.0 * RADIUS * 100.0)
        (told,) = item.modifiers[0].node_warnings
        assert told.type == "WARNING"
        assert "units: raise Vertex Budget or Finest Spacing" in told.message
    item = around(ocean, vertex_budget=4000)
    places(item)
    assert not item.modifiers[0].node_warnings
    moved_to(camera, 0.0, 0.0, -3.0)
    places(item)
    (told,) = item.modifiers[0].node_warnings
    assert told.type == "INFO"
    assert "under water" in told.message


def test_around_which_camera(around, sheet, camera, empty_scene):
    ocean = flat_sheet(sheet)
    other = bpy.data.objects.new("Other", bpy.data.cameras.new("Other"))
    empty_scene.collection.objects.link(other)
    moved_to(other, -500.0, 40.0, 5.0)
    scenes, given = around(ocean), around(ocean, camera=other)

    def middle(item):
        points = places(item)
        near = points[points[:, 2] > -1e-6]
        return 0.5 * (near.min(axis=0) + near.max(axis=0))[:2]

    np.testing.assert_allclose(middle(scenes), camera.location[:2], atol=1.0)
    np.testing.assert_allclose(middle(given), other.location[:2], atol=1.0)
    moved_to(camera, 80.0, 90.0, 5.0)
    np.testing.assert_allclose(middle(scenes), (80.0, 90.0), atol=1.0)
    empty_scene.camera = None
    moved_to(scenes, 7.0, 8.0, 0.0)
    np.testing.assert_allclose(middle(scenes), (0.0, 0.0), atol=1.0)


def test_near_the_camera_it_is_the_core_s_sea(
    around, ocean_object, core, make_parameters, camera, empty_scene
):
    parameters = make_parameters()
    ocean = ocean_object.add(empty_scene, parameters)
    spacing = 0.5 * DOMAIN / SAMPLES
    item = around(ocean, finest_spacing=spacing, curvature=False, to_horizon=False, reach=300.0)
    for frame in (1, 9):
        empty_scene.frame_set(frame)
        mesh = evaluated_mesh(item)
        points = numbers(mesh, "position", 3)
        rest = points - numbers(mesh, "displacement", 3)
        near = away(rest, camera) < 0.5 * (coarseness(mesh) - 1) * spacing
        assert np.count_nonzero(near) > 300
        found = core.Ocean(parameters).height_at(
            points[near, 0], points[near, 1], parameters.timing.time(frame)
        )
        np.testing.assert_allclose(points[near, 2], found, atol=1e-3)
        np.testing.assert_allclose(rest / spacing, np.round(rest / spacing), atol=1e-3)


def test_attributes_go_on_as_the_ocean_s(around, ocean_object, make_parameters, camera, empty_scene):
    parameters = make_parameters()
    ocean = ocean_object.add(empty_scene, parameters)
    item = around(ocean, finest_spacing=DOMAIN / SAMPLES, fade=False, to_horizon=False, reach=300.0)
    own, shown = evaluated_mesh(ocean), evaluated_mesh(item)
    rest = numbers(shown, "position", 3) - numbers(shown, "displacement", 3)
    rest[:, 2] = 0.0
    column, row = np.round(rest[:, :2] / (DOMAIN / SAMPLES)).astype(int).T
    sample = (row % SAMPLES) * (SAMPLES + 1) + column % SAMPLES
    for name, count in (("displacement", 3), ("velocity", 3), ("foam", 1), ("cusp", 1)):
        # at whole samples, but for rounding of the place
        np.testing.assert_allclose(numbers(shown, name, count), numbers(own, name, count)[sample], atol=2e-3)
    corners = np.empty(len(shown.loops), np.int32)
    shown.loops.foreach_get("vertex_index", corners)
    st = np.empty(2 * len(shown.loops), np.float32)
    shown.attributes["st"].data.foreach_get("vector", st)
    expected = rest[corners, :2] / DOMAIN + 0.5 / SAMPLES
    np.testing.assert_allclose(st.reshape(-1, 2), expected, atol=1e-3)
    np.testing.assert_array_equal(numbers(shown, "slope_variance", 1), 0.0)


def test_of_an_ocean_that_is_turned(around, ocean_object, core, make_parameters, camera, empty_scene):
    parameters = make_parameters()
    ocean = ocean_object.add(empty_scene, parameters)
    ocean.rotation_euler.z = 0.7
    moved_to(ocean, 20.0, 30.0, 4.0)
    item = around(
        ocean, finest_spacing=0.5 * DOMAIN / SAMPLES, curvature=False, to_horizon=False, reach=300.0
    )
    moved_to(item, 5.0, 0.0, 1.0)
    points = places(item)
    world = points @ np.array(item.matrix_world)[:3, :3].T + np.array(item.matrix_world)[:3, 3]
    near = np.hypot(*(world - np.array(camera.location))[:, :2].T) < 15.0
    assert np.count_nonzero(near) > 50
    inverse = np.linalg.inv(np.array(ocean.matrix_world))
    inside = world[near] @ inverse[:3, :3].T + inverse[:3, 3]
    found = core.Ocean(parameters).height_at(inside[:, 0], inside[:, 1], 0.0)
    np.testing.assert_allclose(inside[:, 2], found, atol=1e-3)


def test_on_a_flight_heights_stay_within_what_interpolation_allows(around, sheet, camera):
    """One wave of height A along x: between points a apart a straight line is up to A k² a²/8 off."""
    size, samples, height = 64.0, 64, 0.5
    curve = height * (2.0 * math.pi / size * 4) ** 2 / 8.0
    ocean = sheet(wave(samples, 4, height), size)
    item = around(ocean, finest_spacing=0.5, fade=False, curvature=False, to_horizon=False, reach=400.0)
    numbers_of = np.random.default_rng(3)
    points = numbers_of.uniform((-20.0, -60.0), (120.0, 60.0), (300, 2))
    points[:150, 1] = 0.37 * points[:150, 0] + 0.05 * points[:150, 1]  # below the camera's way
    truth = height * np.cos(2.0 * math.pi * 4 / size * points[:, 0])
    half = coarseness(evaluated_mesh(item))
    assert half >= 8
    before = None
    for step in range(101):
        moved_to(camera, float(step), 0.37 * step, 6.0)
        told = heights(item, points)
        # the cells around a point are no larger than this, nor finer than those of the ocean
        distance = away(points, camera)
        cell = np.maximum(2.0 * (distance + 0.5) / (half - 2), 1.0)
        off = np.abs(told - truth)
        assert (off <= curve * (cell**2 + 1.0) + 1e-4).all()
        # and while a point stays in the finest level, nothing moves at all
        finest = distance < (half - 4) * 0.5
        if before is not None:
            steady = finest & before[0]
            assert steady.any()
            np.testing.assert_allclose(told[steady], before[1][steady], atol=1e-4)
        before = finest, told


def test_waves_fade_evenly_and_none_is_left_far_away(around, sheet, camera):
    """The height that is left of a wave is that of two-by-two means: cos(k Δ 2ⁱ/2) after each."""
    size, samples, height, count = 64.0, 64, 0.5, 8
    k = 2.0 * math.pi * count / size
    ocean = sheet(wave(samples, count, height), size)
    item = around(ocean, finest_spacing=0.5, curvature=False, to_horizon=False, reach=3000.0)
    mesh = evaluated_mesh(item)
    displacement = numbers(mesh, "displacement", 3)
    rest = numbers(mesh, "position", 3) - displacement
    left = np.cumprod([1.0, *(abs(math.cos(0.5 * k * 2.0**i)) for i in range(6))])
    cells = np.maximum(2.0 * away(rest, camera) / (coarseness(mesh) - 1), 0.5)
    level = np.clip(np.log2(2.0 * cells), 0.0, 6.0)
    share = np.interp(level, np.arange(7), left)
    # between the samples of a mean they are interpolated
    span = 2.0 ** np.ceil(level)
    bound = height * share * np.minimum(k**2 * span**2 / 8.0, 1.0) + 1e-4
    truth = height * share * np.cos(k * rest[:, 0])
    assert (np.abs(displacement[:, 2] - truth) <= bound).all()
    assert np.abs(displacement[cells > 16.0, 2]).max() < 1e-6
    # what the slopes have lost is told: all of it, in the mean half of (A k)², interpolated along x
    lost = numbers(mesh, "slope_variance", 1)[:, 0]
    sampled = height * math.sin(k)  # of the central differences between samples a metre apart
    assert lost[cells > 16.0] == pytest.approx(0.5 * sampled**2, rel=0.05)
    assert lost[level == 0.0].max() < 0.5 * sampled**2


def test_the_helper(extension, ocean_object, make_parameters, camera, empty_scene, rendering):
    parameters = make_parameters()
    ocean = ocean_object.add(empty_scene, parameters)
    water = extension("scene.water_material")
    water.assign(ocean, water.water_material())
    water.describe(ocean, parameters, empty_scene)
    add = extension("scene.camera_surface").add_camera_surface
    horizon = extension("scene.surroundings").add_horizon(
        ocean, parameters, empty_scene, empty_scene.collection, 1
    )
    item = add(ocean, empty_scene, budget=BUDGET)
    assert horizon.hide_viewport
    mesh = evaluated_mesh(item)
    assert 0.8 * BUDGET < len(mesh.vertices) <= BUDGET
    assert mesh.materials[mesh.polygons[0].material_index].original == water.water_material()
    name = "ocean_tweak_slope_variance"
    assert item[name] == ocean[name]
    water.describe(ocean, make_parameters(resolution=64), empty_scene)
    assert item[name] == ocean[name]
    # hidden, the ocean still moves
    first = places(item)
    empty_scene.frame_set(20)
    assert np.abs(places(item) - first).max() > 0.1
    moved_to(empty_scene.camera, 3.0, 4.0, 5.0)
    shown = rendering(lambda mesh: numbers(mesh, "displacement", 3))
    assert list(shown) == [item.name]
    assert np.abs(shown[item.name]).max() > 0.1
    with pytest.raises(extension("scene.settings").OceanObjectError, match="is not an ocean"):
        add(item, empty_scene)


def test_the_button_makes_it_and_takes_it_away(extension, ocean_object, make_parameters, empty_scene, window):
    parameters = make_parameters()
    ocean = ocean_object.add(empty_scene, parameters)
    horizon = extension("scene.surroundings").add_horizon(
        ocean, parameters, empty_scene, empty_scene.collection, 1
    )
    bpy.context.view_layer.objects.active = ocean
    meshes = len(bpy.data.meshes)
    assert not bpy.ops.ocean.remove_camera_surface.poll()
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        assert bpy.ops.ocean.add_camera_surface(budget=2000) == {"FINISHED"}
        bpy.ops.ed.undo_push(message="added")
        ocean = bpy.data.objects[ocean.name]
        surface = extension("scene.camera_surface").camera_surface_of(ocean)
        assert 1500 < len(evaluated_mesh(surface).vertices) <= 2000
        assert ocean.hide_render
        with pytest.raises(RuntimeError, match="has a camera surface already"):
            bpy.ops.ocean.add_camera_surface()
        bpy.ops.ed.undo()
        assert not bpy.data.objects["Ocean"].hide_render
        bpy.ops.ed.redo()
        ocean, horizon = bpy.data.objects["Ocean"], bpy.data.objects["Ocean Horizon"]
        bpy.context.view_layer.objects.active = ocean
        assert bpy.ops.ocean.remove_camera_surface() == {"FINISHED"}
    assert extension("scene.camera_surface").camera_surface_of(ocean) is None
    assert (ocean.hide_render, ocean.display_type, horizon.hide_viewport) == (False, "TEXTURED", False)
    assert len(bpy.data.meshes) == meshes
