# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders two seconds of a shot of the gallery, and joins them into an animated WebP that loops.

python3 -m tools.blender --in 5.2 examples/loop.py -- --out build/loop --webp docs/gallery/storm.webp

Frames that lie in the folder already are not rendered again.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))

import cross_fade
import gallery
from extension import enable

LARGEST = 1_500_000  # bytes
#: of the surface around the camera: small pictures show no more
VERTICES = 150_000


def main() -> None:
    """Render as the command line says."""
    arguments = parse(sys.argv[sys.argv.index("--") + 1 :])
    count = round(arguments.seconds * arguments.fps) + arguments.fade
    frames = [arguments.frame + arguments.every * number for number in range(count)]
    engine = arguments.engine.lower()
    paths = [arguments.out.resolve() / f"{arguments.shot}-{engine}-{frame:04d}.png" for frame in frames]
    if not all(path.exists() for path in paths):
        render(arguments, dict(zip(frames, paths, strict=True)))
    loop = cross_fade.closed(cross_fade.read(paths), arguments.fade)
    quality = cross_fade.save_webp(loop, arguments.webp, arguments.fps, LARGEST)
    size = arguments.webp.stat().st_size
    print(f"{arguments.webp}: {len(loop)} frames, {size / 1e6:.2f} MB, quality {quality}")


def parse(argv: list[str]) -> argparse.Namespace:
    """The arguments after "--"."""
    parser = gallery.picture_parser("loop.py")
    parser.set_defaults(width=640, samples=16)
    parser.add_argument("--shot", default="storm", choices=gallery.SHOTS)
    parser.add_argument("--engine", default="CYCLES", choices=gallery.ENGINES)
    parser.add_argument("--webp", type=Path, required=True, help="the animation")
    parser.add_argument("--seconds", type=float, default=2.0)
    parser.add_argument("--fps", type=float, default=12.0, help="of the animation")
    parser.add_argument("--every", type=int, default=2, help="one of so many frames, of 24 in a second")
    parser.add_argument("--fade", type=int, default=6, help="frames that are blended; so many more are made")
    return parser.parse_args(argv)


def render(arguments: argparse.Namespace, paths: dict[int, Path]) -> None:
    """Render the frames that are not there yet."""
    os.environ.setdefault("MESA_EXTENSION_OVERRIDE", gallery.ANISOTROPIC_FILTERS)
    shot = gallery.SHOTS[arguments.shot]
    shot = shot._replace(changes={**shot.changes, "vertices": VERTICES})
    gallery.build(enable(), shot, arguments.engine)
    scene = bpy.context.scene
    gallery.set_quality(scene, arguments.width, arguments.samples)
    scene.render.use_motion_blur = False
    for frame, path in paths.items():
        if not path.exists():
            gallery.render(scene, frame, path)


if __name__ == "__main__":
    main()
