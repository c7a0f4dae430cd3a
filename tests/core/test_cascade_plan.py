# SPDX-License-Identifier: GPL-3.0-or-later
"""Planned patches: what they promise, that nothing repeats, and what is said where it cannot be."""

from __future__ import annotations

import dataclasses
import math
import os
import re

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from ocean_tweak.core import Area, Ocean, OceanParameters, ParameterError, Patch, WaveLayer
from ocean_tweak.core.sea.memory import memory_need
from ocean_tweak.core.sea.patch_plan import SPARE, Wish, odd_side, planned

#: many more with `make test-long`
QUICK = settings(
    max_examples=500 if "OCEAN_TWEAK_LONG_TESTS" in os.environ else 40,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow],
)


def decades(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(math.log(low), math.log(high)).map(math.exp)


@QUICK
@given(
    wind=st.floats(2.0, 35.0), finest=decades(0.02, 5.0), area=decades(50.0, 20e3), memory=decades(3e7, 8e9)
)
def test_any_plan_keeps_what_it_promises(wind: float, finest: float, area: float, memory: float) -> None:
    sea = OceanParameters(layers=(WaveLayer(wind_speed=wind),))
    try:
        result = planned(sea, Wish(finest, area, memory))
    except ParameterError:  # what it says is tested below
        return
    patches = result.patches
    assert 1 <= len(patches) <= 4
    assert patches[-1].shortest_wavelength == finest
    assert patches[0].domain_size >= area
    assert memory_need(result).peak() <= memory
    for patch in patches:
        assert 4.0 * patch.domain_size / patch.resolution <= patch.shortest_wavelength
    for patch in patches[1:]:
        assert patch.domain_size >= 6.0 * patch.longest_wavelength
    peak = Ocean(sea.replace(resolution=16)).statistics().peak_wavelength
    assert patches[0].domain_size >= 6.0 * peak * 0.95
    for index, one in enumerate(patches):
        for other in patches[index + 1 :]:
            turn = math.remainder(other.rotation - one.rotation, 0.5 * math.pi)
            assert abs(turn) > 0.2
            ratio = one.domain_size / other.domain_size
            assert min(abs(ratio * q - round(ratio * q)) for q in range(1, 6)) > 1e-3


def test_waves_that_repeat_hold_a_tenth_of_the_variance_at_most() -> None:
    for wind in (5.0, 12.0, 25.0):
        sea = OceanParameters(layers=(WaveLayer(wind_speed=wind, fetch=40e3),))
        found = Ocean(planned(sea, Wish(0.2, 1500.0))).statistics()
        assert sum(patch.share for patch in found.patches[1:]) <= 0.1
        assert found.warnings == ()
        assert found.resolved.m0 == pytest.approx(found.spectrum.m0, rel=0.01)


def autocorrelation(height: np.ndarray) -> np.ndarray:
    """Of a raster that does not repeat, at lags of up to 4/5 of its side; 1 in the centre, at [0, 0]."""
    size = len(height)
    height = height - np.mean(height)
    padded, ones = (np.zeros((2 * size, 2 * size)) for _ in range(2))
    padded[:size, :size], ones[:size, :size] = height, 1.0
    sums, counts = (np.fft.irfft2(np.abs(np.fft.rfft2(field)) ** 2) for field in (padded, ones))
    result = sums / np.maximum(counts, 1.0) / np.var(height)
    result[counts < 0.04 * size**2] = 0.0
    return result


def test_ten_domains_show_no_repetition() -> None:
    """A raster of ten domains of one patch: its peak is 1 a domain away, and none of the plan's over 0.1."""
    wind = WaveLayer(wind_speed=3.0, spreading="FLAT", swell=0.0)
    one = OceanParameters(resolution=256, domain_size=60.0, layers=(wind,))
    raster, samples = 600.0, 1200
    far = 30.0  # m, several waves: nearer, the sea is like itself as any sea is
    away = np.minimum(np.arange(2 * samples), 2 * samples - np.arange(2 * samples)) * raster / samples
    outside = np.hypot(away, away[:, np.newaxis]) > far

    single = autocorrelation(
        Ocean(one).surface(0.0, on=Area(raster, samples)).displacement[..., 2].astype(float)
    )
    assert np.max(single[outside]) > 0.99
    several = Ocean(planned(one, Wish(0.5, raster)))
    assert len(several.patches) > 1
    field = several.surface(0.0, on=Area(raster, samples)).displacement[..., 2].astype(float)
    assert np.max(autocorrelation(field)[outside]) < 0.1


def test_more_memory_makes_wider_patches() -> None:
    sea = OceanParameters()
    narrow, wide = (planned(sea, Wish(0.1, 2000.0, memory)) for memory in (8e7, 2e9))
    least = [
        min(patch.domain_size / patch.longest_wavelength for patch in found.patches[1:])
        for found in (narrow, wide)
    ]
    assert least[1] > 1.5 * least[0]


def test_a_sea_that_one_patch_can_be_gets_one() -> None:
    result = planned(OceanParameters(), Wish(8.0, 800.0))
    (patch,) = result.patches
    assert patch.band == (8.0, 1e6)
    assert not result.is_cascade


def test_what_cannot_be_reached_is_refused_with_what_would_do() -> None:
    sea = OceanParameters()
    with pytest.raises(ParameterError, match="needs more memory") as refused:
        planned(sea, Wish(0.1, 4000.0, 6.5e7))
    memory, finest, area = (
        float(re.search(text, str(refused.value))[1])  # type: ignore[index]
        for text in (r"memory of (\S+) MB", r"a finest wave of (\S+) m", r"an area of (\S+) m")
    )
    for wish in (
        Wish(0.1, 4000.0, memory * 1e6),
        Wish(finest, 4000.0, 6.5e7),
        Wish(0.1, area, 6.5e7),
    ):
        assert planned(sea, wish).patches
    with pytest.raises(ParameterError, match="is too much for 4 patches"):
        planned(sea, Wish(0.001, 90e3, 1e14))


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"finest": 0.0, "area": 100.0}, r"plan\.finest = 0\.0: must be from 0\.001 to 10000 m"),
        ({"finest": 1.0, "area": math.inf}, r"plan\.area = inf: must be from"),
        ({"finest": 200.0, "area": 100.0}, "must be below the area of 100 m"),
        ({"finest": 1.0, "area": 100.0, "memory": 10.0}, r"plan\.memory = 10\.0: must be from 1e\+06"),
    ],
)
def test_a_wish_must_be_numbers(values: dict[str, float], said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        Wish(**values)


def test_a_plan_replaces_earlier_patches_and_keeps_the_sea() -> None:
    sea = OceanParameters(seed=4, layers=(WaveLayer(wind_speed=9.0),), patches=(Patch(300.0, resolution=64),))
    result = planned(sea, Wish(0.5, 1000.0))
    assert dataclasses.replace(result, patches=()).layers == sea.layers
    assert result.seed == 4


@pytest.mark.parametrize(("low", "high"), [(10.0, 400.0), (390.0, 400.0), (400.0, 400.0)])
def test_sides_are_rather_large_and_in_no_small_ratio(low: float, high: float) -> None:
    """At least nine tenths of what is allowed; and p/q up to q = 8 is further from it than from most."""
    patches = (Patch(1000.0), Patch(330.0))
    side = odd_side(low, high, patches)
    assert side is not None
    assert max(low / SPARE, 0.89 * high) <= side <= high

    def oddness(length: float) -> float:
        ratios = [patch.domain_size / length for patch in patches]
        return min(abs(ratio * q - round(ratio * q)) for ratio in ratios for q in range(1, 9))

    among = [oddness(length) for length in np.linspace(max(low, 0.9 * high), high, 200)]
    assert oddness(side) >= 0.8 * max(among)
    assert odd_side(high, 0.99 * high, patches) is None
