# SPDX-License-Identifier: GPL-3.0-or-later
"""The inside of hulls of known shape: edges to a fraction of a texel, and what is inside and what is not."""

import numpy as np
import pytest

from ocean_tweak.core.sea.hull_plan import LEVELS, hull_plan

AROUND = np.linspace(0.0, 2.0 * np.pi, 97)[:-1]


def lathed(profile, closed=False):
    """Vertices and triangles of a solid of revolution; its profile is (radius, height) from the bottom up.

    closed : the last point of the profile joins the first
    """
    rings = [
        np.stack([r * np.cos(AROUND), r * np.sin(AROUND), np.full(len(AROUND), z)], axis=-1)
        for r, z in profile
    ]
    return lofted(rings, closed)


def lofted(rings, closed=False):
    count = len(rings[0])
    faces = []
    for first in range(len(rings) if closed else len(rings) - 1):
        second = (first + 1) % len(rings)
        for i in range(count):
            a, b = first * count + i, first * count + (i + 1) % count
            c, d = second * count + i, second * count + (i + 1) % count
            faces += [(a, b, d), (a, d, c)]
    return np.concatenate(rings), np.array(faces)


def box(low, high):
    corners = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    vertices = np.array(low) + corners * (np.array(high) - low)
    quads = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
    return vertices, np.array([part for a, b, c, d in quads for part in ((a, b, c), (a, c, d))])


def together(*solids):
    first, parts = 0, []
    for vertices, triangles in solids:
        parts.append(triangles + first)
        first += len(vertices)
    return np.concatenate([vertices for vertices, _ in solids]), np.concatenate(parts)


def distance(plan, places):
    """As the shader looks it up: linear along all axes, in the unit of the hull."""
    x, y, z = np.moveaxis(np.asarray(places, float), -1, 0)
    level = np.minimum((z - plan.low[2]) / plan.spacing, LEVELS - 1.0)
    k = np.clip(np.floor(level), 0, LEVELS - 2).astype(int)
    j, i = ((place - low) / plan.texel - 0.5 for place, low in ((x, plan.low[0]), (y, plan.low[1])))
    _, rows, columns = plan.distance.shape
    j, i = np.clip(j, 0, columns - 1.001), np.clip(i, 0, rows - 1.001)
    j0, i0 = j.astype(int), i.astype(int)
    total = 0.0
    for dk, wk in ((0, 1 - (level - k)), (1, level - k)):
        for di, wi in ((0, 1 - (i - i0)), (1, i - i0)):
            for dj, wj in ((0, 1 - (j - j0)), (1, j - j0)):
                total = total + wk * wi * wj * plan.distance[k + dk, i0 + di, j0 + dj]
    return np.where(z < plan.low[2], 1.0, total) * plan.texel


def is_inside(plan, *place):
    return bool(distance(plan, place) < 0.0)


def edge_error(plan, radius_at, heights):
    """Mean distance in texels of the plan's edge from a circle, along rays from the middle."""
    errors = []
    for z in heights:
        radius = radius_at(z)
        along = np.linspace(0.8 * radius, 1.2 * radius, 2001)
        for angle in np.linspace(0.0, 6.28, 41):
            places = np.stack([along * np.cos(angle), along * np.sin(angle), np.full(len(along), z)], axis=-1)
            found = along[np.argmax(distance(plan, places) >= 0.0)]
            # the polygon lies a little within the circle
            errors.append(abs(found - radius * np.cos(np.pi / 96)) / plan.texel)
    return np.mean(errors)


def test_the_edge_is_where_the_hull_is():
    straight = hull_plan(*lathed([(0.0, -1.0), (5.0, -1.0), (5.0, 2.0)]))
    assert edge_error(straight, lambda z: 5.0, [-0.6, 0.1, 1.2]) < 0.1
    flared = hull_plan(*lathed([(0.0, -1.0), (3.0, -1.0), (6.0, 2.0)]))
    assert edge_error(flared, lambda z: 4.0 + z, [-0.5, 0.03, 0.37, 1.4]) < 0.1


