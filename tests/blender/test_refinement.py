# SPDX-License-Identifier: GPL-3.0-or-later
"""In a window a changed setting shows at once with few samples, then with all. The tests are the clock."""

import json
import threading
import time

import addon_utils
import bpy
import numpy as np
import pytest

from .conftest import SAMPLES, evaluated_mesh
from .layouts import draw  # noqa: F401
from .surfaces import read

TOLERANCE = 1e-4  # m
COARSE = 16


@pytest.fixture
def refinement(extension, monkeypatch):
    """Refinement as with a window, and without the pause. A new file must leave no timer."""
    module = extension("scene.refinement")
    monkeypatch.setattr(module, "has_window", lambda: True)
    monkeypatch.setattr(module, "PAUSE", 0.0)
    monkeypatch.setattr(extension("scene.plan"), "COARSE", COARSE)
    yield module
    bpy.ops.wm.read_homefile(use_empty=True)
    assert not bpy.app.timers.is_registered(module.go_on)


@pytest.fixture
def item(ocean_object, make_parameters, empty_scene, refinement):
    return ocean_object.add(empty_scene, make_parameters())


def run_until(refinement, done):
    """Let the timer work until something is done; returns how long it wanted to wait last."""
    deadline = time.monotonic() + 60.0
    wait = refinement.go_on()
    while not done():
        assert time.monotonic() < deadline
        time.sleep(0.01)
        wait = refinement.go_on()
    return wait


@pytest.fixture
def counting_allowed(extension, monkeypatch):
    """Statistics are made only when this is set, however quick the thread is."""
    allowed, module = threading.Event(), extension("scene.evaluation")
    count = module.computed_statistics

    def count_when_allowed(parameters):
        assert allowed.wait(60.0)
        return count(parameters)

    monkeypatch.setattr(module, "computed_statistics", count_when_allowed)
    yield allowed
    allowed.set()


@pytest.mark.parametrize("method", ["NODES", "DISPLACE"])
def test_few_samples_then_all_then_the_statistics(
    item, refinement, core, make_parameters, expected, evaluated, counting_allowed, method
):
    item.ocean_tweak.method = method
    counting_allowed.set()
    run_until(refinement, lambda: not refinement.is_outstanding(item))
    counting_allowed.clear()
    bpy.app.timers.unregister(refinement.go_on)  # as Blender does with a timer that wants no next time
    before = item.ocean_tweak.statistics
    item.ocean_tweak.seed = 9
    assert bpy.app.timers.is_registered(refinement.go_on)
    assert refinement.is_unfinished(item)
    sea = make_parameters(seed=9)
    shown = evaluated(item)
    assert shown.shape == (SAMPLES + 1, SAMPLES + 1, 3)
    few = expected(sea.replace(resolution=COARSE), 1)
    np.testing.assert_allclose(shown[::2, ::2], few, atol=TOLERANCE)
    np.testing.assert_allclose(shown[::2, 1::2], (few[:, :-1] + few[:, 1:]) / 2, atol=TOLERANCE)
    np.testing.assert_allclose(shown[1::2, ::2], (few[:-1] + few[1:]) / 2, atol=TOLERANCE)
    assert item.ocean_tweak.statistics == before
    assert run_until(refinement, lambda: not refinement.is_unfinished(item)) is not None
    np.testing.assert_allclose(evaluated(item), expected(sea, 1), atol=TOLERANCE)
    assert refinement.is_outstanding(item)
    counting_allowed.set()
    assert run_until(refinement, lambda: not refinement.is_outstanding(item)) is None
    statistics = core.Ocean(sea).statistics().to_dict()
    assert item.ocean_tweak.statistics == json.dumps(statistics) != before


