# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of wave layers: whatever is added or removed, the other layers keep their waves."""

import bpy
import pytest

from .conftest import sea_of


def layers(item):
    return item.ocean_tweak.to_parameters(bpy.context.scene).layers


def test_add_duplicate_remove(ocean):
    first = layers(ocean)[0]
    bpy.ops.ocean.layer_add()
    assert ocean.ocean_tweak.active_layer == 1
    ocean.ocean_tweak.layers[1].definition = "SEA_STATE"
    ocean.ocean_tweak.layers[1].peak_period = 14.0
    bpy.ops.ocean.layer_duplicate()
    assert ocean.ocean_tweak.active_layer == 2
    one, two, three = layers(ocean)
    assert one == first
    assert two.peak_period == three.peak_period == 14.0
    assert len({one.id, two.id, three.id}) == 3
    ocean.ocean_tweak.active_layer = 1
    bpy.ops.ocean.layer_remove()
    assert layers(ocean) == (one, three)
    assert ocean.ocean_tweak.active_layer == 0


def test_the_last_layer_stays(ocean):
    assert not bpy.ops.ocean.layer_remove.poll()
    with pytest.raises(RuntimeError, match="at least one wave layer"):
        bpy.ops.ocean.layer_remove()


def test_solo_and_back(ocean):
    for _ in range(2):
        bpy.ops.ocean.layer_add()
    ocean.ocean_tweak.active_layer = 1
    bpy.ops.ocean.layer_solo()
    assert [layer.muted for layer in layers(ocean)] == [True, False, True]
    ocean.ocean_tweak.active_layer = 2
    bpy.ops.ocean.layer_solo()
    assert [layer.muted for layer in layers(ocean)] == [True, True, False]
    bpy.ops.ocean.layer_solo()
    assert not any(layer.muted for layer in layers(ocean))


def test_muting_leaves_a_layer_out(ocean, evaluated, empty_scene):
    ocean.ocean_tweak.layers[0].muted = True
    assert abs(evaluated(ocean)[..., 2]).max() == 0.0


def test_undo_brings_a_layer_back(ocean, window):
    name, before = ocean.name, layers(ocean)
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.ocean.layer_add()
        bpy.ops.ed.undo_push(message="added")
        assert len(layers(bpy.data.objects[name])) == 2
        bpy.ops.ed.undo()
    assert layers(bpy.data.objects[name]) == before


def test_loops_are_whole_frames(ocean, empty_scene):
    empty_scene.render.fps, empty_scene.render.fps_base = 24, 1.001
    settings = ocean.ocean_tweak
    settings.use_loop, settings.loop_frames = True, 100
    sea = settings.to_parameters(empty_scene)
    assert sea.loop_duration * sea.timing.fps == 100
    settings.from_parameters(sea.replace(loop_duration=None), empty_scene)
    assert not settings.use_loop
    settings.from_parameters(sea, empty_scene)
    assert (settings.use_loop, settings.loop_frames) == (True, 100)


@pytest.mark.parametrize("metres", [1.0, 0.01])
def test_fetch_in_kilometres_is_the_fetch(ocean, empty_scene, metres):
    empty_scene.unit_settings.scale_length = metres
    layer = ocean.ocean_tweak.layers[0]
    layer.fetch_km = 120.0
    assert layers(ocean)[0].fetch == pytest.approx(120e3)
    assert layer.fetch_km == pytest.approx(120.0)


def test_a_drift_in_percent_is_a_share_of_the_wind(ocean):
    foam = ocean.ocean_tweak.foam
    foam.drift_percent = 3.5
    assert sea_of(ocean).foam.drift == pytest.approx(0.035)
    foam.drift = 0.01
    assert foam.drift_percent == pytest.approx(1.0)
