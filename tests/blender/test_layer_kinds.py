# SPDX-License-Identifier: GPL-3.0-or-later
"""Wind fields and images beside wave layers: one list, and nothing lost on the way through Blender."""

import json

import bpy
import numpy as np
import pytest

from tests.layers import layers_of, with_layers

from .conftest import DOMAIN, positions_of, sea_of

TOLERANCE = 1e-4  # m


@pytest.fixture
def rich(core, make_parameters):
    """A sea with layers of all kinds, whose numbers float32 and 8 bits cannot all hold."""
    chance = np.random.default_rng(5)
    winds = [core.Raster(4.0 + 3.0 * chance.random((5, 3, 2)), name) for name in ("early", "late")]
    return make_parameters(
        layers=(
            core.WaveLayer(wind_speed=9.1),
            core.WaveLayer(wind_speed=4.3, fetch=2e3, id=7),
            core.WindFieldLayer(wind_speed=8.2, columns=4, rows=3, start_time=-20.0),
            core.WindFieldLayer(keys=(core.WindKey(vectors=winds[0]),), columns=3, rows=3, life=3.3),
            core.WindFieldLayer(
                keys=(core.WindKey(time=0.1, vectors=winds[0]), core.WindKey(time=2.3, vectors=winds[1])),
                columns=2, rows=2, wind_scale=0.9,
            ),
            core.ImageLayer(wind_speed=7.7, noise_resolution=64),
            core.ImageLayer(
                image=core.Raster(chance.normal(size=(7, 5)), "sketch"), filter="FRACTAL", amplitude_scale=0.3
            ),
        ),
    )  # fmt: skip


def test_all_kinds_come_back_to_the_last_bit(ocean, rich, empty_scene):
    empty_scene.unit_settings.scale_length = 0.3048
    ocean.ocean_tweak.from_parameters(rich, empty_scene)
    assert json.loads(sea_of(ocean).to_json()) == json.loads(rich.to_json())
    kinds = [layer.kind for layer in ocean.ocean_tweak.layers]
    assert kinds == ["WAVES"] * 2 + ["WIND_FIELD"] * 3 + ["IMAGE"] * 2
    images = [ocean.ocean_tweak.layers[place].group.image for place in (3, 6)]
    assert [image.name for image in images] == ["early", "sketch"]
    assert all(image.is_float and image.packed_file and image.colorspace_settings.is_data for image in images)


def test_taking_a_sea_over_again_makes_no_more_images(ocean, rich, empty_scene):
    ocean.ocean_tweak.from_parameters(rich, empty_scene)
    before = set(bpy.data.images)
    ocean.ocean_tweak.from_parameters(sea_of(ocean), empty_scene)
    bpy.ops.ocean.layer_add()
    assert set(bpy.data.images) == before
    assert layers_of(sea_of(ocean), "IMAGE") == layers_of(rich, "IMAGE")


def test_all_kinds_outlive_saving_and_duplicating(ocean, rich, empty_scene, tmp_path):
    ocean.ocean_tweak.from_parameters(rich, empty_scene)
    copy = ocean.copy()
    empty_scene.collection.objects.link(copy)
    assert sea_of(copy) == rich
    name = copy.name
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "sea.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "sea.blend"))
    assert sea_of(bpy.data.objects["Ocean"]) == rich
    assert sea_of(bpy.data.objects[name]) == rich


def test_all_kinds_are_linked_and_overridden(ocean, rich, empty_scene, tmp_path):
    ocean.ocean_tweak.from_parameters(rich, empty_scene)
    path = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(path, link=True) as (_, into):
        into.objects = ["Ocean"]
    linked = into.objects[0]
    bpy.context.scene.collection.objects.link(linked)
    assert sea_of(linked) == rich
    own = linked.override_create(remap_local_usages=True)
    assert sea_of(own) == rich
    with pytest.raises(
        ValueError,
        match="2 wave layers, 3 wind fields, 2 images, this sea has 2 wave layers, 3 wind fields:",
    ):
        own.ocean_tweak.from_parameters(with_layers(rich, IMAGE=()), bpy.context.scene)


def test_vertices_are_those_of_the_core(ocean, rich, empty_scene, expected, evaluated):
    ocean.ocean_tweak.from_parameters(rich, empty_scene)
    for frame in (1, 30):
        empty_scene.frame_set(frame)
        assert np.abs(evaluated(ocean) - expected(rich, frame)).max() < TOLERANCE
    without = with_layers(rich, WIND_FIELD=(), IMAGE=())
    assert np.abs(evaluated(ocean) - expected(without, 30)).max() > 0.05


