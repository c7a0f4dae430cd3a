# SPDX-License-Identifier: GPL-3.0-or-later
"""Images and arrays as rasters: which number stands where, and what is refused."""

from __future__ import annotations

import builtins
import os
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest

from ocean_tweak.core.data.errors import ParameterError
from ocean_tweak.core.data.raster import Raster
from ocean_tweak.core.data.validation import Validated, nested, raster
from ocean_tweak.export.images import read_raster, with_rasters
from tests.image_files import exr as exr_by_hand
from tests.image_files import png, tiff

Image = pytest.importorskip("PIL.Image")

#: two rows and three columns, as they stand in an image: the top row first
TOP, BOTTOM = (0, 51, 255), (10, 20, 30)


def test_grey_of_8_bits_is_upright_and_divided_by_255(tmp_path: Path) -> None:
    image = read_raster(png(tmp_path / "a.png", 8, 0, [bytes(TOP), bytes(BOTTOM)], 3))
    assert image.shape == (2, 3, 1)
    assert image.name == "a.png"
    np.testing.assert_allclose(image.values[1, :, 0], [0.0, 0.2, 1.0], atol=1e-7)
    np.testing.assert_allclose(image.values[0, :, 0], np.array(BOTTOM) / 255.0, atol=1e-7)


def test_grey_of_16_bits_is_divided_by_65535(tmp_path: Path) -> None:
    image = read_raster(png(tmp_path / "a.png", 16, 0, [struct.pack(">HH", 13107, 65535)], 2))
    np.testing.assert_allclose(image.values[0, :, 0], [0.2, 1.0], atol=1e-7)


def test_colour_is_three_channels_and_transparency_none(tmp_path: Path) -> None:
    path = png(tmp_path / "a.png", 8, 6, [bytes((255, 51, 0, 7))], 1)
    np.testing.assert_allclose(read_raster(path).values[0, 0], [1.0, 0.2, 0.0], atol=1e-7)
    np.testing.assert_allclose(read_raster(path, 2).values[0, 0], [1.0, 0.2], atol=1e-7)
    assert read_raster(path, 1).values[0, 0, 0] == pytest.approx(0.2126 + 0.2 * 0.7152, abs=1e-6)


def test_palettes_and_jpeg_are_read_too(tmp_path: Path) -> None:
    Image.new("P", (2, 2), 1).save(tmp_path / "a.gif")
    Image.new("RGB", (8, 8), (200, 100, 0)).save(tmp_path / "a.jpg", quality=95)
    assert read_raster(tmp_path / "a.gif").shape == (2, 2, 3)
    np.testing.assert_allclose(read_raster(tmp_path / "a.jpg").values[4, 4] * 255, (200, 100, 0), atol=3)


def exr(path: Path, **channels: Any) -> Path:
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {n: np.array(v, np.float32) for n, v in channels.items()}).write(str(path))
    return path


def test_exr_is_upright_and_keeps_its_numbers(tmp_path: Path) -> None:
    path = exr(tmp_path / "a.exr", R=[[1.5, -20.0], [3.0, 4.0]], G=[[0.0, 0.25], [7.0, 8.0]])
    expected = [[[3.0, 7.0], [4.0, 8.0]], [[1.5, 0.0], [-20.0, 0.25]]]
    np.testing.assert_array_equal(read_raster(path).values, expected)
    assert read_raster(exr(tmp_path / "y.exr", Y=[[2.0]])).values.tolist() == [[[2.0]]]


def test_an_array_is_itself_with_its_first_row_at_the_smallest_y(tmp_path: Path) -> None:
    values = np.arange(12.0).reshape(2, 3, 2)
    np.save(tmp_path / "a.npy", values)
    np.testing.assert_array_equal(read_raster(tmp_path / "a.npy").values, values)
    np.save(tmp_path / "b.npy", np.array([[0, 51, 255]], np.uint8))
    np.testing.assert_allclose(read_raster(tmp_path / "b.npy").values[0, :, 0], [0.0, 0.2, 1.0], atol=1e-7)


