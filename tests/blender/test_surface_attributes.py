# SPDX-License-Identifier: GPL-3.0-or-later
"""What shots read of the mesh is the core's, whatever moves it, in the viewport and in renders."""

import bpy
import numpy as np
import pytest

from .conftest import DOMAIN, SAMPLES, evaluated_mesh
from .surfaces import ALL_MAPS, assert_alike, read, wanted

# method, source, quads of the mesh: another number than that of the samples keeps attributes from the mesh
WAYS = {
    "nodes, attributes": ("NODES", "LIVE", 0),
    "nodes, images": ("NODES", "LIVE", 2 * SAMPLES),
    "nodes, files": ("NODES", "SEQUENCE", 0),
    "Displace, images": ("DISPLACE", "LIVE", 0),
    "Displace, files": ("DISPLACE", "SEQUENCE", 0),
}
SIDE = SAMPLES + 1
#: what the switch of foam asks for
FOAM = {"foam", "cusp", "breaking", "foam_age"}
VIEWPORT = 16


@pytest.fixture
def add(ocean_object, bake, empty_scene):
    def add_ocean(parameters, way, maps=ALL_MAPS, **more):
        method, source, quads = WAYS[way]
        first = parameters.timing.start_frame
        sequence = bake(parameters, first, first + 3, maps=maps) if source == "SEQUENCE" else None
        return ocean_object.add(
            empty_scene, parameters, method, source, sequence, mesh_resolution=quads, **more
        )

    return add_ocean


def at_samples(found, samples):
    """Of a mesh finer than the samples, the vertices that stand on samples."""
    step = (len(found["position"]) - 1) // samples
    return {name: values[::step, ::step] for name, values in found.items()}


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("metres", [1.0, 0.5])
def test_everything_is_the_core_s(add, core, make_parameters, empty_scene, way, metres):
    empty_scene.unit_settings.scale_length = metres
    parameters = make_parameters(start_frame=3)
    item = add(parameters, way)
    for frame in (4, 6, 5):
        empty_scene.frame_set(frame)
        side = (WAYS[way][2] or SAMPLES) + 1
        found = at_samples(read(evaluated_mesh(item), side, side), SAMPLES)
        assert_alike(found, wanted(core, parameters, frame, metres), metres)


@pytest.mark.parametrize("way", WAYS)
def test_patches_are_shown_joined(add, core, make_parameters, empty_scene, way):
    """On as many samples as are rendered; the ocean keeps its patches."""
    patches = core.Patch(DOMAIN, 0.0, 20.0, 1e6, 24), core.Patch(44.0, 0.7, 9.0, 20.0, 32)
    parameters = make_parameters(patches=patches).on_one_grid(SAMPLES)
    item = add(parameters, way)
    empty_scene.frame_set(4)
    side = (WAYS[way][2] or SAMPLES) + 1
    found = at_samples(read(evaluated_mesh(item), side, side), SAMPLES)
    assert_alike(found, wanted(core, parameters, 4))
    assert not item.ocean_tweak.error
    assert item.ocean_tweak.to_parameters(empty_scene) == parameters


@pytest.mark.parametrize("way", WAYS)
def test_a_render_has_all_samples(add, core, make_parameters, empty_scene, rendering, way):
    parameters = make_parameters()
    item = add(parameters, way, viewport_resolution=VIEWPORT)
    side = (WAYS[way][2] or SAMPLES) + 1
    for frame in (1, 3):
        empty_scene.frame_set(frame)
        found = rendering(lambda mesh: read(mesh, side, side))[item.name]
        assert_alike(at_samples(found, SAMPLES), wanted(core, parameters, frame))


# a mesh whose quads are given has them in the viewport too
@pytest.mark.parametrize("way", [way for way, (_, _, quads) in WAYS.items() if quads == 0])
def test_the_viewport_has_fewer(add, core, make_parameters, empty_scene, way):
    parameters = make_parameters()
    item = add(parameters, way, viewport_resolution=VIEWPORT)
    empty_scene.frame_set(2)
    found = read(evaluated_mesh(item), VIEWPORT + 1, VIEWPORT + 1)
    if WAYS[way][1] == "LIVE":
        # its own sea, of fewer waves
        assert_alike(found, wanted(core, parameters.replace(resolution=VIEWPORT), 2))
    else:
        step = SAMPLES // VIEWPORT
        every_other = {name: values[::step, ::step] for name, values in wanted(core, parameters, 2).items()}
        assert_alike(found, every_other)


@pytest.mark.parametrize("way", WAYS)
def test_what_is_switched_off_is_left_out(add, make_parameters, empty_scene, way):
    item = add(make_parameters(), way)
    side = (WAYS[way][2] or SAMPLES) + 1
    empty_scene.frame_set(2)
    switches = {"use_foam": FOAM, "use_normals": {"normal"}, "use_velocity": {"velocity"}}
    everything = {"position", "displacement", "st"}.union(*switches.values())
    for switch, names in switches.items():
        setattr(item.ocean_tweak, switch, False)
        assert set(read(evaluated_mesh(item), side, side)) == everything - names
        setattr(item.ocean_tweak, switch, True)
        empty_scene.frame_set(empty_scene.frame_current)
        assert set(read(evaluated_mesh(item), side, side)) == everything


