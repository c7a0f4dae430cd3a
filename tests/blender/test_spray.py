# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray of an ocean: points at the particles of the core, made anew with each frame, gone with the ocean."""

import dataclasses
import importlib
import threading
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

import ocean_tweak.core
from ocean_tweak.core import Ocean, OceanParameters, Spray, WaveLayer
from ocean_tweak.core.sea.foam_levels import FoamLevels
from ocean_tweak.core.sea.patch_plan import Wish, planned
from ocean_tweak.core.sea.spray import CameraSpray, TileSpray
from ocean_tweak.core.spray import drops

SEA = OceanParameters(
    resolution=64, domain_size=100.0, seed=2, layers=(WaveLayer(wind_speed=22.0, fetch=300e3),), spray=Spray()
)


@pytest.fixture
def ocean(extension, empty_scene):
    return extension("scene.ocean_object").add(empty_scene, SEA)


def points(item):
    """What nodes make of the spray of an ocean: its attributes by name, (points, …)."""
    graph = bpy.context.evaluated_depsgraph_get()
    geometry = item.evaluated_get(graph).evaluated_geometry()
    cloud, found = geometry.pointcloud, {}
    for name, size in (("position", 3), ("velocity", 3), ("radius", 1), ("kind", 1), ("left", 1)):
        values = np.empty(len(cloud.points) * size, np.float32)
        cloud.attributes[name].data.foreach_get("vector" if size == 3 else "value", values)
        found[name] = values.reshape(-1, size) if size == 3 else values
    return found


def spray_of(ocean):
    return next((child for child in ocean.children if child.name.endswith("Spray")), None)


def made(time):
    """The core's particles."""
    return TileSpray(Ocean(SEA)).at(time, Spray())


def test_points_are_the_particles_of_the_frame(ocean, empty_scene):
    empty_scene.frame_set(13)
    found, expected = points(spray_of(ocean)), made(0.5)
    assert len(expected.age) > 100
    np.testing.assert_allclose(found["position"], expected.position, atol=1e-4)
    np.testing.assert_allclose(found["velocity"], expected.velocity, atol=1e-4)
    np.testing.assert_allclose(found["radius"], expected.radius, rtol=1e-5)
    np.testing.assert_allclose(found["left"], 1.0 - expected.age / 4.0, atol=1e-5)


def test_between_frames_points_go_on_by_their_velocity(ocean, empty_scene):
    empty_scene.frame_set(13)
    before = points(spray_of(ocean))
    empty_scene.frame_set(13, subframe=0.25)
    after = points(spray_of(ocean))
    np.testing.assert_allclose(
        after["position"], before["position"] + before["velocity"] * 0.25 / 24.0, atol=1e-4
    )
    empty_scene.frame_set(12, subframe=0.75)  # nearer to 13 than to 12
    assert len(points(spray_of(ocean))["radius"]) == len(before["radius"])


def test_what_is_close_to_the_lens_is_no_ball_that_covers_the_picture(ocean, empty_scene):
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    empty_scene.collection.objects.link(camera)
    empty_scene.frame_set(13)
    expected = made(0.5)
    is_mist = expected.kind == drops.MIST
    assert np.count_nonzero(is_mist) > 3
    for kind in (drops.SPUME, drops.MIST):
        nearest = expected.position[expected.kind == kind][5]
        ocean.location = (30.0, -20.0, 5.0)  # the nodes count in the space of the spray
        camera.location = nearest + np.array([30.0, -20.0, 5.1])
        empty_scene.camera = camera
        bpy.context.view_layer.update()
        away = np.linalg.norm(expected.position - nearest - (0.0, 0.0, 0.1), axis=1)
        seen = points(spray_of(ocean))["radius"]
        largest = np.where(is_mist, 0.25, 0.003) * away
        np.testing.assert_allclose(seen, np.minimum(expected.radius, largest), rtol=1e-2, atol=1e-5)
        assert 0.0 < np.mean(seen < 0.99 * expected.radius) < 0.5
    empty_scene.camera = None
    bpy.context.view_layer.update()
    np.testing.assert_allclose(points(spray_of(ocean))["radius"], expected.radius, rtol=1e-5)


