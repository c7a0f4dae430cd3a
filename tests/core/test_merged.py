# SPDX-License-Identifier: GPL-3.0-or-later
"""Several patches on the samples of one grid: their sum, without the waves that the grid cannot hold."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from ocean_tweak.core import Foam, Ocean, OceanParameters, ParameterError, Patch, Places, WaveLayer
from ocean_tweak.core.numerics.memo import MEMO
from ocean_tweak.core.parameters.patch_seas import merged_bands, parts
from ocean_tweak.core.parameters.shot import Shot
from ocean_tweak.core.sea.bake import ShotSeas
from ocean_tweak.core.sea.memory import memory_need
from ocean_tweak.core.sea.part_waves import PartWaves, strain_covariances
from ocean_tweak.core.sea.sums import border_shares
from ocean_tweak.core.statistics.unresolved_slopes import total_slope_variance, unresolved_slope_variance
from tests.core.patched_seas import LAYER, SEA, THREE, summed

PATCHES, APART = THREE, SEA
#: samples of 128 before the border of two 20 m waves
INSIDE = 119
GENERATOR = np.random.default_rng(2)


def joined(samples: int, **changes: object) -> OceanParameters:
    return APART.replace(**changes).on_one_grid(samples)


def test_the_grid_is_that_of_the_first_patch() -> None:
    sea = joined(256)
    assert (sea.resolution, sea.domain_size, sea.merged_resolution) == (256, 600.0, 256)
    assert not sea.is_cascade
    assert sea.at_resolution(64).merged_resolution == 64
    assert sea.at_resolution(64).patches == PATCHES
    assert sea.without_patches == OceanParameters(seed=3, layers=(LAYER,), resolution=256, domain_size=600.0)
    assert OceanParameters.from_json(sea.to_json()) == sea
    assert "merged_resolution" not in APART.to_json()


def test_waves_too_short_for_the_grid_are_left_out() -> None:
    """Two samples of a 2.34 m grid are 4.69 m: of the third patch's band from 5 to 0.9 m a part stays."""
    bands = [patch.band for patch in merged_bands(joined(256)).patches]
    assert bands == [(20.0, 1e6), (5.0, 20.0), (pytest.approx(4.6875), 5.0)]
    assert [patch.band for patch in merged_bands(joined(128)).patches] == [
        (20.0, 1e6), (pytest.approx(9.375), 20.0),
    ]  # fmt: skip
    assert [patch.band for patch in merged_bands(joined(32)).patches] == [(20.0, 1e6)]


@pytest.mark.parametrize(
    ("patches", "ends"),
    [
        # two samples of the first are 1.125 m, of the second 3/16 m and of the grid 0.375 m
        ((Patch(9.0, 1.0, 1.0, 1e6, 16), Patch(1.5, 0.0, 0.0, 1.0, 16)), [1.0, 0.375]),
        # two samples of the middle one are longer than all of its waves
        (
            (
                Patch(9.0, 0.0, 2.0, 1e6, 16),
                Patch(20.0, 0.3, 1.0, 2.0, 16),
                Patch(6.0, 0.1, 0.0, 1.0, 16),
            ),
            [2.0, 1.0, 0.75],
        ),
    ],
)
def test_bands_meet_where_a_patch_in_between_is_coarse(patches: tuple[Patch, ...], ends: list[float]) -> None:
    bands = merged_bands(OceanParameters(patches=patches, merged_resolution=48)).patches
    assert [patch.shortest_wavelength for patch in bands] == ends
    assert [patch.longest_wavelength for patch in bands] == [1e6, *ends[:-1]]


def test_patches_are_read_at_eight_samples_a_wave() -> None:
    """Linear interpolation keeps (2 + cos 2π/8)/3 = 0.902 of the shortest wave's variance along an axis."""
    for patch in merged_bands(joined(1024)).patches[1:]:
        assert 8.0 <= patch.samples_a_wave < 9.0


def test_it_is_the_sum_of_the_waves() -> None:
    """Of few waves added up one by one: 1 - cos(2π/16) = 0.076 is what a line misses of the shortest wave."""
    layer = dataclasses.replace(LAYER, wind_speed=6.0)
    patches = (Patch(120.0, 0.0, 16.0, 1e6, 32), Patch(37.0, -0.9, 6.0, 16.0, 32))
    sea = OceanParameters(layers=(layer,), patches=patches).on_one_grid(64)
    index = GENERATOR.integers(0, 57, (60, 2))
    places = 120.0 / 64 * index
    bands = merged_bands(sea)
    sums = summed(bands, *places.T, 1.5)
    first = summed(bands.replace(patches=bands.patches[:1]), *places.T, 1.5)
    found = Ocean(sea, "double").surface(1.5).displacement[index[:, 1], index[:, 0]]
    for component, name in enumerate("xyz"):
        of_second = np.std(sums[name] - first[name])
        assert of_second > 0.02
        assert np.std(found[:, component] - sums[name]) < 0.08 * of_second  # it is read linearly


