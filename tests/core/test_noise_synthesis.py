# SPDX-License-Identifier: GPL-3.0-or-later
"""Images into waves, after Mastin, Watterberg & Mareda (1987): noise, filters, waves of an image."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy import integrate, special

from ocean_tweak.core.data.errors import ParameterError
from ocean_tweak.core.data.raster import Raster
from ocean_tweak.core.numerics.grid import WaveVectorGrid
from ocean_tweak.core.spectral.water import Water
from ocean_tweak.core.waves.image import animation, filters, source
from ocean_tweak.core.waves.image.parameters import ImageLayer
from ocean_tweak.core.waves.image.state import filtered
from tests.core.images import DEEP, L, N, drawing, elevation, spectrum, state

# The source


def test_white_noise_is_that_of_the_paper() -> None:
    """Whole levels, -127…127 around 128, all as likely, and no two neighbours alike in kind."""
    noise = source.white_noise(512, 1)
    assert noise.min() == 1
    assert noise.max() == 255
    assert np.array_equal(noise, np.rint(noise))
    counts = np.bincount(noise.astype(int).ravel(), minlength=256)[1:]
    expected = noise.size / 255
    assert np.sum((counts - expected) ** 2 / expected) == pytest.approx(254, abs=5 * np.sqrt(2 * 254))
    assert noise.mean() == pytest.approx(128.0, abs=5 * 73.6 / 512)
    assert noise.var() == pytest.approx(source.noise_variance(), rel=0.01)
    for shifted in (np.roll(noise, 1, 0), np.roll(noise, 1, 1)):
        assert abs(np.corrcoef(noise.ravel(), shifted.ravel())[0, 1]) < 5 / 512


def test_its_transform_is_white_too() -> None:
    """Mastin et al. (1987), fig. 6: all frequencies are there, none stands out."""
    power = np.abs(source.noise_coefficients(256, 5)) ** 2
    k = WaveVectorGrid(256, 1.0).k / (2 * np.pi)
    for low, high in ((5, 20), (20, 50), (50, 90), (90, 127)):
        ring = power[(k >= low) & (k < high)]
        assert ring.mean() * 256**2 == pytest.approx(1.0, abs=5 / np.sqrt(len(ring)))


def test_noise_is_a_matter_of_its_seed() -> None:
    first = source.white_noise(64, 7)
    np.testing.assert_array_equal(first, source.white_noise(64, 7))
    assert np.mean(first == source.white_noise(64, 8)) < 0.02
    # the same numbers for ever and on every machine
    np.testing.assert_array_equal(first[0, :4], source.white_noise(16, 7)[0, :4])


# The filters


def test_formulas_as_printed() -> None:
    """Eq. 1-6 written out once more, with SciPy's gamma function."""
    U, g = 15.0, 9.81
    f_m = 0.13 * g / U
    f = f_m * np.array([0.6, 0.9, 1.0, 1.3, 3.0])
    printed = 0.0081 * g**2 / ((2 * np.pi) ** 4 * f**5) * np.exp(-5 / 4 * (f_m / f) ** 4)
    np.testing.assert_allclose(filters.pierson_moskowitz(f, U), printed, rtol=1e-12)
    assert filters.pierson_moskowitz(0.0, U) == 0.0
    theta = np.array([0.0, 0.4, 1.5, 2.9])
    for ratio, mu in ((0.5, 4.06), (0.999999, 4.06), (1.0, -2.34), (1.7, -2.34), (20.0, -2.34)):
        p = 9.77 * ratio**mu
        norm = 2 ** (1 - 2 * p) * np.pi * special.gamma(2 * p + 1) / special.gamma(p + 1) ** 2
        expected = np.cos(theta / 2) ** (2 * p) / norm
        np.testing.assert_allclose(filters.directional_spreading(ratio, theta), expected, rtol=1e-6)
        total, _ = integrate.quad(
            lambda t, r=ratio: float(filters.directional_spreading(r, t)), -np.pi, np.pi
        )
        assert total == pytest.approx(1.0, abs=1e-6)


def test_moments_of_pierson_moskowitz() -> None:
    """m0 = α g² / (5 ω_m⁴) in closed form: Hs 5.54 m at 15 m/s; Tz/Tp = (0.8/π)^¼; the peak at f_m."""
    U = 15.0
    f_m = 0.13 * 9.81 / U
    m0, m2 = (
        integrate.quad(lambda f, n=n: f**n * float(filters.pierson_moskowitz(f, U)), 1e-3, 50, limit=800,
                       points=[f_m])[0]
        for n in (0, 2)
    )  # fmt: skip
    assert 4 * np.sqrt(m0) == pytest.approx(0.02460 * U**2, rel=1e-3)  # 4√(0.0081/5) g/(2π 0.13)² U²/g²
    assert filters.total_energy(U) == pytest.approx(m0, rel=1e-6)
    assert np.sqrt(m0 / m2) * f_m == pytest.approx((0.8 / np.pi) ** 0.25, rel=2e-3)
    f = f_m * np.linspace(0.9, 1.1, 2001)
    assert f[np.argmax(filters.pierson_moskowitz(f, U))] == pytest.approx(f_m, rel=2e-4)


