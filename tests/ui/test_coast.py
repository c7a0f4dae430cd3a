# SPDX-License-Identifier: GPL-3.0-or-later
"""A coast in a window: its waves are computed beside it, Esc shows the open sea, overlays are drawn."""

import numpy as np
import pytest

LAND = """
with over('WINDOW'):
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    bpy.ops.mesh.ocean_tweak_add()
    ocean().use_foam, ocean().viewport_resolution = False, 64
    side = ocean().domain_size
    places = [(x, y, -12.0 + 13.0 * x / side) for x in (0.0, side) for y in (0.0, side)]
    mesh = bpy.data.meshes.new('Land')
    mesh.from_pydata(places, [], [(0, 2, 3, 1)])
    land = bpy.data.objects.new('Land', mesh)
    land.location = bpy.context.object.location
    bpy.context.scene.collection.objects.link(land)
    ocean().coast.bed = land
    area().spaces.active.show_gizmo = False
    view = area().spaces.active.region_3d
    view.view_perspective, view.view_distance = 'ORTHO', 2.2 * side
    view.view_rotation, view.view_location = (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
"""
MAKE = "with over('WINDOW'): bpy.ops.ocean.make_coast('INVOKE_DEFAULT', True)"
MAKING = "any(each.bl_idname == 'OCEAN_OT_make_coast' for each in window().modal_operators)"
COAST = "'Ocean Coast' in bpy.data.objects"
HIGHEST = (
    "(lambda mesh: max((vertex.co.z for vertex in mesh.vertices), default=0.0))"
    "(bpy.data.objects['Ocean Coast'].data)"
)


@pytest.fixture
def land(hand):
    """An ocean, and a mesh that slopes out of it; the mouse is over the 3D view."""
    hand.ask(f"run({LAND!r})")
    hand.wait("is_refining()", False)
    hand.to_viewport()
    return hand


def seen(hand, name):
    """(rows, columns, 3) colors of the view."""
    picture = np.asarray(hand.keep(name), float) / 255.0
    left, top, width, height = (int(part) for part in hand.ask("box('WINDOW')"))
    return picture[top : top + height, left : left + width]


def test_esc_shows_the_open_sea_and_the_next_press_the_coast(land):
    hand = land
    hand.ask(f"run({MAKE!r})")
    assert hand.ask(MAKING)
    hand.key("Escape")
    hand.wait(MAKING, False)
    assert hand.ask("ocean().coast.muted")
    hand.wait("is_refining()", False)
    assert not hand.ask(COAST)
    hand.ask(f"run({MAKE!r})")
    hand.wait(MAKING, False)
    assert not hand.ask("ocean().coast.muted")
    assert hand.ask(HIGHEST) > 0.1


def test_the_overlays_are_drawn_over_water_and_go_with_their_switches(land):
    hand = land
    hand.ask(f"run({MAKE!r})")
    hand.wait(MAKING, False)
    hand.wait("is_refining()", False)
    plain = seen(hand, "coast")
    hand.ask("setattr(ocean().coast, 'show_height', True)")
    mapped = seen(hand, "coast-height")
    changed = np.abs(mapped - plain).max(axis=-1) > 0.05
    assert 0.1 < changed.mean() < 0.95
    hand.ask("setattr(ocean().coast, 'show_direction', True)")
    arrows = np.abs(seen(hand, "coast-direction") - mapped).max(axis=-1) > 0.05
    assert 0.002 < arrows.mean() < 0.2
    hand.ask("run('ocean().coast.show_height = ocean().coast.show_direction = False')")
    assert (np.abs(seen(hand, "coast-again") - plain).max(axis=-1) > 0.05).mean() < 0.01
