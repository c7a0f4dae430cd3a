# SPDX-License-Identifier: GPL-3.0-or-later
"""Float on Ocean in the menu and the sidebar: what floats, on which ocean, and what is said otherwise."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from mathutils import Vector

from . import floats
from .floats import CENTIMETRE, assert_rides, sea_below

# fixtures for every test here
select, ocean, buoy = floats.select, floats.ocean, floats.buoy


def test_float_and_remove(ocean, buoy, select, core, make_parameters, empty_scene):
    select(buoy)
    assert bpy.ops.object.ocean_tweak_float(draft=0.5, tilt=0.25) == {"FINISHED"}
    empty_scene.frame_set(7)
    point, _ = sea_below(core, ocean, make_parameters(resolution=16), 7, (25.0, 40.0))
    np.testing.assert_allclose(buoy.matrix_world.translation, point - [0.0, 0.0, 0.5], atol=CENTIMETRE)
    # again with other settings: the same carrier
    assert bpy.ops.object.ocean_tweak_float() == {"FINISHED"}
    bpy.context.view_layer.update()
    assert len(bpy.data.meshes) == 2
    assert_rides(buoy, core, ocean, make_parameters(resolution=16), 7)
    assert bpy.ops.object.ocean_tweak_float_remove() == {"FINISHED"}
    bpy.context.view_layer.update()
    assert tuple(buoy.matrix_world.translation) == (25.0, 40.0, 9.0)
    assert set(bpy.data.objects) == {ocean, buoy}


@pytest.mark.parametrize("operator", ["ocean_tweak_float", "ocean_tweak_float_bake"])
def test_one_step_of_undo(ocean, buoy, select, window, operator):
    select(buoy)
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        getattr(bpy.ops.object, operator)()
        bpy.ops.ed.undo_push(message="floating")
        assert bpy.data.objects["Buoy"].constraints or bpy.data.actions
        bpy.ops.ed.undo()
    item = bpy.data.objects["Buoy"]
    bpy.context.view_layer.update()
    assert not item.constraints
    assert not bpy.data.actions
    assert tuple(item.matrix_world.translation) == (25.0, 40.0, 9.0)
    assert sorted(each.name for each in bpy.data.objects) == ["Buoy", "Ocean"]


def test_children_go_along(ocean, buoy, select, empty_scene):
    flag = bpy.data.objects.new("Flag", None)
    flag.parent, flag.location = buoy, (0.0, 0.0, 2.0)
    empty_scene.collection.objects.link(flag)
    select(buoy, flag)
    bpy.ops.object.ocean_tweak_float()
    empty_scene.frame_set(6)
    assert not flag.constraints
    np.testing.assert_allclose(
        flag.matrix_world.translation, buoy.matrix_world @ Vector((0.0, 0.0, 2.0)), atol=1e-5
    )


def test_the_ocean_that_is_chosen(ocean, ocean_object, buoy, select, extension, make_parameters, empty_scene):
    floating = extension("scene.floating")
    lake = ocean_object.add(empty_scene, make_parameters(seed=3), name="Lake")

    def floats_on():
        return floating.ride_of(floating.carrier_of(buoy))[0]

    select(buoy)
    bpy.ops.object.ocean_tweak_float()
    assert floats_on() == lake  # the first by name
    select(ocean, buoy)
    bpy.ops.object.ocean_tweak_float()
    assert floats_on() == ocean  # the active one
    bpy.ops.object.ocean_tweak_float(ocean="Lake")
    assert floats_on() == lake
    with pytest.raises(RuntimeError, match="'Pond' is not an ocean of this scene"):
        bpy.ops.object.ocean_tweak_float(ocean="Pond")


def test_what_is_said_when_it_cannot_be(ocean_object, buoy, select, make_parameters, empty_scene):
    operators = bpy.ops.object.ocean_tweak_float, bpy.ops.object.ocean_tweak_float_bake
    select(buoy)
    for operator in operators:
        with pytest.raises(RuntimeError, match="no ocean in this scene"):
            operator()
    with pytest.raises(RuntimeError, match="None of the selected objects floats"):
        bpy.ops.object.ocean_tweak_float_remove()
    ocean = ocean_object.add(empty_scene, make_parameters())
    select(ocean)
    for operator in operators:
        with pytest.raises(RuntimeError, match="Only oceans are selected"):
            operator()
    select()
    for operator in operators:
        with pytest.raises(RuntimeError, match="Nothing is selected"):
            operator()
    select(buoy)
    with pytest.raises(RuntimeError, match="first frame lies after the last"):
        bpy.ops.object.ocean_tweak_float_bake(frame_start=5, frame_end=4)
    ocean.parent = buoy
    with pytest.raises(RuntimeError, match="Buoy carries Ocean"):
        bpy.ops.object.ocean_tweak_float()
    assert set(bpy.data.objects) == {ocean, buoy}


def test_it_saves_and_loads(ocean, buoy, select, core, make_parameters, tmp_path):
    select(buoy)
    bpy.ops.object.ocean_tweak_float()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "buoy.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "buoy.blend"))
    item, sea = bpy.data.objects["Buoy"], bpy.data.objects["Ocean"]
    bpy.context.scene.frame_set(11)
    assert_rides(item, core, sea, make_parameters(resolution=16), 11)
    item.select_set(True)
    bpy.ops.object.ocean_tweak_float_bake(frame_end=2)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "buoy.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "buoy.blend"))
    bpy.data.objects["Buoy"].select_set(True)
    bpy.ops.object.ocean_tweak_float_remove()
    assert tuple(bpy.data.objects["Buoy"].location) == (25.0, 40.0, 9.0)


class Layout:
    """Takes what a panel draws, and remembers it."""

    def __init__(self, drawn):
        self.drawn = drawn

    def column(self, **_named):
        return Layout(self.drawn)

    def label(self, text, **_named):
        self.drawn.append(text)

    def prop(self, owner, name, text):
        owner.path_resolve(name)
        self.drawn.append(text)

    def prop_search(self, owner, name, _data, _collection, text, **_named):
        self.prop(owner, name, text)

    def operator_menu_enum(self, name, choice, text, **_named):
        assert choice in bpy.ops.object.ocean_tweak_float.get_rna_type().properties
        self.operator(name)
        self.drawn[-1] = text

    def operator(self, name, **_named):
        module, _, function = name.partition(".")
        assert hasattr(bpy.types, f"{module.upper()}_OT_{function}")
        self.drawn.append(name)
        return SimpleNamespace()


def test_the_panel_shows_how_the_active_object_floats(ocean, buoy, select, extension):
    panel = extension("ui.panels.floating").OCEAN_PT_float

    def drawn():
        texts = []
        panel.draw(SimpleNamespace(layout=Layout(texts)), bpy.context)
        return texts

    touch = ["object.ocean_tweak_contact", "object.ocean_tweak_cut_out"]
    buttons = ["object.ocean_tweak_wake", "object.ocean_tweak_float_bake", "object.ocean_tweak_float_remove"]
    select()
    assert drawn() == ["object.ocean_tweak_float", *buttons]
    select(buoy)
    assert drawn() == ["object.ocean_tweak_float", *touch, *buttons]
    bpy.ops.object.ocean_tweak_float()
    inputs = ["Ocean", "Waterline", "Draft", "Keel", "Tilt", "Drift", "Keep Height", "Damped"]
    assert drawn() == ["Float As", *inputs, *touch, *buttons]


@pytest.mark.parametrize(("menu", "function"), [("VIEW3D_MT_object", "draw_object_menu"),
                                               ("NODE_MT_add", "draw_add_menu")])  # fmt: skip
def test_the_menus_offer_it(menu, function):
    functions = getattr(bpy.types, menu).draw._draw_funcs
    assert function in [each.__name__ for each in functions]


@pytest.mark.parametrize("group", ["SAMPLE", "FLOAT"])
def test_the_node_editor_adds_the_groups(extension, empty_scene, window, group):
    tree = bpy.data.node_groups.new("Own", "GeometryNodeTree")
    with window.override():
        area = bpy.context.area
        before = area.type
        area.type = "NODE_EDITOR"
        try:
            space = area.spaces.active
            space.tree_type = "GeometryNodeTree"
            assert not bpy.ops.node.ocean_tweak_add_group.poll()
            space.pin, space.node_tree = True, tree
            assert bpy.ops.node.ocean_tweak_add_group(group=group) == {"FINISHED"}
        finally:
            area.type = before
    kind = {"SAMPLE": extension("nodes.sample").SAMPLE, "FLOAT": extension("nodes.floating").FLOAT}[group]
    assert [node.node_tree.name for node in tree.nodes] == [kind.name]
