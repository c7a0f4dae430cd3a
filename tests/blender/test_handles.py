# SPDX-License-Identifier: GPL-3.0-or-later
"""The handles in the 3D view: where each is, what it reads and what it sets. A window's mouse pulls them."""

import math

import bpy
import pytest
from mathutils import Matrix, Vector


@pytest.fixture
def item(ocean_object, make_parameters, empty_scene):
    """An ocean of 150 m that is turned and moved."""
    made = ocean_object.add(empty_scene, make_parameters())
    bpy.context.view_layer.objects.active = made
    made.matrix_world = Matrix.Translation((10.0, 20.0, 1.0)) @ Matrix.Rotation(math.radians(90.0), 4, "Z")
    bpy.context.view_layer.update()
    return made


@pytest.fixture
def handles(extension):
    return extension("ui.gizmos").HANDLES


def tip(handles, item, name):
    """Where in the world a handle is that leads along its z."""
    handle = handles[name]
    return handle.place(item) @ Vector((0.0, 0.0, handle.read(item)))


def test_each_sets_what_it_reads(handles, item):
    settings = item.ocean_tweak
    bpy.ops.ocean.layer_add(kind="HERO_WAVE")
    hero = settings.active_layer
    wanted = {"size": 45.0, "direction": -0.5, "speed": 20.0, "focus": (12.0, 34.0, 0.0), "wavelength": 25.0}
    settings.active_layer, settings.layers[0].definition = 0, "WIND"
    for name, value in wanted.items():
        settings.active_layer = hero if name in ("focus", "wavelength") else 0
        handles[name].write(item, value)
        assert handles[name].read(item) == pytest.approx(value)
    wave = settings.layers[hero].hero_wave
    assert settings.domain_size == pytest.approx(90.0)
    assert settings.layers[0].wind_direction == pytest.approx(0.5)  # a dial turns clockwise
    assert settings.layers[0].wind_speed == pytest.approx(60.0 * 20.0 / 90.0)  # 60 m/s are a side
    assert (wave.x, wave.y, wave.wavelength) == pytest.approx((12.0, 34.0, 25.0))


def test_they_stand_in_the_world_where_the_sea_has_them(handles, item):
    """The ocean's x is the world's y here, and its y the world's -x."""
    settings = item.ocean_tweak
    settings.domain_size, layer = 80.0, settings.layers[0]
    layer.definition, layer.wind_speed, layer.wind_direction = "WIND", 15.0, 0.0
    bpy.context.view_layer.update()
    # the middle is where it was at 150 m, and the corner 40 from it
    assert tuple(item.matrix_world.translation) == pytest.approx((-25.0, 55.0, 1.0), abs=1e-4)
    # from the middle to the edge, which a pull there moves
    assert tuple(tip(handles, item, "size")) == pytest.approx((-65.0, 135.0, 1.0), abs=1e-4)
    # from the middle, (40, 40) in the ocean, and 20 along: 15 of 60 m/s of a side
    assert tuple(tip(handles, item, "speed")) == pytest.approx((-65.0, 115.0, 1.0), abs=1e-4)
    bpy.ops.ocean.layer_add(kind="HERO_WAVE")
    wave = settings.layers[settings.active_layer].hero_wave
    wave.x, wave.y, wave.wavelength, wave.direction = 5.0, 7.0, 30.0, math.radians(180.0)
    assert tuple(tip(handles, item, "wavelength")) == pytest.approx((-32.0, 30.0, 1.0), abs=1e-4)


def test_what_a_layer_has_not_is_not_read(handles, item):
    settings, layer = item.ocean_tweak, item.ocean_tweak.layers[0]
    assert handles["focus"].read(item) is None
    assert handles["wavelength"].read(item) is None
    layer.definition = "SEA_STATE"
    assert handles["speed"].read(item) is None
    assert handles["direction"].read(item) is not None
    bpy.ops.ocean.layer_add(kind="WIND_FIELD")
    settings.layers[settings.active_layer].wind_field.source = "IMAGE"
    assert handles["direction"].read(item) is None


def test_the_size_of_several_patches_is_the_firsts(handles, item):
    bpy.ops.ocean.patch_add()
    bpy.ops.ocean.patch_add()
    handles["size"].write(item, 150.0)
    assert item.ocean_tweak.patches[0].domain_size == pytest.approx(300.0)


def test_handles_are_shown_of_a_live_ocean_that_is_active(extension, item):
    poll = extension("ui.gizmos").OCEAN_GGT_handles.poll
    assert poll(bpy.context)
    item.ocean_tweak.source = "SEQUENCE"
    assert not poll(bpy.context)
    item.ocean_tweak.source = "LIVE"
    bpy.context.view_layer.objects.active = None
    assert not poll(bpy.context)
