# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks of layers and patches: from an image, a vertex group or the distance to an object."""

import dataclasses

import bpy
import numpy as np
import pytest

from tests.layers import with_layers

from .conftest import DOMAIN, SAMPLES, evaluated_mesh
from .surfaces import ALL_MAPS, assert_alike, read, wanted

SIDE = SAMPLES + 1


@pytest.fixture
def ocean(ocean_object, make_parameters, empty_scene):
    item = ocean_object.add(empty_scene, make_parameters())
    bpy.context.view_layer.objects.active = item
    item.select_set(True)
    return item


@pytest.fixture
def mask(ocean):
    return ocean.ocean_tweak.layers[0].mask


def new_mesh(name, faces, weights=()):
    """Quads of their lower and upper corners at some height, with a vertex group."""
    corners = [
        corner
        for (x0, y0), (x1, y1), z in faces
        for corner in ((x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z))
    ]
    data = bpy.data.meshes.new(name)
    data.from_pydata(corners, [], [tuple(range(4 * i, 4 * i + 4)) for i in range(len(faces))])
    item = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(item)
    group = item.vertex_groups.new(name="Waves")
    for index, weight in enumerate(weights):
        group.add([index], weight, "REPLACE")
    return item


def heights(item):
    return read(evaluated_mesh(item), SIDE, SIDE)["displacement"][..., 2]


def test_an_image_masks_its_layer(ocean, mask, core, empty_scene, extension):
    image = bpy.data.images.new("Coast", 8, 4, float_buffer=True, is_data=True)
    texels = np.ones((4, 8, 4), np.float32)
    texels[..., :3] = np.linspace(0.0, 1.0, 8)[:, np.newaxis]
    image.pixels.foreach_set(texels.ravel())
    image.update()
    mask.image = image
    mask.source = "IMAGE"
    parameters = ocean.ocean_tweak.to_parameters(empty_scene)
    found = parameters.layers[0].mask
    assert found == core.Mask(
        source="IMAGE",
        image=core.Raster(texels[..., 0]),
        inner_radius=found.inner_radius,
        outer_radius=found.outer_radius,
    )
    assert_alike(read(evaluated_mesh(ocean), SIDE, SIDE), wanted(core, parameters, 1))
    assert not ocean.ocean_tweak.error


def test_painting_the_image_moves_the_sea(ocean, mask, empty_scene):
    image = bpy.data.images.new("Coast", 4, 4, float_buffer=True, is_data=True)
    image.pixels.foreach_set(np.ones(64, np.float32))
    image.update()
    mask.image, mask.source = image, "IMAGE"
    before = heights(ocean)
    image.pixels.foreach_set(np.zeros(64, np.float32))
    image.update()
    bpy.context.view_layer.update()
    empty_scene.frame_set(empty_scene.frame_current)
    assert np.abs(before).max() > 0.1
    assert np.abs(heights(ocean)).max() == 0.0


def test_no_image_is_told(ocean, mask):
    mask.source = "IMAGE"
    assert "layers.0.mask.image" in ocean.ocean_tweak.error


@pytest.mark.parametrize("metres", [1.0, 0.5])
def test_a_distance_is_measured_from_an_object(ocean, mask, core, empty_scene, metres):
    empty_scene.unit_settings.scale_length = metres
    ocean.location = (5.0, -3.0, 1.0)
    post = bpy.data.objects.new("Post", None)
    empty_scene.collection.objects.link(post)
    post.location = (45.0, 27.0, 0.0)
    bpy.context.view_layer.update()
    mask.inner_radius, mask.outer_radius = 10.0, 40.0
    mask.object, mask.source = post, "DISTANCE"
    found = ocean.ocean_tweak.to_parameters(empty_scene).layers[0].mask
    expected = core.Mask(x=40 * metres, y=30 * metres, inner_radius=10 * metres, outer_radius=40 * metres)
    assert found == expected


def test_it_follows_an_object_that_is_moved_by_hand(ocean, mask, empty_scene):
    post = bpy.data.objects.new("Post", None)
    empty_scene.collection.objects.link(post)
    mask.inner_radius, mask.outer_radius = 10.0, 20.0
    mask.object, mask.source = post, "DISTANCE"
    for place in ((30.0, 60.0), (90.0, 20.0)):
        post.location = (*place, 0.0)
        bpy.context.view_layer.update()
        bpy.context.view_layer.update()
        along = DOMAIN / SAMPLES * np.arange(SIDE)
        away = np.hypot(along - place[0], along[:, np.newaxis] - place[1])
        empty_scene.frame_set(empty_scene.frame_current)
        assert np.abs(heights(ocean)[away < 9.0]).max() == 0.0
        assert np.abs(heights(ocean)[(away > 21.0) & (away < 60.0)]).max() > 0.05


