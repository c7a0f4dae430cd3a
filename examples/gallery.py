# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the ocean scenes that one press makes, and renders a still of each.

python3 -m tools.blender --in 5.2 examples/gallery.py -- --out build/gallery

--jpeg DIR also writes the pictures there as JPEG files of at most 200 kB, as docs/gallery has them.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))

from extension import Extension, enable

LARGEST = 200_000  # bytes
MOODS = ("CALM", "FRESH_BREEZE", "STORM")
ENGINES = ("CYCLES", "EEVEE")


#: where Mesa's driver draws EEVEE on a processor, the horizon's images take minutes a sample with it
ANISOTROPIC_FILTERS = "-GL_EXT_texture_filter_anisotropic -GL_ARB_texture_filter_anisotropic"


def main() -> None:
    """Render as the command line says."""
    arguments = parse(sys.argv[sys.argv.index("--") + 1 :])
    os.environ.setdefault("MESA_EXTENSION_OVERRIDE", ANISOTROPIC_FILTERS)
    extension = enable()
    for mood in arguments.moods:
        for engine in arguments.engines:
            build(extension, mood, engine, arguments)
            picture = arguments.out.resolve() / f"{mood.lower().replace('_', '-')}-{engine.lower()}.png"
            render(bpy.context.scene, arguments.frame, picture)
            if arguments.jpeg:
                save_jpeg(picture, arguments.jpeg.resolve() / f"{picture.stem}.jpg")


def parse(argv: list[str]) -> argparse.Namespace:
    """The arguments after "--"."""
    parser = picture_parser("gallery.py")
    parser.add_argument("--moods", nargs="+", default=MOODS, choices=MOODS)
    parser.add_argument("--engines", nargs="+", default=ENGINES, choices=ENGINES)
    parser.add_argument("--resolution", type=int, help="samples along a side, instead of the mood's")
    parser.add_argument("--rings", type=int, help="of copies around the ocean, instead of the scene's")
    parser.add_argument("--still", action="store_true", help="without motion blur")
    return parser.parse_args(argv)


def picture_parser(program: str) -> argparse.ArgumentParser:
    """What every gallery is asked for: where pictures go, how large and how clean they are, and the frame."""
    parser = argparse.ArgumentParser(prog=program)
    parser.add_argument("--out", type=Path, required=True, help="folder for the pictures")
    parser.add_argument("--jpeg", type=Path, help="folder for small JPEG files of them")
    parser.add_argument("--width", type=int, default=1280, help="pixels; the height is 27/64 of it")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--frame", type=int, default=1)
    return parser


def build(extension: Extension, mood: str, engine: str, arguments: argparse.Namespace) -> None:
    """A new file with the scene of a mood, ready to render."""
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.ocean.add_scene(mood=mood, engine=engine)
    scene = bpy.context.scene
    if arguments.resolution:
        bpy.data.objects["Ocean"].ocean_tweak.resolution = arguments.resolution
    if arguments.rings is not None:
        modifier = bpy.data.objects["Ocean Horizon"].modifiers[0]
        extension.module("nodes.modifier_inputs").set_input(modifier, "Rings", arguments.rings)
    set_quality(scene, arguments.width, arguments.samples)
    scene.render.use_motion_blur = not arguments.still


def set_quality(scene: bpy.types.Scene, width: int, samples: int) -> None:
    """How large and how clean pictures are; the height is 27/64 of the width."""
    scene.render.resolution_x, scene.render.resolution_y = width, width * 27 // 64
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.adaptive_threshold = 0.015
    scene.cycles.max_bounces = 4
    scene.cycles.use_denoising = True
    scene.cycles.denoiser = "OPENIMAGEDENOISE"
    scene.eevee.taa_render_samples = samples


def render(scene: bpy.types.Scene, frame: int, path: Path) -> None:
    """Render a still into a PNG file."""
    started = time.perf_counter()
    scene.frame_set(frame)
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    if not path.exists():
        raise RuntimeError(f"{path} was not rendered")
    print(f"{path.name}: {time.perf_counter() - started:.1f} s", flush=True)


def save_jpeg(picture: Path, path: Path) -> None:
    """The picture as the best JPEG below 200 kB. Raises RuntimeError if there is none."""
    path.parent.mkdir(parents=True, exist_ok=True)
    image = bpy.data.images.load(str(picture))
    image.pixels[0] = image.pixels[0]  # or Blender copies the file as it is
    image.file_format = "JPEG"
    for quality in range(94, 40, -3):
        image.save(filepath=str(path), quality=quality)
        if path.stat().st_size < LARGEST:
            return
    raise RuntimeError(f"{path} stays above {LARGEST} bytes")


if __name__ == "__main__":
    main()
