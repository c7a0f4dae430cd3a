# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks whose object moves by itself: at each frame where it is then, in viewport, render and bake."""

import bpy
import numpy as np
import pytest

from .conftest import SAMPLES, evaluated_mesh, positions_of
from .surfaces import assert_alike, read, wanted

SIDE = SAMPLES + 1
LAST = 11


@pytest.fixture
def ocean(ocean_object, make_parameters, empty_scene):
    empty_scene.frame_start, empty_scene.frame_end = 1, LAST
    return ocean_object.add(empty_scene, make_parameters())


def place_at(frame):
    """Of what goes 60 m along x in ten frames, and stays before and after."""
    return 30.0 + 6.0 * (min(max(frame, 1), LAST) - 1), 50.0


def moving(scene, how):
    """An object that goes so, by keys of its own or of another one."""
    item = bpy.data.objects.new("Post", None)
    scene.collection.objects.link(item)
    item.location = (*place_at(1), 0.0)
    keyed, begin = item, 30.0
    if how in ("parent", "constraint", "driver"):
        keyed, begin = bpy.data.objects.new("Crane", None), 0.0
        scene.collection.objects.link(keyed)
    if how == "parent":
        item.parent = keyed
    elif how == "constraint":
        item.constraints.new("COPY_LOCATION").target = keyed
        item.constraints[0].use_offset = True
    elif how == "driver":
        driver = item.driver_add("delta_location", 0).driver
        driver.type = "SUM"
        target = driver.variables.new().targets[0]
        target.id, target.data_path = keyed, "location.x"
    for frame in (1, LAST):
        keyed.location.x = begin + 6.0 * (frame - 1)
        keyed.keyframe_insert("location", index=0, frame=frame)
    for layer in keyed.animation_data.action.layers:
        for point in layer.strips[0].channelbag(keyed.animation_data.action_slot).fcurves[0].keyframe_points:
            point.interpolation = "LINEAR"
    return item


def measured(group, item, shape="ORIGIN"):
    group.inner_radius, group.outer_radius = 10.0, 25.0
    group.object, group.measured_from, group.source = item, shape, "DISTANCE"
    bpy.context.view_layer.update()


def mask_at(ocean, core, scene, frame):
    x, y = place_at(frame)
    parameters = ocean.ocean_tweak.to_parameters(scene)
    return parameters.replace(mask=core.Mask(x=x, y=y, inner_radius=10.0, outer_radius=25.0))


@pytest.mark.parametrize("hidden", [False, True])
@pytest.mark.parametrize("how", ["keys", "parent", "constraint", "driver"])
def test_each_frame_has_the_place_of_then(ocean, core, empty_scene, how, hidden, capfd):
    post = moving(empty_scene, how)
    measured(ocean.ocean_tweak.mask, post)
    if hidden:
        post.hide_viewport = post.hide_render = True
    for frame in (4, LAST, 2):
        empty_scene.frame_set(frame)
        expected = wanted(core, mask_at(ocean, core, empty_scene, frame), frame)
        assert_alike(read(evaluated_mesh(ocean), SIDE, SIDE), expected)
        assert ocean.ocean_tweak.mask.x == pytest.approx(place_at(frame)[0], abs=1e-4)
    assert not ocean.ocean_tweak.error
    assert "ependency cycle" not in "".join(capfd.readouterr())


@pytest.mark.parametrize("hidden", [False, True])
def test_a_shot_has_the_motion_whatever_frame_is_shown(ocean, core, empty_scene, extension, hidden):
    shots = extension("scene.shots")
    post = moving(empty_scene, "keys")
    measured(ocean.ocean_tweak.layers[0].mask, post)
    post.hide_viewport = hidden
    empty_scene.frame_set(7)
    shot = shots.shot_of(ocean, empty_scene)
    for frame in range(1, LAST + 1):
        mask = shot.at(frame).parameters.layers[0].mask
        assert (mask.x, mask.y) == pytest.approx(place_at(frame), abs=1e-4)
    assert shot.parameters.layers[0].mask.x == pytest.approx(30.0)
    empty_scene.frame_set(3)
    assert shots.shot_of(ocean, empty_scene) == shot
    post.location.y = 70.0
    bpy.context.view_layer.update()
    assert shots.shot_of(ocean, empty_scene) != shot


