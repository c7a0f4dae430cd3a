# SPDX-License-Identifier: GPL-3.0-or-later
"""Every field, in double precision, against sums of cosines and against theory for a single wave."""

from __future__ import annotations

import dataclasses
from fractions import Fraction

import numpy as np
import pytest

from ocean_tweak.core import Ocean, OceanParameters, Timing, Water, WaveLayer
from ocean_tweak.core.numerics.grid import WaveVectorGrid
from ocean_tweak.core.statistics.sea_spectrum import SeaSpectrum
from ocean_tweak.core.synthesis.channels import OF_WAVES
from ocean_tweak.core.synthesis.coefficients import InitialState
from tests.core import direct_sum
from tests.core.direct_sum import surface_of

SEAS = {
    "one layer": OceanParameters(resolution=16, domain_size=250.0, choppiness=0.9, seed=3),
    "three layers in finite depth": OceanParameters(
        resolution=16,
        domain_size=250.0,
        dispersion="FINITE_DEPTH",
        water=Water(depth=12.0),
        layers=(
            WaveLayer(wind_direction=1.0),
            WaveLayer(spectrum="JONSWAP", spreading="HASSELMANN", wind_direction=-2.0, wind_speed=8.0),
            WaveLayer(
                definition="SEA_STATE", significant_wave_height=1.5, peak_period=9.0, wind_direction=4.0
            ),
        ),
    ),
    "loop": OceanParameters(
        resolution=16,
        domain_size=250.0,
        loop_duration=Fraction(15),
        amplitudes="DETERMINISTIC",
        dispersion="DEEP",
    ),
    "wide orbits": OceanParameters(
        resolution=16, domain_size=250.0, orbital_motion="FINITE_DEPTH", water=Water(depth=5.0)
    ),
}


def expected_fields(parameters: OceanParameters, time: float) -> dict[str, np.ndarray]:
    """All outputs from the direct sum, by their definitions."""
    depth = parameters.water.depth
    coth = (
        (lambda k: 1.0 / np.tanh(k * depth))
        if parameters.orbital_motion == "FINITE_DEPTH"
        else (lambda k: 1.0)
    )
    sums = direct_sum.fields(
        Ocean(parameters, precision="double").initial_state, time, parameters.choppiness, coth
    )
    return outputs_from(sums)