def test_a_window_shows_an_eighth_as_much_larger(extension, ocean, empty_scene, monkeypatch):
    module = extension("scene.spray")
    plan = extension("scene.plan").plan_for(ocean, ocean.ocean_tweak, empty_scene)
    monkeypatch.setattr(module.bpy, "app", SimpleNamespace(background=False))
    shown = module.wanted(ocean, plan, empty_scene).spray
    assert shown.amount == 0.125
    assert shown.size == pytest.approx(0.002 * 8**0.5)
    assert module.wanted(ocean, plan, empty_scene, is_rendered=True).spray.amount == 1.0


def test_a_switch_and_numbers_that_change_no_wave(ocean, empty_scene):
    empty_scene.frame_set(13)
    few = len(points(spray_of(ocean))["radius"])
    ocean.ocean_tweak.spray.amount = 2.0
    assert 1.7 * few < len(points(spray_of(ocean))["radius"]) < 2.3 * few
    ocean.ocean_tweak.use_spray = False
    assert spray_of(ocean) is None
    assert ocean.ocean_tweak.to_parameters(empty_scene).spray is None


@pytest.fixture
def around(extension, empty_scene):
    """An ocean of patches with a surface around a camera at x = 100 m, y = 50 m."""
    sea = planned(OceanParameters(seed=2, layers=SEA.layers), Wish(finest=4.0, area=200.0))
    shown = sea.replace(spray=Spray(life=1.0, amount=0.2), patches=sea.patches).on_one_grid(64)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    empty_scene.collection.objects.link(camera)
    empty_scene.camera = camera
    camera.location = (100.0, 50.0, 4.0)
    bpy.context.view_layer.update()
    ocean = extension("scene.ocean_object").add(empty_scene, shown)
    extension("scene.camera_surface").add_camera_surface(ocean, empty_scene)
    empty_scene.frame_set(2)
    return ocean, sea, shown.spray


def test_a_sea_of_patches_has_it_around_the_camera(around):
    ocean, sea, spray = around
    expected = CameraSpray(FoamLevels(sea)).at(1 / 24.0, spray, (100.0, 50.0))
    assert len(expected.age) > 1000
    np.testing.assert_allclose(points(spray_of(ocean))["position"], expected.position, atol=1e-3)


def ship_of(core):
    """A ship of 8 m/s, with its bow under the camera, of the extension's core or of this test's."""
    path = (core.PathSample(0.0, 90.0, 50.0), core.PathSample(10.0, 170.0, 50.0))
    return core.WakeLayer(path=path, length=30.0, beam=8.0, area_size=256.0, area_resolution=128, decay=0.1)


def test_bows_around_the_camera_have_it(around, core, empty_scene):
    """What they throw is there besides."""
    ocean, sea, spray = around
    shown = ocean.ocean_tweak.to_parameters(empty_scene)
    shown = shown.replace(layers=(*shown.layers, ship_of(core)), patches=shown.patches)
    ocean.ocean_tweak.from_parameters(shown, empty_scene)
    empty_scene.frame_set(3)
    with_ship = sea.replace(layers=(*sea.layers, ship_of(ocean_tweak.core)), patches=sea.patches)
    expected = CameraSpray(FoamLevels(with_ship)).at(2 / 24.0, spray, (100.0, 50.0))
    without = CameraSpray(FoamLevels(sea)).at(2 / 24.0, spray, (100.0, 50.0))
    assert len(expected.age) > len(without.age) + 100
    np.testing.assert_allclose(points(spray_of(ocean))["position"], expected.position, atol=1e-3)