@pytest.mark.parametrize("way", ["nodes, files", "Displace, files"])
@pytest.mark.parametrize("maps", [("disp",), ("disp", "foam"), ("disp", "normal", "vel")])
def test_maps_that_were_not_baked_are_left_out(add, core, make_parameters, empty_scene, way, maps):
    parameters = make_parameters()
    item = add(parameters, way, maps)
    empty_scene.frame_set(3)
    names = {"disp": {"displacement"}, "foam": FOAM - {"foam_age"}}
    names |= {"normal": {"normal"}, "vel": {"velocity"}}
    left = {"position", "st"}.union(*(names[name] for name in maps))
    expected = wanted(core, parameters, 3)
    assert_alike(read(evaluated_mesh(item), SIDE, SIDE), {name: expected[name] for name in left})


@pytest.mark.parametrize("way", ["nodes, files", "Displace, files"])
def test_a_sequence_played_faster_moves_faster(add, core, make_parameters, empty_scene, way):
    """One file a frame: at 48 frames per second the waves of a bake at 24 run twice as fast."""
    parameters = make_parameters(fps=24)
    item = add(parameters, way)
    empty_scene.render.fps = 48
    item.ocean_tweak.use_foam = False  # any change: the frame rate alone is told by the window
    empty_scene.frame_set(2)
    found = read(evaluated_mesh(item), SIDE, SIDE)["velocity"]
    np.testing.assert_allclose(found, 2.0 * wanted(core, parameters, 2)["velocity"], atol=1e-3)


@pytest.mark.parametrize("way", WAYS)
def test_velocity_is_the_change_of_position(add, make_parameters, empty_scene, evaluated, way):
    item = add(make_parameters(), way)
    empty_scene.frame_set(3)
    side = (WAYS[way][2] or SAMPLES) + 1
    velocity = read(evaluated_mesh(item), side, side)["velocity"]
    empty_scene.frame_set(2)
    before = evaluated(item)
    empty_scene.frame_set(4)
    change = (evaluated(item) - before) * 24.0 / 2.0
    assert np.abs(velocity).max() > 1.0
    # between the two frames the waves turn a little
    assert np.abs(velocity - change).max() < 0.1


def test_switching_between_ways_leaves_nothing_behind(add, core, make_parameters, empty_scene):
    parameters = make_parameters()
    item = add(parameters, "nodes, files", maps=("disp",))
    settings = item.ocean_tweak
    for method, source in (("NODES", "LIVE"), ("NODES", "SEQUENCE"), ("DISPLACE", "LIVE"),
                           ("DISPLACE", "SEQUENCE"), ("NODES", "LIVE")):  # fmt: skip
        settings.method, settings.source = method, source
        empty_scene.frame_set(1)
        empty_scene.frame_set(2)
        expected = wanted(core, parameters, 2)
        names = set(expected) if source == "LIVE" else {"position", "displacement", "st"}
        assert_alike(read(evaluated_mesh(item), SIDE, SIDE), {name: expected[name] for name in names})


def test_foam_of_a_frame_is_the_same_however_it_is_reached(add, core, make_parameters, empty_scene):
    parameters = make_parameters()
    item = add(parameters, "nodes, attributes")
    for frame, subframe in ((40, 0.0), (39, 0.75), (40, 0.25), (40, 0.0), (10, 0.0), (41, 0.5), (40, 0.0)):
        empty_scene.frame_set(frame, subframe=subframe)
        found = read(evaluated_mesh(item), SIDE, SIDE)
        assert_alike(found, wanted(core, parameters, frame + subframe))


def test_a_mesh_in_edit_mode_shows_the_sea(add, core, make_parameters, empty_scene):
    """Its attributes cannot be written then: images take their place."""
    parameters = make_parameters()
    item = add(parameters, "nodes, attributes")
    bpy.context.view_layer.objects.active = item
    bpy.ops.object.mode_set(mode="EDIT")
    empty_scene.frame_set(4)
    assert item.ocean_tweak.error == ""
    bpy.ops.object.mode_set(mode="OBJECT")
    empty_scene.frame_set(3)
    assert_alike(read(evaluated_mesh(item), SIDE, SIDE), wanted(core, parameters, 3))


@pytest.mark.parametrize(
    ("switch", "attributes"),
    [("use_foam", FOAM), ("use_velocity", {"velocity"}), ("use_normals", {"custom_normal"})],
)
def test_a_live_mesh_has_what_its_switches_ask_for_and_nothing_else(add, make_parameters, switch, attributes):
    item = add(make_parameters(), "nodes, attributes")
    everything = {"displacement", "velocity", "custom_normal", *FOAM}

    def of_sea():
        of_grid = {"position", "sharp_face", "st"}
        return {each.name for each in item.data.attributes if not each.is_internal} - of_grid

    assert of_sea() == everything
    setattr(item.ocean_tweak, switch, False)
    assert of_sea() == everything - attributes
    setattr(item.ocean_tweak, switch, True)
    assert of_sea() == everything
