# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders stills of the ocean scenes that one press makes, and of others beside them.

python3 -m tools.blender --in 5.2 examples/gallery.py -- --out build/gallery

--jpeg DIR also writes the pictures there as JPEG files of at most 200 kB, as docs/gallery has them.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import os
import sys
import time
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))

from cloud_shadows import CloudShadows
from cloud_shadows import add as add_cloud_shadows
from extension import Extension, enable

LARGEST = 200_000  # bytes
ENGINES = ("CYCLES", "EEVEE")
#: where Mesa's driver draws EEVEE on a processor, the horizon's images take minutes a sample with it
ANISOTROPIC_FILTERS = "-GL_EXT_texture_filter_anisotropic -GL_ARB_texture_filter_anisotropic"


class Shot(NamedTuple):
    """A ready scene, or one with another sea, sky or camera.

    mood : of the scene
    wind : speed in m/s and fetch in m of another sea, on patches down to waves of a fifth of a metre; None
        for the mood's own
    changes : of fields of the mood
    sky : a key of SKIES, for another sky than the mood's
    light : of fields of the sky
    foam : as a share of what the wind leaves
    is_afloat : whether something floats before the camera
    away : how far that is, at least and at most, in m; None for where the mood has it
    shadows : of clouds on the water
    frame : of the still
    """

    mood: str
    wind: tuple[float, float] | None = None
    changes: Mapping[str, float] = MappingProxyType({})
    sky: str = ""
    light: Mapping[str, float] = MappingProxyType({})
    foam: float = 1.0
    is_afloat: bool = True
    away: tuple[float, float] | None = None
    shadows: CloudShadows | None = None
    frame: int = 1


SHOTS = {
    "calm": Shot("CALM"),
    "fresh-breeze": Shot(
        "FRESH_BREEZE", (10.5, 120e3), foam=3.0,
        changes={
            "rings": 0, "eye": 4.2, "crest_distance": 13.0, "vertices": 600_000, "tilt": math.radians(4.0),
        },
    ),
    "storm": Shot("STORM"),
    "backlit-crest": Shot(
        "FRESH_BREEZE", (14.0, 80e3), is_afloat=False,
        changes={
            "rings": 0, "eye": 1.2, "crest_distance": 9.0, "lens": 70.0, "tilt": math.radians(-2.5),
            "vertices": 600_000,
        },
        light={"sun_azimuth": math.radians(96.0), "sun_elevation": math.radians(13.0), "clouds": 0.35},
        frame=45,
    ),
    "aerial-60m": Shot(
        "FRESH_BREEZE", (13.0, 200e3), away=(150.0, 210.0), foam=2.5,
        changes={"eye": 60.0, "tilt": math.radians(10.0), "lens": 32.0, "rings": 0},
        light={
            "sun_azimuth": math.radians(128.0), "sun_elevation": math.radians(17.0), "exposure": -0.1,
            "visibility": 60e3,
        },
    ),
    "aerial-300m": Shot(
        "STORM", away=(780.0, 950.0), shadows=CloudShadows(size=2200.0, left=0.15),
        changes={"eye": 300.0, "tilt": math.radians(11.5), "lens": 35.0},
        light={
            "sun_azimuth": math.radians(12.0), "sun_elevation": math.radians(24.0), "clouds": 0.65,
            "overcast": 0.12, "exposure": 0.0, "visibility": 35e3,
        },
    ),
    "golden-hour": Shot(
        "FRESH_BREEZE", (9.0, 80e3), sky="GOLDEN_HOUR", foam=1.5, away=(85.0, 115.0),
        light={
            "sun_azimuth": math.radians(98.0), "sun_elevation": math.radians(4.6), "clouds": 0.6,
            "exposure": 0.9,
        },
        changes={
            "eye": 3.6, "lens": 60.0, "tilt": math.radians(1.6), "rings": 0, "crest_distance": 14.0,
            "vertices": 600_000,
        },
    ),
    "dusk": Shot("CALM", sky="DUSK", away=(55.0, 75.0)),
    "moonlit-night": Shot("FRESH_BREEZE", sky="MOONLIT_NIGHT", away=(75.0, 95.0)),
    "storm-light": Shot(
        "STORM", sky="STORM_LIGHT", light={"sun_azimuth": math.radians(130.0)},
        changes={"lens": 50.0, "tilt": math.radians(-3.5)},
    ),
    "beach": Shot("BEACH", frame=40),
    "harbour": Shot("HARBOUR", frame=40),
    "islet": Shot("ISLET", frame=40),
}  # fmt: skip


