# SPDX-License-Identifier: GPL-3.0-or-later
"""Statistics of seas whose numbers are known beforehand."""

from __future__ import annotations

import numpy as np
import pytest

from ocean_tweak.core import Ocean, OceanParameters, Timing, Water, WaveLayer
from ocean_tweak.core.numerics.grid import WaveVectorGrid
from ocean_tweak.core.spectral.sea_state import SeaState, together
from ocean_tweak.core.statistics import sea_scales
from ocean_tweak.core.statistics.sea_statistics import field_state, mode_state


@pytest.fixture
def parameters() -> OceanParameters:
    return OceanParameters(resolution=64, domain_size=640.0, dispersion="DEEP")


def test_one_wave(parameters: OceanParameters) -> None:
    """A = 2 m, 8 wavelengths of 80 m in 640 m along +y, or the field it leaves."""
    grid = WaveVectorGrid(64, 640.0)
    along, against = np.zeros(grid.shape), np.zeros(grid.shape)
    along[8, 0] = against[-8, 0] = 1.0  # |h|² = (A/2)² at ky and conjugated at -ky
    state = mode_state(along, against, grid, parameters)
    assert state.m0 == pytest.approx(2.0)
    assert state.significant_wave_height == pytest.approx(4 * np.sqrt(2.0))
    k = 2 * np.pi / 80.0
    period = 2 * np.pi / np.sqrt(9.81 * k)
    assert state.zero_crossing_period == pytest.approx(period)
    assert state.peak_period == pytest.approx(period, rel=0.05)  # the kernel's width
    assert state.mean_square_slope == pytest.approx(2.0 * k**2)
    assert state.mean_direction == pytest.approx(np.pi / 2)
    assert state.directional_spread == pytest.approx(0.0, abs=1e-6)
    assert state.steepness == pytest.approx(4 * np.sqrt(2.0) / state.peak_wavelength)
    y = 10.0 * np.arange(64)[:, np.newaxis] * np.ones(64)
    measured = field_state(2.0 * np.cos(k * y + 0.3), parameters)
    assert measured.m0 == pytest.approx(2.0)
    assert abs(measured.mean_direction) == pytest.approx(np.pi / 2)
    assert measured.directional_spread == pytest.approx(0.0, abs=1e-4)
    assert measured.zero_crossing_period == pytest.approx(period)


def test_directions_of_a_known_spreading() -> None:
    # cos²θ has r = 8/3π, so a spread of √(2 - 16/3π) = 0.5499 rad; flat has r = 0, √2
    for model, spread in (("COSINE_SQUARED", 0.5499), ("FLAT", np.sqrt(2.0))):
        layer = WaveLayer(spreading=model, swell=0.0, wind_direction=2.0)
        sea = Ocean(OceanParameters(resolution=128, domain_size=600.0, layers=(layer,)))
        statistics = sea.statistics()
        assert statistics.spectrum.directional_spread == pytest.approx(spread, abs=1e-3)
        assert statistics.resolved.directional_spread == pytest.approx(spread, abs=0.02)
        if model != "FLAT":
            assert statistics.spectrum.mean_direction == pytest.approx(2.0, abs=1e-6)
            assert statistics.resolved.mean_direction == pytest.approx(2.0, abs=0.02)
            assert statistics.seed.mean_direction == pytest.approx(2.0, abs=0.3)
            field = field_state(sea.surface(3.0).displacement[..., 2], sea.parameters)
            assert field.mean_direction == pytest.approx(2.0 - np.pi, abs=0.3)  # the axis, in (-π/2, π/2]
            assert field.directional_spread == pytest.approx(spread, abs=0.15)


def test_periods_of_a_pierson_moskowitz_sea() -> None:
    layer = WaveLayer(spectrum="PIERSON_MOSKOWITZ", wind_speed=10.0)
    statistics = Ocean(
        OceanParameters(resolution=512, domain_size=1000.0, dispersion="DEEP", layers=(layer,))
    ).statistics()
    peak_period = 2 * np.pi / (0.855 * 9.81 / 10.0)
    assert statistics.peak_period == pytest.approx(peak_period, rel=1e-3)
    assert statistics.spectrum.zero_crossing_period == pytest.approx(0.7104 * peak_period, rel=2e-3)
    assert statistics.significant_wave_height == pytest.approx(2.245, rel=1e-3)
    assert statistics.peak_wavelength == pytest.approx(9.81 * peak_period**2 / (2 * np.pi), rel=2e-3)
    assert statistics.resolved.peak_period == pytest.approx(peak_period, rel=0.05)
    # waves longer than 4 m carry all but the tail: 1 - exp(-5/4 (ω_p/ω)⁴) of the energy is lost
    omega = np.sqrt(9.81 * 2 * np.pi / 3.9)
    lost = 1 - np.exp(-1.25 * (2 * np.pi / peak_period / omega) ** 4)
    assert 1 - statistics.resolved_share == pytest.approx(lost, rel=0.25)
    assert not statistics.warnings


