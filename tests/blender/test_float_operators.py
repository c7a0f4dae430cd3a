# SPDX-License-Identifier: GPL-3.0-or-later
"""Float on Ocean in the menu and the sidebar, and its bake to keyframes."""

import math
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from mathutils import Vector

FRAMES = (1, 48)
CENTIMETRE, DEGREE = 0.01, 1.0


@pytest.fixture
def select(empty_scene):
    """Select these objects and no others; the first one is active."""

    def choose(*items):
        for item in empty_scene.objects:
            item.select_set(item in items)
        bpy.context.view_layer.objects.active = items[0] if items else None
        bpy.context.view_layer.update()

    return choose


@pytest.fixture
def ocean(ocean_object, make_parameters, empty_scene):
    empty_scene.frame_start, empty_scene.frame_end = FRAMES
    item = ocean_object.add(empty_scene, make_parameters(), viewport_resolution=16)
    item.ocean_tweak.use_foam = False  # quicker
    item.location, item.rotation_euler.z = (12.0, -30.0, 2.0), 0.6
    return item


@pytest.fixture
def buoy(empty_scene):
    item = bpy.data.objects.new("Buoy", None)
    item.location = (25.0, 40.0, 9.0)
    empty_scene.collection.objects.link(item)
    return item


@pytest.fixture
def keys(empty_scene):
    """Frames and interpolations of an object's curves by path and index."""

    def read(item):
        animation = item.animation_data
        curves = [
            animation.action.fcurve_ensure_for_datablock(item, path, index=index)
            for path in ("location", "rotation_euler")
            for index in range(3)
        ]
        return [[(point.co.x, point.interpolation) for point in curve.keyframe_points] for curve in curves]

    return read


def sea_below(core, ocean, parameters, frame, place):
    matrix = np.array(ocean.matrix_world)
    inside = np.linalg.inv(matrix) @ [*place[:2], 0.0, 1.0]
    found = core.Ocean(parameters).points_at(inside[0], inside[1], parameters.timing.time(frame))
    point = matrix @ [inside[0], inside[1], float(found.height), 1.0]
    return point[:3], matrix[:3, :3] @ found.normal


def assert_rides(item, core, ocean, parameters, frame, shown=None):
    point, normal = sea_below(core, ocean, parameters, shown or frame, (25.0, 40.0))
    matrix = np.array(item.matrix_world)
    assert np.linalg.norm(matrix[:3, 3] - point) < CENTIMETRE
    assert math.degrees(Vector(matrix[:3, 2]).angle(Vector(normal))) < DEGREE


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
    # by its carrier
    select(next(each for each in bpy.data.objects if each.type == "MESH" and each != ocean))
    assert bpy.ops.object.ocean_tweak_float_remove() == {"FINISHED"}
    bpy.context.view_layer.update()
    assert tuple(buoy.matrix_world.translation) == (25.0, 40.0, 9.0)
    assert set(bpy.data.objects) == {ocean, buoy}


@pytest.mark.parametrize("mode", ["XYZ", "QUATERNION", "AXIS_ANGLE"])
def test_bake_to_keyframes(ocean, buoy, select, core, make_parameters, empty_scene, mode):
    buoy.rotation_mode = mode
    select(buoy)
    empty_scene.frame_set(5)
    assert bpy.ops.object.ocean_tweak_float_bake() == {"FINISHED"}
    assert empty_scene.frame_current == 5
    assert not buoy.constraints
    assert set(bpy.data.objects) == {ocean, buoy}
    for frame in range(FRAMES[0], FRAMES[1] + 1):
        empty_scene.frame_set(frame)
        assert_rides(buoy, core, ocean, make_parameters(), frame)  # the sea of the render
    before = buoy.matrix_world.translation.copy()
    empty_scene.frame_set(FRAMES[1] + 10)
    assert buoy.matrix_world.translation == before
    assert bpy.ops.object.ocean_tweak_float_remove() == {"FINISHED"}
    empty_scene.frame_set(9)
    assert tuple(buoy.matrix_world.translation) == (25.0, 40.0, 9.0)
    assert buoy.animation_data is None
    assert not bpy.data.actions


def test_keys_are_linear_and_stand_in_their_range(ocean, buoy, select, keys):
    select(buoy)
    bpy.ops.object.ocean_tweak_float_bake(frame_start=10, frame_end=13)
    for curve in keys(buoy):
        assert curve == [(frame, "LINEAR") for frame in (10, 11, 12, 13)]


