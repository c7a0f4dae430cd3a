# SPDX-License-Identifier: GPL-3.0-or-later
"""Patterns that no grid holds: their statistics, and that they repeat."""

from __future__ import annotations

from statistics import NormalDist

import numpy as np
import pytest

from ocean_tweak.nodes.surface_detail import (
    billows,
    foam_lace,
    gradient,
    gusts,
    normal,
    ripple_slopes,
    spline_weights,
)


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


QUANTILE = NormalDist().inv_cdf


def test_a_share_of_the_gusts_lies_below_that_share():
    values = gusts(128)
    for share in (0.1, 0.5, 0.9):
        assert np.mean(values < share) == pytest.approx(share, abs=1e-3)


@pytest.mark.parametrize("pattern", [foam_lace, lambda resolution: normal(billows(resolution))])
def test_what_foam_covers_by_is_normally_distributed(pattern):
    values = pattern(128)
    for share in (0.01, 0.1, 0.5, 0.9):
        assert np.mean(values < QUANTILE(share)) == pytest.approx(share, abs=1e-3)
    assert np.mean(values) == pytest.approx(0.0, abs=1e-3)
    assert np.var(values) == pytest.approx(1.0, rel=1e-2)


@pytest.mark.parametrize("pattern", [foam_lace, billows, gusts])
def test_edges_meet(pattern):
    values = pattern(256)
    for rows in (values, values.T):
        steps = np.abs(np.diff(rows, axis=0)).mean(axis=1)
        assert np.abs(rows[0] - rows[-1]).mean() < 1.2 * steps.max()


def _spline(weights, shift):
    """A periodic cubic B-spline along both axes, at the samples moved by a share of their spacing."""
    t = shift
    parts = ((1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3)
    for axis in (0, 1):
        weights = sum(part / 6.0 * np.roll(weights, 1 - step, axis) for step, part in enumerate(parts))
    return weights


def test_a_spline_of_the_weights_has_the_field_s_values():
    field = foam_lace(128)
    np.testing.assert_allclose(_spline(spline_weights(field), 0.0), field, atol=1e-12)


def test_between_the_samples_too_a_share_of_the_lace_lies_below_that_share():
    between = _spline(spline_weights(foam_lace(256)), 0.5)
    for share in (0.05, 0.3, 0.7, 0.95):
        assert np.mean(between < QUANTILE(share)) == pytest.approx(share, abs=5e-3)


def test_the_gradient_is_that_of_a_wave():
    x, y = np.meshgrid(np.arange(64) / 64, np.arange(64) / 64)
    along, across = gradient(np.sin(2.0 * np.pi * (x + 2.0 * y)))
    slope = 2.0 * np.pi * np.cos(2.0 * np.pi * (x + 2.0 * y))
    np.testing.assert_allclose(along, slope, atol=0.02)
    np.testing.assert_allclose(across, 2.0 * slope, atol=0.1)


def test_billows_are_domes_with_creases_between():
    """Creases, few, bend upwards more sharply than domes, nearly everywhere, bend down."""
    height = billows(512)
    bent = sum(np.roll(height, step, axis) for axis in (0, 1) for step in (-1, 1)) - 4.0 * height
    assert np.mean(bent < 0.0) > 0.6
    assert np.percentile(bent, 99.0) > 1.5 * -np.percentile(bent, 1.0)
    np.testing.assert_allclose(height.mean(), 0.0, atol=1e-12)


def test_cells_of_the_lace_are_small_and_large():
    """Holes of an old lace, by their areas: the largest has more than ten times that of the median."""
    holes = foam_lace(256) > QUANTILE(0.35)
    areas = _areas(holes)
    assert areas.max() > 10.0 * np.median(areas)


def _areas(inside):
    """Samples in each connected part, neighbours by their sides; edges do not meet."""
    names = np.where(inside, np.arange(1, inside.size + 1).reshape(inside.shape), 0)
    while True:
        grown = names.copy()
        for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
            grown = np.maximum(grown, np.roll(names, step, axis))
        grown[~inside] = 0
        if np.array_equal(grown, names):
            return np.unique(names[inside], return_counts=True)[1]
        names = grown
