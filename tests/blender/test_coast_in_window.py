# SPDX-License-Identifier: GPL-3.0-or-later
# ruff: noqa: F811 - fixtures of other modules
"""In a window the waves over a bed are computed beside it, with their progress; Esc shows the open sea."""

import threading
import time

import bpy
import numpy as np
import pytest

from .coasts import calm, coast_of, ocean, slope, values  # noqa: F401 - fixtures
from .test_refinement import refinement, run_until  # noqa: F401 - a fixture


@pytest.fixture
def held(extension, monkeypatch):
    """Waves over a bed stop half way until it is set; gives that and the threads that computed some."""
    allowed, threads = threading.Event(), []
    module = extension("core.sea.coast_waves")
    make = module.pictures

    def slow(sea, waves, ground, tell):
        threads.append(threading.current_thread())

        def told(share):
            tell(share)
            while share > 0.5 and not allowed.wait(0.01):
                tell(share)

        return make(sea, waves, ground, told)

    monkeypatch.setattr(module, "pictures", slow)
    monkeypatch.setattr(extension("core.numerics.memo").MEMO, "shelf", None)
    extension("core.numerics.memo").MEMO.drop()
    yield allowed, threads
    allowed.set()


def begin(extension, ocean):
    """What Make Coast begins with a window; gives what it waits for."""
    operators = extension("ui.coast_operators")
    return operators.OCEAN_OT_make_coast.begin(None, bpy.context)


def is_half_way(refinement, ocean):
    progress = refinement.progress_of(ocean)
    return progress is not None and progress.share > 0.5


def test_the_window_goes_on_and_sees_how_far_the_waves_are(extension, refinement, ocean, coast_of, held):
    allowed, threads = held
    ocean.ocean_tweak.coast.bed = slope()
    begin(extension, ocean)
    run_until(refinement, lambda: is_half_way(refinement, ocean))
    mesh = coast_of(ocean).data
    assert np.ptp(values(mesh, "position", 3)[:, 2]) == 0.0  # still water, meanwhile
    assert "waves over the bed" in refinement.progress_of(ocean).doing
    assert refinement.is_unfinished(ocean)
    bpy.context.scene.frame_set(7)  # which does not wait
    assert np.ptp(values(mesh, "position", 3)[:, 2]) == 0.0
    allowed.set()
    run_until(refinement, lambda: not refinement.is_unfinished(ocean))
    assert np.ptp(values(coast_of(ocean).data, "position", 3)[:, 2]) > 0.5
    assert threading.main_thread() not in threads
    assert len(threads) == 1


def test_a_change_ends_what_is_computed_for_the_sea_before(
    extension, refinement, ocean, coast_of, held, core
):
    allowed, threads = held
    ocean.ocean_tweak.coast.bed = slope()
    begin(extension, ocean)
    run_until(refinement, lambda: is_half_way(refinement, ocean))
    ocean.ocean_tweak.seed = 12
    run_until(refinement, lambda: len(threads) == 2)  # though the first was not allowed to end
    allowed.set()
    run_until(refinement, lambda: not refinement.is_unfinished(ocean))
    mesh = coast_of(ocean).data
    moved = values(mesh, "displacement", 3)
    rest = (values(mesh, "position", 3) - moved)[:, :2].astype(np.float64)
    sea = core.Ocean(ocean.ocean_tweak.to_parameters(bpy.context.scene))
    assert sea.parameters.seed == 12
    expected = sea.frame(bpy.context.scene.frame_current, on=core.Places(rest[:, 0], rest[:, 1]))
    np.testing.assert_allclose(moved, expected.displacement, atol=2e-3)


def test_given_up_it_is_the_open_sea(extension, refinement, ocean, coast_of, held):
    allowed, threads = held
    ocean.ocean_tweak.coast.bed = slope()
    work = begin(extension, ocean)
    assert work.done == 0
    run_until(refinement, lambda: is_half_way(refinement, ocean))
    assert 50 <= work.done < work.steps
    work.cancel()
    run_until(refinement, lambda: not refinement.is_unfinished(ocean))
    assert coast_of(ocean) is None
    assert work.done == work.steps
    assert not allowed.is_set()
    assert len(threads) == 1
    assert not ocean.hide_render
    # and once more
    ocean.ocean_tweak.coast.muted = False
    allowed.set()
    run_until(refinement, lambda: not refinement.is_unfinished(ocean))
    assert np.ptp(values(coast_of(ocean).data, "position", 3)[:, 2]) > 0.5


def test_a_render_does_not_wait(extension, refinement, ocean, coast_of, held):
    allowed, _ = held
    ocean.ocean_tweak.coast.bed = slope()
    begin(extension, ocean)
    run_until(refinement, lambda: is_half_way(refinement, ocean))
    threading.Timer(0.2, allowed.set).start()
    asked = time.monotonic()
    extension("scene.refinement").show(ocean, bpy.context.scene, extension("scene.refresh").Wanted.RENDER)
    assert time.monotonic() - asked < 30.0
    assert np.ptp(values(coast_of(ocean).data, "position", 3)[:, 2]) > 0.5
    run_until(refinement, lambda: not refinement.is_unfinished(ocean))
