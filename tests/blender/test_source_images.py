# SPDX-License-Identifier: GPL-3.0-or-later
"""Images become waves and winds by the numbers of their files, and what is wrong with one is told by name."""

from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from tests import image_files
from tests.layers import layers_of

from .conftest import sea_of

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


@pytest.fixture
def waves(ocean):
    bpy.ops.ocean.layer_add(kind="IMAGE")
    return ocean.ocean_tweak.layers[1].image_waves


@pytest.fixture
def wind(ocean):
    bpy.ops.ocean.layer_add(kind="WIND_FIELD")
    return ocean.ocean_tweak.layers[1].wind_field


def png(path, values):
    """Write an 8-bit PNG, the top row first: (rows, columns) grey or (rows, columns, 3)."""
    rows = [row.astype(np.uint8).tobytes() for row in values]
    return image_files.png(path, 8, 2 if values.ndim == 3 else 0, rows, values.shape[1])


def float_image(values, name="decimal"):
    """An image of (rows, columns) or (rows, columns, channels), the bottom row first."""
    rows, columns = values.shape[:2]
    image = bpy.data.images.new(name, columns, rows, alpha=False, float_buffer=True, is_data=True)
    texels = np.ones((rows, columns, 4), np.float32)
    texels[..., : 3 if values.ndim == 2 else values.shape[2]] = (
        values[..., None] if values.ndim == 2 else values
    )
    image.pixels.foreach_set(texels.ravel())
    return image


@pytest.mark.parametrize("shape", [(3, 5), (4, 7, 3)])
def test_8_bits_are_shares_of_255_and_the_top_row_is_far(ocean, waves, tmp_path, shape):
    values = np.random.default_rng(2).integers(0, 256, shape)
    waves.image = bpy.data.images.load(str(png(tmp_path / "odd.png", values)))
    raster = layers_of(sea_of(ocean), "IMAGE")[0].image
    grey = values if len(shape) == 2 else values @ (0.2126, 0.7152, 0.0722)
    assert raster.shape == (*shape[:2], 1)
    assert np.abs(raster.values[..., 0] - grey[::-1] / 255.0).max() < 1e-6
    assert raster.name == "odd.png"
    assert not ocean.ocean_tweak.error


def test_decimals_are_themselves(ocean, waves, wind):
    values = np.random.default_rng(3).normal(size=(6, 3)).astype(np.float32) * 40
    ocean.ocean_tweak.layers[2].image_waves.image = float_image(values)
    assert layers_of(sea_of(ocean), "IMAGE")[0].image.values[..., 0].tolist() == values.tolist()


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("kind", ["u1", "u2", "u4", "i2", "i4", "f4"])
def test_numbers_of_a_tiff_mean_the_same_here_and_outside(ocean, extension, tmp_path, kind, order):
    """Shares of the largest of their kind; Pillow, which reads outside, does not read some of big-endian."""
    largest = 1.0 if kind == "f4" else float(np.iinfo(kind).max)
    shares = np.array([[0.0, 0.25, 1.0], [-1.0 if kind[0] in "if" else 0.5, 0.125, 0.75]])
    numbers = np.trunc(shares * largest) if kind != "f4" else shares
    path = image_files.tiff(tmp_path / "a.tif", numbers.astype(kind), order)
    read = extension("scene.source_images").open_image(path, 1)
    assert np.abs(read.values[::-1, :, 0] - numbers / largest).max() < 1e-6
    if (kind, order) != ("u4", ">"):
        pytest.importorskip("PIL")
        outside = extension("export.images").read_raster(path, 1)
        assert np.abs(outside.values - read.values).max() < 1e-6


@pytest.mark.parametrize(
    ("depth", "colour", "rows"),
    [(16, 2, "102030405060"), (16, 6, "1020304050607080"), (16, 4, "10203040"), (2, 0, "40"), (8, 4, "2030")],
)
def test_pngs_mean_the_same_here_and_outside(ocean, extension, tmp_path, depth, colour, rows):
    pytest.importorskip("PIL")
    path = image_files.png(tmp_path / "a.png", depth, colour, [bytes.fromhex(rows)], 1)
    read = extension("scene.source_images").open_image(path, 1)
    outside = extension("export.images").read_raster(path, 1)
    assert np.abs(outside.values - read.values).max() < 1e-6
    assert 0.05 < read.values[0, 0, 0] < 0.5


@pytest.mark.parametrize("values", [np.array([[-9, 9]], np.int8), np.array([[0.5, 1.0]], np.float64)])
def test_tiffs_of_which_blender_loses_numbers_are_refused(ocean, waves, tmp_path, values):
    waves.image = bpy.data.images.load(str(image_files.tiff(tmp_path / "a.tif", values)))
    assert "layers.1.image = 'a.tif': holds " in ocean.ocean_tweak.error
    assert "which are not supported" in ocean.ocean_tweak.error


PAINTED = np.arange(1.0, 7.0, dtype=np.float32).reshape(2, 3)