@pytest.mark.parametrize("method", ["NODES", "DISPLACE"])
def test_a_baked_ocean(ocean_object, bake, buoy, select, core, make_parameters, empty_scene, method):
    parameters = make_parameters()
    ocean = ocean_object.add(empty_scene, parameters, method, "SEQUENCE", bake(parameters, 3, 10))
    select(buoy)
    bpy.ops.object.ocean_tweak_float()
    for frame in (1, 3, 7, 12):
        empty_scene.frame_set(frame)
        assert_rides(buoy, core, ocean, parameters, frame, shown=min(max(frame, 3), 10))
    # what floats keeps its settings
    assert bpy.ops.object.ocean_tweak_float_bake(frame_start=1, frame_end=12, draft=5.0) == {"FINISHED"}
    assert not buoy.constraints
    for frame in (1, 3, 7, 12):
        empty_scene.frame_set(frame)
        assert_rides(buoy, core, ocean, parameters, frame, shown=min(max(frame, 3), 10))


def test_keys_are_what_floated_live(ocean, buoy, select, empty_scene):
    """Waterline, draft, tilt, drift, a parent and an animated way: the core and the nodes agree."""
    empty_scene.objects["Ocean"].ocean_tweak.viewport_resolution = 32
    parent = bpy.data.objects.new("Tow", None)
    parent.location, parent.rotation_euler = (5.0, 6.0, 1.0), (0.0, 0.1, 0.2)
    empty_scene.collection.objects.link(parent)
    buoy.parent = parent
    for frame, x in ((1, 20.0), (20, 60.0)):
        buoy.location.x = x
        buoy.keyframe_insert("location", frame=frame)
    buoy.rotation_euler = (0.1, 0.0, 0.5)
    action = buoy.animation_data.action
    select(buoy)
    bpy.ops.object.ocean_tweak_float(waterline=20.0, draft=0.4, tilt=0.6, drift=0.5)
    live = {}
    for frame in (1, 8, 15, 20):
        empty_scene.frame_set(frame)
        live[frame] = np.array(buoy.matrix_world)
    bpy.ops.object.ocean_tweak_float_bake(frame_end=20)
    for frame, matrix in live.items():
        empty_scene.frame_set(frame)
        np.testing.assert_allclose(buoy.matrix_world, matrix, atol=1e-3)
    assert buoy.animation_data.action != action
    bpy.ops.object.ocean_tweak_float_remove()
    assert buoy.animation_data.action == action
    empty_scene.frame_set(20)
    assert buoy.location.x == 60.0


def test_baking_again_begins_at_the_place_on_land(ocean, buoy, select, core, make_parameters, empty_scene):
    select(buoy)
    bpy.ops.object.ocean_tweak_float_bake(frame_end=4, drift=1.0, draft=3.0)
    bpy.ops.object.ocean_tweak_float_bake(frame_end=4)
    empty_scene.frame_set(3)
    assert_rides(buoy, core, ocean, make_parameters(), 3)
    bpy.ops.object.ocean_tweak_float()  # live again
    bpy.context.view_layer.update()
    assert_rides(buoy, core, ocean, make_parameters(resolution=16), 3)
    bpy.ops.object.ocean_tweak_float_remove()
    bpy.context.view_layer.update()
    assert tuple(buoy.matrix_world.translation) == (25.0, 40.0, 9.0)
    assert not bpy.data.actions


def test_a_constraint_of_the_object_s_own(ocean, buoy, select, core, make_parameters, empty_scene):
    target = bpy.data.objects.new("Target", None)
    target.location = (25.0, 40.0, 1.0)
    empty_scene.collection.objects.link(target)
    constraint = buoy.constraints.new("COPY_LOCATION")
    constraint.target = target
    buoy.location = (0.0, 0.0, 0.0)
    select(buoy)
    bpy.ops.object.ocean_tweak_float()
    empty_scene.frame_set(4)
    assert_rides(buoy, core, ocean, make_parameters(resolution=16), 4)
    bpy.ops.object.ocean_tweak_float_bake(frame_end=4)
    empty_scene.frame_set(4)
    assert_rides(buoy, core, ocean, make_parameters(), 4)
    bpy.ops.object.ocean_tweak_float_remove()
    bpy.context.view_layer.update()
    assert buoy.constraints[0].enabled
    assert tuple(buoy.matrix_world.translation) == (25.0, 40.0, 1.0)


