# SPDX-License-Identifier: GPL-3.0-or-later
"""Bakes with steps, with gaps, of single frames and of frames before 0: shown, without this extension too."""

import bpy
import numpy as np
import pytest

from .conftest import vertices
from .other_blender import look
from .surfaces import ALL_MAPS
from .test_missing_frames import METHODS, warnings

#: the frames of a bake, and a frame that it lacks with the one that is held there
BAKES = {
    "step": ((1, 3, 5, 7, 9), {2: 1, 8: 7, 20: 9, -4: 1}),
    "apart": ((1, 2, 3, 50, 51), {4: 3, 49: 3, 60: 51}),
    "early": ((-1234, -3, -2, 0, 4), {-4: -1234, -1: -2, 3: 0}),
    "all early": ((-3, -2), {-9: -3, 1: -2}),
    "pick-up": ((12,), {11: 12, 13: 12}),
}


@pytest.fixture
def baked(ocean_object, bake, make_parameters, empty_scene):
    """Make an ocean that reads some of the frames of a bake."""

    def make(frames, method, name="Ocean", **changes):
        sequence = bake(make_parameters(**changes), frames=frames, name=name, maps=ALL_MAPS)
        return ocean_object.add(
            empty_scene, make_parameters(**changes), method, "SEQUENCE", sequence, name=name
        )

    return make


def others(frames, held):
    """The frames to look at, and those that they show."""
    return [*((frame, frame) for frame in frames), *held.items()]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", BAKES)
def test_each_frame_shows_its_file_or_the_one_before(
    baked, make_parameters, expected, empty_scene, method, name
):
    frames, held = BAKES[name]
    item = baked(frames, method)
    for frame, shown in others(frames, held):
        empty_scene.frame_set(frame)
        np.testing.assert_allclose(vertices(item), expected(make_parameters(), shown), atol=2e-3)
        told = [("WARNING", f"Frame {frame} was not baked: frame {shown} is held")] if frame != shown else []
        assert warnings(item) == told
        assert item.ocean_tweak.missing_file == ""
    item.ocean_tweak.out_of_range = "HOLD"
    empty_scene.frame_set(next(iter(held)))
    assert warnings(item) == []


def test_a_blender_without_the_extension_shows_them(baked, make_parameters, expected, tmp_path):
    wanted = {}
    for method in METHODS:
        for kind, (frames, held) in BAKES.items():
            item = baked(frames, method, name=f"{method} {kind}")
            wanted[item.name] = dict(others(frames, held))
    file = tmp_path / "shot.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    frames = sorted(set().union(*wanted.values()))
    seen, _ = look(file, list(wanted), frames, tmp_path)
    for name, shown in wanted.items():
        for frame, baked_frame in shown.items():
            sea = expected(make_parameters(), baked_frame)[..., 2]
            heights = seen[f"{name} viewport {frame}"][:, 2]
            np.testing.assert_allclose(heights, sea.ravel(), atol=2e-3, err_msg=f"{name}, frame {frame}")


def test_frames_that_are_baked_later_are_used(ocean, expected, make_parameters, empty_scene):
    empty_scene.frame_start, empty_scene.frame_end, empty_scene.frame_step = 1, 7, 3
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    assert ocean.ocean_tweak.sequence_frames == "1-7x3"
    empty_scene.frame_set(3)
    np.testing.assert_allclose(vertices(ocean), expected(make_parameters(), 1), atol=2e-3)
    empty_scene.frame_step = 1
    assert bpy.ops.ocean.bake() == {"FINISHED"}
    assert ocean.ocean_tweak.sequence_frames == "1-7"
    for frame in (2, 3, 4, 7):
        empty_scene.frame_set(frame)
        np.testing.assert_allclose(vertices(ocean), expected(make_parameters(), frame), atol=2e-3)


def test_a_file_from_before_there_were_gaps(baked, make_parameters, expected, empty_scene):
    item = baked((1, 2, 3), "NODES")
    settings = item.ocean_tweak
    settings.sequence_frames, settings.sequence_first, settings.sequence_last = "", 1, 3
    settings.repeats_x = 1
    for frame, shown in ((0, 1), (2, 2), (9, 3)):
        empty_scene.frame_set(frame)
        np.testing.assert_allclose(vertices(item), expected(make_parameters(), shown), atol=2e-3)


def test_what_floats_on_a_bake_with_gaps_stays_on_it(baked, extension, empty_scene):
    item = baked((-3, 1, 5), "NODES")
    boat = bpy.data.objects.new("Boat", bpy.data.meshes.new("Boat"))
    boat.location = (60.0, 60.0, 0.0)
    empty_scene.collection.objects.link(boat)
    empty_scene.view_layers.update()
    extension("scene.floating").float_on(boat, item)
    live = {frame: height_of(boat, empty_scene, frame) for frame in range(-4, 7)}
    ride = extension("scene.floating").Ride()
    bake = extension("scene.float_bake").FloatBake(empty_scene, [boat], item, lambda _: ride, range(-4, 7))
    for _ in bake.frames:
        bake.advance()
    bake.finish()
    assert len({round(height, 4) for height in live.values()}) == 3
    for frame, height in live.items():
        assert height_of(boat, empty_scene, frame) == pytest.approx(height, abs=1e-3)


def height_of(item, scene, frame):
    scene.frame_set(frame)
    return item.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation.z


def test_what_a_file_says_may_be_anything(baked, empty_scene):
    """Strings that a stranger's file stores: nothing fails, and no list of all frames is made."""
    settings = baked((1, 2), "NODES").ocean_tweak
    for text, first, last in (
        ("water", 0, 0),
        ("1-2x0", 0, 0),
        ("0-999999999x9", 0, 0),
        ("", 5, 1),
        ("1.5", 1, 2),
    ):
        settings.sequence_frames, settings.sequence_first, settings.sequence_last = text, first, last
        settings.sequence_stretch = text
        settings.repeats_x = 1
        empty_scene.frame_set(1)
        assert settings.error == ""
        assert "0000.exr" in settings.missing_file


def test_a_file_of_a_frame_that_no_scene_has_is_none(bake, make_parameters, extension):
    sequence = bake(make_parameters(), 1, 2)
    for number in ("9999999999", "-9999999999"):
        sequence.path(1).with_name(f"sea_disp.{number}.exr").write_bytes(b"")
    assert extension("scene.image_sequence").find_sequence(sequence.directory) == sequence
