# SPDX-License-Identifier: GPL-3.0-or-later
"""Baking by hand: started, stopped with Esc, taken up again; then live and baked by turns."""

import pytest

#: more than any machine bakes before a hand has reached Esc, and how many more it bakes afterwards
NEVER_DONE, MORE = 100_000, 20
SOURCE = "ocean().source"


@pytest.fixture
def small_sea(hand, tmp_path):
    """A quick ocean in a saved file; returns the hand and where its cache is."""
    hand.press("mesh.ocean_tweak_add")
    hand.wait("len(oceans())", 1)
    hand.ask("run('ocean().resolution = ocean().viewport_resolution = 128')")
    hand.ask(f"run('bpy.context.scene.frame_end = {NEVER_DONE}')")
    hand.ask(f"save({str(tmp_path / 'shot.blend')!r})")
    return hand, tmp_path


def frames_of(folder):
    return list(folder.rglob("*_disp.*.exr"))


def test_bake_is_stopped_and_taken_up_again(small_sea):
    hand, folder = small_sea
    live = hand.ask("highest()")

    hand.press("ocean.bake(")
    hand.wait("baking() is not None and baking().done > 2")
    hand.keep("baking", moving=True)
    hand.to_viewport()
    hand.key("Escape")
    hand.wait("baking() is None")
    done = hand.ask("ocean().bake_done")
    assert 2 < done <= len(frames_of(folder)) < NEVER_DONE
    assert hand.ask(SOURCE) == "LIVE"
    hand.keep("bake-stopped")

    frames = len(frames_of(folder)) + MORE
    hand.ask(f"run('bpy.context.scene.frame_end = {frames}')")
    hand.press("ocean.bake(")
    hand.wait(SOURCE, "SEQUENCE", seconds=120.0)
    assert hand.ask("[ocean().bake_done, ocean().bake_total]") == [frames, frames]
    # the first bake may have ended its frames a moment after it was stopped, beyond these
    assert {int(file.suffixes[-2][1:]) for file in frames_of(folder)} >= set(range(1, frames + 1))
    # files hold metres to 2⁻¹⁶ of the value
    hand.wait("highest()", lambda baked: abs(baked - live) < 1e-3)
    hand.keep("baked")

    hand.choose("ocean_tweak.source", SOURCE, "LIVE")
    hand.wait("highest()", lambda now: abs(now - live) < 1e-5)
    hand.choose("ocean_tweak.source", SOURCE, "SEQUENCE")
    hand.to_viewport()
    hand.key("ctrl+z")
    hand.wait(SOURCE, "LIVE")