@pytest.mark.parametrize("direction", [0.0, 0.7, np.pi / 4])
def test_physical_filter_holds_the_spectrum(direction: float) -> None:
    layer = ImageLayer(wind_speed=8.0, wind_direction=direction)
    grid = WaveVectorGrid(256, 250.0)
    power = filters.filter_power(layer, grid, "DEEP", DEEP)
    m0 = 0.0081 * 9.81**2 / 5 / (2 * np.pi * 0.13 * 9.81 / 8.0) ** 4
    assert np.sum(power * grid.multiplicity) * grid.cell_area == pytest.approx(m0, rel=0.01)


def test_filters_are_even_and_follow_the_wind() -> None:
    """Fig. 7: waves of the peak frequency pass at 45° and 225° and not at 135° and 315°."""
    grid = WaveVectorGrid(256, 2000.0)
    for gain in ("PAPER", "PHYSICAL"):
        layer = ImageLayer(wind_speed=15.0, wind_direction=np.pi / 4, filter_gain=gain)
        power = filters.filter_power(layer, grid, "DEEP", DEEP)
        np.testing.assert_allclose(power[1:128, 0], power[:128:-1, 0], rtol=1e-9)
        # f_m is at k = (2π 0.13)² g/U² = 0.0291 or 9.26 modes; at 8.49 p is 8.2, and 2·cos¹⁶·⁴ 45° is 1/145
        assert power[6, 6] / power[-6, 6] == pytest.approx(145, rel=0.1)


def test_unit_gain_keeps_the_variance_of_noise() -> None:
    for layer in (
        ImageLayer(wind_speed=10.0, filter_gain="PAPER"),
        ImageLayer(filter="FRACTAL", fractal_dimension=3.0),
        ImageLayer(filter="WATER_TEXTURE", texture_wavelength=10.0),
    ):
        grid = WaveVectorGrid(64, 400.0)
        power = filters.unit_gain(filters.filter_power(layer, grid, "DEEP", DEEP), grid)
        # over the modes of the whole plane but the mean
        assert np.sum(power * grid.multiplicity) == pytest.approx(64**2 - 1)
        energies = []
        for seed in range(60):
            coefficients = source.noise_coefficients(64, seed) * np.sqrt(power)
            energies.append(np.sum(np.abs(coefficients) ** 2 * grid.multiplicity))
        scatter = np.std(energies) / np.sqrt(60)
        assert np.mean(energies) == pytest.approx(1.0, abs=5 * scatter)


@pytest.mark.parametrize(("dimension", "beta"), [(2.1, 3.8), (2.5, 3.0), (3.0, 2.0)])
def test_slope_of_a_fractal(dimension: float, beta: float) -> None:
    """The power fitted from the field itself falls as 1/k^β, β = 8 - 2D, within 2 %."""
    layer = ImageLayer(filter="FRACTAL", fractal_dimension=dimension, noise_resolution=256)
    power = np.mean([np.abs(spectrum(elevation(state(layer, 256, seed=s)))) ** 2 for s in range(6)], axis=0)
    index = np.fft.fftfreq(256, 1 / 256)
    radius = np.hypot(index, index[:, np.newaxis])
    rings = np.geomspace(4, 120, 25)
    mean = [power[(radius >= a) & (radius < b)].mean() for a, b in pairwise(rings)]
    centre = [radius[(radius >= a) & (radius < b)].mean() for a, b in pairwise(rings)]
    weight = np.sqrt([np.sum((radius >= a) & (radius < b)) for a, b in pairwise(rings)])
    slope, _ = np.polyfit(np.log(centre), np.log(mean), 1, w=weight)
    assert -slope == pytest.approx(beta, rel=0.02)


def test_slope_of_water_texture() -> None:
    """Beyond its peak 1/k^3.8, below it little: a Gaussian that meets it at the peak."""
    layer = ImageLayer(filter="WATER_TEXTURE", texture_wavelength=20.0)
    grid = WaveVectorGrid(256, 400.0)
    power = filters.filter_power(layer, grid, "DEEP", DEEP)[0]
    peak = 20  # waves a side
    assert np.argmax(power) == peak
    assert power[peak] == pytest.approx(1.0)
    np.testing.assert_allclose(power[peak:120], (np.arange(peak, 120) / peak) ** -3.8, rtol=1e-9)
    np.testing.assert_allclose(power[1:peak], np.exp(-4.5 * (1 - np.arange(1, peak) / peak) ** 2), rtol=1e-9)


