# SPDX-License-Identifier: GPL-3.0-or-later
"""Oceans that a shot overrides from an asset file: what the shot does with them is there when it opens."""

import bpy
import numpy as np
import pytest

from .camera_views import numbers
from .conftest import evaluated_mesh
from .other_blender import look

TOLERANCE = 2e-3  # m; images keep 2⁻¹⁶ of their values
METHODS = ("NODES", "DISPLACE")


@pytest.fixture
def asset(empty_scene, ocean_object, make_parameters, tmp_path, monkeypatch):
    """A file with an ocean of each method in one collection."""
    monkeypatch.delenv("OCEAN_TWEAK_CACHE", raising=False)
    water = bpy.data.collections.new("Water")
    empty_scene.collection.children.link(water)
    for method in METHODS:
        item = ocean_object.add(empty_scene, make_parameters(), method, name=method, collection=water)
        item.ocean_tweak.use_foam = item.ocean_tweak.use_velocity = item.ocean_tweak.use_normals = False
    path = tmp_path / "asset.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return path


@pytest.fixture
def shot(asset, tmp_path):
    """A file that overrides them."""
    bpy.ops.wm.read_homefile(use_empty=True)
    path = tmp_path / "shots" / "shot.blend"
    path.parent.mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 3
    override_all(asset)
    return path


def override_all(asset):
    with bpy.data.libraries.load(str(asset), link=True) as (_, wanted):
        wanted.collections = ["Water"]
    wanted.collections[0].override_hierarchy_create(bpy.context.scene, bpy.context.view_layer)


def overrides():
    return {item.name: item for item in bpy.data.objects if item.override_library and item.type == "MESH"}


def bake_all():
    for item in overrides().values():
        bpy.context.view_layer.objects.active = item
        assert bpy.ops.ocean.bake() == {"FINISHED"}


def open_again(path):
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=str(path))


def check(expected, evaluated, sea, frames=(1, 3)):
    """All of them are where this sea is."""
    assert overrides() or bpy.data.objects["NODES"]
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        for name, item in overrides().items():
            np.testing.assert_allclose(
                evaluated(item), expected(sea, frame), atol=TOLERANCE, err_msg=f"{name}, frame {frame}"
            )


def test_baked_overrides_keep_their_bakes(asset, shot, expected, evaluated, make_parameters, tmp_path):
    override_all(asset)
    assert len(overrides()) == 2 * len(METHODS)
    bake_all()
    assert len(list((shot.parent / "cache").glob("*/v*"))) == 4
    open_again(shot)
    assert {item.ocean_tweak.source for item in overrides().values()} == {"SEQUENCE"}
    check(expected, evaluated, make_parameters())
    names, wanted = list(overrides()), expected(make_parameters(), 3)[..., 2].ravel()
    seen, _ = look(shot, names, [3], tmp_path)
    for name in (f"{name} {kind} 3" for name in names for kind in ("viewport", "render")):
        np.testing.assert_allclose(seen[name][:, 2], wanted, atol=TOLERANCE, err_msg=name)


def test_an_override_that_is_live_again_or_local_moves(shot, expected, evaluated, make_parameters):
    bake_all()
    open_again(shot)
    for item in overrides().values():
        item.ocean_tweak.source = "LIVE"
    open_again(shot)
    check(expected, evaluated, make_parameters(), (2, 9))
    bake_all()
    names = list(overrides())
    for item in overrides().values():
        item.make_local()
    for frame in (1, 3):
        bpy.context.scene.frame_set(frame)
        for name in names:
            item = bpy.data.objects[name]
            assert item.override_library is None
            item.ocean_tweak.out_of_range = "HOLD"  # all modifiers are made anew
            wanted = expected(make_parameters(), frame)
            np.testing.assert_allclose(evaluated(item), wanted, atol=TOLERANCE, err_msg=name)


