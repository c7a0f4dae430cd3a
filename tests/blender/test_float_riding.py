# SPDX-License-Identifier: GPL-3.0-or-later
"""Boats that ride damped: as the core has it, from any frame alone, and on the surface where none solves."""

import math
from fractions import Fraction

import bpy
import numpy as np
import pytest
from mathutils import Vector

from . import floats

# fixtures for every test here
select, ocean = floats.select, floats.ocean
PLACE, TURN = (25.0, 40.0), 0.5
LENGTH, BEAM, HEIGHT = 12.0, 4.0, 3.0
PERIOD, ROLL_PERIOD = 2.5, 4.0


@pytest.fixture
def boat(empty_scene):
    """A box that lies along its y axis."""
    mesh = bpy.data.meshes.new("Boat")
    corners = [
        (x * BEAM / 2, y * LENGTH / 2, z * HEIGHT / 2) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)
    ]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh.from_pydata(corners, [], faces)
    item = bpy.data.objects.new("Boat", mesh)
    item.location, item.rotation_euler.z = (*PLACE, 9.0), TURN
    empty_scene.collection.objects.link(item)
    bpy.context.view_layer.update()
    return item


@pytest.fixture
def set_ride(extension):
    def change(item, **values):
        carriers, inputs = extension("scene.float_carrier"), extension("nodes.modifier_inputs")
        modifier = carriers.modifier_of(carriers.carrier_of(item))
        inputs.set_inputs(modifier, {name.replace("_", " ").title(): each for name, each in values.items()})
        carriers.carrier_of(item).update_tag()
        bpy.context.view_layer.update()

    return change


@pytest.fixture
def afloat(boat, ocean, select, set_ride):
    """The boat, riding damped with short memory, so that tests are quick."""
    select(boat)
    assert bpy.ops.object.ocean_tweak_float(riding="DAMPED", use_contact=False) == {"FINISHED"}
    set_ride(
        boat, heave_period=PERIOD, pitch_period=PERIOD, roll_period=ROLL_PERIOD, damping=0.4, roll_damping=0.4
    )
    return boat


@pytest.fixture
def queries(extension, monkeypatch):
    """The moments for which the water was asked."""
    water, asked = extension("core.sea.felt_water"), []
    of_sea = water.FeltWater._new

    def counted(self, time, place):
        asked.append((time, place))
        return of_sea(self, time, place)

    monkeypatch.setattr(water.FeltWater, "_new", counted)
    return asked


def expected(extension, core, ocean, parameters, frame, heading, aside_periods=()):
    """Location and up of the boat: by a loop over moments, with all waves of the sea."""
    riding, waterline = extension("core.sea.riding"), extension("core.sea.waterline")
    sea, now = core.Ocean(parameters), Fraction(frame - 1, 24)
    matrix = np.array(ocean.matrix_world)
    to_ocean = np.linalg.inv(matrix)
    middle = (to_ocean @ [*PLACE, 0.0, 1.0])[:2]
    ahead = to_ocean[:2, :2] @ [math.cos(heading), math.sin(heading)]
    aside = np.array([-ahead[1], ahead[0]])
    offsets = waterline.stencil() * [LENGTH / 2, BEAM / 2]
    x, y = (middle + offsets[:, :1] * ahead + offsets[:, 1:] * aside).T
    modes = tuple(riding.Oscillator(period, 0.4) for period in (PERIOD, PERIOD, ROLL_PERIOD))
    found = []
    for number, mode in enumerate(modes):
        known = riding.moments(now, mode)
        water = [
            waterline.fitted_plane(sea.height_at(x, y, time), (LENGTH / 2, BEAM / 2))[number]
            for time in known.times
        ]
        found.append(riding.ride(np.array(water), known, now, mode))
    height, along, across = found
    slope = along * ahead + across * aside
    for period, way in zip(aside_periods, (ahead, aside), strict=False):
        mode = riding.Oscillator(period, 0.4)
        known = riding.moments(now, mode)
        gone = [
            sea.surface(time, {"displacement"}, on=core.Places(x, y)).displacement[:, :2].mean(axis=0) @ way
            for time in known.times
        ]
        middle = middle + riding.ride(np.array(gone), known, now, mode) * way
    return matrix @ [*middle, height, 1.0], matrix[:3, :3] @ [-slope[0], -slope[1], 1.0]


