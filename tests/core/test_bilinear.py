# SPDX-License-Identifier: GPL-3.0-or-later
"""Between four samples the surface is a hyperbolic paraboloid, whichever reader reads it."""

import numpy as np
import pytest

from ocean_tweak.core.numerics.interpolation import Reader, between, stretched, wrapped

FIELD = np.array([[1.0, 2.0, 4.0], [8.0, 16.0, 32.0], [64.0, 128.0, 256.0]])


@pytest.mark.parametrize(
    ("row", "column", "value"),
    [(0.0, 0.0, 1.0), (0.5, 0.0, 4.5), (0.0, 0.25, 1.25), (1.5, 1.5, 108.0), (2.0, 2.5, 160.0),
     (2.5, 2.5, (256.0 + 64.0 + 4.0 + 1.0) / 4), (-0.5, 3.0, 32.5), (7.0, -1.0, 32.0)],
)  # fmt: skip
def test_readers_agree_with_means_by_hand(row, column, value):
    places = np.array([row]), np.array([column])
    assert between(*places, FIELD.shape).read(FIELD) == [value]
    # at a third of the size, in float32 too
    reader = Reader(places[1] / 3.0, places[0] / 3.0, 1.0, 3)
    np.testing.assert_allclose(reader.read(wrapped(FIELD).ravel()), [value], rtol=1e-6)
    single = reader.read(wrapped(FIELD).astype(np.float32).ravel())
    assert single.dtype == np.float32
    np.testing.assert_allclose(single, [value], rtol=1e-6)


def test_rows_and_columns_may_be_of_another_number():
    field = np.arange(10.0).reshape(2, 5)
    assert between(np.array([1.5]), np.array([4.5]), field.shape).read(field) == [4.5]


def test_a_field_is_stretched_from_its_first_sample_to_its_last():
    np.testing.assert_array_equal(stretched(FIELD, 1, 4)[0], [1.0, 1.5, 2.0, 3.0, 4.0])
    np.testing.assert_array_equal(stretched(FIELD, 0, 1), FIELD[[0, 2]])
    np.testing.assert_array_equal(stretched(np.stack([FIELD, -FIELD], -1), 0, 4)[1, 0], [4.5, -4.5])


def test_a_wrapped_field_ends_as_it_begins():
    np.testing.assert_array_equal(wrapped(FIELD), np.pad(FIELD, ((0, 1), (0, 1)), "wrap"))
