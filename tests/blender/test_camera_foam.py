# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam of the surface around the camera: on the crests of the summed patches, wherever the camera is."""

import bpy
import numpy as np
import pytest

from . import camera_views
from .camera_views import moved_to, numbers
from .conftest import evaluated_mesh
from .test_refinement import run_until

# fixtures for the tests here
camera, parameters = camera_views.camera, camera_views.foaming_patches

NAMES = ("foam", "breaking", "foam_age")


@pytest.fixture
def shown(extension, ocean_object, parameters, camera, empty_scene):
    """An ocean of two patches, away from the world's origin, with a surface around the camera."""
    ocean = ocean_object.add(empty_scene, parameters)
    ocean.location = (-40.0, 25.0, 0.0)
    item = extension("scene.camera_surface").add_camera_surface(ocean, empty_scene, budget=150_000)
    settings = {"Finest Spacing": 0.25, "To Horizon": False, "Reach": 1500.0, "Curvature": False}
    settings["Viewport Vertex Budget"] = 150_000  # as in a render
    settings["Foam Pile"] = 0.0  # which moves vertices away from the water
    extension("nodes.modifier_inputs").set_inputs(item.modifiers[0], settings)
    empty_scene.frame_set(9)
    return ocean, item


def foam_of(item):
    """Places at rest in the ocean's space, and foam, breaking and age there."""
    mesh = evaluated_mesh(item)
    rest = numbers(mesh, "position", 3) - numbers(mesh, "displacement", 3)
    return mesh, rest[:, :2], np.concatenate([numbers(mesh, name, 1) for name in NAMES], axis=1)


def eye_of(ocean, camera):
    return np.array(ocean.matrix_world.inverted() @ camera.matrix_world.translation)[:2]


def expected_foam(extension, parameters, time, place, x, y, number=0):
    """One ring between its places, by the core and arithmetic."""
    rings = extension("core.sea.foam_rings")
    levels = extension("core.sea.foam_levels")
    made = rings.FoamRings(levels.FoamLevels(parameters)).at(time, rings.Place(*place))
    cell = levels.FINEST * 2.0**number
    column, row = (x - made.corners[number][0]) / cell, (y - made.corners[number][1]) / cell
    j, i = np.floor(column).astype(int), np.floor(row).astype(int)
    u, v = (column - j)[:, np.newaxis], (row - i)[:, np.newaxis]
    field = np.stack(made.foam[number], axis=-1)
    south = field[i, j] * (1 - u) + field[i, j + 1] * u
    north = field[i + 1, j] * (1 - u) + field[i + 1, j + 1] * u
    return south * (1 - v) + north * v


def test_vertices_have_the_foam_of_their_ring(shown, extension, parameters, camera):
    ocean, item = shown
    _, rest, found = foam_of(item)
    place = eye_of(ocean, camera)
    time = parameters.timing.time(9)
    off = np.abs(rest - place).max(axis=1)
    for number, low, high in ((0, 0.0, 16.0), (1, 26.0, 36.0), (2, 52.0, 70.0)):
        ring = (off >= low) & (off < high)
        assert np.count_nonzero(ring) > 500
        expected = expected_foam(extension, parameters, time, place, *rest[ring].T, number)
        # places are rounded to a float; an age may change by a second from one place to the next
        np.testing.assert_allclose(found[ring, :2], expected[:, :2], atol=0.02)
        np.testing.assert_allclose(found[ring, 2], expected[:, 2], atol=0.2)
    far = off > 1200.0
    assert np.ptp(found[far], axis=0) == pytest.approx(0.0, abs=1e-6)
    assert 0.0 < found[far][0, 1] < found[far][0, 0] < 1.0


def test_crests_break_where_the_surface_that_is_drawn_is_compressed(shown, core, parameters, camera):
    """Against the compression of the sum of all waves, straight from the core."""
    ocean, item = shown
    mesh, rest, found = foam_of(item)
    close = np.abs(rest - eye_of(ocean, camera)).max(axis=1) < 18.0
    x, y = rest[close].T
    cusp = core.Ocean(parameters).surface(parameters.timing.time(9), {"cusp"}, on=core.Places(x, y)).cusp
    breaking = found[close, 1] > 0.5
    assert 10 < np.count_nonzero(breaking) < 0.2 * len(x)
    share = np.mean(breaking)
    assert np.mean(cusp[breaking] > np.quantile(cusp, 1.0 - 2.0 * share)) > 0.7
    # and the cusp of the surface is that of the sum
    np.testing.assert_allclose(numbers(mesh, "cusp", 1)[close, 0], cusp, atol=0.1)


