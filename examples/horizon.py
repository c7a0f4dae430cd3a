# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders one sea of several patches from 2 m and from 300 m above the water.

python3 -m tools.blender --in 5.2 examples/horizon.py -- --out build/horizon

The sea is that of examples/horizon.json, which *Add > Mesh > Ocean Scene > To the Horizon* makes as well. The
pictures show that nothing repeats from above and that there are ripples before the camera.
"""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))

from extension import enable
from gallery import picture_parser, render, save_jpeg, set_quality

PARAMETERS = Path(__file__).resolve().with_suffix(".json")
#: height over the sea at rest in m, and degrees below the horizon; None for what the scene comes with
VIEWS = {"2m": None, "300m": (300.0, 9.0)}


def main() -> None:
    """Render as the command line says."""
    arguments = parse(sys.argv[sys.argv.index("--") + 1 :])
    enable()
    for name in arguments.views:
        build(arguments.params, name)
        set_quality(bpy.context.scene, arguments.width, arguments.samples)
        bpy.context.scene.render.use_motion_blur = False
        picture = arguments.out.resolve() / f"horizon-{name}.png"
        render(bpy.context.scene, arguments.frame, picture)
        if arguments.jpeg:
            save_jpeg(picture, arguments.jpeg.resolve() / f"{picture.stem}.jpg")


def parse(argv: list[str]) -> argparse.Namespace:
    """The arguments after "--"."""
    parser = picture_parser("horizon.py")
    parser.add_argument("--params", type=Path, default=PARAMETERS, help="JSON of the sea")
    parser.add_argument("--views", nargs="+", default=tuple(VIEWS), choices=VIEWS)
    return parser.parse_args(argv)


def build(parameters: Path, view: str) -> None:
    """A new file with the scene, and the camera at its height."""
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.ocean.add_scene(mood="HORIZON", use_buoy=view == "2m")
    bpy.ops.ocean.import_parameters(filepath=str(parameters.resolve()))
    if VIEWS[view] is None:
        return
    height, tilt = VIEWS[view]
    camera = bpy.context.scene.camera
    camera.location.z = height
    camera.rotation_euler.x = 0.5 * math.pi - math.radians(tilt)


if __name__ == "__main__":
    main()
