# SPDX-License-Identifier: GPL-3.0-or-later
"""Folders that hold a baked sequence, and those that do not."""

import dataclasses

import bpy
import pytest


@pytest.fixture
def sequences(extension, package):
    return extension("scene.image_sequence")


def test_found_by_folder_and_by_file(sequences, bake, make_parameters):
    baked = bake(make_parameters(), 1001, 1004)
    assert sequences.find_sequence(baked.directory) == baked
    assert sequences.find_sequence(baked.path(1003)) == baked


def test_one_of_several_is_found_by_file(sequences, bake, make_parameters):
    bake(make_parameters(), 1, 2, name="calm")
    storm = bake(make_parameters(), 5, 6, name="storm")
    assert sequences.find_sequence(storm.path(6)) == storm
    with pytest.raises(sequences.SequenceError, match="more than one: calm, storm"):
        sequences.find_sequence(storm.directory)


def test_refused(sequences, bake, make_parameters, tmp_path):
    baked = bake(make_parameters(), 1, 4)
    baked.path(3).unlink()
    for sequence, said in (
        (baked, "1 of the frames 1-4 have no file, the first of them .*sea_disp.0003.exr"),
        (dataclasses.replace(baked, name="lake"), "No files lake_disp.####.exr .*it holds sea"),
        (dataclasses.replace(baked, frames=(1, 10**9)), "Frames 1 and 1000000000 are 999999999 apart"),
        (dataclasses.replace(baked, directory=tmp_path / "nowhere"), "The folder .*nowhere does not exist"),
    ):
        with pytest.raises(sequences.SequenceError, match=said):
            sequence.check()
    with pytest.raises(sequences.SequenceError, match="has none"):
        sequences.find_sequence(tmp_path)
    with pytest.raises(sequences.SequenceError, match="neither a folder nor"):
        sequences.find_sequence(tmp_path / "picture.png")


def test_frames_for_a_render_are_counted_before_they_are_made(extension, capsys):
    frame_ranges = extension("export.farm.render_baked").frame_ranges
    assert frame_ranges("1-9:4,20") == [range(1, 10, 4), range(20, 21)]
    for text in ("1-600000,1-600000", "1,1000000000", "9" * 5000):
        with pytest.raises(SystemExit) as ended:
            frame_ranges(text)
        assert ended.value.code == 2
        assert "--frames" in capsys.readouterr().err


def test_images_of_an_area_are_refused(sequences, extension, core, make_parameters, tmp_path):
    parameters, area = make_parameters(), core.Area(60.0, 16, (5.0, -10.0))
    sink = extension("export.exr").ExrSequence(tmp_path, "sea", parameters, area=area)
    sink.write(1, core.Ocean(parameters).frame(1, sink.outputs, area))
    with pytest.raises(
        sequences.SequenceError, match=r"sea_disp\.0001\.exr shows an area, which does not repeat"
    ):
        sequences.load_sequence(sequences.find_sequence(tmp_path))


def test_nothing_is_added_for_a_sequence_that_cannot_be_used(
    sequences, bake, ocean_object, make_parameters, empty_scene
):
    baked = bake(make_parameters(), 1, 2)
    baked.path(1).write_bytes(b"no image")
    for sequence, said in ((baked, "cannot be read"), (None, "needs an image sequence")):
        with pytest.raises(sequences.SequenceError, match=said):
            ocean_object.add(empty_scene, make_parameters(), source="SEQUENCE", sequence=sequence)
    with pytest.raises(ValueError, match="method = 'MAGIC'"):
        ocean_object.add(empty_scene, make_parameters(), method="MAGIC")
    assert not empty_scene.objects
    assert not bpy.data.meshes
    assert not bpy.data.images


def test_source_without_files_is_shown(ocean_object, make_parameters, empty_scene):
    settings = ocean_object.add(empty_scene, make_parameters()).ocean_tweak
    settings.source = "SEQUENCE"
    assert "No image sequence is chosen" in settings.error
    settings.source = "LIVE"
    assert settings.error == ""


def test_oceans_share_an_image_of_the_same_files(ocean_object, bake, make_parameters, empty_scene):
    baked = bake(make_parameters(), 1, 2)
    seas = [
        ocean_object.add(empty_scene, make_parameters(), method, "SEQUENCE", baked)
        for method in ("NODES", "DISPLACE")
    ]
    assert len({sea.ocean_tweak.sequence_maps.disp for sea in seas}) == 1
    assert len([image for image in bpy.data.images if image.source == "SEQUENCE"]) == 1


def test_the_script_of_farms_knows_the_maps_that_blender_reads(extension):
    """It is complete by itself: it is not to import the extension."""
    script = extension("export.farm.render_baked")
    for name in extension("nodes.names").MAP_INPUTS:
        assert script._FILE.fullmatch(f"sea_{name}.0001.exr")["name"] == "sea"
    assert script._FILE.fullmatch("sea_slope.0001.exr") is None
