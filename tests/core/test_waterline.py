# SPDX-License-Identifier: GPL-3.0-or-later
"""The plane that a hull feels: what it lets through, against the disc's own integrals."""

import numpy as np
import pytest
from scipy.special import j1

from ocean_tweak.core.sea import waterline


def test_the_stencil_is_an_even_disc():
    points = waterline.stencil()
    assert points.shape == (waterline.POINTS, 2)
    np.testing.assert_allclose(points.mean(axis=0), 0.0, atol=1e-15)
    # of a disc of radius 1: the mean of x² is 1/4, of xy nothing
    np.testing.assert_allclose(points.T @ points / len(points), np.eye(2) / 4.0, atol=1e-3)
    radius = np.hypot(*points.T)
    assert 0.9 < radius.max() < 1.0
    for share in (0.3, 0.5, 0.8):  # of the radius, and so of the area its square
        assert np.mean(radius < share) == pytest.approx(share**2, abs=0.1)


@pytest.mark.parametrize("per_length", [0.05, 0.2, 0.5, 1.0, 1.5])
@pytest.mark.parametrize("angle", [0.0, 0.4])
def test_of_a_wave_the_disc_s_mean_remains(per_length, angle):
    """A wave k over a disc of radius R has the mean 2 J1(kR)/(kR) of its height in the middle."""
    x, y = waterline.stencil().T
    k = np.pi * per_length  # wavelengths of 1/per_length discs
    heights = np.cos(k * (x * np.cos(angle) + y * np.sin(angle)))
    plane = waterline.fitted_plane(heights, 1.0)
    assert plane.height == pytest.approx(2.0 * j1(k) / k, abs=0.015)
    assert plane.slope_x == pytest.approx(0.0, abs=1e-12)


def test_the_plane_is_that_of_least_squares():
    numbers = np.random.default_rng(1)
    heights = numbers.normal(size=(3, waterline.POINTS))
    plane = waterline.fitted_plane(heights, 7.0)
    x, y = 7.0 * waterline.stencil().T
    for index, row in enumerate(heights):
        (a, b, c), *_ = np.linalg.lstsq(np.stack([np.ones_like(x), x, y], axis=-1), row, rcond=None)
        np.testing.assert_allclose([value[index] for value in plane], [a, b, c], atol=1e-12)


def test_a_point_has_no_plane():
    with pytest.raises(ValueError, match="radius = 0"):
        waterline.fitted_plane(np.zeros(waterline.POINTS), 0.0)
