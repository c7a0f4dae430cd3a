# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields of seas of several patches, foam among them: those of the sum of all waves."""

from __future__ import annotations

import dataclasses
from fractions import Fraction

import numpy as np
import pytest

from ocean_tweak.core import Area, Foam, Ocean, OceanParameters, Patch, Places
from ocean_tweak.core.foam.drifting import whitecaps_at
from ocean_tweak.core.foam.model import FoamModel
from ocean_tweak.core.synthesis.channels import OF_WAVES
from tests.core.patched_seas import LAYER, SEA, THREE, small, summed
from tests.core.test_fields import outputs_from

GENERATOR = np.random.default_rng(11)


@pytest.mark.parametrize("rotation", [0.0, 0.5 * np.pi, -0.5 * np.pi])
def test_every_field_of_the_sum_equals_the_sum_of_waves(rotation: float) -> None:
    """Where samples of both patches coincide nothing is interpolated."""
    patches = (Patch(64.0, 0.0, 12.0, 1e6, 16), Patch(32.0, rotation, 4.5, 12.0, 16))
    sea = small(patches=patches, choppiness=0.8)
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(0.0, 128.0, 4.0), np.arange(-64.0, 64.0, 4.0)))
    fields = Ocean(sea, precision="double").surface(2.5, OF_WAVES, on=Places(x, y))
    for name, expected in outputs_from(summed(sea, x, y, 2.5)).items():
        actual = getattr(fields, name)
        if name == "min_eigenvector":
            actual = actual * np.sign(np.sum(actual * expected, axis=-1, keepdims=True))
        np.testing.assert_allclose(actual, expected, atol=2e-6, err_msg=name)


def test_fields_between_the_samples_are_near_the_sum_of_waves() -> None:
    patches = tuple(dataclasses.replace(p, resolution=512) for p in small().patches)
    x, y = GENERATOR.uniform(-200.0, 200.0, (2, 200))
    exact = summed(small(), x, y, 4.0)
    sea = small(patches=patches)  # more samples refine the same sea, within its bands
    fine = Ocean(sea).surface(4.0, {"displacement", "slope"}, on=Places(x, y))
    spread = np.std(exact["z"])
    assert np.std(fine.displacement[:, 2] - exact["z"]) < 0.05 * spread
    assert np.std(fine.slope[:, 0] - exact["z_x"]) < 0.35 * np.std(exact["z_x"])


def test_exact_surface_is_the_sum_of_waves() -> None:
    sea = small()
    x, y = GENERATOR.uniform(-300.0, 300.0, (2, 60))
    sums = summed(sea, x, y, 3.0)
    points = Ocean(sea).points_at(x + sums["x"], y + sums["y"], 3.0, "exact", velocity=True)
    assert np.all(points.found)
    np.testing.assert_allclose(points.height, sums["z"], atol=2e-5)
    np.testing.assert_allclose(points.rest, np.stack([x, y], -1), atol=2e-4)
    np.testing.assert_allclose(points.velocity, np.stack([sums[c + "_t"] for c in "xyz"], -1), atol=2e-4)
    np.testing.assert_allclose(points.normal, outputs_from(sums)["normal"], atol=2e-4)


def test_places_are_found_where_they_went() -> None:
    cascade = Ocean(SEA)
    x, y = GENERATOR.uniform(-5e3, 5e3, (2, 2000))
    points = cascade.points_at(x, y, 4.0, velocity=True)
    assert np.all(points.found)
    rest_x, rest_y = points.rest[:, 0], points.rest[:, 1]
    fields = cascade.surface(4.0, {"displacement", "velocity"}, on=Places(rest_x, rest_y))
    np.testing.assert_allclose(rest_x + fields.displacement[:, 0], x, atol=1e-4)
    np.testing.assert_allclose(rest_y + fields.displacement[:, 1], y, atol=1e-4)
    np.testing.assert_allclose(fields.displacement[:, 2], points.height, atol=1e-4)
    np.testing.assert_allclose(fields.velocity, points.velocity, atol=1e-4)
    assert cascade.height_at(3.0, 4.0, 2.0).shape == ()


def test_velocity_is_the_change_of_the_displacement() -> None:
    cascade = Ocean(SEA, precision="double")
    x, y = GENERATOR.uniform(0.0, 1e3, (2, 300))
    step = 1e-3
    before, after = (cascade.surface(5.0 + dt, on=Places(x, y)).displacement for dt in (-step, step))
    velocity = cascade.surface(5.0, {"velocity"}, on=Places(x, y)).velocity
    np.testing.assert_allclose((after - before) / (2 * step), velocity, atol=1e-4)