def test_what_cannot_be_read_names_the_file_and_the_reason(tmp_path: Path) -> None:
    (tmp_path / "text.png").write_text("no image")
    (tmp_path / "text.exr").write_text("no image")
    (tmp_path / "text.npy").write_text("no array")
    np.save(tmp_path / "objects.npy", np.array([[None]]), allow_pickle=True)
    np.save(tmp_path / "words.npy", np.array([["a"]]))
    np.save(tmp_path / "line.npy", np.zeros(3))
    np.save(tmp_path / "wide.npy", np.zeros((1, 5000), np.uint8))
    np.save(tmp_path / "nan.npy", np.array([[1.0, np.nan]]))
    exr(tmp_path / "nan.exr", R=[[np.nan]], G=[[0.0]])
    exr(tmp_path / "depth.exr", depth=[[1.0]])
    png(tmp_path / "wide.png", 8, 0, [bytes(5000)], 5000)
    short = png(tmp_path / "short.png", 8, 0, [bytes(99)] * 99, 99)
    short.write_bytes(short.read_bytes()[:-30])
    reasons = {
        "text.png": "not an image", "text.exr": "not a readable EXR", "text.npy": "not a NumPy array",
        "objects.npy": "not an array", "words.npy": "must hold numbers", "line.npy": "must be an array",
        "wide.npy": "5000 x 1 samples", "wide.png": "5000 x 1 samples",
        "nan.npy": "must be finite", "nan.exr": "must be finite", "depth.exr": "it has depth",
        "short.png": "cannot be read", "none.png": "No such file", "none.exr": "No such file",
        "none.npy": "No such file",
    }  # fmt: skip
    for name, reason in reasons.items():
        with pytest.raises(ParameterError) as caught:
            read_raster(tmp_path / name)
        assert name in str(caught.value), name
        assert reason in str(caught.value), str(caught.value)
    np.save(tmp_path / "one.npy", np.zeros((2, 2)))
    with pytest.raises(ParameterError, match="must have 2 channels, but has 1"):
        read_raster(tmp_path / "one.npy", 2)


WIND = np.random.default_rng(5).normal(size=(18, 30, 2))


@pytest.mark.parametrize("fortran", [False, True])
@pytest.mark.parametrize("kind", ["<f8", ">f4", ">i2", "<f2"])
@pytest.mark.parametrize(
    ("stored", "axes"), [("yxc", ""), ("cyx", ""), ("xyc", "xyc"), ("cxy", "cxy"), ("ycx", "ycx")]
)
def test_axes_of_an_array_are_told_by_its_shape_or_asked_for(
    tmp_path: Path, stored: str, axes: str, kind: str, fortran: bool
) -> None:
    values = np.rint(WIND * 100).astype(kind)
    array = values.transpose(["yxc".index(name) for name in stored])
    np.save(tmp_path / "a.npy", np.asfortranarray(array) if fortran else np.ascontiguousarray(array))
    np.testing.assert_array_equal(read_raster(tmp_path / "a.npy", 2, axes=axes).values, values)


@pytest.mark.parametrize(
    ("shape", "count", "told"),
    [
        ((2, 30, 2), 2, 'may be yxc or cyx: say which with "axes": "yxc"'),
        ((3, 30, 1), 1, "may be yxc or cyx"),
        ((18, 30, 3), 2, "in which no axis is 2 channels"),
        ((3, 18, 30), 2, "in which no axis is 2 channels"),
        ((18, 30, 2), 1, "in which no axis is 1 or 3 or 4 channels"),
        ((18, 2), 2, "must have 2 channels, but has 1"),
        ((1, 2, 18, 30), 2, "must be an array"),
    ],
)
def test_axes_and_channels_are_not_guessed(
    tmp_path: Path, shape: tuple[int, ...], count: int, told: str
) -> None:
    np.save(tmp_path / "a.npy", np.random.default_rng(1).normal(size=shape))
    with pytest.raises(ParameterError) as caught:
        read_raster(tmp_path / "a.npy", count)
    assert told in caught.value.reason


def test_an_ambiguous_array_is_read_as_asked(tmp_path: Path) -> None:
    values = np.random.default_rng(1).normal(size=(2, 30, 2)).astype(np.float32)
    np.save(tmp_path / "a.npy", values)
    for axes, expected in (("yxc", values), ("cyx", values.transpose(1, 2, 0))):
        np.testing.assert_array_equal(read_raster(tmp_path / "a.npy", 2, axes=axes).values, expected)
    np.save(tmp_path / "even.npy", np.ones((2, 2, 2)))  # the same whichever way it is read
    assert read_raster(tmp_path / "even.npy", 2).shape == (2, 2, 2)


def test_truth_values_are_a_mask_and_whole_numbers_themselves(tmp_path: Path) -> None:
    np.save(tmp_path / "mask.npy", np.array([[True, False]]))
    assert read_raster(tmp_path / "mask.npy", 1).values.ravel().tolist() == [1.0, 0.0]
    for kind in (np.int8, np.int16, np.int32, np.uint32, np.int64):
        np.save(tmp_path / "a.npy", np.array([[3, 127]], kind))
        assert read_raster(tmp_path / "a.npy", 1).values.ravel().tolist() == [3.0, 127.0]


