# SPDX-License-Identifier: GPL-3.0-or-later
"""A layout that records what panels draw, and what draws them all with it."""

from types import SimpleNamespace

import bpy
import pytest


class Layout:
    """Takes what a panel draws, and remembers it."""

    use_property_decorate = False

    def __init__(self, drawn, look=lambda _owner, _name: None):
        self.drawn, self.look = drawn, look

    def part(self, *_positional, **_named):
        return Layout(self.drawn, self.look)

    row = column = box = split = part

    def label(self, text, **_named):
        self.drawn.append(text)

    def template_list(self, name, _id, owner, items, _active_owner, active, **_named):
        assert hasattr(bpy.types, name)
        assert {items, active} <= set(owner.bl_rna.properties.keys())
        self.drawn.append(name)

    def template_ID(self, owner, name, **_named):  # Blender's own name
        assert name in owner.bl_rna.properties
        self.drawn.append(name)

    def separator(self, **_named):
        pass

    def template_icon(self, icon_value, **_named):
        assert icon_value

    def menu(self, name, **_named):
        assert hasattr(bpy.types, name)
        self.drawn.append(name)

    def progress(self, factor, text, **_named):
        assert 0.0 <= factor <= 1.0
        self.drawn.append(text)

    def prop(self, owner, name, **_named):
        assert name in owner.bl_rna.properties
        self.drawn.append(name)
        self.look(owner, name)

    def prop_search(self, owner, name, source, items, **_named):
        assert items in source.bl_rna.properties
        self.prop(owner, name)

    def prop_decorator(self, owner, name):
        assert name in owner.bl_rna.properties

    def operator(self, name, **_named):
        module, _, function = name.partition(".")
        assert hasattr(bpy.types, f"{module.upper()}_OT_{function}")
        self.drawn.append(name)
        return SimpleNamespace()

    def operator_menu_enum(self, name, _property, **_named):
        return self.operator(name)


@pytest.fixture
def draw(extension, empty_scene):
    """Draw all panels that show themselves; returns what was drawn."""

    def draw_all(item, look=lambda _owner, _name: None):
        drawn = []
        context = SimpleNamespace(
            active_object=item, scene=empty_scene, window_manager=None, region=SimpleNamespace(width=300),
            preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),
        )  # fmt: skip
        panels = [cls for cls in extension("ui.panels").CLASSES if issubclass(cls, bpy.types.Panel)]
        for panel in panels:
            if not hasattr(panel, "poll") or panel.poll(context):
                shown = SimpleNamespace(layout=Layout(drawn, look))
                getattr(panel, "draw_header", lambda *_: None)(shown, context)
                panel.draw(shown, context)
        return drawn

    return draw_all


@pytest.fixture
def item(ocean_object, make_parameters, empty_scene):
    return ocean_object.add(empty_scene, make_parameters())
