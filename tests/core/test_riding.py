# SPDX-License-Identifier: GPL-3.0-or-later
"""A hull on the water as an oscillator: its closed form, a numerical solution, and waves of some lengths."""

import math
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ocean_tweak.core.sea import riding, waterline
from ocean_tweak.core.sea.riding import Moments, Oscillator

LENGTH, BEAM, DRAFT = 40.0, 10.0, 3.0


def ridden(water, time, *modes):
    """Where a hull is on water that is a function of time, the same in every mode."""
    return np.array([ridden_in(water, Fraction(time), mode) for mode in modes])


def ridden_in(water, time, mode):
    known = riding.moments(time, mode)
    return riding.ride(np.array([water(float(moment)) for moment in known.times]), known, time, mode)


def amplitude(water, frequency, mode):
    """Of the motion on a water of this frequency, from a quarter of its period to the next."""
    start = Fraction(500)
    quarter = Fraction(math.pi / 2.0 / frequency)
    return math.hypot(*(ridden(water, start + part * quarter, mode)[0] for part in (0, 1)))


@pytest.mark.parametrize("damping", [riding.LEAST_DAMPING, 0.05, 0.1, 0.3, 1.0])
def test_resonance_at_the_natural_period(damping):
    """A spring and a damper that shake: √(1 + 4ζ²)/2ζ, which nears 1/2ζ (Den Hartog 1956, 2.12)."""
    frequency = 2.0 * math.pi / 8.0
    found = amplitude(lambda t: math.sin(frequency * t), frequency, Oscillator(8.0, damping))
    assert found == pytest.approx(math.sqrt(1.0 + 4.0 * damping**2) / (2.0 * damping), rel=0.025)
    if damping < 0.2:
        assert found == pytest.approx(1.0 / (2.0 * damping), rel=0.04)


def test_a_long_roll_beside_a_quick_heave_is_remembered_whole():
    """Each as at its own resonance, √(1 + 4ζ²)/2ζ: neither shortens what the other remembers."""
    heave, roll = Oscillator(2.0, 0.3), Oscillator(14.0, 0.05)
    for column, mode in enumerate((heave, roll)):
        frequency = 2.0 * math.pi / mode.period
        start, quarter = Fraction(500), Fraction(mode.period / 4.0)
        parts = [
            ridden(lambda t, w=frequency: math.sin(w * t), start + part * quarter, heave, roll)[column]
            for part in (0, 1)
        ]
        whole = math.sqrt(1.0 + 4.0 * mode.damping**2) / (2.0 * mode.damping)
        assert math.hypot(*parts) == pytest.approx(whole, rel=0.025)


@pytest.mark.parametrize("ratio", [0.2, 0.7, 1.5, 3.0])
def test_the_answer_to_a_frequency(ratio):
    """Transmissibility: √((1 + (2ζr)²)/((1 − r²)² + (2ζr)²))."""
    damping, period = 0.2, 6.0
    frequency = ratio * 2.0 * math.pi / period
    whole = math.hypot(1.0, 2.0 * damping * ratio) / math.hypot(1.0 - ratio**2, 2.0 * damping * ratio)
    assert amplitude(
        lambda t: math.cos(frequency * t), frequency, Oscillator(period, damping)
    ) == pytest.approx(whole, abs=0.035)


def test_it_solves_the_equation_of_motion():
    """On uneven water after a calm, against Runge and Kutta from the same beginning."""
    numbers = np.random.default_rng(4)
    known = Moments(Fraction(1, 2), range(-100, 41))
    water = np.zeros(len(known.numbers))
    water[100:] = np.cumsum(numbers.normal(size=41))
    times = np.array([float(time) for time in known.times])
    damping, omega = 0.15, 2.0 * math.pi / 7.0

    def motion(time, state):
        place = min(int((time - times[0]) / 0.5), len(times) - 2)
        slope = (water[place + 1] - water[place]) / 0.5
        height = water[place] + slope * (time - times[place])
        off = state[0] - height
        return [state[1], -2.0 * damping * omega * (state[1] - slope) - omega**2 * off]

    solved = solve_ivp(motion, (-1.0, 19.7), [0.0, 0.0], max_step=0.02, rtol=1e-8, atol=1e-8)
    found = riding.ride(water, known, Fraction(197, 10), Oscillator(7.0, damping))
    assert found == pytest.approx(solved.y[0, -1], abs=2e-3)


def test_it_moves_without_jumps():
    """Place and speed go on where a moment is passed, and where one is forgotten."""
    mode = Oscillator(6.0, 0.1)
    step = riding.moments(Fraction(0), mode).step
    height = lambda t: math.sin(0.9 * t) + 0.5 * math.sin(1.7 * t)  # noqa: E731
    times = [7 * step + Fraction(part, 100) * step for part in range(-300, 300)]
    places = np.array([ridden(height, time, mode)[0] for time in times])
    speeds = np.diff(places) / (float(step) / 100.0)
    assert np.abs(speeds).max() < 12.0
    assert np.abs(speeds).max() > 1.0
    assert np.abs(np.diff(speeds)).max() < 0.03