WHOLE = [
    (np.uint8, 255), (np.uint16, 65535), (np.uint32, 2**32 - 1), (np.int16, 32767), (np.int32, 2**31 - 1),
]  # fmt: skip


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize(("kind", "largest"), WHOLE)
def test_whole_numbers_of_a_tiff_are_shares_of_the_largest(
    tmp_path: Path, kind: type, largest: int, order: str
) -> None:
    numbers = np.array(
        [[0, largest // 5, largest], [-largest if kind(0).dtype.kind == "i" else 1, 7, 2]], kind
    )
    path = tiff(tmp_path / "a.tif", numbers, order)
    if (kind, order) == (np.uint32, ">"):  # Pillow has no word for these
        with pytest.raises(ParameterError, match="Pillow does not read"):
            read_raster(path)
        return
    expected = numbers.astype(float)[::-1] / largest
    np.testing.assert_allclose(read_raster(path, 1).values[..., 0], expected, rtol=1e-6, atol=1e-9)


def test_decimals_of_a_tiff_are_themselves(tmp_path: Path) -> None:
    path = tiff(tmp_path / "a.tif", np.array([[-1.5, 300.25]], np.float32))
    assert read_raster(path).values.ravel().tolist() == [-1.5, 300.25]


@pytest.mark.parametrize(
    ("values", "tags", "told"),
    [
        (np.zeros((1, 1), np.int8), {}, "signed whole numbers of 8 bits"),
        (np.zeros((1, 1), np.float64), {}, "decimals of 64 bits"),
        (np.zeros((1, 1), np.uint64), {}, "whole numbers of 64 bits"),
        (np.zeros((1, 1), np.uint8), {"orientation": 6}, "save it upright"),
    ],
)
def test_tiffs_that_programs_read_differently_are_refused(
    tmp_path: Path, values: np.ndarray, tags: dict[str, int], told: str
) -> None:
    with pytest.raises(ParameterError, match=told):
        read_raster(tiff(tmp_path / "a.tif", values, **tags))


DEEP = np.array([[[13107, 300, 40000], [65534, 1, 255]]], np.uint16)


@pytest.mark.parametrize("transparent", [False, True])
def test_colours_of_16_bits_keep_them(tmp_path: Path, transparent: bool) -> None:
    values = np.dstack([DEEP, [[9, 65535]]]).astype(np.uint16) if transparent else DEEP
    rows = [values[0].astype(">u2").tobytes()]
    paths = [
        png(tmp_path / "a.png", 16, 6 if transparent else 2, rows, 2),
        *(tiff(tmp_path / f"{name}.tif", values, order) for name, order in (("le", "<"), ("be", ">"))),
    ]
    for path in paths:
        np.testing.assert_allclose(read_raster(path, 3).values, DEEP / 65535.0, rtol=1e-6)


def test_grey_of_16_bits_with_transparency(tmp_path: Path) -> None:
    path = png(tmp_path / "a.png", 16, 4, [struct.pack(">4H", 13107, 7, 65534, 65535)], 2)
    np.testing.assert_allclose(read_raster(path, 1).values[0, :, 0], np.array([13107, 65534]) / 65535)


def test_no_program_is_started_for_an_image(tmp_path: Path) -> None:
    """PostScript is a program: what looks like an image must not run."""
    victim = tmp_path / "victim"
    victim.touch()
    for name in ("a.png", "a.eps", "a.jpg"):
        (tmp_path / name).write_bytes(
            b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 4 4\n%%EndComments\n"
            + f"({victim}) deletefile\n%%EOF\n".encode()
        )
        with pytest.raises(ParameterError, match="not an image of a supported kind"):
            read_raster(tmp_path / name)
    assert victim.exists()


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such pipes")
def test_pipes_and_devices_are_no_files(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.png")
    for path in (tmp_path / "pipe.png", Path("/dev/zero"), tmp_path, Path("a\0b.png")):
        with pytest.raises(ParameterError, match="cannot be read"):
            read_raster(path)


def test_headers_that_promise_too_much_are_refused_before_it_is_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    small = np.zeros((1, 1), np.float32)
    (tmp_path / "zip.npy").write_bytes(b"PK\x03\x04" + bytes(100))
    for name, head in (
        ("deep", b"{'descr': " + b"[" * 3000 + b"]" * 3000 + b"}"),
        ("huge", b"{'descr': '<f8', 'fortran_order': False, 'shape': (4096, 4096, 4)}"),
        ("less", b"{'descr': '<f8', 'fortran_order': False, 'shape': (-1, 4)}"),
    ):
        head += b" " * (-(len(head) + 11) % 64) + b"\n"
        content = b"\x93NUMPY\x01\0" + struct.pack("<H", len(head)) + head
        (tmp_path / f"{name}.npy").write_bytes(content)
    exr_by_hand(tmp_path / "wide.exr", {"Y": small}, display=(10**9, 10**9))
    exr_by_hand(tmp_path / "many.exr", {f"layer{index}.Y": small for index in range(20)} | {"Y": small})
    monkeypatch.setattr("ocean_tweak.export.images.exr_images.MOST_NUMBERS", 20)
    reasons = {
        "zip.npy": "not a NumPy array", "deep.npy": "not a NumPy array", "huge.npy": "cut off",
        "less.npy": "samples", "wide.exr": "samples", "many.exr": "must have at most",
    }  # fmt: skip
    for name, reason in reasons.items():
        with pytest.raises(ParameterError) as caught:
            read_raster(tmp_path / name, 1)
        assert reason in str(caught.value), str(caught.value)


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
        read_raster(path)


@dataclass(frozen=True)
class Frame(Validated):
    vectors: Raster | None = raster("vectors", channels=2)  # noqa: RUF009  it makes a field


@dataclass(frozen=True)
class Film(Validated):
    frames: tuple[Frame, ...] = nested(Frame, many=True, empty=True)


def test_references_become_rasters_with_as_many_channels_as_wanted(tmp_path: Path) -> None:
    png(tmp_path / "a.png", 8, 2, [bytes((255, 0, 9))], 1)
    data = {"frames": [{"vectors": {"file": "a.png", "offset": 0.5, "scale": 20.0}}, {"vectors": None}]}
    resolved = with_rasters(Film, data, tmp_path)
    assert data["frames"][0]["vectors"]["file"] == "a.png", "what was given stays"
    assert Raster.from_plain(resolved["frames"][0]["vectors"]).values.tolist() == [[[10.0, -10.0]]]
    assert resolved["frames"][1] == {"vectors": None}


def test_references_say_which_channels_and_axes(tmp_path: Path) -> None:
    painted = np.arange(1.0, 17.0, dtype=np.float32).reshape(4, 4)
    exr_by_hand(tmp_path / "a.exr", {"wind.u": painted, "wind.v": -painted})
    np.save(tmp_path / "a.npy", WIND.transpose(2, 1, 0))
    frames = [
        {"vectors": {"file": "a.exr", "channels": "wind"}},
        {"vectors": {"file": "a.npy", "axes": "cxy"}},
    ]
    resolved = with_rasters(Film, {"frames": frames}, tmp_path)["frames"]
    read = [Raster.from_plain(frame["vectors"]).values for frame in resolved]
    np.testing.assert_array_equal(read[0][::-1], np.stack([painted, -painted], axis=-1))
    np.testing.assert_array_equal(read[1], WIND.astype(np.float32))


def test_files_are_counted_before_they_are_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    read = []

    def reader(path: Path, *_: Any) -> Raster:
        read.append(path)
        return Raster(np.zeros((10, 10, 2)))

    with pytest.raises(ParameterError, match="65 entries"):
        with_rasters(Film, {"frames": [{"vectors": {"file": "a.npy"}}] * 65}, tmp_path, reader)
    assert not read
    monkeypatch.setattr("ocean_tweak.core.data.raster.MOST_NUMBERS", 500)
    with pytest.raises(ParameterError, match=r"frames\.2\.vectors.*at most 500 together"):
        with_rasters(Film, {"frames": [{"vectors": {"file": "a.npy"}}] * 9}, tmp_path, reader)
    assert len(read) == 3


@pytest.mark.parametrize(
    ("reference", "where", "reason"),
    [
        ({"file": "none.png"}, "frames.0.vectors.file", "No such file"),
        ({"file": 3}, "frames.0.vectors.file", "path of a file"),
        ({"file": "a.npy", "strength": 2}, "frames.0.vectors.strength", "unknown key"),
        ({"file": "a.npy", "channels": 2}, "frames.0.vectors.channels", "names of channels"),
        ({"file": "a.npy", "channels": "Z"}, "frames.0.vectors.file", "is not an EXR image"),
        ({"file": "a.npy", "axes": "tyx"}, "frames.0.vectors.axes", "must be one of yx, xy"),
        ({"file": "a.npy", "axes": "xy"}, "frames.0.vectors.file", "has 3 axes, not xy"),
        ({"file": "a.npy", "scale": "2"}, "frames.0.vectors.scale", "must be a number"),
        ({"file": "a.npy", "offset": float("nan")}, "frames.0.vectors.offset", "must be a number"),
    ],
)
def test_references_that_cannot_be_used_are_named(
    tmp_path: Path, reference: Any, where: str, reason: str
) -> None:
    np.save(tmp_path / "a.npy", np.zeros((1, 1, 2)))
    with pytest.raises(ParameterError) as caught:
        with_rasters(Film, {"frames": [{"vectors": reference}]}, tmp_path)
    assert caught.value.field == where
    assert reason in str(caught.value)


def test_data_of_another_form_is_left_for_validation(tmp_path: Path) -> None:
    for data in (3, None, [], {"frames": 3}, {"frames": [3]}, {"other": {"file": "x"}}):
        assert with_rasters(Film, data, tmp_path) == data