def test_the_three_winds_of_the_menu_have_waves(ocean, evaluated):
    ocean.ocean_tweak.resolution = 128
    ocean.ocean_tweak.layers[0].muted = True
    for wind in ("UNIFORM", "OPPOSED_HALVES", "VARYING_SPEED"):
        bpy.ops.ocean.layer_add(kind="WIND_FIELD", wind=wind)
        heights = evaluated(ocean)[..., 2]
        assert not ocean.ocean_tweak.error
        assert 0.02 < np.std(heights) < 2.0, wind
        bpy.ops.ocean.layer_remove()
        assert abs(evaluated(ocean)[..., 2]).max() == 0.0
    bpy.ops.ocean.layer_add(kind="WIND_FIELD", wind="OPPOSED_HALVES")
    (layer,) = layers_of(sea_of(ocean), "WIND_FIELD")
    assert np.sign(layer.rasters[0].values[3, :, 0]).tolist() == [-1.0] * 8 + [1.0] * 8


def test_the_three_winds_of_the_menu_are_rendered(ocean, rendering, expected):
    """Coarser in the viewport, as it is when an ocean is added; the render has all samples."""
    settings = ocean.ocean_tweak
    settings.resolution, settings.viewport_resolution = 128, 64
    for wind in ("UNIFORM", "OPPOSED_HALVES", "VARYING_SPEED"):
        bpy.ops.ocean.layer_add(kind="WIND_FIELD", wind=wind)
        rendered = rendering(positions_of)["Ocean"]
        assert np.abs(rendered - expected(sea_of(ocean), 1)).max() < TOLERANCE, wind
        bpy.ops.ocean.layer_remove()
    assert np.abs(rendered - expected(sea_of(ocean), 1)).max() > 0.05


def test_usd_of_every_kind_comes_back(ocean, rich, empty_scene, tmp_path, extension):
    if not extension("export.usd.library").is_installed():
        pytest.skip("this Blender has no OpenUSD")
    settings = ocean.ocean_tweak
    settings.from_parameters(rich, empty_scene)
    settings.usd.file = str(tmp_path / "sea.usd")
    empty_scene.frame_start, empty_scene.frame_end = 2, 3
    assert bpy.ops.ocean.export_usd() == {"FINISHED"}
    bpy.ops.ocean.import_usd(filepath=str(tmp_path / "sea.usd"))
    came = bpy.context.view_layer.objects.active
    assert came != ocean
    assert sea_of(came) == rich


def test_duplicate_move_solo_and_remove_work_for_every_kind(ocean, rich, empty_scene):
    settings = ocean.ocean_tweak
    settings.from_parameters(rich, empty_scene)
    settings.active_layer = 3
    bpy.ops.ocean.layer_duplicate()
    assert settings.active_layer == 4
    assert settings.layers[4].wind_field.image == settings.layers[3].wind_field.image
    fields = layers_of(sea_of(ocean), "WIND_FIELD")
    assert fields[1].keys == fields[2].keys
    assert len({field.id for field in fields}) == 4
    bpy.ops.ocean.layer_move(direction="UP")
    assert [field.id for field in layers_of(sea_of(ocean), "WIND_FIELD")] == [0, 3, 1, 2]
    assert settings.active_layer == 3
    assert bpy.ops.ocean.layer_move(direction="UP") == {"FINISHED"}
    assert bpy.ops.ocean.layer_move(direction="UP") == {"CANCELLED"}  # wave layers stand above
    bpy.ops.ocean.layer_remove()
    assert sea_of(ocean) == rich
    settings.active_layer = 6
    bpy.ops.ocean.layer_solo()
    sea = sea_of(ocean)
    assert [(layer.kind, layer.id) for layer in sea.active()] == [("IMAGE", 1)]
    bpy.ops.ocean.layer_solo()
    assert sea_of(ocean) == rich


def test_a_sea_keeps_a_layer_of_waves(ocean):
    bpy.ops.ocean.layer_add(kind="IMAGE")
    ocean.ocean_tweak.active_layer = 0
    with pytest.raises(RuntimeError, match="at least one wave layer"):
        bpy.ops.ocean.layer_remove()
    ocean.ocean_tweak.active_layer = 1
    assert bpy.ops.ocean.layer_remove() == {"FINISHED"}


def test_undo_brings_every_kind_back(ocean, rich, empty_scene, window):
    ocean.ocean_tweak.from_parameters(rich, empty_scene)
    with window.override():
        bpy.ops.ed.undo_push(message="before")
        for place in (6, 4, 3):
            bpy.data.objects["Ocean"].ocean_tweak.active_layer = place
            bpy.ops.ocean.layer_remove()
            bpy.ops.ed.undo_push(message="removed")
        for _ in range(3):
            bpy.ops.ed.undo()
    assert sea_of(bpy.data.objects["Ocean"]) == rich


def test_keys_follow_their_wave_layers(ocean, core, make_parameters, empty_scene, extension):
    settings = ocean.ocean_tweak
    layers = tuple(core.WaveLayer(wind_speed=speed) for speed in (5.0, 6.0, 7.0))
    settings.from_parameters(make_parameters(layers=layers), empty_scene)
    settings.layers[2].keyframe_insert("wind_speed", frame=1)
    settings.layers[0].driver_add("amplitude_scale")
    paths = lambda: [curve.data_path for curve in extension("scene.animated").curves_of(ocean)]  # noqa: E731
    bpy.ops.ocean.layer_add(kind="WIND_FIELD")
    assert paths() == ["ocean_tweak.layers[2].wind_speed"]
    settings.active_layer = 1
    bpy.ops.ocean.layer_remove()
    assert paths() == ["ocean_tweak.layers[1].wind_speed"]
    bpy.ops.ocean.layer_move(direction="DOWN")
    assert paths() == ["ocean_tweak.layers[0].wind_speed"]
    assert [driver.data_path for driver in ocean.animation_data.drivers] == [
        "ocean_tweak.layers[1].amplitude_scale"
    ]
    settings.active_layer = 0
    bpy.ops.ocean.layer_remove()
    assert paths() == []