def test_a_bow_on_an_ocean_of_one_patch_has_it_in_any_wind(extension, core, empty_scene):
    """Around the camera, and not on the tile, which knows no ship; until the ship is muted."""
    waves = WaveLayer(wind_speed=6.0, fetch=5e3)
    sea = OceanParameters(resolution=64, domain_size=60.0, seed=2, layers=(waves,), spray=Spray(life=0.5))
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    empty_scene.collection.objects.link(camera)
    empty_scene.camera = camera
    camera.location = (100.0, 50.0, 4.0)
    bpy.context.view_layer.update()
    ocean = extension("scene.ocean_object").add(empty_scene, sea)
    extension("scene.camera_surface").add_camera_surface(ocean, empty_scene)
    assert spray_of(ocean) is None
    shown = ocean.ocean_tweak.to_parameters(empty_scene)
    ocean.ocean_tweak.from_parameters(shown.replace(layers=(*shown.layers, ship_of(core))), empty_scene)
    empty_scene.frame_set(3)
    with_ship = sea.replace(layers=(waves, ship_of(ocean_tweak.core)))
    expected = CameraSpray(FoamLevels(with_ship)).at(2 / 24.0, sea.spray, (100.0, 50.0))
    assert len(expected.age) > 100
    np.testing.assert_allclose(points(spray_of(ocean))["position"], expected.position, atol=1e-3)
    ocean.ocean_tweak.layers[1].wake.muted = True
    empty_scene.frame_set(4)
    assert spray_of(ocean) is None


def test_the_storm_has_it_by_itself(extension, empty_scene, monkeypatch):
    moods, spray = extension("scene.moods"), extension("core").Spray
    original, few = moods.MOODS["STORM"], spray(amount=0.1, life=0.5)
    assert original.waves().spray == spray()  # as it is at sea
    assert all(mood.waves().spray is None for mood in moods.MOODS.values() if mood != original)
    storm = dataclasses.replace(original, waves=lambda: original.waves().replace(spray=few), vertices=20_000)
    monkeypatch.setitem(moods.MOODS, "STORM", storm)
    assert bpy.ops.ocean.add_scene(mood="STORM", engine="CYCLES", use_buoy=False) == {"FINISHED"}
    ocean = next(item for item in empty_scene.objects if item.ocean_tweak.is_ocean)
    assert ocean.ocean_tweak.error == ""
    assert ocean.ocean_tweak.to_parameters(empty_scene).spray == few
    assert empty_scene.cycles.transparent_max_bounces >= 64
    at, camera = points(spray_of(ocean))["position"], empty_scene.camera.location - ocean.location
    away = np.abs(at[:, :2] - camera[:2]).max(axis=1)
    assert len(away) > 1000
    assert 1200.0 < away.max() < 1500.0  # around it, and not on the tile of 2.8 km, which begins elsewhere


def test_what_a_camera_far_away_sees_is_not_quickly_made(extension, around, empty_scene):
    ocean, _, _ = around
    module = extension("scene.spray")
    for x, is_near in ((99.5, True), (160.0, False)):
        empty_scene.camera.location.x = x
        bpy.context.view_layer.update()
        plan = extension("scene.plan").plan_for(ocean, ocean.ocean_tweak, empty_scene)
        assert module.refresh(ocean, plan, empty_scene, patient=False) is is_near


def test_a_place_next_to_zero_is_no_option(extension, around, empty_scene):
    ocean, _, _ = around
    empty_scene.camera.location = (-1.25e-7, -2e-5, 4.0)
    bpy.context.view_layer.update()
    words = extension("scene.spray").spray_arguments(ocean, empty_scene)
    bake = importlib.import_module("ocean_tweak.cli.arguments").make_parser(in_blender=False)
    read = bake.parse_args(["bake", "--frames", "1", *words])
    assert read.spray
    assert read.spray_place == pytest.approx((-1.25e-7, -2e-5), rel=1e-3)