def main() -> None:
    """Render as the command line says."""
    arguments = parse(sys.argv[sys.argv.index("--") + 1 :])
    os.environ.setdefault("MESA_EXTENSION_OVERRIDE", ANISOTROPIC_FILTERS)
    extension = enable()
    for name in arguments.shots:
        for engine in arguments.engines:
            build(extension, SHOTS[name], engine)
            set_quality(bpy.context.scene, arguments.width, arguments.samples)
            bpy.context.scene.render.use_motion_blur = not arguments.still
            picture = arguments.out.resolve() / f"{name}-{engine.lower()}.png"
            render(bpy.context.scene, arguments.frame or SHOTS[name].frame, picture)
            if arguments.jpeg:
                save_jpeg(picture, arguments.jpeg.resolve() / f"{picture.stem}.jpg")


def parse(argv: list[str]) -> argparse.Namespace:
    """The arguments after "--"."""
    parser = picture_parser("gallery.py")
    parser.add_argument("--shots", nargs="+", default=tuple(SHOTS), choices=SHOTS)
    parser.add_argument("--engines", nargs="+", default=ENGINES, choices=ENGINES)
    parser.set_defaults(frame=0)
    parser.add_argument("--still", action="store_true", help="without motion blur")
    return parser.parse_args(argv)


def picture_parser(program: str) -> argparse.ArgumentParser:
    """What every gallery is asked for: where pictures go, how large and how clean they are, and the frame."""
    parser = argparse.ArgumentParser(prog=program)
    parser.add_argument("--out", type=Path, required=True, help="folder for the pictures")
    parser.add_argument("--jpeg", type=Path, help="folder for small JPEG files of them")
    parser.add_argument("--width", type=int, default=1280, help="pixels; the height is 27/64 of it")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--frame", type=int, default=1, help="in place of each picture's own")
    return parser


def build(extension: Extension, shot: Shot, engine: str) -> None:
    """A new file with the scene of a shot, ready to render."""
    moods, surroundings = extension.module("scene.moods"), extension.module("scene.surroundings")
    bpy.ops.wm.read_homefile(use_empty=True)
    mood = (moods.MOODS | moods.COASTS)[shot.mood]
    sky = extension.module("scene.skies").SKIES[shot.sky].sky if shot.sky else mood.sky
    mood = dataclasses.replace(mood, **shot.changes, sky=dataclasses.replace(sky, **shot.light))
    if shot.wind is not None:
        mood = dataclasses.replace(mood, waves=partial(wind_sea, extension, *shot.wind, shot.foam))
    if shot.away is not None:
        afloat = extension.module("scene.afloat").AFLOAT
        nearest, farthest = shot.away
        afloat["SHOT"] = dataclasses.replace(afloat["BOAT"], nearest=nearest, farthest=farthest)
        mood = dataclasses.replace(mood, floats="SHOT")
    scene, wishes = bpy.context.scene, surroundings.Wishes(engine=engine, afloat=shot.is_afloat)
    if mood.shore is None:
        moods.MOODS["SHOT"] = mood
        surroundings.build(scene, "SHOT", wishes)
    else:
        moods.COASTS["SHOT"] = mood
        extension.module("scene.coast_scene").build(scene, "SHOT", wishes)
    if shot.shadows is not None:
        add_cloud_shadows(extension, scene, shot.shadows)


def wind_sea(extension: Extension, wind_speed: float, fetch: float, foam: float) -> Any:
    """Parameters of a wind's sea that runs towards the camera, with so much of the usual foam."""
    core, plan = extension.module("core"), extension.module("core.sea.patch_plan")
    direction = extension.module("scene.moods").VIEW + math.radians(205.0)
    layer = core.WaveLayer(wind_speed=wind_speed, fetch=fetch, wind_direction=direction, swell=0.3)
    return plan.planned(
        core.OceanParameters(seed=3, layers=(layer,), foam=core.Foam(coverage=foam)),
        plan.Wish(finest=0.2, area=900.0),
    )


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


def save_jpeg(picture: Path, path: Path, most: int = LARGEST) -> None:
    """The picture as the best JPEG of so many bytes at most. Raises RuntimeError if there is none."""
    path.parent.mkdir(parents=True, exist_ok=True)
    image = bpy.data.images.load(str(picture))
    image.pixels[0] = image.pixels[0]  # or Blender copies the file as it is
    image.file_format = "JPEG"
    for quality in range(94, 40, -3):
        image.save(filepath=str(path), quality=quality)
        if path.stat().st_size < most:
            return
    raise RuntimeError(f"{path} stays above {most} bytes")


if __name__ == "__main__":
    main()
