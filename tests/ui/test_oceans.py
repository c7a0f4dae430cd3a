# SPDX-License-Identifier: GPL-3.0-or-later
"""The ocean is always at hand: a list and a pin where there are several, and what was made for a deleted one
goes with it. Undo and redo take each as one step."""

TWO = """
def shown():
    with over():
        return extension('ui.active_ocean').shown_ocean(bpy.context).name

with over('WINDOW'):
    for number in range(2):
        bpy.ops.mesh.ocean_tweak_add()
        settings = bpy.context.view_layer.objects.active.ocean_tweak
        settings.use_foam, settings.viewport_resolution = False, 32
    bpy.ops.object.select_all(action='DESELECT')
    bpy.context.view_layer.objects.active = None
    bpy.ops.ed.undo_push(message='two oceans')
"""
SCENE = """
def there():
    '''Objects of the scene by what they are.'''
    names = sorted(item.name for item in bpy.context.scene.objects)
    left = [item for item in bpy.data.objects if item.get('ocean_tweak_float_part') == 'follower']
    return [names, len(left)]

with over('WINDOW'):
    bpy.ops.ocean.add_scene(mood='HORIZON')
    ocean().viewport_resolution = 64
    item = next(item for item in bpy.data.objects if item.ocean_tweak.is_ocean)
    for each in bpy.context.scene.objects:
        each.select_set(each == item)
    bpy.context.view_layer.objects.active = item
    bpy.ops.ed.undo_push(message='scene')
"""


def test_a_list_and_a_pin(hand):
    hand.ask(f"run({TWO!r})")
    hand.wait("len(oceans())", 2)
    hand.wait("shown()", "Ocean")  # the first by name, though nothing is selected
    hand.click(*hand.find("ocean.pin(", across=(0.97, 0.94)))
    hand.wait("bpy.context.scene.ocean_tweak_pinned", "Ocean")
    hand.ask("setattr(bpy.context.view_layer.objects, 'active', bpy.data.objects['Ocean.001'])")
    hand.wait("shown()", "Ocean")
    hand.to_viewport()
    hand.key("ctrl+z")
    hand.wait("bpy.context.scene.ocean_tweak_pinned", "")
    hand.key("ctrl+shift+z")
    hand.wait("bpy.context.scene.ocean_tweak_pinned", "Ocean")
    hand.wait("shown()", "Ocean")


def test_what_was_made_for_an_ocean_goes_and_comes_with_it(hand):
    hand.ask(f"run({SCENE!r})")
    hand.wait("len(oceans())", 1)
    hand.wait("is_refining()", False)
    before = hand.ask("there()")
    hand.to_viewport()
    hand.key("Delete")
    # its surface, patches and carriers are gone; what is the artist's own stays
    left = hand.wait("there()", [["Buoy", "Ocean Camera", "Ocean Sun"], 0])
    assert set(left[0]) < set(before[0])
    assert before[1] == 1
    hand.find("ocean.add_scene(")
    hand.to_viewport()
    hand.key("ctrl+z")
    hand.wait("there()", before)
    hand.find("layers[0].wind_speed")
    hand.to_viewport()
    hand.key("ctrl+shift+z")
    hand.wait("there()", left)
