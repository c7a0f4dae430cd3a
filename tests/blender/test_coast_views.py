# SPDX-License-Identifier: GPL-3.0-or-later
"""What shows or reads an ocean with a coast sees the sea over its bed."""

import bpy
import numpy as np
import pytest

from . import coasts, floats
from .camera_views import numbers
from .coasts import SIDE, slope
from .conftest import evaluated_mesh
from .test_sample import answers, new_asker
from .test_wakes import key, new_hull

# fixtures for every test here
calm, coast_of, select = coasts.calm, coasts.coast_of, floats.select

FRAME = 30


@pytest.fixture(params=[False, True], ids=["one patch", "two patches"])
def ocean(request, empty_scene, ocean_object, calm, core):
    """An ocean over a slope, of a sea of one patch or of two."""
    if request.param:
        patches = (
            core.Patch(domain_size=SIDE, shortest_wavelength=20.0, resolution=32),
            core.Patch(
                domain_size=50.0,
                longest_wavelength=20.0,
                shortest_wavelength=6.0,
                rotation=0.5,
                resolution=32,
            ),
        )
        calm = calm.replace(patches=patches)
    item = ocean_object.add(empty_scene, calm)
    bpy.context.view_layer.objects.active = item
    group = item.ocean_tweak.coast
    with item.ocean_tweak.quiet():
        group.rim, group.shortest_wavelength, group.bed = 80.0, 40.0, slope()
    assert bpy.ops.ocean.make_coast() == {"FINISHED"}
    assert item.ocean_tweak.error == ""
    return item


@pytest.fixture
def camera(empty_scene):
    item = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    item.location = (100.0, 100.0, 3.0)
    item.rotation_euler = (1.4, 0.0, 1.6)
    empty_scene.collection.objects.link(item)
    empty_scene.camera = item
    bpy.context.view_layer.update()
    return item


@pytest.fixture
def surface_of(extension):
    return extension("scene.plan").camera_surface_of


def sea(core, ocean):
    # a camera surface shows each patch with its own samples
    found = core.Ocean(ocean.ocean_tweak.to_parameters(bpy.context.scene).separate)
    return found, found.parameters.timing.time(FRAME)


def test_a_camera_surface_is_the_sea_over_the_bed(ocean, camera, core, coast_of, surface_of, extension):
    assert coast_of(ocean) is not None
    bpy.ops.ocean.add_camera_surface()
    assert ocean.ocean_tweak.error == ""
    assert coast_of(ocean) is None
    surface = surface_of(ocean)
    extension("nodes.modifier_inputs").set_inputs(
        extension("scene.plan").surface_modifier(surface), {"Fade": False, "Curvature": False}
    )
    surface.update_tag()
    bpy.context.scene.frame_set(FRAME)
    mesh = evaluated_mesh(surface)
    moved = numbers(mesh, "displacement", 3)
    rest = numbers(mesh, "position", 3) - moved
    near = (np.abs(rest[:, :2] - SIDE / 2) < SIDE / 2 + 50.0).all(axis=1) & (rest[:, 0] < SIDE)
    whole, time = sea(core, ocean)
    expected = whole.surface(time, {"displacement", "velocity"}, on=core.Places(*rest[near, :2].T))
    assert near.sum() > 1000
    # shares are bilinear between the bed's samples, and so is what they weigh
    np.testing.assert_allclose(moved[near], expected.displacement, atol=0.03)
    assert np.sqrt(np.mean((moved[near] - expected.displacement) ** 2)) < 2e-3
    velocity = numbers(mesh, "velocity", 3)[near]
    assert np.sqrt(np.mean((velocity - expected.velocity) ** 2)) < 5e-3
    on_land = near & (rest[:, 0] > 190.0)
    assert np.abs(moved[on_land]).max() < 1e-3
    # the open sea offshore, as deep as it is said to be, and the bed
    far = rest[:, 0] < -200.0
    assert np.abs(moved[far, 2]).max() > 0.3
    depth = numbers(mesh, "depth", 1)[:, 0]
    np.testing.assert_allclose(depth[far], 20.0, atol=0.1)
    over = near & (rest[:, 0] > 10.0) & (rest[:, 0] < 180.0)
    np.testing.assert_allclose(depth[over], 12.0 - 0.065 * rest[over, 0], atol=0.2)
    foam = numbers(mesh, "foam", 1)[:, 0]
    assert foam[over].max() > 0.5
    assert foam[on_land].max() < 0.01


