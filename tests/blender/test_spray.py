# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray of an ocean: points at the particles of the core, made anew with each frame, gone with the ocean."""

import dataclasses
import importlib
import threading
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

import ocean_tweak.core.sea.spray_squares
from ocean_tweak.core import Foam, OceanParameters, Spray, WaveLayer
from ocean_tweak.core.sea.foam_levels import FoamLevels
from ocean_tweak.core.sea.patch_plan import Wish, planned
from ocean_tweak.core.sea.spray import CameraSpray
from ocean_tweak.core.spray import drops

from .spray_points import SEA, made, points, spray_of


@pytest.fixture
def ocean(extension, empty_scene):
    return extension("scene.ocean_object").add(empty_scene, SEA)


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
        found = points(spray_of(ocean))
        seen = found["radius"]
        part = (expected.id % 2**24) / 2**24
        largest = np.where(is_mist, 0.25, 0.00025 + 0.00065 * part**3) * away
        is_drawn = ~is_mist | (found["mist_density"] > 0.0)
        assert is_drawn.mean() > 0.99
        drawn = np.where(is_drawn, np.minimum(expected.radius, largest), 0.0)
        np.testing.assert_allclose(seen, drawn, rtol=1e-2, atol=1e-5)
        assert 0.0 < np.mean(seen < 0.99 * expected.radius) < 0.5
    empty_scene.camera = None
    bpy.context.view_layer.update()
    np.testing.assert_allclose(points(spray_of(ocean))["radius"], expected.radius, rtol=1e-5)


@pytest.fixture
def puffs(extension, empty_scene):
    """A function that shows mist at places in m, around a camera at the origin: its points."""
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    empty_scene.collection.objects.link(camera)
    empty_scene.camera = camera

    def shown(places, radius):
        random = np.random.default_rng(5)
        mesh = bpy.data.meshes.new("Mist")
        mesh.from_pydata(places.tolist(), [], [])
        given = {
            "radius": np.full(len(places), radius), "kind": np.full(len(places), drops.MIST),
            "age": random.uniform(0.0, 4.0, len(places)), "number": random.integers(2**24, size=len(places)),
        }  # fmt: skip
        for name, values in given.items():
            mesh.attributes.new(name, "FLOAT", "POINT").data.foreach_set("value", values.astype(np.float32))
        item = bpy.data.objects.new("Mist", mesh)
        empty_scene.collection.objects.link(item)
        group = extension("nodes.versioned").node_group(extension("nodes.spray").SPRAY)
        item.modifiers.new("Spray", "NODES").node_group = group
        return points(item)

    return shown


def test_light_in_dense_mist_is_gone_before_cycles_ends_it(puffs, extension):
    """Which it does in black after 64 puffs: of a hurricane's mist there are hundreds along the horizon."""
    radius, random = 2.0, np.random.default_rng(4)
    places = np.array([50.0, -300.0, -4.0]) + random.uniform(size=(130_000, 3)) * (1350.0, 600.0, 8.0)
    away = np.linalg.norm(places, axis=1)
    found = puffs(places, radius)
    drawn = found["radius"] > 0.0
    np.testing.assert_array_equal(drawn, found["mist_density"] > 0.0)
    look = extension("nodes.versioned").node_group(extension("nodes.spray_look").SPRAY_LOOK)
    new = next(each for each in look.interface.items_tree if each.name == "Mist").default_value

    def left(opacity, is_there):
        """Most of the light that any ray has left after 64 puffs, which are soft balls."""
        most = 0.0
        for angle in np.linspace(-0.2, 0.2, 41):
            along = places @ (np.cos(angle), np.sin(angle), 0.0)
            beside = (away**2 - along**2) / radius**2
            met = np.flatnonzero((beside < 1.0) & is_there)
            met = met[np.argsort(along[met])][:64]
            if len(met) == 64:
                most = max(most, np.prod(1.0 - np.clip(opacity[met] * (1.0 - beside[met]), 0.0, 1.0)))
        return most

    assert left(new * found["left"], found["left"] > 0.0) > 0.05
    assert left(new * found["mist_density"], drawn) < 0.02
    # and they cover as much as all would, but for those near the lens
    far = away > radius / 0.02
    covering = far / away**2
    assert np.dot(covering, found["mist_density"]) == pytest.approx(np.dot(covering, found["left"]), rel=0.03)


