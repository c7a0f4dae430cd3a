# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures into seas, after Mastin, Watterberg & Mareda (1987)."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from scipy import integrate, special

from ocean_tweak.core import Ocean, OceanParameters, Water, WaveLayer
from ocean_tweak.core.errors import ParameterError
from ocean_tweak.core.fields import OUTPUTS
from ocean_tweak.core.grid import WaveVectorGrid
from ocean_tweak.core.initial_state import InitialState
from ocean_tweak.core.noise_synthesis import animation, filters, source
from ocean_tweak.core.noise_synthesis.parameters import PictureLayer, check_loop
from ocean_tweak.core.noise_synthesis.state import filtered, picture_waves
from ocean_tweak.core.raster import Raster
from ocean_tweak.core.shot import Animation, Shot
from ocean_tweak.core.synthesis import Synthesis, Z
from ocean_tweak.core.unresolved_slopes import total_slope_variance, unresolved_slope_variance

DEEP = Water(depth=11e3)
N, L = 128, 200.0


def drawing(rows: int = 96, columns: int = 96) -> np.ndarray:
    """A bright ring off the middle on a ramp, [y, x] in 0…1."""
    y, x = np.mgrid[0:rows, 0:columns] / max(rows, columns)
    ring = np.exp(-(((np.hypot(x - 0.4, y - 0.6) - 0.2) / 0.02) ** 2))
    return 0.2 + 0.6 * ring + 0.1 * np.sin(2 * np.pi * x)


def state(layer: PictureLayer, n: int = N, size: float = L, seed: int = 3, **more: object) -> InitialState:
    grid = WaveVectorGrid(n, size)
    loop = more.pop("loop", None)
    waves = picture_waves(layer, grid, "DEEP", DEEP, seed, loop, bool(more.pop("match", False)))
    return InitialState(
        grid, waves.h_plus, waves.h_minus, waves.omega, waves.expected_plus, waves.expected_minus,
        loop_duration=loop, mirrored=layer.animation != "TRANSLATION",
    )  # fmt: skip


def elevation(of: InitialState, time: float | Fraction = 0.0, by: str = "") -> np.ndarray:
    n = of.grid.resolution
    field = np.empty((n, n))

    def write(block: slice, rows: object) -> None:
        field[block] = rows.position(Z, by)

    Synthesis(of, OceanParameters(), dtype=np.complex128).fill(time, [(Z, by)], write)
    return field


def spectrum(field: np.ndarray) -> np.ndarray:
    """Coefficients of exp(ik·x) over the whole plane."""
    return np.fft.fft2(field) / field.size


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
    layer = PictureLayer(wind_speed=8.0, wind_direction=direction)
    grid = WaveVectorGrid(256, 250.0)
    power = filters.filter_power(layer, grid, "DEEP", DEEP)
    m0 = 0.0081 * 9.81**2 / 5 / (2 * np.pi * 0.13 * 9.81 / 8.0) ** 4
    assert np.sum(power * grid.multiplicity) * grid.cell_area == pytest.approx(m0, rel=0.01)


def test_filters_are_even_and_follow_the_wind() -> None:
    """Fig. 7: waves of the peak frequency pass at 45° and 225° and not at 135° and 315°."""
    grid = WaveVectorGrid(256, 2000.0)
    for gain in ("PAPER", "PHYSICAL"):
        layer = PictureLayer(wind_speed=15.0, wind_direction=np.pi / 4, filter_gain=gain)
        power = filters.filter_power(layer, grid, "DEEP", DEEP)
        np.testing.assert_allclose(power[1:128, 0], power[:128:-1, 0], rtol=1e-9)
        # f_m is at k = (2π 0.13)² g/U² = 0.0291 or 9.26 modes; at 8.49 p is 8.2, and 2·cos¹⁶·⁴ 45° is 1/145
        assert power[6, 6] / power[-6, 6] == pytest.approx(145, rel=0.1)


