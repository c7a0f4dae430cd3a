# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests inside Blender share: seas small enough to be quick, and what they must look like."""

import dataclasses
import os
import sys
from fractions import Fraction
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from tests import blender_fixtures

# Mesa's driver, which draws on a processor, takes minutes for filters that no image here asks for. It reads
# this once, with the first picture of a process
os.environ.setdefault(
    "MESA_EXTENSION_OVERRIDE", "-GL_EXT_texture_filter_anisotropic -GL_ARB_texture_filter_anisotropic"
)

# fixtures for every test here
package, extension = blender_fixtures.package, blender_fixtures.extension
empty_scene = blender_fixtures.empty_scene


@pytest.fixture(autouse=True)
def nothing_fails_unseen(monkeypatch):
    """What Blender calls by itself, handlers and timers, only prints its errors: they fail the test here."""
    errors = []
    monkeypatch.setattr(sys, "excepthook", lambda _type, error, _traceback: errors.append(error))
    yield
    if errors:
        raise errors[0]


@pytest.fixture(scope="session")
def water_file(tmp_path_factory):
    """Where the first test that builds the water's node group keeps it for those after it."""
    return tmp_path_factory.mktemp("water") / "water.blend"


@pytest.fixture(autouse=True)
def water_is_built_once(extension, water_file, monkeypatch):
    """To add the water's 500 nodes and its images takes seconds: a file without shaders gets those kept.

    That they are what the code builds is tested in test_node_trees.
    """
    material, original = extension("scene.water_material"), extension("nodes.versioned").node_group
    water = extension("nodes.water").WATER

    def kept(kind):
        is_new = not any(group.bl_idname == "ShaderNodeTree" for group in bpy.data.node_groups)
        if kind != water or not is_new:
            return original(kind)
        if not water_file.exists():
            group = original(kind)
            bpy.data.libraries.write(str(water_file), {group})
            return group
        with bpy.data.libraries.load(str(water_file)) as (_, wanted):
            wanted.node_groups = [water.name]
        for library in [each for each in bpy.data.libraries if each.filepath == str(water_file)]:
            bpy.data.libraries.remove(library)
        return original(kind)

    monkeypatch.setattr(material, "node_group", kept)


SAMPLES = 32
DOMAIN = 150.0  # m


@pytest.fixture
def core(extension):
    return extension("core")


@pytest.fixture
def ocean_object(extension):
    return extension("scene.ocean_object")


@pytest.fixture
def make_parameters(core):
    """A small sea that looks different along x and y and when mirrored."""

    def make(start_frame=1, fps=24, wind_direction=0.4, **changes):
        layer = core.WaveLayer(wind_speed=11.0, fetch=80e3, wind_direction=wind_direction)
        timing = core.Timing(fps=Fraction(fps), start_frame=start_frame)
        values = {
            "resolution": SAMPLES,
            "domain_size": DOMAIN,
            "seed": 7,
            "layers": (layer,),
            "timing": timing,
            # foam that is soon forgotten: every frame alone looks back over its memory
            "foam": core.Foam(half_life=0.3),
        }
        return core.OceanParameters(**values).replace(**changes)

    return make


@pytest.fixture
def ocean(ocean_object, make_parameters, empty_scene):
    """The small sea as a live ocean, the active object."""
    item = ocean_object.add(empty_scene, make_parameters())
    bpy.context.view_layer.objects.active = item
    return item


def stored(item):
    """An ocean's settings as a file holds them: what is written here is not checked."""
    if hasattr(item, "bl_system_properties_get"):
        return item.bl_system_properties_get()["ocean_tweak"]
    return item["ocean_tweak"]


def sea_of(item):
    """The parameters of an ocean, as its settings have them now."""
    return item.ocean_tweak.to_parameters(bpy.context.scene)


