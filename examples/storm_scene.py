# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds storm.blend: one sea in three scenes, each moved in another way.

blender --background --python examples/storm_scene.py --
        --params examples/storm.json --sequence DIR --frames 1-24 --spray 0.01 0.01 --out storm.blend

"Displace" and "Geometry nodes" read the EXR sequence and need no extension, "Live" computes each frame.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parent))

from extension import enable
from storm_render import render_settings

#: scene name → method and source of its ocean
SCENES = {
    "Displace": ("DISPLACE", "SEQUENCE"),
    "Geometry nodes": ("NODES", "SEQUENCE"),
    "Live": ("NODES", "LIVE"),
}
OPENED = "Geometry nodes"

LOOKING = math.radians(235.0)  # the wind blows along +x: waves come towards the camera, from its right
RINGS = 3


def main() -> None:
    """Build the file from the command line's arguments."""
    arguments = parse(sys.argv[sys.argv.index("--") + 1 :])
    extension = enable()
    core = extension.module("core")
    parameters = core.OceanParameters.from_json(arguments.params.read_text(encoding="utf-8"))
    if arguments.spray is not None:
        amount, size = arguments.spray
        parameters = parameters.replace(spray=core.Spray(amount=amount, size=size))
    first, last = arguments.frames
    sequence = extension.module("scene.image_sequence").ImageSequence(
        arguments.sequence, arguments.params.stem, tuple(range(first, last + 1))
    )
    bpy.ops.wm.read_homefile(use_empty=True)
    for scene in make_scenes(extension, first, last, parameters.timing.fps):
        method, source = SCENES[scene.name]
        add_ocean(extension, scene, parameters, method, source, sequence if source == "SEQUENCE" else None)
    dress(extension, parameters)
    save(arguments.out)


def parse(argv: list[str]) -> argparse.Namespace:
    """The arguments after "--"."""
    parser = argparse.ArgumentParser(prog="storm_scene.py")
    parser.add_argument("--params", type=Path, required=True, help="parameters of the sea, JSON")
    parser.add_argument("--sequence", type=Path, required=True, help="folder of the baked frames")
    parser.add_argument("--frames", type=_range, required=True, metavar="FIRST-LAST")
    parser.add_argument(
        "--spray", type=float, nargs=2, metavar=("AMOUNT", "SIZE"), help="that of the bake; none by default"
    )
    parser.add_argument("--out", type=Path, required=True, help="the .blend file to write")
    return parser.parse_args(argv)


def _range(text: str) -> tuple[int, int]:
    first, last = text.split("-")
    return int(first), int(last)


def make_scenes(extension, first, last, fps):
    """The three scenes, with the shot's frames."""
    scenes = [bpy.context.scene]
    scenes += [bpy.data.scenes.new(name) for name in list(SCENES)[1:]]
    for scene, name in zip(scenes, SCENES, strict=True):
        scene.name = name
        scene.frame_start, scene.frame_end = first, last
        scene.frame_set(first)
        extension.module("scene.units").set_frame_rate(scene, fps)
        render_settings(scene)
    return scenes


def add_ocean(extension, scene, parameters, method, source, sequence):
    """The ocean of a scene."""
    ocean = extension.module("scene.ocean_object").add(
        scene, parameters, method=method, source=source, sequence=sequence, name=f"Ocean {scene.name}"
    )
    grids = [
        other.data for other in bpy.data.objects if other.type == "MESH" and other.data.get("shared_grid")
    ]
    if grids:  # all three are moved from the same flat grid: one of them is enough in the file
        own, ocean.data = ocean.data, grids[0]
        bpy.data.meshes.remove(own)
    else:
        ocean.data["shared_grid"] = True


def dress(extension, parameters):
    """Water to the horizon, sky, sun and camera, the same in all scenes, as the ready storm has them."""
    moods, surroundings = extension.module("scene.moods"), extension.module("scene.surroundings")
    water_material, scene_sky = extension.module("scene.water_material"), extension.module("scene.scene_sky")
    mood = dataclasses.replace(moods.MOODS["STORM"], crest_distance=7.0, tilt=math.radians(-2.0))
    sky = mood.sky.turned(LOOKING - moods.VIEW)
    material = water_material.water_material(mood.water)
    place = surroundings.camera_place(mood, parameters, LOOKING)
    camera = None
    for scene in bpy.data.scenes:
        ocean = scene.objects[f"Ocean {scene.name}"]
        camera = camera or surroundings.new_camera(mood, place, ocean, scene, LOOKING)
        scene.collection.objects.link(camera)
        scene.camera = camera
        if not ocean.material_slots:  # the three of them share a mesh
            water_material.assign(ocean, material)
        water_material.describe(ocean, parameters, scene)
        surroundings.add_horizon(ocean, parameters, scene, scene.collection, RINGS)
        if scene != bpy.data.scenes[0]:  # one world and one sun serve all
            scene.world = bpy.data.scenes[0].world
            scene.collection.objects.link(bpy.data.objects["Ocean Sun"])
        scene_sky.settings_of(scene).use_exposure = True
        scene_sky.put(scene, sky, LOOKING)


def save(path: Path) -> None:
    """Write the file so that it can be moved together with its frames."""
    path = path.resolve()
    path.parent.mkdir(parents=True, exist_ok=True)
    if bpy.context.window:
        bpy.context.window.scene = bpy.data.scenes[OPENED]
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=True, relative_remap=True)
    fixed = [image.filepath for image in bpy.data.images if image.filepath and image.filepath[:2] != "//"]
    if fixed:
        raise RuntimeError(f"paths that do not move with {path.name}: {', '.join(fixed)}")


if __name__ == "__main__":
    main()
