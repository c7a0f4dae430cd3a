# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels only draw: how much they do depends neither on the size of the file nor on disks."""

import json
import os
import sys
from collections import Counter
from contextlib import contextmanager
from pathlib import Path

import bpy
import numpy as np
import pytest

from .layouts import draw  # noqa: F401
from .test_bake_state import baked  # noqa: F401

#: what Python tells its audit hooks of files and folders
_OF_DISKS = ("open", "os.listdir", "os.scandir", "os.mkdir", "glob.glob")
_heard = []
_listening = False


def _hear(event, arguments):
    if _listening and event in _OF_DISKS:
        _heard.append((event, arguments[0]))


sys.addaudithook(_hear)  # there is no way to take it back


@contextmanager
def listening():
    global _listening
    _heard.clear()
    _listening = True
    try:
        yield _heard
    finally:
        _listening = False


def by_function(run):
    """How many lines of Python a call takes in each function, of whatever module."""
    counts = Counter()

    def trace(frame, event, _argument):
        counts[frame.f_code.co_qualname] += event == "line"
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        run()
    finally:
        sys.settrace(before)
    return counts


@pytest.fixture
def everything(extension, draw, ocean):  # noqa: F811
    """Draws every panel and menu text of an ocean, and asks each operator whether it may run."""
    bpy.ops.ocean.layer_add(kind="HERO_WAVE")
    bpy.ops.ocean.patch_add()
    classes = extension("registration").CLASSES
    operators = [each for each in classes if issubclass(each, bpy.types.Operator) and hasattr(each, "poll")]
    assert len(operators) > 30
    overlays = extension("ui.overlays")

    def run():
        drawn = draw(ocean)
        for operator in operators:
            operator.poll(bpy.context)
        overlays.trouble_lines(500.0)
        overlays.wind_lines(ocean, bpy.context.scene)
        overlays.coast_overlay.state_map(ocean, bpy.context.scene)
        return drawn

    return run


def add_objects(count):
    """Objects as a large scene has them: some with modifiers, most of them children of others."""
    parent = None
    for number in range(count):
        item = bpy.data.objects.new(f"Grass {number}", bpy.data.meshes.new("Grass"))
        bpy.context.scene.collection.objects.link(item)
        if number % 5 == 0:
            item.modifiers.new("Grass", "ARRAY")
        if number % 10 == 0:
            parent = item
        else:
            item.parent = parent
    bpy.context.view_layer.update()


def test_a_large_scene_takes_no_more_lines_than_a_small_one(everything):
    add_objects(20)
    everything()
    few = by_function(everything)
    add_objects(2000)
    assert len(bpy.data.objects) > 2000
    assert by_function(everything) == few
    assert few.total() > 1000


def test_what_panels_know_of_other_objects_follows_them(ocean, ocean_object, make_parameters, extension):
    needs, floating, scene = extension("scene.portability"), extension("scene.floating"), bpy.context.scene
    other = ocean_object.add(scene, make_parameters(seed=2), name="Lake")
    boat = bpy.data.objects.new("Boat", None)
    scene.collection.objects.link(boat)

    def names(item):
        bpy.context.view_layer.update()
        return {need.name for need in needs.neighbours_of(item).needs}

    assert names(ocean) == {ocean.name}
    carrier = floating.float_on(boat, ocean)
    assert names(ocean) == {ocean.name, "Boat"}
    floating.let_ride(carrier, other, floating.Ride())  # no object comes or goes
    assert (names(ocean), names(other)) == ({ocean.name}, {"Lake", "Boat"})
    floating.sink(boat)
    assert names(other) == {"Lake"}
    assert needs.has_ocean(scene)
    for item in (ocean, other):
        bpy.data.objects.remove(item)
    assert not needs.has_ocean(scene)


def test_no_folder_is_listed_and_no_file_read(everything, ocean):
    everything()
    with listening() as heard:
        everything()
    assert heard == []


def test_no_disk_is_asked_for_a_baked_ocean(draw, baked, monkeypatch):  # noqa: F811
    before, asked, stat = draw(baked), [], os.stat
    cache = baked.ocean_tweak.cache_folder

    def noted(path, *arguments, **named):
        if str(path).startswith(cache):
            asked.append(str(path))
        return stat(path, *arguments, **named)

    monkeypatch.setattr(os, "stat", noted)
    with listening() as heard:
        assert draw(baked) == before
        assert Path(cache).is_dir()
    assert (heard, asked) == ([], [cache])
    assert "use_bake" not in before  # the form has no use for it
    baked.ocean_tweak.usd.form = "displacement"
    assert "use_bake" in draw(baked)


def test_a_spectrum_is_drawn_beside_the_panel_and_the_last_one_only(extension, core, monkeypatch):
    previews, drawn = extension("ui.previews"), []
    pixels = np.zeros((previews.SIZE, previews.SIZE, 4), np.float32)
    monkeypatch.setattr(previews, "has_window", lambda: True)
    monkeypatch.setattr(previews, "spectrum_plot", lambda sea: drawn.append(sea.layers[0]) or pixels)
    layers = [core.WaveLayer(wind_speed=speed) for speed in (9.0, 9.5)]
    for layer in layers:
        previews.PREVIEWS.spectrum(core.OceanParameters(layers=(layer,)))
    assert drawn == []
    assert bpy.app.timers.is_registered(previews.draw_spectrum)
    previews.draw_spectrum()
    assert [layer.wind_speed for layer in drawn] == [9.5]
    bpy.app.timers.unregister(previews.draw_spectrum)


def test_texts_of_the_settings_are_parsed_once(everything, ocean, monkeypatch):
    everything()
    parsed = []
    loads = json.loads
    monkeypatch.setattr(json, "loads", lambda text, **named: parsed.append(text) or loads(text, **named))
    everything()
    assert parsed == []
    ocean.ocean_tweak.seed = 11
    parsed.clear()
    everything()
    assert parsed == [ocean.ocean_tweak.statistics]