def new_wall(scene, kind):
    """A breakwater from (30, 60) to (90, 60), as the edge of a mesh or as a curve."""
    if kind == "MESH":
        data = bpy.data.meshes.new("Wall")
        data.from_pydata([(0.0, 0.0, 3.0), (60.0, 0.0, 5.0)], [(0, 1)], [])
    else:
        data = bpy.data.curves.new("Wall", "CURVE")
        data.dimensions = "3D"
        spline = data.splines.new("POLY")
        spline.points.add(1)
        spline.points[1].co = (60.0, 0.0, 2.0, 1.0)
    item = bpy.data.objects.new("Wall", data)
    item.location = (30.0, 60.0, 0.0)
    scene.collection.objects.link(item)
    bpy.context.view_layer.update()
    return item


def away_from_wall(x0, y0):
    along = DOMAIN / SAMPLES * np.arange(SIDE)
    x, y = along, along[:, np.newaxis]
    return np.hypot(np.maximum(np.maximum(x0 - x, x - x0 - 60.0), 0.0), y - y0)


@pytest.mark.parametrize("kind", ["MESH", "CURVE"])
@pytest.mark.parametrize("owner", ["layer", "sea"])
def test_a_distance_is_measured_from_a_shape_and_follows_it(ocean, mask, empty_scene, kind, owner):
    group = mask if owner == "layer" else ocean.ocean_tweak.mask
    ocean.location = (2.0, -4.0, 0.0)
    wall = new_wall(empty_scene, kind)
    group.inner_radius, group.outer_radius = 10.0, 20.0
    group.object, group.measured_from, group.source = wall, "SHAPE", "DISTANCE"
    for x, y in ((28.0, 64.0), (50.0, 90.0)):
        wall.location = (x + 2.0, y - 4.0, 0.0)
        bpy.context.view_layer.update()
        bpy.context.view_layer.update()
        found = ocean.ocean_tweak.to_parameters(empty_scene)
        lines = (found.mask or found.layers[0].mask).lines.values
        np.testing.assert_allclose(lines, [[[x, y, x + 60.0, y]]], atol=1e-4)
        away = away_from_wall(x, y)
        assert np.abs(heights(ocean)[away < 9.0]).max() == 0.0
        assert np.abs(heights(ocean)[(away > 21.0) & (away < 40.0)]).max() > 0.05
    if kind == "MESH":
        wall.data.vertices[1].co.x = 20.0
        wall.data.update_tag()
        bpy.context.view_layer.update()
        found = ocean.ocean_tweak.to_parameters(empty_scene)
        assert (found.mask or found.layers[0].mask).lines.values[0, 0, 2] == pytest.approx(70.0)


def test_a_shape_without_edges_is_told(ocean, mask, empty_scene):
    empty = bpy.data.objects.new("Post", None)
    empty_scene.collection.objects.link(empty)
    mask.object, mask.measured_from, mask.source = empty, "SHAPE", "DISTANCE"
    assert "it has no edges to measure from" in ocean.ocean_tweak.error
    mask.measured_from = "ORIGIN"
    assert not ocean.ocean_tweak.error


def test_what_floats_is_no_mask(ocean, mask, empty_scene, extension):
    """The water would follow what follows the water."""
    boat, flag = (bpy.data.objects.new(name, None) for name in ("Boat", "Flag"))
    for item in (boat, flag):
        empty_scene.collection.objects.link(item)
    flag.parent = boat
    extension("scene.floating").float_on(boat, ocean)
    for item in (boat, flag):
        mask.object, mask.source = item, "DISTANCE"
        assert "it floats on this water" in ocean.ocean_tweak.error
        mask.source = "NONE"
    assert not ocean.ocean_tweak.error


