# SPDX-License-Identifier: GPL-3.0-or-later
"""What reaches a layer above without an import is found, and what only looks so is not."""

import ast

import pytest

from tools.arrows import arrows


def lines(module, source):
    return [line for line, _ in arrows(module, ast.parse(source))]


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("scene.render", 'package = kind.__module__.rpartition(".ui.")[0]'),
        ("scene.render", 'load("ocean_tweak.cli.workers")'),
        ("core.parameters", 'load("scene.settings")'),
        ("scene.render", "importlib.import_module(name)"),
        ("export.files", "runpy.run_module(name)"),
        ("scene.render", 'subprocess.run(module_command("cli.workers"))'),
        ("scene.render", "subprocess.run(module_command(PACKAGE))"),
        ("scene.render", "bpy.ops.ocean.bake()"),
        ("scene.render", "bpy.ops.mesh.ocean_tweak_add()"),
    ],
)
def test_an_arrow_up_is_found(module, source):
    assert set(lines(module, f"\n{source}")) == {2}


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("ui.panels", 'load("scene.settings")'),
        ("registration", 'load("ui.panels")'),
        ("ui.bake_operators", "bpy.ops.ocean.apply_preset()"),
        ("scene.render", "bpy.ops.object.modifier_apply()"),
        ("scene.render", '"the scene is one, and cli is not ui."'),
        ("scene.render", 'load("core.parameters")'),
        ("export.usd.isolated", "subprocess.run(module_command(__name__))"),
        ("export.usd.library", 'importlib.import_module("pxr")'),
        ("cli", "module_command(package)"),
    ],
)
def test_what_stays_in_its_layer_or_goes_down_is_none(module, source):
    assert lines(module, source) == []
