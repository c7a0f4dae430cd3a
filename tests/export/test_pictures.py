# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures and arrays as rasters: which number stands where, and what is refused."""

from __future__ import annotations

import builtins
import struct
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest

from ocean_tweak.core.errors import ParameterError
from ocean_tweak.core.raster import Raster
from ocean_tweak.core.validation import Validated, nested, raster
from ocean_tweak.export.pictures import read_picture, with_pictures

Image = pytest.importorskip("PIL.Image")

#: two rows and three columns, as they stand in a picture: the top row first
TOP, BOTTOM = (0, 51, 255), (10, 20, 30)


def png(path: Path, depth: int, colour: int, rows: list[bytes], columns: int) -> Path:
    """A PNG file from its specification: no filter, one block of data."""

    def chunk(kind: bytes, content: bytes) -> bytes:
        return (
            struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
        )

    head = struct.pack(">IIBBBBB", columns, len(rows), depth, colour, 0, 0, 0)
    data = zlib.compress(b"".join(b"\0" + row for row in rows))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b""))
    return path


def test_grey_of_8_bits_is_upright_and_divided_by_255(tmp_path: Path) -> None:
    picture = read_picture(png(tmp_path / "a.png", 8, 0, [bytes(TOP), bytes(BOTTOM)], 3))
    assert picture.shape == (2, 3, 1)
    assert picture.name == "a.png"
    np.testing.assert_allclose(picture.values[1, :, 0], [0.0, 0.2, 1.0], atol=1e-7)
    np.testing.assert_allclose(picture.values[0, :, 0], np.array(BOTTOM) / 255.0, atol=1e-7)


def test_grey_of_16_bits_is_divided_by_65535(tmp_path: Path) -> None:
    picture = read_picture(png(tmp_path / "a.png", 16, 0, [struct.pack(">HH", 13107, 65535)], 2))
    np.testing.assert_allclose(picture.values[0, :, 0], [0.2, 1.0], atol=1e-7)


def test_colour_is_three_channels_and_transparency_none(tmp_path: Path) -> None:
    path = png(tmp_path / "a.png", 8, 6, [bytes((255, 51, 0, 7))], 1)
    np.testing.assert_allclose(read_picture(path).values[0, 0], [1.0, 0.2, 0.0], atol=1e-7)
    np.testing.assert_allclose(read_picture(path, 2).values[0, 0], [1.0, 0.2], atol=1e-7)
    assert read_picture(path, 1).values[0, 0, 0] == pytest.approx(0.2126 + 0.2 * 0.7152, abs=1e-6)


def test_palettes_and_jpeg_are_read_too(tmp_path: Path) -> None:
    Image.new("P", (2, 2), 1).save(tmp_path / "a.gif")
    Image.new("RGB", (8, 8), (200, 100, 0)).save(tmp_path / "a.jpg", quality=95)
    assert read_picture(tmp_path / "a.gif").shape == (2, 2, 3)
    np.testing.assert_allclose(read_picture(tmp_path / "a.jpg").values[4, 4] * 255, (200, 100, 0), atol=3)


def exr(path: Path, **channels: Any) -> Path:
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {n: np.array(v, np.float32) for n, v in channels.items()}).write(str(path))
    return path


def test_exr_is_upright_and_keeps_its_numbers(tmp_path: Path) -> None:
    path = exr(tmp_path / "a.exr", R=[[1.5, -20.0], [3.0, 4.0]], G=[[0.0, 0.25], [7.0, 8.0]])
    expected = [[[3.0, 7.0], [4.0, 8.0]], [[1.5, 0.0], [-20.0, 0.25]]]
    np.testing.assert_array_equal(read_picture(path).values, expected)
    assert read_picture(exr(tmp_path / "y.exr", Y=[[2.0]])).values.tolist() == [[[2.0]]]


def test_an_array_is_itself_with_its_first_row_at_the_smallest_y(tmp_path: Path) -> None:
    values = np.arange(12.0).reshape(2, 3, 2)
    np.save(tmp_path / "a.npy", values)
    np.testing.assert_array_equal(read_picture(tmp_path / "a.npy").values, values)
    np.save(tmp_path / "b.npy", np.array([[0, 51, 255]], np.uint8))
    np.testing.assert_allclose(read_picture(tmp_path / "b.npy").values[0, :, 0], [0.0, 0.2, 1.0], atol=1e-7)


