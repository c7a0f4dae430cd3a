# SPDX-License-Identifier: GPL-3.0-or-later
"""The viewport shows the sea without its shortest waves, a render all of it; and no surface is made twice."""

import bpy
import numpy as np
import pytest

from .conftest import DOMAIN, SAMPLES, positions_of

TOLERANCE = 1e-4  # m
VIEWPORT = 16
METHODS = ("NODES", "DISPLACE")


@pytest.fixture
def add(ocean_object, empty_scene):
    """Add a sea that is coarser in the viewport."""

    def add_ocean(parameters, method="NODES", *more, **named):
        named = {"viewport_resolution": VIEWPORT, **named}
        return ocean_object.add(empty_scene, parameters, method, *more, **named)

    return add_ocean


@pytest.fixture
def rendered(empty_scene):
    """What a render engine is given: frame → {object: vertices}, materials and normals beside."""
    seen = {}

    class Probe(bpy.types.RenderEngine):
        bl_idname, bl_label = "OCEAN_TEST_PROBE", "Probe"

        def render(self, depsgraph):
            frame = depsgraph.scene.frame_current
            for instance in depsgraph.object_instances:
                item = instance.object
                if item.type == "MESH":
                    seen[frame, item.name] = positions_of(item.data)
                    seen["mesh", item.name] = facts(item.data)

    bpy.utils.register_class(Probe)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    empty_scene.collection.objects.link(camera)
    empty_scene.camera = camera
    empty_scene.render.engine = Probe.bl_idname
    empty_scene.render.resolution_x = empty_scene.render.resolution_y = 8
    yield seen
    bpy.utils.unregister_class(Probe)


def facts(mesh):
    """What a renderer reads besides the vertices."""
    coordinates = np.array([tuple(loop.vector) for loop in mesh.uv_layers["st"].uv])
    corners = [loop.vertex_index for loop in mesh.loops]
    return {
        "materials": [material.name for material in mesh.materials if material is not None],
        "material numbers": {polygon.material_index for polygon in mesh.polygons},
        "upright": all(polygon.normal.z > 0.0 for polygon in mesh.polygons),
        "smooth": all(polygon.use_smooth for polygon in mesh.polygons),
        "sides": {len(polygon.vertices) for polygon in mesh.polygons},
        "coordinates": coordinates[np.unique(corners, return_index=True)[1]],
    }


@pytest.fixture
def computed(core, monkeypatch):
    """The resolution and time of every surface that is made."""
    made = []
    original = core.Ocean.surface

    def surface(self, time, outputs=("displacement",), **named):
        if "displacement" in outputs:  # foam is asked for by itself
            made.append((self.parameters.resolution, float(time)))
        return original(self, time, outputs, **named)

    monkeypatch.setattr(core.Ocean, "surface", surface)
    return made


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("metres_per_unit", [1.0, 0.01])
def test_viewport_and_render_are_the_core_s(
    add, make_parameters, expected, evaluated, empty_scene, rendered, method, metres_per_unit
):
    empty_scene.unit_settings.scale_length = metres_per_unit
    empty_scene.camera.data.clip_end = 1e6
    fine, coarse = make_parameters(), make_parameters(resolution=VIEWPORT)
    item = add(fine, method)
    for frame in (1, 5):
        empty_scene.frame_set(frame)
        assert bpy.ops.render.render() == {"FINISHED"}
        in_render, in_viewport = rendered[frame, "Ocean"], evaluated(item)
        for sea, parameters in ((in_render, fine), (in_viewport, coarse)):
            difference = (sea - expected(parameters, frame, metres_per_unit)) * metres_per_unit
            assert np.abs(difference).max() < TOLERANCE


@pytest.mark.parametrize("method", METHODS)
def test_every_frame_of_an_animation_is_rendered_in_full(
    add, make_parameters, expected, empty_scene, rendered, tmp_path, method
):
    add(make_parameters(), method)
    empty_scene.frame_start, empty_scene.frame_end = 11, 13
    empty_scene.render.filepath = str(tmp_path / "picture")
    bpy.ops.render.render(animation=True)
    for frame in (11, 12, 13):
        np.testing.assert_allclose(
            rendered[frame, "Ocean"], expected(make_parameters(), frame), atol=TOLERANCE
        )