def test_the_waves_of_all_samples_are_made_beside_the_window(item, refinement, extension, monkeypatch):
    run_until(refinement, lambda: not refinement.is_outstanding(item))
    module, made = extension("core.sea.part_waves"), []
    make = module.initial_state

    def noted(parameters, *arguments):
        made.append((parameters.resolution, threading.current_thread() is threading.main_thread()))
        return make(parameters, *arguments)

    monkeypatch.setattr(module, "initial_state", noted)
    item.ocean_tweak.seed = 11
    run_until(refinement, lambda: not refinement.is_outstanding(item))
    assert (COARSE, True) in made  # what is shown at once
    assert [in_window for resolution, in_window in made if resolution == SAMPLES] == [False]


def test_every_change_puts_it_off(item, refinement, monkeypatch, make_parameters, expected, evaluated):
    monkeypatch.setattr(refinement, "PAUSE", 3600.0)
    for seed in (3, 4):
        item.ocean_tweak.seed = seed
        refinement.go_on()
        few = expected(make_parameters(seed=seed, resolution=COARSE), 1)
        np.testing.assert_allclose(evaluated(item)[::2, ::2], few, atol=TOLERANCE)
    bpy.context.scene.frame_set(3)
    few = expected(make_parameters(seed=4, resolution=COARSE), 3)
    np.testing.assert_allclose(evaluated(item)[::2, ::2], few, atol=TOLERANCE)


def test_a_render_does_not_wait(item, refinement, make_parameters, expected, tmp_path):
    item.ocean_tweak.seed = 9
    file = tmp_path / "sea.obj"
    bpy.ops.wm.obj_export(
        filepath=str(file), export_eval_mode="DAG_EVAL_RENDER", forward_axis="Y", up_axis="Z"
    )
    lines = [line.split()[1:4] for line in file.read_text().splitlines() if line.startswith("v ")]
    vertices = np.array(lines, float).reshape(SAMPLES + 1, SAMPLES + 1, 3)
    np.testing.assert_allclose(vertices, expected(make_parameters(seed=9), 1), atol=TOLERANCE)


def test_statistics_of_a_sea_that_has_changed_again_are_not_shown(item, refinement, core, make_parameters):
    item.ocean_tweak.seed = 3
    refinement.go_on()
    item.ocean_tweak.seed = 4
    run_until(refinement, lambda: not refinement.is_outstanding(item))
    wanted = core.Ocean(make_parameters(seed=4)).statistics().to_dict()
    assert item.ocean_tweak.statistics == json.dumps(wanted)


def test_the_panel_says_that_it_is_not_all_yet(item, refinement, draw):  # noqa: F811
    run_until(refinement, lambda: not refinement.is_outstanding(item))
    drawn = draw(item)
    assert "Refining…" not in drawn
    item.ocean_tweak.seed = 3
    assert draw(item).count("Refining…") == 1
    assert len(draw(item)) == len(drawn)  # no row moves
    run_until(refinement, lambda: not refinement.is_outstanding(item))
    assert "Refining…" not in draw(item)


def test_what_is_wrong_is_told_and_nothing_goes_on(item, refinement, core, monkeypatch):
    item.ocean_tweak.resolution = 33
    assert "resolution = 33" in item.ocean_tweak.error
    assert run_until(refinement, lambda: not refinement.is_outstanding(item)) is None
    monkeypatch.setattr(core.Ocean, "statistics", lambda self: (_ for _ in ()).throw(MemoryError))
    item.ocean_tweak.resolution = 34
    assert item.ocean_tweak.error == ""
    run_until(refinement, lambda: not refinement.is_outstanding(item))
    assert "memory" in item.ocean_tweak.error


def test_removed_or_undone_meanwhile(item, refinement, window, make_parameters, expected, evaluated):
    with window.override():
        bpy.ops.ed.undo_push(message="added")
        item.ocean_tweak.seed = 3
        bpy.ops.ed.undo_push(message="changed")
        bpy.ops.ed.undo()
    item = bpy.data.objects["Ocean"]
    run_until(refinement, lambda: not refinement.is_outstanding(item))
    np.testing.assert_allclose(evaluated(item), expected(make_parameters(), 1), atol=TOLERANCE)
    item.ocean_tweak.seed = 5
    bpy.data.objects.remove(item)
    assert refinement.go_on() is None