def test_it_rides_as_the_core_has_it(extension, afloat, ocean, core, make_parameters, empty_scene):
    tilts = []
    for frame in (1, 13, 30):
        empty_scene.frame_set(frame)
        point, up = expected(extension, core, ocean, make_parameters(), frame, TURN + math.pi / 2)
        place = np.array(afloat.matrix_world)
        # a third of the beam deep: its lowest point is half its height below the origin
        level = point[2] - BEAM / 3.0 + HEIGHT / 2.0
        np.testing.assert_allclose(place[:3, 3], [*point[:2], level], atol=0.02)
        assert math.degrees(Vector(place[:3, 2]).angle(Vector(up))) < 0.5
        tilts.append(math.degrees(Vector(up).angle((0.0, 0.0, 1.0))))
    assert max(tilts) > 2.0


def test_with_a_period_it_surges_and_sways_about_its_place(
    extension, afloat, ocean, core, make_parameters, empty_scene, set_ride, select
):
    """As the same oscillators, forced by how far the water under it has gone; baked too."""
    set_ride(afloat, surge_period=3.0, sway_period=5.0)
    ways, live = [], []
    for frame in (1, 13, 30):
        empty_scene.frame_set(frame)
        turn = TURN + math.pi / 2
        point, _ = expected(extension, core, ocean, make_parameters(), frame, turn, (3.0, 5.0))
        still, _ = expected(extension, core, ocean, make_parameters(), frame, turn)
        place = np.array(afloat.matrix_world)
        np.testing.assert_allclose(place[:2, 3], point[:2], atol=0.01)
        assert place[2, 3] == pytest.approx(still[2] - BEAM / 3.0 + HEIGHT / 2.0, abs=0.02)
        ways.append(math.dist(point[:2], still[:2]))
        live.append(place)
    assert max(ways) > 0.1
    select(afloat)
    assert bpy.ops.object.ocean_tweak_float_bake(frame_start=30, frame_end=30) == {"FINISHED"}
    empty_scene.frame_set(30)
    np.testing.assert_allclose(np.array(afloat.matrix_world), live[-1], atol=0.02)


def test_any_frame_alone_is_the_same(extension, afloat, empty_scene):
    def at(frame, subframe=0.0):
        empty_scene.frame_set(frame, subframe=subframe)
        return np.array(afloat.matrix_world).tobytes()

    frames = [(1, 0.0), (2, 0.0), (2, 0.25), (17, 0.0), (40, 0.5)]
    forth = [at(*frame) for frame in frames]
    extension("core.numerics.memo").MEMO.drop()
    extension("scene.float_riding").forget_all()
    assert [at(*frame) for frame in reversed(frames)] == forth[::-1]
    assert len(set(forth)) == len(forth)


def test_a_frame_more_asks_for_one_moment_a_step_or_none(extension, afloat, empty_scene, queries):
    riding = extension("core.sea.riding")
    steps = {
        riding.moments(Fraction(0), riding.Oscillator(period, 0.4)).step for period in (PERIOD, ROLL_PERIOD)
    }
    empty_scene.frame_set(10)
    queries.clear()
    for frame in range(11, 35):  # a second
        before = len(queries)
        empty_scene.frame_set(frame)
        assert len(queries) - before <= len(steps)
    # what one mode asked for, the others know
    assert 0 < len(queries) <= 1.0 / min(steps) + 1


