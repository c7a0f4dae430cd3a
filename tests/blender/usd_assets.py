# SPDX-License-Identifier: GPL-3.0-or-later
"""Oceans to be exported as USD layers, and what a program reads of these."""

import importlib.util

import bpy
import numpy as np
import pytest

TOLERANCE = 1e-4  # m
FRAMES = (1, 2, 3)
needs_usd = pytest.mark.skipif(importlib.util.find_spec("pxr") is None, reason="this Blender has no OpenUSD")


@pytest.fixture
def saved(empty_scene, tmp_path, monkeypatch):
    """A file that has been saved, with three frames."""
    monkeypatch.delenv("OCEAN_TWEAK_CACHE", raising=False)
    empty_scene.frame_start, empty_scene.frame_end = FRAMES[0], FRAMES[-1]
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))
    return bpy.context.scene


@pytest.fixture
def ocean(saved, ocean_object, make_parameters, core):
    return add_ocean(saved, ocean_object, make_parameters(foam=core.Foam(half_life=0.05)))


def add_ocean(scene, ocean_object, parameters, **more):
    item = ocean_object.add(scene, parameters, **more)
    bpy.context.view_layer.objects.active = item
    item.ocean_tweak.usd.proxy = 0
    return item


@pytest.fixture
def process(extension):
    return extension("scene.usd")


def value(path, attribute, frame=None, mesh="geo/sea/surface"):
    """An attribute of the mesh, as a program reads it that opens the asset."""
    from pxr import Usd

    stage = Usd.Stage.Open(str(path))
    stage.Reload()
    prim = stage.GetDefaultPrim().GetPath()
    time = Usd.TimeCode.Default() if frame is None else Usd.TimeCode(frame)
    return np.array(stage.GetAttributeAtPath(f"{prim}/{mesh}.{attribute}").Get(time), np.float64)


def contents(folder):
    return {path: path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}