# From image to sea


def test_parseval_from_image_to_sea() -> None:
    """Energies of modes are the variance of the elevation, at every step."""
    image = Raster(drawing(64, 64), "ring")
    coefficients = source.image_coefficients(image)
    grid = WaveVectorGrid(64, L)
    full = np.fft.fft2(image.values[..., 0].astype(float)) / 64**2
    nyquist = np.sum(np.abs(full[32]) ** 2) + np.sum(np.abs(full[:, 32]) ** 2) - np.abs(full[32, 32]) ** 2
    held = np.sum(np.abs(coefficients) ** 2 * grid.multiplicity)
    assert held + nyquist == pytest.approx(image.values.astype(float).var(), rel=1e-9)
    for animated in animation.RATES:
        layer = ImageLayer(image=image, filter="FRACTAL", animation=animated)
        of = state(layer)
        energy = np.sum((np.abs(of.h_plus) ** 2 + np.abs(of.h_minus) ** 2) * of.grid.multiplicity)
        for time in (0.0, 3.7):
            assert elevation(of, time).var() == pytest.approx(energy, rel=1e-9), animated


@pytest.mark.parametrize("name", list(filters.POWERS))
@pytest.mark.parametrize("scale", [1.0, 0.3])
def test_height_is_the_one_asked_for(name: str, scale: float) -> None:
    for image in (None, Raster(drawing(), "ring")):
        layer = ImageLayer(
            image=image, filter=name, filter_gain="PAPER", significant_wave_height=2.5, noise_resolution=N,
            wind_speed=7.0, amplitude_scale=scale,
        )  # fmt: skip
        assert 4 * elevation(state(layer)).std() == pytest.approx(2.5 * scale, rel=1e-9)


def test_height_of_the_physical_filter() -> None:
    """Noise has it on average over seeds, an image exactly; Hs = 0.02460 U²."""
    layer = ImageLayer(wind_speed=7.0, noise_resolution=N)
    squares = [elevation(state(layer, seed=seed)).var() for seed in range(40)]
    expected = (0.02460 * 7.0**2 / 4) ** 2
    assert np.mean(squares) == pytest.approx(
        expected, abs=5 * np.std(squares) / np.sqrt(40) + 0.01 * expected
    )
    matched = state(layer, match=True)
    assert elevation(matched).var() == pytest.approx(expected, rel=0.01)
    whole = filtered(replace(layer, image=Raster(drawing())), L, None, "DEEP", DEEP)
    assert whole.m0 == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("name", list(filters.POWERS))
