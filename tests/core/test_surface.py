# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface against a direct sum of cosines, and single waves against theory."""

from __future__ import annotations

import numpy as np
import pytest

from ocean_tweak.core import Ocean, OceanParameters, Timing, Water, WaveLayer
from ocean_tweak.core.numerics.grid import WaveVectorGrid
from ocean_tweak.core.synthesis.channels import OF_WAVES
from ocean_tweak.core.synthesis.coefficients import InitialState
from tests.core import direct_sum
from tests.core.direct_sum import surface_of


@pytest.mark.parametrize("time", [0.0, 1.7, 3600.0])
def test_transform_equals_the_sum_of_cosines(time: float) -> None:
    parameters = OceanParameters(
        resolution=16,
        domain_size=300.0,
        seed=4,
        choppiness=0.8,
        water=Water(depth=20.0),
        layers=(WaveLayer(wind_speed=15.0, wind_direction=1.1, fetch=200e3, swell=0.2),),
    )
    ocean = Ocean(parameters)
    summed = direct_sum.fields(Ocean(parameters, precision="double").initial_state, time, 0.8)
    expected = np.stack([summed[component] for component in "xyz"], axis=-1)
    error = np.abs(ocean.surface(time).displacement - expected)
    assert np.max(error) < 1e-6 * np.max(np.abs(expected))
    assert np.any(ocean.initial_state.h_plus[:, 0])


def single_wave(amplitude: float, index: tuple[int, int], n: int = 256) -> InitialState:
    """One cosine that travels along +k, with k = 1 rad/m times the index, in deep water."""
    grid = WaveVectorGrid(n, 2 * np.pi)
    h_plus = np.zeros(grid.shape, np.complex128)
    h_plus[index] = 0.5 * amplitude
    omega = np.sqrt(9.81 * grid.k)
    h_minus = np.zeros_like(h_plus)
    return InitialState(grid, h_plus, h_minus, omega, np.abs(h_plus) ** 2, np.abs(h_minus) ** 2)


def test_crests_sharpen() -> None:
    """A = 0.1 m, k = 1: at fixed x the second harmonic is +½kA², the mean -½kA², the skewness +0.106."""
    A = 0.1
    state = single_wave(A, (0, 1), n=1024)
    moved = surface_of(state)["displacement"][0]
    x = 2 * np.pi / 1024 * np.arange(1024)
    position, height = x + moved[:, 0], moved[:, 2]
    elevation = np.interp(x, position, height, period=2 * np.pi)
    coefficients = np.fft.rfft(elevation) / 1024
    assert 2 * coefficients[2].real == pytest.approx(0.5 * A**2, rel=0.02)
    assert coefficients[0].real == pytest.approx(-0.5 * A**2, rel=0.02)
    skewness = np.mean((elevation - elevation.mean()) ** 3) / np.std(elevation) ** 3
    assert skewness == pytest.approx(0.106, abs=0.02 * 0.106 + 0.004)


@pytest.mark.parametrize("index", [(0, 3), (2, 3), (-2, 3), (5, 0)])
def test_a_wave_travels_along_its_wave_vector(index: tuple[int, int]) -> None:
    state = single_wave(0.2, index, n=64)
    if index[1] == 0:  # the column holds a wave twice, at ky and conjugated at -ky
        state.h_minus[-index[0], 0] = np.conj(state.h_plus[index])
    k = np.array([index[1], index[0]], float)
    speed = np.sqrt(9.81 / np.hypot(*k))
    time = 0.37
    x = 2 * np.pi / 64 * np.arange(64)
    X, Y = np.meshgrid(x, x)
    along = (k[0] * X + k[1] * Y) - np.hypot(*k) * speed * time
    elevation = surface_of(state, time)["displacement"][..., 2]
    np.testing.assert_allclose(elevation, 0.2 * np.cos(along), atol=1e-6)


def test_wind_direction_is_where_the_waves_go() -> None:
    """Most energy travels along the wind: the mean of k over h_plus and h_minus points with it."""
    for direction in (0.0, 2.0, -2.5):
        layer = WaveLayer(wind_direction=direction, swell=0.5)
        state = Ocean(OceanParameters(resolution=64, domain_size=400.0, layers=(layer,))).initial_state
        flow = np.abs(state.h_plus) ** 2 - np.abs(state.h_minus) ** 2
        vector = np.array([np.sum(flow * state.grid.kx), np.sum(flow * state.grid.ky)])
        difference = np.arctan2(vector[1], vector[0]) - direction
        assert abs((difference + np.pi) % (2 * np.pi) - np.pi) < 0.25


def test_single_precision_stays_exact_after_hours(windy: OceanParameters) -> None:
    single = Ocean(windy).surface(1e4, OF_WAVES)
    double = Ocean(windy, precision="double").surface(1e4, OF_WAVES)
    for name in OF_WAVES:
        exact = getattr(double, name)
        error = getattr(single, name) - exact
        assert getattr(single, name).dtype == np.float32
        assert exact.dtype == np.float64
        if name not in ("min_eigenvector", "jacobian", "min_eigenvalue", "normal"):  # these are not linear
            assert np.sqrt(np.mean(error**2) / np.mean(exact**2)) < 5e-7, name
        else:
            assert np.sqrt(np.mean(error**2)) < 2e-6, name


def test_frames_belong_to_the_shot(windy: OceanParameters) -> None:
    shot = windy.replace(timing=Timing(fps=25, start_frame=1001))  # type: ignore[arg-type]
    np.testing.assert_array_equal(
        Ocean(shot).frame(1011).displacement, Ocean(windy).surface(0.4).displacement
    )


def test_any_frame_alone_has_the_same_bytes(windy: OceanParameters) -> None:
    in_order = [Ocean(windy).frame(frame).displacement.tobytes() for frame in (1, 2, 3)]
    backwards = [Ocean(windy).frame(frame).displacement.tobytes() for frame in (3, 2, 1)]
    assert in_order == backwards[::-1]


def test_outputs_that_were_not_asked_for_are_named(windy: OceanParameters) -> None:
    ocean = Ocean(windy)
    with pytest.raises(AttributeError, match="displacement was not computed"):
        _ = ocean.surface(0.0, outputs=()).displacement
    with pytest.raises(ValueError, match="'foam_colour'"):
        ocean.surface(0.0, outputs={"foam_colour"})
    with pytest.raises(ValueError, match="time = nan"):
        ocean.surface(float("nan"))
