# SPDX-License-Identifier: GPL-3.0-or-later
"""While files move an ocean, panel and console tell which sea they are, and how the settings differ."""

import json

import bpy
import numpy as np
import pytest

from .conftest import sea_of
from .layouts import draw  # noqa: F401 - a fixture
from .test_animation import key


@pytest.fixture
def baked(ocean, empty_scene, tmp_path):
    """The small sea, baked for three frames and moved by them."""
    empty_scene.frame_start, empty_scene.frame_end = 1, 3
    ocean.ocean_tweak.cache_folder = str(tmp_path / "cache")
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    assert ocean.ocean_tweak.source == "SEQUENCE"
    return ocean


def differences(item):
    text = item.ocean_tweak.bake_differs
    return {path: (baked, own) for path, baked, own in json.loads(text or "[]")}


def wave_height(item):
    return json.loads(item.ocean_tweak.statistics)["spectrum"]["significant_wave_height"]


def test_a_bake_of_the_settings_is_told_as_such(baked, draw, core):  # noqa: F811
    assert differences(baked) == {}
    drawn = draw(baked)
    assert "The bake" in drawn
    assert "ocean.settings_from_bake" not in drawn
    assert wave_height(baked) == core.Ocean(sea_of(baked)).statistics().significant_wave_height


def test_other_settings_are_told_and_the_numbers_stay_those_of_the_bake(baked, draw, core):  # noqa: F811
    before = sea_of(baked)
    baked.ocean_tweak.layers[0].wind_speed = 5.0
    baked.ocean_tweak.choppiness = 0.5
    assert differences(baked) == {"layers.0.wind_speed": (11.0, 5.0), "choppiness": (1.0, 0.5)}
    assert wave_height(baked) == core.Ocean(before).statistics().significant_wave_height
    text = " ".join(draw(baked))
    assert "Settings differ from the bake" in text
    assert "Layer 1, Wind Speed 5, baked 11" in text
    assert "11 m/s" in text
    assert "ocean.settings_from_bake" in text
    baked.ocean_tweak.layers[0].wind_speed = 11.0
    assert set(differences(baked)) == {"choppiness"}
    assert bpy.ops.ocean.settings_from_bake() == {"FINISHED"}
    assert sea_of(baked) == before
    assert differences(baked) == {}


def test_bake_again_shows_the_settings(baked):
    folder = baked.ocean_tweak.sequence_maps.disp.filepath
    baked.ocean_tweak.seed = 8
    assert differences(baked) == {"seed": (7, 8)}
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    assert differences(baked) == {}
    assert baked.ocean_tweak.sequence_maps.disp.filepath != folder


def test_keys_are_compared_frame_by_frame_and_come_back(ocean, empty_scene, tmp_path):
    empty_scene.frame_start, empty_scene.frame_end = 1, 5
    ocean.ocean_tweak.cache_folder = str(tmp_path / "cache")
    key(ocean, "layers[0].wind_speed", {1: 8.0, 5: 12.0})
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    for frame in (1, 2, 5, 6):
        empty_scene.frame_set(frame)
        assert differences(ocean) == {}
    key(ocean, "layers[0].wind_speed", {5: 16.0})
    seen = {}
    for frame in (1, 3, 5):
        empty_scene.frame_set(frame)
        seen[frame] = differences(ocean)
    assert seen == {1: {}, 3: {"layers.0.wind_speed": (10.0, 12.0)}, 5: {"layers.0.wind_speed": (12.0, 16.0)}}
    assert bpy.ops.ocean.settings_from_bake() == {"FINISHED"}
    for frame in (1, 3, 5):
        empty_scene.frame_set(frame)
        assert differences(ocean) == {}
    assert ocean.ocean_tweak.layers[0].wind_speed == 12.0


def test_files_of_other_programs_and_other_jobs_are_compared_by_their_headers(
    ocean, ocean_object, bake, make_parameters, empty_scene
):
    sequence = bake(make_parameters(seed=3), 1, 2)
    ocean_object.use_sequence(ocean, empty_scene, sequence)
    assert differences(ocean) == {"seed": (3, 7)}
    (sequence.directory / "bake.json").write_text("[]")
    ocean.ocean_tweak.choppiness = 2.0
    assert set(differences(ocean)) == {"seed", "choppiness"}
    assert bpy.ops.ocean.settings_from_bake() == {"FINISHED"}
    assert differences(ocean) == {}


