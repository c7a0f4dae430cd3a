# SPDX-License-Identifier: GPL-3.0-or-later
"""The buoy and the fishing boat of the ready scenes: whole meshes of known size, well in the picture."""

import math

import bmesh
import bpy
import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view

KINDS = ("BUOY", "BOAT")


@pytest.fixture
def afloat(extension):
    return extension("scene.afloat").AFLOAT


def islands(mesh):
    """Volumes in m³, bounds and faces of the pieces of a mesh that hang together."""
    whole = bmesh.new()
    whole.from_mesh(mesh)
    left, found = set(whole.faces), []
    while left:
        piece, front = set(), [next(iter(left))]
        while front:
            face = front.pop()
            if face not in piece:
                piece.add(face)
                front += [near for edge in face.edges for near in edge.link_faces if near not in piece]
        left -= piece
        points = np.array([[vertex.co for vertex in face.verts] for face in piece])
        # divergence theorem over the two triangles of each quad, from its first corner
        first, second, third, fourth = points.transpose(1, 0, 2)
        volume = np.sum(np.cross(first, second) * third + np.cross(first, third) * fourth) / 6.0
        found.append((volume, points.min(axis=(0, 1)), points.max(axis=(0, 1)), len(piece)))
    whole.free()
    return found


@pytest.mark.parametrize("kind", KINDS)
def test_closed_solids_seen_from_outside(afloat, empty_scene, kind):
    mesh = afloat[kind].new("Thing", 1.0).data
    whole = bmesh.new()
    whole.from_mesh(mesh)
    assert all(edge.is_manifold and edge.is_contiguous for edge in whole.edges)
    assert min(face.calc_area() for face in whole.faces) > 0.0
    whole.free()
    assert all(volume > 0.0 for volume, *_ in islands(mesh))
    assert not mesh.validate(verbose=False)


def test_the_boat_is_a_small_trawler(afloat, empty_scene):
    boat = afloat["BOAT"].new("Boat", 1.0)
    mesh = boat.data
    assert 14.0 < boat.dimensions.x < 16.0
    assert boat.dimensions.y == pytest.approx(5.0, abs=0.2)
    assert 2000 <= len(mesh.vertices) <= 8000
    # the hull is the largest piece; nothing else reaches the water
    (_, low, high, _), *others = sorted(islands(mesh), key=lambda piece: -piece[0])
    assert low[2] == pytest.approx(-2.1, abs=0.01)
    assert min(piece[1][2] for piece in others) > 0.5
    # the bow is at +x: higher than the stern, and pointed
    points = np.array([vertex.co for vertex in mesh.vertices])
    at_rail = points[(points[:, 2] < high[2]) & (points[:, 2] > 1.6)]
    assert at_rail[at_rail[:, 0] > 6.5][:, 1].max() < 0.7 * at_rail[at_rail[:, 0] < -6.5][:, 1].max()
    assert high[0] > 7.0


def displacement(mesh):
    """Of the largest piece below z = 0, m³."""
    whole = bmesh.new()
    whole.from_mesh(mesh)
    geometry = [*whole.verts, *whole.edges, *whole.faces]
    cut = bmesh.ops.bisect_plane(
        whole, geom=geometry, plane_co=(0, 0, 0), plane_no=(0, 0, 1), clear_outer=True
    )
    rim = [item for item in cut["geom_cut"] if isinstance(item, bmesh.types.BMEdge)]
    bmesh.ops.contextual_create(whole, geom=rim)
    volume = whole.calc_volume()
    whole.free()
    return volume


def test_the_boat_s_waterline_is_that_of_its_weight(afloat, empty_scene):
    """Block coefficients of trawlers are 0.45 to 0.6; antifouling is below all other paint."""
    mesh = afloat["BOAT"].new("Boat", 1.0).data
    below = np.array([vertex.co for vertex in mesh.vertices if vertex.co.z < 0.0])
    box = np.ptp(below, axis=0)
    assert 0.4 < displacement(mesh) / np.prod(box) < 0.65
    painted = {material.name: set() for material in mesh.materials}
    for face in mesh.polygons:
        painted[mesh.materials[face.material_index].name].update(mesh.vertices[v].co.z for v in face.vertices)
    assert min(painted["Boat Deck"]) > 0.8
    assert max(painted["Boat Antifouling"]) <= min(painted["Boat Topsides"]) + 0.01
    assert max(painted["Boat Antifouling"]) > 0.1


@pytest.mark.parametrize("kind", KINDS)
def test_sizes_are_metres_whatever_the_unit(afloat, empty_scene, kind):
    small, large = (afloat[kind].new("Thing", metres) for metres in (1.0, 0.01))
    np.testing.assert_allclose(large.dimensions, 100.0 * np.array(small.dimensions), rtol=1e-5)


