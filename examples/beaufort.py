# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the Beaufort scale: forces 0 to 12 from one camera, in one light.

python3 -m tools.blender --in 5.2 examples/beaufort.py -- --out build/beaufort --jpeg docs/gallery/beaufort

Each force has the wind of the middle of its range and, in the open sea, the waves that the scale goes by.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import sys
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))

from extension import Extension, enable
from gallery import picture_parser, render, save_jpeg, set_quality


class Force(NamedTuple):
    """The sea of a force.

    wind_speed : m/s
    fetch : m
    finest : length of the shortest waves of its mesh, m
    area : side of the square in which nothing is repeated, m
    choppiness : up to where its crests fold
    coverage : of foam, as a share of what was measured at sea, where winds blew up to 23 m/s
    half_life : of foam, s
    visibility : in the air, m, which spray takes from a storm
    spray : its amount; beyond 25 m/s the haze of visibility stands for most of it, which is millions of drops
    seed : of the waves: where a crest breaks before the camera as often as it does in that wind
    overcast : how much of the sky is closed cloud
    frame : of the still: one in which the boat is not behind a wave
    """

    wind_speed: float
    fetch: float
    finest: float
    area: float
    choppiness: float = 1.0
    coverage: float = 1.0
    half_life: float = 2.5
    visibility: float = 40e3
    spray: float = 0.0
    seed: int = 3
    overcast: float = 0.45
    frame: int = 1


FORCES = (
    Force(0.2, 1e3, 0.5, 250.0),
    Force(1.0, 1.7e3, 0.05, 60.0),
    Force(2.5, 10.8e3, 0.08, 150.0),
    Force(4.4, 33.6e3, 0.1, 300.0),
    Force(6.7, 48e3, 0.15, 500.0, 1.1),
    Force(9.4, 100e3, 0.2, 800.0, 1.15, spray=1.0),
    Force(12.3, 130e3, 0.25, 1000.0, 1.2, spray=1.0),
    Force(15.5, 155e3, 0.3, 1200.0, 1.2, 1.7, 5.0, 30e3, 1.0, frame=25),
    Force(19.0, 195e3, 0.4, 1600.0, 1.2, 1.4, 5.0, 20e3, 1.0, seed=5, frame=30),
    Force(22.6, 230e3, 0.5, 2000.0, 1.25, 1.2, 4.5, 9e3, 1.0, seed=1),
    Force(26.5, 280e3, 0.5, 2000.0, 1.25, 2.5, 6.0, 4e3, 0.3),
    Force(30.6, 345e3, 0.5, 2400.0, 1.25, 3.2, 7.0, 1.5e3, 0.15),
    Force(36.0, 420e3, 0.5, 2800.0, 1.25, 3.4, 7.0, 700.0, 0.05, overcast=0.9),
)

#: waves of the first force that has any stand this far away, m, higher ones in proportion
CREST, CREST_HEIGHTS = 22.0, 8.0
#: a fishing boat of 15 m gives the scale: how far away it is, m
BOAT = (75.0, 110.0)
VERTICES = 300_000


def main() -> None:
    """Render as the command line says."""
    arguments = parse(sys.argv[sys.argv.index("--") + 1 :])
    extension = enable()
    for number in arguments.forces:
        build(extension, FORCES[number])
        scene = bpy.context.scene
        set_quality(scene, arguments.width, arguments.samples)
        scene.render.resolution_y = arguments.width * 9 // 16
        scene.render.use_motion_blur = False
        picture = arguments.out.resolve() / f"force-{number:02d}.png"
        render(scene, arguments.frame or FORCES[number].frame, picture)
        if arguments.jpeg:
            save_jpeg(picture, arguments.jpeg.resolve() / f"{picture.stem}.jpg", arguments.bytes)


def parse(argv: list[str]) -> argparse.Namespace:
    """The arguments after "--"."""
    parser = picture_parser("beaufort.py")
    parser.set_defaults(width=800, samples=10, frame=0)
    parser.add_argument("--forces", nargs="+", type=int, default=range(13), choices=range(13))
    parser.add_argument("--bytes", type=int, default=90_000, help="of a JPEG file, at most")
    return parser.parse_args(argv)


