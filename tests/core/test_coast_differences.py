# SPDX-License-Identifier: GPL-3.0-or-later
"""Derivatives of fields over a bed: exact for what is straight, also at land and at the ends of the rows."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ocean_tweak.core.waves.coast.differences import Differences

ROWS, COLUMNS, STEP = 40, 32, 0.5


def places() -> tuple[np.ndarray, np.ndarray]:
    return np.meshgrid(STEP * np.arange(ROWS), STEP * np.arange(COLUMNS), indexing="ij")


def wet() -> np.ndarray:
    """A sea with a shore, an island of one sample, and a channel of one."""
    there = np.ones((ROWS, COLUMNS), bool)
    there[30:] = False
    there[30:, 10] = True
    there[12, 20] = False
    return there


def test_the_derivative_of_what_rises_evenly_is_its_slope_wherever_a_neighbour_is_water() -> None:
    x, _ = places()
    there = wet()
    field = np.where(there, 3.0 * x, 0.0)
    assert_allclose(Differences(there, STEP).by(field, 0)[there], 3.0, rtol=1e-6)
    across = np.where(there, 2.0, 0.0)
    assert np.all(Differences(there, STEP).by(across, 1)[there] == 0.0)  # land beside it counts for nothing


@pytest.mark.parametrize(("axis", "waves"), [(0, 2.0), (1, 4.0)])
def test_short_waves_are_differentiated_to_the_eighth_order(axis: int, waves: float) -> None:
    """At k Δ the error is (k Δ)⁸/630 of the derivative (Fornberg 1988); rows repeat."""
    place = places()[axis]
    k = 2.0 * np.pi * waves / (STEP * (COLUMNS if axis else ROWS))
    found = Differences(np.ones((ROWS, COLUMNS), bool), STEP).by(np.sin(k * place), axis)
    inside = slice(None) if axis else slice(4, -4)
    off = np.abs(found - k * np.cos(k * place))[inside].max() / k
    assert off == pytest.approx((k * STEP) ** 8 / 630.0, rel=0.2)