def test_mist_before_the_lens_is_of_few_puffs_that_take_as_much_light(puffs):
    """Of puffs that fill much of the picture a ray meets dozens, each of which takes next to nothing."""
    radius, random = 3.0, np.random.default_rng(6)
    away, angle = random.uniform(25.0, 100.0, 6000), random.uniform(-0.5, 0.5, 6000)
    height = random.uniform(-0.05, 0.05, 6000)
    found = puffs(away[:, np.newaxis] * np.stack([np.cos(angle), np.sin(angle), height], 1), radius)
    seen = radius / away
    alone = found["left"] * (0.02 / seen) ** 2  # as thin as each one would be without the others
    drawn = found["mist_density"] > 0.0
    assert np.mean(drawn) < 0.35
    for column in range(5):  # of the picture
        here = np.abs(angle + 0.4 - 0.2 * column) < 0.1
        taken = np.dot(seen[here] ** 2, found["mist_density"][here])
        assert taken == pytest.approx(np.dot(seen[here] ** 2, alone[here]), rel=0.15)
    # and none stands out: the larger it is seen, the fainter it is
    assert np.all(found["mist_density"] <= 1.01 * np.maximum(0.02 / seen, alone))


def test_a_puff_alone_is_as_dense_as_it_is_old_and_does_not_stand_out_at_the_lens(puffs):
    away, angles = np.array([500.0, 200.0, 100.0, 25.0, 5.0]), np.arange(5.0)
    found = puffs(away[:, np.newaxis] * np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], 1), 1.0)
    np.testing.assert_allclose(found["radius"], 1.0)
    expected = found["left"] * (1.0, 1.0, 1.0, 0.25, 0.01)  # of the square of the size, beyond 2 % of the way
    np.testing.assert_allclose(found["mist_density"], expected, rtol=1e-4)


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
def only_near(extension, monkeypatch):
    """Spray in the two finest squares alone, 44 m around the camera: all squares are the storm's."""
    for module in (extension("core.sea.spray_squares"), ocean_tweak.core.sea.spray_squares):
        monkeypatch.setattr(module, "STANDS_FOR", module.STANDS_FOR[:2])


@pytest.fixture
def around(extension, empty_scene, only_near):
    """An ocean of patches with a surface around a camera at x = 100 m, y = 50 m; its foam is soon gone."""
    sea = OceanParameters(seed=2, layers=SEA.layers, foam=Foam(half_life=0.3))
    sea = planned(sea, Wish(finest=4.0, area=200.0))
    shown = sea.replace(spray=Spray(life=0.6, amount=0.2), patches=sea.patches).on_one_grid(64)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    empty_scene.collection.objects.link(camera)
    empty_scene.camera = camera
    camera.location = (100.0, 50.0, 4.0)
    bpy.context.view_layer.update()
    ocean = extension("scene.ocean_object").add(empty_scene, shown.replace(spray=None))
    extension("scene.camera_surface").add_camera_surface(ocean, empty_scene)
    ocean.ocean_tweak.from_parameters(shown, empty_scene)
    empty_scene.frame_set(2)
    return ocean, sea, shown.spray


def test_a_sea_of_patches_has_it_around_the_camera(around):
    ocean, sea, spray = around
    expected = CameraSpray(FoamLevels(sea)).at(1 / 24.0, spray, (100.0, 50.0))
    assert len(expected.age) > 500
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