def test_what_cannot_be_read_names_the_file_and_the_reason(tmp_path: Path) -> None:
    (tmp_path / "text.png").write_text("no picture")
    (tmp_path / "text.exr").write_text("no picture")
    (tmp_path / "text.npy").write_text("no array")
    np.save(tmp_path / "objects.npy", np.array([[None]]), allow_pickle=True)
    np.save(tmp_path / "words.npy", np.array([["a"]]))
    np.save(tmp_path / "line.npy", np.zeros(3))
    np.save(tmp_path / "wide.npy", np.zeros((1, 5000), np.uint8))
    np.save(tmp_path / "nan.npy", np.array([[1.0, np.nan]]))
    exr(tmp_path / "nan.exr", R=[[np.nan]], G=[[0.0]])
    exr(tmp_path / "depth.exr", depth=[[1.0]])
    png(tmp_path / "wide.png", 8, 0, [bytes(5000)], 5000)
    png(tmp_path / "deep.png", 16, 2, [bytes(6)], 1)
    short = png(tmp_path / "short.png", 8, 0, [bytes(99)] * 99, 99)
    short.write_bytes(short.read_bytes()[:-30])
    reasons = {
        "text.png": "not a picture", "text.exr": "not a readable EXR", "text.npy": "not an array",
        "objects.npy": "not an array", "words.npy": "must hold numbers", "line.npy": "must be an array",
        "wide.npy": "5000 x 1 samples", "wide.png": "5000 x 1 samples", "deep.png": "save it as .exr",
        "nan.npy": "must be finite", "nan.exr": "must be finite", "depth.exr": "it has depth",
        "short.png": "cannot be read", "none.png": "No such file", "none.exr": "No such file",
        "none.npy": "No such file",
    }  # fmt: skip
    for name, reason in reasons.items():
        with pytest.raises(ParameterError) as caught:
            read_picture(tmp_path / name)
        assert name in str(caught.value), name
        assert reason in str(caught.value), str(caught.value)
    np.save(tmp_path / "one.npy", np.zeros((2, 2)))
    with pytest.raises(ParameterError, match="must have 2 channels, but has 1"):
        read_picture(tmp_path / "one.npy", 2)


def test_without_pillow_the_message_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = png(tmp_path / "a.png", 8, 0, [b"\0"], 1)
    true_import = builtins.__import__

    def without(name: str, *rest: Any, **more: Any) -> Any:
        if name.partition(".")[0] == "PIL":
            raise ImportError(name)
        return true_import(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(ParameterError, match=r"pip install Pillow.*\.exr"):
        read_picture(path)


@dataclass(frozen=True)
class Frame(Validated):
    vectors: Raster | None = raster("vectors", channels=2)  # noqa: RUF009  it makes a field


@dataclass(frozen=True)
class Film(Validated):
    frames: tuple[Frame, ...] = nested(Frame, many=True, empty=True)


def test_references_become_rasters_with_as_many_channels_as_wanted(tmp_path: Path) -> None:
    png(tmp_path / "a.png", 8, 2, [bytes((255, 0, 9))], 1)
    data = {"frames": [{"vectors": {"file": "a.png", "offset": 0.5, "scale": 20.0}}, {"vectors": None}]}
    resolved = with_pictures(Film, data, tmp_path)
    assert data["frames"][0]["vectors"]["file"] == "a.png", "what was given stays"
    assert Raster.from_plain(resolved["frames"][0]["vectors"]).values.tolist() == [[[10.0, -10.0]]]
    assert resolved["frames"][1] == {"vectors": None}


@pytest.mark.parametrize(
    ("reference", "where", "reason"),
    [
        ({"file": "none.png"}, "frames.0.vectors.file", "No such file"),
        ({"file": 3}, "frames.0.vectors.file", "path of a file"),
        ({"file": "a.npy", "strength": 2}, "frames.0.vectors.strength", "unknown key"),
        ({"file": "a.npy", "scale": "2"}, "frames.0.vectors.scale", "must be a number"),
        ({"file": "a.npy", "offset": float("nan")}, "frames.0.vectors.offset", "must be a number"),
    ],
)
def test_references_that_cannot_be_used_are_named(
    tmp_path: Path, reference: Any, where: str, reason: str
) -> None:
    np.save(tmp_path / "a.npy", np.zeros((1, 1, 2)))
    with pytest.raises(ParameterError) as caught:
        with_pictures(Film, {"frames": [{"vectors": reference}]}, tmp_path)
    assert caught.value.field == where
    assert reason in str(caught.value)


def test_data_of_another_form_is_left_for_validation(tmp_path: Path) -> None:
    for data in (3, None, [], {"frames": 3}, {"frames": [3]}, {"other": {"file": "x"}}):
        assert with_pictures(Film, data, tmp_path) == data
