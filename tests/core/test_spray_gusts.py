# SPDX-License-Identifier: GPL-3.0-or-later
"""Gusts that tear off more here and less there: as much as without on average, in strands along the wind."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ocean_tweak.core.spray.gusts import gusts

DIRECTION = 0.7


def _places(count: int = 40_000, side: float = 20e3) -> np.ndarray:
    """(2, count) places in m on a large square."""
    return np.random.default_rng(1).uniform(-0.5 * side, 0.5 * side, (2, count))


def _likeness(along: float, across: float, later: float = 0.0) -> float:
    """Correlation of gusts so far apart, in m and s."""
    x, y = _places()
    cosine, sine = math.cos(DIRECTION), math.sin(DIRECTION)
    beside = x + cosine * along - sine * across, y + sine * along + cosine * across
    here, there = gusts(x, y, 20.0, DIRECTION, 3), gusts(*beside, 20.0 + later, DIRECTION, 3)
    return float(np.corrcoef(here, there)[0, 1])


def test_gusts_take_nothing_away_from_the_mean_and_differ() -> None:
    found = np.stack([gusts(*_places(), time, DIRECTION, 3) for time in (0.0, 7.5, 61.0)])
    np.testing.assert_allclose(found.mean(axis=1), 1.0, atol=0.03)
    assert found.min() >= 0.0
    assert np.mean(found < 0.5) > 0.15
    assert np.mean(found > 1.5) > 0.15


def test_gusts_are_strands_along_the_wind_that_last_for_seconds() -> None:
    assert _likeness(30.0, 0.0) > 0.8
    assert abs(_likeness(0.0, 40.0)) < 0.1
    assert abs(_likeness(260.0, 0.0)) < 0.1
    assert _likeness(0.0, 0.0, later=1.0) > 0.85
    assert abs(_likeness(0.0, 0.0, later=13.0)) < 0.1


def test_gusts_belong_to_a_place_a_time_and_a_seed() -> None:
    x, y = _places(200)
    found = gusts(x, y, 5.0, DIRECTION, 3)
    np.testing.assert_array_equal(gusts(x[::-1], y[::-1], 5.0, DIRECTION, 3)[::-1], found)
    assert not np.allclose(gusts(x, y, 5.0, DIRECTION, 4), found)


def test_gusts_pass_smoothly_from_one_to_the_next() -> None:
    x = np.arange(0.0, 400.0, 0.1)
    found = gusts(x, np.full(x.shape, 3.0), 5.0, 0.5 * math.pi, 3)  # across the wind
    assert np.abs(np.diff(found)).max() < 0.1
    steps = [
        float(gusts(np.array([9.0]), np.array([9.0]), time, 0.0, 3)[0]) for time in np.arange(0, 20, 0.05)
    ]
    assert np.abs(np.diff(steps)).max() < 0.1


@pytest.mark.parametrize("duration", [2.0, 8.0, 25.0])
def test_gusts_repeat_after_a_loop(duration: float) -> None:
    x, y = _places(500)
    first, again, end = (
        gusts(x, y, time, DIRECTION, 3, duration) for time in (1.25, 1.25 + duration, duration - 1e-6)
    )
    np.testing.assert_allclose(again, first, atol=1e-9)
    np.testing.assert_allclose(end, gusts(x, y, 0.0, DIRECTION, 3, duration), atol=1e-4)