def test_moved_by_hand_it_rides_there_and_inertia_differs_from_the_surface(
    afloat, ocean, set_ride, empty_scene, queries
):
    empty_scene.frame_set(12)
    here = afloat.matrix_world.copy()
    queries.clear()
    afloat.location.x += 30.0
    bpy.context.view_layer.update()
    bpy.context.view_layer.update()
    assert queries
    assert afloat.matrix_world.translation.x == pytest.approx(here.translation.x + 30.0, abs=1e-3)
    assert abs(afloat.matrix_world.translation.z - here.translation.z) > 1e-2
    afloat.location.x -= 30.0
    bpy.context.view_layer.update()
    bpy.context.view_layer.update()
    assert afloat.matrix_world == here
    set_ride(afloat, damped=False)
    assert (afloat.matrix_world.translation - here.translation).length > 1e-2


def test_where_nobody_solves_it_follows_the_surface(extension, afloat, set_ride, empty_scene):
    def at(frame):
        empty_scene.frame_set(frame)
        bpy.context.view_layer.update()
        return np.array(afloat.matrix_world)

    with extension("scene.handlers").asleep():
        alone = at(20)
    set_ride(afloat, damped=False)
    with extension("scene.handlers").asleep():
        at(1)
        np.testing.assert_array_equal(at(20), alone)


def test_a_bake_is_what_it_was_live(afloat, select, empty_scene):
    """On its way under sail: keyed, turning, in tow."""
    parent = bpy.data.objects.new("Tow", None)
    parent.rotation_euler.z = 0.2
    empty_scene.collection.objects.link(parent)
    afloat.parent = parent
    for frame, x, turn in ((1, 20.0, 0.0), (20, 60.0, 0.7)):
        afloat.location.x, afloat.rotation_euler.z = x, turn
        afloat.keyframe_insert("location", frame=frame)
        afloat.keyframe_insert("rotation_euler", frame=frame)
    live = {}
    for frame in (1, 9, 20):
        empty_scene.frame_set(frame)
        live[frame] = np.array(afloat.matrix_world)
    select(afloat)
    assert bpy.ops.object.ocean_tweak_float_bake(frame_end=20) == {"FINISHED"}
    for frame, matrix in live.items():
        empty_scene.frame_set(frame)
        np.testing.assert_allclose(afloat.matrix_world, matrix, atol=1e-3)


def test_keys_tell_where_it_was(extension, boat, empty_scene):
    path = extension("scene.float_path")
    parent = bpy.data.objects.new("Tow", None)
    empty_scene.collection.objects.link(parent)
    parent.delta_location.z, parent.delta_rotation_euler.x, parent.scale = 3.0, 0.2, (2.0, 2.0, 2.0)
    boat.parent, boat.rotation_mode = parent, "QUATERNION"
    for frame, turn in ((1, 0.0), (25, 1.0)):
        parent.rotation_euler.z, boat.location.y = turn, 10.0 * turn
        boat.rotation_quaternion = (math.cos(turn), 0.0, math.sin(turn), 0.0)
        parent.keyframe_insert("rotation_euler", frame=frame)
        boat.keyframe_insert("location", frame=frame)
        boat.keyframe_insert("rotation_quaternion", frame=frame)
    assert path.is_known(boat)
    for frame in (1, 7, 25):
        empty_scene.frame_set(frame)
        there = np.array(boat.matrix_world)
        empty_scene.frame_set(40)
        np.testing.assert_allclose(path.matrix_at(boat, frame), there, atol=1e-5)
    boat.constraints.new("COPY_LOCATION")
    assert not path.is_known(boat)


