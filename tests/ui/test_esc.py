# SPDX-License-Identifier: GPL-3.0-or-later
"""Esc ends long work in a window and leaves nothing behind; else the work is done, and undone as one step."""

import pytest

PAINTED = """
with over('WINDOW'):
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=8, y_subdivisions=8, size=500.0)
    grid = bpy.context.object
    grid.vertex_groups.new(name='Harbour').add(range(81), 0.5, 'REPLACE')
    bpy.ops.mesh.ocean_tweak_add()
    ocean().use_foam, ocean().viewport_resolution = False, 32
    mask = ocean().mask
    mask.mesh, mask.vertex_group, mask.source = grid, 'Harbour', 'VERTEX_GROUP'
    bpy.ops.ed.undo_push(message='painted')
"""
READ = "with over('WINDOW'): bpy.ops.ocean.read_weights('INVOKE_DEFAULT', True, patch=-2, samples=1024)"
CONVERTED = """
with over('WINDOW'):
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    bpy.ops.mesh.primitive_plane_add()
    modifier = bpy.context.object.modifiers.new('Ocean', 'OCEAN')
    modifier.resolution, modifier.viewport_resolution = 48, 48
    bpy.context.object.name = 'Old Sea'
    modifier.show_viewport = False
    bpy.ops.ed.undo_push(message='old sea')
"""
CONVERT = "with over('WINDOW'): bpy.ops.ocean.convert('INVOKE_DEFAULT', True)"
CUBE = """
with over('WINDOW'):
    bpy.ops.mesh.ocean_tweak_add()
    ocean().use_foam, ocean().viewport_resolution = False, 32
    cube = bpy.data.objects['Cube']
    for item in bpy.context.scene.objects: item.select_set(item == cube)
    bpy.context.view_layer.objects.active = cube
    bpy.ops.ed.undo_push(message='cube')
"""
BAKE = "with over('WINDOW'): bpy.ops.object.ocean_tweak_float_bake('INVOKE_DEFAULT', True, frame_end={})"
BAKING = "any(each.bl_idname == 'OBJECT_OT_ocean_tweak_float_bake' for each in window().modal_operators)"
KEYED = "bpy.data.objects['Cube'].animation_data is not None"
READING = "any(each.bl_idname == 'OCEAN_OT_read_weights' for each in window().modal_operators)"
CONVERTING = "any(each.bl_idname == 'OCEAN_OT_convert' for each in window().modal_operators)"
IMAGE = "ocean().mask.image is not None"


@pytest.fixture
def over_view(hand):
    """The mouse over the 3D view, where Esc is heard."""

    def begin(statements):
        hand.ask(f"run({statements!r})")
        hand.to_viewport()

    return begin


def test_weights(hand, over_view):
    over_view(PAINTED)
    hand.wait("is_refining()", False)
    over_view(READ)
    assert hand.ask(READING)
    hand.keep("weights-being-read", moving=True)
    hand.key("Escape")
    hand.wait(READING, False)
    assert not hand.ask(IMAGE)
    assert hand.ask("len(bpy.data.images)") == hand.ask("sum(image.users > 0 for image in bpy.data.images)")
    over_view(READ)
    hand.wait(IMAGE)
    hand.wait(READING, False)
    hand.to_viewport()
    hand.key("ctrl+z")
    hand.wait(IMAGE, False)
    hand.key("ctrl+shift+z")
    hand.wait(IMAGE)


def test_conversion(hand, over_view):
    over_view(CONVERTED)
    over_view(CONVERT)
    assert hand.ask(CONVERTING)
    hand.key("Escape")
    hand.wait(CONVERTING, False)
    assert hand.ask("[len(oceans()), [item.name for item in bpy.data.objects]]") == [0, ["Old Sea"]]
    over_view(CONVERT)
    hand.wait("list(oceans())", ["Old Sea"])
    hand.to_viewport()
    hand.key("ctrl+z")
    hand.wait("len(oceans())", 0)
    hand.key("ctrl+shift+z")
    hand.wait("list(oceans())", ["Old Sea"])


def test_float(hand, over_view):
    over_view(CUBE)
    hand.wait("is_refining()", False)
    before = hand.ask("[bpy.context.scene.frame_current, sorted(bpy.data.objects.keys())]")
    over_view(BAKE.format(2000))
    hand.wait("bpy.context.scene.frame_current", lambda frame: frame > 3)
    hand.keep("float-being-baked", moving=True)
    hand.key("Escape")
    hand.wait(BAKING, False)
    assert not hand.ask(KEYED)
    assert hand.ask("[bpy.context.scene.frame_current, sorted(bpy.data.objects.keys())]") == before
    over_view(BAKE.format(5))
    hand.wait(KEYED)
    hand.wait(BAKING, False)
    hand.to_viewport()
    hand.key("ctrl+z")
    hand.wait(KEYED, False)
    hand.key("ctrl+shift+z")
    hand.wait(KEYED)
