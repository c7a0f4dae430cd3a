# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves from a wind field: particles against the formula, waves against the paper, many against stamping."""

from __future__ import annotations

import math
import tracemalloc
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from ocean_tweak.core import (
    Foam,
    Ocean,
    OceanParameters,
    ParameterError,
    Raster,
    WaveLayer,
    WindFieldLayer,
    WindKey,
)
from ocean_tweak.core.grid import WaveVectorGrid
from ocean_tweak.core.memory import memory_need
from ocean_tweak.core.wave_particles.bounds import most_particles
from ocean_tweak.core.wave_particles.convolution import deposit
from ocean_tweak.core.wave_particles.emission import Emission
from ocean_tweak.core.wave_particles.life import Particles, particles_of
from ocean_tweak.core.wave_particles.origins import layer_origins
from ocean_tweak.core.wave_particles.shape import RadiusClasses, bump, radius_classes
from ocean_tweak.core.wave_particles.stamping import stamp
from ocean_tweak.core.wave_particles.wind import bilinear, sampled_wind
from ocean_tweak.core.wave_particles.wind_waves import WindWaves

Array = NDArray[np.float64]

G = 9.81
FLAT = (WaveLayer(muted=True),)
OUTPUTS = {"displacement", "slope", "jacobian", "velocity"}

#: one origin in the middle of the patch, in step, from time 0 on
LONE = {
    "rows": 1, "columns": 1, "jitter": 0.0, "phase_jitter": 0.0, "start_time": 0.0, "wind_speed": 10.0,
}  # fmt: skip
PERIOD = math.sqrt(2.0 * math.pi) * 10.0 / G
LENGTH = 100.0 / G
SPEED = 10.0 / math.sqrt(2.0 * math.pi)


def sea(resolution: int = 256, size: float = 160.0, **layer: Any) -> OceanParameters:
    return OceanParameters(
        resolution=resolution, domain_size=size, layers=FLAT, wind_fields=(WindFieldLayer(**layer),)
    )


def particles(parameters: OceanParameters, time: float) -> Particles:
    return WindWaves(parameters).particles(time)


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
    radii = radius_classes(parameters.wind_fields, G).radii
    np.testing.assert_allclose(radii, [0.5 * speed**2 / G])


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
    now, classes = one_wave(9.0, front="PARALLEL", wind_direction=0.5 * math.pi)
    assert len(now.x) == 5
    np.testing.assert_allclose(np.diff(np.sort(now.x)), 0.5 * classes.radii[0])
    np.testing.assert_allclose(now.y, 2000.0 + 9.0 * LENGTH)
    np.testing.assert_allclose(now.velocity_x, 0.0, atol=1e-12)


def test_heights_by_steepness_or_by_speed() -> None:
    for choice, expected in (("STEEPNESS", 0.2 * LENGTH / (2 * math.pi)), ("WIND_SPEED", 0.05 * 10.0)):
        now, _ = one_wave(6.0, height=choice, gain=3.0, particles=1, split_angle=0.0)
        assert now.amplitude[0] == pytest.approx(3.0 * expected)


# winds that differ from place to place and from time to time


def keyed(*winds: tuple[float, Any]) -> tuple[WindKey, ...]:
    return tuple(WindKey(time, Raster(np.array(vectors, float))) for time, vectors in winds)


def test_rasters_are_bilinear_and_periodic() -> None:
    raster = Raster(np.array([[[0.0, 0.0], [4.0, 8.0]], [[2.0, 0.0], [6.0, 8.0]]]))
    x = np.array([0.0, 50.0, 25.0, 75.0, 25.0, 125.0])
    y = np.array([0.0, 0.0, 0.0, 0.0, 25.0, 25.0])
    values = bilinear(raster, x, y, 100.0)
    np.testing.assert_allclose(values[:, 0], [0.0, 4.0, 2.0, 2.0, 3.0, 3.0])
    np.testing.assert_allclose(values[:, 1], [0.0, 8.0, 4.0, 4.0, 4.0, 4.0])
    made = sampled_wind(lambda x, y: (x, 3.0 * y), 100.0, 4)
    np.testing.assert_allclose(made.values[2, 3], [75.0, 150.0])


