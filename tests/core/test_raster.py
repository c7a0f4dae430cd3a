# SPDX-License-Identifier: GPL-3.0-or-later
"""Rasters: exact both ways, refused by name."""

from __future__ import annotations

import base64
import json
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from ocean_tweak.core.data.errors import ParameterError
from ocean_tweak.core.data.raster import MOST_NUMBERS, Raster, check_numbers

RAMP = np.arange(12.0).reshape(3, 4)


@given(hnp.arrays(np.float32, hnp.array_shapes(min_dims=2, max_dims=2, max_side=5),
                  elements=st.floats(allow_nan=False, allow_infinity=False, width=32)))  # fmt: skip
def test_json_keeps_every_number(values: np.ndarray) -> None:
    raster = Raster(values, "some")
    read = Raster.from_plain(json.loads(json.dumps(raster.to_plain())))
    np.testing.assert_array_equal(read.values[..., 0], values)
    assert read == raster
    assert hash(read) == hash(raster)
    assert read.name == "some"


@pytest.mark.parametrize(
    ("values", "encoding"),
    [
        (np.arange(256).reshape(16, 16) / 255.0, "uint8"),
        (np.arange(256).reshape(16, 16) * 257 / 65535.0, "uint8"),
        (np.arange(256).reshape(16, 16) * 3 / 65535.0, "uint16"),
        (RAMP - 5.0, "float16"),
        (RAMP + 1e-7, "float32"),
    ],
)
def test_the_smallest_exact_encoding(values: np.ndarray, encoding: str) -> None:
    plain = Raster(values).to_plain()
    assert plain["encoding"] == encoding
    np.testing.assert_array_equal(Raster.from_plain(plain).values[..., 0], values.astype(np.float32))


def test_numbers_written_by_hand() -> None:
    vectors = Raster.from_plain({"values": [[[1, 0], [0, 2]]], "name": "gusts"})
    assert vectors.shape == (1, 2, 2)
    assert vectors.values[0, 1].tolist() == [0.0, 2.0]


def test_cannot_be_changed() -> None:
    source = RAMP.copy()
    raster = Raster(source)
    before = raster.sha256
    source[0, 0] = 99.0
    with pytest.raises(ValueError, match="read-only"):
        raster.values[0, 0] = 1.0
    assert raster == Raster(RAMP)
    assert Raster(raster.values).sha256 == before


def test_shape_and_zero_count_but_names_do_not() -> None:
    assert Raster(RAMP) != Raster(RAMP.reshape(4, 3))
    assert Raster(RAMP, "a") == Raster(RAMP, "b")
    assert Raster([[-0.0]]) == Raster([[0.0]])


BIG = base64.b64encode(zlib.compress(b"\0" * 10_000_000)).decode()


@pytest.mark.parametrize(
    ("data", "told"),
    [
        ({"values": [[1.0, float("nan")]], "name": "logo.png"}, "'logo.png' = nan: .* row 0, column 1"),
        ({"values": [[1.0, 1e300]]}, "finite"),
        ({"values": [[1.0], [1.0, 2.0]]}, "same number of numbers"),
        ({"values": [[10**400]]}, "finite in 32 bits"),
        ({"values": [["x"]]}, "numbers"),
        ({"values": []}, "rows and columns"),
        ({"values": [[[1, 2, 3, 4, 5]]]}, "channels"),
        ({"values": [[1]], "sort": 3}, "must have the keys"),
        ([[1]], "JSON object"),
        ({"shape": [1, 1, 1], "encoding": "object", "data": ""}, "encoding"),
        ({"shape": [10**9, 1, 1], "encoding": "uint8", "data": ""}, "shape"),
        ({"shape": [1, 1, True], "encoding": "uint8", "data": ""}, "shape"),
        ({"shape": [1, 1, 1], "encoding": "uint8", "data": "no!"}, "base64"),
        ({"shape": [1, 1, 1], "encoding": "uint8", "data": "AAAA"}, "base64"),
        ({"shape": [2, 2, 1], "encoding": "uint8", "data": BIG}, "must hold 4 bytes"),
        (Raster(RAMP, "logo").brief(), "none of its numbers"),
    ],
)
def test_refused(data: object, told: str) -> None:
    with pytest.raises(ParameterError, match=told):
        Raster.from_plain(data)


def test_as_many_numbers_as_are_allowed() -> None:
    check_numbers(MOST_NUMBERS)
    with pytest.raises(ParameterError, match="must hold at most"):
        check_numbers(MOST_NUMBERS + 1)


def test_what_is_masked_is_a_hole_and_not_what_lies_under_the_mask() -> None:
    depths = np.ma.masked_equal(np.array([[3, 2], [-9999, 1]]), -9999)
    with pytest.raises(ParameterError, match=r"raster = nan: .* row 1, column 0"):
        Raster(depths)
    assert Raster(np.ma.masked_less(depths.filled(4), 0)) == Raster([[3.0, 2.0], [4.0, 1.0]])
