# SPDX-License-Identifier: GPL-3.0-or-later
"""A coast that is baked: points over the bed move it, in a Blender without the extension too."""

import json
from dataclasses import replace

import bpy
import numpy as np
import pytest

from . import coasts
from .coasts import fine_slope, values
from .other_blender import look, run_script

calm, ocean, coast_of = coasts.calm, coasts.ocean, coasts.coast_of
NAMES = ("displacement", "velocity", "foam", "breaking", "foam_age", "cusp")


@pytest.fixture
def saved(ocean, tmp_path, monkeypatch):
    """A file with three frames, in a folder that can be moved."""
    monkeypatch.delenv("OCEAN_TWEAK_CACHE", raising=False)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 3
    (tmp_path / "project").mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "project" / "shot.blend"))
    return scene


@pytest.fixture
def bed(ocean):
    """A fine one, turned and moved against the ocean, which is so too."""
    bed = fine_slope()
    ocean.location = bed.location = (20.0, -30.0, 1.0)
    ocean.rotation_euler.z = bed.rotation_euler.z = 0.4
    bpy.context.view_layer.update()
    ocean.ocean_tweak.coast.bed = bed
    assert bpy.ops.ocean.make_coast() == {"FINISHED"}
    return bed


@pytest.fixture
def coast(ocean, bed, coast_of):
    return coast_of(ocean)


def shown(item):
    mesh = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    fields = {name: values(mesh, name, 3 if name in NAMES[:2] else 1).copy() for name in NAMES}
    return {"position": values(mesh, "position", 3).copy(), **fields}


def wet_of(bed):
    return values(bed.evaluated_get(bpy.context.evaluated_depsgraph_get()).data, "wet").copy()


@pytest.mark.parametrize("method", ["NODES", "DISPLACE"])
def test_a_bake_moves_it_as_live(ocean, coast, bed, saved, extension, method):
    ocean.ocean_tweak.method = method
    live, wet = {}, {}
    for frame in (3, 1):
        saved.frame_set(frame)
        live[frame], wet[frame] = shown(coast), wet_of(bed)
    assert np.abs(live[3]["position"] - live[1]["position"]).max() > 0.05
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    settings = ocean.ocean_tweak
    assert (settings.source, settings.error, settings.bake_differs) == ("SEQUENCE", "", "")
    assert "displacement" not in coast.data.attributes
    assert "wet" not in bed.data.attributes
    for frame in (1, 3):
        saved.frame_set(frame)
        found = shown(coast)
        for name, expected in live[frame].items():
            # the first lines are 2500 m away, where a float has 0.2 mm
            np.testing.assert_allclose(found[name], expected, atol=5e-4, err_msg=f"{name} {frame}")
        # beds are read between the samples of the waves
        assert np.abs(wet_of(bed) - wet[frame]).mean() < 0.02
    assert ("DISPLACE" in {each.type for each in ocean.modifiers}) == (method == "DISPLACE")
    assert extension("scene.portability").needs_of(ocean) == ()
    assert not [text for modifier in coast.modifiers for text in modifier.node_warnings]
    bpy.ops.ocean.use_live()
    saved.frame_set(3)
    np.testing.assert_array_equal(shown(coast)["position"], live[3]["position"])
    np.testing.assert_array_equal(wet_of(bed), wet[3])
    assert [each.name for each in bed.modifiers] == []


def test_without_the_extension_it_moves_where_the_project_is_now(ocean, coast, bed, saved, tmp_path):
    live = {}
    for frame in (3, 1):
        saved.frame_set(frame)
        live[frame] = shown(coast)["position"]
    bpy.ops.ocean.bake()
    bpy.ops.wm.save_mainfile()
    (tmp_path / "project").rename(tmp_path / "moved")
    seen, said = look(tmp_path / "moved" / "shot.blend", [coast.name, bed.name], [1, 3], tmp_path)
    assert "ERROR" not in said
    assert "stand still" not in said
    for frame in (1, 3):
        for kind in ("viewport", "render"):
            np.testing.assert_allclose(seen[f"{coast.name} {kind} {frame}"], live[frame], atol=5e-4)
        assert not len(seen[f"{coast.name} warnings {frame}"])


def test_frames_without_points_are_told(ocean, coast, saved, tmp_path):
    bpy.ops.ocean.bake()
    for path in tmp_path.rglob("*_coast.0003.ply"):
        path.unlink()
    bpy.ops.wm.save_mainfile()
    saved.frame_set(5)
    bpy.context.evaluated_depsgraph_get()
    held = [each.message for modifier in coast.modifiers for each in modifier.node_warnings]
    assert any("Frame 5 was not baked" in text for text in held)
    _, said = look(bpy.data.filepath, [coast.name], [3], tmp_path)
    assert "Ocean_coast.0003" in said


def test_a_bake_of_before_is_told_and_goes_on_live(ocean, coast, calm, saved, bake, extension):
    extension("scene.ocean_object").use_sequence(ocean, saved, bake(calm, 1, 3))
    (need,) = extension("scene.portability").needs_of(ocean)
    assert (need.name, need.remedy) == (coast.name, "bake it again")