def test_a_constant_wind_in_keys_is_the_constant_wind() -> None:
    """The table of phases, inverted, against the closed form."""
    wind = 10.0 * np.array([math.cos(0.3), math.sin(0.3)])
    options = {"rows": 3, "columns": 3, "start_time": -7.0}
    plain = particles(sea(wind_direction=0.3, wind_speed=10.0, **options), 31.7)
    for keys in (keyed((0.0, [[wind]])), keyed(*((t, [[wind]]) for t in (-20.0, -3.3, 4.0, 90.0)))):
        now = particles(sea(keys=keys, **options), 31.7)
        assert len(now.x) == len(plain.x)
        for one, other in zip(plain, now, strict=True):
            np.testing.assert_allclose(one, other, rtol=2e-5, atol=1e-4)


def test_births_of_a_growing_wind_follow_the_integral() -> None:
    """Wind 5 + t/2 from 0 to 20 s: ∫g/(√(2π)V)dt = 2g/√(2π)·ln(1 + t/10)."""
    field = WindFieldLayer(
        **{**LONE, "keys": keyed((0.0, [[[5.0, 0.0]]]), (20.0, [[[15.0, 0.0]]])), "life": 50}
    )
    births = Emission(field, layer_origins(field, 0, 100.0), 100.0, G).births(19.0)
    born = 19.0 - births.age
    phase = 2.0 * G / math.sqrt(2.0 * math.pi) * np.log1p(born / 10.0)
    np.testing.assert_allclose(phase, np.arange(1, len(born) + 1), atol=3e-4)
    assert len(born) == math.floor(2.0 * G / math.sqrt(2.0 * math.pi) * math.log1p(1.9))
    np.testing.assert_allclose(births.wind[:, 0], 5.0 + 0.5 * born, rtol=1e-9)


def test_calm_and_what_the_grid_cannot_hold_emit_nothing() -> None:
    assert len(particles(sea(wind_speed=1.9), 50.0).x) == 0
    assert len(particles(sea(wind_speed=0.0), 50.0).x) == 0
    fine, coarse = (sea(resolution=n, wind_speed=4.0) for n in (512, 256))  # 1.63 m: 5.2 and 2.6 texels
    assert len(particles(fine, 50.0).x) > 0
    assert len(particles(coarse, 50.0).x) == 0
    lull = keyed(
        (0.0, [[[10.0, 0.0]]]), (1.0, [[[0.0, 0.0]]]), (30.0, [[[0.0, 0.0]]]), (31.0, [[[9.0, 0.0]]])
    )
    field = WindFieldLayer(keys=lull, start_time=-20.0, life=8.0)
    emission = Emission(field, layer_origins(field, 0, 160.0), 160.0, G)
    born = 29.0 - emission.births(29.0).age
    assert len(emission.births(29.0).age) == 0 or born.max() < 1.0
    assert len(emission.births(60.0).age) > 0


def test_more_resolution_is_the_same_sea() -> None:
    wind = Raster(np.random.default_rng(5).normal(0.0, 9.0, (6, 5, 2)))
    low, high = (sea(resolution=n, keys=(WindKey(0.0, wind),), rows=4, columns=4) for n in (512, 1024))
    coarse, fine = particles(low, 10.0), particles(high, 10.0)
    np.testing.assert_array_equal(WindWaves(low).classes.radii, WindWaves(high).classes.radii)
    assert set(zip(coarse.x, coarse.y, strict=True)) <= set(zip(fine.x, fine.y, strict=True))


def test_never_more_than_four_radii() -> None:
    for spread in (0.01, 1.0, 30.0):
        wind = Raster(20.0 + np.random.default_rng(2).uniform(-0.5, 0.5, (9, 9, 2)) * spread)
        field = WindFieldLayer(keys=(WindKey(0.0, wind),))
        radii = radius_classes((field,), G).radii
        assert 1 <= len(radii) <= 4
        assert np.all(np.diff(radii) > 0.0)
        assert radii[-1] <= 0.5 * field.greatest_speed**2 / G


def test_two_halves_of_opposite_wind_run_against_each_other() -> None:
    size, n = 200.0, 256
    halves = sampled_wind(lambda x, y: (np.where(y < 0.5 * size, 9.0, -9.0), 0.0 * x), size, 64)
    parameters = sea(n, size, keys=(WindKey(0.0, halves),), rows=8, columns=8, life=4.0, split_angle=0.03)
    ocean, step = Ocean(parameters), 0.2
    early, late = (ocean.surface(t).displacement[..., 2].astype(float) for t in (10.0, 10.0 + step))
    expected = 9.0 / math.sqrt(2.0 * math.pi)
    for rows, sign in ((slice(32, 96), 1.0), (slice(160, 224), -1.0)):
        one, two = np.fft.rfft(early[rows], axis=1), np.fft.rfft(late[rows], axis=1)
        # the phase of the band around λ = 8.3 m turns by -k·C·dt
        mode = np.arange(12, 40)
        turned = np.angle(np.sum(two[:, mode] * np.conj(one[:, mode]), axis=0))
        weight = np.sum(np.abs(one[:, mode]) ** 2, axis=0)
        measured = -np.average(turned / (2 * np.pi * mode / size * step), weights=weight)
        assert measured == pytest.approx(sign * expected, rel=0.1)


