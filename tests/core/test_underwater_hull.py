# SPDX-License-Identifier: GPL-3.0-or-later
"""What hulls of known volume displace, and where."""

import numpy as np
import pytest

from ocean_tweak.core.sea.hull_plan import hull_plan
from ocean_tweak.core.sea.underwater_hull import draughts_below

from .test_hull_plan import box, lathed, together

SHAPE = (24, 64)


def draughts(solid, *levels):
    """(draughts, volume) at each level."""
    vertices, triangles = solid
    low, high = vertices.min(axis=0)[:2], vertices.max(axis=0)[:2]
    plan = hull_plan(vertices, triangles)
    found = [draughts_below(plan, level, tuple(low), tuple(high), SHAPE) for level in levels]
    return [(each, float(each.mean() * np.prod(high - low))) for each in found]


def ellipsoid_bowl(thick=0.0):
    """Below z = 0 half an ellipsoid of 20 by 5 by 2 m, and sides of 1 m above, open; thick in shares."""
    angle = np.linspace(0.0, 0.5 * np.pi, 25)
    profile = [(np.sin(a), -2.0 * np.cos(a)) for a in angle] + [(1.0, 1.0)]
    profile[0] = (1e-6, -2.0)
    if thick:
        within = [((1.0 - thick) * r, (1.0 - thick) * z if z < 0.0 else z) for r, z in profile]
        profile += within[::-1]
    vertices, triangles = lathed(profile, closed=bool(thick))
    return vertices * (10.0, 2.5, 1.0), triangles


def test_a_box_displaces_its_part_below_the_water():
    """20 by 4 m, from 1.5 m below its origin: as deep everywhere."""
    levels = (-0.6, 0.0, 0.7)
    told = draughts(box((-10.0, -2.0, -1.5), (10.0, 2.0, 2.0)), *levels)
    for level, (found, volume) in zip(levels, told, strict=True):
        assert volume == pytest.approx(20.0 * 4.0 * (level + 1.5), rel=0.03)
        np.testing.assert_allclose(found[2:-2, 2:-2], level + 1.5, rtol=0.03)


@pytest.mark.parametrize("thick", [0.0, 0.1])
def test_an_open_boat_displaces_its_hold_too(thick):
    """Half an ellipsoid: 2/3 π abc, and c √(1 - r²) deep, whether its planking is a sheet or thick."""
    [(found, volume)] = draughts(ellipsoid_bowl(thick), 0.0)
    assert volume == pytest.approx(2.0 / 3.0 * np.pi * 10.0 * 2.5 * 2.0, rel=0.03)
    y, x = (((np.arange(count) + 0.5) * 2.0 / count - 1.0) for count in SHAPE)
    r = np.hypot(x, y[:, np.newaxis])
    expected = 2.0 * np.sqrt(np.maximum(1.0 - r * r, 0.0))
    assert np.abs(found - expected)[r < 0.85].mean() < 0.04
    assert found[r > 1.05].max() < 0.05


def test_a_catamaran_is_two_hulls():
    """Of 20 by 1 by 1 m, 4 m apart: water between them."""
    hulls = together(box((-10.0, -3.0, -1.0), (10.0, -2.0, 1.0)), box((-10.0, 2.0, -1.0), (10.0, 3.0, 1.0)))
    deck = together(hulls, box((-5.0, -3.0, 1.0), (5.0, 3.0, 1.2)))
    [(found, volume)] = draughts(deck, 0.0)
    assert volume == pytest.approx(2.0 * 20.0, rel=0.05)
    across = found.mean(axis=1)
    assert across[5:19].max() < 0.02
    np.testing.assert_allclose(across[[1, 2, -3, -2]], 1.0, atol=0.06)


def test_a_rectangle_may_hold_a_part_of_it():
    """The quarter around a corner has a quarter of the volume, whatever its cells."""
    vertices, triangles = box((-10.0, -2.0, -1.0), (10.0, 2.0, 1.0))
    found = draughts_below(hull_plan(vertices, triangles), 0.0, (0.0, 0.0), (20.0, 9.0), (7, 5))
    assert found.mean() * 20.0 * 9.0 == pytest.approx(20.0, rel=0.03)
    assert found[5:].max() == found[:, 3:].max() == 0.0