def test_warnings_name_the_remedy() -> None:
    sea = Ocean(OceanParameters(resolution=16, domain_size=200.0))
    warnings = sea.statistics().warnings
    assert "holds only 2.2 of the longest waves (89.7 m)" in warnings[0]
    assert "at least 270 m" in warnings[0]
    assert "samples are 12.5 m apart" in warnings[1]
    gusts = OceanParameters(resolution=64, layers=(WaveLayer(wind_speed=5.0, fetch=300e3),))
    assert any("fully developed after 43.4" in w for w in Ocean(gusts).statistics().warnings)
    enough = Ocean(OceanParameters(resolution=256, domain_size=400.0, water=Water(depth=200.0)))
    assert enough.statistics().warnings == ()


@pytest.mark.parametrize(
    ("wind", "number"),
    [(0.0, 0), (0.29, 0), (0.3, 1), (3.3, 2), (5.5, 4), (12.0, 6), (17.2, 8), (24.4, 9), (32.6, 11),
     (32.7, 12), (90, 12)],
)  # fmt: skip
def test_beaufort(wind: float, number: int) -> None:
    assert sea_scales.beaufort_number(wind) == number


@pytest.mark.parametrize(
    ("height", "code", "name"),
    [(0.0, 0, "Calm (glassy)"), (0.05, 1, "Calm (rippled)"), (0.5, 2, "Smooth"), (1.25, 3, "Slight"),
     (2.0, 4, "Moderate"), (4.0, 5, "Rough"), (4.01, 6, "Very rough"), (9.0, 7, "High"),
     (14.0, 8, "Very high"),
     (14.5, 9, "Phenomenal")],
)  # fmt: skip
def test_sea_states(height: float, code: int, name: str) -> None:
    assert sea_scales.sea_state(height) == code
    assert sea_scales.SEA_STATE_NAMES[code] == name


def test_scales_refuse_what_is_not_on_them() -> None:
    for call in (
        lambda: sea_scales.beaufort_number(-1.0),
        lambda: sea_scales.beaufort_number(float("nan")),
        lambda: sea_scales.sea_state(-0.1),
    ):
        with pytest.raises(ValueError, match="="):
            call()


@pytest.mark.parametrize(
    ("periods", "change"), [(4.54, 0.1013), (4.56, 0.0965), (4.43, 0.0971), (4.46, 0.1031)]
)
def test_loops_that_change_speeds_by_more_than_a_tenth_are_warned_about(
    periods: float, change: float
) -> None:
    """Waves of 25 m, in deep water √(2π·25/g) = 4.0014 s long, must go round a whole number of times."""
    wave = WaveLayer(
        definition="SEA_STATE", peak_period=4.0, shortest_wavelength=20.0, longest_wavelength=30.0
    )
    period = (2.0 * np.pi * 25.0 / 9.81) ** 0.5
    sea = OceanParameters(
        resolution=16, domain_size=25.0, dispersion="DEEP", layers=(wave,),
        loop_duration=f"{periods * period:.3f}", timing=Timing(fps=1000),
    )  # fmt: skip
    statistics = Ocean(sea).statistics()
    assert statistics.loop_speed_change == pytest.approx(change, abs=1e-4)
    assert any("changes the speed" in warning for warning in statistics.warnings) == (change > 0.1)


def test_two_crossing_swells_together() -> None:
    """As high as each other, to the east and to the north, of one direction each: r = √½."""
    east = SeaState(1.0, 12.0, 10.0, 225.0, 0.001, 0.0, 0.0)
    north = SeaState(1.0, 6.0, 5.0, 56.0, 0.004, 0.5 * np.pi, 0.0)
    both = together([east, north])
    assert both.m0 == 2.0
    assert both.mean_square_slope == 0.005
    assert both.mean_direction == pytest.approx(0.25 * np.pi)
    assert both.directional_spread == pytest.approx(np.sqrt(2.0 - np.sqrt(2.0)))
    # as many zero crossings as their mean squares tell: 1/Tz² = ½(1/10² + 1/5²)
    assert both.zero_crossing_period == pytest.approx(np.sqrt(40.0))
    wide = together([east, SeaState(1.0, 12.0, 10.0, 225.0, 0.001, 0.0, 0.6)])
    assert wide.directional_spread == pytest.approx(np.sqrt(0.5 * 0.6**2))
