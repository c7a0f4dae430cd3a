# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers with fewer digits."""

import zlib

import numpy as np
import pytest

from ocean_tweak.core.numerics.rounding import rounded


@pytest.mark.parametrize("scale", [1e-6, 1.0, 3e5])
def test_what_is_off_is_a_small_share(scale):
    values = scale * np.random.default_rng(3).standard_normal((64, 64, 3)).astype(np.float32)
    off = rounded(values, 1.0 / 64.0) - values
    size = np.sqrt(np.mean(values.astype(np.float64) ** 2))
    assert 0.2 / 64.0 * size < np.abs(off).max() <= 0.5 / 64.0 * size * (1.0 + 1e-5)
    assert off.dtype == np.float32


def test_it_takes_less_room():
    values = np.random.default_rng(3).standard_normal(10_000).astype(np.float32)
    few = rounded(values, 1.0 / 64.0)
    # 64 steps a deviation: log2(64) + 2.05 bits of a normal distribution, of 32
    assert len(np.unique(few)) < 700
    assert len(zlib.compress(few.tobytes())) < 0.45 * len(zlib.compress(values.tobytes()))


@pytest.mark.parametrize("values", [np.zeros(3), np.zeros((0, 2)), np.array([1.0, np.inf])])
def test_what_has_no_size_stays(values):
    np.testing.assert_array_equal(rounded(values, 0.1), values)
