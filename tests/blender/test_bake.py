# SPDX-License-Identifier: GPL-3.0-or-later
"""Baking from Blender: the frames are the core's, they lie where they should, and nothing is lost."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import bpy
import numpy as np
import pytest

TOLERANCE = 2e-3  # m; images keep 2⁻¹⁶ of their values


@pytest.fixture
def saved(empty_scene, tmp_path, monkeypatch):
    """A file that has been saved, with four frames."""
    monkeypatch.delenv("OCEAN_TWEAK_CACHE", raising=False)
    empty_scene.frame_start, empty_scene.frame_end = 1, 4
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))
    return bpy.context.scene


@pytest.fixture
def ocean(saved, ocean_object, make_parameters):
    item = ocean_object.add(saved, make_parameters())
    bpy.context.view_layer.objects.active = item
    item.ocean_tweak.use_foam = False  # it looks back over many surfaces
    return item


def bakes(folder):
    return sorted(path.parent for path in folder.glob("cache/*/v*/bake.json"))


def test_a_bake_lies_beside_the_file_and_moves_the_ocean(
    ocean, make_parameters, expected, evaluated, saved, tmp_path
):
    ocean.ocean_tweak.use_foam = True
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    (folder,) = bakes(tmp_path)
    assert folder.parent.name == f"Ocean-{ocean.ocean_tweak.uid}"
    assert len(list(folder.glob("*.exr"))) == 4 * 5  # frames times maps
    assert ocean.ocean_tweak.source == "SEQUENCE"
    for frame in (4, 2):
        saved.frame_set(frame)
        np.testing.assert_allclose(evaluated(ocean), expected(make_parameters(), frame), atol=TOLERANCE)


def test_another_sea_gets_another_version(ocean, tmp_path):
    bpy.ops.ocean.bake()
    (first,) = bakes(tmp_path)
    before = {path.name: path.read_bytes() for path in first.glob("*.exr")}
    ocean.ocean_tweak.layers[0].wind_speed = 8.0
    bpy.ops.ocean.bake()
    versions = bakes(tmp_path)
    assert [folder.name[:5] for folder in versions] == ["v001-", "v002-"]
    assert {path.name: path.read_bytes() for path in first.glob("*.exr")} == before
    assert Path(bpy.path.abspath(ocean.ocean_tweak.sequence_maps.disp.filepath)).parent == versions[1]


def test_a_bake_goes_on(ocean, package, tmp_path):
    bpy.ops.ocean.bake()
    (folder,) = bakes(tmp_path)
    kept = {path.name: path.stat().st_mtime_ns for path in folder.glob("*.exr") if ".0003." not in path.name}
    for path in folder.glob("*.0003.exr"):
        path.unlink()
    chosen = bpy.context.preferences.addons[package].preferences
    chosen.write_log = True
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    chosen.write_log = False
    assert len(list(folder.glob("*.exr"))) == 4 * 3
    assert {name: (folder / name).stat().st_mtime_ns for name in kept} == kept
    assert "frame 3 (1/1)" in folder.with_suffix(".log").read_text()


def test_the_baked_sea_is_animated_too(ocean, core, make_parameters, extension, saved, tmp_path):
    layer = ocean.ocean_tweak.layers[0]
    for frame, wind in ((1, 6.0), (4, 12.0)):
        layer.wind_speed = wind
        layer.keyframe_insert("wind_speed", frame=frame)
    saved.frame_set(2)
    bpy.context.view_layer.update()
    shown = ocean.ocean_tweak.to_parameters(saved)
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    assert saved.frame_current == 2
    (folder,) = bakes(tmp_path)
    image, _ = extension("export.exr").read_image(folder / "Ocean_disp.0002.exr")
    assert 6.0 < shown.layers[0].wind_speed < 12.0
    surface = core.Ocean(shown).frame(2).displacement
    np.testing.assert_allclose(image, surface, atol=TOLERANCE)
    animation = json.loads((folder / "bake.json").read_text())["shot"]["animation"]
    assert animation["first_frame"] == 0
    assert len(animation["samples"]["layers.0.wind_speed"]) == 6


def test_duplicates_bake_beside_each_other(ocean, saved, tmp_path):
    bpy.ops.ocean.bake()
    twin = ocean.copy()
    twin.data = ocean.data.copy()
    saved.collection.objects.link(twin)
    twin.ocean_tweak.source = "LIVE"
    bpy.context.view_layer.objects.active = twin
    bpy.ops.ocean.bake()
    assert twin.ocean_tweak.uid != ocean.ocean_tweak.uid
    assert len(bakes(tmp_path)) == 2


def test_what_keeps_a_bake_from_being_made_is_said(ocean, tmp_path):
    (tmp_path / "cache").write_text("a file")
    with pytest.raises(RuntimeError, match="cache"):
        bpy.ops.ocean.bake()
    assert ocean.ocean_tweak.source == "LIVE"
    assert not extension_running(ocean)


def extension_running(item):
    bpy.context.view_layer.objects.active = item
    return bpy.ops.ocean.stop_bake.poll()


def test_bake_wants_an_ocean(empty_scene):
    for operator in (bpy.ops.ocean.bake, bpy.ops.ocean.stop_bake, bpy.ops.ocean.take_cache_along):
        assert not operator.poll()


def test_unsaved_files_bake_into_the_users_folder(
    empty_scene, ocean_object, make_parameters, extension, tmp_path, monkeypatch
):
    monkeypatch.delenv("OCEAN_TWEAK_CACHE", raising=False)
    place = extension("scene.cache_place")
    monkeypatch.setattr(place, "user_folder", lambda name: tmp_path / name)
    item = ocean_object.add(empty_scene, make_parameters())
    assert place.cache_folder(item) == tmp_path / "cache"
    monkeypatch.setenv("OCEAN_TWEAK_CACHE", str(tmp_path / "farm"))
    assert place.cache_folder(item) == tmp_path / "farm"
    item.ocean_tweak.cache_folder = str(tmp_path / "own")
    assert place.cache_folder(item) == tmp_path / "own"


def test_a_librarys_cache_is_beside_the_library(ocean, extension, tmp_path):
    bpy.ops.wm.save_mainfile()
    library = tmp_path / "assets" / "library.blend"
    library.parent.mkdir()
    shutil.move(bpy.data.filepath, library)
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "other.blend"))
    with bpy.data.libraries.load(str(library), link=True) as (source, target):
        target.objects = source.objects
    place = extension("scene.cache_place")
    assert place.cache_folder(target.objects[0]) == (library.parent / "cache").resolve()


def test_save_as_elsewhere_offers_to_take_the_bake_along(
    ocean, make_parameters, expected, evaluated, saved, tmp_path
):
    bpy.ops.ocean.bake()
    assert not bpy.ops.ocean.take_cache_along.poll()
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(elsewhere / "shot.blend"))
    saved.frame_set(3)
    np.testing.assert_allclose(evaluated(ocean), expected(make_parameters(), 3), atol=TOLERANCE)
    assert bpy.ops.ocean.take_cache_along() == {"FINISHED"}
    assert not bpy.ops.ocean.take_cache_along.poll()
    assert len(bakes(elsewhere)) == 1
    shutil.rmtree(tmp_path / "cache")
    saved.frame_set(2)
    np.testing.assert_allclose(evaluated(ocean), expected(make_parameters(), 2), atol=TOLERANCE)


@pytest.mark.parametrize("what", ["a link", "a folder's link", "a pipe"])
def test_nothing_is_taken_along_through_links(ocean, saved, extension, tmp_path, what):
    ocean.ocean_tweak.use_foam = False
    saved.frame_end = 1
    bpy.ops.ocean.bake()
    (folder,) = bakes(tmp_path)
    secret = tmp_path / "secret"
    secret.mkdir()
    (secret / "key").write_text("private")
    if what == "a pipe":
        os.mkfifo(folder / "other")
    else:
        (folder / "other").symlink_to(secret / "key" if what == "a link" else secret)
    ocean.ocean_tweak.cache_folder = str(tmp_path / "elsewhere")
    with pytest.raises(RuntimeError, match="other is a link or not a file"):
        bpy.ops.ocean.take_cache_along()
    assert not list((tmp_path / "elsewhere").rglob("*other*"))


def test_the_window_is_free_while_it_bakes(ocean, extension, saved):
    """What the running operator does: start, look, stop, and go on later."""
    process, shots = extension("scene.bake_process"), extension("scene.shots")
    frames = tuple(range(1, 200))
    bake = process.start(ocean, shots.shot_of(ocean, saved, frames), frames)
    assert process.running(ocean) is bake
    assert not bpy.ops.ocean.bake.poll()
    while bake.done < 3:
        assert not bake.has_ended(), bake.error
    assert 0.0 < bake.factor < 1.0
    assert bake.seconds_left > 0.0
    bpy.ops.ocean.stop_bake()
    bake.wait()
    assert bake.is_stopped
    assert not bake.is_complete
    process.forget(bake)
    assert process.running(ocean) is None
    made = sorted(int(path.stem) for path in bake.folder.glob("records/*.json"))
    assert 3 <= len(made) < 199
    missing = next(frame for frame in frames if frame not in made)
    again = process.start(ocean, shots.shot_of(ocean, saved, frames), (*made, missing))
    again.wait()
    process.forget(again)
    assert again.is_complete, again.error
    assert again.left == 1


def test_nothing_of_a_strangers_folder_or_file_is_obeyed(ocean, tmp_path, monkeypatch):
    """Modules beside the .blend file are not run, a name is no option, a uid is no path; no file is left."""
    folder, temporary = tmp_path / "sent", tmp_path / "temporary"
    folder.mkdir()
    temporary.mkdir()
    for module in ("numpy", "json", "argparse"):  # this process has them already
        (folder / f"{module}.py").write_text(f"open({str(folder / 'RUN')!r}, 'w')")
    monkeypatch.chdir(folder)
    monkeypatch.setattr(sys, "path", ["", *sys.path])
    monkeypatch.setenv("TMPDIR", str(temporary))
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    ocean.name = "-Sea"
    ocean.ocean_tweak.uid = "/../../elsewhere/x"
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    (baked,) = bakes(tmp_path)
    assert baked.parent == tmp_path / "cache" / f"-Sea-{ocean.ocean_tweak.uid}"
    assert not list(tmp_path.glob("**/elsewhere*"))
    assert not (folder / "RUN").exists()
    assert not list(temporary.iterdir())


#: a Blender whose bake is under way, which prints the number of the bake's process and never ends
BAKING = """
import bpy, sys, time
sys.path.insert(0, sys.argv[1])
import ocean_tweak.registration as registration
registration.register()
from ocean_tweak.core.parameters.ocean_parameters import OceanParameters
from ocean_tweak.scene import bake_process, ocean_object, shots
scene = bpy.context.scene
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[2])
item = ocean_object.add(scene, OceanParameters(resolution=64, domain_size=300.0))
frames = tuple(range(1, 5001))
bake = bake_process.start(item, shots.shot_of(item, scene, frames), frames)
print("pid", bake._process.pid, flush=True)
time.sleep(600)
"""


@pytest.mark.skipif("OCEAN_TWEAK_ZIP" in os.environ, reason="a Blender is no module of Python there")
def test_a_bake_ends_by_itself_when_its_blender_is_killed(package, tmp_path):
    """With whole frames and without its lock, so that Bake goes on with it at once."""
    root = Path(__file__).parents[2]
    blender = subprocess.Popen(
        [sys.executable, "-c", BAKING, str(root), str(tmp_path / "shot.blend")],
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        number = next(int(line.split()[1]) for line in blender.stdout if line.startswith("pid "))
        wait_for(lambda: len(list(tmp_path.glob("cache/*/v*/records/[0-9]*.json"))) > 2)
    finally:
        blender.kill()
        blender.communicate()
    wait_for(lambda: not Path(f"/proc/{number}").exists() or is_zombie(number))
    (folder,) = bakes(tmp_path)
    wait_for(lambda: not list(folder.glob(".*")))
    assert not list(folder.glob("locks/*.lock"))
    made = {record.stem for record in folder.glob("records/[0-9]*.json")}
    assert 2 < len(made) < 5000
    for image in folder.glob("*_disp.*.exr"):
        assert image.suffixes[0][1:] in made


def is_zombie(process):
    return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] == "Z"


def wait_for(condition):
    until = time.monotonic() + 60.0
    while not condition():
        assert time.monotonic() < until
        time.sleep(0.05)
