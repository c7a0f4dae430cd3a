# SPDX-License-Identifier: GPL-3.0-or-later
"""An open boat on a breeze, that rides damped, and with its hull cut out: the picture of docs/floating.md.

python3 -m tools.blender --in 5.2 examples/dry_hull.py -- --out build/dry_hull

--jpeg DIR also writes it there as a JPEG file of at most 200 kB, as docs/gallery has it; --wet leaves the
water in the boat, to compare.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

sys.path.insert(0, str(Path(__file__).resolve().parent))

from extension import Extension, enable
from gallery import picture_parser, render, save_jpeg, set_quality

#: m: where the boat is, and its size; rad, its heading
PLACE, HEADING, LENGTH, BEAM = (60.0, 60.0), 0.7, 6.0, 2.0
#: of the shell, from the middle of its bottom outside to that inside: share of the plan, and height in m
PROFILE = (
    (0.0, -0.5), (0.55, -0.5), (0.8, -0.2), (0.95, 0.15), (1.0, 0.45),
    (0.96, 0.45), (0.9, 0.15), (0.75, -0.15), (0.5, -0.42), (0.0, -0.42),
)  # fmt: skip
#: m by which bow and stern are higher than the middle
SHEER = 0.25
POINTS = 64


def main() -> None:
    """Render as the command line says."""
    parser = picture_parser("dry_hull.py")
    parser.add_argument("--wet", action="store_true", help="do not cut out the hull")
    arguments = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    extension = enable()
    bpy.ops.wm.read_homefile(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    add_sea(extension, scene)
    add_light(scene)
    boat = add_boat(scene)
    bpy.ops.object.ocean_tweak_float(riding="DAMPED")
    if not arguments.wet:
        bpy.ops.object.ocean_tweak_cut_out()
    scene.frame_set(arguments.frame)
    add_camera(scene, boat)
    set_quality(scene, arguments.width, arguments.samples)
    picture = arguments.out / ("wet-hull.png" if arguments.wet else "dry-hull.png")
    render(scene, arguments.frame, picture)
    if arguments.jpeg is not None:
        save_jpeg(picture, arguments.jpeg / f"{picture.stem}.jpg")


def add_sea(extension: Extension, scene: bpy.types.Scene) -> None:
    """A sea of 9 m/s with the water material."""
    core = extension.module("core")
    wind = core.WaveLayer(wind_speed=9.0, fetch=60e3, wind_direction=0.4)
    parameters = core.OceanParameters(resolution=512, domain_size=120.0, seed=3, layers=(wind,))
    ocean = extension.module("scene.ocean_object").add(scene, parameters)
    bpy.context.view_layer.objects.active = ocean
    bpy.ops.ocean.use_water_material()


def add_light(scene: bpy.types.Scene) -> None:
    """A pale sky and the sun."""
    scene.world = bpy.data.worlds.new("Sky")
    if scene.world.node_tree is None:  # a world has nodes from the start since Blender 5.0
        scene.world.use_nodes = True
    sky = scene.world.node_tree.nodes["Background"].inputs
    sky["Color"].default_value, sky["Strength"].default_value = (0.45, 0.6, 0.8, 1.0), 0.9
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.data.energy, sun.rotation_euler = 3.0, (0.8, 0.2, 0.6)
    scene.collection.objects.link(sun)


def add_boat(scene: bpy.types.Scene) -> bpy.types.Object:
    """A dinghy with a shell and no deck, selected."""
    angle = np.linspace(0.0, 2.0 * math.pi, POINTS, endpoint=False)
    along, full = np.cos(angle), np.sqrt(1.0 - 0.5 * np.cos(angle) ** 4)
    rings = [
        np.stack(
            [
                0.5 * LENGTH * share * along,
                0.5 * BEAM * share * np.sin(angle) * full,
                height + SHEER * np.abs(along) ** 3 * (height > 0.0),
            ],
            axis=-1,
        )
        for share, height in PROFILE
    ]
    faces = [
        (ring + i, ring + (i + 1) % POINTS, ring + POINTS + (i + 1) % POINTS, ring + POINTS + i)
        for ring in range(0, POINTS * (len(rings) - 1), POINTS)
        for i in range(POINTS)
    ]
    mesh = bpy.data.meshes.new("Dinghy")
    mesh.from_pydata(np.concatenate(rings).tolist(), [], faces)
    mesh.shade_smooth()
    wood = bpy.data.materials.new("Wood")
    if wood.node_tree is None:
        wood.use_nodes = True
    wood.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.35, 0.16, 0.06, 1.0)
    mesh.materials.append(wood)
    boat = bpy.data.objects.new("Dinghy", mesh)
    boat.location, boat.rotation_euler.z = (*PLACE, 0.0), HEADING
    scene.collection.objects.link(boat)
    for item in bpy.context.selected_objects:
        item.select_set(False)
    boat.select_set(True)
    bpy.context.view_layer.objects.active = boat
    bpy.context.view_layer.update()
    return boat


def add_camera(scene: bpy.types.Scene, boat: bpy.types.Object) -> None:
    """Above its starboard quarter, looking down into it."""
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    middle = boat.matrix_world.translation
    side = Vector((math.sin(HEADING + 0.35), -math.cos(HEADING + 0.35), 0.75))
    camera.location = middle + 1.45 * LENGTH * side
    camera.rotation_euler = (middle - camera.location).to_track_quat("-Z", "Y").to_euler()
    camera.data.lens = 45.0
    scene.collection.objects.link(camera)
    scene.camera = camera


if __name__ == "__main__":
    main()
