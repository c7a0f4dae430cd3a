# SPDX-License-Identifier: GPL-3.0-or-later
"""Seas from a height and a period, from a Beaufort number, and from Blender's own Ocean modifier."""

import math
import re

import bpy
import numpy as np
import pytest

from .conftest import sea_of
from .layouts import draw  # noqa: F401 - a fixture


@pytest.mark.parametrize(("height", "period"), [(2.0, 7.0), (2.5, 14.0), (0.4, 2.5)])
def test_waves_of_a_height_and_a_period(ocean, core, height, period):
    assert bpy.ops.ocean.match_sea_state(by="WAVES", height=height, period=period) == {"FINISHED"}
    state = core.Ocean(sea_of(ocean)).statistics()
    assert state.spectrum.significant_wave_height == pytest.approx(height, rel=0.01)
    assert state.spectrum.peak_period == pytest.approx(period, rel=0.01)
    assert 4.0 < state.wavelengths_per_domain < 5.0


def test_a_beaufort_number(ocean, core):
    """The WMO's probable wave height of Beaufort 7 is 4 m."""
    assert bpy.ops.ocean.match_sea_state(by="BEAUFORT", beaufort="beaufort_07", fit_domain=False) == {
        "FINISHED"
    }
    state = core.Ocean(sea_of(ocean)).statistics()
    assert state.spectrum.significant_wave_height == pytest.approx(4.0, rel=0.03)
    assert sea_of(ocean).domain_size == 150.0


def test_a_sea_state_that_no_wind_raises_is_told_with_the_nearest(ocean, draw):  # noqa: F811
    """In deep water the wavelength is g T²/2π, of which 6 m are much more than any sea has."""
    assert bpy.ops.ocean.match_sea_state(by="WAVES", height=6.0, period=4.0) == {"FINISHED"}
    told = " ".join(draw(ocean))
    steepness = 6.0 / (9.81 * 4.0**2 / (2.0 * math.pi))
    assert f"Their steepness, height over wavelength, would be {steepness:.2f}" in told
    found = re.search(r"Nearest: (\S+) m at 4 s, or 6 m at (\S+) s", told)
    assert found is not None
    lower, longer = map(float, found.groups())
    assert lower < 6.0
    assert longer > 4.0
    for height, period in ((lower, 4.0), (6.0, longer)):
        bpy.ops.ocean.match_sea_state(by="WAVES", height=height, period=period)
        assert "Nearest" not in " ".join(draw(ocean))


def test_match_wants_an_ocean(empty_scene):
    assert not bpy.ops.ocean.match_sea_state.poll()
    assert not bpy.ops.ocean.convert.poll()


@pytest.fixture
def blenders_ocean(empty_scene):
    item = bpy.data.objects.new("Old Sea", bpy.data.meshes.new("Old Sea"))
    empty_scene.collection.objects.link(item)
    modifier = item.modifiers.new("Ocean", "OCEAN")
    modifier.resolution, modifier.viewport_resolution = 8, 6
    modifier.spatial_size, modifier.size = 60, 1.5
    modifier.repeat_x = 2
    modifier.wind_velocity, modifier.depth, modifier.random_seed = 12.5, 30.0, 3
    modifier.choppiness, modifier.wave_direction = 0.8, 0.5
    modifier.spectrum, modifier.fetch_jonswap = "JONSWAP", 80.0
    item.data.materials.append(bpy.data.materials.new("Water"))
    item.location = (10.0, 20.0, 1.0)
    item.rotation_euler = (0.0, 0.0, 0.3)
    bpy.context.view_layer.objects.active = item
    bpy.context.view_layer.update()
    return item


def corners(item):
    """(2, 3) lower and upper corner of the evaluated mesh in the world, Blender units."""
    evaluated = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
    flat = np.empty(3 * len(evaluated.data.vertices), np.float32)
    evaluated.data.vertices.foreach_get("co", flat)
    places = flat.reshape(-1, 3) @ np.array(item.matrix_world.to_3x3()).T + np.array(
        item.matrix_world.translation
    )
    return np.array([places.min(axis=0), places.max(axis=0)])


