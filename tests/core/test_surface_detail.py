# SPDX-License-Identifier: GPL-3.0-or-later
"""Patterns that no grid holds: their statistics, and that they repeat."""

from __future__ import annotations

import numpy as np
import pytest

from ocean_tweak.nodes.surface_detail import foam_lace, gusts, ripple_slopes


def test_ripples_have_unit_slopes_mostly_along_the_wind():
    slopes = ripple_slopes(256)
    along, across = np.mean(slopes**2, axis=(1, 2))
    assert along + across == pytest.approx(1.0)
    # cos²θ: three times as much along as across
    assert along / across == pytest.approx(3.0, rel=0.1)
    np.testing.assert_allclose(np.mean(slopes, axis=(1, 2)), 0.0, atol=1e-9)


def test_every_octave_of_ripples_has_the_same_slopes():
    slopes = ripple_slopes(512)
    energy = np.sum(np.abs(np.fft.fft2(slopes)) ** 2, axis=0)
    index = np.fft.fftfreq(512, 1.0 / 512)
    k = np.hypot(index, index[:, np.newaxis])
    octaves = [energy[(k >= low) & (k < 2 * low)].sum() for low in (8, 16, 32, 64)]
    np.testing.assert_allclose(octaves, np.mean(octaves), rtol=0.12)
    assert energy[k < 7.9].sum() < 1e-9 * energy.sum()


@pytest.mark.parametrize("pattern", [foam_lace, gusts])
def test_a_share_of_the_values_lies_below_that_share(pattern):
    values = pattern(128)
    for share in (0.1, 0.5, 0.9):
        assert np.mean(values < share) == pytest.approx(share, abs=1e-3)


@pytest.mark.parametrize("pattern", [foam_lace, gusts])
def test_edges_meet(pattern):
    values = pattern(256)
    for rows in (values, values.T):
        steps = np.abs(np.diff(rows, axis=0)).mean(axis=1)
        assert np.abs(rows[0] - rows[-1]).mean() < 1.2 * steps.max()
