# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders a small picture of every preset, as the presets' menu shows them.

python3 -m tools.blender --in 5.2 examples/thumbnails.py -- --out ocean_tweak/ui/thumbnails

Each is the sea of its preset under the sky of the mood nearest to its wave height, seen from the same height
in terms of its waves.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import sys
import tempfile
from pathlib import Path

import bpy
from PIL import Image

sys.path.insert(0, str(Path(__file__).resolve().parent))

from extension import enable

SIZE = 192  # pixels
QUALITY = 88
SAMPLES = 256  # of the sea along each side: more cannot be seen
PATCH = 400.0  # m, of seas of several patches
SEEN = 1200.0  # m of water around the camera
MOST_RINGS = 40
#: wave heights in m up to which a mood serves
MOODS = ((0.8, "CALM"), (4.5, "FRESH_BREEZE"), (math.inf, "STORM"))


def main() -> None:
    """Render as the command line says."""
    arguments = parse(sys.argv[sys.argv.index("--") + 1 :])
    extension = enable()
    presets = extension.module("core.parameters.presets").built_in()
    arguments.out.mkdir(parents=True, exist_ok=True)
    for key in arguments.presets or presets:
        build(extension, presets[key].parameters)
        render(arguments.out.resolve() / f"{key}.jpg", arguments.samples)


def parse(argv: list[str]) -> argparse.Namespace:
    """The arguments after "--"."""
    parser = argparse.ArgumentParser(prog="thumbnails.py")
    parser.add_argument("--out", type=Path, required=True, help="folder for the pictures")
    parser.add_argument("--presets", nargs="*", help="keys of presets; all by default")
    parser.add_argument("--samples", type=int, default=48)
    return parser.parse_args(argv)


def build(extension, parameters) -> None:
    """A new file with the preset's sea, its sky and a camera."""
    core, stage = extension.module("core"), extension.module("scene.surroundings")
    moods = extension.module("scene.moods")
    bpy.ops.wm.read_homefile(use_empty=True)
    scene = bpy.context.scene
    if parameters.patches:  # so near, the sea of one patch looks the same
        parameters = parameters.without_patches.replace(domain_size=PATCH)
    height = core.Ocean(parameters.replace(resolution=64)).statistics().significant_wave_height
    key = next(name for limit, name in MOODS if height <= limit)
    usual = moods.MOODS[key]
    mood = dataclasses.replace(
        usual, eye=2.0 * height, crest_distance=18.0, lens=35.0, rings=usual.rings or 3
    )
    moods.MOODS[key] = mood
    made = stage.build(scene, key, stage.Wishes(afloat=False))
    of_mood = mood.sea(parameters.timing)
    turn = of_mood.layers[0].wind_direction
    turned = tuple(
        dataclasses.replace(layer, wind_direction=layer.wind_direction + turn) for layer in parameters.layers
    )
    sea = parameters.replace(resolution=SAMPLES, layers=turned, seed=of_mood.seed)
    settings = made.ocean.ocean_tweak
    settings.viewport_resolution = SAMPLES
    settings.from_parameters(sea, scene)
    half = 0.5 * sea.domain_size
    made.ocean.location = (-half, -half, 0.0)
    set_input = extension.module("nodes.modifier_inputs").set_input
    rings = min(max(3, math.ceil(SEEN / sea.domain_size)), MOST_RINGS)
    horizon = bpy.data.objects[f"{made.ocean.name} Horizon"]
    set_input(horizon.modifiers[0], "Rings", rings)
    scene.camera = stage.new_camera(mood, stage.camera_place(mood, sea), made.ocean, scene)
    scene.camera.data.clip_start = 0.01
    scene.collection.objects.link(scene.camera)


def render(path: Path, samples: int) -> None:
    """Render a square still into a JPEG file."""
    scene = bpy.context.scene
    scene.render.use_motion_blur = False
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_denoising = True
    scene.cycles.denoiser = "OPENIMAGEDENOISE"
    scene.render.image_settings.file_format = "PNG"
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "picture.png")
        bpy.ops.render.render(write_still=True)
        # Blender's own JPEG file would hold more notes than pixels
        with Image.open(scene.render.filepath) as image:
            image.convert("RGB").save(path, quality=QUALITY)
    print(f"{path.name}: {path.stat().st_size // 1000} kB", flush=True)


if __name__ == "__main__":
    main()