def test_a_bake_has_the_motion(ocean, core, empty_scene, tmp_path):
    post = moving(empty_scene, "keys")
    measured(ocean.ocean_tweak.mask, post)
    empty_scene.frame_end = 3
    bpy.context.view_layer.objects.active = ocean
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    assert ocean.ocean_tweak.source == "SEQUENCE"
    for frame in (3, 1):
        empty_scene.frame_set(frame)
        expected = wanted(core, mask_at(ocean, core, empty_scene, frame), frame)
        found = read(evaluated_mesh(ocean), SIDE, SIDE)
        np.testing.assert_allclose(found["position"], expected["position"], atol=1e-3)
        assert not ocean.ocean_tweak.bake_differs
    post.location.y = 80.0
    bpy.context.view_layer.update()
    empty_scene.frame_set(2)
    assert "mask.y" in ocean.ocean_tweak.bake_differs


def test_a_shape_that_turns(ocean, core, empty_scene, extension, tmp_path):
    """A wall of 40 m about its end: a quarter turn in ten frames."""
    data = bpy.data.meshes.new("Wall")
    data.from_pydata([(0.0, 0.0, 0.0), (40.0, 0.0, 0.0)], [(0, 1)], [])
    wall = bpy.data.objects.new("Wall", data)
    empty_scene.collection.objects.link(wall)
    wall.location = (60.0, 60.0, 0.0)
    for frame, turn in ((1, 0.0), (LAST, np.pi / 2)):
        wall.rotation_euler.z = turn
        wall.keyframe_insert("rotation_euler", index=2, frame=frame)
    measured(ocean.ocean_tweak.mask, wall, "SHAPE")
    empty_scene.frame_set(LAST)
    lines = ocean.ocean_tweak.to_parameters(empty_scene).mask.lines.values
    np.testing.assert_allclose(lines, [[[60.0, 60.0, 60.0, 100.0]]], atol=1e-4)
    assert_alike(
        read(evaluated_mesh(ocean), SIDE, SIDE),
        wanted(core, ocean.ocean_tweak.to_parameters(empty_scene), LAST),
    )
    shot = extension("scene.shots").shot_of(ocean, empty_scene)
    track = dict(shot.animation.samples)["mask.lines"].values
    assert track.shape == (LAST + 2, 1, 4)
    np.testing.assert_allclose(track[1], [[60.0, 60.0, 100.0, 60.0]], atol=1e-4)
    np.testing.assert_allclose(np.hypot(*(track[:, 0, 2:] - track[:, 0, :2]).T), 40.0, rtol=1e-5)
    file, before = tmp_path / "shot.json", ocean.ocean_tweak.to_parameters(empty_scene)
    file.write_text(shot.to_json(), encoding="utf-8")
    with pytest.raises(RuntimeError, match=r"mask\.lines moves in this shot"):
        bpy.ops.ocean.import_parameters(filepath=str(file))
    assert ocean.ocean_tweak.to_parameters(empty_scene) == before


def test_a_render_has_the_place_of_its_frame(ocean, core, empty_scene, tmp_path):
    """What is hidden in renders, as such objects are, moves there too."""
    post = moving(empty_scene, "parent")
    measured(ocean.ocean_tweak.mask, post)
    post.hide_render = post.parent.hide_render = True
    seen = {}

    class Probe(bpy.types.RenderEngine):
        bl_idname, bl_label = "OCEAN_TEST_PROBE", "Probe"

        def render(self, depsgraph):
            item = next(each for each in depsgraph.objects if each.name == ocean.name)
            seen[depsgraph.scene.frame_current] = positions_of(item.data)

    bpy.utils.register_class(Probe)
    try:
        camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        empty_scene.collection.objects.link(camera)
        empty_scene.camera = camera
        render = empty_scene.render
        render.engine, render.resolution_x, render.resolution_y = Probe.bl_idname, 8, 8
        render.filepath = str(tmp_path / "####")
        empty_scene.frame_start, empty_scene.frame_end = 4, 5
        bpy.ops.render.render(animation=True)
    finally:
        bpy.utils.unregister_class(Probe)
    for frame in (4, 5):
        expected = wanted(core, mask_at(ocean, core, empty_scene, frame), frame)["position"]
        np.testing.assert_allclose(seen[frame].reshape(SIDE, SIDE, 3), expected, atol=1e-4)


