# SPDX-License-Identifier: GPL-3.0-or-later
"""Seas from USD layers, back in Blender: the same as were exported, or refused with the reason."""

import bpy
import numpy as np
import pytest

from . import usd_assets
from .conftest import vertices
from .usd_assets import FRAMES, TOLERANCE, needs_usd, value

# fixtures for every test here
saved, ocean = usd_assets.saved, usd_assets.ocean


@needs_usd
def test_import_makes_the_same_sea_again(ocean, saved, tmp_path):
    usd = ocean.ocean_tweak.usd
    usd.form, usd.up_axis, usd.metres_per_unit, usd.tiles = "points", "Y", 0.01, (2, 1)
    usd.file = "//usd/my bay.usd"
    bpy.ops.ocean.export_usd()
    wanted, shown = ocean.ocean_tweak.to_parameters(saved), {}
    for frame in FRAMES:
        saved.frame_set(frame)
        shown[frame] = vertices(ocean)
    bpy.data.objects.remove(ocean)
    saved.render.fps = 30
    assert bpy.ops.ocean.import_usd(filepath=str(tmp_path / "usd" / "my bay.usd")) == {"FINISHED"}
    item = bpy.context.active_object
    assert item.name == "my_bay"
    assert item.select_get()
    assert item.ocean_tweak.to_parameters(saved) == wanted
    assert saved.render.fps == 24
    assert (item.ocean_tweak.repeats_x, item.ocean_tweak.repeats_y) == (2, 1)
    item.ocean_tweak.repeats_x = 1
    for frame in FRAMES:
        saved.frame_set(frame)
        np.testing.assert_allclose(vertices(item), shown[frame], atol=1e-6)


@needs_usd
def test_an_animated_sea_goes_there_and_back(ocean, saved, tmp_path):
    saved.unit_settings.scale_length = 0.5
    settings = ocean.ocean_tweak
    settings.usd.form, settings.use_ocean_time = "points", True
    layer = settings.layers[0]
    for frame, wind, time in ((0, 14.0, 0.0), (1, 14.0, 0.1), (4, 22.0, 0.7)):
        layer.wind_speed, settings.ocean_time = wind, time
        layer.keyframe_insert("wind_speed", frame=frame)
        settings.keyframe_insert("ocean_time", frame=frame)
    assert bpy.ops.ocean.export_usd() == {"FINISHED"}
    asset, shown = tmp_path / "usd" / "Ocean" / "Ocean.usd", {}
    for frame in FRAMES:
        saved.frame_set(frame)
        bpy.context.view_layer.update()
        shown[frame] = vertices(ocean)
        points = value(asset, "points", frame) / 0.5
        np.testing.assert_allclose(points, shown[frame].reshape(-1, 3), atol=TOLERANCE)
    bpy.data.objects.remove(ocean)
    assert bpy.ops.ocean.import_usd(filepath=str(asset)) == {"FINISHED"}
    item = bpy.context.active_object
    assert item.ocean_tweak.use_ocean_time
    for frame in FRAMES:
        saved.frame_set(frame)
        bpy.context.view_layer.update()
        np.testing.assert_allclose(vertices(item), shown[frame], atol=TOLERANCE)
    assert np.abs(shown[1] - shown[3]).max() > 0.1


@needs_usd
def test_layers_that_are_not_ours_cannot_be_imported(saved, tmp_path):
    from pxr import Usd

    foreign = tmp_path / "foreign.usda"
    Usd.Stage.CreateNew(str(foreign)).Save()
    (tmp_path / "broken.usd").write_bytes(b"no layer")
    cases = (
        ("foreign.usda", "holds no sea of Ocean Tweak"),
        ("none.usd", "no such file"),
        ("broken.usd", "."),
    )
    for name, said in cases:
        with pytest.raises(RuntimeError, match=said):
            bpy.ops.ocean.import_usd(filepath=str(tmp_path / name))
    assert not saved.objects


@needs_usd
def test_undo_takes_an_import_back(ocean, saved, tmp_path, window):
    ocean.ocean_tweak.usd.form = "points"
    bpy.ops.ocean.export_usd()
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.ocean.import_usd(filepath=str(tmp_path / "usd" / "Ocean" / "Ocean.usd"))
        assert len(bpy.data.objects) == 2
        bpy.ops.ed.undo_push(message="Import Sea from USD")
        bpy.ops.ed.undo()
    assert [item.name for item in bpy.data.objects] == ["Ocean"]
