# SPDX-License-Identifier: GPL-3.0-or-later
"""What enabling adds to Blender, disabling takes away, any number of times."""

import logging

import addon_utils
import bpy
import pytest


def traces(package):
    """Everything in Blender that an extension can leave behind, each as one readable line."""
    owners = (bpy.types.Object, bpy.types.Scene, bpy.types.WindowManager, bpy.types.Image, bpy.types.Mesh)
    menus = [getattr(bpy.types, name) for name in dir(bpy.types) if "_MT_" in name]
    return {
        *(f"type {name}" for name in dir(bpy.types)),  # all but the property groups
        *(
            f"type {group.__name__}"
            for group in bpy.types.PropertyGroup.__subclasses__()
            if group.is_registered
        ),
        *(
            f"property {owner.__name__}.{name}"
            for owner in owners
            for name, _ in owner.bl_rna.properties.items()
        ),
        *(f"handler {name} {function.__module__}.{function.__name__}" for name, function in handlers()),
        *(
            f"menu {menu.__name__} {draw.__module__}.{draw.__name__}"
            for menu in menus
            for draw in getattr(menu.draw, "_draw_funcs", ())
            if draw.__module__.startswith(package)
        ),
        *(f"keymap {keymap.name} {item.idname}" for keymap in keymaps() for item in keymap.keymap_items),
    }


def handlers():
    """Every application handler, with the name of its list."""
    names = [name for name in dir(bpy.app.handlers) if isinstance(getattr(bpy.app.handlers, name), list)]
    return [(name, function) for name in names for function in getattr(bpy.app.handlers, name)]


def keymaps():
    configuration = bpy.context.window_manager.keyconfigs.addon
    return configuration.keymaps if configuration else ()


@pytest.fixture
def disabled(package):
    """Disable the extension for one test and enable it again."""
    addon_utils.disable(package)
    yield package
    assert addon_utils.enable(package) is not None


def test_disabling_leaves_nothing(disabled):
    before = traces(disabled)
    for _ in range(10):
        assert addon_utils.enable(disabled) is not None
        added = traces(disabled) - before
        assert {line.split()[0] for line in added} >= {"type", "property", "handler", "menu"}
        addon_utils.disable(disabled)
        assert traces(disabled) == before


def test_handlers_are_added_once_and_outlive_a_new_file(package):
    bpy.ops.wm.read_homefile(use_empty=True)
    ours = [(name, f.__name__) for name, f in handlers() if f.__module__.startswith(package)]
    assert ours
    assert len(ours) == len(set(ours))


def test_the_console_hears_what_the_preferences_say_once(package, capsys):
    """After any number of registrations, under whatever name Blender knows the package by."""
    logger = logging.getLogger(f"{package}.ocean_tweak.scene.anything")
    for _ in range(2):
        addon_utils.disable(package)
        assert addon_utils.enable(package) is not None
    # from before, it would be of a class that is gone
    chosen = bpy.context.preferences.addons[package].preferences
    logger.warning("flat")
    logger.info("unheard")
    chosen.log_level = "INFO"
    logger.info("heard")
    chosen.log_level = "ERROR"
    logger.warning("unheard")
    chosen.log_level = "WARNING"
    assert capsys.readouterr().err == "ocean_tweak: flat\nocean_tweak: info: heard\n"
