# SPDX-License-Identifier: GPL-3.0-or-later
"""Force fields are recorded over the patch, and their waves run with the wind at their own speed."""

import math

import bpy
import numpy as np
import pytest
from mathutils import Matrix

from tests.layers import layers_of

SIZE = 128.0  # m
RESOLUTION = 64


@pytest.fixture
def ocean(ocean_object, core, empty_scene):
    """Flat water, and a wind field that has nothing yet. Time 0 is at frame 1."""
    field = core.WindFieldLayer(
        columns=1, rows=1, jitter=0.0, phase_jitter=0.0, start_time=0.0, crest="PARALLEL", particles=9,
        life=50.0, steepness=0.5,
    )  # fmt: skip
    parameters = core.OceanParameters(
        resolution=RESOLUTION, domain_size=SIZE, layers=(core.WaveLayer(muted=True), field),
        timing=core.Timing(start_frame=1), choppiness=0.0,
    )  # fmt: skip
    item = ocean_object.add(empty_scene, parameters)
    bpy.context.view_layer.objects.active = item
    item.ocean_tweak.active_layer = 1
    empty_scene.frame_start, empty_scene.frame_end = 1, 49
    return item


def blow(strength, towards=(1.0, 0.0, 0.0), at=(0.0, 0.0, 0.0), name="Wind"):
    """A force field that blows along a direction."""
    item = bpy.data.objects.new(name, None)
    bpy.context.scene.collection.objects.link(item)
    turn = Matrix(np.eye(3)).col[2].rotation_difference(towards).to_matrix().to_4x4()
    item.matrix_world = Matrix.Translation(at) @ turn
    bpy.context.view_layer.objects.active, before = item, bpy.context.view_layer.objects.active
    with bpy.context.temp_override(object=item, active_object=item):
        bpy.ops.object.forcefield_toggle()
    bpy.context.view_layer.objects.active = before
    item.field.type, item.field.strength = "WIND", strength
    item.field.falloff_power = 0.0
    return item


def record(**given):
    settings = {"first": 1, "last": 49, "step": 4, "samples": 4, **given}
    return bpy.ops.ocean.record_wind(**settings)


def wind_of(item):
    return layers_of(item.ocean_tweak.to_parameters(bpy.context.scene), "WIND_FIELD")[0]


def test_a_steady_wind_is_the_same_everywhere(ocean):
    blow(6.0, (0.0, 1.0, 0.0))
    blow(2.5)
    assert record() == {"FINISHED"}
    layer = wind_of(ocean)
    assert [key.time for key in layer.keys] == [0.0, 2.0]  # what lies between is the same
    for raster in layer.rasters:
        assert raster.shape == (4, 4, 2)
        assert np.abs(raster.values - (2.5, 6.0)).max() < 5e-3
    assert ocean.ocean_tweak.layers[1].wind_field.source == "RECORDING"


def test_the_wind_is_that_of_the_ocean_s_own_axes(ocean):
    blow(6.0)
    ocean.matrix_world = Matrix.Rotation(math.radians(90), 4, "Z")
    bpy.context.view_layer.update()
    record()
    assert np.abs(wind_of(ocean).rasters[0].values - (0.0, -6.0)).max() < 5e-3


def test_falloffs_are_those_of_the_field(ocean):
    item = blow(8.0, at=(32.0, 32.0, 0.0))
    item.field.falloff_power = 1.0
    record()
    values = wind_of(ocean).rasters[0].values[..., 0]  # samples 32 m apart
    assert values[1, 1] == pytest.approx(8.0)
    assert values[1, 2] == values[2, 1] == pytest.approx(8.0 / 33.0, rel=1e-3)
    assert values[2, 2] == pytest.approx(8.0 / (1.0 + 32.0 * math.sqrt(2.0)), rel=1e-3)
    item.field.use_min_distance, item.field.distance_min = True, 20.0
    item.field.use_max_distance, item.field.distance_max = True, 40.0
    record()
    values = wind_of(ocean).rasters[0].values[..., 0]
    assert values[1, 2] == pytest.approx(8.0 / 13.0, rel=1e-3)
    assert values[2, 2] == 0.0
    item.field.use_min_distance = item.field.use_max_distance = False
    item.field.falloff_type, item.field.falloff_power, item.field.radial_falloff = "TUBE", 0.0, 1.0
    record()
    values = wind_of(ocean).rasters[0].values[..., 0]
    assert values[1].tolist() == pytest.approx([8.0] * 4)
    assert values[2].tolist() == pytest.approx([8.0 / 33.0] * 4, rel=1e-3)
    item.field.z_direction = "POSITIVE"
    record()
    assert wind_of(ocean).rasters[0].values[1, :, 0].tolist() == pytest.approx([0.0, 8.0, 8.0, 8.0])


