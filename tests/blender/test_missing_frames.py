# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames that were not baked are held, files that are gone are told: in the panel and in the modifier."""

import bpy
import numpy as np
import pytest

from .conftest import SAMPLES, evaluated_mesh, vertices
from .layouts import draw  # noqa: F401
from .surfaces import ALL_MAPS, read

METHODS = ("NODES", "DISPLACE")


@pytest.fixture
def baked(bake, make_parameters):
    """Frames 11 to 13 with all maps."""
    return bake(make_parameters(start_frame=11), 11, 13, maps=ALL_MAPS)


@pytest.fixture(params=METHODS)
def item(request, ocean_object, baked, make_parameters, empty_scene):
    empty_scene.frame_set(12)
    parameters = make_parameters(start_frame=11)
    return ocean_object.add(empty_scene, parameters, request.param, "SEQUENCE", baked)


def warnings(item):
    """What the modifiers tell, as (type, message)."""
    evaluated_mesh(item)
    nodes = [modifier for modifier in item.modifiers if modifier.type == "NODES"]
    return [(each.type, each.message) for modifier in nodes for each in modifier.node_warnings]


def test_frames_beyond_the_baked_ones_are_told_or_not(item, draw, empty_scene):  # noqa: F811
    assert warnings(item) == []
    for frame, held in ((10, 11), (14, 13)):
        empty_scene.frame_set(frame)
        assert warnings(item) == [("WARNING", f"Frame {frame} was not baked: frame {held} is held")]
        assert f"Frame {frame} has no file: frame {held} is held" in " ".join(draw(item))
    held = vertices(item)
    item.ocean_tweak.out_of_range = "HOLD"
    assert warnings(item) == []
    assert "has no file" not in " ".join(draw(item))
    np.testing.assert_array_equal(vertices(item), held)
    empty_scene.frame_set(13)
    np.testing.assert_allclose(vertices(item), held, atol=1e-6)


def test_what_is_wrong_stands_over_the_view_and_on_the_console(item, baked, extension, empty_scene, caplog):
    written = extension("ui.overlays").trouble_lines
    empty_scene.frame_set(11)
    assert written(600.0) == []
    baked.path(13).unlink()
    for _ in range(2):  # the console hears it once
        empty_scene.frame_set(13)
        item.ocean_tweak.repeats_x = 3 - item.ocean_tweak.repeats_x  # shown anew
    text = f"sea_disp.0013.exr is missing: bake it again or choose other files. Looked in {baked.directory}"
    assert " ".join(written(2000.0)) == f"{item.name}: {text}"
    assert max(map(len, written(300.0))) < 45
    assert [record.message for record in caplog.records] == [f"{item.name}, frame 13: {text}"]
    empty_scene.frame_set(12)
    assert written(600.0) == []
    item.ocean_tweak.source = "LIVE"
    item.ocean_tweak.resolution = 33
    (line,) = written(2000.0)
    assert "resolution = 33: must be an even number" in line
    item.ocean_tweak.resolution = 32
    assert written(2000.0) == []


def test_a_missing_file_is_told(item, baked, draw, empty_scene):  # noqa: F811
    baked.path(13).unlink()
    empty_scene.frame_set(11)
    assert item.ocean_tweak.missing_file == ""
    empty_scene.frame_set(13)
    assert item.ocean_tweak.missing_file == str(baked.path(13))
    assert "sea_disp.0013.exr is missing: bake it again or choose other files" in " ".join(draw(item))
    (told,) = warnings(item)
    assert told[0] == "ERROR"
    assert "The displacement image of frame 13 is missing or cannot be read" in told[1]
    empty_scene.frame_set(12)
    assert item.ocean_tweak.missing_file == ""
    assert warnings(item) == []
    empty_scene.frame_set(20)  # the frame that would be held
    assert item.ocean_tweak.missing_file == str(baked.path(13))


def test_a_file_of_another_map_that_is_missing_is_told_too(item, baked, empty_scene):
    baked.path(13, "foam").unlink()
    empty_scene.frame_set(13)
    assert item.ocean_tweak.missing_file == str(baked.path(13, "foam"))
    found = read(evaluated_mesh(item), SAMPLES + 1, SAMPLES + 1)
    assert "foam" not in found
    assert "velocity" in found


def test_files_that_are_gone_do_not_keep_settings_from_changing(item, baked, empty_scene):
    for path in baked.path(11).parent.iterdir():
        path.unlink()
    item.ocean_tweak.repeats_x = 2
    assert item.ocean_tweak.error == ""
    assert item.ocean_tweak.missing_file == str(baked.path(12))
    assert warnings(item)[0][0] == "ERROR"
    item.ocean_tweak.source = "LIVE"
    assert item.ocean_tweak.missing_file == ""
    assert warnings(item) == []


def test_a_deleted_image_is_told(item, empty_scene):
    bpy.data.images.remove(item.ocean_tweak.sequence_maps.disp)
    empty_scene.frame_set(13)
    item.ocean_tweak.repeats_x = 2
    assert "No image sequence is chosen" in item.ocean_tweak.error
    assert warnings(item)[0][0] == "ERROR"


def test_a_damaged_file_is_told(item, baked, empty_scene):
    baked.path(13).write_bytes(b"no image")
    empty_scene.frame_set(13)
    assert warnings(item)[0][0] == "ERROR"


@pytest.mark.parametrize("map_name", ["foam", "vel"])
def test_a_map_with_gaps_is_refused(ocean_object, bake, make_parameters, empty_scene, map_name):
    baked = bake(make_parameters(), 1, 3, maps=ALL_MAPS)
    baked.path(2, map_name).unlink()
    with pytest.raises(ValueError, match=f"1 of the frames 1-3 have no file.*sea_{map_name}.0002.exr"):
        ocean_object.add(empty_scene, make_parameters(), source="SEQUENCE", sequence=baked)


def test_maps_of_different_size_are_refused(ocean_object, bake, make_parameters, empty_scene):
    baked = bake(make_parameters(), 1, 2)
    bake(make_parameters(resolution=16), 1, 2, maps=("foam",))
    with pytest.raises(ValueError, match=r"sea_foam\.0001\.exr is 16 texels wide, the displacement 32"):
        ocean_object.add(empty_scene, make_parameters(), source="SEQUENCE", sequence=baked)


@pytest.mark.parametrize("method", METHODS)
def test_a_mesh_without_vertices_makes_no_trouble(ocean_object, make_parameters, empty_scene, method):
    item = ocean_object.add(empty_scene, make_parameters(), method)
    item.data.clear_geometry()
    empty_scene.frame_set(3)
    assert item.ocean_tweak.error == ""
    assert len(evaluated_mesh(item).vertices) == 0


@pytest.mark.parametrize("method", METHODS)
def test_foam_that_does_not_last(ocean_object, core, make_parameters, empty_scene, method):
    parameters = make_parameters(foam=core.Foam(half_life=0.0))
    item = ocean_object.add(empty_scene, parameters, method)
    for frame in (5, 3):
        empty_scene.frame_set(frame)
        found = read(evaluated_mesh(item), SAMPLES + 1, SAMPLES + 1)["foam"][:-1, :-1, 0]
        wanted = core.Ocean(parameters).frame(frame, {"foam"}).foam
        np.testing.assert_allclose(found, wanted, atol=1e-6)
