# SPDX-License-Identifier: GPL-3.0-or-later
"""Oceans as USD layers from Blender: what the layers hold, and what is refused with its reason."""

import os
import sys
from pathlib import Path

import bpy
import numpy as np
import pytest

from . import usd_assets
from .conftest import DOMAIN, SAMPLES, vertices
from .usd_assets import FRAMES, TOLERANCE, add_ocean, contents, needs_usd, value

# fixtures for every test here
saved, ocean, process = usd_assets.saved, usd_assets.ocean, usd_assets.process


def image_of(path, frame):
    """The path of a frame's displacement image, as the material has it."""
    from pxr import Usd

    stage = Usd.Stage.Open(str(path))
    stage.Reload()
    image = stage.GetAttributeAtPath(f"{stage.GetDefaultPrim().GetPath()}/mtl/water/mtlx_image.inputs:file")
    return image.Get(frame).path


def record(path):
    """What the asset says of itself."""
    from pxr import Usd

    stage = Usd.Stage.Open(str(path))
    stage.Reload()
    return stage.GetDefaultPrim().GetCustomDataByKey("ocean_tweak")


def flat():
    """(SAMPLES+1, SAMPLES+1, 3): the grid at rest."""
    steps = np.arange(SAMPLES + 1) * DOMAIN / SAMPLES
    east, north = np.meshgrid(steps, steps)
    return np.stack([east, north, np.zeros_like(east)], axis=-1)


@needs_usd
@pytest.mark.parametrize("form", ["points", "clips"])
def test_points_are_those_of_the_evaluated_mesh(ocean, saved, tmp_path, form):
    ocean.ocean_tweak.usd.form = form
    assert bpy.ops.ocean.export_usd() == {"FINISHED"}
    asset = tmp_path / "usd" / "Ocean" / "Ocean.usd"
    shown = []
    for frame in FRAMES:
        saved.frame_set(frame)
        shown.append(vertices(ocean).reshape(-1, 3))
        np.testing.assert_allclose(value(asset, "points", frame), shown[-1], atol=TOLERANCE)
    assert np.abs(shown[0] - shown[-1]).max() > 0.05


@needs_usd
def test_displacement_images_are_the_evaluated_displacement(ocean, saved, extension, tmp_path):
    ocean.ocean_tweak.usd.form = "displacement"
    assert bpy.ops.ocean.export_usd() == {"FINISHED"}
    folder = tmp_path / "usd" / "Ocean"
    np.testing.assert_allclose(value(folder / "Ocean.usd", "points").reshape(flat().shape), flat(), atol=1e-4)
    for frame in FRAMES:
        saved.frame_set(frame)
        (file,) = folder.glob(f"textures/*/*/*_disp.{frame:04d}.exr")
        image, _ = extension("export.exr").read_image(file)
        moved = (vertices(ocean) - flat())[:-1, :-1]
        np.testing.assert_allclose(image, moved, atol=TOLERANCE)


@needs_usd
def test_choices_of_the_panel_are_those_of_the_layers(ocean, tmp_path):
    usd = ocean.ocean_tweak.usd
    usd.form, usd.file, usd.up_axis, usd.metres_per_unit = "points", "//out/bay.usda", "Y", 0.01
    usd.subframes, usd.attributes, usd.half = 2, {"velocities", "foam"}, True
    usd.tiles, usd.proxy, usd.variants = (2, 3), 8, "32, 16"
    assert bpy.ops.ocean.export_usd() == {"FINISHED"}
    said = record(tmp_path / "out" / "bay.usda")
    expected = {
        "name": "bay", "form": "points", "upAxis": "Y", "metersPerUnit": 0.01, "half": True, "tiles": "2x3",
        "attributes": "velocities,foam", "proxy": 8, "variants": "32,16", "frames": "1-3,1.5,2.5",
    }  # fmt: skip
    assert {name: said[name] for name in expected} == expected


@needs_usd
def test_the_file_browser_exports_what_was_chosen(ocean, tmp_path):
    ocean.ocean_tweak.usd.form = "points"
    assert bpy.ops.ocean.export_usd_as(filepath=str(tmp_path / "chosen" / "sea")) == {"FINISHED"}
    assert ocean.ocean_tweak.usd.file == "//chosen/sea.usd"
    assert (tmp_path / "chosen" / "sea.usd").is_file()
    for chosen in ("water.v001", "fog.v001.usda"):
        assert bpy.ops.ocean.export_usd_as(filepath=str(tmp_path / chosen / chosen)) == {"FINISHED"}
        assert bpy.ops.ocean.verify_usd() == {"FINISHED"}
    assert (tmp_path / "water.v001" / "water.v001.usd").is_file()
    assert (tmp_path / "fog.v001.usda" / "fog.v001.usda").is_file()


@needs_usd
def test_foreign_layers_stay_unless_asked(ocean, tmp_path):
    from pxr import Usd

    usd = ocean.ocean_tweak.usd
    usd.form, usd.file = "points", str(tmp_path / "set" / "mine.usd")
    foreign = tmp_path / "set" / "mtl.usd"
    foreign.parent.mkdir()
    Usd.Stage.CreateNew(str(foreign)).Save()
    before = contents(foreign.parent)
    with pytest.raises(RuntimeError, match=r"mtl\.usd exists already .*in Blender: Overwrite"):
        bpy.ops.ocean.export_usd()
    assert contents(foreign.parent) == before
    usd.force = True
    assert bpy.ops.ocean.export_usd() == {"FINISHED"}
    assert bpy.ops.ocean.verify_usd() == {"FINISHED"}


