# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam looks at its past only every few moments: what that changes, and that it shows nowhere."""

from __future__ import annotations

import dataclasses
import math
from fractions import Fraction

import numpy as np
import pytest

from ocean_tweak.core import Foam, Ocean, OceanParameters, WaveLayer
from ocean_tweak.core.foam.looks import Looks, stride_of
from ocean_tweak.core.foam.model import FoamHistory

TIMES = (30.0, 36.0)


def sea(wind: float, resolution: int, size: float, **changes: object) -> Ocean:
    layer = WaveLayer(wind_speed=wind, fetch=200e3)
    return Ocean(OceanParameters(resolution=resolution, domain_size=size, layers=(layer,), seed=4, **changes))


def looking_at_each_moment(ocean: Ocean) -> Ocean:
    """The same sea, with foam for which nothing is interpolated."""
    exact = Ocean(ocean.parameters)
    exact.__dict__["foam_model"] = dataclasses.replace(ocean.foam_model, frequency=math.inf)
    assert exact.foam_model.stride == 1
    return exact


def foam(ocean: Ocean, name: str = "foam") -> np.ndarray:
    return np.stack([ocean.surface(time, {name})[name] for time in TIMES])


@pytest.mark.parametrize(
    ("wind", "resolution", "size", "stride"),
    [
        (10.0, 192, 300.0, 3),
        (15.0, 256, 200.0, 3),
        (24.0, 192, 300.0, 4),
        (25.0, 192, 750.0, 5),
        (25.0, 256, 500.0, 4),
    ],
)
def test_foam_is_nearly_that_of_all_moments(wind: float, resolution: int, size: float, stride: int) -> None:
    """The same in outline and amount: a correlation of 0.98, and a tenth of the mean."""
    ocean = sea(wind, resolution, size)
    assert ocean.foam_model.stride == stride
    found, exact = foam(ocean), foam(looking_at_each_moment(ocean))
    assert np.corrcoef(found.ravel(), exact.ravel())[0, 1] > 0.98
    assert np.mean(found) == pytest.approx(np.mean(exact), rel=0.1)
    assert np.sqrt(np.mean((found - exact) ** 2)) < 0.2 * np.std(exact)


def test_no_bars_lie_where_the_sea_was_looked_at() -> None:
    """Of old foam as much is born between looks as at them: its age tells the moment."""
    ocean = sea(22.0, 256, 400.0, foam=Foam(drift=0.0))
    stride, step = ocean.foam_model.stride, float(ocean.foam_model.step)
    ages = foam(ocean, "foam_age")
    left = foam(ocean)
    of_moments = np.zeros(stride)
    for time, age, weight in zip(TIMES, ages, left, strict=True):
        old = age > 2.0
        moments = np.rint((time - age[old]) / step).astype(int) % stride
        of_moments += np.bincount(moments, weight[old], stride)
    assert stride == 3
    np.testing.assert_allclose(of_moments / np.mean(of_moments), 1.0, atol=0.12)


def test_waves_within_the_band_are_interpolated() -> None:
    """Places with waves of one frequency each, seen every third moment."""
    stride = 3
    frequency = np.linspace(0.1, 2.1, 9)[:, np.newaxis] / stride  # rad a moment
    phase = np.linspace(0.0, 2.0 * math.pi, 40)
    looks = Looks(lambda moment: np.cos(frequency * moment + phase).astype(np.float32), stride, -10.0)
    for moment in range(-4, 20):
        seen = looks.at(moment)
        assert seen.places.size == frequency.size * phase.size
        wave = seen.compression.reshape(len(frequency), -1)
        np.testing.assert_allclose(wave, np.cos(frequency * moment + phase), atol=0.13)
        np.testing.assert_allclose(wave[:6], np.cos(frequency * moment + phase)[:6], atol=0.05)


@pytest.mark.parametrize("stride", [1, 2, 5])
def test_no_more_looks_are_kept_than_are_used(stride: int) -> None:
    looks = Looks(lambda _: np.zeros(1000, np.float32), stride, 0.5)
    for moment in range(200):
        looks.at(moment)
        assert looks.nbytes <= (0 if stride == 1 else 7 * 4000)


def test_looks_are_as_far_apart_as_frequencies_allow() -> None:
    assert stride_of(math.inf, 0.125) == 1
    assert stride_of(0.0, 0.125) == 8
    strides = [stride_of(frequency, 0.125) for frequency in np.linspace(1.0, 40.0, 100)]
    assert sorted(strides, reverse=True) == strides
    # never half a turn of the highest frequency apart, from where two waves look alike
    assert all(
        stride * frequency * 0.125 < math.pi
        for stride, frequency in zip(strides, np.linspace(1.0, 40.0, 100), strict=True)
        if stride > 1
    )


@pytest.mark.parametrize(("size", "most"), [(400.0, 48), (2000.0, 32)])
def test_how_often_a_frame_alone_looks_back(size: float, most: int) -> None:
    """512² samples; as often as foam was born, it would be 121 times."""
    model = sea(15.0, 512, size).foam_model
    looked: list[Fraction] = []

    def compression_at(time: Fraction) -> np.ndarray:
        looked.append(time)
        return np.zeros((16, 16), np.float32)

    FoamHistory(model, compression_at, 16).whitecaps(50.03)
    assert model.memory == 121
    assert len(looked) <= most


@pytest.mark.parametrize("loop", [None, Fraction(4)])
def test_the_history_may_begin_anywhere(loop: Fraction | None) -> None:
    """What was looked at before changes nothing, nor from where births are counted."""
    ocean = sea(22.0, 64, 200.0, foam=Foam(half_life=0.4), loop_duration=loop)
    assert ocean.foam_model.stride > 1
    history = ocean.new_foam_history()
    for time in np.arange(1.03, 12.0, 0.61):  # long enough for births to be counted anew
        alone = ocean.new_foam_history().whitecaps(float(time))
        for one, other in zip(history.whitecaps(float(time)), alone, strict=True):
            np.testing.assert_array_equal(one, other)