def test_a_coast_without_its_camera_surface_has_its_mesh_again(ocean, camera, coast_of, extension):
    bpy.ops.ocean.add_camera_surface()
    assert extension("scene.portability").needs_of(ocean)[0].name == "Ocean Camera Surface"
    assert ocean.hide_render
    bpy.ops.ocean.remove_camera_surface()
    assert coast_of(ocean) is not None
    assert ocean.hide_render
    ocean.ocean_tweak.coast.use = False
    assert not ocean.hide_render
    assert sorted(item.name for item in bpy.context.scene.objects) == ["Bed", "Camera", "Ocean"]
    assert [modifier.name for modifier in ocean.modifiers] == ["Ocean Tweak"]


# the mesh of an ocean with several patches has fewer waves than their sum
@pytest.mark.parametrize("ocean", [False], indirect=True, ids=["one patch"])
@pytest.mark.parametrize(("method", "at_rest"), [("NODES", False), ("DISPLACE", True)])
def test_ocean_sample_sees_the_sea_over_the_bed(ocean, core, extension, empty_scene, method, at_rest):
    ocean.ocean_tweak.method = method
    x, y = np.meshgrid(np.linspace(-250.0, 420.0, 33), np.linspace(-30.0, 260.0, 13))
    points = np.stack((x.ravel(), y.ravel(), np.zeros(x.size)), axis=-1)
    asker = new_asker(extension, empty_scene, points, ocean, at_rest)
    empty_scene.frame_set(FRAME)
    found = answers(evaluated_mesh(asker))
    whole, time = sea(core, ocean)
    assert found["Foam"].max() > 0.5
    assert found["Height"][x.ravel() < 150.0].std() > 0.2
    if at_rest:
        expected = whole.surface(time, {"displacement", "velocity"}, on=core.Places(x.ravel(), y.ravel()))
        np.testing.assert_allclose(found["Displacement"], expected.displacement, atol=6e-3)
        np.testing.assert_allclose(found["Velocity"], expected.velocity, atol=1e-2)
    else:
        expected = whole.points_at(x.ravel(), y.ravel(), time)
        np.testing.assert_allclose(found["Height"].ravel(), expected.height, atol=6e-3)
        over = (x.ravel() > 20.0) & (x.ravel() < 170.0)
        steep = (found["Normal"] - expected.normal)[over]
        assert np.sqrt(np.mean(steep**2)) < 1e-3


@pytest.mark.parametrize("ocean", [False], indirect=True, ids=["one patch"])
def test_ocean_sample_sees_it_in_other_units(ocean, core, extension, empty_scene):
    unit = empty_scene.unit_settings.scale_length = 0.5  # m
    bpy.context.view_layer.update()
    empty_scene.frame_set(FRAME)
    whole, time = sea(core, ocean)
    side = whole.parameters.domain_size
    x, y = (
        axis.ravel() for axis in np.meshgrid(np.linspace(-0.6, 0.9, 61) * side, np.array((0.2, 0.7)) * side)
    )
    points = np.stack((x, y, np.zeros(x.size)), axis=-1) / unit
    found = answers(evaluated_mesh(new_asker(extension, empty_scene, points, ocean, False)))
    expected = whole.points_at(x, y, time)
    assert np.ptp(expected.height) > 0.2
    np.testing.assert_allclose(unit * found["Height"].ravel(), expected.height, atol=6e-3)
    assert np.sqrt(np.mean((found["Normal"] - expected.normal) ** 2)) < 2e-3


@pytest.mark.parametrize("ocean", [False], indirect=True, ids=["one patch"])
def test_a_ship_makes_waves_over_the_bed_that_end_on_land(
    ocean, camera, core, extension, empty_scene, surface_of, select
):
    ship = new_hull(empty_scene)
    empty_scene.frame_end = 100
    key(ship, {1: (120.0, 100.0, 0.0), 100: (150.0, 100.0, 0.0)})
    select(ship)
    assert bpy.ops.object.ocean_tweak_wake() == {"FINISHED"}
    assert ocean.ocean_tweak.error == ""
    surface = surface_of(ocean)
    extension("nodes.modifier_inputs").set_inputs(
        extension("scene.plan").surface_modifier(surface), {"Fade": False, "Curvature": False}
    )
    surface.update_tag()
    empty_scene.frame_set(FRAME + 60)
    mesh = evaluated_mesh(surface)
    moved = numbers(mesh, "displacement", 3)
    rest = numbers(mesh, "position", 3) - moved
    whole, _ = sea(core, ocean)
    time = whole.parameters.timing.time(FRAME + 60)
    near = (np.abs(rest[:, :2] - (120.0, 100.0)) < 78.0).all(axis=1)
    on = core.Places(*rest[near, :2].T)
    expected = whole.surface(time, on=on).displacement
    calm = whole.parameters.replace(layers=[each for each in whole.parameters.layers if each.kind != "WAKE"])
    wake = expected - core.Ocean(calm).surface(time, on=on).displacement
    # between samples of its area, which has cells of 6 m here
    assert np.corrcoef(wake[:, 2], moved[near, 2] - (expected - wake)[:, 2])[0, 1] > 0.9
    assert np.abs(wake).max() > 0.5
    on_land = near & (rest[:, 0] > 192.0)
    assert on_land.sum() > 10
    assert np.abs(moved[on_land]).max() < 1e-3


