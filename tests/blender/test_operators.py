# SPDX-License-Identifier: GPL-3.0-or-later
"""What the artist can press."""

import json
import resource
from fractions import Fraction

import bpy
import numpy as np
import pytest

TOLERANCE = 1e-4  # m


@pytest.fixture
def active(ocean_object, make_parameters, empty_scene):
    """A small ocean, active and selected."""
    item = ocean_object.add(empty_scene, make_parameters())
    bpy.context.view_layer.objects.active = item
    item.select_set(True)
    return item


def test_add_puts_down_the_default_sea_around_the_cursor(core, empty_scene, evaluated):
    empty_scene.cursor.location = (10.0, 20.0, 3.0)
    assert bpy.ops.mesh.ocean_tweak_add() == {"FINISHED"}
    item = bpy.context.active_object
    assert item.select_get()
    assert [other.name for other in bpy.context.selected_objects] == [item.name]
    assert tuple(item.location) == (10.0 - 200.0, 20.0 - 200.0, 3.0)
    sea = item.ocean_tweak.to_parameters(empty_scene)
    layer = sea.layers[0]
    assert (layer.wind_speed, layer.fetch, sea.water.depth, layer.swell) == (12.0, 150e3, 200.0, 0.3)
    assert (sea.domain_size, sea.resolution) == (400.0, 512)
    at_rest = evaluated(item)
    empty_scene.frame_set(12)
    assert np.abs(evaluated(item) - at_rest).max() > 0.5
    # the published height of this sea
    assert json.loads(item.ocean_tweak.statistics)["spectrum"]["significant_wave_height"] == pytest.approx(
        3.15, abs=0.01
    )


def test_add_in_centimetres_is_as_large(empty_scene):
    empty_scene.unit_settings.scale_length = 0.01
    bpy.ops.mesh.ocean_tweak_add(method="DISPLACE")
    item = bpy.context.active_object
    assert tuple(item.location) == (-20000.0, -20000.0, 0.0)
    assert item.ocean_tweak.to_parameters(empty_scene).domain_size == 400.0
    kinds = ["NODES", "DISPLACE", "DISPLACE", "NODES", "NODES", "NODES"]
    assert [modifier.type for modifier in item.modifiers] == kinds


def test_the_menu_offers_it():
    functions = bpy.types.VIEW3D_MT_mesh_add.draw._draw_funcs
    assert "draw_add_menu" in [function.__name__ for function in functions]


def test_export_and_import_give_the_same_sea(active, core, empty_scene, tmp_path, make_parameters):
    file = str(tmp_path / "sea.json")
    before = active.ocean_tweak.to_parameters(empty_scene)
    assert bpy.ops.ocean.export_parameters(filepath=file) == {"FINISHED"}
    assert core.OceanParameters.from_json((tmp_path / "sea.json").read_text()) == before
    active.ocean_tweak.from_parameters(make_parameters(seed=99, choppiness=0.1), empty_scene)
    assert bpy.ops.ocean.import_parameters(filepath=file) == {"FINISHED"}
    assert active.ocean_tweak.to_parameters(empty_scene) == before


def test_import_gives_the_scene_the_file_s_frame_rate(active, empty_scene, tmp_path, make_parameters):
    file = tmp_path / "sea.json"
    file.write_text(make_parameters(fps="30000/1001", start_frame=1001).to_json())
    bpy.ops.ocean.import_parameters(filepath=str(file), use_frame_rate=False)
    assert active.ocean_tweak.to_parameters(empty_scene).timing.fps == 24
    bpy.ops.ocean.import_parameters(filepath=str(file))
    timing = active.ocean_tweak.to_parameters(empty_scene).timing
    assert (timing.fps, timing.start_frame) == (Fraction(30000, 1001), 1001)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('{"depht": 3}', "depht"),
        ('{"water": {"depth": -3}}', "water.depth = -3"),
        ('{"layers": [', "not valid JSON"),
        ("[]", "JSON object"),
        (b"\xff\xfe", "utf-8"),
        (b" " * 64_000_001, "larger than 64 MB"),
    ],
)
def test_a_bad_file_is_refused_and_changes_nothing(active, empty_scene, tmp_path, text, said):
    before = active.ocean_tweak.to_parameters(empty_scene)
    file = tmp_path / "bad.json"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(RuntimeError, match=said):
        bpy.ops.ocean.import_parameters(filepath=str(file))
    with pytest.raises(RuntimeError, match="No such file"):
        bpy.ops.ocean.import_parameters(filepath=str(tmp_path / "missing.json"))
    assert active.ocean_tweak.to_parameters(empty_scene) == before


