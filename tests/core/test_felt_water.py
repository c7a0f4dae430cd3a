# SPDX-License-Identifier: GPL-3.0-or-later
"""What a hull feels: of a plane all of it, where its waterline lies; of a sea as much as its beam asks."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ocean_tweak.core import OceanParameters, PathSample, WakeLayer, WaveLayer
from ocean_tweak.core.sea import felt_water
from ocean_tweak.core.sea.felt_water import FeltWater, Footprint, felt, felt_sea

HEADING, HALF = 0.5, (6.0, 2.0)
#: the surface is 2 m + 0.1 x - 0.3 y high, and its water has gone 3 m along x and -1 m along y
LEVEL, SLOPE, GONE = 2.0, np.array([0.1, -0.3]), np.array([3.0, -1.0])
ALONG, ACROSS = (np.array([math.cos(turn), math.sin(turn)]) for turn in (HEADING, HEADING + 0.5 * math.pi))


@pytest.mark.parametrize("sways", [False, True])
@pytest.mark.parametrize("drift", [0.0, 0.7])
def test_of_a_plane_it_is_that_plane_under_the_waterline(drift: float, sways: bool) -> None:
    asked = []

    def height(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        asked.append(np.stack((x, y)))
        return LEVEL + SLOPE[0] * x + SLOPE[1] * y

    place = Footprint(25.0, 40.0, HEADING, *HALF, drift, sways)
    found = felt(place, lambda x, y: np.broadcast_to(GONE, (len(x), 2)), height)
    middle = np.array([25.0, 40.0]) + drift * GONE
    assert_allclose(found[:3], [LEVEL + SLOPE @ middle, SLOPE @ ALONG, SLOPE @ ACROSS], atol=1e-12)
    assert_allclose(found[3:], [GONE @ ALONG, GONE @ ACROSS] if sways else [0.0, 0.0], atol=1e-12)
    (points,) = asked
    off = points - middle[:, np.newaxis]
    for axis, half in zip((ALONG, ACROSS), HALF, strict=True):
        assert 0.7 * half < np.abs(axis @ off).max() <= half + 1e-9
        assert_allclose(np.mean(axis @ off), 0.0, atol=1e-9)


def test_what_was_felt_is_kept_up_to_a_number(monkeypatch: pytest.MonkeyPatch) -> None:
    water = FeltWater(OceanParameters(resolution=16, domain_size=100.0, layers=(WaveLayer(),)))
    made = []
    original = felt_water.felt
    monkeypatch.setattr(felt_water, "felt", lambda place, *of: made.append(place) or original(place, *of))
    monkeypatch.setattr(felt_water, "_MOST", 2)
    one, two, three = (Footprint(x, 0.0, 0.0, *HALF, 0.0) for x in (0.0, 10.0, 20.0))
    first = water.at(Fraction(1), one)
    for place in (two, one):
        water.at(Fraction(1), place)
    assert made == [one, two]
    size = water.nbytes
    water.at(Fraction(1), three)
    assert water.nbytes == size > 0
    assert water.at(Fraction(1), one) == first
    assert made == [one, two, three, one]


def test_a_sea_is_as_fine_as_a_beam_asks_and_without_wakes() -> None:
    ship = WakeLayer(path=(PathSample(0.0, -50.0), PathSample(10.0, 50.0)))
    sea = OceanParameters(resolution=512, domain_size=200.0, layers=(WaveLayer(), ship))
    for beam in (4.0, 10.0, 40.0):
        found = felt_sea(sea, beam)
        assert beam / 6.0 < found.domain_size / found.resolution <= beam / 3.0
        assert [*found.active()] == [*sea.layers[:1]]
    assert felt_sea(sea, 0.2).resolution == 512
