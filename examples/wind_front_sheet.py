# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the front of examples/wind-front.json as it crosses its patch, and lays the frames out on a sheet.

python3 -m tools.blender --in 5.2 examples/wind_front_sheet.py -- --out build/wind-front --jpeg docs/gallery
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from pathlib import Path

import bpy
from PIL import Image

sys.path.insert(0, str(Path(__file__).resolve().parent))

from extension import enable
from gallery import picture_parser, render, save_jpeg, set_quality

SEA = Path(__file__).resolve().parent / "wind-front.json"
FRAMES = (120, 288, 456)  # 5, 12 and 19 seconds after the first
GAP = 4  # pixels
MOOD = "FRESH_BREEZE"


def main() -> None:
    """Render as the command line says, and lay out."""
    parser = picture_parser("wind_front_sheet.py")
    parser.set_defaults(width=640, samples=32)
    arguments = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    enable()
    build()
    scene, folder = bpy.context.scene, arguments.out.resolve()
    set_quality(scene, arguments.width, arguments.samples)
    scene.render.resolution_y = arguments.width * 15 // 32
    scene.render.use_motion_blur = False
    pictures = [folder / f"wind-front-{number}.png" for number in range(len(FRAMES))]
    for frame, picture in zip(FRAMES, pictures, strict=True):
        render(scene, arguments.frame + frame, picture)
    sheet = folder / "wind-front.png"
    below_each_other(pictures).save(sheet)
    if arguments.jpeg:
        save_jpeg(sheet, arguments.jpeg.resolve() / "wind-front.jpg")


def below_each_other(pictures: Sequence[Path]) -> Image.Image:
    """The pictures of files, of one size, from the first at the top to the last."""
    images = [Image.open(picture).convert("RGB") for picture in pictures]
    width, height = images[0].size
    sheet = Image.new("RGB", (width, len(images) * (height + GAP) - GAP), (20, 22, 24))
    for index, image in enumerate(images):
        sheet.paste(image, (0, index * (height + GAP)))
    return sheet


def build() -> None:
    """The scene of one press with the sea of the front, seen from above its middle."""
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.ocean.add_scene(mood=MOOD, use_buoy=False)
    scene, ocean = bpy.context.scene, bpy.data.objects["Ocean"]
    bpy.context.view_layer.objects.active = ocean
    bpy.ops.ocean.import_parameters(filepath=str(SEA))
    size = ocean.ocean_tweak.domain_size
    ocean.location = (0.0, 0.0, 0.0)
    bpy.data.objects.remove(bpy.data.objects["Ocean Horizon"])  # the front is in one patch only
    scene.camera.location = (0.5 * size, -0.35 * size, 0.45 * size)
    scene.camera.rotation_euler = (math.radians(54.0), 0.0, 0.0)
    scene.camera.data.lens = 20.5


if __name__ == "__main__":
    main()