def test_foam_stays_where_it_is_when_the_camera_moves(shown, camera, empty_scene):
    ocean, item = shown
    _, rest, before = foam_of(item)
    place = eye_of(ocean, camera)
    moved_to(camera, camera.location.x + 5.0, camera.location.y - 3.0, 6.0)
    empty_scene.frame_set(9)
    _, rest_after, after = foam_of(item)
    keys = {tuple(key): index for index, key in enumerate(np.round(rest_after / 0.25).astype(int))}
    pairs = [
        (index, keys[key])
        for index, key in enumerate(map(tuple, np.round(rest / 0.25).astype(int)))
        if key in keys and np.abs(rest[index] - place).max() < 12.0
    ]
    first, second = np.array(pairs).T
    assert len(first) > 500
    np.testing.assert_allclose(after[second, :2], before[first, :2], atol=0.02)


def test_foam_follows_a_camera_that_jumps(shown, camera, empty_scene):
    """The camera's own matrix is that of the frame before while a frame begins."""
    ocean, _ = shown
    for frame, x in ((9, 31.0), (10, 431.0)):
        camera.location.x = x
        camera.keyframe_insert("location", frame=frame)
    empty_scene.frame_set(9)
    empty_scene.frame_set(10)
    (points,) = [child for child in ocean.children if child.name.endswith("Foam")]
    middle = np.array(points.data.vertices[0].co)[:2] + 24.0
    np.testing.assert_allclose(middle, eye_of(ocean, camera), atol=2.0)
    assert eye_of(ocean, camera)[0] == pytest.approx(471.0, abs=0.1)


def test_foam_of_another_frame_is_not_shown(shown, extension, empty_scene):
    """Where the extension does not run: the foam of the ocean's own mesh, and a warning."""
    ocean, item = shown
    with extension("scene.handlers").asleep():
        empty_scene.frame_set(12)
        _, _, found = foam_of(item)
        (told,) = item.modifiers[0].node_warnings
        assert "frame 9" in " ".join(told.message.split())
        assert "Ocean Tweak" in told.message
        own = numbers(evaluated_mesh(ocean), "foam", 1)
        assert own.max() > 0.0
        assert found[:, 0].max() <= own.max() + 1e-6
    empty_scene.frame_set(9)
    evaluated_mesh(item)
    assert not item.modifiers[0].node_warnings


def test_points_come_and_go_with_the_foam(shown, extension, empty_scene):
    ocean, item = shown
    get = extension("nodes.modifier_inputs").get_input
    (points,) = [child for child in ocean.children if child.name.endswith("Foam")]
    assert get(item.modifiers[0], "Foam") == points
    assert points.hide_viewport
    assert points.hide_render
    ocean.ocean_tweak.use_foam = False
    assert get(item.modifiers[0], "Foam") is None
    assert not [child for child in ocean.children if child.name.endswith("Foam")]
    assert numbers(evaluated_mesh(item), "foam", 1).max() == 0.0
    ocean.ocean_tweak.use_foam = True
    assert get(item.modifiers[0], "Foam") is not None
    extension("scene.camera_surface").remove_camera_surface(ocean)
    assert not [child for child in ocean.children if child.name.endswith("Foam")]


def test_a_baked_sea_has_foam_of_the_files_that_are_shown(shown, extension, core, parameters, bake, camera):
    ocean, item = shown
    files = bake(parameters.on_one_grid(32), 1, 12, maps=("disp", "foam"))
    extension("scene.ocean_object").use_sequence(ocean, bpy.context.scene, files)
    bpy.context.scene.frame_set(10)
    _, rest, found = foam_of(item)
    place = eye_of(ocean, camera)
    close = np.abs(rest - place).max(axis=1) < 12.0
    time = parameters.timing.time(10)
    expected = expected_foam(extension, parameters, time, place, *rest[close].T)
    np.testing.assert_allclose(found[close, :2], expected[:, :2], atol=0.02)


def test_motion_blur_keeps_the_foam_of_the_frame(shown, empty_scene):
    _, item = shown
    before = foam_of(item)[2]
    empty_scene.frame_set(9, subframe=0.25)
    np.testing.assert_array_equal(np.sort(foam_of(item)[2][:, 0]), np.sort(before[:, 0]))


