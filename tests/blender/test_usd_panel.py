# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel, the file browser and the menus of USD: what they show, and what they say where they cannot."""

import sys
from types import SimpleNamespace

import bpy
import pytest

from . import usd_assets
from .layouts import Layout
from .usd_assets import needs_usd

# fixtures for every test here
saved, ocean, process = usd_assets.saved, usd_assets.ocean, usd_assets.process


def test_defaults_and_texts_are_the_command_lines(ocean, extension):
    usd, package = ocean.ocean_tweak.usd, extension("export.usd.package").Package
    usd.property_unset("proxy")
    for name in ("up_axis", "half", "proxy"):
        assert getattr(usd, name) == getattr(package, name)
    assert tuple(usd.tiles) == package.tiles
    assert usd.attributes == set(package.attributes)
    assert usd.metres_per_unit == package.metres_per_unit
    parser = extension("cli.arguments").make_parser(in_blender=True)
    (commands,) = (action for action in parser._actions if action.dest == "run" or action.choices)
    helps = {action.dest: action.help for action in commands.choices["usd"]._actions}
    for name in (
        "up_axis",
        "metres_per_unit",
        "subframes",
        "attributes",
        "half",
        "tiles",
        "proxy",
        "variants",
    ):
        text = usd.bl_rna.properties[name].description
        assert helps[name].lower().startswith(text.lower())


def test_without_openusd_the_buttons_say_what_to_install(ocean, monkeypatch):
    monkeypatch.setitem(sys.modules, "pxr", None)
    for name in ("export_usd", "export_usd_as", "verify_usd", "import_usd"):
        operator = getattr(bpy.ops.ocean, name)
        assert not operator.poll()
        with pytest.raises(RuntimeError, match=r"no OpenUSD: install it with 'pip install usd-core'"):
            operator()


@needs_usd
def test_without_an_ocean_there_is_nothing_to_export(empty_scene):
    for operator in (bpy.ops.ocean.export_usd, bpy.ops.ocean.export_usd_as, bpy.ops.ocean.verify_usd):
        with pytest.raises(RuntimeError, match="There is no ocean in this scene"):
            operator()
    assert not bpy.ops.ocean.stop_usd.poll()
    assert bpy.ops.ocean.import_usd.poll()


def drawn_by(draw, item):
    drawn = []
    context = SimpleNamespace(
        active_object=item, scene=bpy.context.scene, region=SimpleNamespace(width=300),
        preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),
    )  # fmt: skip
    draw(SimpleNamespace(layout=Layout(drawn)), context)
    return drawn


def test_the_panel_and_the_browser_show_the_choices(ocean, extension):
    panel, browser = extension("ui.panels.output").OCEAN_PT_usd, extension("ui.usd_operators")
    always = {"form", "up_axis", "metres_per_unit", "subframes", "tiles", "use_proxy", "variants", "force"}
    for draw in (panel.draw, browser.OCEAN_OT_export_usd_as.draw):
        ocean.ocean_tweak.usd.form = "clips"
        assert always | {"attributes", "half"} <= set(drawn_by(draw, ocean))
        ocean.ocean_tweak.usd.form = "displacement"
        drawn = set(drawn_by(draw, ocean))
        assert always <= drawn
        assert not {"attributes", "half", "use_bake"} & drawn
    for draw in (browser.draw_export_menu, browser.draw_import_menu):
        assert len(drawn_by(draw, ocean)) == 1


def test_the_panel_shows_how_far_it_is_and_what_is_missing(ocean, extension, process, monkeypatch):
    draw = extension("ui.panels.output").OCEAN_PT_usd.draw
    monkeypatch.setitem(sys.modules, "pxr", None)
    assert "pip install usd-core" in " ".join(drawn_by(draw, ocean))
    export = SimpleNamespace(phase="", done=3, left=12, factor=0.25, seconds_left=62.0, is_stopped=False)
    monkeypatch.setitem(process._running, ocean.session_uid, export)
    drawn = drawn_by(draw, ocean)
    assert "3 / 12, 1:02" in drawn
    assert "ocean.stop_usd" in drawn
    assert "ocean.export_usd" not in drawn


def test_the_menus_offer_both_ways(package):
    for menu, name in (("export", "draw_export_menu"), ("import", "draw_import_menu")):
        functions = getattr(bpy.types, f"TOPBAR_MT_file_{menu}").draw._draw_funcs
        assert name in [function.__name__ for function in functions]