def test_what_carries_over(blenders_ocean):
    before = corners(blenders_ocean)
    assert bpy.ops.ocean.convert() == {"FINISHED"}
    item = bpy.context.active_object
    converted = sea_of(item)
    assert item.ocean_tweak.is_ocean
    assert (converted.resolution, converted.domain_size, converted.seed) == (64, 90.0, 3)
    assert converted.choppiness == pytest.approx(0.8)
    assert converted.water.depth == 30.0
    layer = converted.layers[0]
    assert (layer.spectrum, layer.wind_speed, layer.fetch) == ("JONSWAP", 12.5, 80e3)
    assert layer.wind_direction == pytest.approx(0.5)
    assert (item.ocean_tweak.repeats_x, item.ocean_tweak.repeats_y) == (2, 1)
    assert item.ocean_tweak.viewport_resolution == 36
    assert [material.name for material in item.data.materials] == ["Water"]
    # it covers the same place, but for the waves that now have their own height and push sideways
    np.testing.assert_allclose(corners(item)[:, :2], before[:, :2], atol=4.0)
    assert blenders_ocean.hide_render
    assert (item.name, blenders_ocean.name) == ("Old Sea", "Old Sea Original")


@pytest.mark.parametrize("way", ["keys", "driver"])
def test_the_clock_carries_over(blenders_ocean, way, extension, empty_scene):
    modifier = blenders_ocean.modifiers["Ocean"]
    if way == "keys":
        for frame, seconds in ((1, 2.0), (25, 5.0)):
            modifier.time = seconds
            modifier.keyframe_insert("time", frame=frame)
            blenders_ocean.keyframe_insert("location", frame=frame)
        for curve in extension("scene.animated").curves_of(blenders_ocean):
            for point in curve.keyframe_points:
                point.interpolation = "LINEAR"
    else:
        modifier.driver_add("time").driver.expression = "2 + (frame - 1) / 8"
    assert bpy.ops.ocean.convert() == {"FINISHED"}
    item = bpy.context.active_object
    assert item.ocean_tweak.use_ocean_time
    empty_scene.frame_set(13)
    clock = extension("scene.animated").clock_of
    settings = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).ocean_tweak
    assert float(clock(settings, empty_scene, 1).time) == pytest.approx(3.5)
    assert all("location" not in curve.data_path for curve in extension("scene.animated").curves_of(item))
    assert modifier.time == pytest.approx(3.5)  # the original's own clock runs on


def test_the_original_goes_where_it_is_not_wanted(blenders_ocean):
    name = blenders_ocean.name
    assert bpy.ops.ocean.convert(keep_original=False) == {"FINISHED"}
    assert bpy.context.active_object.name == name
    assert len(bpy.data.objects) == 1


def test_the_list_of_what_is_lost(blenders_ocean, extension, empty_scene):
    conversion = extension("scene.conversion")
    modifier = blenders_ocean.modifiers["Ocean"]
    assert conversion.convert(blenders_ocean, modifier, empty_scene).lost == ()
    modifier.wave_scale, modifier.wave_alignment, modifier.use_spray = 2.0, 0.4, True
    lost = " ".join(conversion.convert(blenders_ocean, modifier, empty_scene).lost)
    for word in ("Amplitude Scale", "Swell", "Spray"):
        assert word in lost


def test_undo_takes_the_conversion_back(blenders_ocean, window):
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.ocean.convert()
        assert len(bpy.data.objects) == 2
        bpy.ops.ed.undo_push(message="converted")
        bpy.ops.ed.undo()
    assert [item.name for item in bpy.data.objects] == ["Old Sea"]
    assert not bpy.data.objects[0].hide_render


def test_settings_that_are_no_sea_are_refused(blenders_ocean):
    blenders_ocean.modifiers["Ocean"].depth = 0.0
    with pytest.raises(RuntimeError, match="depth"):
        bpy.ops.ocean.convert()
    assert len(bpy.data.objects) == 1
