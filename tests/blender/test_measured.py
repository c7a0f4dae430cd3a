# SPDX-License-Identifier: GPL-3.0-or-later
"""Measured seas, currents and equalisers in Blender: imported, kept in the file, keyed, and in a shot."""

import math
from fractions import Fraction

import bpy
import numpy as np
import pytest

from tests.export.spectrum_files import BUOY, BUOY_FILES

from .conftest import sea_of


def import_buoy(**how):
    files = [{"name": path.name} for path in BUOY_FILES]
    return bpy.ops.ocean.import_measured(directory=str(BUOY), files=files, **how)


def test_a_buoy_becomes_an_ocean(ocean_object, empty_scene):
    """The sea has the height that the buoy measured; the file keeps it with its spectra."""
    assert import_buoy(tail=False) == {"FINISHED"}
    item = bpy.context.active_object
    (layer,) = sea_of(item).layers
    assert layer.definition == "MEASURED"
    energy = layer.measured.energy_at(0.0) @ layer.measured.bins[1]
    assert 4.0 * math.sqrt(energy) == pytest.approx(1.12, abs=0.005)
    mesh = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    heights = np.empty(3 * len(mesh.vertices))
    mesh.vertices.foreach_get("co", heights)
    assert 0.6 < 4.0 * heights[2::3].std() < 1.8


def test_a_buoy_becomes_a_layer_and_its_time_can_be_keyed(ocean, empty_scene):
    assert import_buoy(target="LAYER", time="all") == {"FINISHED"}
    settings = ocean.ocean_tweak
    assert [layer.definition for layer in settings.layers] == ["WIND", "MEASURED"]
    layer = settings.layers[1]
    layer.measured_time = 0.0
    layer.keyframe_insert("measured_time", frame=1)
    layer.measured_time = 36000.0
    layer.keyframe_insert("measured_time", frame=11)
    before = sea_of(ocean).layers[1].measured
    assert len(before.seconds) == 11
    empty_scene.frame_set(6)
    assert 0.0 < sea_of(ocean).layers[1].measured_time < 36000.0