def cork(item, scene, x, frames):
    """Heights in m of the evaluated surface in the middle row at a place, a number a frame."""
    row, column = RESOLUTION // 2, round(x / SIZE * RESOLUTION)
    heights = []
    for frame in frames:
        scene.frame_set(frame)
        mesh = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        heights.append(mesh.vertices[row * (RESOLUTION + 1) + column].co.z)
    return np.array(heights)


def test_a_change_of_the_wind_arrives_downwind_later(ocean, empty_scene):
    """Waves of V m/s run with V/√(2π) from the only origin, in the middle of the patch: those of a wind that
    wakes up at one moment reach twice the distance in twice the time."""
    speed, wakes = 12.0, 25
    item = blow(0.0)
    item.field.keyframe_insert("strength", frame=wakes - 1)
    item.field.strength = speed
    item.field.keyframe_insert("strength", frame=wakes)
    assert record(last=wakes + 4, step=1, samples=2) == {"FINISHED"}
    assert ocean.ocean_tweak.error == ""
    wave_speed = speed / math.sqrt(2.0 * math.pi)
    length = speed**2 / 9.81  # m, of a wave
    arrivals = []
    for distance in (24.0, 48.0):
        frames = range(wakes, wakes + 24 * 16, 6)
        heights = cork(ocean, empty_scene, SIZE / 2 + distance, frames)
        assert np.abs(heights).max() > 0.05
        moved = np.nonzero(np.abs(heights - heights[0]) > 0.2 * np.abs(heights - heights[0]).max())[0][0]
        arrivals.append((frames[moved] - wakes) / 24.0)
    # the first wave's front is half a wavelength ahead of its middle; one is born within a period
    period = length / wave_speed
    for distance, arrival in zip((24.0, 48.0), arrivals, strict=True):
        assert (distance - 0.5 * length) / wave_speed - 0.3 <= arrival <= distance / wave_speed + 1.3 * period
    assert arrivals[1] - arrivals[0] == pytest.approx(24.0 / wave_speed, abs=0.35 * period)


def test_a_recording_stays_when_the_wind_is_gone(ocean, empty_scene, tmp_path, expected, evaluated):
    item = blow(10.0)
    item.field.keyframe_insert("strength", frame=1)
    item.field.strength = 14.0
    item.field.keyframe_insert("strength", frame=49)
    record()
    sea = ocean.ocean_tweak.to_parameters(empty_scene)
    assert len(layers_of(sea, "WIND_FIELD")[0].keys) == 13
    bpy.data.objects.remove(item)
    copy = ocean.copy()
    empty_scene.collection.objects.link(copy)
    name = copy.name
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "sea.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "sea.blend"))
    scene = bpy.context.scene
    scene.frame_set(200)
    for each in ("Ocean", name):
        assert bpy.data.objects[each].ocean_tweak.to_parameters(scene) == sea
        assert np.abs(evaluated(bpy.data.objects[each]) - expected(sea, 200)).max() < 1e-4
    assert np.abs(evaluated(bpy.data.objects[name])[..., 2]).max() > 0.02


def test_one_undo_takes_a_recording_back(ocean, window, empty_scene):
    blow(9.0)
    with window.override():
        bpy.context.view_layer.objects.active = ocean
        before = wind_of(ocean)
        bpy.ops.ed.undo_push(message="before")
        record()
        bpy.ops.ed.undo_push(message="recorded")
        assert wind_of(bpy.data.objects["Ocean"]) != before
        bpy.ops.ed.undo()
        assert wind_of(bpy.data.objects["Ocean"]) == before
        bpy.ops.ed.redo()
        assert len(wind_of(bpy.data.objects["Ocean"]).keys) == 2


def test_only_the_chosen_collection_is_recorded(ocean, empty_scene):
    blow(9.0)
    other = blow(4.0, (0.0, 1.0, 0.0), name="Other")
    chosen = bpy.data.collections.new("Winds")
    empty_scene.collection.children.link(chosen)
    chosen.objects.link(other)
    ocean.ocean_tweak.layers[1].wind_field.objects = chosen
    record()
    assert np.abs(wind_of(ocean).rasters[0].values - (0.0, 4.0)).max() < 5e-3
    assert ocean.ocean_tweak.layers[1].wind_field.objects == chosen


def test_the_scene_stays_at_its_frame(ocean, empty_scene):
    blow(9.0)
    empty_scene.frame_set(17)
    record()
    assert empty_scene.frame_current == 17


