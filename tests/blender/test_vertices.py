# SPDX-License-Identifier: GPL-3.0-or-later
"""Every way to move the mesh puts each vertex where the core's surface is."""

import itertools

import bpy
import numpy as np
import pytest

from .conftest import DOMAIN, SAMPLES

TOLERANCE = 1e-4  # m
METHODS = ("NODES", "DISPLACE")
SOURCES = ("LIVE", "SEQUENCE")
WAYS = tuple(itertools.product(METHODS, SOURCES))


@pytest.fixture
def add(ocean_object, bake, empty_scene):
    """Add a sea by one of the ways; a sequence holds the 24 frames from the start frame on."""

    def add_ocean(parameters, method, source, **more):
        first = parameters.timing.start_frame
        sequence = bake(parameters, first, first + 23) if source == "SEQUENCE" else None
        return ocean_object.add(empty_scene, parameters, method, source, sequence, **more)

    return add_ocean


@pytest.mark.parametrize(("method", "source"), WAYS)
@pytest.mark.parametrize("first", [1, 1001])
@pytest.mark.parametrize("metres_per_unit", [1.0, 0.01])
def test_vertices_are_the_surface(
    add, make_parameters, expected, evaluated, empty_scene, method, source, first, metres_per_unit
):
    empty_scene.unit_settings.scale_length = metres_per_unit
    parameters = make_parameters(start_frame=first)
    item = add(parameters, method, source)
    for frame in (first, first + 1, first + 23):
        empty_scene.frame_set(frame)
        difference = evaluated(item) - expected(parameters, frame, metres_per_unit)
        assert np.abs(difference).max() * metres_per_unit < TOLERANCE


@pytest.mark.parametrize(("method", "source"), WAYS)
def test_edges_meet(add, make_parameters, evaluated, empty_scene, method, source):
    item = add(make_parameters(), method, source)
    empty_scene.frame_set(9)
    sea = evaluated(item)
    assert np.ptp(sea[..., 2]) > 0.5
    np.testing.assert_allclose(sea[:, -1], sea[:, 0] + (DOMAIN, 0, 0), atol=TOLERANCE)
    np.testing.assert_allclose(sea[-1], sea[0] + (0, DOMAIN, 0), atol=TOLERANCE)


@pytest.mark.parametrize("method", METHODS)
def test_finer_mesh_reads_between_samples(add, make_parameters, expected, evaluated, method):
    parameters = make_parameters()
    sea = evaluated(add(parameters, method, "LIVE", mesh_resolution=2 * SAMPLES))
    samples = expected(parameters, 1)
    np.testing.assert_allclose(sea[::2, ::2], samples, atol=TOLERANCE)
    np.testing.assert_allclose(sea[::2, 1::2], (samples[:, :-1] + samples[:, 1:]) / 2, atol=TOLERANCE)
    np.testing.assert_allclose(sea[1::2, ::2], (samples[:-1] + samples[1:]) / 2, atol=TOLERANCE)


@pytest.mark.parametrize("method", METHODS)
def test_coarser_mesh_reads_every_other_sample(add, make_parameters, expected, evaluated, method):
    parameters = make_parameters()
    sea = evaluated(add(parameters, method, "LIVE", mesh_resolution=SAMPLES // 2))
    np.testing.assert_allclose(sea, expected(parameters, 1)[::2, ::2], atol=TOLERANCE)


def test_nodes_read_by_position_where_the_attribute_is_missing(add, make_parameters, expected, evaluated):
    parameters = make_parameters()
    item = add(parameters, "NODES", "LIVE")
    item.data.uv_layers.remove(item.data.uv_layers["st"])
    np.testing.assert_allclose(evaluated(item), expected(parameters, 1), atol=TOLERANCE)


@pytest.mark.parametrize("method", METHODS)
def test_live_seas_move_within_a_frame(add, make_parameters, expected, evaluated, empty_scene, method):
    parameters = make_parameters()
    item = add(parameters, method, "LIVE")
    empty_scene.frame_set(5, subframe=0.25)
    np.testing.assert_allclose(evaluated(item), expected(parameters, 5.25), atol=TOLERANCE)


def test_seconds_come_from_the_scene(add, make_parameters, expected, evaluated, empty_scene):
    item = add(make_parameters(fps=24), "NODES", "LIVE")
    empty_scene.render.fps, empty_scene.render.fps_base = 30, 1.001
    empty_scene.frame_set(100)
    at_30 = make_parameters(fps="30000/1001")
    np.testing.assert_allclose(evaluated(item), expected(at_30, 100), atol=TOLERANCE)


@pytest.mark.parametrize("method", METHODS)
def test_the_sequence_is_held_at_both_ends(add, make_parameters, expected, evaluated, empty_scene, method):
    parameters = make_parameters(start_frame=101)
    item = add(parameters, method, "SEQUENCE")
    for frame, shown in ((5, 101), (100, 101), (125, 124), (3000, 124)):
        empty_scene.frame_set(frame)
        np.testing.assert_allclose(evaluated(item), expected(parameters, shown), atol=TOLERANCE)


def test_rendered_mesh_is_smooth_and_square(add, make_parameters):
    mesh = add(make_parameters(), "NODES", "LIVE").data
    assert len(mesh.polygons) == SAMPLES**2
    assert all(polygon.use_smooth and len(polygon.vertices) == 4 for polygon in mesh.polygons)
    assert all(polygon.normal.z > 0.99 for polygon in mesh.polygons)
    assert not mesh.validate()


def test_images_are_data(add, make_parameters):
    settings = [add(make_parameters(), "DISPLACE", source).ocean_tweak for source in SOURCES]
    for image in (settings[0].live_maps.disp, settings[1].sequence_maps.disp):
        assert image.colorspace_settings.is_data


def test_frame_handler_computes_each_ocean_once(add, make_parameters, empty_scene, core, monkeypatch):
    add(make_parameters(), "NODES", "LIVE")
    add(make_parameters(seed=8), "DISPLACE", "LIVE")
    computed = []
    original = core.Ocean.surface

    def surface(self, time, outputs, **named):
        if "displacement" in outputs:  # foam is asked for by itself
            computed.append(self)
        return original(self, time, outputs, **named)

    monkeypatch.setattr(core.Ocean, "surface", surface)
    empty_scene.frame_set(3)
    assert sorted(ocean.parameters.seed for ocean in computed) == [7, 8]
    assert bpy.context.scene.frame_current == 3