def test_an_image_stands_in_the_sea(name: str) -> None:
    """At time 0 the elevation is the image, filtered: correlation 1 with NumPy's own filtering of it."""
    image = drawing(N, N).astype(np.float32).astype(np.float64)
    layer = ImageLayer(image=Raster(image, "ring"), filter=name, filter_gain="PAPER", wind_speed=6.0)
    kx, ky = (2 * np.pi / L * np.fft.fftfreq(N, 1 / N)[axis] for axis in (np.s_[None, :], np.s_[:, None]))
    k = np.hypot(kx, ky)
    k[0, 0] = 1.0
    if name == "FRACTAL":
        power = k**-3.8
    elif name == "WATER_TEXTURE":
        ratio = k * 2.0 / (2 * np.pi)
        power = np.where(ratio >= 1, np.maximum(ratio, 1) ** -3.8, np.exp(-4.5 * (1 - ratio) ** 2))
    else:
        power = filters.directional_power(k, np.arctan2(ky, kx), layer, "DEEP", DEEP)
    power[0, 0] = 0.0
    power[N // 2] = power[:, N // 2] = 0.0
    by_numpy = np.fft.ifft2(np.fft.fft2(image) * np.sqrt(power)).real
    correlation = np.corrcoef(by_numpy.ravel(), elevation(state(layer)).ravel())[0, 1]
    # the cells' means around the peak are not the samples taken here
    assert correlation == pytest.approx(1.0, abs=1e-9 if name != "MODIFIED_PIERSON_MOSKOWITZ" else 0.003)
    phases = spectrum(elevation(state(layer))) * np.conj(np.fft.fft2(image))
    strong = np.abs(phases) > 1e-6 * np.abs(phases).max()
    assert np.max(np.abs(np.angle(phases[strong]))) < 1e-6


def test_unfiltered_image_is_the_image() -> None:
    """D = 4 is no filter: β = 0. The first row of the image has the smallest y."""
    image = drawing(N, N)
    layer = ImageLayer(image=Raster(image), filter="FRACTAL", fractal_dimension=4.0)
    assert np.corrcoef(image.ravel(), elevation(state(layer)).ravel())[0, 1] > 0.999
    assert np.corrcoef(image[::-1].ravel(), elevation(state(layer)).ravel())[0, 1] < 0.5


@pytest.mark.parametrize("shape", [(40, 40), (41, 63), (300, 200), (1, 9), (7, 1)])
def test_any_size_is_resampled_periodically(shape: tuple[int, int]) -> None:
    """Waves of an image keep their place and shape, whatever its size: they are made anew at the samples."""
    rows, columns = shape
    y, x = np.arange(rows)[:, np.newaxis] / rows, np.arange(columns) / columns
    waves = [(0, 2, 1.0, 0.3), (1, 0, 0.5, 1.0), (-2, 3, 0.7, 2.0)]
    kept = [wave for wave in waves if 2 * abs(wave[0]) < rows and 2 * abs(wave[1]) < columns]
    image = np.sum([a * np.cos(2 * np.pi * (i * y + j * x) + e) for i, j, a, e in kept], axis=0)
    layer = ImageLayer(image=Raster(image), filter="FRACTAL", fractal_dimension=4.0)
    Y, X = np.arange(N)[:, np.newaxis] / N, np.arange(N) / N
    expected = np.sum([a * np.cos(2 * np.pi * (i * Y + j * X) + e) for i, j, a, e in kept], axis=0)
    np.testing.assert_allclose(np.corrcoef(expected.ravel(), elevation(state(layer)).ravel())[0, 1], 1.0)


def test_resolution_shows_more_of_the_same_sea() -> None:
    for layer in (ImageLayer(wind_speed=7.0), ImageLayer(filter="FRACTAL", fractal_dimension=3.0)):
        coarse, fine = (spectrum(elevation(state(layer, n))) for n in (32, 128))
        index = [*range(16), *range(-15, 0)]
        np.testing.assert_allclose(coarse[np.ix_(index, index)], fine[np.ix_(index, index)], atol=1e-12)


def test_the_shortest_wave_of_an_odd_image_is_kept() -> None:
    """20 waves over 41 pixels."""
    image = np.broadcast_to(np.cos(2.0 * np.pi * 20.0 * np.arange(41) / 41.0), (41, 41))
    layer = ImageLayer(image=Raster(image), filter="FRACTAL", fractal_dimension=4.0)
    expected = np.broadcast_to(np.cos(2.0 * np.pi * 20.0 * np.arange(N) / N), (N, N))
    assert np.corrcoef(expected.ravel(), elevation(state(layer)).ravel())[0, 1] == pytest.approx(1.0)


def test_waves_are_told_where_the_noise_has_some() -> None:
    """On a grid finer than the noise nothing is told of waves that the noise is too coarse for."""
    fine = filtered(ImageLayer(noise_resolution=16), L, 64, "DEEP", Water())
    beyond = (fine.grid.kx > 7.5 * fine.grid.spacing) | (np.abs(fine.grid.ky) > 7.5 * fine.grid.spacing)
    assert not np.any(fine.coefficients[beyond])
    assert not np.any(fine.expected[beyond])
    assert np.any(fine.expected[~beyond])


def test_colours_become_their_luminance() -> None:
    colours = np.zeros((8, 8, 3))
    colours[2, 3] = (1.0, 0.0, 0.0)
    colours[5, 1] = (0.0, 1.0, 0.5)
    layer = ImageLayer(image=Raster(colours, "dots"))
    assert layer.image.shape == (8, 8, 1)
    assert layer.image.values[2, 3, 0] == pytest.approx(0.2126)
    assert layer.image.values[5, 1, 0] == pytest.approx(0.7152 + 0.0361)
    opaque = np.concatenate([colours, np.ones((8, 8, 1))], axis=-1)
    assert ImageLayer(image=Raster(opaque)) == layer


def test_what_holds_no_waves_is_refused_by_name() -> None:
    with pytest.raises(ParameterError, match=r"image \(grey\.png\) = 0\.5: everywhere"):
        ImageLayer(image=Raster(np.full((4, 4), 0.5), "grey.png"))
    with pytest.raises(ParameterError, match=r"raster 'hole\.exr' = nan: must be finite"):
        ImageLayer(image=Raster([[0.0, np.nan]], "hole.exr"))
    with pytest.raises(ParameterError, match="2 channels': must have 1"):
        ImageLayer(image=Raster(np.arange(8.0).reshape(2, 2, 2), "winds"))
    with pytest.raises(ParameterError, match="noise_resolution = 33: must be an even number"):
        ImageLayer(noise_resolution=33)