@pytest.mark.parametrize("metres", [1.0, 0.5])
def test_a_noise_goes_with_the_wind_and_lets_its_share_through(ocean, mask, core, empty_scene, metres):
    empty_scene.unit_settings.scale_length = metres
    layer = ocean.ocean_tweak.layers[0]
    layer.wind_speed, layer.wind_direction = 9.0, 0.5
    mask.noise_coverage, mask.noise_contrast = 0.25, 0.75
    mask.source = "NOISE"
    found = ocean.ocean_tweak.to_parameters(empty_scene).layers[0].mask
    assert (found.source, found.noise_coverage, found.noise_contrast) == ("NOISE", 0.25, 0.75)
    assert found.noise_speed == pytest.approx(9.0 * metres)
    assert found.noise_direction == pytest.approx(0.5)
    empty_scene.frame_set(30)
    parameters = ocean.ocean_tweak.to_parameters(empty_scene)
    if metres == 1.0:
        assert_alike(read(evaluated_mesh(ocean), SIDE, SIDE), wanted(core, parameters, 30))
    ocean.ocean_tweak.from_parameters(parameters, empty_scene)
    assert ocean.ocean_tweak.to_parameters(empty_scene) == parameters


def test_gusts_too_small_for_the_domain_are_told(ocean, mask):
    mask.source = "NOISE"
    assert not ocean.ocean_tweak.error
    mask.noise_size = 0.02 * DOMAIN
    assert "mask.noise_size" in ocean.ocean_tweak.error


def test_strength_leaves_a_share(ocean, mask, empty_scene):
    mask.inner_radius, mask.outer_radius = 500.0, 600.0
    whole = heights(ocean)
    mask.strength, mask.source = 0.75, "DISTANCE"
    np.testing.assert_allclose(heights(ocean), 0.25 * whole, atol=1e-5)


def test_weights_of_a_mesh_are_read_from_above(ocean, mask, core, empty_scene):
    """Weight 1 on the left half, from 0 to 1 on the right upper quarter, nothing elsewhere."""
    half = DOMAIN / 2
    faces = [((0.0, 0.0), (half, DOMAIN), -4.0), ((half, half), (DOMAIN, DOMAIN), 7.0)]
    mask.mesh = new_mesh("Coast", faces, [1.0] * 4 + [0.0, 1.0, 1.0, 0.0])
    mask.vertex_group = "Waves"
    assert bpy.ops.ocean.read_weights(samples=16) == {"FINISHED"}
    assert mask.source == "VERTEX_GROUP"
    found = ocean.ocean_tweak.to_parameters(empty_scene).layers[0].mask.image.values[..., 0]
    expected = np.zeros((16, 16))
    expected[:, :8] = 1.0
    expected[8:, 8:] = (np.arange(8) + 0.5) / 8
    np.testing.assert_allclose(found, expected, atol=1e-5)


def test_the_highest_face_counts_and_modifiers_too(ocean, mask, empty_scene):
    faces = [((0.0, 0.0), (DOMAIN, DOMAIN), 1.0), ((0.0, 0.0), (DOMAIN, DOMAIN), 5.0)]
    mask.mesh, mask.vertex_group = new_mesh("Coast", faces, [0.0] * 4 + [1.0] * 4), "Waves"
    mask.mesh.modifiers.new("Half", "SOLIDIFY").thickness = 0.1
    bpy.ops.ocean.read_weights(samples=4)
    found = ocean.ocean_tweak.to_parameters(empty_scene).layers[0].mask.image.values
    np.testing.assert_allclose(found, 1.0, atol=1e-5)


def test_strokes_and_moves_are_read_by_themselves(ocean, mask, empty_scene, extension, monkeypatch):
    painting = extension("scene.mask_following")
    asked = []
    monkeypatch.setattr(painting, "read_soon", lambda: asked.append(True))
    mesh = new_mesh("Coast", [((0.0, 0.0), (DOMAIN, DOMAIN), 0.0)], [0.25] * 4)
    mask.mesh, mask.vertex_group = mesh, "Waves"
    bpy.ops.ocean.read_weights(samples=16)
    before = heights(ocean)

    def is_read_after(change):
        asked.clear()
        change()
        bpy.context.view_layer.update()
        was_asked = bool(asked)
        painting.read()
        return was_asked

    bpy.context.view_layer.update()
    assert not is_read_after(lambda: None)
    bpy.context.view_layer.objects.active = mesh
    bpy.ops.object.mode_set(mode="WEIGHT_PAINT")
    assert is_read_after(
        lambda: (mesh.vertex_groups[0].add([0, 1, 2, 3], 0.75, "REPLACE"), mesh.data.update())
    )
    np.testing.assert_allclose(heights(ocean), 3.0 * before, atol=2e-3)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert not is_read_after(mesh.data.update)  # by something else: it may read the sea
    assert is_read_after(lambda: setattr(mesh, "location", (0.5 * DOMAIN, 0.0, 0.0)))
    assert np.abs(heights(ocean)[:, 4:12]).max() < 1e-3
    mesh.location.x = 2.0 * DOMAIN
    bpy.context.view_layer.update()
    painting.read()
    assert "move it there" in ocean.ocean_tweak.error