def test_the_highest_sheet_of_a_fold() -> None:
    wind = dataclasses.replace(LAYER, wind_speed=14.0)
    cascade = Ocean(SEA.replace(choppiness=3.5, layers=(wind,), patches=THREE[:2]))
    x, y = np.random.default_rng(1).uniform(0.0, 3000.0, (2, 60_000))
    fields = cascade.surface(1.0, {"displacement", "min_eigenvalue"}, on=Places(x, y))
    folded = fields.min_eigenvalue < -0.05
    assert np.count_nonzero(folded) > 20
    moved = fields.displacement[folded].astype(float)
    heights = cascade.height_at(x[folded] + moved[:, 0], y[folded] + moved[:, 1], 1.0)
    # at a fold's very edge a net may miss it; single patches have a quad for each
    assert np.mean(heights >= moved[:, 2] - 1e-3) > 0.8
    wave_height = cascade.statistics().significant_wave_height
    assert np.mean(np.maximum(moved[:, 2] - heights, 0.0)) < 0.02 * wave_height
    assert np.any(heights > moved[:, 2] + 1e-3)


def test_the_sum_repeats_with_no_patch() -> None:
    cascade = Ocean(SEA)
    x, y = GENERATOR.uniform(0.0, 600.0, (2, 4000))
    here = cascade.surface(1.0, {"slope"}, on=Places(x, y)).slope[:, 0]
    for patch in THREE:
        c, s = np.cos(patch.rotation), np.sin(patch.rotation)
        there = cascade.surface(
            1.0, {"slope"}, on=Places(x + c * patch.domain_size, y + s * patch.domain_size)
        ).slope[:, 0]
        # slopes are spread over all bands: what one patch repeats is not the sum
        assert np.corrcoef(here, there)[0, 1] < 0.6


# foam


def test_foam_of_one_patch_is_that_of_its_ocean() -> None:
    sea = OceanParameters(
        resolution=64, domain_size=200.0, layers=(dataclasses.replace(LAYER, wind_speed=16.0),),
        foam=Foam(drift=0.0, coverage=3.0, half_life=1.0),
    )  # fmt: skip
    expected = Ocean(sea).surface(2.3, {"foam"}).foam
    assert 0.02 < np.mean(expected > 0.1) < 0.9
    np.testing.assert_allclose(
        Ocean(sea).surface(2.3, {"foam"}, on=Area(200.0, 64)).foam, expected, atol=1e-5
    )


def test_foam_of_the_sum_covers_what_the_wind_leaves() -> None:
    wind = dataclasses.replace(LAYER, wind_speed=15.0)
    sea = SEA.replace(layers=(wind,), foam=Foam(half_life=1.0, coverage=2.0))
    cascade = Ocean(sea)
    x, y = GENERATOR.uniform(0.0, 20e3, (2, 20_000))
    fields = cascade.surface(4.0, {"foam", "jacobian"}, on=Places(x, y))
    foam = fields.foam
    assert np.all((foam >= 0.0) & (foam <= 1.0))
    # 4.82e-6 · 16.98³
    assert np.mean(foam * fields.jacobian) == pytest.approx(2.0 * 0.023597, rel=0.25)
    # a frame alone is that of a sequence
    cascade.surface(4.125, {"foam"}, on=Places(x, y))
    np.testing.assert_array_equal(cascade.surface(4.0, {"foam"}, on=Places(x, y)).foam, foam)
    np.testing.assert_array_equal(Ocean(sea).surface(4.0, {"foam"}, on=Places(x[:5], y[:5])).foam, foam[:5])


def test_foam_drifts_along_the_wind() -> None:
    """Foam that is born once, in a spot at the origin, lies downwind of it later, and fades."""
    model = FoamModel(threshold=0.5, half_life=2.0, drift=(1.5, -0.5), spacing=1.0)

    def spot(x: np.ndarray, y: np.ndarray, time: Fraction) -> np.ndarray:
        return np.where((np.hypot(x, y) < 0.4) & (time == 1), 1.0, 0.0)

    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(-6.0, 6.1, 0.25), np.arange(-6.0, 6.1, 0.25)))
    foam = whitecaps_at(model, spot, x, y, 3.0).foam
    covered = foam > 0.0
    assert np.mean(x[covered]) == pytest.approx(2.0 * 1.5, abs=0.1)
    assert np.mean(y[covered]) == pytest.approx(2.0 * -0.5, abs=0.1)
    np.testing.assert_allclose(foam[covered], 0.5, rtol=1e-6)
    assert np.all(whitecaps_at(model, spot, x, y, 1.0).foam == (np.hypot(x, y) < 0.4))
    assert not np.any(whitecaps_at(model, spot, x, y, 0.5).foam)


def test_cusp_of_the_sum_is_made_of_strains_as_the_document_says() -> None:
    cascade = Ocean(SEA)
    x, y = GENERATOR.uniform(0.0, 500.0, (2, 200))
    fields = cascade.surface(2.0, {"strain", "cusp"}, on=Places(x, y))
    xx, yy, xy = np.moveaxis(fields.strain, -1, 0)
    cusp = np.maximum(0.0, 1 - (1 + (xx + yy) / 2) + np.sqrt(((xx - yy) / 2) ** 2 + xy**2))
    np.testing.assert_allclose(fields.cusp, cusp, atol=1e-6)