def test_a_time_needs_a_bounded_past_that_it_shares_with_others():
    for mode in (Oscillator(9.0, 0.02), Oscillator(7.99, 0.02), Oscillator(0.5, 0.3)):
        for time in (Fraction(0), Fraction(-3), Fraction(10**6, 7)):
            known = riding.moments(time, mode)
            assert len(known.numbers) <= 1352
            assert known.times[-2] <= time < known.times[-1]
            assert time - known.times[0] >= mode.memory
    near = [riding.moments(Fraction(100) + Fraction(n, 24), Oscillator(8.0, 0.1)) for n in range(48)]
    together = set().union(*(known.numbers for known in near))
    assert len(together) <= len(near[0].numbers) + 2.0 / float(near[0].step) + 1


def test_any_order_has_the_same_bytes():
    modes = (Oscillator(6.0, 0.3), Oscillator(11.0, 0.1))
    height = lambda t: math.sin(0.7 * t) + 0.2 * math.sin(2.3 * t)  # noqa: E731
    times = [Fraction(n, 24) for n in range(60)]
    forth = [ridden(height, time, *modes).tobytes() for time in times]
    back = [ridden(height, time, *modes).tobytes() for time in reversed(times)]
    assert forth == back[::-1]
    assert len(set(forth)) == len(forth)


def motion_on_waves(wavelength):
    """Heave in m and pitch as a slope on waves of 1 m from ahead in deep water, at four of their phases."""
    k = 2.0 * math.pi / wavelength
    frequency = math.sqrt(9.81 * k)
    half = (0.5 * LENGTH, 0.5 * BEAM)
    periods = riding.natural_periods(LENGTH, BEAM, DRAFT)
    modes = (Oscillator(periods.heave, 0.3), Oscillator(periods.pitch, 0.3))
    x = half[0] * waterline.stencil()[:, 0]
    result = []
    for part in range(4):
        time = Fraction(300) + part * Fraction(math.pi / 2.0 / frequency)
        found = []
        for mode, felt in zip(modes, ("height", "slope_x"), strict=True):
            known = riding.moments(time, mode)
            heights = np.array([np.cos(k * x + frequency * float(moment)) for moment in known.times])
            water = getattr(waterline.fitted_plane(heights, half), felt)
            found.append(riding.ride(water, known, time, mode))
        result.append((found, frequency * float(time), k))
    return result


def test_waves_a_fifth_of_the_hull_do_not_move_it():
    for (heave, pitch), _, k in motion_on_waves(LENGTH / 5.0):
        assert abs(heave) < 0.01
        assert abs(pitch) < 0.01 * k


def test_it_follows_a_swell_ten_times_as_long():
    for (heave, pitch), phase, k in motion_on_waves(LENGTH * 10.0):
        assert heave == pytest.approx(math.cos(phase), abs=0.12)
        assert pitch == pytest.approx(-k * math.sin(phase), abs=0.12 * k)


def test_natural_periods_of_known_ships():
    """The code's own formula; and what measured ships have: heave and pitch of a 175 m container ship about
    8.5 s (ITTC's S-175), of a boat of 15 m three to four, roll of it five to six.
    """
    large = riding.natural_periods(175.0, 25.4, 9.5)
    assert 7.5 < large.heave == large.pitch < 9.5
    share = 0.373 + 0.023 * 25.4 / 9.5 - 0.043 * 1.75
    assert large.roll == pytest.approx(2.0 * share * 25.4 / math.sqrt(2.54))
    largest = riding.natural_periods(800.0, 80.0, 25.0)  # beyond what the code was made for
    assert largest.roll == pytest.approx(2.0 * 0.25 * 80.0 / math.sqrt(8.0))
    boat = riding.natural_periods(15.0, 4.7, 1.5)
    assert 3.0 < boat.heave < 4.0
    assert 5.0 < boat.roll < 6.5
    buoy = riding.natural_periods(1.5, 1.5, 0.5)
    assert buoy.roll == buoy.pitch == buoy.heave
    moon = riding.natural_periods(15.0, 4.7, 1.5, gravity=1.62)
    assert (
        moon.roll / boat.roll
        == pytest.approx(moon.heave / boat.heave)
        == pytest.approx(math.sqrt(9.81 / 1.62))
    )


def test_what_is_no_hull_or_no_water_is_refused():
    with pytest.raises(ValueError, match=r"draft = 0\.0"):
        riding.natural_periods(10.0, 3.0, 0.0)
    with pytest.raises(ValueError, match=r"damping = 0\.0"):
        Oscillator(3.0, 0.0)
    with pytest.raises(ValueError, match="period = nan"):
        Oscillator(math.nan, 0.1)
    mode = Oscillator(3.0, 0.1)
    known = riding.moments(Fraction(0), mode)
    with pytest.raises(ValueError, match="not finite"):
        riding.ride(np.full(len(known.numbers), np.nan), known, Fraction(0), mode)
    with pytest.raises(ValueError, match="must be"):
        riding.ride(np.zeros(3), known, Fraction(0), mode)