@pytest.mark.parametrize("export", ["parameters", "preset"])
def test_an_export_is_whole_or_the_old_file(active, tmp_path, export):
    file = tmp_path / "old.json"
    file.write_text("{}")
    key = {"key": "beaufort_05"} if export == "preset" else {}
    write = getattr(bpy.ops.ocean, f"export_{export}")
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, limits[1]))  # as a disk that has room for so many bytes
    try:
        with pytest.raises(RuntimeError, match=r"old\.json: File too large"):
            write(filepath=str(file), **key)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert file.read_text() == "{}"
    assert list(tmp_path.iterdir()) == [file]
    assert write(filepath=str(file), **key) == {"FINISHED"}
    assert json.loads(file.read_text())


def test_a_sea_of_several_patches_is_imported_and_exported(active, core, empty_scene, tmp_path):
    """Apart in the file it came from; on the samples that are rendered from then on."""
    patches = [{"domain_size": 90.0, "shortest_wavelength": 20.0, "resolution": 32},
               {"domain_size": 30.0, "longest_wavelength": 20.0, "resolution": 48}]  # fmt: skip
    file = tmp_path / "sea.json"
    file.write_text(json.dumps({"patches": patches}))
    bpy.ops.ocean.import_parameters(filepath=str(file))
    shown = active.ocean_tweak.to_parameters(empty_scene)
    assert shown == core.OceanParameters.from_json(file.read_text()).on_one_grid(32)
    assert bpy.ops.ocean.export_parameters(filepath=str(tmp_path / "again.json")) == {"FINISHED"}
    assert core.OceanParameters.from_json((tmp_path / "again.json").read_text()) == shown


def test_settings_that_are_no_sea_are_not_exported(active, tmp_path):
    active.ocean_tweak.resolution = 33
    with pytest.raises(RuntimeError, match="resolution = 33"):
        bpy.ops.ocean.export_parameters(filepath=str(tmp_path / "sea.json"))
    assert not list(tmp_path.iterdir())


def test_baked_and_back_to_live(active, bake, make_parameters, expected, evaluated, empty_scene):
    baked = make_parameters(domain_size=222.0, resolution=48, start_frame=101, fps=25)
    sequence = bake(baked, 101, 104)
    empty_scene.frame_set(103)
    assert bpy.ops.ocean.use_sequence(filepath=str(sequence.path(102))) == {"FINISHED"}
    assert active.ocean_tweak.source == "SEQUENCE"
    assert active.ocean_tweak.to_parameters(empty_scene) == baked
    np.testing.assert_allclose(evaluated(active), expected(baked, 103), atol=TOLERANCE)
    assert bpy.ops.ocean.use_live() == {"FINISHED"}
    empty_scene.frame_set(150)
    np.testing.assert_allclose(evaluated(active), expected(baked, 150), atol=TOLERANCE)


def test_unusable_files_leave_the_ocean_live(active, bake, make_parameters, expected, evaluated, tmp_path):
    sequence = bake(make_parameters(seed=3), 1, 3, maps=("disp", "vel"))
    sequence.path(2, "vel").unlink()  # a frame that has no map at all was not baked
    with pytest.raises(RuntimeError, match="have no file"):
        bpy.ops.ocean.use_sequence(filepath=str(sequence.path(1)))
    with pytest.raises(RuntimeError, match="neither a folder"):
        bpy.ops.ocean.use_sequence(filepath=str(tmp_path / "other.exr"))
    assert active.ocean_tweak.source == "LIVE"
    np.testing.assert_allclose(evaluated(active), expected(make_parameters(), 1), atol=TOLERANCE)


def test_operators_want_an_ocean(empty_scene):
    for operator in (
        bpy.ops.ocean.import_parameters, bpy.ops.ocean.export_parameters,
        bpy.ops.ocean.use_sequence, bpy.ops.ocean.use_live,
    ):  # fmt: skip
        assert not operator.poll()
        with pytest.raises(RuntimeError, match="There is no ocean in this scene"):
            operator()


def test_the_command_line_sees_the_oceans_of_the_file(
    active, extension, ocean_object, make_parameters, empty_scene, capsys
):
    registration = extension("registration")
    other = make_parameters(seed=5, domain_size=80.0)
    ocean_object.add(empty_scene, other, name="Lake")
    seas = {name: sea.shot.parameters for name, sea in registration.scene_oceans().items()}
    assert seas == {"Ocean": make_parameters(), "Lake": other}
    assert registration.run_command(["info", "--object", "Lake", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert {"format": 2, **report["Lake"]["parameters"]} == json.loads(other.to_json())
    assert registration.run_command(["info", "--object", "Pond"]) == 2