def test_a_linked_ocean_gets_no_layer(ocean, empty_scene, tmp_path):
    file = str(tmp_path / "sea.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(file, link=True) as (_, chosen):
        chosen.objects = ["Ocean"]
    bpy.context.scene.collection.objects.link(bpy.data.objects["Ocean"])
    with pytest.raises(RuntimeError, match="make it local"):
        import_buoy(target="LAYER")
    assert len(bpy.data.objects["Ocean"].ocean_tweak.layers) == 1


def test_without_an_ocean_a_layer_is_refused(empty_scene):
    with pytest.raises(RuntimeError, match="choose As New Ocean"):
        import_buoy(target="LAYER")
    assert not list(empty_scene.objects)
    assert import_buoy() == {"FINISHED"}


def test_bad_files_are_refused_in_a_line(ocean, empty_scene, tmp_path):
    path = tmp_path / "41010.spec"
    path.write_text("SWAN 1\nTIME\n4\n")
    with pytest.raises(RuntimeError, match=r"41010.spec, line 3.*option 4"):
        bpy.ops.ocean.import_measured(filepath=str(path))


def test_a_keyed_current_is_the_same_in_the_scene_and_in_its_shot(extension, ocean, empty_scene):
    """The panel's keys, and the samples of the shot that is exported: the same water at each frame."""
    settings = ocean.ocean_tweak
    settings.use_current = True
    settings.current.direction = 0.5
    for frame, speed in ((1, 0.0), (6, 0.0), (12, 3.0)):
        settings.current.speed = speed
        settings.current.keyframe_insert("speed", frame=frame)
    empty_scene.frame_start, empty_scene.frame_end = 1, 14
    shot = extension("scene.shots").shot_of(ocean, empty_scene)
    for frame in (1, 7, 10, 14):
        empty_scene.frame_set(frame)
        evaluated = ocean.evaluated_get(bpy.context.evaluated_depsgraph_get())
        own = evaluated.ocean_tweak.to_parameters(empty_scene).current
        moment = shot.at(Fraction(frame))
        time = float(moment.time)
        np.testing.assert_allclose(own.carried(time), moment.parameters.current.carried(time), atol=2e-3)
        np.testing.assert_allclose(own.velocity, moment.parameters.current.velocity, atol=1e-4)
    assert math.hypot(*own.carried(time)) > 0.3


def test_an_equaliser_of_the_sea_and_of_a_layer(extension, ocean, empty_scene):
    """Bands are those of the panel, in the parameters and in the spectrum's picture; keys are samples."""
    plain = extension("ui.spectrum_plot").spectrum_plot(sea_of(ocean))
    settings = ocean.ocean_tweak
    settings.use_equaliser = settings.layers[0].use_equaliser = True
    assert np.array_equal(extension("ui.spectrum_plot").spectrum_plot(sea_of(ocean)), plain)
    settings.equaliser.peak = -6.0
    settings.layers[0].equaliser.shorter_2 = 12.0
    sea = sea_of(ocean)
    assert (sea.equaliser.peak, sea.layers[0].equaliser.shorter_2) == (-6.0, 12.0)
    assert not np.array_equal(extension("ui.spectrum_plot").spectrum_plot(sea), plain)
    settings.equaliser.keyframe_insert("peak", frame=1)
    settings.equaliser.peak = 0.0
    settings.equaliser.keyframe_insert("peak", frame=5)
    empty_scene.frame_start, empty_scene.frame_end = 1, 5
    shot = extension("scene.shots").shot_of(ocean, empty_scene)
    assert shot.at(1).parameters.equaliser.peak == pytest.approx(-6.0)
    assert shot.at(5).parameters.equaliser.peak == pytest.approx(0.0)
    settings.use_equaliser = False
    assert sea_of(ocean).equaliser is None


@pytest.mark.parametrize("keyed", [False, True])
def test_what_drifts_goes_along_with_the_current(extension, ocean, empty_scene, keyed):
    """By as much as the water has come, live and baked to keys; what does not drift stays above its place."""
    floating = extension("scene.floating")
    empty_scene.frame_start, empty_scene.frame_end = 1, 10
    settings = ocean.ocean_tweak
    settings.use_current, settings.use_foam = True, False
    settings.current.direction = 0.5
    settings.current.speed = 3.0
    if keyed:
        settings.current.keyframe_insert("speed", frame=1)
        settings.current.speed = 0.0
        settings.current.keyframe_insert("speed", frame=7)
    items = []
    for drift in (0.0, 1.0):
        item = bpy.data.objects.new("Cork", None)
        item.location = (60.0, 50.0, 0.0)
        empty_scene.collection.objects.link(item)
        floating.float_on(item, ocean, floating.Ride(drift=drift))
        items.append(item)
    live = {}
    for frame in (4, 10):
        empty_scene.frame_set(frame)
        # of an ocean that is animated, this is known after the evaluation
        bpy.context.view_layer.update()
        evaluated = ocean.evaluated_get(bpy.context.evaluated_depsgraph_get())
        sea = evaluated.ocean_tweak.to_parameters(empty_scene)
        time = sea.timing.time(frame)
        way = np.array(sea.current.carried(float(time)))
        assert np.hypot(*way) > 0.3
        at_rest = extension("core").Places(*np.add(way, (60.0, 50.0)))
        fields = extension("core").Ocean(sea).surface(time, on=at_rest)
        expected = way + fields.displacement[:2]
        places = [np.array(item.matrix_world.translation) for item in items]
        np.testing.assert_allclose(places[0][:2], (60.0, 50.0), atol=1e-3)
        np.testing.assert_allclose(places[1][:2] - (60.0, 50.0), expected, atol=0.05)
        live[frame] = places[1]
    bpy.context.view_layer.objects.active = items[1]
    items[1].select_set(True)
    assert bpy.ops.object.ocean_tweak_float_bake(drift=1.0) == {"FINISHED"}
    for frame, place in live.items():
        empty_scene.frame_set(frame)
        np.testing.assert_allclose(items[1].matrix_world.translation, place, atol=0.02)