@pytest.mark.parametrize("packed", [False, True])
def test_what_an_exr_stores_lies_where_it_was_painted(ocean, waves, tmp_path, packed):
    """Of an image of 4 x 4 the part from column 2, row 1 on, a column of which lies outside."""
    path = image_files.exr(tmp_path / "a.exr", {"Y": PAINTED}, (2, 1), (4, 4))
    waves.image = image = bpy.data.images.load(str(path))
    if packed:
        image.pack()
        path.unlink()
        bpy.ops.ocean.reload_image()
    expected = np.zeros((4, 4))
    expected[1:3, 2:] = PAINTED[:, :2]
    assert (layers_of(sea_of(ocean), "IMAGE")[0].image.values[::-1, :, 0] == expected).all()
    image.pixels[0:3] = (9.0, 9.0, 9.0)  # painted, in the lowest row that is stored
    image.update()
    expected[2, 2] = 9.0
    ocean.ocean_tweak.seed += 1
    assert (layers_of(sea_of(ocean), "IMAGE")[0].image.values[::-1, :, 0] == expected).all()


def test_channels_of_an_exr_are_chosen_by_name(ocean, waves, wind, extension, tmp_path):
    """In Blender these are multi-layer images, of which it gives no texels at all."""
    factors = {"R": 1, "depth.Z": 2, "gust.u": 3, "gust.v": 4}
    planes = {name: factor * PAINTED for name, factor in factors.items()}
    image = bpy.data.images.load(str(image_files.exr(tmp_path / "a.exr", planes)))
    # the wind's layer comes first, whose property groups are found anew
    wind, waves = (layer.group for layer in ocean.ocean_tweak.layers[1:])
    wind.source, wind.image, wind.image_values, wind.image_speed = "IMAGE", image, "PLAIN", 1.0
    waves.image = image
    assert "layers.1.image = 'a.exr': must have 2 channels, but has 1" in ocean.ocean_tweak.error
    wind.image_channels, waves.image_channels = "gust", "depth.X"
    assert "no channel or layer depth.X; it has R, depth.Z, gust.u, gust.v" in ocean.ocean_tweak.error
    waves.image_channels = "depth.Z"
    assert ocean.ocean_tweak.error == ""
    sea = sea_of(ocean)
    assert (layers_of(sea, "IMAGE")[0].image.values[::-1, :, 0] == 2 * PAINTED).all()
    assert (
        layers_of(sea, "WIND_FIELD")[0].rasters[0].values[::-1] == np.dstack([3 * PAINTED, 4 * PAINTED])
    ).all()
    names = extension("scene.source_images").channel_names(image)
    assert sorted(names) == ["R", "depth.Z", "gust.u", "gust.v"]
    # taking over the same sea changes nothing
    ocean.ocean_tweak.from_parameters(sea, bpy.context.scene)
    wind, waves = (layer.group for layer in ocean.ocean_tweak.layers[1:])
    assert (waves.image, waves.image_channels) == (image, "depth.Z")
    assert (wind.image, wind.image_channels) == (image, "gust")
    assert sea_of(ocean) == sea


def test_a_choice_of_channels_is_no_matter_to_other_images(ocean, waves):
    waves.image_channels = "Z"
    waves.image = float_image(np.random.default_rng(3).normal(size=(6, 3)).astype(np.float32))
    assert ocean.ocean_tweak.error == ""


def test_images_that_hold_no_waves_are_told_by_name(ocean, waves):
    flat = np.ones((4, 4), np.float32)
    waves.image = float_image(flat, "wall")
    assert "layers.1.image (wall) = 1.0: everywhere" in ocean.ocean_tweak.error
    broken = np.arange(12, dtype=np.float32).reshape(3, 4)
    broken[2, 1] = np.nan
    waves.image = float_image(broken, "hole")
    assert "raster 'hole' = nan: must be finite everywhere" in ocean.ocean_tweak.error
    assert "row 2, column 1" in ocean.ocean_tweak.error
    waves.image = None
    assert ocean.ocean_tweak.error == ""


def test_missing_files_and_movies_are_told_by_name(ocean, waves, tmp_path):
    file = png(tmp_path / "gone.png", np.arange(12).reshape(3, 4))
    waves.image = bpy.data.images.load(str(file))
    file.unlink()
    bpy.ops.ocean.reload_image()
    assert "layers.1.image = 'gone.png': its file cannot be read" in ocean.ocean_tweak.error
    waves.image.source = "SEQUENCE"
    ocean.ocean_tweak.seed += 1
    assert "must be a single image" in ocean.ocean_tweak.error


def test_a_changed_file_is_read_again_when_asked(ocean, waves, tmp_path):
    file = png(tmp_path / "drawn.png", np.arange(12).reshape(3, 4))
    waves.image = bpy.data.images.load(str(file))
    png(file, np.arange(12)[::-1].reshape(3, 4))
    assert layers_of(sea_of(ocean), "IMAGE")[0].image.values[0, 0, 0] == pytest.approx(8 / 255)
    bpy.ops.ocean.reload_image()
    assert layers_of(sea_of(ocean), "IMAGE")[0].image.values[0, 0, 0] == pytest.approx(3 / 255)


