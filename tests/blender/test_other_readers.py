# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps as other programs read them, through OpenImageIO, which many of them are built on."""

import json

import numpy as np
import pytest

FRAMES = (1, 12)
MAPS = {"disp": "displacement", "normal": "normal", "vel": "velocity", "foam": None, "foam_age": None}


@pytest.fixture
def oiio(package):
    """OpenImageIO as Blender brings it."""
    import bpy

    bpy.utils.expose_bundled_modules()
    return pytest.importorskip("OpenImageIO")


@pytest.fixture
def baked(extension, make_parameters, tmp_path):
    """The folder of a bake of a small sea, by its command, and the sea."""
    parameters = make_parameters()
    (tmp_path / "sea.json").write_text(parameters.to_json())
    words = ["bake", "--params", str(tmp_path / "sea.json"), "--frames", ",".join(map(str, FRAMES))]
    words += ["--maps", ",".join(MAPS), "--name", "gale", "--workers", "1", "--out", str(tmp_path / "out")]
    assert extension("cli").main(words) == 0
    (folder,) = (tmp_path / "out").glob("gale-*/v001-*")
    return folder, parameters


def test_names_are_sequences_of_four_digits(baked):
    """As Nuke writes them, %04d, with nothing else between the name and the number."""
    folder, _ = baked
    expected = {f"gale_{name}.%04d.exr" % frame for name in MAPS for frame in FRAMES}
    assert {path.name for path in folder.glob("*.exr")} == expected


def test_pixels_are_the_sea(baked, oiio, core):
    folder, parameters = baked
    sea = core.Ocean(parameters)
    for frame in FRAMES:
        surface = sea.frame(frame, {"displacement", "normal", "velocity", "foam", "breaking", "foam_age"})
        wanted = {
            "foam": np.stack([surface.foam, surface.foam, surface.breaking], axis=-1),
            "foam_age": surface.foam_age,
        }
        for name, channel in MAPS.items():
            image = oiio.ImageInput.open(str(folder / f"gale_{name}.{frame:04d}.exr"))
            assert image, oiio.geterror()
            pixels, names = image.read_image("float"), image.spec().channelnames
            image.close()
            field = wanted[name] if channel is None else getattr(surface, channel)
            assert tuple(names) == ("R", "G", "B")
            found = pixels[::-1]  # a file's first row is its top one, where y is largest
            channels = (0, 2) if name == "foam" else range(field.shape[-1]) if field.ndim == 3 else (0,)
            for index in channels:
                one = field[..., index] if field.ndim == 3 else field
                np.testing.assert_allclose(found[..., index], one, atol=2e-3 * max(1.0, np.abs(one).max()))


def test_metadata_can_be_read(baked, oiio):
    folder, parameters = baked
    image = oiio.ImageInput.open(str(folder / "gale_disp.0001.exr"))
    texts = [str(attribute.value) for attribute in image.spec().extra_attribs]
    image.close()
    found = [json.loads(text) for text in texts if text.startswith("{")]
    assert any(each.get("domain_size") == parameters.domain_size for each in found)