def test_a_changed_asset_leaves_the_bake(asset, shot, expected, evaluated, make_parameters, ocean_object):
    """The shot is brought into step with an asset that has more in it, and whose oceans changed."""
    bake_all()
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=str(asset))
    water, scene = bpy.data.collections["Water"], bpy.context.scene
    for name in METHODS:
        item = bpy.data.objects[name]
        item.ocean_tweak.choppiness = 0.2
        item.modifiers.new("Subdivide", "SUBSURF").levels = 0
    buoy = bpy.data.objects.new("Buoy", None)
    water.objects.link(buoy)
    buoy.parent = bpy.data.objects["NODES"]
    scene.frame_set(2)
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=str(shot))
    assert any(item.name.startswith("Buoy") and item.override_library for item in bpy.data.objects)
    check(expected, evaluated, make_parameters())


def test_a_linked_bake_is_shown_with_its_library_wherever_both_go(
    asset, expected, evaluated, make_parameters, tmp_path
):
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 2
    for method in METHODS:
        bpy.context.view_layer.objects.active = bpy.data.objects[method]
        assert bpy.ops.ocean.bake() == {"FINISHED"}
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.read_homefile(use_empty=True)
    (tmp_path / "shots").mkdir()
    file = tmp_path / "shots" / "shot.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    with bpy.data.libraries.load(str(asset), link=True, relative=True) as (_, wanted):
        wanted.collections = ["Water"]
    bpy.context.scene.collection.children.link(wanted.collections[0])
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.read_homefile(use_empty=True)
    farm = tmp_path / "farm"
    farm.mkdir()
    for name in ("asset.blend", "cache", "shots"):
        (tmp_path / name).rename(farm / name)
    bpy.ops.wm.open_mainfile(filepath=str(farm / "shots" / "shot.blend"))
    bpy.context.scene.frame_set(2)
    for method in METHODS:
        item = bpy.data.objects[method]
        assert item.library is not None
        assert item.ocean_tweak.missing_file == ""
        np.testing.assert_allclose(evaluated(item), expected(make_parameters(), 2), atol=TOLERANCE)


def test_a_horizon_that_both_files_bake_reads_the_shots_points(
    empty_scene, ocean_object, core, make_parameters, extension, evaluated, tmp_path, monkeypatch
):
    """The shot looks at another sea than its asset does."""
    monkeypatch.delenv("OCEAN_TWEAK_CACHE", raising=False)
    cut = 20.0
    patches = (
        core.Patch(domain_size=150.0, shortest_wavelength=cut, resolution=32),
        core.Patch(domain_size=40.0, longest_wavelength=cut, shortest_wavelength=5.0, resolution=32),
    )
    water = bpy.data.collections.new("Water")
    empty_scene.collection.children.link(water)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location = (71.3, 52.9, 2.0)
    water.objects.link(camera)
    empty_scene.camera, empty_scene.frame_end = camera, 2
    item = ocean_object.add(
        empty_scene, make_parameters(patches=patches, merged_resolution=32), collection=water
    )
    bpy.context.view_layer.objects.active = item
    surface = extension("scene.camera_surface").add_camera_surface(item, empty_scene, budget=2000)
    inputs = {"Finest Spacing": 0.2, "To Horizon": False, "Reach": 6.0, "Fade": False}
    extension("nodes.modifier_inputs").set_inputs(surface.modifiers[0], inputs)
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    asset, shot = tmp_path / "asset.blend", tmp_path / "shots" / "shot.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(asset))
    bpy.ops.wm.read_homefile(use_empty=True)
    shot.parent.mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(shot))
    scene = bpy.context.scene
    scene.frame_end = 2
    override_all(asset)
    (name,) = (name for name in overrides() if name.endswith("Camera Surface"))
    item, scene.camera = overrides()["Ocean"], bpy.data.objects["Camera"]
    item.ocean_tweak.source, item.ocean_tweak.seed = "LIVE", 8
    scene.frame_set(2)
    live = positions(overrides()[name])
    bpy.context.view_layer.objects.active = item
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    open_again(shot)
    bpy.context.scene.frame_set(2)
    np.testing.assert_allclose(positions(overrides()[name]), live, atol=TOLERANCE)
    seen, _ = look(shot, [name], [2], tmp_path)
    for kind in ("viewport", "render"):
        np.testing.assert_allclose(seen[f"{name} {kind} 2"], live, atol=TOLERANCE)


def positions(item):
    return numbers(evaluated_mesh(item), "position", 3)
