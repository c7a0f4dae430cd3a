# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders boats in a harbour from above, the picture of docs/wakes.md.

python3 -m tools.blender --in 5.2 examples/harbour_wakes.py -- --out build/wakes

--jpeg DIR also writes the picture there as a JPEG file of at most 200 kB, as docs/gallery has it.
`python3 examples/wake_angle.py` measures Kelvin's angle on it.
"""

from __future__ import annotations

import itertools
import math
import random
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import bpy
from mathutils import Matrix, Vector

sys.path.insert(0, str(Path(__file__).resolve().parent))

from extension import Extension, enable
from gallery import picture_parser, render, save_jpeg, set_quality
from wake_angle import FERRY, SPEED, WIDE
from wakes import BOAT_LENGTH, press

#: frames a second, of the shot, and of the picture
FPS, LAST, PICTURED = 24, 480, 470
#: m, of the camera
HEIGHT = 400.0
#: m/s and m of the light air over the harbour, m of its patch and samples along it
WIND, FETCH, PATCH, SAMPLES = 2.2, 700.0, 160.0, 512
#: rad, of the sun
ELEVATION, AZIMUTH = math.radians(64.0), math.radians(-157.0)
#: stops
EXPOSURE = 0.35
CONCRETE, ASPHALT, ROCK = (0.34, 0.32, 0.29), (0.10, 0.10, 0.105), (0.16, 0.15, 0.14)
PAINTS = ((0.35, 0.06, 0.03), (0.04, 0.12, 0.25), (0.45, 0.42, 0.36), (0.06, 0.2, 0.12), (0.5, 0.28, 0.05))

Place = tuple[float, float]


def main() -> None:
    """Render as the command line says."""
    parser = picture_parser("harbour_wakes.py")
    parser.set_defaults(frame=PICTURED, width=800)
    arguments = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    build(enable())
    scene = bpy.context.scene
    set_quality(scene, arguments.width, arguments.samples)
    scene.render.resolution_y = arguments.width * 9 // 16
    scene.render.use_motion_blur = False
    picture = arguments.out.resolve() / "harbour-wakes.png"
    render(scene, arguments.frame, picture)
    if arguments.jpeg:
        save_jpeg(picture, arguments.jpeg.resolve() / "harbour-wakes.jpg")


def build(extension: Extension) -> None:
    """A new file with the harbour, ready to render."""
    bpy.ops.wm.read_homefile(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine, scene.render.fps, scene.frame_end = "CYCLES", FPS, LAST
    ocean = add_water(extension, scene)
    add_camera(scene)
    extension.module("scene.camera_surface").add_camera_surface(ocean, scene, budget=600_000)
    add_quays(scene)
    add_moored(extension, scene)
    names = list(add_boats(extension, scene))
    press(extension, names)
    for layer in ocean.ocean_tweak.layers:
        if layer.kind == "WAKE":
            wake = layer.wake
            wake.area_size, wake.area_resolution, wake.decay = 512.0, 1024, 0.02
            wake.foam_half_life = 7.0


def add_water(extension: Extension, scene: bpy.types.Scene) -> bpy.types.Object:
    """Harbour water in a light air, under a high sun."""
    core, water = extension.module("core"), extension.module("scene.water_material")
    sky = extension.module("scene.sky").Sky(ELEVATION, AZIMUTH, clouds=0.0)
    air = core.WaveLayer(wind_speed=WIND, fetch=FETCH, wind_direction=2.4)
    sea = core.OceanParameters(
        resolution=SAMPLES, domain_size=PATCH, seed=5, layers=(air,), timing=core.Timing(fps=FPS)
    )
    ocean = extension.module("scene.ocean_object").add(scene, sea, viewport_resolution=SAMPLES)
    material = water.water_material("COASTAL")
    water.assign(ocean, material)
    water.describe(ocean, sea, scene)
    extension.module("scene.scene_sky").put(scene, sky, 0.0, "Sky", scene.collection)
    scene.view_settings.exposure, scene.view_settings.look = EXPOSURE, "AgX - Medium High Contrast"
    return ocean


def add_camera(scene: bpy.types.Scene) -> None:
    """Straight above the harbour's middle, +x to the right."""
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location.z = HEIGHT
    camera.data.angle = 2.0 * math.atan(0.5 * WIDE / HEIGHT)
    camera.data.clip_end = 10.0 * HEIGHT
    scene.collection.objects.link(camera)
    scene.camera = camera
    bpy.context.view_layer.update()


