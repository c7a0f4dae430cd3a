# SPDX-License-Identifier: GPL-3.0-or-later
"""What live oceans keep: no more than the budget over any number of frames, and nothing of another file."""

import gc
import os
import sys
import tracemalloc
from pathlib import Path

import bpy
import numpy as np
import pytest

from .test_animation import key

MB = 10**6


@pytest.fixture
def memo(extension):
    module = extension("core.numerics.memo")
    module.MEMO.drop()
    gc.collect()  # what tests before left behind is counted as long as it lives
    yield module.MEMO
    module.MEMO.budget = None
    module.MEMO.drop()


def add_keyed(ocean_object, make_parameters, core, scene, last):
    """An ocean of 64² with all of its maps whose wind rises."""
    parameters = make_parameters(resolution=64, foam=core.Foam(half_life=0.1))
    item = ocean_object.add(scene, parameters)
    key(item, "layers[0].wind_speed", {1: 5.0, last: 15.0})
    return item


def test_a_keyed_wind_stays_within_the_budget(memo, ocean_object, make_parameters, core, empty_scene):
    last = 40
    memo.budget = 4 * MB
    item = add_keyed(ocean_object, make_parameters, core, empty_scene, last)
    gc.collect()
    gc.disable()  # what goes, goes without Python's search for circles
    tracemalloc.start()
    try:
        empty_scene.frame_set(1)
        before = tracemalloc.get_traced_memory()[0]
        for frame in range(1, last + 1):
            empty_scene.frame_set(frame)
            assert item.ocean_tweak.error == ""
            assert sum(memo.report().values()) <= 4 * MB
        grown = tracemalloc.get_traced_memory()[0] - before
    finally:
        tracemalloc.stop()
        gc.enable()
    # a sea of 64² with its surface takes 0.3 MB, forty of them three times the budget; what Blender and tests
    # before keep of it takes some of the rest
    assert grown < 6 * MB
    assert sum(memo.report().values()) > MB // 2, "some frames are kept"


def test_a_frame_that_is_kept_is_not_made_again(
    memo, ocean_object, make_parameters, core, empty_scene, monkeypatch
):
    add_keyed(ocean_object, make_parameters, core, empty_scene, 10)
    for frame in (3, 4):
        empty_scene.frame_set(frame)
    monkeypatch.setattr(core.Ocean, "surface", lambda *a, **k: pytest.fail("it is there"))
    empty_scene.frame_set(3)


def test_a_budget_below_one_sea_shows_it_and_says_so(
    memo, ocean_object, make_parameters, core, extension, empty_scene
):
    made, module = [], extension("core.sea.part_waves")
    parameters = make_parameters(resolution=128)
    with pytest.MonkeyPatch.context() as patch:
        make = module.initial_state
        patch.setattr(module, "initial_state", lambda *a: made.append(a) or make(*a))
        memo.budget = MB // 10
        item = ocean_object.add(empty_scene, parameters)
        item.ocean_tweak.use_foam = False
        made.clear()
        for frame in range(2, 6):
            empty_scene.frame_set(frame)
        assert item.ocean_tweak.error == ""
    assert len(made) <= 1
    line = extension("core.sea.memory").beyond_budget(parameters)
    assert "the memory for all seas is 100 kB" in line
    assert "raise Memory in the extension's preferences" in line
    bpy.context.view_layer.objects.active = item
    warnings = extension("ui.panels.sea")._object_warnings(bpy.context)
    assert line in warnings
    memo.budget = None
    assert line not in extension("ui.panels.sea")._object_warnings(bpy.context)


def test_the_preference_sets_the_budget(memo, package, extension, monkeypatch):
    monkeypatch.delenv("OCEAN_TWEAK_MEMORY", raising=False)
    chosen = bpy.context.preferences.addons[package].preferences
    automatic = memo.budget
    assert chosen.memory_is_automatic
    chosen.memory = 20
    assert memo.budget == automatic
    chosen.memory_is_automatic = False
    assert memo.budget == 20 * MB
    assert extension("ui.preferences")._memory_texts() == ["0 bytes of 20 MB is used"]
    monkeypatch.setenv("OCEAN_TWEAK_MEMORY", "30MB")
    chosen.memory = 40
    assert memo.budget == 30 * MB
    assert "OCEAN_TWEAK_MEMORY" in extension("ui.preferences")._memory_texts()[-1]
    monkeypatch.delenv("OCEAN_TWEAK_MEMORY")
    chosen.memory_is_automatic = True
    assert memo.budget == automatic


def test_a_bad_budget_of_the_environment_is_shown(memo, ocean, extension, empty_scene, monkeypatch):
    monkeypatch.setenv("OCEAN_TWEAK_MEMORY", "lots")
    memo.budget = None
    empty_scene.frame_set(5)
    assert "OCEAN_TWEAK_MEMORY = 'lots': must be a size" in ocean.ocean_tweak.error
    assert extension("ui.preferences")._memory_texts()[0].startswith("OCEAN_TWEAK_MEMORY = 'lots'")
    monkeypatch.delenv("OCEAN_TWEAK_MEMORY")
    empty_scene.frame_set(6)
    assert ocean.ocean_tweak.error == ""


def test_another_file_keeps_nothing_of_this_one(memo, ocean, empty_scene):
    empty_scene.frame_set(5)
    assert {"surfaces", "waves"} <= memo.report().keys()
    bpy.ops.wm.read_homefile(use_empty=True)
    assert memo.report() == {}


def test_the_water_s_patterns_are_computed_once_for_all_files(memo, extension, empty_scene, monkeypatch):
    images = extension("nodes.detail_image")
    first = np.array(images.gust_image().pixels)
    bpy.ops.wm.read_homefile(use_empty=True)
    monkeypatch.setattr(images, "spline_weights", None)
    assert np.array_equal(images.gust_image().pixels, first)


LONG = "OCEAN_TWEAK_LONG_TESTS" in os.environ


@pytest.mark.skipif(sys.platform != "linux", reason="resident memory is read from /proc")
def test_a_session_takes_no_more_however_long_it_is(memo, ocean_object, make_parameters, core, empty_scene):
    """2,000 frames and 300 edits, or a tenth of both: what the process holds at the end, it held before."""
    frames, edits, budget = (2000, 300, 4 * MB) if LONG else (200, 30, 4 * MB)
    memo.budget = budget
    item = ocean_object.add(empty_scene, make_parameters(resolution=64, foam=core.Foam(half_life=0.5)))

    def live_through(first, last):
        for frame in range(first, last + 1):
            empty_scene.frame_set(frame)
            if frame % (frames // edits) == 0:
                item.ocean_tweak.layers[0].wind_speed = 8.0 + (frame * 0.61803) % 7.0
            assert item.ocean_tweak.error == ""
            assert sum(memo.report().values()) <= budget

    live_through(1, 150)  # fills what is kept
    gc.collect()
    before = resident()
    live_through(151, 150 + frames)
    gc.collect()
    # a sea with its surfaces takes 0.3 MB and more, so that each edit's would be seen
    assert resident() - before < max(0.1 * edits, 6.0) * MB


def resident():
    """Bytes of this process in memory."""
    words = Path("/proc/self/statm").read_text(encoding="ascii").split()
    return int(words[1]) * os.sysconf("SC_PAGE_SIZE")
