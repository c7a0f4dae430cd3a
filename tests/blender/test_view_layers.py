# SPDX-License-Identifier: GPL-3.0-or-later
"""Oceans that the first view layer does not show keep their animation: baked, floated, recorded, rendered."""

import bpy
import numpy as np
import pytest

#: m/s at frames 1 and 11
WINDS = {1: 5.0, 11: 15.0}


@pytest.fixture
def water(ocean, empty_scene):
    """A collection with an ocean whose wind rises, and that comes closer."""
    collection = bpy.data.collections.new("Water")
    empty_scene.collection.children.link(collection)
    empty_scene.collection.objects.unlink(ocean)
    collection.objects.link(ocean)
    for frame, wind in WINDS.items():
        ocean.ocean_tweak.layers[0].wind_speed = wind
        ocean.keyframe_insert("ocean_tweak.layers[0].wind_speed", frame=frame)
        ocean.location.x = 10.0 * frame
        ocean.keyframe_insert("location", frame=frame)
    empty_scene.frame_start, empty_scene.frame_end, empty_scene.frame_step = 1, 11, 10
    empty_scene.frame_set(1)
    bpy.context.view_layer.update()
    return collection


def exclude(scene, *numbers):
    for number in numbers:
        scene.view_layers[number].layer_collection.children["Water"].exclude = True


def of_another_layer(scene, _water, _ocean):
    scene.view_layers.new("Two")
    exclude(scene, 0)


def excluded(scene, _water, _ocean):
    scene.view_layers.new("Two")
    exclude(scene, 0, 1)


def hidden(_scene, _water, ocean):
    ocean.hide_viewport = True


def of_a_hidden_collection(_scene, water, _ocean):
    water.hide_viewport = True


def instanced(scene, water, _ocean):
    scene.collection.children.unlink(water)
    empty = bpy.data.objects.new("Instance", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", water
    scene.collection.objects.link(empty)
    empty.hide_viewport = True


PLACES = (of_another_layer, excluded, hidden, of_a_hidden_collection, instanced)


@pytest.mark.parametrize("put", PLACES)
def test_a_shot_has_the_animation_wherever_the_ocean_is(water, ocean, empty_scene, extension, put, capfd):
    put(empty_scene, water, ocean)
    kept = set(bpy.data.objects)
    sea = extension("registration").scene_oceans()["Ocean"]
    assert sea.frames == (1, 11)
    for frame, wind in WINDS.items():
        assert sea.shot.at(frame).parameters.layers[0].wind_speed == pytest.approx(wind)
    assert ("is in no view layer of Scene that is rendered" in capfd.readouterr().err) == (put is excluded)
    assert set(bpy.data.objects) == kept
    assert empty_scene.frame_current == 1


@pytest.mark.parametrize("put", [of_another_layer, hidden])
def test_floating_on_it_is_baked_with_the_animation(
    water, ocean, empty_scene, extension, make_parameters, put
):
    boat = bpy.data.objects.new("Boat", bpy.data.meshes.new("Boat"))
    empty_scene.collection.objects.link(boat)
    boat.location = (60.0, 40.0, 0.0)
    floating, baking = extension("scene.floating"), extension("scene.float_bake")

    def keys():
        ride = floating.Ride()
        bake = baking.FloatBake(empty_scene, [boat], ocean, lambda _: ride, range(10, 12))
        for _ in bake.frames:
            bake.advance()
        bake.finish()
        made = [list(point.co) for curve in curves(boat) for point in curve.keyframe_points]
        extension("scene.float_keys").unbake(boat)
        return np.array(made)

    curves = extension("scene.animated").curves_of
    seen = keys()
    assert np.ptp(seen[:, 1]) > 0.1
    put(empty_scene, water, ocean)
    np.testing.assert_allclose(keys(), seen, atol=1e-5)


def test_painted_weights_of_another_layer_are_those_of_the_moved_mesh(ocean, empty_scene, extension):
    """A sheet over the patch's western half is moved east by its modifier."""
    sheet = bpy.data.objects.new("Sheet", bpy.data.meshes.new("Sheet"))
    corners = [(0.0, 0.0), (75.0, 0.0), (75.0, 150.0), (0.0, 150.0)]
    sheet.data.from_pydata([(x, y, 5.0) for x, y in corners], [], [(0, 1, 2, 3)])
    sheet.vertex_groups.new(name="Painted").add(range(4), 1.0, "REPLACE")
    mover = sheet.modifiers.new("Mover", "DISPLACE")
    mover.direction, mover.strength, mover.mid_level = "X", 75.0, 0.0
    aside = bpy.data.collections.new("Water")
    empty_scene.collection.children.link(aside)
    aside.objects.link(sheet)
    empty_scene.view_layers.new("Two")
    exclude(empty_scene, 0)
    module = extension("scene.vertex_weights")
    seen = module.weights_seen(module.WeightsReading(ocean, sheet, "Painted", empty_scene, 16)).values
    np.testing.assert_allclose(seen[..., 0], np.repeat([[0.0] * 8 + [1.0] * 8], 16, axis=0), atol=1e-6)


def test_a_live_render_of_the_second_layer_is_the_frame_s_sea(
    water, ocean, empty_scene, rendering, extension, core, evaluated
):
    empty_scene.frame_set(11)
    heights = evaluated(ocean)[..., 2].ravel()
    of_another_layer(empty_scene, water, ocean)
    empty_scene.frame_set(1)
    empty_scene.frame_set(11)

    def look(mesh):
        return [vertex.co.z for vertex in mesh.vertices]

    np.testing.assert_allclose(rendering(look)["Ocean"], heights, atol=1e-4)


def test_one_broken_ocean_keeps_no_other_from_its_shot(ocean, ocean_object, empty_scene, extension):
    other = ocean_object.add(empty_scene, ocean.ocean_tweak.to_parameters(empty_scene), name="Broken")
    other.ocean_tweak.layers[0].mask.source = "IMAGE"
    oceans = extension("registration").scene_oceans()
    assert set(oceans) == {"Ocean", "Broken"}
    assert oceans["Ocean"].shot.parameters.seed == 7
    with pytest.raises(ValueError, match="image"):
        oceans["Broken"]