def test_each_field_is_that_of_the_sum() -> None:
    """At the grid's samples, as the sea of the same bands tells it for any place."""
    sea = joined(128)
    outputs = {"displacement", "velocity", "slope", "strain", "normal", "cusp", "jacobian", "min_eigenvector"}
    found = Ocean(sea).surface(4.0, outputs)
    along = 600.0 / 128 * np.arange(INSIDE)
    there = Ocean(merged_bands(sea)).surface(4.0, outputs, on=Places(along, along[:, np.newaxis]))
    for name in outputs:
        inside = getattr(found, name)[:INSIDE, :INSIDE]
        np.testing.assert_allclose(inside, getattr(there, name), atol=3e-5, err_msg=name)


def test_the_square_repeats_without_a_seam() -> None:
    """Derivatives by differences across the far sides are those of the fields, as they are inside."""
    sea = joined(512, choppiness=0.0)
    fields = Ocean(sea, "double").surface(4.0, {"displacement", "slope"})
    spacing = 600.0 / 512
    for axis, name in ((1, "x"), (0, "y")):
        height = np.moveaxis(fields.displacement[..., 2], axis, 0)
        slope = np.moveaxis(fields.slope[..., 1 - axis], axis, 0)
        along = (height[(np.arange(512) + 1) % 512] - height) / spacing
        error = np.sqrt(np.mean((along - 0.5 * (slope + np.roll(slope, -1, 0))) ** 2, axis=1))
        assert error[[-1, 0, -20]].max() < 1.2 * error[50:400].max(), name
        assert error[50:400].max() < 0.2 * np.std(slope)


def test_shares_within_the_border() -> None:
    """Squares add up to 1; before the border only what is there counts, at the side only what is before."""
    place = np.array([0.0, 70.0, 80.0, 87.3, 95.0, 99.9, 100.0])
    (here, here_slope, no_step), (before, before_slope, step) = border_shares(place, 100.0, 20.0)
    assert (no_step, step) == (0.0, 100.0)
    np.testing.assert_allclose(here**2 + before**2, 1.0)
    np.testing.assert_array_equal(before[:3], 0.0)
    np.testing.assert_allclose(here[-1], 0.0, atol=1e-12)
    ahead, behind = (border_shares(place + step, 100.0, 20.0) for step in (1e-5, -1e-5))
    for index, slope in enumerate((here_slope, before_slope)):
        difference = (ahead[index][0] - behind[index][0]) / 2e-5
        np.testing.assert_allclose(slope, difference, atol=1e-5)


def test_waves_that_the_grid_lacks_are_told_as_slopes() -> None:
    """Together with those that it holds they are all gravity waves."""
    sea = joined(256)
    held = Ocean(sea).statistics().resolved.mean_square_slope
    lacking = unresolved_slope_variance(sea)
    assert held + lacking == pytest.approx(total_slope_variance(APART.without_patches), rel=0.03)
    assert lacking > unresolved_slope_variance(joined(512)) > unresolved_slope_variance(APART)


def test_the_border_is_as_high_as_the_rest() -> None:
    """What the second patch has there: shares whose squares add up to 1 keep the variance."""
    inside, border = [], []
    for seed in range(40):
        sea = joined(128, seed=seed, choppiness=0.0)
        first = Ocean(sea.replace(patches=(dataclasses.replace(PATCHES[0], shortest_wavelength=20.0),)))
        height = (Ocean(sea).surface(0.0).displacement - first.surface(0.0).displacement)[..., 2]
        border.append(np.mean(height[INSIDE:] ** 2))
        inside.append(np.mean(height[:INSIDE] ** 2))
    assert np.mean(border) == pytest.approx(np.mean(inside), rel=0.06)


def test_the_variance_is_that_of_the_waves_that_it_holds() -> None:
    """Of many seeds; what bilinear reading loses of the second patch is a tenth at most."""
    wanted, found = 0.0, 0.0
    for seed in range(12):
        sea = joined(128, seed=seed, choppiness=0.0)
        statistics = Ocean(sea).statistics()
        wanted += statistics.seed.m0
        found += float(np.var(Ocean(sea).surface(0.0).displacement[..., 2]))
    assert found == pytest.approx(wanted, rel=0.02)
    whole = Ocean(APART).statistics().resolved.m0
    assert statistics.resolved.m0 < whole


def test_one_patch_joined_is_that_patch() -> None:
    sea = joined(32)
    (first,) = merged_bands(sea).patches
    alone = Ocean(sea.replace(merged_resolution=0, patches=(first,)))
    np.testing.assert_array_equal(Ocean(sea).surface(1.0).displacement, alone.surface(1.0).displacement)


