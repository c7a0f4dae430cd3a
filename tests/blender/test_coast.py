# SPDX-License-Identifier: GPL-3.0-or-later
"""A coast in Blender: a mesh as sea bed, and the sea that ends on it."""

import bpy
import numpy as np
import pytest

from . import coasts
from .coasts import SIDE, fine_slope, slope, values

# fixtures for every test here
calm, ocean, coast_of, coast = coasts.calm, coasts.ocean, coasts.coast_of, coasts.coast


@pytest.mark.parametrize("hole", [False, True])
def test_make_coast_reads_the_depths_of_a_mesh(ocean, hole):
    settings = ocean.ocean_tweak
    settings.coast.bed = slope(hole=hole)
    assert bpy.ops.ocean.make_coast() == {"FINISHED"}
    assert settings.error == ""
    coast = settings.to_parameters(bpy.context.scene).coast
    assert coast is not None
    assert coast.depth is not None
    depth = coast.depth.values[..., 0]
    expected = 12.0 - 0.065 * np.linspace(0.0, SIDE, depth.shape[1])
    np.testing.assert_allclose(depth, np.broadcast_to(expected, depth.shape), atol=2.0 if hole else 0.02)
    assert coast.spacing == pytest.approx(SIDE / (depth.shape[1] - 1))


def test_the_mesh_over_the_bed_is_the_sea_there(ocean, core, coast_of):
    settings, scene = ocean.ocean_tweak, bpy.context.scene
    settings.coast.bed = slope()
    bpy.ops.ocean.make_coast()
    scene.frame_set(30)
    item = coast_of(ocean)
    assert item is not None
    assert ocean.hide_render
    sea = core.Ocean(settings.to_parameters(scene))
    place, moved = values(item.data, "position", 3), values(item.data, "displacement", 3)
    rest = (place - moved)[:, :2].astype(np.float64)
    time = sea.parameters.timing.time(30)
    expected = sea.surface(time, on=core.Places(rest[:, 0], rest[:, 1])).displacement
    np.testing.assert_allclose(moved, expected, atol=2e-3)
    assert np.abs(moved[:, 2]).max() > 0.3
    assert np.abs(moved[rest[:, 0] > 190.0]).max() < 1e-4
    assert values(item.data, "foam").max() > 0.5
    assert values(item.data, "depth").min() > 0.0
    scene.frame_set(31)
    assert np.abs(values(item.data, "displacement", 3) - moved).max() > 0.01
    # finer near the shore
    x = np.unique(rest[:, 0].round(0))
    assert np.diff(x)[-1] < 0.5 * np.diff(x)[0]


def test_points_over_land_have_a_film_of_water_and_others_the_depth(ocean, extension):
    ocean.ocean_tweak.coast.bed = slope()
    bpy.ops.ocean.make_coast()
    points = extension("scene.bed_points").points_of(ocean)
    depth = values(points.data, extension("nodes.names").COAST_DEPTH)
    depth = depth[depth != 0.0]  # points behind the samples, which hold averages, have none
    assert depth.max() > 11.9
    assert depth.min() == pytest.approx(0.02)  # m, where the ground is up to 1 m above the water


def test_patterns_of_the_material_lie_on_the_water_at_rest(ocean, coast_of):
    ocean.ocean_tweak.coast.bed = slope()
    bpy.ops.ocean.make_coast()
    mesh = coast_of(ocean).data
    rest = (values(mesh, "position", 3) - values(mesh, "displacement", 3))[:, :2]
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    found = np.empty(2 * len(corners), np.float32)
    mesh.uv_layers["st"].uv.foreach_get("vector", found)
    np.testing.assert_allclose(np.ptp(found.reshape(-1, 2) - rest[corners] / SIDE, axis=0), 0.0, atol=1e-5)
    assert values(mesh, "cusp").max() > 0.0


