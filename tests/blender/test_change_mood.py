# SPDX-License-Identifier: GPL-3.0-or-later
"""Another mood for an ocean that is there: sea, sky and camera change, and nothing is there twice."""

import math

import bpy
import pytest


def oceans(scene):
    return [item for item in scene.objects if item.ocean_tweak.is_ocean]


def kinds(scene):
    """How many objects of a kind a scene has, by what their names begin with."""
    words = ("Ocean Horizon", "Ocean Camera Surface", "Ocean Camera", "Ocean Sun", "Buoy", "Fishing Boat")
    names = [item.name for item in scene.objects if not item.hide_viewport or "Horizon" in item.name]
    found = {}
    for name in names:
        word = next((word for word in words if name.startswith(word)), None)
        if word is not None and "Place" not in name:
            found[word] = found.get(word, 0) + 1
    return found


def test_there_and_back(quick, empty_scene, extension):
    """What the scene shows after a change is what a new scene of that mood shows."""
    bpy.ops.ocean.add_scene(mood="CALM")
    (ocean,), camera, world = oceans(empty_scene), empty_scene.camera, empty_scene.world
    calm = ocean.ocean_tweak.to_parameters(empty_scene)
    there = camera.location.copy()
    assert kinds(empty_scene) == {"Ocean Horizon": 1, "Ocean Camera": 1, "Ocean Sun": 1, "Buoy": 1}

    assert bpy.ops.ocean.change_mood(mood="STORM") == {"FINISHED"}
    assert oceans(empty_scene) == [ocean]
    wanted = quick["STORM"].sea(calm.timing)
    found = ocean.ocean_tweak.to_parameters(empty_scene)
    assert found.layers == wanted.layers
    assert found.spray == wanted.spray
    assert len(found.patches) == len(wanted.patches) == 4
    expected = {"Ocean Camera Surface": 1, "Ocean Camera": 1, "Ocean Sun": 1, "Fishing Boat": 1}
    assert kinds(empty_scene) == expected
    assert empty_scene.camera == camera
    assert camera.data.lens == pytest.approx(quick["STORM"].lens)
    assert empty_scene.world == world
    assert world.name == "Storm Sky"
    assert empty_scene.view_settings.exposure == pytest.approx(quick["STORM"].sky.exposure)
    elevation = empty_scene.ocean_tweak_sky.sun_elevation
    assert elevation == pytest.approx(quick["STORM"].sky.sun_elevation)
    assert ocean.active_material.name == "Ocean Tweak Water Stormy"

    assert bpy.ops.ocean.change_mood(mood="CALM") == {"FINISHED"}
    assert oceans(empty_scene) == [ocean]
    assert ocean.ocean_tweak.to_parameters(empty_scene) == calm
    assert kinds(empty_scene) == {"Ocean Horizon": 1, "Ocean Camera": 1, "Ocean Sun": 1, "Buoy": 1}
    assert tuple(camera.location) == pytest.approx(tuple(there), abs=1e-4)
    assert not ocean.hide_render
    heights = [curve for curve in curves(camera) if curve.data_path == "location"]
    assert [curve.array_index for curve in heights] == [2]


def curves(item):
    return item.animation_data.action.layers[0].strips[0].channelbags[0].fcurves


def test_what_is_the_artists_own_stays(quick, empty_scene, extension, capfd):
    bpy.ops.ocean.add_scene(mood="CALM", use_buoy=False)
    (ocean,) = oceans(empty_scene)
    own = bpy.data.objects.new("Mine", bpy.data.cameras.new("Mine"))
    ship = bpy.data.objects.new("Ship", bpy.data.meshes.new("Ship"))
    for item in (own, ship):
        empty_scene.collection.objects.link(item)
    ship.data.from_pydata([(-1, -1, 0), (1, -1, 0), (0, 1, 1)], [], [(0, 1, 2)])
    extension("scene.floating").float_on(ship, ocean)
    empty_scene.camera, empty_scene.world = own, bpy.data.worlds.new("My World")
    bpy.ops.ocean.change_mood(mood="FRESH_BREEZE")
    assert empty_scene.camera != own
    assert "Mine is kept" in capfd.readouterr().out
    assert own.name in empty_scene.objects
    assert bpy.data.worlds["My World"].use_fake_user
    assert extension("scene.floating").floats(ship)
    assert not {"Buoy", "Fishing Boat"} & kinds(empty_scene).keys()


def test_a_bake_is_not_changed(quick, empty_scene, ocean, bake, make_parameters):
    files = bake(make_parameters(seed=3), 1, 3)
    bpy.ops.ocean.use_sequence(filepath=str(files.path(1)))
    before = ocean.ocean_tweak.to_parameters(empty_scene)
    with pytest.raises(RuntimeError, match="shows a bake"):
        bpy.ops.ocean.change_mood(mood="STORM")
    assert ocean.ocean_tweak.to_parameters(empty_scene) == before
    assert empty_scene.world is None or empty_scene.world.name != "Storm Sky"
    assert empty_scene.camera is None


def test_a_turned_ocean_is_looked_at_as_it_lies(quick, empty_scene, extension):
    """The camera stands above the water and not in it."""
    bpy.ops.ocean.add_scene(mood="CALM")
    (ocean,) = oceans(empty_scene)
    ocean.rotation_euler.z = math.radians(70.0)
    bpy.ops.ocean.change_mood(mood="FRESH_BREEZE")
    sea = extension("core").Ocean(ocean.ocean_tweak.to_parameters(empty_scene))
    x, y, z = empty_scene.camera.location - ocean.location
    assert 0.5 * quick["FRESH_BREEZE"].eye < z - sea.height_at(x, y, 0.0) < 2.0 * quick["FRESH_BREEZE"].eye


def test_one_undo_takes_it_back(quick, empty_scene, window):
    with window.override():
        bpy.ops.ocean.add_scene(mood="CALM")
        bpy.ops.ed.undo_push(message="calm")
        before = kinds(bpy.context.scene)
        bpy.ops.ocean.change_mood(mood="STORM")
        bpy.ops.ed.undo_push(message="storm")
        bpy.ops.ed.undo()
        scene = bpy.context.scene
        assert kinds(scene) == before
        assert scene.world.name == "Calm Sky"
        assert len(oceans(scene)) == 1