def test_ahead_of_a_sharp_bow_there_is_water():
    """Where the bow itself is nearest to both of its sides, of which one lies as if it were inside."""
    outline = np.array([(-4.0, -6.0), (4.0, 0.0), (-4.0, 6.0)])
    rings = [
        np.column_stack((size * outline, np.full(3, z))) for size, z in ((0.0, -1.0), (1.0, -1.0), (1.0, 2.0))
    ]
    plan = hull_plan(*lofted(rings))
    _, rows, columns = plan.distance.shape
    x, y = np.meshgrid(
        plan.low[0] + plan.texel * (np.arange(columns) + 0.5),
        plan.low[1] + plan.texel * (np.arange(rows) + 0.5),
    )
    # beyond or within each of the three sides by a texel
    beyond = np.maximum(0.8 * np.abs(y) + 0.6 * (x - 4.0), -4.0 - x)
    assert np.all(plan.distance[LEVELS // 2][beyond > plan.texel] > 0.0)
    assert np.all(plan.distance[LEVELS // 2][beyond < -plan.texel] < 0.0)


def test_an_open_boat_is_dry_up_to_its_rim_and_above():
    boat = hull_plan(*lathed([(0.0, -1.0), (3.0, -1.0), (4.0, 1.0)]))
    assert is_inside(boat, 0.0, 0.0, 0.0)
    assert is_inside(boat, 3.2, 0.0, 0.0)
    assert not is_inside(boat, 3.8, 0.0, 0.0)
    assert not is_inside(boat, 0.0, 0.0, -1.1)  # beneath its bottom
    assert is_inside(boat, 2.0, 1.0, 1.4)  # a wave higher than its rim
    assert is_inside(boat, 2.0, 1.0, 9.0)
    assert not is_inside(boat, 4.6, 0.0, 9.0)


@pytest.mark.parametrize("thickness", [0.02, 0.3])
def test_an_open_boat_with_thick_sides_is_dry(thickness):
    profile = [
        (0.0, -1.0),
        (4.0, -1.0),
        (4.0, 1.0),
        (4.0 - thickness, 1.0),
        (4.0 - thickness, -0.8),
        (0.0, -0.8),
    ]
    boat = hull_plan(*lathed(profile))
    for z in (-0.5, 0.5, 1.5):
        assert is_inside(boat, 0.0, 0.0, z)
        assert is_inside(boat, 3.0, 1.0, z)
    assert not is_inside(boat, 4.2, 0.0, 0.5)
    # the edge is at the outer side, or within the plank
    edge = np.linspace(3.5, 4.5, 1001)
    found = edge[np.argmax(distance(boat, np.stack([edge, 0 * edge, 0 * edge + 0.2], axis=-1)) > 0.0)]
    assert 4.0 - max(0.2 * boat.texel, thickness) <= found <= 4.0 + 0.2 * boat.texel


def test_a_decked_ship_has_water_on_its_deck():
    ship = hull_plan(*box((-10.0, -2.0, -1.0), (10.0, 2.0, 1.0)))
    assert is_inside(ship, 9.0, 0.0, 0.5)
    assert not is_inside(ship, 0.0, 0.0, 1.3)
    assert not is_inside(ship, 10.2, 0.0, 0.5)


def test_masts_do_not_take_levels_from_the_hull():
    ship = box((-10.0, -2.0, -1.0), (10.0, 2.0, 1.0))
    mast = box((-0.4, -0.4, 0.0), (0.4, 0.4, 20.0))
    assert hull_plan(*together(ship, mast)).spacing < 0.12


def test_between_two_hulls_in_a_ring_and_beneath_a_capsized_boat_there_is_water():
    two = hull_plan(
        *together(box((-5.0, -3.0, -1.0), (5.0, -2.0, 1.0)), box((-5.0, 2.0, -1.0), (5.0, 3.0, 1.0)))
    )
    assert is_inside(two, 0.0, 2.5, 0.0)
    assert not is_inside(two, 0.0, 0.0, 0.0)
    tube = np.linspace(0.0, 2.0 * np.pi, 25)[:-1]
    ring = hull_plan(*lathed([(3.0 + np.cos(a), np.sin(a)) for a in tube], closed=True))
    assert is_inside(ring, 3.0, 0.0, 0.0)
    assert not is_inside(ring, 0.0, 0.0, 0.0)
    capsized = hull_plan(
        *together(lathed([(4.0, -1.0), (3.0, 1.0), (0.0, 1.0)]), box((5, -1, -1), (7, 1, 1)))
    )
    assert not is_inside(capsized, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("turn", [0.0, 0.5 * np.pi])
def test_in_a_dock_that_is_open_at_one_end_there_is_water(turn):
    """Though it has a floor below, and sides all around but there: to +x, and turned, to +y."""
    floor = box((-5.0, -3.0, -1.0), (5.0, 3.0, -0.8))
    sides = [box((-5.0, low, -1.0), (5.0, low + 0.4, 1.0)) for low in (-3.0, 2.6)]
    vertices, triangles = together(floor, *sides, box((-5.0, -3.0, -1.0), (-4.6, 3.0, 1.0)))
    c, s = np.cos(turn), np.sin(turn)
    plan = hull_plan(vertices @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]), triangles)
    assert not is_inside(plan, 0.0, 0.0, 0.2)
    assert is_inside(plan, -2.8 * s, 2.8 * c, 0.2)  # within a side


def test_a_fin_without_thickness_cuts_nothing():
    ship = box((-5.0, -2.0, -1.0), (5.0, 2.0, 1.0))
    fin = np.array([(-7.0, 0.0, -1.0), (-5.0, 0.0, -1.0), (-5.0, 0.0, 0.5)]), np.array([(0, 1, 2)])
    assert not is_inside(hull_plan(*together(ship, fin)), -6.0, 0.0, -0.8)


def test_turning_faces_around_changes_nothing():
    vertices, triangles = lathed([(0.0, -1.0), (3.0, -1.0), (4.0, 1.0)])
    there, back = hull_plan(vertices, triangles), hull_plan(vertices, triangles[:, ::-1])
    np.testing.assert_allclose(there.distance, back.distance, atol=1e-5)


@pytest.mark.parametrize("solid", ["plane", "wall", "pipe"])
def test_what_encloses_nothing_is_refused(solid):
    square = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    flat = np.pad(square, ((0, 0), (0, 1)))
    quad = np.array([(0, 1, 2), (0, 2, 3)])
    hulls = {
        "plane": (flat, quad),
        "wall": (flat[:, [0, 2, 1]], quad),
        "pipe": lathed([(2.0, -1.0), (2.0, 1.0)]),
    }
    with pytest.raises(ValueError, match="encloses nothing"):
        hull_plan(*hulls[solid])


def test_an_open_boat_is_dry_beside_a_house_that_is_higher_than_its_rim():
    """At all levels above its rim up to the top of the house, and beyond."""
    boat = lofted(
        [np.array([(-x, -y, z), (x, -y, z), (x, y, z), (-x, y, z)])
         for x, y, z in ((0.0, 0.0, -1.0), (8.0, 3.0, -1.0), (8.0, 3.0, 1.0))]
    )  # fmt: skip
    plan = hull_plan(*together(boat, box((4.0, -2.9, -0.9), (7.9, 2.9, 4.0))))
    for z in (0.5, 1.3, 2.0, 3.0, 3.9):
        assert is_inside(plan, -3.0, 0.0, z), z
        assert is_inside(plan, -7.0, 2.0, z), z
        assert not is_inside(plan, -3.0, 3.5, z), z


def test_a_house_on_deck_that_narrows_is_known_to_its_top():
    """Of a third of the hull's area at its foot: what is above that is not taken for a mast."""
    hull = box((-10.0, -3.0, -2.0), (10.0, 3.0, 1.0))
    house = lofted(
        [np.array([(-x, -y, z), (x, -y, z), (x, y, z), (-x, y, z)])
         for x, y, z in ((0.0, 0.0, 1.0), (5.0, 2.5, 1.0), (2.5, 1.25, 5.0), (0.0, 0.0, 5.0))]
    )  # fmt: skip
    plan = hull_plan(*together(hull, house))
    assert is_inside(plan, 4.5, 0.0, 1.2)
    for x, z in ((4.0, 3.5), (3.0, 4.7)):  # beside the house
        assert not is_inside(plan, x, 0.0, z)
        assert is_inside(plan, x - 2.0, 0.0, z)