def add_boats(extension: Extension, scene: bpy.types.Scene) -> Iterator[str]:
    """A ferry that goes straight on, a launch that turns, and one that crosses: (name, place at s) each."""
    now = (PICTURED - 1) / FPS
    ways: dict[str, tuple[float, Callable[[float], Place]]] = {
        "Ferry": (17.0, lambda t: (FERRY[0] + SPEED * (t - now), FERRY[1])),
        "Launch": (10.0, lambda t: turned(t - now + 11.0, (-8.0, 40.0), 24.0, 4.4)),
        "Pilot": (11.0, lambda t: (-112.0 + 1.5 * (t - now), -8.0 - 4.2 * (t - now))),
    }
    for name, (length, place) in ways.items():
        boat = extension.module("scene.boat").new_boat(name, BOAT_LENGTH / length)
        scene.collection.objects.link(boat)
        for frame in range(1, LAST + 1, 6):
            t = (frame - 1) / FPS
            (x, y), (ahead_x, ahead_y) = place(t), place(t + 0.1)
            boat.location = (x, y, 0.0)
            turn = math.atan2(ahead_y - y, ahead_x - x)
            before = boat.rotation_euler.z
            boat.rotation_euler.z = before + math.remainder(turn - before, math.tau)
            boat.keyframe_insert("location", frame=frame)
            boat.keyframe_insert("rotation_euler", index=2, frame=frame)
        for curve in extension.module("scene.animated").curves_of(boat):
            for point in curve.keyframe_points:
                point.interpolation = "LINEAR"
        yield name


def add_moored(extension: Extension, scene: bpy.types.Scene) -> None:
    """Boats that lie at the quay and the pier."""
    berths = ((-84.0, 66.5, 0.0, 18.0), (-142.0, 67.5, math.pi, 14.0), (76.0, 65.0, -0.5 * math.pi, 9.0),
              (94.5, 65.5, 0.5 * math.pi, 11.0), (124.5, 65.5, -0.5 * math.pi, 10.0))  # fmt: skip
    for x, y, turn, length in berths:
        boat = extension.module("scene.boat").new_boat("Moored", BOAT_LENGTH / length)
        boat.location, boat.rotation_euler.z = (x, y, 0.0), turn
        scene.collection.objects.link(boat)


def turned(since: float, middle: Place, radius: float, speed: float) -> Place:
    """Along a line until 0 s, and then around a middle."""
    if since < 0.0:
        return middle[0] + speed * since, middle[1] - radius
    angle = speed * since / radius
    return middle[0] + radius * math.sin(angle), middle[1] - radius * math.cos(angle)


def add_quays(scene: bpy.types.Scene) -> None:
    """A quay with sheds and boxes, a mole of rocks, and a pier."""
    chance = random.Random(4)
    concrete, asphalt = surface("Concrete", CONCRETE, 0.35), surface("Asphalt", ASPHALT, 0.5)
    block(scene, (-115.0, 84.0), (150.0, 26.0), (-6.0, 2.2), concrete)
    block(scene, (-115.0, 87.5), (148.0, 26.0), (2.2, 2.25), asphalt)
    block(scene, (112.0, 88.0), (110.0, 30.0), (-6.0, 2.2), concrete)
    block(scene, (112.0, 91.0), (108.0, 30.0), (2.2, 2.25), asphalt)
    for x in range(-186, -42, 12):  # bollards and fenders
        block(scene, (x, 71.8), (0.5, 0.5), (2.2, 2.9), surface("Iron", (0.02, 0.02, 0.02), 0.1))
        block(scene, (x + 5.0, 70.8), (1.2, 0.6), (0.2, 1.8), surface("Rubber", (0.012, 0.012, 0.012), 0.1))
    paints = [surface(f"Paint {number}", paint, 0.2) for number, paint in enumerate(PAINTS)]
    for _ in range(46):
        x, y = -178.0 + 6.6 * chance.randrange(13), 79.0 + 2.9 * chance.randrange(4)
        top = 2.25 + 2.6 * chance.choice((1, 1, 2))
        block(scene, (x, y), (6.1, 2.44), (2.25, top), chance.choice(paints))
    roof(scene, (-62.0, 84.0), (34.0, 13.0), (2.2, 8.0, 10.5), surface("Roof", (0.32, 0.3, 0.28), 0.3))
    roof(scene, (96.0, 86.5), (30.0, 14.0), (2.2, 7.0, 9.5), surface("Tiles", (0.28, 0.1, 0.06), 0.4))
    for x in (70.0, 90.0, 110.0, 130.0):  # fingers of a pier
        block(scene, (x, 66.0), (1.8, 16.0), (0.3, 0.8), surface("Planks", (0.22, 0.16, 0.1), 0.5))
    mole(scene, ((142.0, -96.0), (128.0, -66.0), (121.0, -50.0)), chance)


