# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves from a wind field: particles against the formula, and waves of several against the paper."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from ocean_tweak.core import Ocean, Raster, WindFieldLayer, WindKey
from ocean_tweak.core.waves.wind_field.emission import Emission, layer_origins
from ocean_tweak.core.waves.wind_field.life import Particles, particles_of
from ocean_tweak.core.waves.wind_field.shape import RadiusClasses, bump, radius_classes
from tests.core.wind_seas import LENGTH, LONE, OUTPUTS, PERIOD, SPEED, G, particles, sea
from tests.layers import layers_of

Array = NDArray[np.float64]


# shape and a single particle


def test_the_bump_is_the_papers_without_its_step() -> None:
    r = 3.0
    places = np.linspace(-4.0, 4.0, 161)
    values = bump(places, np.zeros(161), r)
    inside = np.abs(places) < r
    np.testing.assert_allclose(
        values.position[:, 2], np.where(inside, 0.5 * (np.cos(np.pi * np.abs(places) / r) + 1.0), 0.0)
    )
    np.testing.assert_allclose(
        values.position[:, 0], -np.sin(np.pi * places / r) * values.position[:, 2], atol=1e-15
    )
    assert np.all(values.position[:, 0][(places > 0) & inside] <= 0.0), "water is drawn to the crest"
    rim = bump(np.array([r - 1e-6]), np.zeros(1), r)
    assert abs(rim.position[0, 2]) < 1e-11
    assert abs(rim.by_x[0, 2]) < 1e-5


def test_slopes_of_the_bump_are_finite_differences() -> None:
    generator = np.random.default_rng(1)
    x, y = generator.uniform(-3.0, 3.0, (2, 200))
    values, step = bump(x, y, 3.0), 1e-6
    by_x = (bump(x + step, y, 3.0).position - bump(x - step, y, 3.0).position) / (2 * step)
    by_y = (bump(x, y + step, 3.0).position - bump(x, y - step, 3.0).position) / (2 * step)
    np.testing.assert_allclose(values.by_x, by_x, atol=1e-8)
    np.testing.assert_allclose(values.by_y, by_y, atol=1e-8)


@pytest.mark.parametrize("age", [0.01, 0.2, 0.5, 0.77, 0.99])
def test_a_single_particle_is_the_formula_at_every_age(age: float) -> None:
    """Born at T at the middle of the patch, towards 0.7 rad: height, slope and velocity from the paper."""
    life, angle, s = 0.9, 0.7, 0.3
    parameters = sea(particles=1, life=life, wind_direction=angle, steepness=s, split_angle=0.0, **LONE)
    time = PERIOD * (1.0 + age * life)
    fields = Ocean(parameters.replace(choppiness=0.8), "double").surface(time, OUTPUTS)

    def expected(t: float, aside: float = 0.0) -> tuple[Array, Array, Array]:
        """Heights and both displacements; the patch's mean height is taken away as a number."""
        grid = np.arange(256) * (160.0 / 256)
        travelled = SPEED * (t - PERIOD)
        dx = grid[np.newaxis, :] + aside - (80.0 + travelled * math.cos(angle))
        dy = grid[:, np.newaxis] - (80.0 + travelled * math.sin(angle))
        d, r = np.hypot(dx, dy), 0.5 * LENGTH
        a = s * LENGTH / (2 * math.pi) * math.sin(math.pi * (t - PERIOD) / (life * PERIOD))
        w = np.where(d < r, a * 0.5 * (np.cos(np.pi * d / r) + 1.0), 0.0)
        return w - w.mean(), -0.8 * np.sin(np.pi * dx / r) * w, -0.8 * np.sin(np.pi * dy / r) * w

    height, along_x, along_y = expected(time)
    a = s * LENGTH / (2 * math.pi) * math.sin(math.pi * age)
    np.testing.assert_allclose(fields.displacement[..., 2], height, atol=0.006 * a)
    np.testing.assert_allclose(fields.displacement[..., 0], along_x, atol=0.006 * a)
    np.testing.assert_allclose(fields.displacement[..., 1], along_y, atol=0.006 * a)
    slope = (expected(time, 1e-5)[0] - expected(time, -1e-5)[0]) / 2e-5
    np.testing.assert_allclose(
        fields.slope[..., 0], slope, atol=0.06 * np.pi * a / LENGTH
    )  # at the rim's kink
    before, after = expected(time - 1e-4), expected(time + 1e-4)
    whole = s * LENGTH / (2 * math.pi)
    for component, (early, late) in enumerate(zip(before, after, strict=True)):
        moving = (late - early) / 2e-4
        index = (component + 2) % 3
        largest = max(np.abs(moving).max(), 0.05 * whole * SPEED / LENGTH)
        np.testing.assert_allclose(fields.velocity[..., index], moving, atol=0.04 * largest)