def test_only_wave_layers_can_be_keyed(ocean):
    bpy.ops.ocean.layer_add(kind="WIND_FIELD")
    assert not ocean.ocean_tweak.layers[1].wind_field.bl_rna.properties["wind_speed"].is_animatable
    assert ocean.ocean_tweak.layers[0].bl_rna.properties["wind_speed"].is_animatable


def test_a_loop_refuses_a_wind_field_by_name(ocean):
    ocean.ocean_tweak.use_loop = True
    with pytest.raises(RuntimeError, match=r"layers\.1 raises waves that do not repeat"):
        bpy.ops.ocean.layer_add(kind="WIND_FIELD")
    assert len(ocean.ocean_tweak.layers) == 1


def test_files_and_presets_carry_every_kind(ocean, rich, empty_scene, tmp_path, monkeypatch, extension):
    presets = extension("scene.user_presets")
    monkeypatch.setattr(presets, "user_folder", lambda _name: tmp_path)
    ocean.ocean_tweak.from_parameters(rich, empty_scene)
    bpy.ops.ocean.export_parameters(filepath=str(tmp_path / "sea.json"))
    bpy.ops.ocean.save_preset(title="Rich")
    for take in (
        lambda: bpy.ops.ocean.import_parameters(filepath=str(tmp_path / "sea.json")),
        lambda: bpy.ops.ocean.apply_preset(key="user:rich"),
    ):
        ocean.ocean_tweak.from_parameters(with_layers(rich, WIND_FIELD=(), IMAGE=()), empty_scene)
        take()
        assert sea_of(ocean) == rich


def test_a_bake_of_every_kind_and_its_parameters(ocean, rich, empty_scene, tmp_path, expected, evaluated):
    settings = ocean.ocean_tweak
    settings.from_parameters(rich, empty_scene)
    settings.cache_folder = str(tmp_path)
    settings.use_foam = settings.use_normals = settings.use_velocity = False
    empty_scene.frame_start, empty_scene.frame_end = 2, 3
    bpy.ops.ocean.bake()
    empty_scene.frame_set(3)
    assert settings.source == "SEQUENCE"
    assert np.abs(evaluated(ocean) - expected(rich, 3)).max() < TOLERANCE
    (image,) = tmp_path.rglob("*_disp.0002.exr")
    bpy.ops.ocean.use_live()
    settings.from_parameters(with_layers(rich, WIND_FIELD=(), IMAGE=()), empty_scene)
    bpy.ops.ocean.use_sequence(filepath=str(image))
    assert sea_of(ocean) == rich
    (image.parent / "bake.json").unlink()
    with pytest.raises(RuntimeError, match="switch off Use Its Parameters"):
        bpy.ops.ocean.use_sequence(filepath=str(image))


def test_arrows_point_where_the_wind_blows(ocean, core, extension, empty_scene):
    overlay = extension("ui.overlays")
    assert overlay.wind_lines(ocean, empty_scene).shape == (0, 2, 3)
    bpy.ops.ocean.layer_add(kind="WIND_FIELD", wind="OPPOSED_HALVES")
    assert overlay.wind_lines(ocean, empty_scene).shape == (0, 2, 3)
    ocean.ocean_tweak.layers[1].wind_field.show_vectors = True
    shafts = overlay.wind_lines(ocean, empty_scene)[:256]
    towards = shafts[:, 1, 0] - shafts[:, 0, 0]
    # bilinear between the two columns where the halves meet
    assert (towards[shafts[:, 0, 0] < 0.45 * DOMAIN] < 0).all()
    inner = (shafts[:, 0, 0] > 0.55 * DOMAIN) & (shafts[:, 0, 0] < 0.9 * DOMAIN)
    assert (towards[inner] > 0).all()
    assert np.ptp(shafts[..., 2]) == 0.0


def test_arrows_of_a_keyed_wind_are_those_of_the_time(core, extension):
    overlay = extension("ui.overlays")
    winds = [core.Raster([[[speed, 0.0]]]) for speed in (2.0, 6.0)]
    layer = core.WindFieldLayer(
        keys=(core.WindKey(time=1.0, vectors=winds[0]), core.WindKey(time=3.0, vectors=winds[1]))
    )
    place = np.array([7.0])
    for time, speed in ((0.0, 2.0), (1.5, 3.0), (3.0, 6.0), (9.0, 6.0)):
        assert overlay.wind_now(layer, time, place, place, 100.0)[0].tolist() == pytest.approx([speed, 0.0])