def test_what_a_constraint_moves_rides_as_what_keys_move(extension, boat, ocean, select, empty_scene):
    """Its past is recorded by the press; moved elsewhere since, it is taken as if it had stood there."""
    keyed = boat.copy()
    empty_scene.collection.objects.link(keyed)
    guide = bpy.data.objects.new("Guide", None)
    empty_scene.collection.objects.link(guide)
    empty_scene.frame_end = 40
    for frame, x in ((1, 20.0), (40, 90.0)):
        for each in (guide, keyed):
            each.location = (x, PLACE[1], 0.0)
            each.keyframe_insert("location", frame=frame)
    constraint = boat.constraints.new("COPY_LOCATION")
    constraint.target = guide
    for item in (boat, keyed):
        select(item)
        assert bpy.ops.object.ocean_tweak_float(riding="DAMPED", use_contact=False) == {"FINISHED"}
    apart = []
    for frame in (9, 25, 40):
        empty_scene.frame_set(frame)
        bpy.context.view_layer.update()
        np.testing.assert_allclose(np.array(boat.matrix_world), np.array(keyed.matrix_world), atol=2e-3)
        apart.append(boat.matrix_world.translation.z)
    carrier = extension("scene.float_carrier").carrier_of(boat)
    assert "recorded" in extension("scene.float_riding").why_not(carrier)
    guide.delta_location.y = 30.0
    empty_scene.frame_set(24)
    empty_scene.frame_set(25)
    bpy.context.view_layer.update()
    moved = np.array(boat.matrix_world)
    assert moved[1, 3] == pytest.approx(PLACE[1] + 30.0, abs=0.1)
    del carrier["ocean_tweak_past"]
    empty_scene.frame_set(24)
    empty_scene.frame_set(25)
    np.testing.assert_allclose(np.array(boat.matrix_world), moved, atol=1e-4)


def test_on_a_baked_ocean_keys_ride_damped_and_live_it_follows_the_surface(
    extension, ocean_object, bake, boat, select, make_parameters, empty_scene
):
    ocean_object.add(empty_scene, make_parameters(), "NODES", "SEQUENCE", bake(make_parameters(), 1, 12))
    select(boat)
    bpy.ops.object.ocean_tweak_float(riding="DAMPED", use_contact=False)
    carrier = extension("scene.float_carrier").carrier_of(boat)
    assert "Bake to Keyframes" in extension("scene.float_riding").why_not(carrier)
    surface = {}
    for frame in (1, 12):
        empty_scene.frame_set(frame)
        surface[frame] = boat.matrix_world.translation.z
    assert bpy.ops.object.ocean_tweak_float_bake(frame_start=1, frame_end=12) == {"FINISHED"}
    heights = []
    for frame in range(1, 13):
        empty_scene.frame_set(frame)
        heights.append(boat.matrix_world.translation.z)
    assert heights[0] == pytest.approx(surface[1], abs=0.3)  # at rest on the water; disc and ellipse differ
    assert abs(heights[-1] - surface[12]) > 0.02
    assert np.abs(np.diff(heights, 2)).max() < 0.05


def test_of_no_size_it_follows_the_surface_and_the_panel_says_so(
    extension, ocean, select, empty_scene, core, make_parameters
):
    item = bpy.data.objects.new("Buoy", None)
    item.location = (25.0, 40.0, 9.0)
    empty_scene.collection.objects.link(item)
    select(item)
    bpy.ops.object.ocean_tweak_float(riding="DAMPED")
    carrier = extension("scene.float_carrier").carrier_of(item)
    extension("nodes.modifier_inputs").set_input(
        extension("scene.float_carrier").modifier_of(carrier), "Damped", True
    )
    empty_scene.frame_set(4)
    floats.assert_rides(item, core, ocean, make_parameters(resolution=16), 4)
    assert "Waterline" in extension("scene.float_riding").why_not(carrier)


def test_defaults_are_those_of_the_hull(extension, afloat):
    floating = extension("scene.floating")
    _, ride = floating.ride_of(floating.carrier_of(afloat))
    assert ride.damped
    assert ride.along_y
    assert ride.waterline == pytest.approx(LENGTH)
    assert ride.beam == pytest.approx(BEAM)
    assert ride.draft == pytest.approx(BEAM / 3.0)
    assert ride.tilt == 1.0
