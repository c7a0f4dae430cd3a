# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks of a noise that moves: gusts."""

from __future__ import annotations

import dataclasses
import math
from fractions import Fraction

import numpy as np
import pytest

from ocean_tweak.core import Mask, Ocean, OceanParameters, ParameterError, Places, WaveLayer
from ocean_tweak.core.masks import weights as module
from ocean_tweak.core.masks.noise import SeaTime, normal_distribution
from ocean_tweak.core.masks.weights import Weights, weights, weights_on_grid

SIZE = 1200.0
GUSTS = Mask(
    source="NOISE", noise_size=60.0, noise_coverage=0.3, noise_contrast=0.9, noise_speed=12.0,
    noise_direction=0.7, noise_evolution=20.0, noise_seed=3,
)  # fmt: skip
RIGID = dataclasses.replace(GUSTS, noise_evolution=0.0)
GENERATOR = np.random.default_rng(8)
X, Y = GENERATOR.uniform(0.0, SIZE, (2, 300))


def over_domain(mask: Mask, time: float = 0.0, samples: int = 256) -> Weights:
    return weights_on_grid((mask,), SIZE, samples, np.float64, SeaTime(time))


def at(mask: Mask, x: np.ndarray, y: np.ndarray, time: float | Fraction, loop: Fraction | None = None):
    return weights((mask,), SIZE, x, y, SeaTime(time, loop))


@pytest.mark.parametrize("coverage", [0.1, 0.5, 0.85])
@pytest.mark.parametrize("time", [0.0, 1000.0])
def test_the_mean_weight_is_the_coverage(coverage: float, time: float) -> None:
    mask = dataclasses.replace(GUSTS, noise_coverage=coverage)
    found = np.mean(
        [over_domain(dataclasses.replace(mask, noise_seed=seed), time).value for seed in range(4)]
    )
    assert found == pytest.approx(coverage, abs=0.01)
    assert over_domain(mask, time).value.min() >= 0.0


@pytest.mark.parametrize("contrast", [0.0, 0.4, 0.9])
def test_contrast_is_how_far_the_weight_goes(contrast: float) -> None:
    """Half covered, its variance is that of the chance of two numbers of correlation c² to be positive
    together, 1/4 + asin(c²)/2π (Sheppard 1899), less 1/4."""
    mask = dataclasses.replace(GUSTS, noise_coverage=0.5, noise_contrast=contrast)
    variance = np.mean([over_domain(dataclasses.replace(mask, noise_seed=n)).value.var() for n in range(4)])
    assert variance == pytest.approx(math.asin(contrast**2) / (2.0 * math.pi), rel=0.03, abs=1e-12)


@pytest.mark.parametrize("size", [40.0, 100.0])
def test_gusts_are_as_far_apart_as_told(size: float) -> None:
    """The mean square slope of k² exp(−k²/k₀²) along an axis is k₀², its variance being 1."""
    mask = dataclasses.replace(GUSTS, noise_size=size, noise_contrast=0.02, noise_coverage=0.5)
    found = over_domain(mask)
    wave_number = math.sqrt(float(np.mean(found.by_x**2)) / found.value.var())
    assert 2.0 * math.pi / wave_number == pytest.approx(size, rel=0.06)


@pytest.mark.parametrize("time", [0.0, 7.3, 5000.0])
def test_derivatives_are_those_of_the_weight(time: float) -> None:
    found, step = at(GUSTS, X, Y, time), 1e-4
    for by, (dx, dy, dt) in zip(found[1:], np.eye(3) * step, strict=True):
        ahead = at(GUSTS, X + dx, Y + dy, time + dt).value
        behind = at(GUSTS, X - dx, Y - dy, time - dt).value
        np.testing.assert_allclose(by, (ahead - behind) / (2.0 * step), atol=2e-4 * np.abs(by).max() + 1e-5)


def test_it_moves_as_told() -> None:
    """Between its samples it is read by a spline, which is not quite the same where it has moved."""
    along = 12.0 * 33.0
    moved = at(RIGID, X + along * math.cos(0.7), Y + along * math.sin(0.7), 33.0).value
    np.testing.assert_allclose(moved, at(RIGID, X, Y, 0.0).value, atol=0.02)
    assert np.abs(moved - at(RIGID, X, Y, 33.0).value).max() > 0.5


def test_it_becomes_another_in_its_time() -> None:
    """It resembles itself by exp(−(t/T)²)."""
    still = dataclasses.replace(GUSTS, noise_speed=0.0, noise_contrast=0.02, noise_coverage=0.5)
    for time in (10.0, 20.0, 60.0):
        alike = [
            np.corrcoef(*(over_domain(mask, when).value.ravel() for when in (50.0, 50.0 + time)))[0, 1]
            for mask in (dataclasses.replace(still, noise_seed=seed) for seed in range(3))
        ]
        assert np.mean(alike) == pytest.approx(math.exp(-((time / 20.0) ** 2)), abs=0.04)


def test_it_has_no_seam() -> None:
    here, there = (at(GUSTS, X + shift * SIZE, Y - shift * SIZE, 4.0) for shift in (0, 2))
    np.testing.assert_allclose(here, there, atol=1e-8)


