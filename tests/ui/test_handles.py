# SPDX-License-Identifier: GPL-3.0-or-later
"""The handles in the 3D view, pulled with the mouse; undo and redo take each as one step."""

import math

import pytest

FRAMED = """
import mathutils
from bpy_extras import view3d_utils

def on_screen(place):
    '''x and y (from the top) in the window of a place in the world.'''
    found = view3d_utils.location_3d_to_region_2d(region('WINDOW'), area().spaces.active.region_3d, place)
    left, top, width, height = box('WINDOW')
    return left + found.x, top + height - found.y

def handle(name):
    item = bpy.context.view_layer.objects.active
    made = extension('ui.gizmos').HANDLES[name]
    value = made.read(item)
    offset = mathutils.Vector(value if name == 'focus' else (0.0, 0.0, value))
    return on_screen(made.place(item) @ offset)

with over('WINDOW'):
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    bpy.ops.mesh.ocean_tweak_add()
    item = bpy.context.view_layer.objects.active
    item.location = (-200.0, -200.0, 0.0)
    settings = ocean()
    settings.use_foam, settings.viewport_resolution = False, 32
    view = area().spaces.active.region_3d
    view.view_perspective, view.view_distance = 'ORTHO', 700.0
    view.view_rotation, view.view_location = (1.0, 0.0, 0.0, 0.0), (60.0, 0.0, 0.0)
    bpy.ops.ed.undo_push(message='framed')
"""


@pytest.fixture
def framed(hand):
    """An ocean of 400 m around the world's origin, seen from above."""
    hand.ask(f"run({FRAMED!r})")
    hand.wait("len(oceans())", 1)
    hand.wait("is_refining()", False)
    hand.settle(4)
    return hand


def pull(hand, name, right, down=0, beside=(0, 0)):
    """Drag a handle, seen from above: up in the window is y."""
    x, y = hand.ask(f"handle({name!r})")
    hand.to_viewport()
    hand.drag_from(x + beside[0], y + beside[1], right, down)
    hand.wait("is_refining()", False)


def add_hero_wave(hand):
    """As one step of undo."""
    add = "bpy.ops.ocean.layer_add(kind='HERO_WAVE'); bpy.ops.ed.undo_push(message='added')"
    command = f"with over('WINDOW'): {add}"
    hand.ask(f"run({command!r})")


def undone_and_redone(hand, expression, before):
    after = hand.ask(expression)
    hand.to_viewport()
    hand.key("ctrl+z")
    hand.wait(expression, lambda value: value == pytest.approx(before))
    hand.key("ctrl+shift+z")
    hand.wait(expression, lambda value: value == pytest.approx(after))


def test_the_size_follows_the_mouse(framed):
    framed.keep("handles")
    pull(framed, "size", right=60, beside=(6, 0))
    size = framed.wait("ocean().domain_size", lambda size: size > 420.0)
    assert size < 800.0
    undone_and_redone(framed, "ocean().domain_size", 400.0)


def test_the_wind_turns_and_blows_harder(framed):
    pull(framed, "speed", right=40, beside=(6, 0))
    speed = framed.wait("ocean().layers[0].wind_speed", lambda speed: speed > 13.0)
    assert speed < 40.0
    undone_and_redone(framed, "ocean().layers[0].wind_speed", 12.0)


def test_the_wind_turns_with_the_dial(framed):
    """Its circle is gripped a sixth of a turn from the wind's direction, where no arrow is."""
    wind = "ocean().layers[0].wind_direction"
    before = framed.ask(wind)
    x, y = framed.ask("on_screen(extension('ui.gizmos').HANDLES['direction'].place(item).translation)")
    radius = framed.ask("bpy.context.preferences.view.gizmo_size * bpy.context.preferences.system.ui_scale")
    grip, turn = before + math.pi / 3.0, math.pi / 6.0
    (a, b), (c, d) = ((radius * math.cos(angle), -radius * math.sin(angle)) for angle in (grip, grip + turn))
    framed.to_viewport()
    framed.drag_from(x + a, y + b, c - a, d - b)
    framed.wait(wind, lambda value: abs(value - before - turn) < math.radians(8.0))
    undone_and_redone(framed, wind, before)


def test_a_hero_wave_becomes_longer(framed):
    add_hero_wave(framed)
    wave = "ocean().layers[ocean().active_layer].hero_wave"
    framed.ask(f"setattr({wave}, 'direction', 0.0)")
    framed.wait("is_refining()", False)
    before = framed.ask(f"{wave}.wavelength")
    pull(framed, "wavelength", right=50, beside=(6, 0))
    framed.wait(f"{wave}.wavelength", lambda value: value > before + 20.0)
    undone_and_redone(framed, f"{wave}.wavelength", before)


def test_a_hero_wave_is_put_where_it_shall_be(framed):
    add_hero_wave(framed)
    wave = "ocean().layers[ocean().active_layer].hero_wave"
    before = framed.ask(f"{wave}.x")
    framed.wait("is_refining()", False)
    pull(framed, "focus", right=-50, down=-30)
    framed.wait(f"{wave}.x", lambda x: x < before - 10.0)
    framed.keep("handles-hero")
    undone_and_redone(framed, f"{wave}.x", before)