# many particles at once


def random_wind(seed: int, **layer: Any) -> dict[str, Any]:
    vectors = np.random.default_rng(seed).normal(0.0, 6.0, (5, 7, 2))
    return {"keys": (WindKey(0.0, Raster(vectors)),), "rows": 5, "columns": 4, **layer}


def test_a_deposit_on_a_sample_and_the_sum_of_weights() -> None:
    grid = WaveVectorGrid(16, 32.0)
    (on_sample,) = deposit(np.array([6.0]), np.array([62.0]), [np.array([8.0])], grid)
    assert on_sample[15, 3] == 4.5  # (6/8)² of it, and an eighth each way
    assert on_sample[15, 2] == on_sample[14, 3] == on_sample[0, 3] == 0.75
    x, y, a = np.random.default_rng(0).uniform(-99.0, 99.0, (3, 50))
    (total,) = deposit(x, y, [a], grid)
    assert total.sum() == pytest.approx(a.sum())


def convolution_error(radius: int) -> float:
    """Largest difference from stamping, in parts of the amplitude, over places between the samples."""
    n = 32 * radius // 5
    speed = math.sqrt(2.0 * radius * G)
    parameters = sea(
        n,
        float(n),
        **{**LONE, "wind_speed": speed, "particles": 1, "split_angle": 0.0, "life": 1.5, "jitter": 1.0},
    )
    worst = 0.0
    for seed in range(6):
        own = parameters.replace(seed=seed)
        now = particles(own, 2.0 * math.sqrt(2.0 * math.pi) * speed / G)
        stamped = stamp(now, WindWaves(own).classes, n, float(n))
        height = Ocean(own, "double").surface(2.0 * math.sqrt(2.0 * math.pi) * speed / G).displacement
        worst = max(worst, np.abs(height - stamped.position).max() / now.amplitude.max())
    return worst


def test_convolution_against_stamping() -> None:
    ten, twenty = convolution_error(10), convolution_error(20)
    assert ten <= 0.01
    assert twenty * 3.5 <= ten


def test_all_fields_of_many_particles_against_stamping() -> None:
    parameters = sea(512, 160.0, **random_wind(3)).replace(choppiness=0.7)
    waves = WindWaves(parameters)
    now = waves.particles(12.0)
    assert len(waves.classes.radii) == 4
    expected = stamp(now, waves.classes, 512, 160.0)
    ocean = Ocean(parameters, "double")
    fields = ocean.surface(12.0, OUTPUTS)
    chop = np.array([0.7, 0.7, 1.0])

    def agrees(field: Array, reference: Array, share: float) -> None:
        assert np.sqrt(np.mean((field - reference) ** 2)) <= share * np.sqrt(np.mean(reference**2))

    agrees(fields.displacement, expected.position * chop, 0.01)
    agrees(fields.velocity, expected.by_time * chop, 0.03)
    agrees(fields.slope[..., 0], expected.by_x[..., 2], 0.03)
    agrees(fields.slope[..., 1], expected.by_y[..., 2], 0.03)
    xx, xy = 1.0 + 0.7 * expected.by_x[..., 0], 0.7 * expected.by_y[..., 0]
    yx, yy = 0.7 * expected.by_x[..., 1], 1.0 + 0.7 * expected.by_y[..., 1]
    agrees(fields.jacobian - 1.0, xx * yy - xy * yx - 1.0, 0.05)
    single = Ocean(parameters).surface(12.0, OUTPUTS)
    for name in OUTPUTS:
        np.testing.assert_allclose(getattr(single, name), getattr(fields, name), atol=2e-5)


def test_the_spectrums_waves_and_the_winds_add() -> None:
    both = OceanParameters(resolution=128, domain_size=160.0, wind_fields=(WindFieldLayer(**random_wind(4)),))
    outputs = {"displacement", "slope", "velocity"}
    together, spectrum, wind = (
        Ocean(p, "double").surface(5.0, outputs)
        for p in (both, both.replace(wind_fields=()), both.replace(layers=FLAT))
    )
    for name in outputs:
        parts = getattr(spectrum, name) + getattr(wind, name)
        np.testing.assert_allclose(getattr(together, name), parts, atol=1e-9)
        assert np.abs(getattr(wind, name)).max() > 0.01