def test_the_bed_is_wet_up_to_where_waves_run(ocean):
    bed = ocean.ocean_tweak.coast.bed = fine_slope()
    bpy.ops.ocean.make_coast()
    bpy.context.scene.frame_set(10)
    height, wet = values(bed.data, "position", 3)[:, 2], values(bed.data, "wet")
    assert (wet[height < -0.1] == 1.0).all()
    assert (wet[height > 0.95] == 0.0).all()
    shore = wet[(height > 0.1) & (height < 0.3)]
    assert shore.mean() > 0.3
    bpy.context.scene.frame_set(200)
    assert np.abs(values(bed.data, "wet") - wet).max() > 0.01


@pytest.mark.parametrize("drawn", [False, True])
def test_what_floats_rides_the_waves_over_the_bed(extension, ocean, core, drawn):
    settings, scene = ocean.ocean_tweak, bpy.context.scene
    settings.coast.bed = slope()
    bpy.ops.ocean.make_coast()
    item = bpy.data.objects.new("Buoy", None)
    item.location = (130.0, 70.0, 0.0)
    scene.collection.objects.link(item)
    floating = extension("scene.floating")
    floating.float_on(item, ocean, floating.Ride(tilt=0.0))
    if drawn:
        bpy.context.view_layer.objects.active = item
        item.select_set(True)
        scene.frame_start, scene.frame_end = 20, 22
        bpy.ops.object.ocean_tweak_float_bake()
    sea = core.Ocean(settings.to_parameters(scene))
    found, expected = [], []
    for frame in (20, 22):
        scene.frame_set(frame)
        found.append(item.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation.z)
        # the mean of its least disc, 0.25 m
        expected.append(sea.height_at(130.0, 70.0, sea.parameters.timing.time(frame)))
    np.testing.assert_allclose(found, np.ravel(expected), atol=0.01)
    settings.coast.muted = True
    scene.frame_set(20)
    if not drawn:
        open_sea = core.Ocean(settings.to_parameters(scene)).height_at(
            130.0, 70.0, sea.parameters.timing.time(20)
        )
        height = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation.z
        assert height == pytest.approx(float(open_sea), abs=0.01)
        assert abs(height - found[0]) > 0.02


def test_settings_keep_a_coast_that_a_file_has(ocean, core, calm):
    bed = np.repeat(np.linspace(12.0, -1.0, 51)[np.newaxis], 51, axis=0)
    coast = core.Coast(depth=core.Raster(bed, "bed"), spacing=4.0, rim=80.0, shortest_wavelength=40.0)
    ocean.ocean_tweak.from_parameters(calm.replace(coast=coast), bpy.context.scene)
    found = ocean.ocean_tweak.to_parameters(bpy.context.scene).coast
    assert found is not None
    assert found.depth is not None
    np.testing.assert_allclose(found.depth.values[..., 0], bed, atol=0.01)
    assert (found.spacing, found.rim, found.shore) == (4.0, 80.0, "+X")


def test_what_is_no_bed_is_refused_in_words(ocean):
    with pytest.raises(RuntimeError, match="Choose a mesh as Sea Bed"):
        bpy.ops.ocean.make_coast()
    ocean.ocean_tweak.coast.bed = slope()
    ocean.ocean_tweak.coast.shore = "-X"
    bpy.ops.ocean.make_coast()
    assert "choose another side" in ocean.ocean_tweak.error


def test_a_deeper_bed_of_the_same_size_shows_its_depth(ocean, coast):
    before = values(coast.data, "depth").copy()
    for vertex in ocean.ocean_tweak.coast.bed.data.vertices:
        vertex.co.z *= 2.0
    bpy.context.view_layer.update()
    bpy.ops.ocean.make_coast()
    at_twelve = np.abs(before - 12.0).argmin()
    assert values(coast.data, "depth")[at_twelve] == pytest.approx(24.0, abs=0.1)


def test_waves_too_short_for_the_bed_leave_it_at_rest(ocean, coast):
    ocean.ocean_tweak.coast.shortest_wavelength = 2.0 * SIDE
    assert ocean.ocean_tweak.error == ""
    assert np.isfinite(values(coast.data, "position", 3)).all()