def test_foam_lies_around_the_camera_of_a_render(shown, camera, empty_scene, tmp_path):
    """While an animation is rendered, the camera's own matrix stays that of before."""
    ocean, _ = shown
    for frame, x in ((9, 31.0), (12, 331.0)):
        camera.location.x = x
        camera.keyframe_insert("location", frame=frame)
    empty_scene.frame_set(9)
    scene, lying = empty_scene, []
    scene.render.engine, scene.cycles.samples = "CYCLES", 1
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.render.filepath = str(tmp_path / "frame")
    scene.frame_start, scene.frame_end = 11, 12

    def look(scene, _depsgraph):
        (points,) = [child for child in ocean.children if child.name.endswith("Foam")]
        lying.append(points.data.vertices[0].co.x + 24.0 + ocean.location.x)

    bpy.app.handlers.frame_change_post.append(look)
    try:
        bpy.ops.render.render(animation=True)
    finally:
        bpy.app.handlers.frame_change_post.remove(look)
    # keys are eased: s²(3 - 2s) of the way at a share s of the time
    assert lying[0] == pytest.approx(31.0 + 300.0 * (3.0 - 4.0 / 3.0) * 4.0 / 9.0, abs=3.0)
    assert lying[1] == pytest.approx(331.0, abs=3.0)


@pytest.fixture
def window(shown, extension, monkeypatch):
    """Refinement as with a window; what is left of it ends with the test."""
    module = extension("scene.refinement")
    monkeypatch.setattr(module, "has_window", lambda: True)
    monkeypatch.setattr(module, "PAUSE", 0.0)
    yield module
    bpy.ops.wm.read_homefile(use_empty=True)


def test_in_a_window_old_foam_follows(shown, window, extension, parameters, camera, empty_scene):
    """After a jump in time foam is there at once where crests break, and the rest a little later."""
    ocean, item = shown

    def foam_near():
        _, rest, found = foam_of(item)
        place = eye_of(ocean, camera)
        close = np.abs(rest - place).max(axis=1) < 12.0
        time = parameters.timing.time(200)
        return found[close], expected_foam(extension, parameters, time, place, *rest[close].T)

    empty_scene.frame_set(200)
    found, expected = foam_near()
    np.testing.assert_allclose(found[:, 1], expected[:, 1], atol=0.02)
    np.testing.assert_allclose(found[:, 0], expected[:, 1], atol=0.02)
    assert window.is_unfinished(ocean)
    run_until(window, lambda: not window.is_unfinished(ocean))
    found, expected = foam_near()
    assert expected[:, 0].mean() > 1.5 * expected[:, 1].mean()
    np.testing.assert_allclose(found[:, :2], expected[:, :2], atol=0.02)
    empty_scene.frame_set(201)  # which is quickly made
    assert not window.is_unfinished(ocean)


def test_a_window_has_few_places_and_a_picture_from_it_all_of_them(
    shown, window, extension, parameters, camera, empty_scene
):
    """Also where the picture is made on the window's own thread, which does not wait for foam by itself."""
    ocean, item = shown
    extension("nodes.modifier_inputs").set_inputs(item.modifiers[0], {"Viewport Vertex Budget": 37_500})
    (points,) = [child for child in ocean.children if child.name.endswith("Foam")]
    empty_scene.frame_set(10)
    shares = []

    def is_there():
        progress = window.progress_of(ocean)
        shares.append(None if progress is None else progress.share)
        return not window.is_unfinished(ocean)

    run_until(window, is_there)
    known = [share for share in shares if share is not None]  # how much of it is made by now
    assert known == sorted(known)
    assert 0.0 <= known[0] <= known[-1] < 1.0
    assert window.progress_of(ocean) is None
    empty_scene.frame_set(11)
    few = len(points.data.vertices)
    refresh = extension("scene.refresh")
    refresh.refresh(ocean, empty_scene, refresh.Wanted.RENDER)
    assert len(points.data.vertices) > 3.0 * few
    _, rest, found = foam_of(item)
    place = eye_of(ocean, camera)
    close = np.abs(rest - place).max(axis=1) < 8.0
    expected = expected_foam(extension, parameters, parameters.timing.time(11), place, *rest[close].T)
    np.testing.assert_allclose(found[close, :2], expected[:, :2], atol=0.02)


def test_fresh_foam_rises_along_the_ocean_s_axis_whatever_the_surface_s_own(shown, extension, empty_scene):
    """Turned, tilted and scaled, the surface shows the same water in the world, with its foam on it."""
    _, item = shown

    def in_world(pile, turn, scale=1.0):
        extension("nodes.modifier_inputs").set_inputs(item.modifiers[0], {"Foam Pile": pile})
        item.rotation_euler, item.scale = turn, (scale,) * 3
        empty_scene.frame_set(9)
        places = numbers(evaluated_mesh(item), "position", 3)
        return places @ np.array(item.matrix_world.to_3x3()).T + item.matrix_world.translation

    water, upright = in_world(0.0, (0.0, 0.0, 0.0)), in_world(0.1, (0.0, 0.0, 0.0))
    assert (upright - water)[:, 2].max() > 0.05
    # floats of places 1500 m away
    np.testing.assert_allclose(in_world(0.1, (0.5, -0.3, 0.8), 1.5), upright, rtol=0.0, atol=2e-3)


