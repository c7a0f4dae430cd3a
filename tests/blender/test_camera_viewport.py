# SPDX-License-Identifier: GPL-3.0-or-later
"""What the viewport shows around the camera: fewer vertices and samples than a render, and the same sea."""

import math

import bpy
import numpy as np
import pytest

from . import camera_views
from .camera_views import heights, heights_of, moved_to, numbers
from .conftest import evaluated_mesh

# fixtures for the tests here
camera = camera_views.camera

SAMPLES = 384  # of a patch in a render; a window has 256


@pytest.fixture
def sea(core, make_parameters):
    """Two patches, of which the second has no short end: half of its samples hold fewer waves."""

    def make(wind_speed=9.0):
        layer = core.WaveLayer(wind_speed=wind_speed, fetch=40e3, wind_direction=0.4)
        patches = (
            core.Patch(domain_size=600.0, shortest_wavelength=6.3, resolution=SAMPLES),
            core.Patch(domain_size=40.0, longest_wavelength=6.3, rotation=0.97, resolution=SAMPLES),
        )
        foam = core.Foam(coverage=0.0)
        return make_parameters(layers=(layer,), patches=patches, foam=foam)

    return make


@pytest.fixture
def shown(extension, ocean_object, sea, camera, empty_scene):
    """An ocean and its surface around a camera two metres above the water."""
    ocean = ocean_object.add(empty_scene, sea())
    item = extension("scene.camera_surface").add_camera_surface(ocean, empty_scene)
    moved_to(camera, 31.3, -17.2, 2.0)
    return ocean, item


def patch_objects(ocean):
    return sorted((item for item in ocean.children if "Patch" in item.name), key=lambda item: item.name)


def sides(ocean):
    return [math.isqrt(grid_of(item, "displacement").shape[0]) - 1 for item in patch_objects(ocean)]


def grid_of(item, name):
    """An attribute of a patch's own samples, which its averages follow."""
    columns, rows, _ = numbers(item.data, "ocean_tweak_averages", 3)[0]
    return numbers(item.data, name, 3)[: round(columns * rows)]


def in_image(camera, columns, rows):
    """Where rays through a regular raster of an image, from just below the horizon down, meet flat water."""
    across = np.radians(np.linspace(-26.0, 26.0, columns))
    down = np.radians(np.linspace(1.0, 20.0, rows))[:, np.newaxis]
    away = camera.location.z / np.tan(down)
    x, y = away * np.sin(across), away * np.cos(across)
    return np.stack([x + camera.location.x, y + camera.location.y], axis=-1).reshape(-1, 2)


def test_what_the_camera_sees_is_what_it_sees_in_a_render(shown, rendering, camera, empty_scene):
    """Of heights below a raster of pixels: the same waves, as high, and nothing lost untold."""
    _, item = shown
    empty_scene.camera = camera  # that of the engine is another one
    bpy.context.view_layer.update()
    points = in_image(camera, 41, 24)
    few, squares = heights(item, points), slope_squares(evaluated_mesh(item), camera)
    assert len(evaluated_mesh(item).vertices) < 50_000

    def look(mesh):
        return heights_of(mesh, points), slope_squares(mesh, camera), len(mesh.vertices)

    whole, whole_squares, count = rendering(look)[item.name]
    assert count > 150_000
    assert whole.std() > 0.1
    assert np.corrcoef(few, whole)[0, 1] > 0.985
    assert few.std() == pytest.approx(whole.std(), rel=0.1)
    assert squares == pytest.approx(whole_squares, rel=0.02)


def slope_squares(mesh, camera):
    """Mean over the water within 100 m of the squares of the slopes that normals show or roughness tells."""
    flat = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertex_normals.foreach_get("vector", flat)
    facing = flat.reshape(-1, 3).astype(np.float64)
    squares = ((facing[:, :2] / facing[:, 2:]) ** 2).sum(axis=1) + numbers(mesh, "slope_variance", 1)[:, 0]
    away = camera_views.away(numbers(mesh, "position", 3), camera)
    near = (away > 4.0) & (away < 100.0)
    # vertices stand for the more water the farther they are
    return np.average(squares[near], weights=away[near] ** 2)


def test_a_render_gets_all_samples(shown, extension, core, sea, rendering, camera, empty_scene):
    ocean, item = shown
    assert sides(ocean) == [256, 256]
    near = rendering(lambda mesh: (sides(ocean), len(mesh.vertices)))
    assert near[item.name][0] == [SAMPLES, SAMPLES]
    assert near[item.name][1] > 150_000
    empty_scene.frame_set(5)
    assert sides(ocean) == [256, 256]
    rest = grid_of(patch_objects(ocean)[0], "displacement")
    whole = core.Ocean(sea()).patches[0].surface(sea().timing.time(5)).displacement
    # every third sample of both stands at every second of the other
    few = rest.reshape(257, 257, 3)[:-1:2, :-1:2]
    np.testing.assert_allclose(few, whole[::3, ::3], atol=0.02 * whole.std())


def test_waves_that_few_samples_lack_are_roughness(shown, core, sea):
    ocean, _ = shown
    *_, last = patch_objects(ocean)
    slopes = grid_of(last, "ocean_tweak_slopes").astype(np.float64)
    squares = (slopes[:, :2] ** 2).sum(axis=1)
    held, lost = squares.mean(), slopes[:, 2] - squares
    whole = core.Ocean(sea()).patches[1].surface(0.0, {"slope"}).slope.astype(np.float64)
    assert lost.min() == pytest.approx(lost.max(), rel=1e-4)
    assert lost.min() > 0.05 * held
    assert held + lost.mean() == pytest.approx((whole**2).sum(axis=-1).mean(), rel=0.02)


def test_while_a_value_is_dragged_there_are_few_samples(shown, extension, empty_scene, monkeypatch):
    ocean, item = shown
    refinement = extension("scene.refinement")
    monkeypatch.setattr(refinement, "has_window", lambda: True)
    monkeypatch.setattr(refinement, "PAUSE", 60.0)
    before = numbers(evaluated_mesh(item), "displacement", 3)[:, 2].std()
    ocean.ocean_tweak.layers[0].wind_speed = 16.0
    assert sides(ocean) == [128, 128]
    assert numbers(evaluated_mesh(item), "displacement", 3)[:, 2].std() > 1.2 * before
    empty_scene.frame_set(2)  # in the midst of it
    assert sides(ocean) == [128, 128]
    refinement.forget_all()
    monkeypatch.undo()
    empty_scene.frame_set(3)
    assert sides(ocean) == [256, 256]