def test_the_mesh_has_height_breaking_and_direction_which_stay(ocean, coast, core):
    mesh, scene = coast.data, bpy.context.scene
    sea = core.Ocean(ocean.ocean_tweak.to_parameters(scene))
    names = {"significant_height": 1, "broken_share": 1, "mean_direction": 2}
    rest = (values(mesh, "position", 3) - values(mesh, "displacement", 3))[:, :2].astype(np.float64)
    expected = sea.surface(0.0, set(names), core.Places(rest[:, 0], rest[:, 1]))
    found = {name: values(mesh, name, count) for name, count in names.items()}
    for name in names:
        np.testing.assert_allclose(found[name], expected[name], atol=0.01)
    assert found["broken_share"].max() > 0.5
    scene.frame_set(9)
    np.testing.assert_array_equal(values(mesh, "significant_height"), found["significant_height"])
    ocean.ocean_tweak.layers[0].wind_speed = 12.0
    assert values(mesh, "significant_height").max() > 1.1 * found["significant_height"].max()
    scene.unit_settings.scale_length = 0.5
    bpy.context.view_layer.update()
    scene.frame_set(10)
    scaled = values(coast.data, "significant_height")
    assert scaled.max() == pytest.approx(
        2.0 * core.Ocean(ocean.ocean_tweak.to_parameters(scene)).coast.significant_height.max(), rel=0.05
    )


def test_overlays_show_height_and_direction_where_there_is_water(ocean, coast, extension, core):
    overlay, scene, group = extension("ui.coast_overlay"), bpy.context.scene, ocean.ocean_tweak.coast
    assert overlay.state_map(ocean, scene) is None
    group.show_height = group.show_direction = True
    shown = overlay.state_map(ocean, scene)
    sea = core.Ocean(ocean.ocean_tweak.to_parameters(scene))
    assert shown.highest == pytest.approx(sea.coast.significant_height.max(), rel=0.1)
    # the waterline of the slope is at x = 184.6
    assert shown.places[shown.triangles.ravel()][:, 0].max() < 185.0
    assert shown.places[shown.triangles.ravel()][:, 0].max() > 175.0
    assert shown.places[shown.triangles.ravel()][:, 0].min() < -100.0
    a, b, c = (shown.places[shown.triangles[:, corner]][:, :2] for corner in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    turned = np.sign(ux * vy - uy * vx)
    assert abs(turned[0]) == 1.0
    assert (turned == turned[0]).all()
    highest = shown.places[np.argmax(shown.colours[:, 0])]
    assert highest[0] < 185.0
    shafts = shown.lines[: len(shown.lines) // 3]
    towards = shafts[:, 1] - shafts[:, 0]
    assert (towards[:, 0] > 0.0).all()  # waves run along +x
    length = np.hypot(towards[:, 0], towards[:, 1])
    np.testing.assert_allclose(length, length[0], rtol=0.02)
    assert shafts[..., 0].max() < 190.0
    # around places of the bed, as far as the shore, and none reaches the next
    middles = shafts.mean(axis=1)[:, :2]
    apart = np.linalg.norm(middles[1:] - middles[0], axis=-1).min()
    assert 0.5 * apart < length.max() < 0.95 * apart
    assert middles[:, 0].max() > 184.6 - 1.5 * apart
    samples = np.stack(sea.coast.ground.places, axis=-1).reshape(-1, 2)
    off = np.linalg.norm(samples - middles[len(middles) // 2], axis=-1).min()
    assert off < 0.01 * sea.coast.ground.step
    group.show_height = False
    assert overlay.state_map(ocean, scene) is not None
    group.show_height, group.show_direction = True, False
    assert overlay.state_map(ocean, scene) is not None
    group.use = False
    assert overlay.state_map(ocean, scene) is None


def test_colours_are_those_of_a_ramp(extension):
    ramp = extension("ui.coast_overlay").ramp
    light = ramp(np.linspace(0.0, 1.0, 9))[:, :3] @ (0.2126, 0.7152, 0.0722)
    assert (np.diff(light) > 0.0).all()
    assert light[-1] - light[0] > 0.6
