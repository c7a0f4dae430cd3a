# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the front of examples/wind-front.json as it crosses its patch, and lays the frames out on a sheet.

python3 -m tools.blender --in 5.2 examples/wind_front_sheet.py -- --out docs/gallery/wind-front.jpg
"""

from __future__ import annotations

import argparse
import math
import sys
import tempfile
from pathlib import Path

import bpy
from PIL import Image

sys.path.insert(0, str(Path(__file__).resolve().parent))

from extension import enable

SEA = Path(__file__).resolve().parent / "wind-front.json"
FRAMES = (121, 289, 457)  # 5, 12 and 19 seconds
WIDTH, HEIGHT, GAP = 640, 300, 4
MOOD = "FRESH_BREEZE"
LARGEST = 200_000  # bytes


def main() -> None:
    """Render as the command line says."""
    arguments = parse(sys.argv[sys.argv.index("--") + 1 :])
    enable()
    build(arguments.samples)
    scene = bpy.context.scene
    sheet = Image.new("RGB", (WIDTH, len(FRAMES) * (HEIGHT + GAP) - GAP), (20, 22, 24))
    with tempfile.TemporaryDirectory() as folder:
        for index, frame in enumerate(FRAMES):
            scene.frame_set(frame)
            scene.render.filepath = str(Path(folder) / f"{frame}.png")
            bpy.ops.render.render(write_still=True)
            with Image.open(scene.render.filepath) as picture:
                sheet.paste(picture.convert("RGB"), (0, index * (HEIGHT + GAP)))
    for quality in range(92, 40, -4):
        sheet.save(arguments.out, quality=quality, optimize=True)
        if arguments.out.stat().st_size < LARGEST:
            return
    raise RuntimeError(f"{arguments.out} stays above {LARGEST} bytes")


def parse(argv: list[str]) -> argparse.Namespace:
    """The arguments after "--"."""
    parser = argparse.ArgumentParser(prog="wind_front_sheet.py")
    parser.add_argument("--out", type=Path, required=True, help="the sheet, a JPEG file")
    parser.add_argument("--samples", type=int, default=32)
    return parser.parse_args(argv)


def build(samples: int) -> None:
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
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    scene.render.use_motion_blur = False
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_denoising, scene.cycles.denoiser = True, "OPENIMAGEDENOISE"


if __name__ == "__main__":
    main()
