# SPDX-License-Identifier: GPL-3.0-or-later
"""Rendering from the window: Blender does it on a thread of its own while the window goes on."""

import itertools

import numpy as np
import pytest
from PIL import Image

# Debian's Blender has no denoiser
QUICK = (
    "scene = bpy.context.scene; scene.cycles.samples = 2; scene.cycles.use_denoising = False; "
    "scene.render.resolution_percentage = 10; ocean().resolution = ocean().viewport_resolution = 128; "
)


@pytest.fixture
def scene(hand):
    """The scene of one click, quick to render."""
    hand.press("ocean.add_scene(")
    hand.wait("len(oceans())", 1)
    hand.keep("ocean-scene")
    hand.ask(f"run({QUICK!r})")
    hand.ask("happenings.seen.clear()")
    return hand


def rendered(hand):
    """Wait for a render to end; return the names of the handlers that were called."""
    hand.wait("[name for name, *_ in happenings.seen]", lambda names: "render_init" in names)
    ended = "[name for name, *_ in happenings.seen if name in ('render_complete', 'render_cancel')]"
    assert hand.wait(ended, lambda names: len(names) == 1, seconds=300.0) == ["render_complete"]
    hand.wait("bpy.app.is_job_running('RENDER')", False)
    return hand.ask("happenings.seen")


def test_ocean_scene_renders_from_the_window(scene, tmp_path):
    hand = scene
    hand.to_viewport()
    hand.key("F12")
    seen = rendered(hand)
    assert all(is_locked for _, _, is_locked in seen)
    assert "render_post" in [name for name, in_window, _ in seen if not in_window], "no thread of its own"
    file = tmp_path / "frame.png"
    hand.ask(f"bpy.data.images['Render Result'].save_render({str(file)!r})")
    picture = np.asarray(Image.open(file).convert("RGB"), float)
    assert picture.std() > 5.0, "the frame is empty"
    hand.keep("rendered")


def test_animation_renders_from_the_window(scene, tmp_path):
    hand = scene
    wishes = f"scene.frame_start, scene.frame_end = 1, 2; scene.render.filepath = {str(tmp_path / 'frame')!r}"
    hand.ask(f"run({'scene = bpy.context.scene; ' + wishes!r})")
    hand.to_viewport()
    hand.key("ctrl+F12")
    seen = rendered(hand)
    # the sea of each frame is made on the render's thread, and no two frames are alike
    assert ["frame_change_pre", False, True] in seen
    pictures = [np.asarray(Image.open(file).convert("RGB"), float) for file in sorted(tmp_path.glob("*.png"))]
    assert len(pictures) == 2
    assert all(abs(first - second).max() > 10 for first, second in itertools.pairwise(pictures))
