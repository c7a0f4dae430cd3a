# SPDX-License-Identifier: GPL-3.0-or-later
"""Oceans as USD layers from Blender, and back: what the layers hold, and what is refused with its reason."""

import importlib.util
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from .conftest import DOMAIN, SAMPLES, vertices
from .test_panels import Layout

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
    return extension("scene.usd_process")


def value(path, attribute, frame=None, mesh="geo/sea/surface"):
    """An attribute of the mesh, as a program reads it that opens the asset."""
    from pxr import Usd

    stage = Usd.Stage.Open(str(path))
    stage.Reload()
    prim = stage.GetDefaultPrim().GetPath()
    time = Usd.TimeCode.Default() if frame is None else Usd.TimeCode(frame)
    return np.array(stage.GetAttributeAtPath(f"{prim}/{mesh}.{attribute}").Get(time), np.float64)


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


def contents(folder):
    return {path: path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


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
        with pytest.raises(RuntimeError, match="Select an ocean first"):
            operator()
    assert not bpy.ops.ocean.stop_usd.poll()
    assert bpy.ops.ocean.import_usd.poll()


@needs_usd
def test_the_file_browser_exports_what_was_chosen(ocean, tmp_path):
    ocean.ocean_tweak.usd.form = "points"
    assert bpy.ops.ocean.export_usd_as(filepath=str(tmp_path / "chosen" / "sea")) == {"FINISHED"}
    assert ocean.ocean_tweak.usd.file == "//chosen/sea.usd"
    assert (tmp_path / "chosen" / "sea.usd").is_file()


@needs_usd
def test_foreign_layers_stay_unless_asked(ocean, tmp_path):
    from pxr import Usd

    usd = ocean.ocean_tweak.usd
    usd.form, usd.file = "points", str(tmp_path / "set" / "mine.usd")
    foreign = tmp_path / "set" / "mtl.usd"
    foreign.parent.mkdir()
    Usd.Stage.CreateNew(str(foreign)).Save()
    before = contents(foreign.parent)
    with pytest.raises(RuntimeError, match=r"mtl\.usd is there already .*in Blender: Overwrite"):
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
    with pytest.raises(RuntimeError, match=f"{folder}.*: give yourself the right to write there"):
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


def drawn_by(draw, item):
    drawn = []
    context = SimpleNamespace(
        active_object=item, scene=bpy.context.scene, region=SimpleNamespace(width=300),
        preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),
    )  # fmt: skip
    draw(SimpleNamespace(layout=Layout(drawn)), context)
    return drawn


def test_the_panel_and_the_browser_show_the_choices(ocean, extension):
    panel, browser = extension("ui.panels.usd").OCEAN_PT_usd, extension("ui.usd_operators")
    always = {"form", "up_axis", "metres_per_unit", "subframes", "tiles", "proxy", "variants", "force"}
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
    draw = extension("ui.panels.usd").OCEAN_PT_usd.draw
    monkeypatch.setitem(sys.modules, "pxr", None)
    assert "pip install usd-core" in " ".join(drawn_by(draw, ocean))
    export = SimpleNamespace(done=3, left=12, factor=0.25, seconds_left=62.0, is_stopped=False)
    monkeypatch.setitem(process._running, ocean.session_uid, export)
    drawn = drawn_by(draw, ocean)
    assert "3 / 12, 1:02" in drawn
    assert "ocean.stop_usd" in drawn
    assert "ocean.export_usd" not in drawn


def test_the_menus_offer_both_ways(package):
    for menu, name in (("export", "draw_export_menu"), ("import", "draw_import_menu")):
        functions = getattr(bpy.types, f"TOPBAR_MT_file_{menu}").draw._draw_funcs
        assert name in [function.__name__ for function in functions]


def test_paths_can_be_relative(ocean, process):
    assert process.default_file(ocean) == "//usd/Ocean/Ocean.usd"
    assert process.usd_file(ocean) == Path(bpy.data.filepath).parent / "usd" / "Ocean" / "Ocean.usd"
