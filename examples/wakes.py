# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the ship in a gale of docs/wakes.md.

python3 -m tools.blender --in 5.2 examples/wakes.py -- --out build/wakes

--jpeg DIR also writes the pictures there as JPEG files of at most 200 kB, as docs/gallery has them.
"""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path

import bpy
from mathutils import Vector

sys.path.insert(0, str(Path(__file__).resolve().parent))

from extension import Extension, enable
from gallery import Shot, build, picture_parser, render, save_jpeg, set_quality

#: m, of the boat that the ready scenes have
BOAT_LENGTH = 15.0
#: frames of a shot, between which ships are keyed
FIRST, LAST = 1, 240
#: frame of the picture, in which a crest stands at the bow
PICTURED = 130
#: m/s and m of the gale's wind and fetch; m/s, times the boat's size, and rad from the direction of the view
#: to the right, of its ship
GALE, SHIP_SPEED, SHIP_SIZE, SHIP_COURSE = (17.0, 250e3), 9.0, 3.0, math.radians(62.0)


def main() -> None:
    """Render as the command line says."""
    arguments = parse(sys.argv[sys.argv.index("--") + 1 :])
    extension = enable()
    for name in arguments.shots:
        SHOTS[name](extension)
        scene = bpy.context.scene
        set_quality(scene, arguments.width, arguments.samples)
        scene.render.use_motion_blur = False
        picture = arguments.out.resolve() / f"{name}.png"
        render(scene, arguments.frame, picture)
        if arguments.jpeg:
            save_jpeg(picture, arguments.jpeg.resolve() / f"{name}.jpg")


def parse(argv: list[str]) -> argparse.Namespace:
    """The arguments after "--"."""
    parser = picture_parser("wakes.py")
    parser.add_argument("--shots", nargs="+", default=tuple(SHOTS), choices=tuple(SHOTS))
    parser.set_defaults(frame=PICTURED)
    return parser.parse_args(argv)


def gale(extension: Extension) -> None:
    """A ship of 45 m that runs across the seas of a gale."""
    light = {"sun_azimuth": math.radians(-105.0), "sun_elevation": math.radians(24.0), "clouds": 0.5}
    build(
        extension,
        Shot(
            "FRESH_BREEZE",
            GALE,
            {"eye": 9.0, "lens": 40.0, "vertices": 600_000},
            is_afloat=False,
            light=light,
        ),
        "CYCLES",
    )
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = FIRST, LAST
    camera = scene.camera
    bpy.context.view_layer.update()
    view = camera.matrix_world.to_3x3() @ Vector((0.0, 0.0, -1.0))
    look = math.atan2(view.y, view.x)
    course = look - SHIP_COURSE
    ahead = Vector((math.cos(course), math.sin(course), 0.0))
    middle = (
        camera.matrix_world.translation + 150.0 * Vector((math.cos(look), math.sin(look), 0.0)) + 14.0 * ahead
    )
    middle.z = 0.0
    camera.rotation_euler.x -= math.radians(1.0)
    new_ship(extension, "Ship", SHIP_SIZE, middle, ahead, SHIP_SPEED)
    press(extension, ["Ship"])
    settings = ocean_of(scene).ocean_tweak
    wake = next(layer.wake for layer in settings.layers if layer.kind == "WAKE")
    wake.amplitude_scale, wake.foam_half_life = 0.7, 10.0
    settings.use_spray = True
    scene.cycles.transparent_max_bounces = 256


def ocean_of(scene: bpy.types.Scene) -> bpy.types.Object:
    """The scene's only ocean."""
    return next(item for item in scene.objects if item.ocean_tweak.is_ocean)


def new_ship(
    extension: Extension, name: str, size: float, middle: Vector, ahead: Vector, speed: float
) -> bpy.types.Object:
    """A boat that is in the middle of its way half way through the shot, at a speed in m/s."""
    scene = bpy.context.scene
    ship = extension.module("scene.boat").new_boat(name, 1.0 / size)
    scene.collection.objects.link(ship)
    ship.rotation_euler.z = math.atan2(ahead.y, ahead.x)
    way = speed * (LAST - FIRST) / scene.render.fps
    for frame, part in ((FIRST, -0.5), (LAST, 0.5)):
        ship.location = middle + part * way * ahead
        ship.keyframe_insert("location", frame=frame)
    for curve in extension.module("scene.animated").curves_of(ship):
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"
    return ship


def press(extension: Extension, names: list[str]) -> None:
    """Float on Ocean, Make Waves and Cut Out Hull: at the waterline that the boats are made for."""
    for item in bpy.context.scene.objects:
        item.select_set(item.name in names)
    bpy.context.view_layer.objects.active = bpy.data.objects[names[0]]
    bpy.context.view_layer.update()
    hull = extension.module("scene.floating").own_hull(bpy.data.objects[names[0]])
    bpy.ops.object.ocean_tweak_float(
        ride="CUSTOM", waterline=hull.length, draft=hull.keel, tilt=0.8, use_contact=True
    )
    bpy.ops.object.ocean_tweak_wake()
    bpy.ops.object.ocean_tweak_cut_out()


SHOTS = {"ship-in-a-gale": gale}

if __name__ == "__main__":
    main()
