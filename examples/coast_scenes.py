# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the ready scenes with a coast, for docs/coast.md.

python -m tools.blender --in 5.2 examples/coast_scenes.py -- --out docs/pictures
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from ocean_tweak import registration
from ocean_tweak.scene import coast_scene
from ocean_tweak.scene.moods import COASTS
from ocean_tweak.scene.surroundings import Wishes


def main() -> None:
    """Render each into DIR/coast-NAME.jpg."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--names", nargs="+", default=[*COASTS], choices=[*COASTS])
    parser.add_argument("--frame", type=int, default=40)
    parser.add_argument("--width", type=int, default=960)
    parser.add_argument("--samples", type=int, default=64)
    words = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    arguments = parser.parse_args(words)
    registration.register()
    for name in arguments.names:
        bpy.ops.wm.read_homefile(use_empty=True)
        scene = bpy.context.scene
        coast_scene.build(scene, name, Wishes())
        scene.frame_set(arguments.frame)
        scene.cycles.samples, scene.cycles.use_denoising = arguments.samples, True
        render = scene.render
        render.resolution_x, render.resolution_y = arguments.width, arguments.width * 9 // 16
        render.image_settings.file_format, render.image_settings.quality = "JPEG", 88
        render.use_motion_blur = False
        render.filepath = str(arguments.out.resolve() / f"coast-{name.lower()}.jpg")
        bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    main()