def test_a_grid_has_the_weights_of_its_places() -> None:
    along = SIZE / 160 * np.arange(160)
    x, y = (part.ravel() for part in np.meshgrid(along, along))
    found = weights_on_grid((GUSTS,), SIZE, 160, np.float64, SeaTime(3.0))
    np.testing.assert_allclose([part.ravel() for part in found], at(GUSTS, x, y, 3.0), atol=1e-11)


def test_it_loops_with_the_sea() -> None:
    loop = Fraction(25)
    begin, middle, end = (at(GUSTS, X, Y, time, loop).value for time in (2, Fraction(29, 2), 27))
    np.testing.assert_array_equal(begin, end)
    assert np.abs(begin - middle).max() > 0.5
    step = Fraction(1, 10_000)
    ahead, behind = (at(GUSTS, X, Y, 2 + sign * step, loop).value for sign in (1, -1))
    rate = at(GUSTS, X, Y, 2, loop).by_t
    np.testing.assert_allclose(rate, (ahead - behind) / (2 * float(step)), atol=2e-4 * np.abs(rate).max())


def test_inverted_and_weaker_with_another() -> None:
    """w v and 1 − s(1 − w), with their change in time."""
    still = Mask(inner_radius=1.0, outer_radius=3.0 * SIZE)
    own, other = at(GUSTS, X, Y, 2.0), at(still, X, Y, 2.0)
    less = at(dataclasses.replace(GUSTS, inverted=True, strength=0.5), X, Y, 2.0)
    np.testing.assert_allclose(less.value, 1.0 - 0.5 * own.value, atol=1e-12)
    np.testing.assert_allclose(less.by_t, -0.5 * own.by_t, atol=1e-12)
    both = weights((still, GUSTS), SIZE, X, Y, SeaTime(2.0))
    np.testing.assert_allclose(both.by_t, own.by_t * other.value, atol=1e-12)


def test_the_normal_distribution() -> None:
    """Against erfc, as closely as Abramowitz & Stegun's eq. 26.2.17 says."""
    x = np.linspace(-6.0, 6.0, 2001)
    value, density = normal_distribution(x)
    expected = [0.5 * math.erfc(-each / math.sqrt(2.0)) for each in x]
    np.testing.assert_allclose(value, expected, atol=7.5e-8)
    np.testing.assert_allclose(density, np.exp(-x * x / 2.0) / math.sqrt(2.0 * math.pi), rtol=1e-12)


def test_masks_that_stand_still_are_made_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Though gusts over the same waves are others at each time."""
    still = Mask(inner_radius=1.0, outer_radius=2.9 * SIZE)
    made: list[Mask] = []
    by_distance = module.by_distance

    def counted(mask: Mask, *where: object) -> object:
        made.append(mask)
        return by_distance(mask, *where)

    monkeypatch.setattr(module, "by_distance", counted)
    for time in (1.0, 2.0):
        found = weights_on_grid((still, GUSTS), SIZE, 96, np.float64, SeaTime(time))
        alone = [weights_on_grid((mask,), SIZE, 96, np.float64, SeaTime(time)) for mask in (still, GUSTS)]
        np.testing.assert_allclose(found.value, alone[0].value * alone[1].value, atol=1e-14)
        np.testing.assert_allclose(found.by_t, alone[0].value * alone[1].by_t, atol=1e-12)
    assert made == [still]


@pytest.mark.parametrize("owner", ["layer", "sea"])
@pytest.mark.parametrize("on", ["tile", "places"])
def test_velocity_is_the_displacements(owner: str, on: str) -> None:
    layer = WaveLayer(wind_speed=10.0, fetch=20e3, mask=GUSTS if owner == "layer" else None)
    parameters = OceanParameters(
        resolution=64, domain_size=SIZE, layers=(layer,), mask=GUSTS if owner == "sea" else None
    )
    sea, step = Ocean(parameters, "double"), 1e-4
    places = {} if on == "tile" else {"on": Places(X, Y)}
    found = sea.surface(6.0, ("velocity",), **places).velocity
    ahead, behind = (sea.surface(6.0 + s * step, **places).displacement for s in (1, -1))
    np.testing.assert_allclose(found, (ahead - behind) / (2.0 * step), atol=2e-4 * np.abs(found).max())
    without = Ocean(parameters.replace(mask=None, layers=(dataclasses.replace(layer, mask=None),)), "double")
    under = at(GUSTS, X, Y, 6.0).value[:, np.newaxis] if places else None
    if places:  # and its own change is a part of it
        plain = under * without.surface(6.0, ("velocity",), **places).velocity
        assert np.abs(found - plain).max() > 0.05 * np.abs(found).max()


@pytest.mark.parametrize("size", [29.0, 1201.0])
def test_gusts_that_do_not_fit_are_told(size: float) -> None:
    with pytest.raises(ParameterError, match=r"mask\.noise_size.*must be from 30 to 1200 m"):
        OceanParameters(domain_size=SIZE, mask=dataclasses.replace(GUSTS, noise_size=size))
    assert not {name for name in OceanParameters(mask=Mask()).to_dict()["mask"] if name.startswith("noise")}
