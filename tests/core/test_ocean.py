# SPDX-License-Identifier: GPL-3.0-or-later
"""The one door: whatever a sea is made of, the same is asked of it in the same way."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from ocean_tweak.core import Area, Mask, Ocean, OceanParameters, Patch, Places, Tile, WaveLayer
from ocean_tweak.core.foam.model import FoamModel
from ocean_tweak.core.sea.memory import memory_need
from ocean_tweak.core.synthesis.channels import CHANNELS

SIDE, SAMPLES = 120.0, 32
WIND = WaveLayer(wind_speed=9.0, fetch=50e3)
ONE = OceanParameters(resolution=SAMPLES, domain_size=SIDE, seed=2, layers=(WIND,))
MASKED = ONE.replace(
    layers=(dataclasses.replace(WIND, mask=Mask(x=20.0, y=30.0, inner_radius=10.0, outer_radius=40.0)),)
)
SEPARATE = ONE.replace(patches=(Patch(SIDE, 0.0, 15.0, 1e6, SAMPLES), Patch(41.0, 0.4, 3.0, 15.0, SAMPLES)))
SEAS = {
    "one": ONE,
    "masked": MASKED,
    "merged_resolution": SEPARATE.on_one_grid(SAMPLES),
    "separate": SEPARATE,
}
GENERATOR = np.random.default_rng(8)


@pytest.fixture(params=SEAS)
def sea(request: pytest.FixtureRequest) -> Ocean:
    parameters: OceanParameters = SEAS[request.param]
    return Ocean(parameters.replace(foam=dataclasses.replace(parameters.foam, half_life=0.3, coverage=50.0)))


def test_an_area_is_its_places(sea: Ocean) -> None:
    area = sea.surface(2.0, CHANNELS, on=Area(30.0, 5, corner=(-7.0, 11.0)))
    x, y = np.meshgrid(-7.0 + 6.0 * np.arange(5), 11.0 + 6.0 * np.arange(5))
    places = sea.surface(2.0, CHANNELS, on=Places(x, y))
    for name, channel in CHANNELS.items():
        assert area[name].shape == ((5, 5, channel.components) if channel.components else (5, 5)), name
        np.testing.assert_array_equal(area[name], places[name], err_msg=name)
    assert np.any(area.foam > 0.0)


def test_places_may_have_any_shape(sea: Ocean) -> None:
    one = sea.surface(2.0, {"displacement", "cusp"}, on=Places(3.0, -200.0))
    assert (one.displacement.shape, one.cusp.shape) == ((3,), ())
    column, row = np.array([[1.0], [2.0]]), np.array([5.0, 6.0, 7.0])
    assert sea.surface(2.0, on=Places(column, row)).displacement.shape == (2, 3, 3)


@pytest.mark.parametrize("name", ["one", "masked"])
def test_places_at_the_samples_are_the_tile(name: str) -> None:
    sea = Ocean(SEAS[name])
    outputs = set(CHANNELS) - {"foam", "min_eigenvector"}
    tile, there = (sea.surface(2.0, outputs, on=on) for on in (Tile(), Area(SIDE, SAMPLES)))
    for output in outputs:
        np.testing.assert_allclose(there[output], tile[output], atol=2e-5, err_msg=output)


def test_a_frame_is_the_surface_at_its_time(sea: Ocean) -> None:
    on = Places(GENERATOR.uniform(0.0, SIDE, 7), 4.0)
    found = sea.frame(13, {"velocity"}, on=on)
    assert found.time == 0.5
    np.testing.assert_array_equal(found.velocity, sea.surface(0.5, {"velocity"}, on=on).velocity)


def test_arrays_of_the_caller_are_filled_at_places_too(sea: Ocean) -> None:
    on = Area(50.0, 6)
    wide = np.zeros((6, 6, 5), np.float32)
    out = {"displacement": wide[..., 1:4], "cusp": np.empty((6, 6), np.float32)}
    found = sea.surface(1.0, {"displacement", "cusp"}, on=on, out=out)
    assert found.cusp is out["cusp"]
    made = sea.surface(1.0, {"displacement", "cusp"}, on=on)
    np.testing.assert_array_equal(wide[..., 1:4], made.displacement)
    np.testing.assert_array_equal(out["cusp"], made.cusp)
    assert not wide[..., 0].any()
    with pytest.raises(
        ValueError, match=r"out\['cusp'\]: must be an array \(6, 6\) of float32, not \(5, 6\)"
    ):
        sea.surface(1.0, {"cusp"}, on=on, out={"cusp": np.empty((5, 6), np.float32)})


def test_all_tell_heights_numbers_and_what_they_need(sea: Ocean) -> None:
    x, y = GENERATOR.uniform(0.0, 0.8 * SIDE, (2, 40))
    points = sea.points_at(x, y, 3.0, velocity=True)
    assert np.all(points.found)
    np.testing.assert_array_equal(sea.height_at(x, y, 3.0), points.height)
    exact = sea.height_at(x, y, 3.0, "exact")
    assert 0.0 < np.abs(exact - points.height).max() < 0.25
    assert 0.2 < sea.statistics().significant_wave_height < 1.5
    assert sea.memory({"normal"}) == memory_need(sea.parameters, {"normal"})
    assert isinstance(sea.foam_model, FoamModel)
    assert 0.0 < sea.foam_model.threshold < 1.0
    with pytest.raises(ValueError, match="x and y: must be finite places in m"):
        sea.height_at(np.nan, 0.0, 1.0)


def test_only_separate_patches_are_several_tiles() -> None:
    for name, parameters in SEAS.items():
        sea = Ocean(parameters)
        if name == "separate":
            assert [patch.parameters.domain_size for patch in sea.patches] == [SIDE, 41.0]
            assert all(patch.patches == (patch,) for patch in sea.patches)
        else:
            assert sea.patches == (sea,)


@pytest.mark.parametrize(
    ("size", "samples", "said"),
    [
        (0.0, 4, r"size = 0\.0: must be a length above 0 m"),
        (np.inf, 4, "size = inf"),
        (1e300, 4, r"size = 1e\+300.* must be within 1e\+12 m"),
        (1.0, 0, "resolution = 0"),
    ],
)
def test_an_area_has_a_size_and_samples(size: float, samples: int, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        Area(size, samples)