@pytest.mark.parametrize("kind", KINDS)
def test_paint_is_shared(afloat, empty_scene, kind):
    first, second = (afloat[kind].new("Thing", 1.0).data for _ in range(2))
    assert list(first.materials) == list(second.materials)
    assert {face.material_index for face in first.polygons} == set(range(len(first.materials)))


@pytest.mark.parametrize("mood", ["CALM", "FRESH_BREEZE", "STORM", "HORIZON"])
def test_it_is_well_in_the_picture(afloat, extension, quick, empty_scene, mood):
    bpy.ops.ocean.add_scene(mood=mood)
    chosen = quick[mood]
    assert (chosen.floats == "BOAT") == (mood == "STORM")
    thing, kind = empty_scene.objects[afloat[chosen.floats].label], afloat[chosen.floats]
    camera = empty_scene.camera
    bpy.context.view_layer.update()
    matrix = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world
    distance = (matrix.translation - camera.location).to_2d().length
    assert kind.nearest <= distance <= 1.2 * kind.farthest
    seen = [world_to_camera_view(empty_scene, camera, matrix @ vertex.co) for vertex in thing.data.vertices]
    across, up, _ = np.array(seen).T
    assert across.min() > 0.02
    assert across.max() < 0.98
    assert up.max() < 1.0
    assert not 0.45 < np.mean(across) < 0.55


def test_water_before_the_boat_hides_some_of_its_hull_and_nothing_of_its_house(quick, extension, empty_scene):
    bpy.ops.ocean.add_scene(mood="STORM")
    boat, camera = empty_scene.objects["Fishing Boat"], empty_scene.camera
    ocean = next(item for item in empty_scene.objects if item.ocean_tweak.is_ocean)
    sea = extension("core").Ocean(ocean.ocean_tweak.to_parameters(empty_scene))
    matrix = boat.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world
    local = np.array([vertex.co for vertex in boat.data.vertices])
    eye = np.array(camera.location)
    points = np.array([matrix @ vertex.co for vertex in boat.data.vertices])
    way = np.linspace(0.05, 0.95, 60)[:, np.newaxis, np.newaxis]
    line = eye + way * (points - eye)
    place = line - np.array(ocean.location)
    water = sea.height_at(place[..., 0], place[..., 1], sea.parameters.timing.time(empty_scene.frame_current))
    hidden = np.any(water > line[..., 2], axis=0)
    assert 0.1 < np.mean(hidden[(local[:, 2] > -0.5) & (local[:, 2] < 1.5)]) < 0.9
    assert not np.any(hidden[local[:, 2] > 3.5])


def test_the_boat_heads_into_the_storm(quick, empty_scene):
    bpy.ops.ocean.add_scene(mood="STORM")
    boat = empty_scene.objects["Fishing Boat"]
    matrix = boat.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world
    ocean = next(item for item in empty_scene.objects if item.ocean_tweak.is_ocean)
    (layer,) = ocean.ocean_tweak.to_parameters(empty_scene).layers
    bow = matrix.to_3x3().col[0].to_2d().normalized()
    against = -np.array([math.cos(layer.wind_direction), math.sin(layer.wind_direction)])
    assert np.dot(bow, against) > math.cos(math.radians(35.0))


def test_the_boat_rides_with_a_dry_deck(quick, extension, empty_scene):
    """In steep short waves, whatever their frame, the sea stays below the deck."""
    bpy.ops.ocean.add_scene(mood="STORM")
    boat = empty_scene.objects["Fishing Boat"]
    deck = boat.data.materials.find("Boat Deck")
    numbers = {v for face in boat.data.polygons if face.material_index == deck for v in face.vertices}
    ocean = next(item for item in empty_scene.objects if item.ocean_tweak.is_ocean)
    heights = []
    for frame in (1, 60, 120, 180):
        empty_scene.frame_set(frame)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        matrix = boat.evaluated_get(depsgraph).matrix_world.copy()
        heights.append(matrix.translation.z)
        sea = extension("core").Ocean(ocean.ocean_tweak.to_parameters(empty_scene))
        points = np.array([matrix @ boat.data.vertices[number].co for number in numbers])
        place = points - np.array(ocean.location)
        water = sea.height_at(place[:, 0], place[:, 1], sea.parameters.timing.time(frame))
        assert np.all(water < points[:, 2])
    assert np.ptp(heights) > 2.0


def test_undo_takes_the_boat_and_its_paint(quick, empty_scene, window):
    with window.override():
        bpy.ops.ed.undo_push(message="Before")
        bpy.ops.ocean.add_scene(mood="STORM")
        bpy.ops.ed.undo_push(message="Ocean Scene")
        assert "Boat Topsides" in bpy.data.materials
        bpy.ops.ed.undo()
    assert not bpy.context.scene.objects
    assert "Boat Topsides" not in bpy.data.materials