def test_reading_again_keeps_one_image(ocean, mask):
    mask.mesh = new_mesh("Coast", [((0.0, 0.0), (DOMAIN, DOMAIN), 0.0)], [0.25] * 4)
    mask.vertex_group = "Waves"
    bpy.ops.ocean.read_weights(samples=4)
    first = len(bpy.data.images)
    mask.mesh.vertex_groups["Waves"].add([0, 1, 2, 3], 0.75, "REPLACE")
    bpy.ops.ocean.read_weights(samples=4)
    assert len(bpy.data.images) == first
    found = np.empty(4 * 16, np.float32)
    mask.image.pixels.foreach_get(found)
    np.testing.assert_allclose(found.reshape(-1, 4)[:, 0], 0.75, atol=1e-6)


@pytest.mark.parametrize("fault", ["no mesh", "no group", "elsewhere"])
def test_weights_that_are_not_there_are_refused(ocean, mask, fault):
    faces = [((-20.0, -20.0), (-10.0, -10.0), 0.0)]
    if fault != "no mesh":
        mask.mesh = new_mesh("Coast", faces, [1.0] * 4)
    mask.vertex_group = "Waves" if fault == "elsewhere" else "Wales"
    told = {"no mesh": "Choose a mesh", "no group": "has no vertex group", "elsewhere": "move it there"}
    with pytest.raises(RuntimeError, match=told[fault]):
        bpy.ops.ocean.read_weights()
    assert mask.source == "NONE"
    assert mask.image is None


def test_a_patch_has_one_of_its_own(ocean, core, make_parameters, empty_scene):
    patches = core.Patch(DOMAIN, 0.0, 20.0, 1e6, 32), core.Patch(44.0, 0.7, 9.0, 20.0, 32)
    settings = ocean.ocean_tweak
    settings.from_parameters(make_parameters(patches=patches), empty_scene)
    group = settings.patches[1].mask
    group.mesh = new_mesh("Coast", [((0.0, 0.0), (DOMAIN, DOMAIN), 0.0)], [0.5] * 4)
    group.vertex_group = "Waves"
    assert bpy.ops.ocean.read_weights(patch=1, samples=4) == {"FINISHED"}
    parameters = settings.to_parameters(empty_scene)
    assert parameters.patches[1].mask.image.values.max() == 0.5
    assert_alike(read(evaluated_mesh(ocean), SIDE, SIDE), wanted(core, parameters, 1))


def test_parameters_with_masks_come_back(ocean, core, make_parameters, empty_scene):
    image = core.Mask(source="IMAGE", image=core.Raster([[0.0, 0.5], [1.0, 0.25]], "Shore"))
    layers = (
        core.WaveLayer(mask=core.Mask(x=10.0, y=20.0, inner_radius=5.0, outer_radius=9.0, inverted=True)),
        core.WaveLayer(mask=image),
    )
    wall = core.Mask(lines=core.Raster([[[1.0, 2.0, 30.1, 0.7]]]), strength=0.6)
    parameters = with_layers(make_parameters(layers=layers, mask=wall), IMAGE=(core.ImageLayer(mask=image),))
    settings = ocean.ocean_tweak
    settings.from_parameters(parameters, empty_scene)
    assert settings.to_parameters(empty_scene) == parameters
    assert settings.layers[1].mask.image == settings.layers[2].image_waves.mask.image
    bare = tuple(dataclasses.replace(layer, mask=None) for layer in layers)
    settings.from_parameters(with_layers(parameters.replace(layers=bare), IMAGE=()), empty_scene)
    assert {layer.mask.source for layer in settings.layers} == {"NONE"}


def test_a_baked_masked_sea_is_the_live_one(ocean, mask, core, empty_scene, bake, ocean_object):
    mask.inner_radius, mask.outer_radius, mask.source = 10.0, 60.0, "DISTANCE"
    parameters = ocean.ocean_tweak.to_parameters(empty_scene)
    sequence = bake(parameters, 1, 2, maps=ALL_MAPS)
    ocean_object.use_sequence(ocean, empty_scene, sequence)
    empty_scene.frame_set(2)
    assert_alike(read(evaluated_mesh(ocean), SIDE, SIDE), wanted(core, parameters, 2))