def test_a_hull_leaves_its_foam_around_the_camera(shown, core, camera, empty_scene):
    """Over that of the waves: a band astern, as wide as the beam and as old as its way."""
    ocean, item = shown
    _, rest, before = foam_of(item)
    sea = ocean.ocean_tweak.to_parameters(empty_scene)
    x, y = eye_of(ocean, camera)
    start, now = sea.timing.time(0), float(sea.timing.time(9))
    path = (core.PathSample(float(start), x - 6.0 * now, y + 4.0), core.PathSample(now, x, y + 4.0))
    wake = core.WakeLayer(path=path, length=4.0, beam=2.0, draught=0.1, area_size=64.0, area_resolution=64)
    ocean.ocean_tweak.from_parameters(sea.replace(layers=(*sea.layers, wake)), empty_scene)
    empty_scene.frame_set(8)
    empty_scene.frame_set(9)
    _, rest, found = foam_of(item)
    astern, aside = x - rest[:, 0] - 2.0, np.abs(rest[:, 1] - y - 4.0)
    band = (astern > 2.0) & (astern < 10.0) & (aside < 0.4)
    assert np.count_nonzero(band) > 20
    assert found[band, 0].min() > 0.7
    assert np.median(found[band, 2] - astern[band] / 6.0) == pytest.approx(0.0, abs=0.2)
    away = (aside > 8.0) & (np.hypot(*(rest - (x, y)).T) < 20.0)
    assert np.median(np.abs(found[away, 0])) <= np.median(before[:, 0]) + 0.05


@pytest.mark.parametrize("wind", [12.0, 2.0])
def test_a_hull_leaves_its_foam_on_an_ocean_of_one_patch(
    extension, core, ocean_object, camera, empty_scene, wind
):
    """Over that of the waves, if they break at all: around the camera, and only while there is a hull."""
    waves = core.WaveLayer(wind_speed=wind, fetch=5e3)
    sea = core.OceanParameters(resolution=64, domain_size=40.0, layers=(waves,))
    ocean = ocean_object.add(empty_scene, sea)
    item = extension("scene.camera_surface").add_camera_surface(ocean, empty_scene, budget=60_000)
    settings = {"Finest Spacing": 0.25, "To Horizon": False, "Reach": 200.0, "Curvature": False}
    extension("nodes.modifier_inputs").set_inputs(item.modifiers[0], settings | {"Foam Pile": 0.0})
    get = extension("nodes.modifier_inputs").get_input
    empty_scene.frame_set(8)
    assert get(item.modifiers[0], "Foam") is None
    x, y = eye_of(ocean, camera)
    start, now = sea.timing.time(0), float(sea.timing.time(9))
    path = (core.PathSample(float(start), x - 6.0 * now, y + 4.0), core.PathSample(now, x, y + 4.0))
    wake = core.WakeLayer(path=path, length=4.0, beam=2.0, draught=0.1, area_size=64.0, area_resolution=64)
    known = ocean.ocean_tweak.to_parameters(empty_scene)
    ocean.ocean_tweak.from_parameters(known.replace(layers=(*known.layers, wake)), empty_scene)
    empty_scene.frame_set(9)
    _, rest, found = foam_of(item)
    astern, aside = x - rest[:, 0] - 2.0, np.abs(rest[:, 1] - y - 4.0)
    band = (astern > 2.0) & (astern < 10.0) & (aside < 0.4)
    assert np.count_nonzero(band) > 20
    assert found[band, 0].min() > 0.6
    assert np.median(found[band, 2] - astern[band] / 6.0) == pytest.approx(0.0, abs=0.2)
    away = (aside > 8.0) & (np.hypot(*(rest - (x, y)).T) < 30.0)
    levels = extension("core.sea.foam_levels").FoamLevels(known)
    mean = float(levels.beyond.foam)
    assert np.mean(found[away, 0]) == pytest.approx(mean, abs=max(0.6 * mean, 1e-3))
    ocean.ocean_tweak.layers[1].wake.muted = True
    assert get(item.modifiers[0], "Foam") is None