def test_a_sea_without_spray_says_why(ocean, empty_scene, caplog):
    ocean.ocean_tweak.layers[0].wind_speed = 6.0
    assert spray_of(ocean) is None
    assert "its wind of 6 m/s tears nothing off" in caplog.text
    assert not ocean.ocean_tweak.error


def test_two_oceans_have_a_spray_each_and_one_goes_with_its_ocean(extension, ocean, empty_scene):
    other = extension("scene.ocean_object").add(empty_scene, SEA)
    assert spray_of(ocean) is not spray_of(other)
    name = spray_of(ocean).name
    bpy.data.objects.remove(ocean)
    bpy.context.view_layer.update()
    extension("scene.spray").remove_left()
    assert name not in bpy.data.objects
    assert spray_of(other) is not None


def test_spray_of_a_deleted_ocean_goes_with_it(ocean, empty_scene):
    assert spray_of(ocean).name in empty_scene.objects
    name = spray_of(ocean).name
    for item in empty_scene.objects:
        item.select_set(item == ocean)
    bpy.ops.object.delete()
    bpy.context.view_layer.update()
    assert name not in empty_scene.objects


def test_mist_that_cycles_would_darken_is_told(extension, ocean, empty_scene):
    told = extension("scene.spray").too_few_bounces
    empty_scene.render.engine = "CYCLES"
    assert "Cycles has 8 transparent bounces, set 64" in told(ocean, empty_scene)
    empty_scene.cycles.transparent_max_bounces = 64
    assert told(ocean, empty_scene) is None
    ocean.ocean_tweak.use_spray = False
    empty_scene.cycles.transparent_max_bounces = 8
    assert told(ocean, empty_scene) is None


def test_a_file_is_without_points_but_with_their_material(extension, ocean, empty_scene, tmp_path):
    look = spray_of(ocean).modifiers[0]
    assert look.node_group.name.startswith("Ocean Tweak Spray")
    bpy.data.materials["Ocean Tweak Spray"].name = "Own Look"
    path = tmp_path / "spray.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(str(path)) as (stored, _):
        assert not [name for name in stored.objects if "Spray" in name]
        assert "Own Look" in stored.materials
    bpy.ops.wm.open_mainfile(filepath=str(path))
    again = next(item for item in bpy.data.objects if item.ocean_tweak.is_ocean)
    assert spray_of(again) is not None
    assert "Ocean Tweak Spray" not in bpy.data.materials


def test_more_than_the_memory_holds_is_told(extension, ocean, monkeypatch):
    monkeypatch.setattr(extension("core.sea.spray"), "usable_memory", lambda: 200_000)
    ocean.ocean_tweak.spray.amount = 50.0
    assert "would do" in ocean.ocean_tweak.error


@pytest.fixture
def baked(extension, ocean, empty_scene, tmp_path):
    """The ocean with frames 12 to 14 baked, of which 13 has no spray."""
    bake = importlib.import_module("ocean_tweak.cli").main
    sea = tmp_path / "sea.json"
    sea.write_text(ocean.ocean_tweak.to_parameters(empty_scene).to_json(), encoding="utf-8")
    assert bake(["bake", "--params", str(sea), "--frames", "12-14", "--out", str(tmp_path), "--spray"]) == 0
    (displacement,) = tmp_path.glob("*/*/*_disp.0012.exr")
    (displacement.parent / "spray" / "sea_spray.0013.ply").unlink()
    object_module = extension("scene.ocean_object")
    sequence = extension("scene.image_sequence").find_sequence(displacement)
    object_module.use_sequence(ocean, empty_scene, sequence)
    return ocean