def test_an_opened_file_is_looked_at(baked, tmp_path):
    baked.ocean_tweak.seed = 8
    with baked.ocean_tweak.quiet():
        baked.ocean_tweak.bake_differs = ""
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "shot.blend"))
    assert differences(bpy.data.objects["Ocean"]) == {"seed": (7, 8)}


def test_the_console_hears_it_once_a_shot(baked, extension, empty_scene, caplog):
    handlers = extension("scene.scene_handlers")
    handlers.begin_render(empty_scene)
    assert caplog.text == ""
    baked.ocean_tweak.seed = 8
    for _ in range(2):
        caplog.clear()
        handlers.begin_render(empty_scene)
        empty_scene.frame_set(2)
        handlers.end_render(empty_scene)
        (record,) = caplog.records
        assert "is shown, not the settings" in record.message
        assert "seed is 8 and was 7" in record.message


def test_a_live_ocean_has_no_bake(baked):
    baked.ocean_tweak.seed = 8
    bpy.ops.ocean.use_live()
    assert baked.ocean_tweak.bake_differs == baked.ocean_tweak.baked_sea == ""
    assert not bpy.ops.ocean.settings_from_bake.poll()


def test_the_farm_renders_no_ocean_that_was_changed_after_its_bake(baked, extension, empty_scene):
    script = extension("export.farm.render_baked")
    folder = extension("scene.cache_place").shown_bake(baked)
    of_job = script.Bake(folder.parent.parent, f"{folder.parent.name}/{folder.name.partition('-')[2]}")
    script.use_sequence(baked, of_job, [1, 2, 3])
    key(baked, "layers[0].wind_speed", {1: 11.0, 2: 11.0, 3: 20.0})
    with pytest.raises(script.RenderError, match=r"wind_speed is 20.0 and was 11.0 in frame 3"):
        script.use_sequence(baked, of_job, [1, 2, 3])
    baked.ocean_tweak.uid = "of a file that has another sea, whose bake was given"
    script.use_sequence(baked, of_job, [1, 2, 3])


def test_another_frame_of_a_bake_makes_no_sea(baked, extension, empty_scene, monkeypatch):
    plans, planned = extension("scene.plan"), []
    plan_of = plans.plan_of
    monkeypatch.setattr(plans, "plan_of", lambda *given: planned.append(given) or plan_of(*given))
    empty_scene.frame_set(2)
    assert planned == []
    baked.ocean_tweak.choppiness = 0.5  # a setting may change the mesh and what moves it
    assert len(planned) == 1
    bpy.ops.ocean.use_live()
    planned.clear()
    empty_scene.frame_set(3)
    assert len(planned) == 1


def test_a_bake_from_before_foam_had_an_age_is_shown_with_a_word_about_it(
    ocean, empty_scene, extension, core, monkeypatch, tmp_path, caplog
):
    """Its foam map has no breaking in blue; the mesh has its foam, nothing that breaks, and no age."""
    formats, channels = extension("core.data.formats"), extension("core.synthesis.channels")
    settings = ocean.ocean_tweak
    settings.use_foam = True
    sea = settings.to_parameters(empty_scene)
    cache, shots = extension("export.cache.folders"), extension("core.parameters.shot")
    job = extension("export.cache.job").Job(
        "Ocean", "0123abcd", shots.Shot(sea), ("disp", "foam"), "ZIP", (1,), foam=1
    )
    with monkeypatch.context() as former:
        former.setattr(formats, "FOAM", 1)
        former.setitem(channels.MAPS, "foam", ("foam", "cusp"))
        folder = cache.open_folder(tmp_path / "cache", job)
        sink = extension("export.cache.records").CacheSink(folder, job)
        assert list(extension("core.sea.bake").bake(job.shot, (1,), sink))
    assert bpy.ops.ocean.use_sequence(filepath=str(folder)) == {"FINISHED"}
    mesh = ocean.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    assert "foam_age" not in mesh.attributes
    found = {name: np.empty(len(mesh.vertices), np.float32) for name in ("foam", "breaking")}
    for name, values in found.items():
        mesh.attributes[name].data.foreach_get("value", values)
    count = sea.resolution
    expected = core.Ocean(sea).frame(1, {"foam"}).foam
    assert expected.max() > 0.1
    grid = found["foam"].reshape(count + 1, count + 1)[:count, :count]
    assert np.abs(grid - expected).max() < 2e-3
    assert not found["breaking"].any()
    caplog.clear()
    extension("scene.scene_handlers").begin_render(empty_scene)
    assert caplog.text.count("was made before foam had an age") == 1
    assert str(folder) in caplog.text