def test_in_centimetres(ocean_object, buoy, select, core, make_parameters, empty_scene):
    empty_scene.unit_settings.scale_length = 0.01
    parameters = make_parameters()
    ocean_object.add(empty_scene, parameters)
    buoy.location = (1000.0, 2000.0, 0.0)
    select(buoy)
    bpy.ops.object.ocean_tweak_float_bake(frame_start=9, frame_end=9)
    empty_scene.frame_set(9)
    height = float(core.Ocean(parameters).height_at(10.0, 20.0, parameters.timing.time(9)))
    assert buoy.location.z / 100.0 == pytest.approx(height, abs=CENTIMETRE)


def test_an_animated_sea(ocean, buoy, select, core, make_parameters, empty_scene):
    """Its own clock at half speed, and a choppiness that grows."""
    ocean.ocean_tweak.use_ocean_time = True
    for frame, time, choppiness in ((1, 0.0, 0.2), (25, 0.5, 1.0)):
        ocean.ocean_tweak.ocean_time, ocean.ocean_tweak.choppiness = time, choppiness
        ocean.keyframe_insert("ocean_tweak.ocean_time", frame=frame)
        ocean.keyframe_insert("ocean_tweak.choppiness", frame=frame)
    select(buoy)
    bpy.ops.object.ocean_tweak_float_bake(frame_start=24, frame_end=25)
    empty_scene.frame_set(25)
    # 0.5 s are frame 13 of a sea that keeps the scene's time
    assert_rides(buoy, core, ocean, make_parameters(choppiness=1.0), 13)
    bpy.ops.object.ocean_tweak_float()
    empty_scene.frame_set(1)
    assert_rides(buoy, core, ocean, make_parameters(resolution=16, choppiness=0.2), 1)


def test_esc_leaves_everything_as_it_was(ocean, buoy, extension, empty_scene):
    floating = extension("scene.floating")
    action = bpy.data.actions.new("Own")
    buoy.animation_data_create().action = action
    empty_scene.frame_set(3)
    things, matrix = set(bpy.data.objects), buoy.matrix_world.copy()
    bake = extension("scene.float_bake").FloatBake(empty_scene, [buoy], ocean, floating.Ride(), range(1, 10))
    bake.advance()
    bake.advance()
    assert (bake.done, empty_scene.frame_current) == (2, 2)
    bake.cancel()
    assert empty_scene.frame_current == 3
    assert set(bpy.data.objects) == things
    assert buoy.matrix_world == matrix
    assert buoy.animation_data.action == action
    assert list(bpy.data.actions) == [action]


def test_a_lost_file_is_told_and_nothing_is_changed(
    ocean_object, bake, buoy, select, make_parameters, empty_scene
):
    sequence = bake(make_parameters(), 1, 4)
    ocean_object.add(empty_scene, make_parameters(), "NODES", "SEQUENCE", sequence)
    sequence.path(3).unlink()
    select(buoy)
    with pytest.raises(RuntimeError, match=r"sea_disp\.0003\.exr"):
        bpy.ops.object.ocean_tweak_float_bake(frame_start=1, frame_end=4)
    assert buoy.animation_data is None
    assert [each.name for each in bpy.data.objects if each.type == "MESH"] == ["Ocean"]


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
    with pytest.raises(RuntimeError, match="'Pond' is no ocean of this scene"):
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
        with pytest.raises(RuntimeError, match="Select the objects that shall float"):
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

    def operator(self, name, **_named):
        module, _, function = name.partition(".")
        assert hasattr(bpy.types, f"{module.upper()}_OT_{function}")
        self.drawn.append(name)


def test_the_panel_shows_how_the_active_object_floats(ocean, buoy, select, extension):
    panel = extension("ui.panels.floating").OCEAN_PT_float

    def drawn():
        texts = []
        panel.draw(SimpleNamespace(layout=Layout(texts)), bpy.context)
        return texts

    buttons = ["object.ocean_tweak_float_bake", "object.ocean_tweak_float_remove"]
    select()
    assert drawn() == ["object.ocean_tweak_float", *buttons]
    select(buoy)
    assert drawn() == ["object.ocean_tweak_float", *buttons]
    bpy.ops.object.ocean_tweak_float()
    inputs = ["Ocean", "Waterline", "Draft", "Tilt", "Drift"]
    assert drawn() == ["Move Buoy Float", *inputs, *buttons]
    select(bpy.data.objects["Buoy Float"])
    assert drawn() == [*inputs, *buttons]


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