def test_an_ocean_that_moves_over_its_mask(ocean, core, empty_scene):
    post = bpy.data.objects.new("Post", None)
    empty_scene.collection.objects.link(post)
    post.location = (70.0, 50.0, 0.0)
    for frame, x in ((1, 0.0), (LAST, 20.0)):
        ocean.location.x = x
        ocean.keyframe_insert("location", index=0, frame=frame)
    measured(ocean.ocean_tweak.mask, post)
    empty_scene.frame_set(LAST)
    assert ocean.ocean_tweak.to_parameters(empty_scene).mask.x == pytest.approx(50.0, abs=1e-4)


def test_what_stands_needs_nothing(ocean, empty_scene, extension):
    following = extension("scene.mask_following")
    post = bpy.data.objects.new("Post", None)
    empty_scene.collection.objects.link(post)
    measured(ocean.ocean_tweak.mask, post)
    assert not following.is_bound(ocean)
    post.keyframe_insert("location", frame=1)
    bpy.context.view_layer.update()
    assert following.is_bound(ocean)
    bpy.data.objects.remove(post)
    bpy.context.view_layer.update()
    assert not following.is_bound(ocean)


def test_a_shot_that_is_taken_over_gets_a_keyed_place(ocean, core, empty_scene, extension):
    measured(ocean.ocean_tweak.layers[0].mask, moving(empty_scene, "keys"))
    shots = extension("scene.shots")
    shot = shots.shot_of(ocean, empty_scene)
    ocean.location = (7.0, -3.0, 0.0)
    ocean.ocean_tweak.from_parameters(shot.parameters, empty_scene)
    shots.animate(ocean, empty_scene, shot)
    assert ocean.ocean_tweak.layers[0].mask.object.parent == ocean
    again = shots.shot_of(ocean, empty_scene)
    for frame in (1, 4, LAST):
        found, expected = (each.at(frame).parameters.layers[0].mask for each in (again, shot))
        assert (found.x, found.y) == pytest.approx((expected.x, expected.y), abs=1e-4)


def test_a_second_import_leaves_no_place_of_the_first(
    ocean, empty_scene, extension, tmp_path, make_parameters
):
    measured(ocean.ocean_tweak.layers[0].mask, moving(empty_scene, "keys"))
    file, still = tmp_path / "shot.json", tmp_path / "still.json"
    file.write_text(extension("scene.shots").shot_of(ocean, empty_scene).to_json(), encoding="utf-8")
    still.write_text(make_parameters().to_json(), encoding="utf-8")
    bpy.context.view_layer.objects.active = ocean
    before = set(bpy.data.objects)
    for _ in range(2):
        assert bpy.ops.ocean.import_parameters(filepath=str(file)) == {"FINISHED"}
        (place,) = set(bpy.data.objects) - before
        assert ocean.ocean_tweak.layers[0].mask.object == place
    bpy.ops.ocean.import_parameters(filepath=str(still))
    assert set(bpy.data.objects) == before


@pytest.mark.parametrize("is_read", [False, True])
def test_its_place_goes_with_a_deleted_ocean(ocean, empty_scene, extension, is_read):
    """Unless the mask of another ocean measures from it.

    is_read : whether a horizon keeps the deleted ocean in the file
    """
    measured(ocean.ocean_tweak.layers[0].mask, moving(empty_scene, "keys"))
    shots, surroundings = extension("scene.shots"), extension("scene.surroundings")
    shot = shots.shot_of(ocean, empty_scene)
    ocean.ocean_tweak.from_parameters(shot.parameters, empty_scene)
    shots.animate(ocean, empty_scene, shot)
    place = ocean.ocean_tweak.layers[0].mask.object
    twin = ocean.copy()
    empty_scene.collection.objects.link(twin)
    if is_read:
        for each in (ocean, twin):
            surroundings.add_horizon(each, shot.parameters, empty_scene, empty_scene.collection, 2)
    for item, is_kept in ((ocean, True), (twin, False)):
        bpy.context.view_layer.update()
        with bpy.context.temp_override(selected_objects=[item], selected_ids=[item]):
            bpy.ops.object.delete()
        bpy.context.view_layer.update()
        assert (place.name in empty_scene.objects) == is_kept
