# SPDX-License-Identifier: GPL-3.0-or-later
"""A coast goes with its ocean and its bed, and says where it stands still: over a bake, linked, alone."""

import bpy
import numpy as np
import pytest

from . import coasts
from .coasts import slope, values
from .other_blender import look, run_script

# fixtures for every test here
calm, ocean, coast_of, coast = coasts.calm, coasts.ocean, coasts.coast_of, coasts.coast


def test_it_goes_when_it_is_switched_off(ocean, coast_of):
    settings = ocean.ocean_tweak
    settings.coast.bed = slope()
    bpy.ops.ocean.make_coast()
    settings.coast.use = False
    assert coast_of(ocean) is None
    assert not ocean.hide_render


def test_the_ocean_is_shown_as_before_when_it_goes(ocean, coast_of):
    coast, ocean.display_type = ocean.ocean_tweak.coast, "WIRE"
    coast.bed = slope()
    for was_hidden in (True, False):
        ocean.hide_render = was_hidden
        bpy.ops.ocean.make_coast()
        bpy.context.scene.frame_set(5)
        assert (ocean.hide_render, ocean.display_type) == (True, "BOUNDS")
        coast.use = False
        assert (ocean.hide_render, ocean.display_type) == (was_hidden, "WIRE")


@pytest.mark.parametrize("how", ["use", "muted", "bed"])
def test_a_bed_dries_when_it_is_one_no_more(ocean, coast_of, how):
    coast, bed, own = ocean.ocean_tweak.coast, slope(), slope("Own")
    own.data.attributes.new("wet", "FLOAT", "POINT")
    coast.bed = bed
    bpy.ops.ocean.make_coast()
    assert "wet" in bed.data.attributes
    if how == "bed":
        coast.bed = own
        bpy.ops.ocean.make_coast()
    else:
        setattr(coast, how, not getattr(coast, how))
    assert "wet" not in bed.data.attributes
    coast.use = False
    assert "wet" in own.data.attributes  # it was there before


def test_a_deleted_bed_is_not_read(ocean, coast_of, window):
    bed = ocean.ocean_tweak.coast.bed = slope()
    bpy.ops.ocean.make_coast()
    for item in bpy.context.scene.objects:
        item.select_set(item == bed)
    with window.override():
        bpy.ops.object.delete()
    assert ocean.ocean_tweak.coast.bed is not None
    with pytest.raises(RuntimeError, match="Bed was deleted: choose another mesh"):
        bpy.ops.ocean.make_coast()


def test_it_goes_with_its_ocean(ocean, coast, window):
    for item in bpy.context.scene.objects:
        item.select_set(item == ocean)
    with window.override():
        bpy.ops.object.delete()
    bpy.context.view_layer.update()
    assert [item.name for item in bpy.context.scene.objects] == ["Bed"]


def test_a_converted_ocean_is_seen(ocean, coast, window):
    for item in bpy.context.scene.objects:
        item.select_set(item == ocean)
    with window.override():
        bpy.ops.object.convert(target="MESH")
    bpy.context.view_layer.update()
    assert sorted(item.name for item in bpy.context.scene.objects) == ["Bed", "Ocean"]
    assert not ocean.hide_render


def test_an_edited_coast_is_told(ocean, coast, window):
    bpy.context.view_layer.objects.active = coast
    with window.override():
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.context.scene.frame_set(6)
        assert "leave Edit Mode" in ocean.ocean_tweak.error
        bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.scene.frame_set(7)
    assert ocean.ocean_tweak.error == ""


def test_over_a_bake_the_coast_goes_on_live_and_says_so(ocean, coast, calm, bake, extension):
    scene = bpy.context.scene
    assert [need.text for need in extension("scene.portability").needs_of(ocean)] == [
        "Ocean is computed live: bake it"
    ]
    extension("scene.ocean_object").use_sequence(ocean, scene, bake(calm, 1, 6))
    scene.frame_set(2)
    before = values(coast.data, "displacement", 3).copy()
    scene.frame_set(5)
    assert np.abs(values(coast.data, "displacement", 3) - before).max() > 0.01
    assert [need.name for need in extension("scene.portability").needs_of(ocean)] == ["Ocean Coast"]