def test_no_wave_before_the_first_period_and_then_one_each() -> None:
    for waves in range(5):
        now = particles(sea(particles=1, life=20.0, split_angle=0.0, **LONE), PERIOD * (waves + 0.5))
        assert len(now.x) == waves
        travelled = np.sort(now.x - 80.0)
        np.testing.assert_allclose(travelled, SPEED * PERIOD * (np.arange(waves) + 0.5), rtol=1e-12)
    assert math.isclose(LENGTH, SPEED * PERIOD)
    assert len(particles(sea(**LONE), -1.0).x) == 0
    still = Ocean(sea(**LONE)).surface(0.5 * PERIOD, OUTPUTS)
    assert not np.any(still.displacement)
    assert np.all(still.jacobian == 1.0)


@pytest.mark.parametrize("speed", [6.0, 12.0])
def test_speed_length_and_period_follow_the_wind(speed: float) -> None:
    parameters = sea(particles=1, split_angle=0.0, **{**LONE, "wind_speed": speed})
    now, later = (particles(parameters, time) for time in (20.0, 20.5))
    np.testing.assert_allclose(now.velocity_x, speed / math.sqrt(2.0 * math.pi))
    gaps = np.diff(np.sort(now.x))
    np.testing.assert_allclose(gaps, speed**2 / G, rtol=1e-9)
    np.testing.assert_allclose(np.sort(later.x)[-1], np.sort(now.x)[-1] + 0.5 * now.velocity_x[0])
    radii = radius_classes(layers_of(parameters, "WIND_FIELD"), G).radii
    np.testing.assert_allclose(radii, [0.5 * speed**2 / G])


def test_many_radii_are_a_few_of_equal_ratio() -> None:
    """Those of winds from 10 to 10·√1.9 m/s differ by 1.9: two, a quarter from either end by ratio."""
    speeds = 10.0 * np.sqrt(np.linspace(1.0, 1.9, 2000)).astype(np.float32)
    key = WindKey(0.0, Raster(np.stack([speeds, np.zeros_like(speeds)], axis=-1)[np.newaxis]))
    radii = radius_classes((WindFieldLayer(keys=(key,)),), G).radii
    smallest = 0.5 * 100.0 * np.quantile(np.linspace(1.0, 1.9, 2000), 0.05) / G
    ratio = 0.5 * 190.0 / G / smallest
    assert radii == pytest.approx([smallest * ratio**0.25, smallest * ratio**0.75], rel=1e-5)


@pytest.mark.parametrize("jitter", [0.0, 0.3, 1.0])
def test_origins_lie_around_the_middles_of_their_cells(jitter: float) -> None:
    """Anywhere within their share of a cell of 100 m by 200 m."""
    layer = WindFieldLayer(columns=8, rows=4, origins=16, jitter=jitter)
    origins = layer_origins(layer, 0, 800.0)
    for places, cells in ((origins.x, 100.0), (origins.y, 200.0)):
        off = np.mod(places, cells) / cells - 0.5
        assert np.ptp(off) == pytest.approx(jitter, rel=0.02, abs=1e-12)
        assert abs(off.mean()) <= 0.1 * jitter


# waves of several particles


def one_wave(age: float, **layer: Any) -> tuple[Particles, RadiusClasses]:
    """The particles of one wave of an age in wavelengths travelled; it lives for 12."""
    wave = {"life": 12.0, "particles": 5, "split_angle": 0.1, "steepness": 0.2}
    field = WindFieldLayer(**{**LONE, **wave, **layer})
    origins = layer_origins(field, 0, 4000.0)
    births = Emission(field, origins, 4000.0, G).births(PERIOD * (1.0 + age))
    newest_but = np.argmax(births.age)
    births = births._replace(
        x=births.x[[newest_but]], y=births.y[[newest_but]],
        age=births.age[[newest_but]], wind=births.wind[[newest_but]],
    )  # fmt: skip
    classes = radius_classes((field,), G)
    return particles_of(births, field, classes, G, 0.0), classes


