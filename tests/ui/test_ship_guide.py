# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/ship.md, followed step by step; the pictures that it keeps are the ones in the page.

What lies outside of the sidebar and the 3D view, in a file browser or in properties of Blender's own, is set
as Blender sets it.
"""

import os
import re

import numpy as np
from PIL import Image

from tools.guide import SHIP, pictures_of

TEXT = SHIP.read_text(encoding="utf-8")
STEPS = re.findall(r"^## \d+\. (.+)$", TEXT, re.MULTILINE)
WIND = "ocean().layers[0].wind_speed"
BOAT = "bpy.data.objects['Fishing Boat']"
# Debian's Blender has no denoiser, and a processor draws the window and renders the picture
QUICK = """
scene = bpy.context.scene
scene.cycles.samples, scene.cycles.use_denoising = {samples}, False
scene.render.resolution_percentage = {percentage}
ocean().viewport_resolution = 64
for patch in ocean().patches:
    patch.resolution = {patch}
item = next(item for item in bpy.data.objects if item.ocean_tweak.is_ocean)
surface = extension('scene.plan').camera_surface_of(item)
modifier = extension('scene.plan').surface_modifier(surface)
extension('nodes.modifier_inputs').set_inputs(modifier, {{'Vertex Budget': {vertices}}})
surface.update_tag()
"""
SELECT = f"""
for item in bpy.context.scene.objects:
    item.select_set(item == {BOAT})
bpy.context.view_layer.objects.active = {BOAT}
"""
FINE = {"samples": 32, "percentage": 25, "patch": 384, "vertices": 100_000}
COARSE = {"samples": 2, "percentage": 10, "patch": 64, "vertices": 10_000}


def test_the_page(hand, tmp_path):
    done = []
    for title, follow in zip(STEPS, HOW, strict=True):
        follow(hand, tmp_path)
        done.append(title)
    assert done == STEPS
    assert [name for name in hand.kept if name.startswith("ship")] == pictures_of(TEXT)


def open_tab(hand, _folder):
    hand.open_sidebar()
    hand.wait("len(oceans())", 0)


def press_storm(hand, _folder):
    hand.press("ocean.add_scene(mood='STORM'")
    hand.wait("len(oceans())", 1)
    hand.ask(f"run({QUICK.format(**FINE if os.environ.get('OCEAN_TWEAK_FINE_PICTURES') else COARSE)!r})")
    hand.wait("area().spaces.active.region_3d.view_perspective", "CAMERA")
    assert hand.ask(f"{BOAT}.name")
    hand.to_viewport()
    hand.wait("is_refining()", False, seconds=400.0)
    hand.keep("ship-scene")


def choose_the_wind(hand, _folder):
    hand.enter("layers[0].wind_speed", "28")
    hand.wait(WIND, 28.0)


def whiten_the_water(hand, _folder):
    hand.open_panel("ocean_tweak.use_foam", "OCEAN_PT_foam")
    hand.enter("foam.coverage", "4")
    hand.wait("ocean().foam.coverage", 4.0)


def put_the_ship(hand, _folder):
    hand.ask(f"run({SELECT!r})")
    before = hand.ask(f"{BOAT}.location.x")
    hand.to_viewport()
    hand.key("g", "x")
    hand.type("6")
    hand.key("Return")
    hand.wait(f"round({BOAT}.location.x - {before}, 3)", 6.0)
    # it stands on the water there
    hand.wait(f"round({BOAT}.matrix_world.translation.x - {before}, 1)", 6.0)
    hand.wait("is_refining()", False, seconds=400.0)
    hand.keep("ship-place")


def turn_it(hand, _folder):
    before = hand.ask(f"{BOAT}.rotation_euler.z")
    hand.to_viewport()
    hand.key("r", "z")
    hand.type("20")
    hand.key("Return")
    hand.wait(f"round({BOAT}.rotation_euler.z - {before}, 3)", lambda turn: abs(abs(turn) - 0.349) < 2e-3)


def ride_as_a_ship(hand, _folder):
    hand.ask("run(\"with over('WINDOW'): bpy.ops.object.ocean_tweak_float(ride='SHIP')\")")
    ride = f"extension('scene.floating').ride_of(extension('scene.floating').carrier_of({BOAT}))[1]"
    hand.wait(f"{ride}.tilt", lambda tilt: 0.0 < tilt < 1.0)
    assert hand.ask(f"{ride}.waterline") > 10.0  # of a boat of 15 m


def make_it_dusk(hand, _folder):
    hand.ask(
        "run('view = bpy.context.scene.view_settings\\nview.exposure = -1.0\\n"
        "view.use_white_balance = True\\nview.white_balance_temperature = 5200.0')"
    )


def save_the_file(hand, folder):
    hand.ask(f"save({str(folder / 'ship.blend')!r})")
    hand.wait("bpy.data.is_saved")


def render(hand, folder):
    hand.ask("happenings.seen.clear()")
    hand.to_viewport()
    hand.key("F12")
    ended = "[name for name, *_ in happenings.seen if name in ('render_complete', 'render_cancel')]"
    hand.wait(ended, ["render_complete"], seconds=1200.0)
    file = folder / "frame.png"
    hand.ask(f"bpy.data.images['Render Result'].save_render({str(file)!r})")
    picture = np.asarray(Image.open(file).convert("RGB"), float)
    assert picture.std() > 5.0, "the frame is empty"
    assert picture.mean() < 110.0, "it is not dusk"
    hand.keep("ship-render")


HOW = (
    open_tab, press_storm, choose_the_wind, whiten_the_water, put_the_ship, turn_it, ride_as_a_ship,
    make_it_dusk, save_the_file, render,
)  # fmt: skip
