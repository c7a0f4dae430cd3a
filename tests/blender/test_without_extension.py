# SPDX-License-Identifier: GPL-3.0-or-later
"""A file that is opened in a Blender without the extension: what is baked moves, the rest says so."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from . import camera_views
from .camera_views import numbers
from .conftest import evaluated_mesh
from .layouts import Layout
from .other_blender import look, run_script
from .spray_points import points, spray_of

camera = camera_views.camera


@pytest.fixture
def saved(empty_scene, tmp_path, monkeypatch):
    """A file that has been saved, with three frames."""
    monkeypatch.delenv("OCEAN_TWEAK_CACHE", raising=False)
    empty_scene.frame_start, empty_scene.frame_end = 1, 3
    (tmp_path / "project" / "again").mkdir(parents=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "project" / "shot.blend"))
    return bpy.context.scene


@pytest.fixture
def patched(core, make_parameters):
    """Two patches; the second has more samples than a window reads."""
    layer = core.WaveLayer(wind_speed=8.0, fetch=20e3, wind_direction=0.4)
    patches = (
        core.Patch(domain_size=150.0, shortest_wavelength=12.0, resolution=64),
        core.Patch(
            domain_size=20.0, longest_wavelength=12.0, shortest_wavelength=3.0, rotation=0.6, resolution=512
        ),
    )
    return make_parameters(layers=(layer,), patches=patches, merged_resolution=32)


@pytest.fixture
def horizon(extension, ocean_object, patched, camera, saved):
    """An ocean of patches with a surface around the camera that ends a few metres away."""
    camera.location = (71.3, 52.9, 2.0)
    ocean = ocean_object.add(saved, patched)
    bpy.context.view_layer.objects.active = ocean
    surface = extension("scene.camera_surface").add_camera_surface(ocean, saved, budget=5000)
    inputs = {"Finest Spacing": 0.1, "To Horizon": False, "Reach": 6.0, "Fade": False}
    extension("nodes.modifier_inputs").set_inputs(surface.modifiers[0], inputs)
    bpy.context.view_layer.update()
    return ocean, surface


def positions(item):
    return numbers(evaluated_mesh(item), "position", 3)


def test_a_baked_horizon_moves(extension, horizon, saved, tmp_path):
    """Its project saved elsewhere, then moved. The render reads all samples, the window means of those."""
    ocean, surface = horizon
    live = {}
    for frame in (3, 1):
        saved.frame_set(frame)
        refresh = extension("scene.refresh")
        refresh.refresh(ocean, saved, refresh.Wanted.RENDER)  # all samples
        live[frame] = positions(surface)
    assert np.abs(live[3] - live[1]).max() > 0.05
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    assert all(not len(patch.data.vertices) for patch in ocean.children if "Patch" in patch.name)
    (tmp_path / "elsewhere" / "deep").mkdir(parents=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "project" / "again" / "shot.blend"))
    moved = tmp_path / "elsewhere" / "deep" / "project"
    (tmp_path / "project").rename(moved)
    seen, said = look(moved / "again" / "shot.blend", [surface.name], [1, 3], tmp_path)
    assert "ERROR" not in said
    for frame in (1, 3):
        # points are kept to a float, 150 m from the corner of the patch
        np.testing.assert_allclose(seen[f"{surface.name} render {frame}"], live[frame], atol=1e-4)
        # no wave is shorter than 38 means, of which half a sample is 2 cm
        np.testing.assert_allclose(seen[f"{surface.name} viewport {frame}"], live[frame], atol=1e-3)
        # foam around the camera is no part of a file: that of the ocean's own mesh takes its place
        assert not len(seen[f"{surface.name} warnings {frame}"])


def test_a_baked_horizon_that_is_live_again(horizon, saved):
    _, surface = horizon
    saved.frame_set(2)
    live = positions(surface)
    bpy.ops.ocean.bake()
    bpy.ops.ocean.use_live()
    np.testing.assert_array_equal(positions(surface), live)


def test_points_that_are_missing_are_told(horizon, saved, tmp_path):
    _, surface = horizon
    bpy.ops.ocean.bake()
    for path in tmp_path.rglob("*_p1_points.0003.ply"):
        path.unlink()
    bpy.ops.wm.save_mainfile()
    _, said = look(bpy.data.filepath, [surface.name], [3], tmp_path)
    assert "Ocean_p1_points.0003" in said


@pytest.mark.parametrize("own_render", [False, True])
@pytest.mark.parametrize("method", ["NODES", "DISPLACE"])
def test_a_live_sea_holds_and_says_so(
    ocean_object, make_parameters, evaluated, saved, tmp_path, method, own_render
):
    samples = 16 if own_render else 32
    ocean = ocean_object.add(saved, make_parameters(), method=method, viewport_resolution=samples)
    saved.frame_set(2)
    live = evaluated(ocean).reshape(-1, 3)
    assert np.ptp(live[:, 2]) > 0.5
    bpy.ops.wm.save_mainfile()
    seen, said = look(bpy.data.filepath, [ocean.name], [2, 3], tmp_path)
    assert said.count("Ocean Tweak: live oceans stand still") == 1
    for frame in (2, 3):
        for kind in ("viewport", "render"):
            np.testing.assert_allclose(seen[f"{ocean.name} {kind} {frame}"], live, atol=1e-4)
        told = seen[f"{ocean.name} warnings {frame}"]
        assert any(text.startswith("The sea stands still as it was in frame 2 ") for text in told)


def warnings_of(item):
    return [each.message for modifier in item.modifiers for each in getattr(modifier, "node_warnings", ())]


@pytest.mark.parametrize("method", ["NODES", "DISPLACE"])
def test_nothing_is_said_where_the_extension_runs(
    extension, ocean_object, make_parameters, saved, window, method, capfd
):
    """Opened anew, played back, rendered between frames, animated, undone, appended."""
    ocean = ocean_object.add(saved, make_parameters(), method=method, viewport_resolution=16)
    layer = ocean.ocean_tweak.layers[0]
    for frame in (1, 3):
        layer.wind_speed = 6.0 + frame
        layer.keyframe_insert("wind_speed", frame=frame)
    path = bpy.data.filepath
    bpy.ops.wm.save_mainfile()

    def check(scene):
        for frame in (2, 3):
            scene.frame_set(frame)
            assert not warnings_of(bpy.context.evaluated_depsgraph_get() and scene.objects[ocean_name])
        scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        scene.render.resolution_x = scene.render.resolution_y = 8
        scene.render.engine, scene.cycles.samples = "CYCLES", 1
        scene.render.use_motion_blur = True
        bpy.ops.render.render()
        assert not warnings_of(scene.objects[ocean_name])

    ocean_name = ocean.name
    with window.override():
        bpy.ops.ed.undo_push(message="as it is")
        ocean.ocean_tweak.choppiness = 0.3
        bpy.ops.ed.undo_push(message="less sharp")
        assert bpy.ops.ed.undo() == {"FINISHED"}
    check(bpy.context.scene)
    bpy.ops.wm.open_mainfile(filepath=path)
    check(bpy.context.scene)
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.wm.append(directory=f"{path}/Object/", filename=ocean_name)
    check(bpy.context.scene)
    out, err = capfd.readouterr()
    assert "stand still" not in out + err
    handlers = extension("scene.handlers")
    handlers.unregister()
    bpy.context.scene.frame_set(3)
    bpy.context.evaluated_depsgraph_get()
    assert warnings_of(bpy.context.scene.objects[ocean_name])
    handlers.register()
    bpy.context.scene.frame_set(2)
    assert not warnings_of(bpy.context.evaluated_depsgraph_get() and bpy.context.scene.objects[ocean_name])


def boat_on(ocean, extension):
    boat = bpy.data.objects.new("Boat", None)
    bpy.context.scene.collection.objects.link(boat)
    extension("scene.floating").float_on(boat, ocean)


def test_what_needs_the_extension_is_named(horizon, extension, tmp_path, capsys):
    """By one list, for the command line and the panel; a bake with points leaves nothing of it."""
    ocean, surface = horizon
    boat_on(ocean, extension)
    needs_of = extension("scene.portability").needs_of
    assert {need.name for need in needs_of(ocean)} == {ocean.name, surface.name, "Boat"}
    wanted = {need.name: need.text for need in needs_of(ocean)}
    assert (
        wanted["Boat"]
        == "Boat floats on Ocean, which is computed live: bake Ocean, or bake the floating to keys"
    )

    def job():
        capsys.readouterr()
        arguments = ["job", "--blend", bpy.data.filepath, "--out", str(tmp_path / "job"), "--frames", "1-3"]
        assert extension("registration").run_command(arguments) == 0
        return capsys.readouterr().out

    said = job()
    assert all(text in said for text in wanted.values())
    assert "disp,points" in (tmp_path / "job" / "template.json").read_text()
    panel = extension("ui.panels.output").OCEAN_PT_bake
    drawn = []
    context = SimpleNamespace(
        active_object=ocean, scene=bpy.context.scene, region=SimpleNamespace(width=1000),
        preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),
    )  # fmt: skip
    panel.draw(SimpleNamespace(layout=Layout(drawn)), context)
    assert "Renders Need Ocean Tweak" in drawn

    bpy.ops.ocean.bake()
    assert needs_of(ocean) == ()
    assert "computed live" not in job()
    for path in tmp_path.rglob("bake.json"):
        path.unlink()
    extension("scene.refresh").refresh(ocean, bpy.context.scene)
    (left,) = needs_of(ocean)
    assert left.name == surface.name
    assert "no points" in left.reason


def render(extension, blend, tmp_path, *arguments):
    script = extension("export.farm.render_baked").__file__
    return run_script(script, "--pictures", str(tmp_path / "pictures"), *arguments, blend=blend)


@pytest.mark.usefixtures("horizon")
def test_the_farm_s_render_reads_points_where_the_bake_is_now(extension, saved, tmp_path):
    saved.render.engine, saved.cycles.samples = "CYCLES", 1
    saved.render.resolution_x = saved.render.resolution_y = 8
    bpy.ops.ocean.bake()
    bpy.ops.wm.save_mainfile()
    (tmp_path / "project" / "cache").rename(tmp_path / "farm")
    (folder,) = (path.parent for path in tmp_path.glob("farm/*/*/bake.json"))
    bake = f"{folder.parent.name}/{folder.name.rpartition('-')[2]}"
    arguments = ["--cache", str(tmp_path / "farm"), "--bake", bake, "--frames", "3"]
    said = render(extension, bpy.data.filepath, tmp_path, *arguments)
    assert said.returncode == 0, said.stdout + said.stderr
    # opened at frame 1, the file still looked where the bake was
    assert "points.0003" not in said.stdout + said.stderr
    assert (tmp_path / "pictures" / "shot_0003.png").is_file()
    (folder / "Ocean_p2_points.0003.ply").unlink()
    said = render(extension, bpy.data.filepath, tmp_path, *arguments)
    assert said.returncode == 1
    assert "Ocean_p2_points.0003.ply is missing" in said.stderr


def test_the_farm_s_render_of_a_live_sea_ends_with_3(horizon, extension, tmp_path):
    ocean, _ = horizon
    folder = tmp_path / "Ocean-12345678" / "v001-01234567"
    folder.mkdir(parents=True)
    (folder / "bake.json").write_text('{"shot": {"domain_size": 150.0, "timing": {}}}')
    (folder / "Ocean_disp.0001.exr").touch()
    bpy.ops.wm.save_mainfile()
    arguments = ["--cache", str(tmp_path), "--bake", "Ocean-12345678/01234567", "--frames", "1"]
    said = render(extension, bpy.data.filepath, tmp_path, *arguments)
    assert said.returncode == 3, said.stdout + said.stderr
    (line,) = (line for line in said.stderr.splitlines() if line.startswith("render_baked: "))
    assert "no Ocean Tweak extension" in line
    assert f"moves {ocean.name} of " in line


def test_a_wake_over_a_bake_stands_and_says_so(core, extension, horizon, saved, tmp_path):
    """The tile goes on by its files, and the wake does not blur."""
    ocean, surface = horizon
    bpy.ops.ocean.bake()
    path = (core.PathSample(0.0, 60.0, 50.0), core.PathSample(10.0, 120.0, 50.0))
    wake = core.WakeLayer(path=path, length=12.0, beam=4.0, area_size=64.0, area_resolution=64)
    shown = ocean.ocean_tweak.to_parameters(saved)
    shown = shown.replace(layers=(*shown.layers, wake), patches=shown.patches)
    ocean.ocean_tweak.from_parameters(shown, saved)
    saved.frame_set(2)
    (area,) = (child for child in ocean.children if child.name.endswith("Area"))
    held = numbers(area.data, "position", 3)
    saved.frame_set(3)
    assert np.abs(numbers(area.data, "position", 3) - held).max() > 1e-3
    assert not warnings_of(area)
    saved.frame_set(2)
    bpy.ops.wm.save_mainfile()
    (tmp_path / "project").rename(tmp_path / "moved")
    blend = tmp_path / "moved" / "shot.blend"
    seen, said = look(blend, [surface.name], [1, 3], tmp_path)
    assert "Ocean Tweak: live oceans stand still" in said
    assert np.abs(seen[f"{surface.name} render 3"] - seen[f"{surface.name} render 1"]).max() > 0.05
    said = render_as_a_farm(extension, blend, tmp_path)
    assert said.returncode == 3, said.stdout + said.stderr
    assert f"moves {area.name} of " in said.stderr
    # it is baked already
    assert "bake the ocean" not in said.stderr
    assert "panel Bake lists under Renders Need Ocean Tweak" in said.stderr


def render_as_a_farm(extension, blend, tmp_path):
    """Frame 1 of a file by the script of a farm, without the extension."""
    folder = tmp_path / "Ocean-12345678" / "v001-01234567"
    folder.mkdir(parents=True)
    (folder / "bake.json").write_text('{"shot": {"domain_size": 150.0, "timing": {}}}')
    arguments = ["--cache", str(tmp_path), "--bake", "Ocean-12345678/01234567", "--frames", "1"]
    script = extension("export.farm.render_baked").__file__
    return run_script(script, "--pictures", str(tmp_path / "out"), *arguments, blend=blend)


@pytest.mark.parametrize("what", ["spray", "current"])
def test_a_bake_moves_and_what_it_lacks_is_told(
    extension, ocean_object, make_parameters, saved, tmp_path, what
):
    ocean = ocean_object.add(saved, make_parameters())
    settings = ocean.ocean_tweak
    bpy.context.view_layer.objects.active = ocean
    buoy = bpy.data.objects.new("Buoy", None)
    saved.collection.objects.link(buoy)
    floating = extension("scene.floating")
    floating.float_on(buoy, ocean, floating.Ride(drift=1.0))
    if what == "current":
        settings.use_current = True
        settings.current.speed = 2.0
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    settings.use_spray = what == "spray"
    bpy.context.view_layer.update()
    lacking, begins = {
        "spray": (ocean.name, "There is no spray as in frame 2 because"),
        "current": ("Buoy", "What floats here has drifted as far as in frame 2 because"),
    }[what]
    assert [need.name for need in extension("scene.portability").needs_of(ocean)] == [lacking]
    saved.frame_set(2)
    (carrier,) = (item for item in bpy.data.objects if extension("scene.float_carrier").is_carrier(item))
    teller = ocean if what == "spray" else carrier
    name, before = teller.name, [modifier.name for modifier in teller.modifiers]
    bpy.ops.wm.save_mainfile()
    assert [modifier.name for modifier in teller.modifiers] == before
    blend = tmp_path / "project" / "shot.blend"
    seen, said = look(blend, [ocean.name], [1, 3], tmp_path)
    assert "as the extension does not run here" in said
    moved = seen[f"{ocean.name} render 3"] - seen[f"{ocean.name} render 1"]
    assert np.abs(moved).max() > 0.05
    if what == "spray":
        assert any(text.startswith(begins) for text in seen[f"{ocean.name} warnings 1"])
    said = render_as_a_farm(extension, blend, tmp_path)
    assert said.returncode == 3, said.stdout + said.stderr
    assert f"moves {name} of " in said.stderr
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    assert [modifier.name for modifier in bpy.data.objects[name].modifiers] == before


@pytest.mark.parametrize(("wind_speed", "is_older"), [(6.0, False), (12.0, True)])
def test_spray_of_bows_is_in_the_bake_and_told_where_an_older_one_lacks_it(
    core, extension, ocean_object, make_parameters, camera, saved, tmp_path, caplog, wind_speed, is_older
):
    """In the panel's list, on the console, and in the file."""
    waves = core.WaveLayer(wind_speed=wind_speed, fetch=80e3)
    path = (core.PathSample(0.0, 60.0, 50.0), core.PathSample(10.0, 120.0, 50.0))
    wake = core.WakeLayer(path=path, length=12.0, beam=4.0, area_size=64.0, area_resolution=64)
    sea = make_parameters(layers=(waves,), spray=core.Spray(life=0.5))
    ocean = ocean_object.add(saved, sea)
    bpy.context.view_layer.objects.active = ocean
    extension("scene.camera_surface").add_camera_surface(ocean, saved, budget=5000)
    both = sea.replace(layers=(waves, wake))
    if is_older:  # made before there was a wake
        assert bpy.ops.ocean.bake() == {"FINISHED"}
    ocean.ocean_tweak.from_parameters(both, saved)
    if not is_older:
        assert bpy.ops.ocean.bake() == {"FINISHED"}
    saved.frame_set(2)
    assert not extension("scene.spray").is_live(ocean)
    texts = [need.text for need in extension("scene.portability").needs_of(ocean) if need.name == ocean.name]
    wanted = ["Ocean has spray of bows, which its bake has not: bake it again"]
    assert texts == (wanted if is_older else [])
    assert ("the baked spray has none of bows: bake it again" in caplog.text) == is_older
    places = points(spray_of(ocean))["position"]
    at_bow = np.hypot(places[:, 0] - 66.3, places[:, 1] - 50.0) < 6.0
    assert is_older or at_bow.sum() > 10
    bpy.ops.wm.save_mainfile()
    (tmp_path / "project").rename(tmp_path / "moved")
    seen, _ = look(tmp_path / "moved" / "shot.blend", [ocean.name], [1, 3], tmp_path)
    told = [text for text in seen[f"{ocean.name} warnings 3"] if text.startswith("There is no spray")]
    wanted = ["There is no spray of bows and of breakers on a coast as in frame 2"]
    assert [text.partition(" because")[0] for text in told] == (wanted if is_older else [])


@pytest.mark.parametrize("damped", [True, False])
def test_a_bake_says_what_is_damped_no_longer(extension, ocean_object, make_parameters, saved, capfd, damped):
    ocean = ocean_object.add(saved, make_parameters())
    boat = bpy.data.objects.new("Boat", None)
    saved.collection.objects.link(boat)
    floating = extension("scene.floating")
    floating.float_on(boat, ocean, floating.Ride(damped=damped, waterline=8.0))
    bpy.context.view_layer.objects.active = ocean
    capfd.readouterr()
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    assert ("Boat follows the surface of the bake" in "".join(capfd.readouterr())) == damped