def outputs_from(sums: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    gradient = np.stack(
        [np.stack([1 + sums["x_x"], sums["x_y"]], -1), np.stack([sums["y_x"], 1 + sums["y_y"]], -1)], -2
    )
    symmetric = 0.5 * (gradient + np.swapaxes(gradient, -1, -2))
    values, vectors = np.linalg.eigh(symmetric)
    along_x = np.stack([1 + sums["x_x"], sums["y_x"], sums["z_x"]], -1)
    along_y = np.stack([sums["x_y"], 1 + sums["y_y"], sums["z_y"]], -1)
    normal = np.cross(along_x, along_y)
    return {
        "displacement": np.stack([sums[c] for c in "xyz"], -1),
        "slope": np.stack([sums["z_x"], sums["z_y"]], -1),
        "velocity": np.stack([sums[c + "_t"] for c in "xyz"], -1),
        "strain": np.stack([sums["x_x"], sums["y_y"], 0.5 * (sums["x_y"] + sums["y_x"])], -1),
        "jacobian": np.linalg.det(gradient),
        "min_eigenvalue": values[..., 0],
        "cusp": np.maximum(0.0, 1.0 - values[..., 0]),
        "min_eigenvector": vectors[..., :, 0],
        "normal": normal / np.linalg.norm(normal, axis=-1, keepdims=True),
    }


def assert_fields_equal(fields, expected: dict[str, np.ndarray]) -> None:
    assert set(expected) == set(OF_WAVES)
    for name, value in expected.items():
        actual = getattr(fields, name)
        if name == "min_eigenvector":  # a direction, not an arrow
            assert np.all(actual[..., 0] >= 0.0)
            actual = np.abs(np.sum(actual * value, axis=-1))
            value = np.ones_like(actual)
        np.testing.assert_allclose(
            actual, value, atol=1e-12 * max(1.0, np.max(np.abs(value))), rtol=0, err_msg=name
        )


@pytest.mark.parametrize("name", SEAS)
@pytest.mark.parametrize("time", [0.0, 2.75, 40.0])
def test_every_field_equals_the_direct_sum(name: str, time: float) -> None:
    fields = Ocean(SEAS[name], precision="double").surface(time, OF_WAVES)
    assert_fields_equal(fields, expected_fields(SEAS[name], time))


def test_single_precision_fields_are_near() -> None:
    parameters = SEAS["three layers in finite depth"]
    single = Ocean(parameters).surface(2.75, OF_WAVES)
    double = Ocean(parameters, precision="double").surface(2.75, OF_WAVES)
    for name in set(OF_WAVES) - {"min_eigenvector"}:
        np.testing.assert_allclose(getattr(single, name), getattr(double, name), atol=2e-5, err_msg=name)


@pytest.mark.parametrize("strength", [0.4, 1.0])
def test_trough_damping(strength: float) -> None:
    """P = P_L + w P_H with w = 1 - δ S(-h_L / 2s), its derivatives by the product rule."""
    parameters = dataclasses.replace(SEAS["one layer"], trough_damping=strength)
    ocean = Ocean(parameters, precision="double")
    state = ocean.initial_state
    peak = SeaSpectrum(parameters).peak_wave_number

    def long_wave(k: float) -> float:
        return float(np.exp(-((k / (3.0 * peak)) ** 4)))

    energy = (state.expected_plus + state.expected_minus) * state.grid.multiplicity
    s = np.sqrt(np.sum(np.vectorize(long_wave)(state.grid.k) ** 2 * energy))
    everything = direct_sum.fields(state, 3.0, parameters.choppiness)
    low = direct_sum.fields(state, 3.0, parameters.choppiness, weight=long_wave)
    u = np.clip(-low["z"] / (2 * s), 0, 1)
    w = 1 - strength * (3 * u**2 - 2 * u**3)
    expected = {}
    for c in "xyz":
        expected[c] = low[c] + w * (everything[c] - low[c])
        for d in ("_x", "_y", "_t"):
            inside = (u > 0) & (u < 1)
            w_rate = np.where(inside, -strength * 6 * u * (1 - u) * -low["z" + d] / (2 * s), 0.0)
            expected[c + d] = (
                low[c + d] + w * (everything[c + d] - low[c + d]) + w_rate * (everything[c] - low[c])
            )
    assert_fields_equal(ocean.surface(3.0, OF_WAVES), outputs_from(expected))
    assert np.min(w) < 1.0 - 0.3 * strength


def test_trough_damping_spares_crests() -> None:
    plain = OceanParameters(resolution=64, domain_size=200.0, layers=(WaveLayer(swell=1.0),))
    damped = dataclasses.replace(plain, trough_damping=1.0)
    before, after = (Ocean(p).surface(1.0).displacement[..., 2] for p in (plain, damped))
    crest = before > 1.2 * np.std(before)
    trough = before < -1.2 * np.std(before)
    change = np.abs(after - before)
    assert np.mean(change[trough]) > 10 * np.mean(change[crest])


def one_wave(amplitude: float, n: int = 64) -> InitialState:
    """h = A cos(x - ωt) on a domain of 2π in deep water."""
    grid = WaveVectorGrid(n, 2 * np.pi)
    h_plus, nothing = np.zeros(grid.shape, complex), np.zeros(grid.shape, complex)
    h_plus[0, 1] = 0.5 * amplitude
    energy = np.abs(h_plus) ** 2
    return InitialState(grid, h_plus, nothing, np.sqrt(9.81 * grid.k), energy, nothing.real)


def test_a_single_wave() -> None:
    """At the crest of A cos(kx - ωt), k = 1: J = 1 - kA, velocity (+Aω, 0, 0), level; steepest behind it."""
    A, omega = 0.2, np.sqrt(9.81)
    fields = {name: field[0] for name, field in surface_of(one_wave(A)).items()}
    x = 2 * np.pi / 64 * np.arange(64)
    np.testing.assert_allclose(fields["jacobian"], 1 - A * np.cos(x), atol=1e-12)
    np.testing.assert_allclose(fields["min_eigenvalue"], np.minimum(1.0, 1 - A * np.cos(x)), atol=1e-12)
    np.testing.assert_allclose(fields["velocity"][0], [A * omega, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(fields["normal"][0], [0.0, 0.0, 1.0], atol=1e-12)
    np.testing.assert_allclose(np.abs(fields["min_eigenvector"][0]), [1.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(fields["slope"][..., 0], -A * np.sin(x), atol=1e-12)
    # seen from above the point x + D has the slope dz/dX = z_x / (1 + D_x), which the normal must show
    normal = fields["normal"]
    np.testing.assert_allclose(-normal[:, 0] / normal[:, 2], -A * np.sin(x) / (1 - A * np.cos(x)), atol=1e-12)


@pytest.mark.parametrize(
    "changes", [{}, {"trough_damping": 0.8}, {"loop_duration": 12, "orbital_motion": "FINITE_DEPTH"}]
)
def test_velocity_is_the_rate_of_displacement(changes: dict) -> None:
    """Central differences in time converge to the velocity with the square of the step."""
    parameters = OceanParameters(resolution=32, domain_size=200.0, water=Water(depth=30.0), **changes)
    ocean = Ocean(parameters, precision="double")
    velocity = ocean.surface(5.0, {"velocity"}).velocity
    errors = []
    for step in (0.02, 0.01):
        after, before = (ocean.surface(5.0 + s).displacement for s in (step, -step))
        errors.append(np.sqrt(np.mean(((after - before) / (2 * step) - velocity) ** 2)))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)
    assert errors[1] < 1e-3 * np.sqrt(np.mean(velocity**2))


# Loops


def test_a_loop_ends_where_it_began() -> None:
    timing = Timing(fps=Fraction(24000, 1001), start_frame=1001)
    parameters = OceanParameters(resolution=32, loop_duration=Fraction("4.004"), timing=timing)
    ocean = Ocean(parameters)
    assert ocean.frame(1001).displacement.tobytes() == ocean.frame(1001 + 96).displacement.tobytes()
    assert (
        ocean.frame(1001 + 7).displacement.tobytes()
        == ocean.frame(1001 + 7 + 96 * 1000).displacement.tobytes()
    )
    assert ocean.frame(990).displacement.tobytes() == ocean.frame(990 + 96).displacement.tobytes()
    assert ocean.frame(1001).displacement.tobytes() != ocean.frame(1001 + 48).displacement.tobytes()


def test_a_loop_changes_frequencies_by_half_a_step_at_most() -> None:
    free = OceanParameters(resolution=32, domain_size=400.0)
    looped = dataclasses.replace(free, loop_duration=Fraction(20))
    step = 2 * np.pi / 20
    before, after = (Ocean(p).initial_state.omega for p in (free, looped))
    turns = after / step
    np.testing.assert_allclose(turns, np.rint(turns), atol=1e-9)
    assert np.min(turns) >= 1.0
    change = np.abs(after - before)[before > step]
    assert np.max(change) <= 0.5 * step + 1e-12
    speed = Ocean(looped).statistics().loop_speed_change
    assert 0.0 < speed <= 0.5 * step / np.min(before[before > 0])
    assert Ocean(free).statistics().loop_speed_change is None


def test_a_loop_must_be_whole_frames() -> None:
    with pytest.raises(ValueError, match=r"loop_duration = '10'.*239.76 frames.*10.01 s, 240 frames"):
        OceanParameters(loop_duration=10, timing=Timing(fps=Fraction(24000, 1001)))
    thirds = OceanParameters(loop_duration="10/3", timing=Timing(fps=30))
    assert OceanParameters.from_json(thirds.to_json()) == thirds
    assert '"10/3"' in thirds.to_json()


def test_short_loops_are_warned_about() -> None:
    short = Ocean(OceanParameters(resolution=32, loop_duration=Fraction(5))).statistics()
    assert any("shorter than 3 peak periods" in w and "Make it at least 23 s" in w for w in short.warnings)
    assert any("changes the speed" in w for w in short.warnings)
    long = Ocean(OceanParameters(resolution=64, loop_duration=Fraction(200))).statistics()
    assert not long.warnings
