# SPDX-License-Identifier: GPL-3.0-or-later
"""Averages over larger and larger cells: means stay, long waves stay, short ones go."""

import numpy as np
import pytest

from ocean_tweak.core.numerics.halving import averages


def field(rows, columns, along_y, along_x):
    y, x = np.arange(rows)[:, np.newaxis] / rows, np.arange(columns) / columns
    wave = np.cos(2.0 * np.pi * (along_x * x + along_y * y) + 0.3)
    return np.stack([wave, wave**2], axis=-1).astype(np.float32)


@pytest.mark.parametrize(("rows", "columns"), [(16, 16), (12, 20), (7, 9)])
def test_there_are_levels_down_to_one_cell_that_is_the_mean(rows, columns):
    whole = field(rows, columns, 1, 2)
    levels = list(averages(whole))
    assert [level.shape[:2] for level in levels[:2]] == [
        (-(-rows // 2), -(-columns // 2)),
        (-(-rows // 4), -(-columns // 4)),
    ]
    assert levels[-1].shape == (1, 1, 2)
    np.testing.assert_allclose(levels[-1][0, 0], whole.mean(axis=(0, 1)), atol=2e-2)


def test_two_by_two_are_their_mean():
    whole = np.random.default_rng(1).normal(size=(8, 6, 3)).astype(np.float32)
    first = next(averages(whole))
    np.testing.assert_allclose(first[2, 1], whole[4:6, 2:4].mean(axis=(0, 1)), rtol=1e-6, atol=1e-6)


def test_a_long_wave_stays_in_its_place_and_a_short_one_goes():
    long, short = field(60, 60, 0, 1), field(60, 60, 0, 27)
    *_, fourth = (level for level, _ in zip(averages(long), range(3), strict=False))
    count = len(fourth)  # 60, 30, 15, 8: the last step has samples between
    x = (np.arange(count) + 0.5) / count - 0.5 / 60
    expected = np.cos(2.0 * np.pi * x + 0.3)
    np.testing.assert_allclose(fourth[0, :, 0], expected, atol=0.06)
    assert np.abs(list(averages(short))[2][..., 0]).max() < 0.15
