# SPDX-License-Identifier: GPL-3.0-or-later
"""A mask's object moved with the mouse and the keyboard: the calm goes along, and undo takes it back."""

import pytest

BEGIN = """
def post():
    '''x of the mask's object over the ocean, and of the mask, in whole units.'''
    item = next(item for item in bpy.data.objects if item.ocean_tweak.is_ocean)
    x = bpy.data.objects['Post'].matrix_world.translation.x - item.matrix_world.translation.x
    return [round(x), round(item.ocean_tweak.mask.x)]

def highest_around(x):
    '''Of the water within 15 units of a place over the ocean, in millimetres.'''
    mesh = evaluated_ocean()
    places = numpy.empty(3 * len(mesh.vertices), numpy.float32)
    mesh.vertices.foreach_get('co', places)
    places = places.reshape(-1, 3)
    near = numpy.hypot(places[:, 0] - x, places[:, 1] - MIDDLE) < 15.0
    return round(1000.0 * float(numpy.abs(places[near, 2]).max()))

with over('WINDOW'):
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    bpy.ops.mesh.ocean_tweak_add()
    settings = ocean()
    settings.use_foam, settings.viewport_resolution = False, 64
    MIDDLE = 0.5 * settings.domain_size
    bpy.ops.object.empty_add(location=(0.0, 0.0, 0.0))
    bpy.context.view_layer.objects.active.name = 'Post'
    mask = settings.mask
    mask.inner_radius, mask.outer_radius = 30.0, 60.0
    mask.object, mask.source = bpy.data.objects['Post'], 'DISTANCE'
    bpy.ops.ed.undo_push(message='a mask')
"""


@pytest.fixture
def masked(hand):
    """An ocean around the world's origin, calm around an empty that is selected there."""
    hand.ask(f"run({BEGIN!r})")
    hand.wait("is_refining()", False)
    return hand


def is_calm_at(hand, here, not_there):
    hand.wait("post()", [here, here])
    hand.wait("is_refining()", False)
    assert hand.wait(f"highest_around({here})", lambda height: height < 1) == 0
    assert hand.ask(f"highest_around({not_there})") > 100


def test_the_calm_goes_where_its_object_is_put(masked):
    hand = masked
    middle = round(hand.ask("MIDDLE"))
    is_calm_at(hand, middle, middle + 100)
    hand.to_viewport()
    hand.key("g", "x")
    hand.type("100")
    hand.key("Return")
    is_calm_at(hand, middle + 100, middle)
    hand.keep("mask-moved")
    hand.to_viewport()
    hand.key("ctrl+z")
    is_calm_at(hand, middle, middle + 100)
    hand.key("ctrl+shift+z")
    is_calm_at(hand, middle + 100, middle)


def test_the_calm_follows_while_it_is_pulled(masked):
    """Before the mouse lets go, of few samples; Esc puts it back."""
    hand = masked
    middle = round(hand.ask("MIDDLE"))
    hand.to_viewport()
    hand.key("g", "x")
    hand.type("100")
    hand.wait("post()", [middle + 100, middle + 100])
    assert hand.wait(f"highest_around({middle + 100})", lambda height: height < 1) == 0
    hand.key("Escape")
    is_calm_at(hand, middle, middle + 100)