def test_painting_shows(ocean, waves, evaluated, empty_scene):
    values = np.random.default_rng(4).normal(size=(16, 16)).astype(np.float32)
    waves.filter = "FRACTAL"
    waves.image = image = float_image(values)
    before = evaluated(ocean)
    image.pixels[4 * 100] = 30.0
    image.update_tag()
    bpy.context.view_layer.update()
    painted = evaluated(ocean)
    assert np.abs(painted - before).max() > 0.01
    image.pixels[4 * 10] = -30.0  # without a note to Blender: seen with the next frame
    empty_scene.frame_set(empty_scene.frame_current)
    assert np.abs(evaluated(ocean) - painted).max() > 0.01


def test_playback_reads_no_image_again(ocean, waves, empty_scene, extension, monkeypatch):
    values = np.random.default_rng(4).normal(size=(16, 16)).astype(np.float32)
    waves.image = float_image(values)
    waves.image.pack()
    sea_of(ocean)
    images = extension("scene.source_images")
    monkeypatch.setattr(images, "_texels", None)
    monkeypatch.setattr(images, "Raster", None)
    for frame in (2, 3):
        empty_scene.frame_set(frame)
    assert ocean.ocean_tweak.error == ""
    assert layers_of(sea_of(ocean), "IMAGE")[0] is layers_of(sea_of(ocean), "IMAGE")[0]


def test_colour_space_of_decimals_is_asked_for(ocean, waves, extension, empty_scene):
    image = float_image(np.random.default_rng(4).normal(size=(4, 4)).astype(np.float32), "linear")
    waves.image = image
    panel = extension("ui.panels.layers")
    said = []
    layout = SimpleNamespace(operator=lambda *_args, **_named: None)
    panel_message = panel.message
    try:
        panel.message = lambda _layout, _context, text: said.append(text)
        panel._image_notes(layout, None, image)
        image.colorspace_settings.name = "sRGB"
        panel._image_notes(layout, None, image)
    finally:
        panel.message = panel_message
    assert len(said) == 1
    assert "choose Non-Color" in said[0]


def test_red_and_green_are_the_wind(ocean, wind):
    values = np.zeros((2, 3, 3), np.float32)
    values[0, 1] = (0.25, -0.5, 9.0)
    wind.source = "IMAGE"
    assert "layers.1.image = '': choose an image" in ocean.ocean_tweak.error
    wind.image, wind.image_values, wind.image_speed = float_image(values), "PLAIN", 8.0
    layer = layers_of(sea_of(ocean), "WIND_FIELD")[0]
    assert layer.keys[0].vectors.shape == (2, 3, 2)
    assert layer.keys[0].vectors.values[0, 1].tolist() == [2.0, -4.0]
    wind.image_values = "CENTRED"
    assert layers_of(sea_of(ocean), "WIND_FIELD")[0].keys[0].vectors.values[0, 1].tolist() == [-4.0, -16.0]
    wind.show_vectors = True
    image = wind.image
    bpy.ops.ocean.layer_add()  # through the parameters and back
    again = ocean.ocean_tweak.layers[2].wind_field
    assert (again.source, again.image, again.image_values) == ("IMAGE", image, "CENTRED")
    assert (again.image_speed, again.show_vectors) == (8.0, True)


def test_a_wind_too_strong_for_the_patch_is_told(ocean, wind):
    wind.wind_speed = 60.0
    assert "layers.1 = '60 m/s': the waves of this wind are 367 m long" in ocean.ocean_tweak.error


def test_a_sea_from_a_file_that_names_its_image(ocean, tmp_path, expected, evaluated, empty_scene, core):
    values = np.random.default_rng(6).integers(0, 256, (8, 6, 3))
    png(tmp_path / "sketch.png", values)
    np.save(tmp_path / "wind.npy", np.full((2, 2, 2), 5.0))
    file = tmp_path / "sea.json"
    file.write_text(
        """{"resolution": 32, "domain_size": 90,
        "pictures": [{"image": {"file": "sketch.png"}, "filter": "FRACTAL"}],
        "wind_fields": [{"keys": [{"vectors": {"file": "wind.npy"}}], "columns": 3, "rows": 3}]}"""
    )
    bpy.ops.ocean.import_parameters(filepath=str(file))
    layers = ocean.ocean_tweak.layers
    assert layers[2].image_waves.image.filepath == str(tmp_path / "sketch.png")
    assert layers[1].wind_field.image.name == "wind.npy"
    sea = sea_of(ocean)
    grey = values[::-1] @ (0.2126, 0.7152, 0.0722) / 255.0
    assert np.abs(layers_of(sea, "IMAGE")[0].image.values[..., 0] - grey).max() < 1e-6
    assert np.abs(evaluated(ocean) - expected(sea, 1)).max() < 1e-4


@pytest.mark.parametrize("name", ["from-image.json", "wind-front.json"])
def test_the_examples_come_in(ocean, name, empty_scene):
    ocean.ocean_tweak.viewport_resolution = 32
    bpy.ops.ocean.import_parameters(filepath=str(EXAMPLES / name))
    assert ocean.ocean_tweak.error == ""
    sea = sea_of(ocean)
    assert layers_of(sea, "IMAGE") or layers_of(sea, "WIND_FIELD")