def test_a_first_patch_may_be_turned() -> None:
    turned = (dataclasses.replace(PATCHES[0], rotation=0.3), *PATCHES[1:])
    sea = OceanParameters(seed=3, layers=(LAYER,), patches=turned).on_one_grid(64)
    found = Ocean(sea).surface(2.0).displacement
    along = 600.0 / 64 * np.arange(57)  # before the border of a tenth of the side
    there = Ocean(merged_bands(sea)).surface(2.0, on=Places(along, along[:, np.newaxis])).displacement
    np.testing.assert_allclose(found[:57, :57], there, atol=3e-5)


def test_strains_are_as_large_as_the_foam_takes_them_for() -> None:
    """Mean squares over the grid; those of the second patch, read between its samples, make the most."""
    found, wanted = np.zeros(3), np.zeros(3)
    for seed in range(10):
        sea = joined(128, seed=seed)
        found += np.mean(Ocean(sea).surface(0.0, {"strain"}).strain.astype(float) ** 2, axis=(0, 1))
        waves = [PartWaves(part, 600.0, "single", None) for part in parts(merged_bands(sea))]
        wanted += np.diag(strain_covariances(waves, (0.0, 0.0))[0])
    np.testing.assert_allclose(found, wanted, rtol=0.02)


def test_foam_covers_as_much_as_at_sea() -> None:
    sea = OceanParameters(
        seed=3, layers=(WaveLayer(wind_speed=16.0, fetch=200e3),), patches=PATCHES, foam=Foam(half_life=0.0)
    ).on_one_grid(160)
    shares = []
    for seed in range(4):
        fields = Ocean(sea.replace(seed=seed)).surface(50.0, {"foam", "jacobian"})
        shares.append(np.mean(fields.foam * fields.jacobian))
    # 4.82e-6 · 17.98³
    assert np.mean(shares) == pytest.approx(0.02802, rel=0.25)


def test_foam_of_a_frame_alone_is_that_of_a_sequence() -> None:
    sea = joined(64, foam=Foam(half_life=0.5))
    one = Ocean(sea)
    for time in (1.0, 1.125, 1.5):
        in_sequence = one.surface(time, {"foam"}).foam
    np.testing.assert_array_equal(in_sequence, Ocean(sea).surface(1.5, {"foam"}).foam)


def test_the_height_above_a_place_is_that_of_the_mesh() -> None:
    sea = Ocean(joined(96), "double")
    moved = sea.surface(2.0).displacement[10:80:13, 9:80:11].reshape(-1, 3)
    rest = 600.0 / 96 * np.stack(np.meshgrid(np.arange(9, 80, 11), np.arange(10, 80, 13)), axis=-1)
    x, y = (rest.reshape(-1, 2) + moved[:, :2]).T
    np.testing.assert_allclose(sea.height_at(x, y, 2.0), moved[:, 2], atol=1e-4)
    exact = sea.points_at(x, y, 2.0, surface="exact")
    assert np.abs(exact.height - moved[:, 2]).max() < 0.1 * np.std(moved[:, 2])


def test_a_shot_is_joined_like_its_sea() -> None:
    shot = Shot(joined(64))
    (fields,) = ShotSeas(shot).frames(5, {"displacement", "foam"})
    there = Ocean(shot.at(5).parameters).surface(shot.at(5).time, {"displacement", "foam"})
    np.testing.assert_array_equal(fields.displacement, there.displacement)
    np.testing.assert_array_equal(fields.foam, there.foam)


@pytest.mark.parametrize(("samples", "patches"), [(15, PATCHES), (33, PATCHES), (64, ())])
def test_what_cannot_be_merged_is_refused(samples: int, patches: tuple[Patch, ...]) -> None:
    with pytest.raises(ParameterError, match=r"^merged_resolution"):
        OceanParameters(patches=patches, merged_resolution=samples)


def test_joined_patches_are_one_sea_of_several_sums() -> None:
    sea = Ocean(joined(64))
    assert sea.patches == (sea,)
    with pytest.raises(ValueError, match="is several sums of waves, or has masks"):
        sea.initial_state  # noqa: B018


def test_places_of_joined_patches_have_the_waves_that_the_grid_holds() -> None:
    x, y = GENERATOR.uniform(0.0, 600.0, (2, 50))
    found = Ocean(joined(128)).surface(4.0, on=Places(x, y)).displacement
    there = Ocean(merged_bands(joined(128))).surface(4.0, on=Places(x, y)).displacement
    np.testing.assert_array_equal(found, there)
    assert np.abs(found - Ocean(APART).surface(4.0, on=Places(x, y)).displacement).max() > 0.01


def test_memory_is_told() -> None:
    apart = memory_need(merged_bands(joined(256)), {"displacement"})
    together = memory_need(joined(256), {"displacement"})
    assert together.surface == apart.surface + 3 * 3 * 256**2 * 4
    MEMO.drop("places of tiles")
    Ocean(joined(256)).surface(0.0)
    kept = MEMO.report()["places of tiles"]  # where samples lie between those of other patches
    assert kept <= together.state - apart.state < 1.2 * kept
