# SPDX-License-Identifier: GPL-3.0-or-later
"""Hero waves in Blender: nothing lost on the way, crests where they were placed, misfits refused."""

import math

import bpy
import numpy as np
import pytest

from tests.layers import layers_of, with_layers

from .conftest import sea_of


@pytest.fixture
def placed(core, make_parameters):
    size = make_parameters().domain_size
    return with_layers(make_parameters(), HERO_WAVE=(
            core.HeroWave(
                x=-0.3 * size, y=0.7 * size, time=0.3, direction=0.7, wavelength=size / 3, crest_height=0.1,
                group_length=1.5, group_width=0.6 * size, phase=0.1,
            ),
            core.HeroWave(muted=True),
        ))  # fmt: skip


def test_they_come_back_to_the_last_bit(ocean, placed, empty_scene, tmp_path):
    empty_scene.unit_settings.scale_length = 0.3048
    ocean.ocean_tweak.from_parameters(placed, empty_scene)
    assert sea_of(ocean) == placed
    assert [layer.kind for layer in ocean.ocean_tweak.layers] == ["WAVES", "HERO_WAVE", "HERO_WAVE"]
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "sea.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "sea.blend"))
    assert sea_of(bpy.data.objects["Ocean"]) == placed


def test_vertices_are_those_of_the_core(ocean, placed, empty_scene, expected, evaluated):
    ocean.ocean_tweak.from_parameters(placed, empty_scene)
    for frame in (1, 20):
        empty_scene.frame_set(frame)
        assert np.abs(evaluated(ocean) - expected(placed, frame)).max() < 1e-4
    assert np.abs(evaluated(ocean) - expected(with_layers(placed, HERO_WAVE=()), 20)).max() > 0.02


def test_the_menus_wave_stands_in_the_middle_now(ocean, empty_scene, evaluated):
    settings = ocean.ocean_tweak
    settings.choppiness = 0.0
    settings.layers[0].muted = True
    empty_scene.frame_set(13)
    bpy.ops.ocean.layer_add(kind="HERO_WAVE")
    assert not settings.error
    (wave,) = layers_of(sea_of(ocean), "HERO_WAVE")
    assert wave.time == 0.5
    heights = evaluated(ocean)[..., 2].ravel()
    places = evaluated(ocean)[np.unravel_index(np.argmax(heights), evaluated(ocean).shape[:-1])]
    np.testing.assert_allclose(places, (wave.x, wave.y, wave.crest_height), rtol=1e-4)
    settings.layers[1].hero_wave.crest_height *= 2.0
    assert evaluated(ocean)[..., 2].max() == pytest.approx(2.0 * wave.crest_height, rel=1e-4)
    settings.layers[1].hero_wave.muted = True
    assert abs(evaluated(ocean)[..., 2]).max() == 0.0


@pytest.mark.parametrize("resolution", [16, 20, 32, 64])
def test_the_menus_wave_fits(ocean, resolution):
    ocean.ocean_tweak.resolution = resolution
    bpy.ops.ocean.layer_add(kind="HERO_WAVE")
    assert [layer.kind for layer in sea_of(ocean).active()].count("HERO_WAVE") == 1


def test_duplicate_move_solo_and_remove(ocean, placed, empty_scene):
    settings = ocean.ocean_tweak
    settings.from_parameters(placed, empty_scene)
    first, second = layers_of(placed, "HERO_WAVE")
    settings.active_layer = 1
    bpy.ops.ocean.layer_duplicate()
    assert layers_of(sea_of(ocean), "HERO_WAVE") == (first, first, second)
    bpy.ops.ocean.layer_remove()
    bpy.ops.ocean.layer_move(direction="DOWN")
    assert layers_of(sea_of(ocean), "HERO_WAVE") == (second, first)
    bpy.ops.ocean.layer_solo()
    assert sea_of(ocean).active() == (first,)


def test_what_does_not_fit_is_told_and_a_coarse_viewport_leaves_it_out(ocean, placed, empty_scene, evaluated):
    settings = ocean.ocean_tweak
    settings.from_parameters(placed, empty_scene)
    settings.layers[1].hero_wave.group_width = 1e4
    assert "layers.1.group_width" in settings.error
    settings.layers[1].hero_wave.group_width = layers_of(placed, "HERO_WAVE")[0].group_width
    assert not settings.error
    settings.layers[0].muted = True
    settings.layers[1].hero_wave.wavelength = placed.domain_size * 5.0 / placed.resolution
    assert not settings.error
    assert np.abs(evaluated(ocean)[..., 2]).max() > 0.02
    settings.viewport_resolution = placed.resolution // 2
    assert not settings.error
    assert np.abs(evaluated(ocean)[..., 2]).max() == 0.0


def test_directions_and_phases_are_angles(ocean):
    bpy.ops.ocean.layer_add(kind="HERO_WAVE")
    group = ocean.ocean_tweak.layers[1].hero_wave
    group.direction = math.radians(90.0)
    assert group.bl_rna.properties["direction"].subtype == "ANGLE"
    assert layers_of(sea_of(ocean), "HERO_WAVE")[0].direction == pytest.approx(math.pi / 2.0)
    assert not group.bl_rna.properties["crest_height"].is_animatable
