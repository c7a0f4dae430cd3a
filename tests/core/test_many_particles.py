# SPDX-License-Identifier: GPL-3.0-or-later
"""Many particles at once: against stamping, as part of a sea, and within the bounds of their number."""

from __future__ import annotations

import dataclasses
import math
import tracemalloc
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from ocean_tweak.core import Foam, Ocean, OceanParameters, ParameterError, WaveLayer, WindFieldLayer
from ocean_tweak.core.numerics.grid import WaveVectorGrid
from ocean_tweak.core.sea.memory import memory_need
from ocean_tweak.core.waves.wind_field.bounds import bytes_of, most_particles
from ocean_tweak.core.waves.wind_field.convolution import deposit
from tests.core.stamping import stamp
from tests.core.wind_seas import FLAT, LONE, OUTPUTS, G, keyed, particles, random_wind, sea
from tests.layers import with_layers

Array = NDArray[np.float64]


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
        stamped = stamp(now, WindFieldLayer.shares(own).classes, n, float(n))
        height = Ocean(own, "double").surface(2.0 * math.sqrt(2.0 * math.pi) * speed / G).displacement
        worst = max(worst, np.abs(height - stamped.position).max() / now.amplitude.max())
    return worst


def test_convolution_against_stamping() -> None:
    ten, twenty = convolution_error(10), convolution_error(20)
    assert ten <= 0.01
    assert twenty * 3.5 <= ten


def test_all_fields_of_many_particles_against_stamping() -> None:
    parameters = sea(512, 160.0, **random_wind(3)).replace(choppiness=0.7)
    waves = WindFieldLayer.shares(parameters)
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
    both = with_layers(
        OceanParameters(resolution=128, domain_size=160.0), WIND_FIELD=(WindFieldLayer(**random_wind(4)),)
    )
    outputs = {"displacement", "slope", "velocity"}
    together, spectrum, wind = (
        Ocean(p, "double").surface(5.0, outputs)
        for p in (both, with_layers(both, WIND_FIELD=()), with_layers(both, WAVES=FLAT))
    )
    for name in outputs:
        parts = getattr(spectrum, name) + getattr(wind, name)
        np.testing.assert_allclose(getattr(together, name), parts, atol=1e-9)
        assert np.abs(getattr(wind, name)).max() > 0.01


def test_edges_agree_and_without_mirrors_they_do_not() -> None:
    parameters = sea(64, 80.0, **random_wind(7, rows=9, columns=9))
    waves = WindFieldLayer.shares(parameters)
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
    parameters = with_layers(parameters, WAVES=(WaveLayer(),)).replace(trough_damping=0.4, foam=foam)
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
    mixed = with_layers(damped, WAVES=(WaveLayer(wind_speed=5.0),))
    calm = with_layers(mixed, WIND_FIELD=())
    with_wind, without = (Ocean(p, "double").surface(5.0, {"displacement", "slope"}) for p in (mixed, calm))
    assert np.any(np.abs(with_wind.displacement - without.displacement) > 0.05)
    height = with_wind.displacement[..., 2]
    by_x = np.fft.irfft(2j * np.pi / 80.0 * np.arange(65) * np.fft.rfft(height, axis=1), axis=1)
    assert np.sqrt(np.mean((with_wind.slope[..., 0] - by_x) ** 2)) < 0.1 * np.sqrt(np.mean(by_x**2))


def test_foam_gathers_on_the_crests_of_the_wind() -> None:
    parameters = OceanParameters(resolution=64, domain_size=80.0, layers=(WaveLayer(wind_speed=9.0),))
    steep = with_layers(parameters, WIND_FIELD=(WindFieldLayer(**random_wind(2, steepness=1.0)),))
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
            "crest": st.sampled_from(["ARC", "PARALLEL"]),
            "particles": st.integers(1, 7),
            "split_angle": st.sampled_from([0.0, 0.1, 1.0]),
            "life": st.sampled_from([0.5, 8.0, 100.0]),
            "minimum_wind_speed": st.sampled_from([0.1, 2.0]),
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
        with pytest.raises(ParameterError, match=r"layers\.1"):
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
            parameters = with_layers(OceanParameters(domain_size=200.0, resolution=2048), WIND_FIELD=(layer,))
            waves = WindFieldLayer.shares(parameters)
            most = max(len(waves.particles(time).x) for time in np.arange(0.0, 60.0, 3.1))
            assert 0 < most <= most_particles(layer)
    with pytest.raises(ParameterError, match=r"layers = 'up to \d+ particles': must have at most 2000000"):
        sea(rows=512, columns=512)
    with pytest.raises(ParameterError, match="waves looked at"):
        sea(rows=100, columns=100, minimum_wind_speed=0.1, life=20.0, particles=1, split_angle=0.0,
            keys=keyed((0.0, [[[20.0, 0.0]]]), (1.0, [[[0.0, 0.0]]])))  # fmt: skip


def test_memory_of_origins() -> None:
    """A place and a part of a period are three numbers of 8 bytes, a wind two; one is there without keys."""
    plain = WindFieldLayer(columns=10, rows=10, origins=2)
    assert bytes_of((plain,), 9.81)[0] == 200 * (3 * 8 + 2 * 8)
    assert bytes_of((plain, plain), 9.81)[0] == 400 * (3 * 8 + 2 * 8)
    assert bytes_of((dataclasses.replace(plain, muted=True),), 9.81) == (0, 0)


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
    assert need.surface > memory_need(with_layers(parameters, WIND_FIELD=())).surface