def test_baked_points_are_those_of_the_files(baked, empty_scene, caplog):
    item = spray_of(baked)
    assert not item.is_runtime_data
    assert len(item.data.vertices) == 0
    for frame in (12, 14):
        empty_scene.frame_set(frame)
        expected = TileSpray(Ocean(SEA)).at((frame - 1) / 24.0, Spray())
        shown = expected.id % 2**24 <= 2**24 / 8  # in a window
        found = points(item)
        np.testing.assert_allclose(found["position"], expected.position[shown], atol=1e-4)
        np.testing.assert_allclose(found["velocity"], expected.velocity[shown], atol=1e-4)
        np.testing.assert_allclose(found["radius"], expected.radius[shown] * 8**0.5, rtol=1e-5)
    assert "spray" not in caplog.text


def test_a_frame_without_a_file_is_told_and_shows_the_one_before(baked, empty_scene, caplog):
    empty_scene.frame_set(12)
    before = points(spray_of(baked))["position"]
    empty_scene.frame_set(13)
    assert "spray.0013.ply is missing, and the spray of frame 12 is shown" in caplog.text
    np.testing.assert_array_equal(points(spray_of(baked))["position"], before)
    assert not baked.ocean_tweak.error


def test_baked_spray_is_kept_in_the_file_and_needs_no_extension(extension, baked, empty_scene, tmp_path):
    path = tmp_path / "shot.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    with extension("scene.handlers").asleep():
        bpy.ops.wm.open_mainfile(filepath=str(path))
        item = next(item for item in bpy.data.objects if item.name.endswith("Spray"))
        bpy.context.scene.frame_set(14)
        assert len(points(item)["radius"]) > 100


@pytest.fixture
def asked(extension, ocean, empty_scene):
    """What a refresh is given at frame 13 of a sea that nobody has made yet."""
    with extension("scene.handlers").asleep():
        empty_scene.frame_set(13)
    extension("core.numerics.memo").MEMO.drop("spray")
    extension("scene.spray").forget_all()
    plan = extension("scene.plan").plan_for(ocean, ocean.ocean_tweak, empty_scene)
    return ocean, plan, empty_scene


def test_a_window_does_not_wait_while_a_thread_looks_back(extension, asked, monkeypatch):
    module, tile = extension("scene.spray"), extension("core.sea.spray").TileSpray
    whole, begun, may_end = tile.at, threading.Event(), threading.Event()

    def slow(self, *arguments):
        begun.set()
        may_end.wait(5.0)
        return whole(self, *arguments)

    monkeypatch.setattr(tile, "at", slow)
    assert not module.refresh(*asked, patient=False)
    worker = threading.Thread(target=module.wanted(*asked).make)
    worker.start()
    assert begun.wait(5.0)
    assert not module.refresh(*asked, patient=False)
    may_end.set()
    worker.join()
    assert module.refresh(*asked, patient=False)
    assert len(points(spray_of(asked[0]))["radius"]) == len(made(0.5).age)


def test_what_failed_is_not_near(extension, asked, monkeypatch):
    module = extension("scene.spray")
    monkeypatch.setattr(extension("core.sea.spray"), "usable_memory", lambda: 1_000)
    with pytest.raises(extension("core.sea.spray").SprayError):
        module.wanted(*asked).make()
    monkeypatch.undo()
    assert not module.refresh(*asked, patient=False)


def test_a_first_look_at_a_frame_between_shows_the_nearest_one(extension, asked, empty_scene):
    ocean, _, _ = asked
    empty_scene.frame_set(12, subframe=0.75)
    found, expected = points(spray_of(ocean)), made(0.5)
    moved = expected.position - expected.velocity * 0.25 / 24.0
    np.testing.assert_allclose(found["position"], moved, atol=1e-4)
    empty_scene.frame_set(20, subframe=0.25)  # far away, nothing of the frame before is left
    expected = made(19 / 24.0)
    moved = expected.position + expected.velocity * 0.25 / 24.0
    np.testing.assert_allclose(points(spray_of(ocean))["position"], moved, atol=1e-4)