@pytest.mark.parametrize("method", METHODS)
def test_the_render_s_grid_is_like_the_viewport_s(add, make_parameters, rendered, extension, method):
    item = add(make_parameters(), method)
    for name in ("Water", "Foam"):
        item.data.materials.append(bpy.data.materials.new(name))
    bpy.ops.render.render()
    found = rendered["mesh", "Ocean"]
    grid = extension("scene.grid_mesh").Grid(DOMAIN, SAMPLES, SAMPLES)
    np.testing.assert_allclose(found.pop("coordinates"), grid.texture_coordinates(), atol=1e-6)
    assert found == {
        "materials": ["Water", "Foam"],
        "material numbers": {0},
        "upright": True,
        "smooth": True,
        "sides": {4},
    }
    edge = rendered[1, "Ocean"]
    np.testing.assert_allclose(edge[:, -1], edge[:, 0] + (DOMAIN, 0, 0), atol=TOLERANCE)
    np.testing.assert_allclose(edge[-1], edge[0] + (0, DOMAIN, 0), atol=TOLERANCE)


@pytest.mark.parametrize("method", METHODS)
def test_an_export_of_what_is_rendered(add, make_parameters, expected, empty_scene, tmp_path, method):
    add(make_parameters(), method)
    empty_scene.frame_set(6)
    file = tmp_path / "sea.obj"
    bpy.ops.wm.obj_export(
        filepath=str(file), export_eval_mode="DAG_EVAL_RENDER", forward_axis="Y", up_axis="Z"
    )
    lines = [line.split()[1:4] for line in file.read_text().splitlines() if line.startswith("v ")]
    vertices = np.array(lines, float).reshape(SAMPLES + 1, SAMPLES + 1, 3)
    np.testing.assert_allclose(vertices, expected(make_parameters(), 6), atol=TOLERANCE)