@needs_usd
def test_what_cannot_be_written_is_said(ocean, tmp_path, process):
    usd = ocean.ocean_tweak.usd
    (tmp_path / "usd").write_text("a file")
    with pytest.raises(RuntimeError, match=f"{tmp_path / 'usd'}.*"):
        bpy.ops.ocean.export_usd()
    assert (tmp_path / "usd").read_text() == "a file"
    wrong = (
        ("file", "//sea.obj", r"must end in \.usd"), ("variants", "5x", "must look like 512,256"),
        ("file", "//sea/payload.usd", "is the name of a layer"),
    )  # fmt: skip
    for name, choice, said in wrong:
        before = getattr(usd, name)
        usd.file = "//sea/sea.usd"
        setattr(usd, name, choice)
        with pytest.raises(RuntimeError, match=said):
            bpy.ops.ocean.export_usd()
        setattr(usd, name, before)
    assert process.running(ocean) is None
    assert not list(tmp_path.rglob("*.usd*"))


@needs_usd
@pytest.mark.skipif(sys.platform != "linux", reason="these rights are Linux's")
def test_a_folder_that_may_not_be_written_is_named(ocean, tmp_path):
    folder = tmp_path / "usd"
    folder.mkdir(mode=0o500)
    if os.access(folder, os.W_OK):  # everything is allowed to root, but this
        folder = Path("/sys/usd")
    ocean.ocean_tweak.usd.file = str(folder / "Ocean" / "Ocean.usd")
    with pytest.raises(RuntimeError, match=f"{folder}.*: get permission to write there"):
        bpy.ops.ocean.export_usd()
    ocean.ocean_tweak.usd.file = ""


@needs_usd
def test_frames_outside_of_the_bake_are_refused(ocean, saved, tmp_path):
    usd = ocean.ocean_tweak.usd
    usd.form = "displacement"
    bpy.ops.ocean.bake()
    saved.frame_end = 5
    with pytest.raises(RuntimeError, match="frames 4-5 are not in this bake"):
        bpy.ops.ocean.export_usd()
    assert not (tmp_path / "usd" / "Ocean" / "Ocean.usd").exists()
    saved.frame_end = 3
    assert bpy.ops.ocean.export_usd() == {"FINISHED"}
    assert not list((tmp_path / "usd").rglob("*.exr"))
    assert image_of(tmp_path / "usd" / "Ocean" / "Ocean.usd", 2).startswith("../../cache/Ocean-")
    assert bpy.ops.ocean.verify_usd() == {"FINISHED"}
    usd.use_bake = False
    assert bpy.ops.ocean.export_usd() == {"FINISHED"}
    assert len(list((tmp_path / "usd").rglob("*.exr"))) == 3


@needs_usd
def test_a_file_that_was_never_saved(
    empty_scene, ocean_object, make_parameters, process, tmp_path, monkeypatch
):
    item = add_ocean(empty_scene, ocean_object, make_parameters())
    monkeypatch.setattr(process, "user_folder", lambda name: tmp_path / name)
    assert process.usd_file(item) == tmp_path / "usd" / "Ocean" / "Ocean.usd"
    item.ocean_tweak.usd.file = "//sea.usd"
    with pytest.raises(RuntimeError, match="was never saved"):
        bpy.ops.ocean.export_usd()


@needs_usd
def test_stopped_the_old_layers_are_whole(ocean, saved, extension, process, tmp_path):
    """What the running operator does: start, look, stop."""
    ocean.ocean_tweak.usd.form = "points"
    bpy.ops.ocean.export_usd()
    before = contents(tmp_path / "usd")
    ocean.ocean_tweak.layers[0].wind_speed = 7.0
    frames = tuple(range(1, 2000))
    export = process.start_export(ocean, extension("scene.shots").shot_of(ocean, saved, frames), frames)
    assert process.running(ocean) is export
    assert not bpy.ops.ocean.export_usd.poll()
    assert not bpy.ops.ocean.verify_usd.poll()
    while export.done < 3:
        assert not export.has_ended(), export.error
    assert export.left == 1999
    assert 0.0 < export.factor < 1.0
    assert export.seconds_left > 0.0
    assert bpy.ops.ocean.stop_usd() == {"FINISHED"}
    export.wait()
    process.forget(export)
    assert export.is_stopped
    assert not export.is_complete
    assert export.error == "stopped; nothing was changed"
    assert contents(tmp_path / "usd") == before


@needs_usd
def test_the_end_says_how_much_was_written(ocean, saved, extension, process, tmp_path):
    export = process.start_export(ocean, extension("scene.shots").shot_of(ocean, saved, FRAMES), FRAMES)
    export.wait()
    process.forget(export)
    assert export.is_complete, export.error
    assert export.path == tmp_path / "usd" / "Ocean" / "Ocean.usd"
    assert export.size == sum(len(data) for data in contents(tmp_path / "usd").values())
    assert export.done == export.left == 3


@needs_usd
def test_verify_names_what_is_lost(ocean, tmp_path):
    bpy.ops.ocean.export_usd()
    assert bpy.ops.ocean.verify_usd() == {"FINISHED"}
    (tmp_path / "usd" / "Ocean" / "clips" / "Ocean.0002.usdc").unlink()
    with pytest.raises(RuntimeError, match=r"frame 2: .*Ocean\.0002\.usdc is missing"):
        bpy.ops.ocean.verify_usd()
    ocean.ocean_tweak.usd.file = "//elsewhere/sea.usd"
    with pytest.raises(RuntimeError, match="no such file"):
        bpy.ops.ocean.verify_usd()


def test_paths_can_be_relative(ocean, process):
    assert process.default_file(ocean) == "//usd/Ocean/Ocean.usd"
    assert process.usd_file(ocean) == Path(bpy.data.filepath).parent / "usd" / "Ocean" / "Ocean.usd"
