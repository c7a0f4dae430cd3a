# SPDX-License-Identifier: GPL-3.0-or-later
"""EXR images from elsewhere as rasters: data windows, channels, parts and every way to store them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest

from ocean_tweak.core.data.errors import ParameterError
from ocean_tweak.export.images import read_raster
from tests.image_files import exr as exr_by_hand

PAINTED = np.arange(1.0, 17.0, dtype=np.float32).reshape(4, 4)


@pytest.mark.parametrize(
    ("at", "rows", "columns"),
    [((1, 1), 2, 2), ((-1, -2), 7, 6), ((-1, 2), 3, 3), ((3, -1), 2, 9), ((0, 0), 4, 4)],
    ids=["inside", "overscan", "partly", "corner", "same"],
)
def test_what_an_exr_stores_lies_where_it_was_painted(
    tmp_path: Path, at: tuple[int, int], rows: int, columns: int
) -> None:
    """Each pixel by itself: that of the image at (x, y) is the stored one at (x, y) less `at`, or 0."""
    stored = np.arange(1.0, rows * columns + 1.0, dtype=np.float32).reshape(rows, columns)
    expected = np.zeros((4, 4))
    for y in range(4):
        for x in range(4):
            i, j = y - at[1], x - at[0]
            if 0 <= i < rows and 0 <= j < columns:
                expected[y, x] = stored[i, j]
    path = exr_by_hand(tmp_path / "a.exr", {"Y": stored}, at, (4, 4))
    np.testing.assert_array_equal(read_raster(path, 1).values[::-1, :, 0], expected)


def test_an_exr_that_stores_nothing_of_its_image_is_refused(tmp_path: Path) -> None:
    path = exr_by_hand(tmp_path / "a.exr", {"Y": PAINTED}, (10, 0), (4, 4))
    with pytest.raises(ParameterError, match="its data window lies outside its display window"):
        read_raster(path)


@pytest.mark.parametrize(
    "more",
    [
        {"lineOrder": OpenEXR.DECREASING_Y},
        {"type": OpenEXR.tiledimage, "tiles": OpenEXR.TileDescription()},
        {"compression": OpenEXR.PIZ_COMPRESSION},
    ],
)
@pytest.mark.parametrize("kind", [np.float16, np.float32, np.uint32])
def test_every_way_to_store_an_exr(tmp_path: Path, more: dict[str, Any], kind: type) -> None:
    values = np.arange(70.0 * 70.0).reshape(70, 70) % 1000
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, **more}
    OpenEXR.File(header, {"Y": values.astype(kind)}).write(str(tmp_path / "a.exr"))
    np.testing.assert_array_equal(read_raster(tmp_path / "a.exr").values[::-1, :, 0], values)


CHANNELS = {
    "R": PAINTED, "G": -PAINTED, "Z": 2 * PAINTED, "mask.R": 3 * PAINTED,
    "gust.u": 4 * PAINTED, "gust.v": 5 * PAINTED,
}  # fmt: skip


@pytest.mark.parametrize(
    ("names", "count", "expected"),
    [
        ("", 2, (1, -1)), ("Z", 1, (2,)), ("mask.R", 1, (3,)), ("mask", 1, (3,)), ("gust", 2, (4, 5)),
        ("gust.v, gust.u", 2, (5, 4)), ("R", 1, (1,)), ("R,Z", 2, (1, 2)),
    ],
)  # fmt: skip
def test_channels_of_an_exr_are_chosen_by_name(
    tmp_path: Path, names: str, count: int, expected: tuple[int, ...]
) -> None:
    path = exr_by_hand(tmp_path / "a.exr", CHANNELS)
    read = read_raster(path, count, names).values[::-1]
    np.testing.assert_array_equal(read, np.stack([factor * PAINTED for factor in expected], axis=-1))


@pytest.mark.parametrize(
    ("names", "count", "told"),
    [
        ("A", 1, "no channel or layer A; it has G, R, Z, gust.u, gust.v, mask.R"),
        ("Z", 2, "must have 2 channels, but has 1"),
        ("", 1, "has 2 channels where one is needed"),
        ("gust", 1, "has 2 channels where one is needed"),
    ],
)
def test_channels_that_an_exr_lacks_are_told_with_those_that_it_has(
    tmp_path: Path, names: str, count: int, told: str
) -> None:
    with pytest.raises(ParameterError, match=told):
        read_raster(exr_by_hand(tmp_path / "a.exr", CHANNELS), count, names)


def test_parts_of_an_exr_are_layers(tmp_path: Path) -> None:
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    parts = [
        OpenEXR.Part({**header, "name": "beauty"}, {"R": PAINTED, "G": PAINTED, "B": PAINTED}, "beauty"),
        OpenEXR.Part({**header, "name": "depth"}, {"Z": 2 * PAINTED}, "depth"),
    ]
    OpenEXR.File(parts).write(str(tmp_path / "a.exr"))
    for names in ("depth.Z", "depth"):
        read = read_raster(tmp_path / "a.exr", 1, names).values[::-1, :, 0]
        np.testing.assert_array_equal(read, 2 * PAINTED)
    with pytest.raises(ParameterError, match="several parts"):
        read_raster(tmp_path / "a.exr", 2, "R,depth.Z")


def test_of_luminance_and_chroma_the_luminance_is_an_image(tmp_path: Path) -> None:
    chroma = PAINTED[::2, ::2].copy()
    path = exr_by_hand(
        tmp_path / "a.exr", {"Y": PAINTED, "RY": chroma, "BY": chroma}, sampling={"RY": 2, "BY": 2}
    )
    np.testing.assert_array_equal(read_raster(path, 1).values[::-1, :, 0], PAINTED)
    with pytest.raises(ParameterError, match="must have 2 channels"):
        read_raster(path, 2)
    with pytest.raises(ParameterError, match="at reduced resolution"):
        read_raster(path, 1, "RY")


def test_a_grey_with_depth_beside_it_is_grey(tmp_path: Path) -> None:
    path = exr_by_hand(tmp_path / "a.exr", {"Y": PAINTED, "Z": 2 * PAINTED})
    np.testing.assert_array_equal(read_raster(path, 1).values[::-1, :, 0], PAINTED)
