# SPDX-License-Identifier: GPL-3.0-or-later
"""An ocean keeps its middle in the world: when its domain is dragged, by Match, presets and patches."""

import math

import bpy
import numpy as np
import pytest
from mathutils import Matrix, Vector


@pytest.fixture
def child(empty_scene):
    """An empty that somebody parents to the ocean."""
    item = bpy.data.objects.new("Pier", None)
    empty_scene.collection.objects.link(item)
    return item


def in_world(item):
    """Where the middle of an ocean is."""
    bpy.context.view_layer.update()
    settings = item.ocean_tweak
    half = 0.5 * settings.domain_size
    return item.matrix_world @ Vector((half * settings.repeats_x, half * settings.repeats_y, 0.0))


def near(place):
    return pytest.approx(tuple(place), abs=2e-3)


def drag(item):
    item.ocean_tweak.domain_size = 410.0


def match(_item):
    bpy.ops.ocean.match_sea_state(by="WAVES", height=3.0, period=9.0)


def preset(_item):
    bpy.ops.ocean.apply_preset(key="beaufort_03")


def plan(item):
    item.ocean_tweak.plan_finest, item.ocean_tweak.plan_area = 2.0, 600.0
    bpy.ops.ocean.plan_patches()


@pytest.mark.parametrize("resize", [drag, match, preset, plan])
def test_the_middle_stays_whatever_the_object_hangs_on(ocean, empty_scene, resize):
    """Turned, scaled and moved itself, under a parent that is all that too."""
    parent = bpy.data.objects.new("Parent", None)
    empty_scene.collection.objects.link(parent)
    parent.matrix_world = (
        Matrix.Translation((5.0, -7.0, 2.0)) @ Matrix.Rotation(0.7, 4, "Z") @ Matrix.Scale(1.5, 4)
    )
    bpy.context.view_layer.update()
    ocean.parent = parent
    ocean.matrix_parent_inverse = Matrix.Translation((3.0, 1.0, 0.0))
    ocean.location, ocean.rotation_euler, ocean.scale = (40.0, 50.0, 6.0), (0.1, 0.0, -1.1), (2.0, 0.5, 1.0)
    ocean.delta_location, ocean.delta_rotation_euler = (1.0, 2.0, 3.0), (0.0, 0.0, 0.3)
    before, size = in_world(ocean), ocean.ocean_tweak.domain_size
    resize(ocean)
    assert ocean.ocean_tweak.error == ""
    assert abs(ocean.ocean_tweak.domain_size - size) > 20.0
    assert tuple(in_world(ocean)) == near(before)
    assert not ocean.ocean_tweak.stays_behind


def test_the_middle_of_repeats_stays(ocean):
    ocean.ocean_tweak.repeats_x, ocean.ocean_tweak.repeats_y = 3, 2
    before = in_world(ocean)
    ocean.ocean_tweak.domain_size = 100.0
    assert tuple(in_world(ocean)) == near(before)
    assert tuple(ocean.location) == near((75.0, 50.0, 0.0))


def test_a_size_that_comes_back_brings_the_place_back(ocean):
    """Sizes that are no sea on the way do not count."""
    for size in (90.0, 0.0, 333.0, 150.0):
        ocean.ocean_tweak.domain_size = size
    assert tuple(ocean.location) == near((0.0, 0.0, 0.0))


def test_a_file_made_before_goes_by_its_mesh(ocean):
    ocean.ocean_tweak.placed_size = 0.0
    before = in_world(ocean)
    ocean.ocean_tweak.domain_size = 300.0
    assert tuple(in_world(ocean)) == near(before)


def test_what_was_placed_stays_in_the_world(ocean, child):
    """Hero waves and places of masks count from the corner, which moves."""
    bpy.ops.ocean.layer_add(kind="HERO_WAVE")
    wave = ocean.ocean_tweak.layers[ocean.ocean_tweak.active_layer].hero_wave
    wave.x, wave.y, wave.wavelength, ocean.ocean_tweak.resolution = 70.0, 20.0, 60.0, 64
    mask = ocean.ocean_tweak.mask
    mask.source, mask.x, mask.y = "DISTANCE", 12.0, 34.0
    child.parent, child.location = ocean, (10.0, 10.0, 0.0)
    bpy.context.view_layer.update()
    before = [ocean.matrix_world @ Vector((each.x, each.y, 0.0)) for each in (wave, mask)]
    before.append(child.matrix_world.translation.copy())
    for change in (drag, match):
        change(ocean)
        bpy.context.view_layer.update()
        wave = ocean.ocean_tweak.layers[ocean.ocean_tweak.active_layer].hero_wave
        after = [ocean.matrix_world @ Vector((each.x, each.y, 0.0)) for each in (wave, mask)]
        after.append(child.matrix_world.translation)
        assert [tuple(place) for place in after] == [near(place) for place in before]


