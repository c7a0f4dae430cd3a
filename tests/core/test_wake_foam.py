# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam of hulls: the band astern, those of the bow, and what a sea shows of them."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from ocean_tweak.core import Foam, Mask, Ocean, PathSample, WakeLayer, WaveLayer
from ocean_tweak.core.foam.model import FAINTEST
from tests.core.test_wake_layers import BOAT, fields, over, sea


def ferry(**changes: object) -> WakeLayer:
    """30 m by 10 m, straight on at 6 m/s, in the middle at 0 s; its foam halves in 10 s."""
    path = (PathSample(0.0), PathSample(1.0, 6.0))
    values = {"path": path, "length": 30.0, "beam": 10.0, "draught": 2.0, "foam_half_life": 10.0}
    return WakeLayer(**(values | changes))


def foam_at(layer: WakeLayer, x: object, y: object, time: float = 0.0) -> object:
    x, y = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
    return layer.own_foam(sea(layer), x.ravel(), y.ravel(), time)


def test_astern_foam_is_as_wide_as_the_beam_and_fades_by_its_half_life() -> None:
    """Each place has the age since the stern passed it; its 15 m are 2.5 s."""
    ages = np.array([1.0, 11.0, 21.0, 31.0])
    found = foam_at(ferry(), -15.0 - 6.0 * ages, 0.0)
    np.testing.assert_allclose(found.age, ages, rtol=1e-5)
    np.testing.assert_allclose(found.foam[1:] / found.foam[:-1], 0.5, rtol=1e-5)
    assert found.foam[0] == pytest.approx(2.0**-0.1, rel=0.02)
    assert np.all(found.breaking == 0.0)
    across = np.linspace(-20.0, 20.0, 401)
    for age, growth in ((0.05, 1.0), (25.0, (1.0 + 15.0) ** 0.2)):  # by the fifth root of the distance
        there = foam_at(ferry(), -15.0 - 6.0 * age, across).foam
        edge = np.abs(across[there > 0.02 * there[200]]).max() if age > 1.0 else 5.0
        half = np.abs(across[there > 0.5 * there[200]]).max()  # of edges that are soft
        assert half == pytest.approx(0.83 * 5.0 * growth, rel=0.05)
        assert edge == pytest.approx(5.0 * growth, rel=0.05)
    assert np.all(foam_at(ferry(), [40.0, -800.0, -50.0], [0.0, 0.0, 40.0]).foam == 0.0)


def test_a_bow_throws_foam_to_both_sides_and_breaks_there() -> None:
    x, y = np.meshgrid(np.linspace(-14.0, 20.0, 69), np.linspace(-12.0, 12.0, 97))
    found = foam_at(ferry(), x, y)
    foam, breaking = (field.reshape(x.shape) for field in (found.foam, found.breaking))
    np.testing.assert_allclose(foam, foam[::-1], atol=1e-6)
    assert x[breaking > 0.2].min() > 6.0  # in the first quarter of the hull
    assert breaking.max() > 0.5
    beside = foam[:, np.argmin(np.abs(x[0] + 5.0))]
    assert np.abs(y[beside.argmax(), 0]) > 5.0  # beside the hull, and nothing under it
    assert beside[len(beside) // 2] < 1e-6


def test_the_band_of_a_bow_leaves_the_hull_where_it_is_as_wide_as_its_beam() -> None:
    """A third of the hull behind the bow; from there on, outwards alone, by twelve metres in a hundred."""
    across = np.linspace(2.0, 12.0, 1001)
    for behind, aside in ((5.0, 5.0 * 0.5**0.5 + 0.6), (10.0, 5.0 + 1.2), (25.0, 5.0 + 3.0)):
        assert across[foam_at(ferry(), 15.0 - behind, across).foam.argmax()] == pytest.approx(aside, abs=0.1)


def test_around_a_bend_the_band_has_no_gap_and_is_as_strong_as_the_hull_is_deep() -> None:
    """At the outer side of a right angle too; and a hull half out of the water leaves half as much."""
    path = (PathSample(-40.0, -240.0), PathSample(0.0), PathSample(40.0, 0.0, 240.0))
    bent = ferry(path=path, length=12.0)
    assert np.all(foam_at(bent, [0.5, 1.0, 1.5], [-0.5, -1.0, -1.5], 20.0).foam > 0.1)
    light = bent.changed(path=tuple(dataclasses.replace(each, immersion=0.5) for each in path))
    whole, half = (foam_at(layer, [-60.0, 0.0], [0.0, 40.0], 20.0).foam for layer in (bent, light))
    np.testing.assert_allclose(half, 0.5 * whole, rtol=1e-5)
    assert whole.min() > 0.1


def test_foam_follows_the_path_and_slow_hulls_make_none() -> None:
    layer = BOAT.changed(foam_half_life=20.0)
    for time in np.arange(2.0, 14.0, 1.0):
        (x, y), _ = layer.track.place(time)
        assert foam_at(layer, x, y, 17.0).foam[0] > 0.3
        assert foam_at(layer, x + 15.0, y - 15.0, 17.0).foam[0] == 0.0
    slow = ferry(path=(PathSample(0.0), PathSample(1.0, 0.5)))
    assert np.all(foam_at(slow, np.linspace(-50.0, 20.0, 71), 0.0).foam == 0.0)
    assert np.all(foam_at(ferry(path=(PathSample(0.0),)), np.linspace(-50.0, 20.0, 71), 0.0).foam == 0.0)
    assert foam_at(ferry(foam=0.0), 0.0, 0.0) is None
    half = foam_at(ferry(foam=0.5), -30.0, 0.0).foam
    np.testing.assert_allclose(half, 0.5 * foam_at(ferry(), -30.0, 0.0).foam)


def test_a_sea_has_the_foam_of_hulls_over_that_of_its_waves() -> None:
    """In a calm too, and under masks; where both are, of that which is more."""
    names = ("foam", "breaking", "foam_age")
    area = over(120.0, 60, -40.0)
    calm = fields(ferry(), 0.0, area, *names)
    x, y = (places.ravel() for places in area.rest_positions())
    own = foam_at(ferry(), x, y)
    shown = np.where(own.foam >= FAINTEST, own.foam, 0.0)
    np.testing.assert_allclose(calm.foam.ravel(), shown, atol=1e-6)
    assert calm.foam_age[calm.foam > 0.0].max() > 5.0
    wind = WaveLayer(wind_speed=15.0)
    windy, waves = (
        Ocean(sea(layers=layers, foam=Foam(half_life=0.0))).surface(0.0, names, on=area)
        for layers in ((wind, ferry(amplitude_scale=0.0)), (wind, ferry(amplitude_scale=0.0, foam=0.0)))
    )
    np.testing.assert_allclose(windy.foam, np.maximum(waves.foam, calm.foam), atol=1e-5)
    everywhere = Mask(x=0.0, y=0.0, inner_radius=0.0, outer_radius=1e-3, inverted=True)
    assert fields(ferry(mask=everywhere), 0.0, over(60.0, 30, -45.0), "foam").foam.max() == 0.0