def surface(name: str, colour: tuple[float, float, float], spots: float) -> bpy.types.Material:
    """A rough material with lighter and darker spots; the one of that name where there is one."""
    known = bpy.data.materials.get(name)
    if known is not None:
        return known
    material = bpy.data.materials.new(name)
    if material.node_tree is None:  # a material has nodes from the start since Blender 5.0
        material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    place, noise = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeTexNoise")
    noise.inputs["Scale"].default_value, noise.inputs["Detail"].default_value = 0.4, 8.0
    links.new(place.outputs["Object"], noise.inputs["Vector"])
    shades = nodes.new("ShaderNodeValToRGB")
    for element, share in zip(shades.color_ramp.elements, (1.0 - spots, 1.0 + spots), strict=True):
        element.color = (*(share * part for part in colour), 1.0)
    shades.color_ramp.elements[0].position, shades.color_ramp.elements[1].position = 0.3, 0.7
    links.new(noise.outputs[0], shades.inputs[0])
    shader = nodes["Principled BSDF"]
    links.new(shades.outputs[0], shader.inputs["Base Color"])
    shader.inputs["Roughness"].default_value = 0.85
    return material


def block(
    scene: bpy.types.Scene, middle: Place, size: Place, heights: Place, material: bpy.types.Material
) -> None:
    """A box, m, from one height to another."""
    x, y = (0.5 * side for side in size)
    corners = [(sx * x, sy * y, z) for z in heights for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    sides = [(i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i) for i in range(4)]
    solid(scene, middle, corners, [(3, 2, 1, 0), (4, 5, 6, 7), *sides], material)


def roof(
    scene: bpy.types.Scene,
    middle: Place,
    size: Place,
    heights: tuple[float, float, float],
    material: bpy.types.Material,
) -> None:
    """A shed, m: its foot, its eaves and its ridge."""
    x, y = (0.5 * side for side in size)
    low, eaves, ridge = heights
    square = ((-x, -y), (x, -y), (x, y), (-x, y))
    corners = [(*each, low) for each in square] + [(*each, eaves) for each in square]
    corners += [(-x, 0.0, ridge), (x, 0.0, ridge)]
    walls = [(i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i) for i in range(4)]
    solid(scene, middle, corners, [*walls, (4, 5, 9, 8), (6, 7, 8, 9), (5, 6, 9), (7, 4, 8)], material)


def mole(scene: bpy.types.Scene, line: Sequence[Place], chance: random.Random) -> None:
    """Rocks heaped along a line, with a way on top."""
    rock = surface("Rock", ROCK, 0.4)
    for (x0, y0), (x1, y1) in itertools.pairwise(line):
        way = Vector((x1 - x0, y1 - y0))
        side = Vector((-way.y, way.x)).normalized()
        for _ in range(int(9.0 * way.length)):
            off = chance.gauss(0.0, 3.2)
            place = Vector((x0, y0)) + chance.random() * way + off * side
            add_rock(scene, (*place, 1.9 - 0.55 * abs(off)), chance, rock)
        turn = Matrix.Rotation(math.atan2(way.y, way.x), 4, "Z")
        block(scene, (0.5 * (x0 + x1), 0.5 * (y0 + y1)), (way.length + 2.0, 3.0), (1.0, 3.0),
              surface("Concrete", CONCRETE, 0.35))  # fmt: skip
        scene.collection.objects[-1].matrix_basis = scene.collection.objects[-1].matrix_basis @ turn


def add_rock(
    scene: bpy.types.Scene, place: tuple[float, float, float], chance: random.Random, rock: bpy.types.Material
) -> None:
    """An angular rock of a metre or two."""
    mesh = bpy.data.meshes.get(f"Rock {chance.randrange(8)}")
    if mesh is None:
        mesh = new_rock(chance, rock)
    item = bpy.data.objects.new("Rock", mesh)
    item.location = place
    item.rotation_euler = [chance.uniform(0.0, math.tau) for _ in range(3)]
    item.scale = [chance.uniform(0.7, 1.5) for _ in range(3)]
    scene.collection.objects.link(item)


def new_rock(chance: random.Random, rock: bpy.types.Material) -> bpy.types.Mesh:
    """A cube whose corners are off."""
    mesh = bpy.data.meshes.new(f"Rock {sum(1 for each in bpy.data.meshes if each.name.startswith('Rock'))}")
    corners = [
        tuple(each * chance.uniform(0.55, 1.2) for each in (x, y, z))
        for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)
    ]  # fmt: skip
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh.from_pydata(corners, [], faces)
    mesh.materials.append(rock)
    return mesh


def solid(
    scene: bpy.types.Scene,
    middle: Place,
    corners: Sequence[tuple[float, float, float]],
    faces: Sequence[tuple[int, ...]],
    material: bpy.types.Material,
) -> None:
    """A mesh at a place."""
    mesh = bpy.data.meshes.new("Solid")
    mesh.from_pydata(corners, [], faces)
    mesh.materials.append(material)
    item = bpy.data.objects.new("Solid", mesh)
    item.location = (*middle, 0.0)
    scene.collection.objects.link(item)


if __name__ == "__main__":
    main()