def test_edges_agree_and_without_mirrors_they_do_not() -> None:
    parameters = sea(64, 80.0, **random_wind(7, rows=9, columns=9))
    waves = WindWaves(parameters)
    now = waves.particles(8.0)
    fine = stamp(now, waves.classes, 256, 80.0, without_mean=False).position[..., 2]
    cracked = stamp(now, waves.classes, 256, 80.0, mirrors=False, without_mean=False).position[..., 2]

    def step_over_edge(height: Array) -> float:
        """The second difference over the edge, against the largest inside, where the surface is smooth."""
        inside = np.abs(np.diff(height, 2, axis=1)).max()
        across = np.abs(height[:, -1] - 2.0 * height[:, 0] + height[:, 1]).max()
        return float(across / inside)

    assert step_over_edge(fine) <= 1.0
    assert step_over_edge(cracked) > 2.0
    # the same shifted by a whole patch, to the precision of the numbers
    far = now._replace(x=now.x + 80.0, y=now.y - 160.0)
    moved = stamp(far, waves.classes, 256, 80.0, without_mean=False).position[..., 2]
    np.testing.assert_allclose(moved, fine, atol=1e-9)
    ocean = Ocean(parameters, "double")
    one = ocean.points_at([0.0, 3.0], [1.0, 80.0], 8.0, "exact")
    other = ocean.points_at([80.0, 83.0], [81.0, 0.0], 8.0, "exact")
    np.testing.assert_allclose(one.height, other.height, atol=1e-6)


def test_particles_only_lift_and_leave_the_mean() -> None:
    field = Ocean(sea(128, 80.0, **random_wind(1)), "double").surface(9.0).displacement
    np.testing.assert_allclose(field.mean(axis=(0, 1)), 0.0, atol=1e-12)
    assert field[..., 2].max() > 0.1


def test_any_frame_alone_in_reverse_and_on_any_threads_has_the_same_bytes() -> None:
    winds = [(t, np.random.default_rng(t).normal(0.0, 6.0, (4, 4, 2))) for t in (0, 2, 5)]
    parameters = sea(64, 80.0, keys=keyed(*((float(t), w) for t, w in winds)), rows=6, columns=6)
    foam = Foam(half_life=0.05, resolution=16)
    parameters = parameters.replace(layers=(WaveLayer(),), trough_damping=0.4, foam=foam)
    outputs = {"displacement", "velocity", "foam", "normal"}

    def content(fields: Any) -> bytes:
        return b"".join(getattr(fields, name).tobytes() for name in sorted(outputs))

    frames = range(1, 30, 7)
    forward = Ocean(parameters)
    in_order = [content(forward.frame(frame, outputs)) for frame in frames]
    backward = Ocean(parameters, workers=3)
    assert [content(backward.frame(frame, outputs)) for frame in reversed(frames)] == in_order[::-1]
    assert content(Ocean(parameters).frame(22, outputs)) == in_order[3]
    assert len(set(in_order)) == len(in_order)


def test_the_exact_surface_is_that_of_the_samples() -> None:
    parameters = sea(64, 80.0, **random_wind(8)).replace(choppiness=0.5, layers=(WaveLayer(),))
    ocean = Ocean(parameters, "double")
    fields = ocean.surface(6.0, {"displacement", "velocity"})
    rest = np.arange(0, 64, 5) * (80.0 / 64)
    sample = fields.displacement[np.arange(0, 64, 5), np.arange(0, 64, 5)]
    points = ocean.points_at(rest + sample[:, 0], rest + sample[:, 1], 6.0, "exact", velocity=True)
    near = np.hypot(points.rest[:, 0] - rest, points.rest[:, 1] - rest) < 1e-3  # not a fold's other sheet
    assert near.mean() > 0.7
    np.testing.assert_allclose(points.height[near], sample[near, 2], atol=1e-4)
    moving = fields.velocity[np.arange(0, 64, 5), np.arange(0, 64, 5)]
    assert points.velocity is not None
    np.testing.assert_allclose(points.velocity[near], moving[near], atol=1e-3)