def test_splitting_keeps_the_sum_of_amplitudes_and_the_fan() -> None:
    # neighbours are 0.1·D apart: half a radius, λ/4, at D = 2.5 λ and, a third of it, at 7.5 λ
    for age, parts in ((2.4, 1), (2.6, 3), (7.4, 3), (7.6, 9)):
        now, _ = one_wave(age)
        assert len(now.x) == 5 * parts, age
        full = 0.2 * LENGTH / (2 * math.pi) * math.sin(math.pi * age / 12.0)
        assert now.amplitude.sum() == pytest.approx(5 * full)
        angles = np.sort(np.arctan2(now.velocity_y, now.velocity_x))
        np.testing.assert_allclose(np.diff(angles), 0.1 / parts, rtol=1e-9)
        np.testing.assert_allclose(angles.mean(), 0.0, atol=1e-12)
        np.testing.assert_allclose(np.hypot(now.x - 2000.0, now.y - 2000.0), age * LENGTH)


@pytest.mark.parametrize("direction", [0.0, 0.8, -2.5])
def test_a_parallel_crest_lies_across_its_way(direction: float) -> None:
    """A straight line of particles, all as far along the wind."""
    now, _ = one_wave(2.0, crest="PARALLEL", wind_direction=direction)
    dx, dy = now.x - 2000.0, now.y - 2000.0
    np.testing.assert_allclose(dx * math.cos(direction) + dy * math.sin(direction), 2.0 * LENGTH)
    assert np.ptp(dy * math.cos(direction) - dx * math.sin(direction)) > 0.5 * LENGTH


def crest(now: Particles, classes: RadiusClasses, age: float, within: float) -> Array:
    """Heights of a wave along its front, between directions, from the sum of the formula."""
    angles = np.linspace(-within, within, 801)
    x, y = 2000.0 + age * LENGTH * np.cos(angles), 2000.0 + age * LENGTH * np.sin(angles)
    total = np.zeros(801)
    for px, py, amplitude in zip(now.x, now.y, now.amplitude, strict=True):
        d = np.hypot(x - px, y - py) / classes.radii[0]
        total += amplitude * np.where(d < 1.0, 0.5 * (np.cos(np.pi * d) + 1.0), 0.0)
    return total


@pytest.mark.parametrize("age", [1.0, 2.45, 2.55, 5.0, 7.45, 7.55, 11.9])
def test_a_front_holds_together_to_its_end(age: float) -> None:
    heights = crest(*one_wave(age), age, within=0.15)
    assert heights.min() > 0.9 * heights.max() if age > 2.0 else heights.min() > 0.5 * heights.max()


def test_a_front_breaks_up_without_splitting() -> None:
    heights = crest(*one_wave(11.9, splitting=False), 11.9, within=0.15)
    assert heights.min() < 0.2 * heights.max()


def test_height_jumps_little_when_a_front_splits() -> None:
    for instant in (2.5, 7.5):
        before, after = (crest(*one_wave(instant + step), instant, within=0.3) for step in (-1e-7, 1e-7))
        jump = np.abs(after - before).max()
        assert jump <= 0.03 * before.max()
        assert jump > 1e-4 * before.max(), "this is where it splits"


def test_a_parallel_front_stays_parallel_half_a_radius_apart() -> None:
    now, classes = one_wave(9.0, crest="PARALLEL", wind_direction=0.5 * math.pi)
    assert len(now.x) == 5
    np.testing.assert_allclose(np.diff(np.sort(now.x)), 0.5 * classes.radii[0])
    np.testing.assert_allclose(now.y, 2000.0 + 9.0 * LENGTH)
    np.testing.assert_allclose(now.velocity_x, 0.0, atol=1e-12)


def test_heights_by_steepness_or_by_speed() -> None:
    for choice, expected in (("STEEPNESS", 0.2 * LENGTH / (2 * math.pi)), ("WIND_SPEED", 0.05 * 10.0)):
        now, _ = one_wave(6.0, height=choice, amplitude_scale=3.0, particles=1, split_angle=0.0)
        assert now.amplitude[0] == pytest.approx(3.0 * expected)