def test_a_stretched_frame_shows_its_own_particles(ocean, empty_scene):
    empty_scene.render.frame_map_old, empty_scene.render.frame_map_new = 100, 200
    empty_scene.frame_set(26)
    expected = made(12 / 24.0)
    np.testing.assert_allclose(points(spray_of(ocean))["position"], expected.position, atol=1e-4)
    empty_scene.frame_set(27, subframe=0.25)
    expected = made(12.5 / 24.0)
    moved = expected.position + expected.velocity * 0.5 * 0.25 / 24.0
    np.testing.assert_allclose(points(spray_of(ocean))["position"], moved, atol=1e-4)


def test_files_are_looked_at_when_they_change_and_not_a_frame(extension, baked, empty_scene, monkeypatch):
    module, looks = extension("scene.spray"), []
    whole = module.told_by_ply
    monkeypatch.setattr(module, "told_by_ply", lambda *given: looks.append(given) or whole(*given))
    for frame in (12, 14, 12):
        empty_scene.frame_set(frame)
    assert looks == []
    (folder,) = extension("scene.patch_points").files_of(baked.ocean_tweak)[2].glob("spray")
    for path in folder.iterdir():
        path.unlink()
    empty_scene.frame_set(14)
    assert module.is_live(baked)
    assert len(points(spray_of(baked))["radius"]) > 100


def test_frames_of_spray_are_counted_by_themselves(extension, ocean, empty_scene, tmp_path, monkeypatch):
    module, counts = extension("scene.bake_process"), []
    whole = module.BakeProcess.take

    def take(self, said):
        whole(self, said)
        counts.append((self.phase, self.done, self.left))

    monkeypatch.setattr(module.BakeProcess, "take", take)
    ocean.ocean_tweak.cache_folder = str(tmp_path)
    shot = extension("scene.shots").shot_of(ocean, empty_scene, (12, 13))
    bake = module.start(ocean, shot, (12, 13))
    bake.wait()
    module.forget(bake)
    assert bake.is_complete, bake.error
    assert len(list(bake.folder.glob("spray/*.ply"))) == 2
    extension("scene.bake_versions").delete(ocean)  # with its spray
    assert not bake.folder.exists()
    each = [(0, 2), (1, 2), (2, 2)]
    assert list(dict.fromkeys(counts)) == [("", *count) for count in each] + [
        ("spray", *count) for count in each
    ]


def test_a_bake_without_the_spray_that_is_on_needs_the_extension(extension, baked, empty_scene):
    needs_of, spray = extension("scene.portability").needs_of, extension("scene.spray")
    assert needs_of(baked) == ()
    (folder,) = extension("scene.patch_points").files_of(baked.ocean_tweak)[2].glob("spray")
    for path in folder.glob("*.ply"):
        path.unlink()
    empty_scene.frame_set(14)
    assert spray.is_live(baked)
    (need,) = needs_of(baked)
    assert need.text == "Ocean has spray, which its bake has not: bake it again"
    baked.ocean_tweak.use_spray = False
    assert needs_of(baked) == ()


@pytest.mark.parametrize(("name", "value"), [("amount", 2.0), ("life", 1.0)])
def test_spray_of_an_older_bake_is_told_and_shown(baked, empty_scene, caplog, name, value):
    empty_scene.frame_set(14)
    before = points(spray_of(baked))
    setattr(baked.ocean_tweak.spray, name, value)
    was = getattr(Spray(), name)
    assert f"its spray was baked with a {name} of {was:g}, and the settings have {value:g}" in caplog.text
    for key, values in points(spray_of(baked)).items():
        np.testing.assert_array_equal(values, before[key])
    assert not baked.ocean_tweak.error


def test_spray_of_another_version_is_told_and_shown(extension, baked, empty_scene, monkeypatch, caplog):
    monkeypatch.setattr(extension("core.data.formats"), "SPRAY", 99)
    extension("scene.spray")._baked_in.cache_clear()
    empty_scene.frame_set(14)
    assert "its spray was baked by another version" in caplog.text
    assert len(points(spray_of(baked))["radius"]) > 10