def test_the_farm_renders_it_and_misses_what_is_lost(ocean, coast, saved, extension, tmp_path):
    saved.render.engine, saved.cycles.samples = "CYCLES", 1
    saved.render.resolution_x = saved.render.resolution_y = 8
    saved.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    saved.collection.objects.link(saved.camera)
    arguments = ["job", "--blend", bpy.data.filepath, "--out", str(tmp_path / "job"), "--frames", "1-3"]
    assert extension("registration").run_command(arguments) == 0
    assert "disp,coast" in (tmp_path / "job" / "template.json").read_text()
    bpy.ops.ocean.bake()
    bpy.ops.wm.save_mainfile()
    (tmp_path / "project" / "cache").rename(tmp_path / "farm")
    (folder,) = (path.parent for path in tmp_path.glob("farm/*/*/bake.json"))
    bake = f"{folder.parent.name}/{folder.name.rpartition('-')[2]}"
    arguments = ["--pictures", str(tmp_path / "out"), "--cache", str(tmp_path / "farm"), "--bake", bake]
    script = extension("export.farm.render_baked").__file__
    said = run_script(script, *arguments, "--frames", "2", blend=bpy.data.filepath)
    assert said.returncode == 0, said.stdout + said.stderr
    assert "coast.0002" not in said.stdout + said.stderr
    (folder / "Ocean_coast.0002.ply").unlink()
    said = run_script(script, *arguments, "--frames", "2", blend=bpy.data.filepath)
    assert said.returncode == 1
    assert "Ocean_coast.0002.ply is missing" in said.stderr


def test_what_reads_a_baked_coast_still_sees_it_and_is_named(ocean, coast, saved, extension, tmp_path):
    buoy = bpy.data.objects.new("Buoy", None)
    buoy.location = (130.0, 70.0, 0.0)
    floating, portability = extension("scene.floating"), extension("scene.portability")

    def height():
        saved.frame_set(3)
        return buoy.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation.z

    saved.collection.objects.link(buoy)
    floating.float_on(buoy, ocean, floating.Ride(tilt=0.0))
    live = height()
    floating.sink(buoy)
    bpy.context.view_layer.update()
    bpy.ops.ocean.bake()
    assert not [child.name for child in ocean.children if child.name.endswith("Bed")]
    assert portability.needs_of(ocean) == ()
    floating.float_on(buoy, ocean, floating.Ride(tilt=0.0))
    bpy.context.view_layer.update()
    assert height() == pytest.approx(live, abs=1e-3)
    (need,) = portability.needs_of(ocean)
    assert need.text == (
        "Buoy floats on the coast of Ocean, of which a bake moves the mesh only: bake the floating to keys"
    )
    bpy.ops.wm.save_mainfile()
    _, said = look(bpy.data.filepath, [coast.name], [1], tmp_path)
    assert "Ocean Tweak: live oceans stand still" in said


def test_it_moves_between_frames_by_its_velocity(ocean, coast, saved):
    """As motion blur in EEVEE asks, and in a slow motion of bakes."""
    saved.frame_set(2, subframe=0.25)
    live = shown(coast)["position"]
    bpy.ops.ocean.bake()
    saved.frame_set(2)
    begun = shown(coast)["position"]
    saved.frame_set(2, subframe=0.25)
    missed = np.abs(shown(coast)["position"] - live)
    assert np.abs(live - begun).max() > 0.01
    # in a hundredth of a second water hardly changes its velocity
    assert np.percentile(missed, 99) < 1e-3
    assert missed.max() < 0.2 * np.abs(live - begun).max()


@pytest.mark.parametrize("own", [True, False])
def test_a_bake_of_the_command_line_is_shown(
    ocean_object, coast_of, core, calm, saved, extension, tmp_path, own
):
    """On an ocean that has its coast from the bake, and on one with another coast."""
    depth = np.repeat(np.linspace(12.0, -1.0, 51)[np.newaxis], 51, axis=0)
    coast = core.Coast(depth=core.Raster(depth, "bed"), spacing=4.0, rim=80.0, shortest_wavelength=40.0)
    sea = calm.replace(coast=coast)
    (tmp_path / "sea.json").write_text(json.dumps(sea.to_dict()))
    arguments = ["bake", "--params", str(tmp_path / "sea.json"), "--frames", "1-3", "--maps", "disp,coast"]
    assert extension("registration").run_command([*arguments, "--out", str(tmp_path / "far")]) == 0
    (image,) = (tmp_path / "far").rglob("sea_disp.0001.exr")
    shallow = coast if own else replace(coast, depth=core.Raster(0.9 * depth, "shallow"))
    ocean = ocean_object.add(saved, calm if own else calm.replace(coast=shallow))
    bpy.context.view_layer.objects.active = ocean
    bpy.ops.ocean.use_sequence(filepath=str(image), use_parameters=own)
    assert ocean.ocean_tweak.error == ""
    assert bool(ocean.ocean_tweak.bake_differs) == (not own)
    found = []
    for frame in (1, 3):
        saved.frame_set(frame)
        found.append(shown(coast_of(ocean)))
    assert np.abs(found[1]["position"] - found[0]["position"]).max() > 0.05
    # of the bake, not of the settings
    whole = core.Ocean(sea)
    rest = values(coast_of(ocean).data, "position", 3).astype(np.float64)
    expected = whole.frame(3, on=core.Places(rest[:, 0], rest[:, 1])).displacement
    np.testing.assert_allclose(found[1]["displacement"], expected, atol=1e-3)