def test_disabling_takes_the_timer_away(item, refinement, package):
    item.ocean_tweak.seed = 3
    refinement.go_on()  # the thread has work too
    addon_utils.disable(package)
    left = bpy.app.timers.is_registered(refinement.go_on)
    assert addon_utils.enable(package) is not None
    assert not left


def test_without_a_window_all_is_done_at_once(
    ocean_object, make_parameters, empty_scene, extension, core, expected, evaluated
):
    item = ocean_object.add(empty_scene, make_parameters())
    item.ocean_tweak.seed = 3
    refinement = extension("scene.refinement")
    assert not bpy.app.timers.is_registered(refinement.go_on)
    assert not refinement.is_outstanding(item)
    sea = make_parameters(seed=3)
    np.testing.assert_allclose(evaluated(item), expected(sea, 1), atol=TOLERANCE)
    assert item.ocean_tweak.statistics == json.dumps(core.Ocean(sea).statistics().to_dict())


def foam_of(item):
    """(N, N) foam of the mesh, the far edges left out."""
    return read(evaluated_mesh(item), SAMPLES + 1, SAMPLES + 1)["foam"][:-1, :-1, 0]


def finish(refinement, item):
    run_until(refinement, lambda: not refinement.is_outstanding(item))


@pytest.mark.parametrize("method", ["NODES", "DISPLACE"])
def test_foam_after_a_jump_is_that_of_the_moment_then_all(item, refinement, core, make_parameters, method):
    item.ocean_tweak.method = method
    finish(refinement, item)
    parameters = make_parameters()
    whole = core.Ocean(parameters).frame(100, {"foam", "cusp"})
    bpy.context.scene.frame_set(100)
    assert refinement.is_outstanding(item)
    instant = foam_of(item)
    # as much of the sea as foam covers, where it is compressed most
    covered = round(core.foam.threshold.foam_outlook(parameters).coverage * SAMPLES**2)
    assert covered > 3
    assert np.count_nonzero(instant >= 0.5) == covered
    assert whole.cusp[instant >= 0.5].min() > whole.cusp[instant < 0.5].max()
    finish(refinement, item)
    np.testing.assert_allclose(foam_of(item), whole.foam, atol=1e-6)
    assert np.abs(instant - whole.foam).max() > 0.1


def test_foam_is_complete_where_time_goes_on(item, refinement, core, make_parameters):
    finish(refinement, item)
    ocean = core.Ocean(make_parameters())
    for frame in (2, 3, 5):
        bpy.context.scene.frame_set(frame)
        assert not refinement.is_outstanding(item)
        np.testing.assert_allclose(foam_of(item), ocean.frame(frame, {"foam"}).foam, atol=1e-6)
    bpy.context.scene.frame_set(4)  # a step back is a jump
    assert refinement.is_outstanding(item)


def test_a_render_has_foam_with_its_history(item, refinement, core, make_parameters, rendering):
    finish(refinement, item)
    bpy.context.scene.frame_set(100)
    (found,) = rendering(lambda mesh: read(mesh, SAMPLES + 1, SAMPLES + 1)["foam"][:-1, :-1, 0]).values()
    wanted = core.Ocean(make_parameters()).frame(100, {"foam"}).foam
    np.testing.assert_allclose(found, wanted, atol=1e-6)


def test_foam_that_cannot_be_made_is_told(item, refinement, core, monkeypatch):
    finish(refinement, item)
    monkeypatch.setattr(
        core.foam.model.FoamHistory, "whitecaps", lambda *a: (_ for _ in ()).throw(MemoryError)
    )
    bpy.context.scene.frame_set(100)
    finish(refinement, item)
    assert "memory" in item.ocean_tweak.error