@pytest.mark.parametrize("ocean", [False], indirect=True, ids=["one patch"])
def test_whitecaps_of_the_open_sea_are_where_they_were_without_a_coast(ocean, core, coast_of, empty_scene):
    """On the coast's mesh before the bed; over land there are none."""
    empty_scene.frame_set(FRAME)
    mesh = coast_of(ocean).data
    rest = numbers(mesh, "position", 3) - numbers(mesh, "displacement", 3)
    shown = [numbers(mesh, name, 1)[:, 0] for name in ("foam", "breaking", "foam_age")]
    _, time = sea(core, ocean)
    ocean.ocean_tweak.coast.muted = True
    open_sea, _ = sea(core, ocean)
    offshore = rest[:, 0] < -170.0
    expected = open_sea.foam_history.whitecaps(time).at(*rest[offshore, :2].T, SIDE)
    assert expected.foam.max() > 0.1
    for found, field in zip(shown, expected, strict=True):
        np.testing.assert_allclose(found[offshore], field, atol=1e-5)
    assert shown[0][rest[:, 0] > 192.0].max() < 0.01


@pytest.mark.parametrize("surface", [False, True])
def test_breakers_throw_up_spray(ocean, camera, extension, empty_scene, surface):
    settings = ocean.ocean_tweak
    settings.use_spray = True
    if surface:
        bpy.ops.ocean.add_camera_surface()
    empty_scene.frame_set(FRAME)
    assert settings.error == ""
    item = extension("scene.spray").spray_of(ocean)
    found = numbers(item.data, "position", 3)
    whole = settings.to_parameters(empty_scene)
    time = whole.timing.time(FRAME)
    expected = extension("core.sea.spray").CameraSpray.of(whole).at(time, whole.spray, (100.0, 100.0))
    # the mesh ends beside the bed, and a camera surface does not
    there = surface | ((expected.position[:, 1] > 0.0) & (expected.position[:, 1] < SIDE))
    assert len(found) == there.sum() > 50
    np.testing.assert_allclose(found, expected.position[there], atol=1e-3)
    assert (found[:, 0] > 80.0).mean() > 0.5


@pytest.mark.parametrize("ocean", [False], indirect=True, ids=["one patch"])
def test_a_coast_is_in_each_scene_that_its_ocean_is_in(ocean, coast_of, extension, empty_scene):
    """It comes with the ocean and goes with it, and stays in the collection that a user chose."""
    shore = bpy.data.collections.new("Shore")
    empty_scene.collection.children.link(shore)
    mesh, points = coast_of(ocean), extension("scene.bed_points").points_of(ocean)
    shore.objects.link(mesh)
    empty_scene.collection.objects.unlink(mesh)
    other = bpy.data.scenes.new("Other")
    cove = bpy.data.collections.new("Cove")
    other.collection.children.link(cove)
    cove.objects.link(ocean)
    other.frame_set(5)
    assert ocean.ocean_tweak.error == ""
    assert {mesh, points} <= set(cove.objects)
    assert mesh.name not in empty_scene.collection.objects
    assert mesh.name in shore.objects
    empty_scene.collection.objects.unlink(ocean)
    other.frame_set(6)
    assert mesh.name not in shore.objects
    assert {mesh, points} <= set(cove.objects)
    assert mesh.users_scene == (other,)


@pytest.mark.parametrize("ocean", [False], indirect=True, ids=["one patch"])
def test_what_drifts_goes_with_the_water_over_the_bed(ocean, core, extension, empty_scene):
    item = bpy.data.objects.new("Buoy", None)
    item.location = (130.0, 70.0, 0.0)
    empty_scene.collection.objects.link(item)
    floating = extension("scene.floating")
    floating.float_on(item, ocean, floating.Ride(tilt=0.0, drift=1.0))
    whole, _ = sea(core, ocean)
    found, expected = [], []
    for frame in (20, 40):
        empty_scene.frame_set(frame)
        found.append(item.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation[:])
        time = whole.parameters.timing.time(frame)
        expected.append(whole.surface(time, on=core.Places(130.0, 70.0)).displacement)
    np.testing.assert_allclose(np.subtract(found, (130.0, 70.0, 0.0)), expected, atol=0.02)
    assert np.ptp(expected, axis=0)[:2].max() > 0.05
