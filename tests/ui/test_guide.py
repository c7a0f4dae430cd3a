# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/first-sea.md, followed step by step in a profile in which the extension was never installed.

The pictures that it keeps are the ones in the guide: `make guide` makes them small and puts them there.
"""

import os
import re

import numpy as np
import pytest
from PIL import Image

from tests.ui.conftest import opened_window
from tools import build, run_tests
from tools.guide import GUIDE, pictures_of

TEXT = GUIDE.read_text(encoding="utf-8")
STEPS = re.findall(r"^## \d+\. (.+)$", TEXT, re.MULTILINE)
WIND, DEPTH = "ocean().layers[0].wind_speed", "ocean().water.depth"
# Debian's Blender has no denoiser, and a processor renders the picture
QUICK = (
    "scene = bpy.context.scene; scene.cycles.samples = {samples}; scene.cycles.use_denoising = False; "
    "scene.render.resolution_percentage = {percentage}; scene.frame_end = 3; "
    "ocean().resolution = ocean().viewport_resolution = {samples_a_side}"
)
FINE = {"samples": 24, "percentage": 25, "samples_a_side": 256}
COARSE = {"samples": 2, "percentage": 10, "samples_a_side": 128}


@pytest.fixture
def newcomer(blender, tmp_path):
    """A hand on a Blender that does not know the extension, and the zip."""
    environment = run_tests.test_environment("guide")
    zip_file = os.environ.get("OCEAN_TWEAK_ZIP") or str(build.build(blender))
    with opened_window(blender, environment) as hand:
        yield hand, zip_file


def test_the_guide(newcomer, tmp_path):
    hand, zip_file = newcomer
    done = []
    for title, follow in zip(STEPS, HOW, strict=True):
        follow(hand, zip_file, tmp_path)
        done.append(title)
    assert done == STEPS
    assert [name for name in hand.kept if name.startswith("first-sea")] == pictures_of(TEXT)


def install(hand, zip_file, _folder):
    assert not hand.ask("hasattr(bpy.types.Object, 'ocean_tweak')")
    # what Blender itself does when the zip is dropped into its window
    hand.ask(f"install({zip_file!r})")
    hand.wait("hasattr(bpy.types.Object, 'ocean_tweak')")


def open_tab(hand, _zip, _folder):
    hand.open_sidebar()
    hand.keep("first-sea-tab")


def add_scene(hand, _zip, _folder):
    hand.press("ocean.add_scene(")
    hand.wait("len(oceans())", 1)
    assert not hand.ask("'Cube' in bpy.data.objects")
    hand.wait("area().spaces.active.region_3d.view_perspective", "CAMERA")
    fine = os.environ.get("OCEAN_TWEAK_FINE_PICTURES")
    hand.ask(f"run({QUICK.format(**FINE if fine else COARSE)!r})")
    hand.keep("first-sea-scene")


def turn_up_the_wind(hand, _zip, _folder):
    before, height = hand.ask(WIND), hand.ask("highest()")
    hand.drag("layers[0].wind_speed", right=60)
    hand.wait(WIND, lambda speed: speed > before)
    hand.keep("first-sea-wind")
    assert hand.ask("highest()") > height


def set_the_depth(hand, _zip, _folder):
    hand.enter("water.depth", "35")
    hand.wait(DEPTH, 35.0)


def take_a_preset(hand, _zip, _folder):
    before = hand.ask(WIND)
    hand.open_menu("OCEAN_MT_presets", beside="ocean.match_sea_state")
    hand.keep("first-sea-presets")
    hand.pick('ocean.apply_preset(key="gale")')
    hand.wait(WIND, lambda speed: speed != before)


def change_the_foam(hand, _zip, _folder):
    hand.open_panel("ocean_tweak.use_foam", "OCEAN_PT_foam")
    hand.enter("foam.coverage", "0.5")
    hand.wait("ocean().foam.coverage", 0.5)
    hand.keep("first-sea-foam")


def save_the_file(hand, _zip, folder):
    # the same operator asks for a name in a file browser first
    hand.ask(f"save({str(folder / 'sea.blend')!r})")
    hand.wait("bpy.data.is_saved")


def bake(hand, _zip, folder):
    hand.press("ocean.bake(")
    hand.wait("baking() is None or baking().done >= 1")
    hand.keep("first-sea-bake", moving=True)
    hand.wait("ocean().source", "SEQUENCE", seconds=240.0)
    assert len(list((folder / "cache").rglob("*_disp.*.exr"))) == 3


def render(hand, _zip, folder):
    hand.ask("happenings.seen.clear()")
    hand.to_viewport()
    hand.key("F12")
    ended = "[name for name, *_ in happenings.seen if name in ('render_complete', 'render_cancel')]"
    hand.wait(ended, ["render_complete"], seconds=1200.0)
    file = folder / "frame.png"
    hand.ask(f"bpy.data.images['Render Result'].save_render({str(file)!r})")
    picture = np.asarray(Image.open(file).convert("RGB"), float)
    assert picture.std() > 5.0, "the frame is empty"
    hand.keep("first-sea-render")


HOW = (
    install, open_tab, add_scene, turn_up_the_wind, set_the_depth, take_a_preset, change_the_foam,
    save_the_file, bake, render,
)  # fmt: skip