def test_the_farm_s_render_reads_spray_where_the_bake_is_now(extension, baked, tmp_path):
    script, modifier = extension("export.farm.render_baked"), spray_of(baked).modifiers[0]
    folder = tmp_path / "farm"
    (tmp_path / "farm/spray").mkdir(parents=True)
    here = SimpleNamespace(name="sea", folder=folder)
    with pytest.raises(script.RenderError, match=r"sea_spray\.0012\.ply is missing: Ocean Spray reads spray"):
        script.show_points(modifier, here, [12])
    (folder / "spray/sea_spray.0012.ply").touch()
    assert script.show_points(modifier, here, [12])
    files = extension("nodes.modifier_inputs").get_input(modifier, "Files")
    assert files == str(folder / "spray/sea_spray.")
    assert not script.show_points(modifier, SimpleNamespace(name="other", folder=folder), [12])


def test_usd_of_the_panel_has_it(extension, ocean, empty_scene, monkeypatch):
    module, told = extension("scene.usd"), []
    monkeypatch.setattr(module.CommandProcess, "__init__", lambda _, name, words, *__: told.append(words))
    shot = extension("scene.shots").shot_of(ocean, empty_scene, (1,))
    ocean.ocean_tweak.spray.amount = 0.5
    for bake in (None, "folder"):
        monkeypatch.setattr(module, "used_bake", lambda _, given=bake: given)
        for is_on in (True, False):
            ocean.ocean_tweak.use_spray = is_on
            module.UsdExport(ocean, shot, (1,))
            words = told.pop()
            assert ("--spray" in words) is is_on
            assert ("--set=spray.amount=0.5" in words) is (is_on and bake is not None)


@pytest.mark.parametrize("subframe", [0.25, -0.4])
def test_baked_points_go_on_by_their_velocity_between_frames(baked, empty_scene, subframe):
    """As both engines look at them for motion blur: EEVEE at other frames, where it pairs points by order."""
    empty_scene.frame_set(14)
    whole = points(spray_of(baked))
    empty_scene.frame_set(14 if subframe > 0.0 else 13, subframe=subframe % 1.0)
    between = points(spray_of(baked))
    moved = whole["position"] + whole["velocity"] * subframe / 24.0
    assert np.linalg.norm(moved - whole["position"], axis=1).max() > 0.05
    np.testing.assert_allclose(between["position"], moved, atol=1e-4)
    np.testing.assert_array_equal(between["velocity"], whole["velocity"])


def test_each_particle_is_in_the_repeat_that_is_nearest_to_the_camera(extension, ocean, empty_scene):
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    empty_scene.collection.objects.link(camera)
    empty_scene.camera = camera
    ocean.ocean_tweak.repeats_x, ocean.ocean_tweak.repeats_y = 3, 1
    camera.location = (240.0, -30.0, 3.0)
    bpy.context.view_layer.update()
    empty_scene.frame_set(13)
    own = made(0.5).position[:, :2]
    found = points(spray_of(ocean))["position"][:, :2]
    places = own[:, np.newaxis] + 100.0 * np.array([(0, 0), (1, 0), (2, 0)])
    away = np.linalg.norm(places - (240.0, -30.0), axis=-1)
    np.testing.assert_allclose(found, places[np.arange(len(own)), away.argmin(axis=1)], atol=1e-3)
    assert len(np.unique(away.argmin(axis=1))) == 2

    extension("scene.surroundings").add_horizon(ocean, SEA, empty_scene, empty_scene.collection, 3)
    empty_scene.frame_set(14)
    empty_scene.frame_set(13)
    found = points(spray_of(ocean))["position"][:, :2]
    shifts = (found - own) / 100.0
    np.testing.assert_allclose(shifts, np.rint(shifts), atol=1e-4)
    assert np.abs(found - (240.0, -30.0)).max() <= 50.001  # also where no repeat of its own is
    assert shifts[:, 1].min() < -0.5