def build(extension: Extension, force: Force) -> None:
    """A new file with the sea of a force, the same camera and the same light."""
    moods, surroundings = extension.module("scene.moods"), extension.module("scene.surroundings")
    afloat = extension.module("scene.afloat").AFLOAT
    bpy.ops.wm.read_homefile(use_empty=True)
    parameters = sea(extension, force)
    height = extension.module("core").Ocean(parameters).statistics().seed.significant_wave_height
    nearest, farthest = BOAT
    afloat["SCALE"] = dataclasses.replace(afloat["BOAT"], nearest=nearest, farthest=farthest, hidden=None)
    light = extension.module("scene.skies").seen(
        27.0, 62.0, clouds=0.6, overcast=force.overcast, sunlight=0.75,
        visibility=force.visibility, exposure=-0.15,
    )  # fmt: skip
    moods.MOODS["FORCE"] = dataclasses.replace(
        moods.MOODS["STORM"], waves=partial(sea, extension, force), sky=light,
        water="STORM" if force.wind_speed > 17.0 else "OCEANIC",
        eye=3.5, crest_distance=max(CREST / height, CREST_HEIGHTS), lens=38.0, tilt=math.radians(2.2),
        floats="SCALE", vertices=VERTICES,
    )  # fmt: skip
    made = surroundings.build(bpy.context.scene, "FORCE", surroundings.Wishes())
    put_in_air(extension, made.ocean)


def put_in_air(extension: Extension, ocean: bpy.types.Object) -> None:
    """Have the boat fade in the air that its water fades in: contrast falls as exp(-3.9 d/visibility)."""
    water = extension.module("scene.water_material").water_node(ocean.active_material)
    afloat = extension.module("scene.afloat").own_afloat(ocean, bpy.context.scene)
    parts = {*afloat, *(child for item in afloat for child in item.children_recursive)}
    for material in {slot.material for item in parts for slot in item.material_slots if slot.material}:
        tree = material.node_tree
        end = tree.get_output_node("ALL")
        depth, clear, air, mixed = (
            tree.nodes.new(f"ShaderNode{kind}") for kind in ("Math", "Math", "Emission", "MixShader")
        )
        depth.operation, clear.operation = "MULTIPLY", "EXPONENT"
        depth.inputs[1].default_value = -3.912 / water.inputs["Visibility"].default_value
        air.inputs[0].default_value = water.inputs["Haze Color"].default_value
        distance = tree.nodes.new("ShaderNodeCameraData").outputs["View Distance"]
        for source, target in (
            (distance, depth.inputs[0]), (depth.outputs[0], clear.inputs[0]),
            (clear.outputs[0], mixed.inputs[0]), (air.outputs[0], mixed.inputs[1]),
            (end.inputs["Surface"].links[0].from_socket, mixed.inputs[2]),
            (mixed.outputs[0], end.inputs["Surface"]),
        ):  # fmt: skip
            tree.links.new(source, target)


def sea(extension: Extension, force: Force) -> Any:
    """Parameters of the waves of a force, which run towards the camera, with foam and spray."""
    core, plan = extension.module("core"), extension.module("core.sea.patch_plan")
    direction = extension.module("scene.moods").VIEW + math.radians(202.0)
    layer = core.WaveLayer(
        wind_speed=force.wind_speed, fetch=force.fetch, wind_direction=direction, swell=0.2
    )
    # no wind raises so little: what is left is the low swell that a calm is hardly ever without
    swell = core.WaveLayer(
        definition="SEA_STATE",
        significant_wave_height=0.04,
        peak_period=5.0,
        shortest_wavelength=15.0,
        wind_direction=direction,
        swell=1.0,
    )
    layers = (swell if force.wind_speed < 0.3 else layer,)
    return plan.planned(
        core.OceanParameters(
            seed=force.seed, layers=layers, choppiness=force.choppiness,
            foam=core.Foam(coverage=force.coverage, half_life=force.half_life),
            spray=core.Spray(force.spray) if force.spray else None,
        ),
        plan.Wish(finest=force.finest, area=force.area),
    )  # fmt: skip


if __name__ == "__main__":
    main()