def test_unit_gain_keeps_the_variance_of_noise() -> None:
    for layer in (
        PictureLayer(wind_speed=10.0, filter_gain="PAPER"),
        PictureLayer(filter="FRACTAL", fractal_dimension=3.0),
        PictureLayer(filter="WATER_TEXTURE", texture_wavelength=10.0),
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
    layer = PictureLayer(filter="FRACTAL", fractal_dimension=dimension, noise_resolution=256)
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
    layer = PictureLayer(filter="WATER_TEXTURE", texture_wavelength=20.0)
    grid = WaveVectorGrid(256, 400.0)
    power = filters.filter_power(layer, grid, "DEEP", DEEP)[0]
    peak = 20  # waves a side
    assert np.argmax(power) == peak
    assert power[peak] == pytest.approx(1.0)
    np.testing.assert_allclose(power[peak:120], (np.arange(peak, 120) / peak) ** -3.8, rtol=1e-9)
    np.testing.assert_allclose(power[1:peak], np.exp(-4.5 * (1 - np.arange(1, peak) / peak) ** 2), rtol=1e-9)


# From picture to sea


def test_parseval_from_picture_to_sea() -> None:
    """Energies of modes are the variance of the elevation, at every step."""
    picture = Raster(drawing(64, 64), "ring")
    coefficients = source.picture_coefficients(picture)
    grid = WaveVectorGrid(64, L)
    full = np.fft.fft2(picture.values[..., 0].astype(float)) / 64**2
    nyquist = np.sum(np.abs(full[32]) ** 2) + np.sum(np.abs(full[:, 32]) ** 2) - np.abs(full[32, 32]) ** 2
    held = np.sum(np.abs(coefficients) ** 2 * grid.multiplicity)
    assert held + nyquist == pytest.approx(picture.values.astype(float).var(), rel=1e-9)
    for animated in animation.RATES:
        layer = PictureLayer(picture=picture, filter="FRACTAL", animation=animated)
        of = state(layer)
        energy = np.sum((np.abs(of.h_plus) ** 2 + np.abs(of.h_minus) ** 2) * of.grid.multiplicity)
        for time in (0.0, 3.7):
            assert elevation(of, time).var() == pytest.approx(energy, rel=1e-9), animated


@pytest.mark.parametrize("name", list(filters.POWERS))
@pytest.mark.parametrize("gain", [1.0, 0.3])
def test_height_is_the_one_asked_for(name: str, gain: float) -> None:
    for picture in (None, Raster(drawing(), "ring")):
        layer = PictureLayer(
            picture=picture, filter=name, filter_gain="PAPER", significant_wave_height=2.5, gain=gain,
            noise_resolution=N, wind_speed=7.0,
        )  # fmt: skip
        assert 4 * elevation(state(layer)).std() == pytest.approx(2.5 * gain, rel=1e-9)


def test_height_of_the_physical_filter() -> None:
    """Noise has it on average over seeds, a picture exactly; Hs = 0.02460 U²."""
    layer = PictureLayer(wind_speed=7.0, noise_resolution=N)
    squares = [elevation(state(layer, seed=seed)).var() for seed in range(40)]
    expected = (0.02460 * 7.0**2 / 4) ** 2
    assert np.mean(squares) == pytest.approx(
        expected, abs=5 * np.std(squares) / np.sqrt(40) + 0.01 * expected
    )
    matched = state(layer, match=True)
    assert elevation(matched).var() == pytest.approx(expected, rel=0.01)
    whole = filtered(replace(layer, picture=Raster(drawing())), L, None, "DEEP", DEEP)
    assert whole.m0 == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("name", list(filters.POWERS))
def test_a_picture_stands_in_the_sea(name: str) -> None:
    """At time 0 the elevation is the picture, filtered: correlation 1 with NumPy's own filtering of it."""
    picture = drawing(N, N).astype(np.float32).astype(np.float64)
    layer = PictureLayer(picture=Raster(picture, "ring"), filter=name, filter_gain="PAPER", wind_speed=6.0)
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
    by_numpy = np.fft.ifft2(np.fft.fft2(picture) * np.sqrt(power)).real
    correlation = np.corrcoef(by_numpy.ravel(), elevation(state(layer)).ravel())[0, 1]
    # the cells' means around the peak are not the samples taken here
    assert correlation == pytest.approx(1.0, abs=1e-9 if name != "MODIFIED_PIERSON_MOSKOWITZ" else 0.003)
    phases = spectrum(elevation(state(layer))) * np.conj(np.fft.fft2(picture))
    strong = np.abs(phases) > 1e-6 * np.abs(phases).max()
    assert np.max(np.abs(np.angle(phases[strong]))) < 1e-6


def test_unfiltered_picture_is_the_picture() -> None:
    """D = 4 is no filter: β = 0. The first row of the picture has the smallest y."""
    picture = drawing(N, N)
    layer = PictureLayer(picture=Raster(picture), filter="FRACTAL", fractal_dimension=4.0)
    assert np.corrcoef(picture.ravel(), elevation(state(layer)).ravel())[0, 1] > 0.999
    assert np.corrcoef(picture[::-1].ravel(), elevation(state(layer)).ravel())[0, 1] < 0.5


@pytest.mark.parametrize("shape", [(40, 40), (41, 63), (300, 200), (1, 9), (7, 1)])
def test_any_size_is_resampled_periodically(shape: tuple[int, int]) -> None:
    """Waves of a picture keep their place and shape, whatever its size: they are made anew at the samples."""
    rows, columns = shape
    y, x = np.arange(rows)[:, np.newaxis] / rows, np.arange(columns) / columns
    waves = [(0, 2, 1.0, 0.3), (1, 0, 0.5, 1.0), (-2, 3, 0.7, 2.0)]
    kept = [wave for wave in waves if 2 * abs(wave[0]) < rows and 2 * abs(wave[1]) < columns]
    picture = np.sum([a * np.cos(2 * np.pi * (i * y + j * x) + e) for i, j, a, e in kept], axis=0)
    layer = PictureLayer(picture=Raster(picture), filter="FRACTAL", fractal_dimension=4.0)
    Y, X = np.arange(N)[:, np.newaxis] / N, np.arange(N) / N
    expected = np.sum([a * np.cos(2 * np.pi * (i * Y + j * X) + e) for i, j, a, e in kept], axis=0)
    np.testing.assert_allclose(np.corrcoef(expected.ravel(), elevation(state(layer)).ravel())[0, 1], 1.0)


def test_resolution_shows_more_of_the_same_sea() -> None:
    for layer in (PictureLayer(wind_speed=7.0), PictureLayer(filter="FRACTAL", fractal_dimension=3.0)):
        coarse, fine = (spectrum(elevation(state(layer, n))) for n in (32, 128))
        index = [*range(16), *range(-15, 0)]
        np.testing.assert_allclose(coarse[np.ix_(index, index)], fine[np.ix_(index, index)], atol=1e-12)


def test_colours_become_their_luminance() -> None:
    colours = np.zeros((8, 8, 3))
    colours[2, 3] = (1.0, 0.0, 0.0)
    colours[5, 1] = (0.0, 1.0, 0.5)
    layer = PictureLayer(picture=Raster(colours, "dots"))
    assert layer.picture.shape == (8, 8, 1)
    assert layer.picture.values[2, 3, 0] == pytest.approx(0.2126)
    assert layer.picture.values[5, 1, 0] == pytest.approx(0.7152 + 0.0361)
    opaque = np.concatenate([colours, np.ones((8, 8, 1))], axis=-1)
    assert PictureLayer(picture=Raster(opaque)) == layer


def test_what_holds_no_waves_is_refused_by_name() -> None:
    with pytest.raises(ParameterError, match=r"picture \(grey\.png\) = 0\.5: everywhere"):
        PictureLayer(picture=Raster(np.full((4, 4), 0.5), "grey.png"))
    with pytest.raises(ParameterError, match=r"raster 'hole\.exr' = nan: must be finite"):
        PictureLayer(picture=Raster([[0.0, np.nan]], "hole.exr"))
    with pytest.raises(ParameterError, match="2 channels': must have 1"):
        PictureLayer(picture=Raster(np.arange(8.0).reshape(2, 2, 2), "winds"))
    with pytest.raises(ParameterError, match="noise_resolution = 33: must be an even number"):
        PictureLayer(noise_resolution=33)


# Motion


def single_wave(i: int, j: int, n: int = 32, **layer: object) -> PictureLayer:
    """A layer whose picture is one cosine, i waves along y and j along x."""
    y, x = np.arange(n)[:, np.newaxis] / n, np.arange(n) / n
    picture = Raster(np.cos(2 * np.pi * (i * y + j * x)))
    return PictureLayer(picture=picture, filter="FRACTAL", fractal_dimension=4.0, **layer)


def phase_advance(layer: PictureLayer, i: int, j: int, time: float) -> float:
    """How far the phase of the mode that runs along (j, i) has turned, in rad: ωt."""
    of = state(layer)
    before, after = (spectrum(elevation(of, t))[i, j] for t in (0.0, time))
    assert abs(after) == pytest.approx(abs(before))
    return float(-np.angle(after / before))


@pytest.mark.parametrize(("i", "j"), [(0, 3), (2, 5), (-4, 1), (5, 0)])
def test_phase_speed_under_dispersion(i: int, j: int) -> None:
    """Eq. 10: c = √(g/k), towards the side to which the wind blows."""
    k, time = 2 * np.pi / L * np.hypot(i, j), 0.31
    towards = np.arctan2(i, j) + 0.4
    layer = single_wave(i, j, wind_direction=towards)
    assert phase_advance(layer, i, j, time) == pytest.approx(np.sqrt(9.81 * k) * time, rel=1e-9)
    assert phase_advance(replace(layer, wind_direction=towards + np.pi), i, j, time) < 0.0


def test_translation_moves_the_picture_as_it_is() -> None:
    """Eq. 9: after 5 s at 10 m/s along (3, 4)/5 all has moved by (30, 40) m."""
    layer = PictureLayer(
        picture=Raster(drawing(80, 80)), filter="FRACTAL", fractal_dimension=3.0, animation="TRANSLATION",
        translation_speed=10.0, wind_direction=np.arctan2(4.0, 3.0),
    )  # fmt: skip
    of = state(layer, 80)
    before, after = elevation(of), elevation(of, 5.0)
    np.testing.assert_allclose(after, np.roll(before, (16, 12), (0, 1)), atol=1e-9)  # samples 2.5 m apart
    x = 2 * np.pi * np.fft.fftfreq(80, 1 / 80) / L
    rate = np.fft.ifft2(-1j * (6.0 * x + 8.0 * x[:, np.newaxis]) * np.fft.fft2(after)).real
    np.testing.assert_allclose(elevation(of, 5.0, by="t"), rate, atol=1e-9)


def test_phase_rates_of_the_dominant_band() -> None:
    """0.05 against 0.003 rad a frame, at 30 frames a second: 1.5 and 0.09 rad/s."""
    grid = WaveVectorGrid(N, 2000.0)
    layer = PictureLayer(wind_speed=15.0, animation="DOMINANT_BAND")
    omega = animation.angular_frequency(layer, grid, "DEEP", DEEP)
    f = np.sqrt(9.81 * grid.k) / (2 * np.pi)
    f_m = 0.13 * 9.81 / 15.0
    x = np.maximum(f / f_m, 1e-3)
    # F(f) > ⅔ F(f_m): x⁻⁵ exp(-5/4 (x⁻⁴ - 1)) > ⅔
    dominant = np.exp(-5 * np.log(x) - 1.25 * (np.minimum(x**-4, 500.0) - 1)) > 2 / 3
    assert 10 < dominant.sum() < 2000
    np.testing.assert_allclose(omega, np.where(dominant, 0.05 * 30, 0.003 * 30))


def test_two_bands_move_apart() -> None:
    """A dominant and a shorter wave start together; after a while only the first has gone far."""
    n, size = 64, 600.0
    x = np.arange(n) / n
    row = np.cos(2 * np.pi * 3 * x) + np.cos(2 * np.pi * 15 * x)  # 200 m (f_m at 15 m/s: 216 m) and 40 m
    layer = PictureLayer(
        picture=Raster(np.tile(row, (n, 1))), filter_gain="PAPER", wind_speed=15.0, animation="DOMINANT_BAND"
    )
    of, time = state(layer, n, size), 0.5
    before, after = (np.fft.fft(elevation(of, t)[0]) for t in (0.0, time))
    turned = -np.angle(after / np.where(before == 0, 1, before))
    assert turned[3] == pytest.approx(1.5 * time)
    assert turned[15] == pytest.approx(0.09 * time)
    metres = turned[[3, 15]] / (2 * np.pi) * size / np.array([3, 15])
    assert metres[0] > 50 * metres[1]


@pytest.mark.parametrize("animated", ["DISPERSION", "DOMINANT_BAND"])
def test_loops_close(animated: str) -> None:
    layer = PictureLayer(picture=Raster(drawing()), filter="FRACTAL", animation=animated)
    of = state(layer, loop=Fraction(7))
    np.testing.assert_array_equal(elevation(of, Fraction(0)), elevation(of, Fraction(7)))
    assert np.ptp(elevation(of, Fraction(3)) - elevation(of, Fraction(0))) > 0.01
    still = replace(layer, animation="DOMINANT_BAND", dominant_rate=0.0, surrounding_rate=0.0)
    np.testing.assert_allclose(
        elevation(state(still, loop=Fraction(7)), 2), elevation(state(still)), atol=1e-12
    )


def test_loops_of_a_translation_close_or_are_refused() -> None:
    whole = PictureLayer(
        picture=Raster(drawing()), animation="TRANSLATION", translation_speed=L / 10 * np.sqrt(2),
        wind_direction=np.pi / 4,
    )  # fmt: skip
    check_loop((whole,), L, Fraction(10))
    of = state(whole, loop=Fraction(10))
    np.testing.assert_array_equal(elevation(of, Fraction(0)), elevation(of, Fraction(10)))
    half_way = np.roll(elevation(of, 0), (N // 2, N // 2), (0, 1))
    np.testing.assert_allclose(elevation(of, Fraction(5)), half_way, atol=1e-9)
    other = replace(whole, translation_speed=21.0, wind_direction=0.0)
    check_loop((other,), L, None)
    check_loop((replace(other, muted=True),), L, Fraction(10))
    with pytest.raises(
        ParameterError, match=r"pictures\.0\.translation_speed = 21\.0: moves the picture by 1\.05"
    ) as info:
        check_loop((other,), L, Fraction(10))
    assert "take 20 m/s towards 0 rad" in str(info.value)


def test_waves_run_with_the_wind_and_once() -> None:
    """Each wave of the plane runs one way: k and -k are never both counted, nor in the column kx = 0."""
    for direction in (0.0, 1.2, np.pi / 2, -np.pi / 2, np.pi):
        layer = PictureLayer(filter="FRACTAL", fractal_dimension=3.0, wind_direction=direction)
        of = state(layer, 32)
        assert not np.any((of.h_plus != 0) & (of.h_minus != 0))
        np.testing.assert_allclose(of.h_minus[1:16, 0], np.conj(of.h_plus[:16:-1, 0]), atol=1e-12)
        np.testing.assert_allclose(of.h_minus[:16:-1, 0], np.conj(of.h_plus[1:16, 0]), atol=1e-12)
        towards = of.grid.kx * np.cos(direction) + of.grid.ky * np.sin(direction)
        assert np.all(of.h_plus[towards < -1e-9] == 0)
        assert np.all(of.h_minus[towards > 1e-9] == 0)


def test_states_add() -> None:
    """A sea of several states is the sum of their fields, and of their rates."""
    layers = [
        PictureLayer(wind_speed=6.0),
        PictureLayer(filter="FRACTAL", animation="TRANSLATION", translation_speed=3.0, wind_direction=0.6),
        PictureLayer(filter="WATER_TEXTURE", texture_wavelength=9.0, animation="DOMINANT_BAND"),
    ]
    parts = [state(layer, 64) for layer in layers]
    together = replace(parts[0], others=tuple(parts[1:]))
    for by in ("", "t"):
        expected = sum(elevation(part, 1.3, by) for part in parts)
        np.testing.assert_allclose(elevation(together, 1.3, by), expected, atol=1e-12)


# In a sea

FLAT = WaveLayer(muted=True)


def sea(*pictures: PictureLayer, **changes: object) -> OceanParameters:
    given = {
        "resolution": 64,
        "domain_size": L,
        "seed": 3,
        "layers": (FLAT,),
        "pictures": pictures,
        **changes,
    }
    return OceanParameters(**given)


def test_a_sea_of_pictures_alone() -> None:
    fields = Ocean(sea(PictureLayer(wind_speed=7.0))).surface(1.0, OUTPUTS)
    assert 0.5 < 4 * fields.displacement[..., 2].std() < 2.0
    assert Ocean(sea()).surface(1.0).displacement.max() == 0.0


def test_pictures_add_to_the_wave_layers() -> None:
    wind = WaveLayer(wind_speed=8.0)
    pictures = (
        PictureLayer(wind_speed=6.0),
        PictureLayer(filter="FRACTAL", animation="TRANSLATION", wind_direction=0.5),
        PictureLayer(filter="FRACTAL", animation="DOMINANT_BAND", fractal_dimension=3.0),
    )
    together = sea(*pictures, layers=(wind,))
    alone = [together.replace(pictures=()), *(
        together.replace(layers=(FLAT,), pictures=tuple(replace(p, muted=i != one) for i, p in
        enumerate(together.pictures))) for one in range(3)
    )]  # fmt: skip
    for output in ("displacement", "velocity", "slope"):
        total, *parts = (
            getattr(Ocean(p, "double").surface(2.3, (output,)), output) for p in (together, *alone)
        )
        np.testing.assert_allclose(total, sum(parts), atol=1e-11)


def test_several_layers_have_noise_of_their_own() -> None:
    twins = sea(PictureLayer(wind_speed=7.0), PictureLayer(wind_speed=7.0))
    assert [layer.id for layer in twins.pictures] == [0, 1]
    first, second = (
        Ocean(twins.replace(pictures=(layer,))).surface(0.0).displacement[..., 2] for layer in twins.pictures
    )
    assert abs(np.corrcoef(first.ravel(), second.ravel())[0, 1]) < 0.3
    same = sea(PictureLayer(wind_speed=7.0, seed=5), seed=99)
    again = sea(PictureLayer(wind_speed=7.0, seed=5, id=4), seed=1)
    np.testing.assert_array_equal(*(Ocean(p).surface(0.0).displacement for p in (same, again)))


def test_json_holds_the_picture() -> None:
    parameters = sea(PictureLayer(picture=Raster(drawing(9, 7), "ring.png"), filter="FRACTAL"))
    assert OceanParameters.from_json(parameters.to_json()) == parameters
    assert parameters.to_dict(brief=True)["pictures"][0]["picture"]["name"] == "ring.png"
    with pytest.raises(ParameterError, match=r"pictures\.0\.filter = 'FRACTAL2'"):
        OceanParameters.from_dict({"pictures": [{"filter": "FRACTAL2"}]})
    with pytest.raises(ParameterError, match=r"pictures\.1\.id = 3: is the id of another"):
        sea(PictureLayer(id=3), PictureLayer(id=3))
    with pytest.raises(ParameterError, match=r"pictures\.0\.translation_speed"):
        sea(PictureLayer(animation="TRANSLATION"), loop_duration=10)


def test_statistics_count_pictures() -> None:
    """Hs of a layer and two pictures is the root of the sum of squares; the seed's is what the field has."""
    ring = PictureLayer(picture=Raster(drawing()), filter="FRACTAL", significant_wave_height=2.0)
    wind = WaveLayer(definition="SEA_STATE", significant_wave_height=1.5, peak_period=4.0)
    noise = PictureLayer(wind_speed=7.0)
    found = Ocean(sea(ring, noise, layers=(wind,))).statistics()
    expected = np.sqrt(2.0**2 + 1.5**2 + (0.02460 * 49) ** 2)
    assert found.significant_wave_height == pytest.approx(expected, rel=2e-3)
    for layer in (ring, replace(ring, animation="TRANSLATION"), replace(noise, animation="DOMINANT_BAND")):
        parameters = sea(layer, layers=(wind,))
        ocean = Ocean(parameters, "double")
        moments = [ocean.surface(t).displacement[..., 2].var() for t in np.arange(40) * 7.0]
        assert np.mean(moments) == pytest.approx(ocean.statistics().seed.m0, rel=0.1)


def test_periods_are_those_that_a_place_sees() -> None:
    """Waves of 20 m that move at 4 m/s pass every 5 s, whatever gravity would have them do."""
    moving = single_wave(0, 10, 64, animation="TRANSLATION", translation_speed=4.0)
    found = Ocean(sea(moving)).statistics()
    assert found.peak_wavelength == pytest.approx(20.0, rel=0.02)
    assert found.seed.peak_period == pytest.approx(5.0)
    assert found.seed.zero_crossing_period == pytest.approx(5.0)
    assert found.seed.mean_direction == pytest.approx(0.0)
    still = Ocean(sea(replace(moving, translation_speed=0.0))).statistics()
    assert still.to_dict()["seed"]["peak_period"] is None
    assert still.warnings == ()


def test_warnings_do_not_misfire() -> None:
    """A picture has its height in every seed and patch; noise with the wind's height does not."""
    picture = PictureLayer(picture=Raster(drawing(32, 32)), filter="FRACTAL")
    assert Ocean(sea(picture)).statistics().warnings == ()
    (warning,) = Ocean(sea(PictureLayer(wind_speed=15.0, noise_resolution=64))).statistics().warnings
    assert "holds only 0.93 of the longest waves (216 m)" in warning
    (warning,) = Ocean(sea()).statistics().warnings
    assert "flat" in warning
    smooth = PictureLayer(
        picture=Raster(np.tile(np.sin(np.arange(64) * np.pi / 32), (64, 1))), wind_speed=0.5
    )
    warnings = Ocean(sea(smooth)).statistics().warnings
    assert any("Picture 0: its filter leaves nothing" in warning for warning in warnings)


def test_loop_speeds_are_told() -> None:
    layer = PictureLayer(filter="FRACTAL", animation="DOMINANT_BAND", dominant_rate=1.0, surrounding_rate=1.0)
    found = Ocean(sea(layer, loop_duration=8)).statistics()
    assert found.loop_speed_change == pytest.approx(1 - np.pi / 4)  # one turn in 8 s


def test_foam_follows_the_strains_of_pictures() -> None:
    """Noise through the physical filter is a wind sea: its foam covers what that wind's should."""
    parameters = sea(PictureLayer(wind_speed=14.0), domain_size=600.0)
    foam = Ocean(parameters).surface(20.0, ("foam",)).foam
    assert 0.0 < np.mean(foam > 0.5) < 0.2
    assert np.all(Ocean(sea(PictureLayer(filter="FRACTAL"))).surface(3.0, ("foam",)).foam == 0.0)


def test_finest_waves_become_roughness() -> None:
    """What a coarse grid leaves out, a fine one has as slopes."""
    noise = PictureLayer(wind_speed=7.0, noise_resolution=256)
    coarse, fine = sea(noise), sea(noise, resolution=256)
    slopes = Ocean(fine, "double").surface(0.0, ("slope",)).slope
    assert unresolved_slope_variance(fine) == pytest.approx(0.0, abs=1e-9)
    total = total_slope_variance(fine)
    assert np.mean(np.sum(slopes**2, axis=-1)) == pytest.approx(total, rel=0.1)
    resolved = Ocean(coarse).statistics().resolved.mean_square_slope
    assert unresolved_slope_variance(coarse) == pytest.approx(total - resolved, rel=1e-6)


def test_a_shot_keeps_its_pictures() -> None:
    """What is animated moves, the picture stays as it is: the same object, not its numbers read anew."""
    parameters = sea(PictureLayer(picture=Raster(drawing()), filter="FRACTAL"), layers=(WaveLayer(),))
    shot = Shot(parameters, Animation(1, (("layers.0.gain", (0.0, 1.0)),)))
    moved = shot.at(2).parameters
    assert moved.layers[0].gain == 1.0
    assert moved.pictures[0].picture is parameters.pictures[0].picture
    with pytest.raises(ParameterError, match=r"pictures\.0\.gain.*each keeps its waves"):
        Animation(1, (("pictures.0.gain", (0.0, 1.0)),))