@pytest.mark.parametrize("resize", [drag, match, plan])
def test_lines_of_a_mask_without_an_object_stay_in_the_world(
    ocean, core, make_parameters, empty_scene, resize
):
    """A breakwater out of a file, of the sea and of a layer."""
    ends = [[[15.0, 20.0, 45.0, 20.0], [45.0, 20.0, 45.0, 40.0]]]
    mask = core.Mask(lines=core.Raster(np.array(ends), "lines"), inner_radius=4.0, outer_radius=14.0)
    sea = make_parameters(mask=mask)
    layer = core.WaveLayer(wind_speed=8.0, fetch=20e3, mask=mask)
    ocean.ocean_tweak.from_parameters(sea.replace(layers=(layer,)), empty_scene)

    def in_the_world():
        bpy.context.view_layer.update()
        settings = ocean.ocean_tweak.to_parameters(empty_scene)
        return [
            tuple(ocean.matrix_world @ Vector((x, y, 0.0)))
            for each in (settings.mask, settings.layers[0].mask)
            for x, y in each.lines.values.reshape(-1, 2)
        ]

    before, place = in_the_world(), ocean.location.copy()
    resize(ocean)
    assert ocean.ocean_tweak.error == ""
    assert (ocean.location - place).length > 10.0
    assert in_the_world() == [near(point) for point in before]


def test_the_horizon_goes_along(ocean, empty_scene, extension, make_parameters):
    horizon = extension("scene.surroundings").add_horizon(
        ocean, make_parameters(), empty_scene, empty_scene.collection, 1
    )
    ocean.ocean_tweak.domain_size = 300.0
    bpy.context.view_layer.update()
    assert horizon.matrix_world == ocean.matrix_world
    assert tuple(horizon.matrix_world.translation) == near((-75.0, -75.0, 0.0))


def key(item):
    item.keyframe_insert("location", frame=1)


def drive(item):
    item.driver_add("location", 1)


def lock(item):
    item.lock_location[0] = True


@pytest.mark.parametrize("hold", [key, drive, lock])
def test_a_location_that_is_held_is_left_alone_and_said_so(ocean, extension, hold):
    hold(ocean)
    ocean.ocean_tweak.domain_size = 300.0
    assert tuple(ocean.location) == (0.0, 0.0, 0.0)
    with bpy.context.temp_override(active_object=ocean):
        warnings = extension("ui.panels.sea")._object_warnings(bpy.context)
    assert any("keyed" in text for text in warnings)
    ocean.ocean_tweak.domain_size = 300.0  # as it is
    assert not ocean.ocean_tweak.stays_behind


@pytest.mark.parametrize("press", [match, preset, plan])
def test_a_press_that_cannot_move_it_reports(ocean, press, capfd):
    key(ocean)
    press(ocean)
    assert "Its location is keyed" in capfd.readouterr().out
    assert tuple(ocean.location) == (0.0, 0.0, 0.0)


def test_parameters_of_a_file_are_taken_as_they_are(ocean, make_parameters, core, empty_scene):
    """The numbers of a hero wave count from sample 0; the middle of the domain stays all the same."""
    sea = make_parameters(domain_size=250.0)
    sea = sea.replace(layers=(*sea.layers, core.HeroWave(x=20.0, y=30.0)))
    before = in_world(ocean)
    ocean.ocean_tweak.from_parameters(sea, empty_scene)
    assert ocean.ocean_tweak.to_parameters(empty_scene) == sea
    assert tuple(in_world(ocean)) == near(before)


def test_undo_takes_size_and_place_back_as_one_step(ocean):
    bpy.ops.ed.undo_push(message="before")
    match(ocean)
    bpy.ops.ed.undo_push(message="matched")
    moved = tuple(ocean.location)
    assert math.hypot(*moved) > 10.0
    bpy.ops.ed.undo()
    ocean = bpy.data.objects["Ocean"]
    assert (tuple(ocean.location), ocean.ocean_tweak.domain_size) == ((0.0, 0.0, 0.0), 150.0)
    bpy.ops.ed.redo()
    assert tuple(bpy.data.objects["Ocean"].location) == near(moved)
