# SPDX-License-Identifier: GPL-3.0-or-later
"""`blender -b … -a`: a frame that cannot be shown ends the render in words, before its picture is written."""

import bpy
import pytest

EXIT_CODE = 3


@pytest.fixture
def shot(empty_scene, tmp_path):
    """A small ocean that a camera sees in four frames."""
    scene = empty_scene
    bpy.ops.mesh.ocean_tweak_add()
    item = bpy.context.active_object
    item.ocean_tweak.resolution = 32
    item.ocean_tweak.cache_folder = str(tmp_path / "cache")
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(scene.camera)
    scene.camera.location.z = 50.0
    scene.render.engine, scene.cycles.samples = "CYCLES", 1
    scene.render.resolution_x = scene.render.resolution_y = 16
    scene.frame_start, scene.frame_end = 1, 4
    scene.render.use_placeholder = True
    scene.render.filepath = str(tmp_path / "picture_")
    return item


@pytest.fixture
def render(run_blender, tmp_path):
    """Save the file and render its animation in another Blender; the process, and the pictures' frames."""

    def run():
        file = tmp_path / "shot.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(file))
        answer = run_blender("-b", file, "-a")
        return answer, sorted(int(path.stem[-4:]) for path in tmp_path.glob("picture_*"))

    return run


def lines(answer):
    return [line for line in answer.stderr.splitlines() if line.startswith("ocean_tweak: ")]


def test_settings_that_are_refused_end_the_render(shot, render):
    shot.ocean_tweak.resolution = 33
    answer, pictures = render()
    assert answer.returncode == EXIT_CODE, answer.stdout
    assert pictures == []
    assert set(lines(answer)) == {
        "ocean_tweak: Ocean, frame 1: resolution = 33: must be an even number from 16 to 8192"
    }
    assert "Traceback" not in answer.stderr


def test_an_ocean_that_is_not_rendered_ends_nothing(shot, render):
    shot.ocean_tweak.resolution = 33
    shot.hide_render = True
    answer, pictures = render()
    assert answer.returncode == 0, answer.stdout
    assert pictures == [1, 2, 3, 4]


def test_a_missing_frame_ends_the_render_and_an_unbaked_one_is_told_once(shot, render, tmp_path):
    bpy.context.scene.frame_end = 2
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    bpy.context.scene.frame_end = 4
    (folder,) = tmp_path.glob("cache/*/v*")
    answer, pictures = render()
    assert answer.returncode == 0, answer.stdout
    assert pictures == [1, 2, 3, 4]
    assert lines(answer) == [
        f"ocean_tweak: Ocean, frame 3: this frame was not baked, 2 is held; {folder} has 1-2"
    ]
    for path in tmp_path.glob("picture_*"):
        path.unlink()
    (folder / "Ocean_disp.0002.exr").unlink()
    answer, pictures = render()
    assert answer.returncode == EXIT_CODE, answer.stdout
    assert pictures == [1]
    assert lines(answer) == [
        "ocean_tweak: Ocean, frame 2: Ocean_disp.0002.exr is missing: bake it again or choose other files. "
        f"Looked in {folder}"
    ]