@pytest.fixture
def expected(core):
    """Where the vertices of a sea must be, in Blender units, straight from the core and arithmetic."""

    def positions(parameters, frame, metres_per_unit=1.0):
        time = float((Fraction(frame) - parameters.timing.start_frame) / parameters.timing.fps)
        moved = core.Ocean(parameters).surface(time).displacement.astype(np.float64)
        samples, domain = parameters.resolution, parameters.domain_size
        grid = np.zeros((samples + 1, samples + 1, 3))
        for row in range(samples + 1):
            for column in range(samples + 1):
                flat = (column * domain / samples, row * domain / samples, 0.0)
                grid[row, column] = flat + moved[row % samples, column % samples]
        return grid / metres_per_unit

    return positions


@pytest.fixture
def bake(extension, core, tmp_path):
    """Write a sequence from a first to a last frame, or at some frames; returns where it is."""

    def write(
        parameters, first=0, last=0, name="sea", directory=tmp_path / "frames", maps=("disp",), frames=None
    ):
        frames = frames or tuple(range(first, last + 1))
        directory.mkdir(exist_ok=True)
        sink = extension("export.exr").ExrSequence(directory, name, parameters, "ZIP", maps)
        sea = core.Ocean(parameters)
        for frame in frames:
            sink.write(frame, sea.frame(frame, sink.outputs))
        return extension("scene.image_sequence").ImageSequence(directory, name, frames)

    return write


def vertices(item):
    """(M+1, M+1, 3) float64: the object's evaluated vertices [y, x], Blender units."""
    return positions_of(item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data)


def positions_of(mesh):
    """(M+1, M+1, 3) float64: a square mesh's vertices [y, x], Blender units."""
    flat = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", flat)
    side = round(len(mesh.vertices) ** 0.5)
    return flat.reshape(side, side, 3).astype(np.float64)


@pytest.fixture
def evaluated():
    return vertices


def evaluated_mesh(item):
    """The object's evaluated mesh, as the viewport has it."""
    return item.evaluated_get(bpy.context.evaluated_depsgraph_get()).data


@pytest.fixture
def rendering(empty_scene):
    """Render with an engine that hands over the meshes it is given: look(name, mesh) → what is kept of it.

    Returns a function of look that renders the present frame and gives {name: what was kept}.
    """
    kept, looks = {}, []

    class Probe(bpy.types.RenderEngine):
        bl_idname, bl_label = "OCEAN_TEST_MESHES", "Meshes"

        def render(self, depsgraph):
            for instance in depsgraph.object_instances:
                if instance.object.type == "MESH":
                    kept[instance.object.name] = looks[-1](instance.object.data)

    bpy.utils.register_class(Probe)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    empty_scene.collection.objects.link(camera)
    empty_scene.camera = camera
    empty_scene.render.engine = Probe.bl_idname
    empty_scene.render.resolution_x = empty_scene.render.resolution_y = 8

    def render(look):
        kept.clear()
        looks.append(look)
        assert bpy.ops.render.render() == {"FINISHED"}
        return dict(kept)

    yield render
    bpy.utils.unregister_class(Probe)


@pytest.fixture
def quick(extension, monkeypatch):
    """Moods with few samples and vertices, without spray: the sea itself is tested elsewhere."""
    moods = extension("scene.moods")
    original = moods.Mood.sea

    def small(self, timing):
        foam = extension("core").Foam(resolution=32, half_life=0.3)
        return original(self, timing).replace(resolution=64, foam=foam, spray=None)

    monkeypatch.setattr(moods.Mood, "sea", small)
    for name, mood in moods.MOODS.items():
        few = dataclasses.replace(mood, vertices=min(mood.vertices, 20_000))
        monkeypatch.setitem(moods.MOODS, name, few)
    return moods.MOODS


@pytest.fixture
def window():
    """A window's context: undo wants one, and Blender has one in the background too."""
    manager = bpy.context.window_manager
    first = manager.windows[0]
    return SimpleNamespace(
        override=lambda: bpy.context.temp_override(window=first, area=first.screen.areas[0])
    )