@pytest.mark.parametrize("overridden", [False, True])
def test_a_linked_coast_says_that_it_stands_and_an_override_moves(
    ocean, coast, tmp_path, overridden, coast_of
):
    scene = bpy.context.scene
    beach = bpy.data.collections.new("Beach")
    scene.collection.children.link(beach)
    for item in list(scene.collection.objects):
        beach.objects.link(item)
        scene.collection.objects.unlink(item)
    file = str(tmp_path / "beach.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(file, link=True) as (_, chosen):
        chosen.collections = ["Beach"]
    scene, beach = bpy.context.scene, bpy.data.collections["Beach"]
    scene.collection.children.link(beach)
    if overridden:
        beach = beach.override_hierarchy_create(scene, bpy.context.view_layer)
    shown = coast_of(next(item for item in beach.all_objects if item.ocean_tweak.is_ocean))
    found = []
    for frame in (2, 5):
        scene.frame_set(frame)
        found.append(values(shown.data, "displacement", 3).copy())
    if overridden:
        assert np.abs(found[1] - found[0]).max() > 0.01
    else:
        assert "make a library override" in shown.parent.ocean_tweak.error


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    """Save the file and move it to another folder; gives its path there."""
    monkeypatch.delenv("OCEAN_TWEAK_CACHE", raising=False)
    project, moved = tmp_path / "project", tmp_path / "moved"
    project.mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(project / "shot.blend"))

    def move():
        bpy.ops.wm.save_mainfile()
        project.rename(moved)
        return moved / "shot.blend"

    return move


@pytest.mark.parametrize("baked", [False, True])
def test_without_the_extension_it_stands_and_says_so(
    ocean, coast, calm, bake, extension, elsewhere, tmp_path, baked
):
    scene = bpy.context.scene
    if baked:
        extension("scene.ocean_object").use_sequence(ocean, scene, bake(calm, 1, 12))
    scene.frame_set(12)
    held = values(coast.data, "position", 3)
    seen, said = look(elsewhere(), [coast.name], [1, 12], tmp_path)
    assert "Ocean Tweak: live oceans stand still" in said
    for frame in (1, 12):
        np.testing.assert_allclose(seen[f"{coast.name} render {frame}"], held, atol=1e-6)
        told = seen[f"{coast.name} warnings {frame}"]
        assert any(text.startswith("The coast stands still as it was in frame 12 ") for text in told)
        assert any(text.endswith("enable the extension, or bake the ocean") for text in told)


def test_where_the_extension_runs_it_says_nothing_and_exports_move(ocean, coast, tmp_path):
    scene = bpy.context.scene
    scene.frame_set(2)
    moving = coast.evaluated_get(bpy.context.evaluated_depsgraph_get())
    assert not [text for modifier in coast.modifiers for text in modifier.node_warnings]
    assert "velocity" in moving.data.attributes
    if not bpy.app.build_options.alembic:
        pytest.skip("this Blender was built without Alembic")
    path, name = str(tmp_path / "coast.abc"), coast.name
    bpy.ops.wm.alembic_export(filepath=path, start=1, end=3, as_background_job=False)
    wanted = []
    for frame in (1, 3):
        scene.frame_set(frame)
        wanted.append(values(coast.data, "position", 3))
    assert np.abs(wanted[1] - wanted[0]).max() > 0.01
    bpy.data.objects.remove(coast)
    bpy.ops.wm.alembic_import(filepath=path, as_background_job=False)
    (item,) = (each for each in bpy.context.selected_objects if name.replace(" ", "_") in each.name)
    for frame, places in zip((1, 3), wanted, strict=True):
        scene.frame_set(frame)
        shown = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        np.testing.assert_allclose(values(shown, "position", 3), places, atol=1e-4)


def test_a_coast_of_a_file_without_the_modifier_gets_it(ocean, coast):
    coast.modifiers.clear()
    bpy.context.scene.frame_set(4)
    assert [each.name for each in coast.modifiers] == ["Ocean Tweak Coast"]


def test_the_farm_s_render_of_a_coast_over_a_bake_ends_with_3(
    ocean, coast, calm, bake, extension, elsewhere, tmp_path
):
    extension("scene.ocean_object").use_sequence(ocean, bpy.context.scene, bake(calm, 1, 2))
    script = extension("export.farm.render_baked").__file__
    folder = tmp_path / "Ocean-12345678" / "v001-01234567"
    folder.mkdir(parents=True)
    (folder / "bake.json").write_text('{"shot": {"domain_size": 200.0, "timing": {}}}')
    arguments = ["--cache", str(tmp_path), "--bake", "Ocean-12345678/01234567", "--frames", "1"]
    said = run_script(script, "--pictures", str(tmp_path / "out"), *arguments, blend=elsewhere())
    assert said.returncode == 3, said.stdout + said.stderr
    assert f"moves {coast.name} of " in said.stderr