def test_troughs_of_the_winds_waves_lose_short_waves_too() -> None:
    """They count among the long waves: what is damped is the spectrum's part alone."""
    parameters = sea(128, 80.0, **random_wind(2))
    damped = parameters.replace(trough_damping=1.0)
    np.testing.assert_array_equal(
        Ocean(damped).surface(5.0).displacement, Ocean(parameters).surface(5.0).displacement
    )
    mixed = damped.replace(layers=(WaveLayer(wind_speed=5.0),))
    calm = mixed.replace(wind_fields=())
    with_wind, without = (Ocean(p, "double").surface(5.0, {"displacement", "slope"}) for p in (mixed, calm))
    assert np.any(np.abs(with_wind.displacement - without.displacement) > 0.05)
    height = with_wind.displacement[..., 2]
    by_x = np.fft.irfft(2j * np.pi / 80.0 * np.arange(65) * np.fft.rfft(height, axis=1), axis=1)
    assert np.sqrt(np.mean((with_wind.slope[..., 0] - by_x) ** 2)) < 0.1 * np.sqrt(np.mean(by_x**2))


def test_foam_gathers_on_the_crests_of_the_wind() -> None:
    parameters = OceanParameters(resolution=64, domain_size=80.0, layers=(WaveLayer(wind_speed=9.0),))
    steep = parameters.replace(wind_fields=(WindFieldLayer(**random_wind(2, steepness=1.0)),))
    assert (
        Ocean(steep).surface(5.0, {"foam"}).foam.mean() > Ocean(parameters).surface(5.0, {"foam"}).foam.mean()
    )


# anything at all


@settings(max_examples=40, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
@given(
    rows=st.integers(1, 3),
    columns=st.integers(1, 3),
    number=st.sampled_from([0.0, 1e-30, 3.0, 9.0, 1e3, 1e38, math.nan, math.inf]),
    time=st.sampled_from([-1e6, -130.0, 0.0, 0.1, 77.0, 1e6]),
    more=st.fixed_dictionaries(
        {
            "front": st.sampled_from(["ARC", "PARALLEL"]),
            "particles": st.integers(1, 7),
            "split_angle": st.sampled_from([0.0, 0.1, 1.0]),
            "life": st.sampled_from([0.5, 8.0, 100.0]),
            "calm": st.sampled_from([0.1, 2.0]),
            "start_time": st.sampled_from([-1e6, 0.0, 1e6]),
        }
    ),
)
def test_any_field_works_or_is_refused_by_name(
    rows: int, columns: int, number: float, time: float, more: dict[str, Any]
) -> None:
    vectors = np.full((rows, columns, 2), 2.0)
    vectors[-1, -1, 0] = number
    layer = {"keys": [{"vectors": {"values": vectors.tolist()}}], "rows": 2, "columns": 2, **more}
    data = {"resolution": 32, "domain_size": 20.0, "layers": [{"muted": True}], "wind_fields": [layer]}
    if not number < 14.5:  # the waves of √(20 g) = 14.0 m/s are as long as the patch
        with pytest.raises(ParameterError, match=r"wind_fields\.0"):
            OceanParameters.from_dict(data)
        return
    parameters = OceanParameters.from_dict(data)
    with np.errstate(over="raise", invalid="raise", divide="raise"):
        fields = Ocean(parameters).surface(time, OUTPUTS)
    assert all(np.all(np.isfinite(getattr(fields, name))) for name in OUTPUTS)


def test_bounds_hold_and_are_refused_beyond() -> None:
    for seed in range(4):
        generator = np.random.default_rng(seed)
        keys = keyed(*((float(t), generator.normal(0.0, 7.0, (3, 3, 2))) for t in range(0, 40, 4)))
        for layer in (
            WindFieldLayer(wind_speed=9.0),
            WindFieldLayer(keys=keys),
            WindFieldLayer(keys=keys[:1]),
        ):
            parameters = OceanParameters(domain_size=200.0, resolution=2048, wind_fields=(layer,))
            waves = WindWaves(parameters)
            most = max(len(waves.particles(time).x) for time in np.arange(0.0, 60.0, 3.1))
            assert 0 < most <= most_particles(layer)
    with pytest.raises(
        ParameterError, match=r"wind_fields = 'up to \d+ particles': must have at most 2000000"
    ):
        sea(rows=512, columns=512)
    with pytest.raises(ParameterError, match="waves looked at"):
        sea(rows=100, columns=100, calm=0.1, life=20.0, particles=1, split_angle=0.0,
            keys=keyed((0.0, [[[20.0, 0.0]]]), (1.0, [[[0.0, 0.0]]])))  # fmt: skip


def test_memory_is_told_before() -> None:
    parameters = sea(1024, 400.0, wind_speed=12.0)
    ocean = Ocean(parameters, workers=1)
    ocean.surface(0.0, ())
    tracemalloc.start()
    ocean.surface(1.0)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    need = memory_need(parameters)
    assert peak < 1.4 * need.surface + need.building
    assert need.surface > memory_need(parameters.replace(wind_fields=())).surface
