# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar shows the scene's ocean whatever is selected; what was made for an ocean is deleted with it."""

import bpy
import pytest

from . import floats

# fixtures for every test here
select, buoy = floats.select, floats.buoy


@pytest.fixture
def shown(extension):
    """Name of the ocean that is shown."""

    def name():
        item = extension("ui.active_ocean").shown_ocean(bpy.context)
        return item and item.name

    return name


@pytest.fixture
def lake(ocean, ocean_object, make_parameters, empty_scene):
    return ocean_object.add(empty_scene, make_parameters(seed=3), name="Lake")


def test_one_ocean_is_always_at_hand(ocean, buoy, select, shown):
    for chosen in ((), (buoy,), (ocean,)):
        select(*chosen)
        assert shown() == "Ocean"
        assert bpy.ops.ocean.apply_preset.poll()
    select(buoy)
    bpy.ops.ocean.apply_preset(key="gale")
    assert ocean.ocean_tweak.preset
    assert bpy.context.active_object == buoy


def test_of_two_the_active_one_the_one_below_or_the_pinned_one(
    ocean, lake, buoy, select, shown, extension, window
):
    select(buoy)
    assert shown() == "Lake"  # the first by name
    select(ocean)
    assert shown() == "Ocean"
    extension("scene.floating").float_on(buoy, ocean)
    select(buoy)
    assert shown() == "Ocean"
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.ocean.pin(ocean="Lake")
        bpy.ops.ed.undo_push(message="pinned")
        assert shown() == "Lake"
        bpy.ops.ed.undo()
        assert shown() == "Ocean"
        bpy.ops.ed.redo()
        assert shown() == "Lake"
    bpy.context.view_layer.objects.active = bpy.data.objects["Ocean"]
    assert shown() == "Lake"
    bpy.data.objects["Lake"].name = "Pond"  # another name, and it is not the pinned one any more
    assert shown() == "Ocean"
    bpy.ops.ocean.pin(ocean="Pond")
    assert shown() == "Pond"
    bpy.ops.ocean.pin()
    assert shown() == "Ocean"
    with pytest.raises(RuntimeError, match="'Sea' is not an ocean of this scene"):
        bpy.ops.ocean.pin(ocean="Sea")


def test_where_there_is_none_nothing_is_shown(empty_scene, buoy, shown):
    assert shown() is None
    with pytest.raises(RuntimeError, match="There is no ocean in this scene"):
        bpy.ops.ocean.apply_preset(key="gale")


def test_a_deleted_ocean_takes_along_what_was_made_for_it(
    ocean, lake, buoy, select, extension, shown, make_parameters, empty_scene, window
):
    surroundings, floating = extension("scene.surroundings"), extension("scene.floating")
    extension("scene.camera_surface").add_camera_surface(lake, empty_scene)
    with window.override():
        for item in (ocean, lake):
            surroundings.add_horizon(item, make_parameters(), empty_scene, empty_scene.collection, 2)
        other = buoy.copy()
        empty_scene.collection.objects.link(other)
        floating.float_on(buoy, ocean)
        floating.float_on(other, lake)
        bpy.context.view_layer.update()
        before = {item.name for item in empty_scene.objects}
        bpy.ops.ed.undo_push(message="before")
        select(lake)
        bpy.ops.object.delete()
        bpy.context.view_layer.update()
        left = {"Ocean", "Ocean Horizon", "Buoy", "Buoy.001"}

        def floating_ones():
            bpy.context.view_layer.update()
            scene = bpy.context.scene
            return {item.name for item in scene.objects if floating.carrier_of(item) is not None}

        assert {item.name for item in empty_scene.objects} == left
        assert floating_ones() == {"Buoy"}
        assert shown() == "Ocean"
        bpy.ops.ed.undo_push(message="deleted")
        bpy.ops.ed.undo()
        assert {item.name for item in bpy.context.scene.objects} == before
        assert floating_ones() == {"Buoy", "Buoy.001"}
        bpy.ops.ed.redo()
        bpy.context.view_layer.update()
        assert {item.name for item in bpy.context.scene.objects} == left
        assert floating_ones() == {"Buoy"}


def test_menus_say_that_an_ocean_is_another_one(ocean, extension):
    texts = []

    class Layout:
        def operator(self, _name, text, **_named):
            texts.append(text)

        def operator_menu_enum(self, _name, _choice, text, **_named):
            texts.append(text)

    class Menu:
        layout = Layout()

    draws = extension("ui.panels").draw_add_menu, extension("ui.scene_operators").draw_add_menu
    for draw in draws:
        draw(Menu, bpy.context)
    assert len(texts) == 2
    assert all("Another Ocean" in text for text in texts)
    bpy.data.objects.remove(ocean)
    texts.clear()
    for draw in draws:
        draw(Menu, bpy.context)
    assert texts == ["Ocean Tweak", "Ocean Scene"]
