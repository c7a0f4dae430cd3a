# SPDX-License-Identifier: GPL-3.0-or-later
"""An ocean whose modifier was applied or removed, or that was converted, is a still mesh and stays one."""

import bpy
import numpy as np
import pytest

from .conftest import evaluated_mesh, vertices
from .layouts import draw  # noqa: F401

METHODS = ("NODES", "DISPLACE")


@pytest.fixture(params=METHODS)
def live(request, ocean_object, make_parameters, empty_scene):
    """A live ocean at frame 10, active and selected, with all maps."""
    item = ocean_object.add(empty_scene, make_parameters(), request.param)
    item.ocean_tweak.use_velocity = True
    bpy.context.view_layer.objects.active = item
    item.select_set(True)
    empty_scene.frame_set(10)
    return item


def apply(item):
    with bpy.context.temp_override(object=item):
        assert bpy.ops.object.modifier_apply(modifier=item.modifiers[0].name) == {"FINISHED"}


def convert(_item):
    assert bpy.ops.object.convert(target="MESH") == {"FINISHED"}


@pytest.mark.parametrize("how", [apply, convert])
@pytest.mark.parametrize("source", ["LIVE", "SEQUENCE"])
def test_it_stays_still(live, ocean_object, bake, make_parameters, empty_scene, tmp_path, draw, how, source):  # noqa: F811
    if source == "SEQUENCE":
        ocean_object.use_sequence(live, empty_scene, bake(make_parameters(), 10, 20))
    still = vertices(live)
    assert np.ptp(still[..., 2]) > 0.5
    how(live)
    for frame in (20, 10):
        empty_scene.frame_set(frame)
        np.testing.assert_allclose(vertices(live), still, atol=1e-5)
    assert not live.modifiers
    assert not live.ocean_tweak.is_ocean
    assert "velocity" not in live.data.attributes  # Cycles would blur by it
    assert "This mesh was an ocean" in " ".join(draw(live))
    live.ocean_tweak.choppiness = 0.2
    assert bpy.ops.object.duplicate(linked=True) == {"FINISHED"}
    assert not bpy.context.active_object.modifiers
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "still.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "still.blend"))
    bpy.context.scene.frame_set(30)
    for name in ("Ocean", "Ocean.001"):
        np.testing.assert_allclose(vertices(bpy.data.objects[name]), still, atol=1e-5)
    assert not bpy.data.textures
    # what node groups of all oceans share is hidden
    assert not [image for image in bpy.data.images if image.users and not image.name.startswith(".")]


@pytest.mark.parametrize("saved", [True, False])
def test_a_file_from_the_moment_after_is_still_too(live, extension, empty_scene, tmp_path, saved):
    """Saved before anything was evaluated, and by a Blender that did not notice."""
    still = vertices(live)
    with extension("scene.handlers").asleep():
        apply(live)
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "still.blend"))
        if saved:
            bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "still.blend"))
    live = bpy.data.objects["Ocean"]
    bpy.context.scene.frame_set(11)
    np.testing.assert_allclose(vertices(live), still, atol=1e-5)
    assert not live.ocean_tweak.is_ocean


def test_the_original_that_convert_keeps_goes_on(live, make_parameters, expected, empty_scene):
    still = vertices(live)
    assert bpy.ops.object.convert(target="MESH", keep_original=True) == {"FINISHED"}
    copy = bpy.context.active_object
    assert copy != live
    empty_scene.frame_set(20)
    np.testing.assert_allclose(vertices(copy), still, atol=1e-5)
    np.testing.assert_allclose(vertices(live), expected(make_parameters(), 20), atol=1e-3)
    assert (live.ocean_tweak.is_ocean, copy.ocean_tweak.is_ocean) == (True, False)


@pytest.mark.parametrize("how", ["convert", "apply"])
def test_a_linked_duplicate_goes_on(live, make_parameters, expected, empty_scene, how):
    still = vertices(live)
    assert bpy.ops.object.duplicate(linked=True) == {"FINISHED"}
    copy = bpy.context.active_object
    if how == "convert":  # Blender gives the converted mesh to all that share it
        convert(copy)
    else:
        with bpy.context.temp_override(object=copy):
            bpy.ops.object.modifier_apply(modifier=copy.modifiers[0].name, single_user=True)
    for frame in (20, 10):
        empty_scene.frame_set(frame)
        np.testing.assert_allclose(vertices(copy), still, atol=1e-5)
        np.testing.assert_allclose(vertices(live), expected(make_parameters(), frame), atol=1e-3)


def test_a_finer_render_does_not_bring_the_sea_back(live, rendering, empty_scene):
    live.ocean_tweak.viewport_resolution = 16
    assert len(live.modifiers) > 1
    still = vertices(live)
    names = [modifier.name for modifier in live.modifiers]
    with bpy.context.temp_override(object=live):
        bpy.ops.object.modifier_apply(modifier="Ocean Tweak")
    assert "Ocean Tweak Render" in names
    empty_scene.frame_set(20)
    seen = rendering(lambda mesh: [vertex.co.z for vertex in mesh.vertices])
    np.testing.assert_allclose(seen["Ocean"], still[..., 2].ravel(), atol=1e-5)


def test_undo_makes_it_an_ocean_again(live, make_parameters, expected, window):
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        apply(live)
        bpy.context.view_layer.update()
        bpy.ops.ed.undo_push(message="applied")
        bpy.ops.ed.undo()
    live = bpy.data.objects["Ocean"]
    bpy.context.scene.frame_set(20)
    assert live.ocean_tweak.is_ocean
    np.testing.assert_allclose(vertices(live), expected(make_parameters(), 20), atol=1e-3)


def test_what_showed_the_sea_and_what_floats_on_it(extension, ocean_object, make_parameters, empty_scene):
    live = ocean_object.add(empty_scene, make_parameters())
    boat = bpy.data.objects.new("Boat", bpy.data.meshes.new("Boat"))
    boat.location = (60.0, 60.0, 0.0)
    empty_scene.collection.objects.link(boat)
    empty_scene.view_layers.update()
    floating = extension("scene.floating")
    floating.float_on(boat, live)
    extension("scene.camera_surface").add_camera_surface(live, empty_scene)
    empty_scene.frame_set(10)
    height = boat.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation.z
    assert abs(height) > 0.05
    apply(live)
    empty_scene.frame_set(20)
    assert extension("scene.camera_surface").camera_surface_of(live) is None
    assert (live.hide_render, live.display_type) == (False, "TEXTURED")
    on_still = boat.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation.z
    assert on_still == pytest.approx(height, abs=1e-3)
    other = ocean_object.add(empty_scene, make_parameters(), name="Other")
    bake = extension("scene.float_bake").FloatBake(
        empty_scene, [boat], other, lambda _: floating.Ride(), range(1, 3)
    )
    with pytest.raises(floating.FloatError, match="Ocean is no longer an ocean"):
        bake.advance()
    bake.cancel()


def test_a_removed_modifier_ends_it_too(live, empty_scene):
    live.modifiers.clear()
    empty_scene.frame_set(12)
    assert not live.modifiers
    assert not live.ocean_tweak.is_ocean
    assert np.ptp([vertex.co.z for vertex in evaluated_mesh(live).vertices]) == 0.0
