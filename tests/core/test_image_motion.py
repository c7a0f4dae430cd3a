# SPDX-License-Identifier: GPL-3.0-or-later
"""How the waves of images move, after Mastin, Watterberg & Mareda (1987)."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from ocean_tweak.core import OceanParameters
from ocean_tweak.core.data.errors import ParameterError
from ocean_tweak.core.data.raster import Raster
from ocean_tweak.core.numerics.grid import WaveVectorGrid
from ocean_tweak.core.waves.image import animation
from ocean_tweak.core.waves.image.parameters import ImageLayer
from tests.core.images import DEEP, L, N, drawing, elevation, single_wave, spectrum, state
from tests.layers import with_layers


def phase_advance(layer: ImageLayer, i: int, j: int, time: float) -> float:
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


def test_translation_moves_the_image_as_it_is() -> None:
    """Eq. 9: after 5 s at 10 m/s along (3, 4)/5 all has moved by (30, 40) m."""
    layer = ImageLayer(
        image=Raster(drawing(80, 80)), filter="FRACTAL", fractal_dimension=3.0, animation="TRANSLATION",
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
    layer = ImageLayer(wind_speed=15.0, animation="DOMINANT_BAND")
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
    layer = ImageLayer(
        image=Raster(np.tile(row, (n, 1))), filter_gain="PAPER", wind_speed=15.0, animation="DOMINANT_BAND"
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
    layer = ImageLayer(image=Raster(drawing()), filter="FRACTAL", animation=animated)
    of = state(layer, loop=Fraction(7))
    np.testing.assert_array_equal(elevation(of, Fraction(0)), elevation(of, Fraction(7)))
    assert np.ptp(elevation(of, Fraction(3)) - elevation(of, Fraction(0))) > 0.01
    still = replace(layer, animation="DOMINANT_BAND", dominant_rate=0.0, surrounding_rate=0.0)
    np.testing.assert_allclose(
        elevation(state(still, loop=Fraction(7)), 2), elevation(state(still)), atol=1e-12
    )


def check_loop(layer: ImageLayer, duration: Fraction | None) -> None:
    with_layers(OceanParameters(domain_size=L, resolution=N, loop_duration=duration), IMAGE=(layer,))


def test_loops_of_a_translation_close_or_are_refused() -> None:
    whole = ImageLayer(
        image=Raster(drawing()), animation="TRANSLATION", translation_speed=L / 10 * np.sqrt(2),
        wind_direction=np.pi / 4,
    )  # fmt: skip
    check_loop(whole, Fraction(10))
    of = state(whole, loop=Fraction(10))
    np.testing.assert_array_equal(elevation(of, Fraction(0)), elevation(of, Fraction(10)))
    half_way = np.roll(elevation(of, 0), (N // 2, N // 2), (0, 1))
    np.testing.assert_allclose(elevation(of, Fraction(5)), half_way, atol=1e-9)
    other = replace(whole, translation_speed=21.0, wind_direction=0.0)
    check_loop(other, None)
    check_loop(replace(other, muted=True), Fraction(10))
    with pytest.raises(
        ParameterError, match=r"layers\.1\.translation_speed = 21\.0: moves the image by 1\.05"
    ) as info:
        check_loop(other, Fraction(10))
    assert "use 20 m/s towards 0 rad" in str(info.value)


def test_waves_run_with_the_wind_and_once() -> None:
    """Each wave of the plane runs one way: k and -k are never both counted, nor in the column kx = 0."""
    for direction in (0.0, 1.2, np.pi / 2, -np.pi / 2, np.pi):
        layer = ImageLayer(filter="FRACTAL", fractal_dimension=3.0, wind_direction=direction)
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
        ImageLayer(wind_speed=6.0),
        ImageLayer(filter="FRACTAL", animation="TRANSLATION", translation_speed=3.0, wind_direction=0.6),
        ImageLayer(filter="WATER_TEXTURE", texture_wavelength=9.0, animation="DOMINANT_BAND"),
    ]
    parts = [state(layer, 64) for layer in layers]
    together = replace(parts[0], others=tuple(parts[1:]))
    for by in ("", "t"):
        expected = sum(elevation(part, 1.3, by) for part in parts)
        np.testing.assert_allclose(elevation(together, 1.3, by), expected, atol=1e-12)
