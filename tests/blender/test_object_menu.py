# SPDX-License-Identifier: GPL-3.0-or-later
"""The Object menu offers what is done with the active ocean: F3 does not find what stands in panels alone."""

from types import SimpleNamespace

import bpy


def entries(draw):
    """What a menu draws: the names of operators and menus."""
    drawn = []
    layout = SimpleNamespace(
        operator=lambda name, **_: drawn.append(name), menu=lambda name, **_: drawn.append(name),
        separator=lambda **_: None,
    )  # fmt: skip
    draw(SimpleNamespace(layout=layout), bpy.context)
    return drawn


def test_the_menu_offers_operators_that_there_are(extension):
    menu = extension("ui.object_menu")
    names = entries(menu.OCEAN_MT_object.draw)
    assert {"ocean.plan_patches", "ocean.read_weights", "ocean.add_camera_surface", "ocean.bake"} <= set(
        names
    )
    assert len(names) == len(set(names))
    for name in names:
        group, _, operator = name.partition(".")
        assert getattr(getattr(bpy.ops, group), operator).get_rna_type().description


def test_it_stands_in_the_object_menu(extension):
    menu = extension("ui.object_menu")
    assert menu.draw_object_menu in bpy.types.VIEW3D_MT_object.draw._draw_funcs
    assert entries(menu.draw_object_menu) == ["OCEAN_MT_object"]