def test_a_bow_on_an_ocean_of_one_patch_has_it_in_any_wind(extension, core, empty_scene, only_near):
    """Around the camera, and not on the tile, which knows no ship; until the ship is muted."""
    waves = WaveLayer(wind_speed=6.0, fetch=5e3)
    sea = OceanParameters(
        resolution=64, domain_size=60.0, seed=2, layers=(waves,), spray=Spray(life=0.5),
        foam=Foam(half_life=0.3),
    )  # fmt: skip
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
    foam = extension("core").Foam(half_life=0.3)
    storm = dataclasses.replace(
        original, waves=lambda: original.waves().replace(spray=few, foam=foam), vertices=20_000
    )
    monkeypatch.setitem(moods.MOODS, "STORM", storm)
    assert bpy.ops.ocean.add_scene(mood="STORM", engine="CYCLES", use_buoy=False) == {"FINISHED"}
    ocean = next(item for item in empty_scene.objects if item.ocean_tweak.is_ocean)
    assert ocean.ocean_tweak.error == ""
    assert ocean.ocean_tweak.to_parameters(empty_scene).spray == few
    assert empty_scene.cycles.transparent_max_bounces >= 256
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
    words = extension("scene.baked_spray").spray_arguments(ocean, empty_scene)
    bake = importlib.import_module("ocean_tweak.cli.arguments").make_parser(in_blender=False)
    read = bake.parse_args(["bake", "--frames", "1", *words])
    assert read.spray
    assert read.spray_place == pytest.approx((-1.25e-7, -2e-5), rel=1e-3)


def test_spray_is_in_the_air_of_the_scene_s_sky(extension, empty_scene):
    assert bpy.ops.ocean.add_scene(mood="CALM", engine="CYCLES", use_buoy=False) == {"FINISHED"}
    ocean = next(item for item in empty_scene.objects if item.ocean_tweak.is_ocean)
    ocean.ocean_tweak.layers[0].wind_speed = 12.0
    ocean.ocean_tweak.use_spray = True
    (look,) = (
        node for node in bpy.data.materials["Ocean Tweak Spray"].node_tree.nodes if node.type == "GROUP"
    )
    water = extension("scene.water_material").water_node(ocean.active_material)
    for visibility in (None, 700.0):
        if visibility is not None:
            empty_scene.ocean_tweak_sky.visibility = visibility
        for name in ("Visibility", "Haze Color"):
            assert np.array_equal(look.inputs[name].default_value, water.inputs[name].default_value)
    assert look.inputs["Visibility"].default_value == 700.0


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
    assert "Cycles has 8 transparent bounces, set 256" in told(ocean, empty_scene)
    empty_scene.cycles.transparent_max_bounces = 256
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


def test_the_solid_view_sees_through_mist(ocean, empty_scene):
    slots = spray_of(ocean).material_slots
    assert [slot.material.name for slot in slots] == ["Ocean Tweak Spray"]
    assert 0.0 < slots[0].material.diffuse_color[3] < 0.3
    slots[0].material.diffuse_color = (0.2, 0.3, 0.4, 1.0)
    empty_scene.frame_set(3)
    assert [slot.material.diffuse_color[3] for slot in spray_of(ocean).material_slots] == [1.0]


def test_more_than_the_memory_holds_is_told(extension, ocean, monkeypatch):
    monkeypatch.setattr(extension("core.sea.spray_outlook"), "usable_memory", lambda: 200_000)
    ocean.ocean_tweak.spray.amount = 50.0
    assert "would do" in ocean.ocean_tweak.error


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
    monkeypatch.setattr(extension("core.sea.spray_outlook"), "usable_memory", lambda: 1_000)
    with pytest.raises(extension("core.sea.spray_outlook").SprayError):
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


def test_light_goes_through_mist_to_the_camera_alone(ocean):
    """Of a hurricane's mist every ray meets dozens of puffs: from each of them others would go through dozens
    more."""
    item = spray_of(ocean)
    assert item.visible_camera
    assert item.visible_transmission
    assert not any((item.visible_shadow, item.visible_diffuse, item.visible_glossy))