@pytest.mark.parametrize("method", METHODS)
def test_a_baked_sequence_is_rendered_with_all_its_samples(
    add, bake, make_parameters, expected, evaluated, empty_scene, rendered, method
):
    parameters = make_parameters()
    item = add(parameters, method, "SEQUENCE", bake(parameters, 1, 4))
    empty_scene.frame_set(3)
    bpy.ops.render.render()
    np.testing.assert_allclose(rendered[3, "Ocean"], expected(parameters, 3), atol=TOLERANCE)
    every_other = expected(parameters, 3)[:: SAMPLES // VIEWPORT, :: SAMPLES // VIEWPORT]
    np.testing.assert_allclose(evaluated(item), every_other, atol=TOLERANCE)


@pytest.mark.parametrize("method", METHODS)
def test_the_two_can_be_made_alike_and_different_again(
    add, make_parameters, expected, evaluated, empty_scene, rendered, method
):
    item = add(make_parameters(), method)
    below = item.modifiers.new("Below", "TRIANGULATE")
    below.show_render = below.show_viewport = False
    kinds = [(modifier.type, modifier.name) for modifier in item.modifiers]
    for viewport in (8192, VIEWPORT, SAMPLES, 2 * VIEWPORT + 1, VIEWPORT):
        item.ocean_tweak.viewport_resolution = viewport
        shown = make_parameters(resolution=min(viewport // 2 * 2, SAMPLES))
        empty_scene.frame_set(empty_scene.frame_current + 1)
        frame = empty_scene.frame_current
        bpy.ops.render.render()
        np.testing.assert_allclose(evaluated(item), expected(shown, frame), atol=TOLERANCE)
        np.testing.assert_allclose(
            rendered[frame, "Ocean"], expected(make_parameters(), frame), atol=TOLERANCE
        )
        if viewport == SAMPLES:
            own = {"NODES": ["NODES"], "DISPLACE": ["DISPLACE", "NODES"]}[method]
            assert [modifier.type for modifier in item.modifiers] == [*own, "TRIANGULATE"]
    assert [(modifier.type, modifier.name) for modifier in item.modifiers] == kinds


@pytest.mark.parametrize("method", METHODS)
def test_a_duplicate_renders_its_own_sea(add, make_parameters, expected, empty_scene, rendered, method):
    item = add(make_parameters(), method)
    twin = item.copy()
    empty_scene.collection.objects.link(twin)
    twin.ocean_tweak.seed = 8
    empty_scene.frame_set(4)
    bpy.ops.render.render()
    for name, seed in ((item.name, 7), (twin.name, 8)):
        sea = expected(make_parameters(seed=seed), 4)
        np.testing.assert_allclose(rendered[4, name], sea, atol=TOLERANCE)


def test_playback_does_not_make_the_render_s_surface(add, make_parameters, empty_scene, computed):
    add(make_parameters())
    computed.clear()
    for frame in (2, 3, 4):
        empty_scene.frame_set(frame)
    assert computed == [(VIEWPORT, 1 / 24), (VIEWPORT, 2 / 24), (VIEWPORT, 3 / 24)]


@pytest.mark.parametrize("method", METHODS)
def test_a_frame_is_made_once_however_often_it_is_asked_for(
    add, make_parameters, evaluated, empty_scene, computed, method
):
    item = add(make_parameters(), method)
    computed.clear()
    for frame, subframe in ((3, 0.0), (2, 0.75), (3, 0.25), (3, 0.0)):  # as Cycles does for motion blur
        empty_scene.frame_set(frame, subframe=subframe)
        item.update_tag()
        evaluated(item)
    assert computed == [(VIEWPORT, time / 24) for time in (2.0, 1.75, 2.25)]


def test_undo_and_tiles_make_no_surface_twice(add, make_parameters, window, empty_scene, computed):
    add(make_parameters())
    with window.override():
        bpy.ops.ed.undo_push(message="added")
        bpy.context.scene.objects["Ocean"].location.x = 5.0
        bpy.ops.ed.undo_push(message="moved")
        computed.clear()
        bpy.ops.ed.undo()
    item = bpy.data.objects["Ocean"]
    assert item.location.x == 0.0
    assert computed == []
    for _ in range(2):
        bpy.context.scene.collection.objects.link(item.copy())
    bpy.context.scene.frame_set(2)
    assert computed == [(VIEWPORT, 1 / 24)]


def test_a_render_with_motion_blur_makes_each_surface_once(add, make_parameters, empty_scene, computed):
    add(make_parameters())
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    empty_scene.collection.objects.link(camera)
    empty_scene.camera = camera
    empty_scene.render.engine = "CYCLES"
    empty_scene.cycles.samples = 1
    empty_scene.render.resolution_x = empty_scene.render.resolution_y = 8
    empty_scene.render.use_motion_blur = True
    computed.clear()
    empty_scene.frame_set(3)
    bpy.ops.render.render()
    fine = [time * 24 for resolution, time in computed if resolution == SAMPLES]
    assert len(fine) == len(set(fine)) >= 3
    assert min(fine) < 2.0 < max(fine)
    assert len(computed) == len(set(computed))


def test_a_vertex_group_survives_a_change_of_the_sea(add, make_parameters):
    item = add(make_parameters())
    item.vertex_groups.new(name="Harbour").add([3], 1.0, "REPLACE")
    item.ocean_tweak.domain_size = 90.0
    item.ocean_tweak.layers[0].wind_speed = 7.0
    assert item.data.vertices[3].groups[0].weight == 1.0


def test_an_edited_mesh_moves_too(add, make_parameters, expected, evaluated, empty_scene):
    """Without a vertex for each sample the attribute cannot be used: the image moves what is left."""
    import bmesh

    parameters = make_parameters(resolution=VIEWPORT)
    item = add(parameters)
    mesh = bmesh.new()
    mesh.from_mesh(item.data)
    mesh.verts.ensure_lookup_table()
    row = VIEWPORT + 1
    bmesh.ops.delete(mesh, geom=mesh.verts[-row:], context="VERTS")
    mesh.to_mesh(item.data)
    empty_scene.frame_set(4)
    found = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    assert len(found.vertices) == row * (row - 1)
    np.testing.assert_allclose(
        [tuple(vertex.co) for vertex in found.vertices],
        expected(parameters, 4)[:-1].reshape(-1, 3), atol=TOLERANCE,
    )  # fmt: skip


def test_foam_of_the_viewport_is_coarser_only_where_renders_have_their_own(
    ocean_object, make_parameters, empty_scene, extension, monkeypatch
):
    plan = extension("scene.plan")
    monkeypatch.setattr(plan, "VIEWPORT_FOAM", VIEWPORT)
    settings = ocean_object.add(empty_scene, make_parameters(), viewport_resolution=24).ocean_tweak
    for viewport, wanted in ((24, VIEWPORT), (SAMPLES, 0)):
        settings.viewport_resolution = viewport
        found = plan.plan_of(settings, empty_scene)
        assert found.viewport_sea().foam.resolution == wanted
        assert found.parameters.foam.resolution == 0