def test_what_cannot_be_recorded_is_told_and_changes_nothing(ocean, empty_scene):
    before = wind_of(ocean)
    with pytest.raises(RuntimeError, match="no force field of the type Wind"):
        record()
    blow(50.0)
    with pytest.raises(RuntimeError, match=r"the waves of this wind are 254\.8 m long"):
        record()
    with pytest.raises(RuntimeError, match="2000 frames are too many"):
        record(last=2000, step=1)
    with pytest.raises(RuntimeError, match="use fewer samples or a larger step"):
        record(samples=256, last=100, step=1)
    with pytest.raises(RuntimeError, match="lies before the first"):
        record(last=0)
    ocean.ocean_tweak.use_ocean_time = True
    bpy.data.objects["Wind"].field.strength = 5.0
    with pytest.raises(RuntimeError, match="Keyed Time must run forwards"):
        record()
    ocean.ocean_tweak.use_ocean_time = False
    assert wind_of(ocean) == before
    ocean.ocean_tweak.layers[1].wind_field.source = "RECORDING"
    assert "nothing is recorded yet" in ocean.ocean_tweak.error


def test_only_a_wind_field_can_be_recorded(ocean):
    ocean.ocean_tweak.active_layer = 0
    with pytest.raises(RuntimeError, match="Choose a wind field"):
        record()


def test_own_time_is_the_time_of_the_keys(ocean, empty_scene):
    blow(9.0)
    settings = ocean.ocean_tweak
    settings.use_ocean_time = True
    for frame, time in ((1, 10.0), (49, 11.0)):
        settings.ocean_time = time
        ocean.keyframe_insert("ocean_tweak.ocean_time", frame=frame)
    record()
    assert [key.time for key in wind_of(ocean).keys] == pytest.approx([10.0, 11.0])


PLACES = [(3.0, 0.0, 2.0), (-4.0, 1.0, 0.5), (0.5, 7.0, -3.0), (10.0, 2.0, 1.0)]


@pytest.mark.parametrize(
    "settings",
    [
        {"falloff_power": 1.0},
        {"falloff_power": 2.0, "use_min_distance": True, "distance_min": 3.0},
        {"falloff_power": 1.0, "use_max_distance": True, "distance_max": 5.0},
        {"falloff_power": 1.0, "shape": "PLANE", "z_direction": "NEGATIVE"},
        {"falloff_type": "TUBE", "falloff_power": 1.0, "radial_falloff": 1.0, "z_direction": "POSITIVE"},
        {"falloff_type": "TUBE", "use_radial_min": True, "radial_min": 2.0, "radial_falloff": 1.0},
        {"falloff_type": "CONE", "falloff_power": 1.0, "radial_falloff": 0.5},
        {"falloff_type": "CONE", "use_radial_max": True, "radial_max": 60.0},
    ],
    ids=str,
)
def test_the_formula_is_that_of_blender_s_own_particles(empty_scene, extension, settings):
    """A particle at rest, without gravity and drag, gains the field's wind times the length of a frame."""
    mesh = bpy.data.meshes.new("Places")
    mesh.from_pydata(PLACES, [], [])
    emitter = bpy.data.objects.new("Places", mesh)
    empty_scene.collection.objects.link(emitter)
    emitter.modifiers.new("Particles", "PARTICLE_SYSTEM")
    system = emitter.particle_systems[0].settings
    system.count, system.emit_from, system.use_emit_random = len(PLACES), "VERT", False
    system.frame_start = system.frame_end = 1
    system.normal_factor = system.effector_weights.gravity = system.drag_factor = system.damping = 0.0
    system.timestep, system.subframes = 0.04, 0
    wind = blow(10.0)
    wind.matrix_world = Matrix.Translation((1.0, -1.0, 0.3)) @ Matrix.Rotation(0.9, 4, (1.0, 2.0, 0.5))
    for name, value in settings.items():
        setattr(wind.field, name, value)
    empty_scene.frame_set(1)
    empty_scene.frame_set(2)
    graph = bpy.context.evaluated_depsgraph_get()
    particles = emitter.evaluated_get(graph).particle_systems[0].particles
    gained = np.array([particle.velocity for particle in particles]) / 0.04
    places = np.array([particle.location for particle in particles])
    assert np.abs(places - PLACES).max() < 0.02
    assert np.abs(gained).max() > 0.1
    found = extension("scene.wind_recording").wind_at(wind.evaluated_get(graph), places)
    assert np.abs(found - gained).max() < 0.01
