# SPDX-License-Identifier: GPL-3.0-or-later
"""Height and mean direction over a bed and in the open sea, against single waves and the sea itself."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ocean_tweak.core import Area, Coast, Ocean, OceanParameters, Patch, Places, Raster, Water, WaveLayer
from ocean_tweak.core.parameters.patch_seas import open_sea
from ocean_tweak.core.sea.coast_pictures import Pictures
from ocean_tweak.core.sea.coast_state import StateFields, flow_over_bed
from ocean_tweak.core.waves.coast.ground import Ground

DEEP, G = 15.0, 9.81
STATE = ("significant_height", "broken_share", "mean_direction")


def sea(direction: float = 0.6, patches: tuple[Patch, ...] = (), **of_coast: object) -> OceanParameters:
    """A swell onto a beach of 200 m towards +x, from 15 m of water to land."""
    bed = np.repeat(np.linspace(DEEP, -1.0, 101)[np.newaxis], 101, axis=0)
    coast = Coast(
        **{"depth": Raster(bed), "spacing": 2.0, "rim": 40.0, "shortest_wavelength": 25.0, **of_coast}
    )
    swell = WaveLayer(
        definition="SEA_STATE", significant_wave_height=0.6, peak_period=8.0, wind_direction=direction,
        spreading="COSINE_2S", swell=1.0,
    )  # fmt: skip
    size = {} if patches else {"resolution": 64, "domain_size": 200.0}
    return OceanParameters(
        water=Water(depth=DEEP), coast=coast, layers=(swell,), seed=3, patches=patches, **size
    )


def state(parameters: OceanParameters, x: object, y: object) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    found = Ocean(parameters).surface(0.0, STATE, on=Places(x, y))
    return found.significant_height, found.broken_share, found.mean_direction


def test_the_flow_of_a_wave_is_half_its_square_along_its_direction() -> None:
    """On a flat bed with a hole of land; of two waves of different frequency it is the sum."""
    bed = np.full((41, 41), DEEP)
    bed[20, 20:23] = -1.0
    coast = Coast(depth=Raster(bed), spacing=5.0, rim=60.0, step=5.0)
    ground = Ground.of(coast, 200.0, 64, 0.0, DEEP)
    wet = ground.depth > 0.0
    assert not wet.all()
    along = ground.step * np.arange(ground.rows)[:, np.newaxis]
    across = ground.step * np.arange(ground.columns)
    period, numbers, sides, amplitudes = 512.0, np.array([95, 115]), (3, -4), (0.5, 0.2)
    elevation, expected = [], np.zeros(2)
    for number, side, amplitude in zip(numbers, sides, amplitudes, strict=True):
        omega, ky = 2.0 * np.pi * number / period, 2.0 * np.pi * side / 200.0
        k = omega**2 / G
        for _ in range(200):
            k = omega**2 / (G * np.tanh(k * DEEP))
        kx = np.sqrt(k * k - ky * ky)
        elevation.append((amplitude * np.exp(1j * (kx * along + ky * across)))[wet])
        expected += 0.5 * amplitude**2 * np.array([kx, ky]) / k
    pictures = Pictures(numbers, np.array(elevation, np.complex64), np.zeros((2, 0), np.complex64))
    flow = flow_over_bed(pictures, ground, period, G)
    assert_allclose(flow[wet], np.broadcast_to(expected, flow[wet].shape), rtol=2e-4)
    assert not flow[~wet].any()


def test_over_a_film_of_water_a_wave_is_as_long_as_over_five_centimetres() -> None:
    """Of 64 s, so long that 0.05 m has it turn by less than is allowed from sample to sample."""
    coast = Coast(depth=Raster(np.full((41, 41), 0.01)), spacing=5.0, rim=60.0, step=5.0)
    ground = Ground.of(coast, 200.0, 64, 0.0, DEEP)
    film = ground.depth == ground.depth.min()
    assert 0.0 < ground.depth.min() < 0.05
    k = 2.0 * np.pi / 64.0 / np.sqrt(G * 0.05)
    wave = 0.3 * np.exp(1j * k * ground.step * np.arange(ground.rows)[:, np.newaxis])
    elevation = np.broadcast_to(wave, ground.depth.shape)[ground.depth > 0.0][np.newaxis]
    pictures = Pictures(np.array([8]), elevation.astype(np.complex64), np.zeros((2, 0), np.complex64))
    flow = flow_over_bed(pictures, ground, 512.0, G)
    assert_allclose(np.median(flow[film], axis=0), (0.5 * 0.3**2, 0.0), rtol=1e-3, atol=1e-6)


@pytest.mark.parametrize("rotation", [0.0, 0.4])
def test_waves_turn_towards_the_shore_as_snell_has_it(rotation: float) -> None:
    """sin θ over the phase speed stays: of a swell of 8 s at the peak."""
    patches = (Patch(200.0, resolution=64, rotation=rotation),) if rotation else ()
    parameters = sea(0.5 + rotation, patches)
    depth = np.array([DEEP, 6.0, 2.0])
    along = 200.0 * (DEEP - depth) / (DEEP + 1.0)
    along[0] = -60.0
    across = np.linspace(0.0, 200.0, 40, endpoint=False)
    c, s = np.cos(rotation), np.sin(rotation)
    found = []
    for x in along:
        _, _, towards = state(parameters, c * x - s * across, s * x + c * across)
        assert_allclose(np.hypot(*towards.T), 1.0, atol=1e-5)
        mean = towards.mean(axis=0)
        found.append(np.arctan2(mean[1], mean[0]) - rotation)
    k = np.full(3, 0.07)
    for _ in range(300):
        k = 0.5 * (k + (2.0 * np.pi / 8.0) ** 2 / (G * np.tanh(k * depth)))
    expected = np.arcsin(np.sin(found[0]) * k[0] / k)
    assert found[0] == pytest.approx(0.5, abs=0.1)
    assert_allclose(found, expected, atol=np.radians(2.0))
    assert found[2] < 0.6 * found[0]


def test_the_height_is_four_times_the_deviation_of_the_elevation() -> None:
    """Of this seed, over all the time after which it repeats; before waves break and are no cosines."""
    parameters = sea(0.1)
    ocean = Ocean(parameters)
    x, y = np.full(24, 90.0), np.linspace(0.0, 200.0, 24, endpoint=False)
    moments = [ocean.surface(t, on=Places(x, y)).displacement[:, 2] for t in np.arange(0.0, 512.0, 4.0)]
    height, broken, _ = state(parameters, x, y)
    assert broken.max() < 0.05
    assert_allclose(height.mean(), 4.0 * np.std(moments, axis=0).mean(), rtol=0.04)
    assert np.corrcoef(height, np.std(moments, axis=0))[0, 1] > 0.9


def test_waves_are_lower_and_more_of_them_broken_near_the_shore() -> None:
    y = np.linspace(0.0, 200.0, 30, endpoint=False)
    places = (100.0, 155.0, 165.0, 180.0)
    found = [[each.mean() for each in state(sea(0.1), np.full(30, x), y)[:2]] for x in places]
    heights, shares = zip(*found, strict=True)
    assert 0.6 * heights[0] > heights[3] > 0.0
    assert shares[0] < 0.02 < shares[1] < shares[2] < 1.0
    on_land = state(sea(0.1), np.full(30, 199.0), y)
    assert_allclose(on_land[0], 0.0, atol=1e-6)


def test_in_the_open_sea_it_is_that_of_the_spectrum_and_does_not_jump_at_the_rim() -> None:
    parameters = sea()
    open_height = Ocean(open_sea(parameters)).statistics().resolved.significant_wave_height
    away = state(parameters, [-900.0, -1200.0], [40.0, 90.0])
    alone = state(open_sea(parameters), [0.0, 3.0], [1.0, 2.0])
    for found in (away, alone):
        assert_allclose(found[0], open_height, rtol=1e-5)
        assert not found[1].any()
        assert_allclose(np.arctan2(found[2][:, 1], found[2][:, 0]), 0.6, atol=0.1)
    assert_allclose(away[2], alone[2], atol=1e-6)
    area = Ocean(parameters).surface(0.0, STATE, on=Area(260.0, 131, corner=(-130.0, 0.0)))
    assert np.abs(np.diff(area.significant_height, axis=1))[:, :60].max() < 0.1 * open_height


@pytest.mark.parametrize("direction", [-1.0, 2.8])
@pytest.mark.parametrize("rotation", [0.0, 0.7])
def test_waves_in_the_open_sea_run_where_they_are_said_to(direction: float, rotation: float) -> None:
    patches = (Patch(200.0, resolution=64, rotation=rotation),) if rotation else ()
    (towards,) = state(open_sea(sea(direction, patches)), [3.0], [4.0])[2]
    assert np.arctan2(towards[1], towards[0]) == pytest.approx(direction, abs=0.1)


def test_a_tile_has_it_everywhere_and_any_time_has_the_same() -> None:
    ocean = Ocean(open_sea(sea()))
    tile, later = ocean.surface(0.0, STATE), ocean.surface(77.0, STATE)
    assert tile.mean_direction.shape == (64, 64, 2)
    assert np.ptp(tile.significant_height) == 0.0
    for name in STATE:
        np.testing.assert_array_equal(tile[name], later[name])


def test_waves_of_a_millimetre_have_a_direction_too_and_no_waves_have_none() -> None:
    small = 0.25e-3**2
    flow = np.array([[0.6 * small, -0.8 * small], [0.0, 0.0]])
    found = StateFields.of(np.array([small, 0.0]), np.zeros(2), flow)
    assert_allclose(found.significant_height, [1e-3, 0.0])
    assert_allclose(found.mean_direction, [[0.6, -0.8], [0.0, 0.0]])


def test_waves_that_turn_too_far_between_samples_are_as_the_march_has_them() -> None:
    """At most 1.2 rad from one sample to the next; half the square of the height runs on all the same."""
    coast = Coast(depth=Raster(np.full((41, 41), DEEP)), spacing=5.0, rim=60.0, step=5.0)
    ground = Ground.of(coast, 200.0, 64, 0.0, DEEP)
    number, period = 196, 512.0
    assert (2.0 * np.pi * number / period) ** 2 / G * ground.step > 2.0 * 1.2
    wave = 0.5 * np.exp(1.2j * np.arange(ground.rows)[:, np.newaxis] * np.ones(ground.columns))
    pictures = Pictures(
        np.array([number]), wave.reshape(1, -1).astype(np.complex64), np.zeros((1, 0), np.complex64)
    )
    flow = flow_over_bed(pictures, ground, period, G)
    assert_allclose(flow, np.broadcast_to([0.125, 0.0], flow.shape), atol=1e-6)
