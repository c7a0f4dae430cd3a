# SPDX-License-Identifier: GPL-3.0-or-later
"""A step's exponentials, against those of the machine and of the whole operator as a matrix."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ocean_tweak.core.waves.coast.wide_angle import Band, series, turned


def test_a_turn_is_that_of_sine_and_cosine():
    angle = np.linspace(-0.6, 0.6, 1001)
    assert_allclose(turned(angle), np.cos(angle) + 1j * np.sin(angle), atol=2e-15, rtol=0.0)


@pytest.mark.parametrize(
    ("highest", "is_all", "reach", "rough"),
    [(12.0, False, 0.3, 0.5), (90.0, True, 0.3, 0.5), (12.0, False, 0.8, 0.05)],
)
def test_the_series_is_the_exponential_of_the_whole_operator(highest, is_all, reach, rough):
    """Of δk·first + δk²·second made symmetric within the band, of a bed as rough as its samples."""
    rng, columns, dx = np.random.default_rng(2), 192, 0.5
    ky = np.fft.fftfreq(columns, 1.0 / columns)[np.newaxis] + 0.2
    band = Band(ky, highest)
    assert band.is_all == is_all
    d = rough * rng.standard_normal((1, columns))
    mean = 0.8 * highest
    keep = np.exp(-((band.ky / (reach * highest)) ** 4))
    first, second = 0.6 * keep * (band.ky / mean) ** 2, -0.4 * keep * (band.ky / mean) ** 2
    waves = rng.standard_normal(band.ky.shape) + 1j * rng.standard_normal(band.ky.shape)
    found = series(waves, band, d, first, second, dx)

    transform = np.fft.fft(np.eye(columns), axis=0)
    back = np.linalg.inv(transform)
    operator = np.zeros((columns, columns), complex)
    for field, factor in ((d, first), (d * d, second)):
        of_places, of_waves = np.diag(field[0]), np.diag(band.whole(factor.astype(complex))[0])
        along = transform @ of_places @ back
        operator += 0.5 * (of_waves @ along + along @ of_waves)
    inside = band.whole(np.ones(waves.shape, complex))[0].real
    value, vector = np.linalg.eigh(inside[:, np.newaxis] * operator * inside)
    assert 1e-3 < np.abs(value * dx).max() < 0.02  # the fourth term is lost, the third is not
    whole = vector @ (np.exp(1j * dx * value) * (vector.conj().T @ band.whole(waves)[0]))
    expected = band.of(whole[np.newaxis])
    assert_allclose(found, expected, atol=3e-9 * np.abs(waves).max(), rtol=0.0)


@pytest.mark.parametrize("offset", [-0.3, 0.0, 0.3])
def test_a_band_has_all_waves_up_to_its_highest_and_gives_them_back(offset):
    ky = np.fft.fftfreq(192, 1.0 / 192)[np.newaxis] + offset
    band = Band(ky, 12.0)
    assert np.count_nonzero(np.abs(band.ky) <= 12.0) == np.count_nonzero(np.abs(ky) <= 12.0)
    back = band.whole(band.ky.astype(complex))
    assert_allclose(back, np.where(np.isin(ky, band.ky), ky, 0.0))
