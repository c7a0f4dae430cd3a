# SPDX-License-Identifier: GPL-3.0-or-later
"""A patch more or less: the bands still join, and hold what they held before."""

from itertools import pairwise

import pytest

from ocean_tweak.core import Ocean, OceanParameters, ParameterError, Patch, WaveLayer
from ocean_tweak.core.sea.patch_editing import with_another_patch, without_patch

LAYER = WaveLayer(wind_speed=11.0, fetch=80e3)
ONE = OceanParameters(domain_size=300.0, resolution=128, layers=(LAYER,))
THREE = ONE.replace(
    patches=(
        Patch(domain_size=600.0, shortest_wavelength=20.0, resolution=256),
        Patch(151.0, 0.97, 4.0, 20.0, 256),
        Patch(33.0, 0.37, 0.6, 4.0, 256),
    )
)


def check_new(patch: Patch, before: tuple[Patch, ...]) -> None:
    """What a plan keeps: 4 samples along the shortest wave, 6 of the longest along a side."""
    assert patch.shortest_wavelength * patch.resolution / patch.domain_size >= 4.0
    assert patch.domain_size / patch.longest_wavelength >= 6.0
    assert min(abs(patch.rotation - other.rotation) for other in before) > 0.1
    ratios = [other.domain_size / patch.domain_size for other in before]
    assert all(abs(ratio - round(ratio)) > 0.02 for ratio in ratios)


def test_the_first_one_added_holds_what_the_grid_did_not() -> None:
    sea = with_another_patch(ONE)
    first, second = sea.patches
    assert (first.domain_size, first.resolution, first.rotation) == (300.0, 128, 0.0)
    assert first.longest_wavelength == 1e6
    # four samples of 300/128 m, and not much more
    assert 4.0 * 300.0 / 128 <= first.shortest_wavelength < 4.5 * 300.0 / 128
    assert second.shortest_wavelength < 0.6 * second.longest_wavelength
    check_new(second, (first,))


def test_a_band_is_shared_by_octaves() -> None:
    sea = with_another_patch(THREE)
    assert sea.patches[:2] == THREE.patches[:2]
    shared, added = sea.patches[2:]
    # √(0.6 · 4) m
    assert shared.shortest_wavelength == pytest.approx(1.549, abs=0.002)
    assert (shared.longest_wavelength, added.shortest_wavelength) == (4.0, 0.6)
    assert (shared.domain_size, shared.resolution) == (33.0, 256)
    check_new(added, sea.patches[:3])


def test_of_the_first_only_waves_that_may_repeat_are_taken() -> None:
    sea = with_another_patch(ONE.replace(patches=(Patch(1000.0, 0.0, 5.0, 1e6, 1024),)))
    # half of its octaves would be √(5 · 1000) = 71 m, about its peak
    assert 10.0 <= sea.patches[0].shortest_wavelength < 40.0
    found = Ocean(sea).statistics()
    assert 0.05 < found.patches[1].share < 0.12


@pytest.mark.parametrize("resolution", [16, 64, 128, 512])
def test_one_after_the_other_up_to_four(resolution: int) -> None:
    sea = ONE.replace(resolution=resolution)
    for count in (2, 3, 4):
        sea = with_another_patch(sea)
        assert len(sea.patches) == count
        for longer, shorter in pairwise(sea.patches):
            assert longer.shortest_wavelength == shorter.longest_wavelength
        check_new(sea.patches[-1], sea.patches[:-1])
    with pytest.raises(ParameterError, match="as many as there can be: 4"):
        with_another_patch(sea)


def test_behind_a_narrow_band_it_goes_on_with_shorter_waves() -> None:
    narrow = ONE.replace(patches=(THREE.patches[0], Patch(151.0, 0.97, 10.0, 20.0, 256)))
    sea = with_another_patch(narrow)
    assert sea.patches[:2] == narrow.patches
    assert sea.patches[2].longest_wavelength == 10.0
    assert sea.patches[2].shortest_wavelength < 5.0
    check_new(sea.patches[2], narrow.patches)
    wide = ONE.replace(patches=(THREE.patches[0], Patch(151.0, 0.97, 5.0, 20.0, 256)))
    assert with_another_patch(wide).patches[1].shortest_wavelength == pytest.approx(10.0)


def test_a_flat_sea_has_room_too() -> None:
    flat = ONE.replace(layers=(WaveLayer(muted=True),))
    assert len(with_another_patch(with_another_patch(flat)).patches) == 3


def test_trough_damping_is_refused_as_in_any_sea_of_patches() -> None:
    with pytest.raises(ParameterError, match="trough_damping"):
        with_another_patch(ONE.replace(trough_damping=0.5))


@pytest.mark.parametrize(
    ("gone", "bands"),
    [(0, [(4.0, 1e6), (0.6, 4.0)]), (1, [(4.0, 1e6), (0.6, 4.0)]), (2, [(20.0, 1e6), (0.6, 20.0)])],
)
def test_the_neighbour_takes_over(gone: int, bands: list[tuple[float, float]]) -> None:
    sea = without_patch(THREE, gone)
    assert [(patch.shortest_wavelength, patch.longest_wavelength) for patch in sea.patches] == bands
    sizes = [patch.domain_size for patch in THREE.patches]
    assert [patch.domain_size for patch in sea.patches] == sizes[:gone] + sizes[gone + 1 :]
    assert sea.patches[0].rotation == 0.0


def test_the_last_one_that_goes_leaves_one_sea() -> None:
    sea = THREE
    for _ in range(3):
        sea = without_patch(sea, 0)
    assert sea.patches == ()
    assert (sea.domain_size, sea.resolution) == (33.0, 256)
