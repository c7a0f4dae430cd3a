# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the scenes of docs/papers in Blender, and measures the frame time of Chen's figure 3.

python3 -m tools.blender --in 5.2 tools/papers/render.py -- [--only PAGE/NAME ...] [--measured FILE.json]
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
import os
import sys
import time
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import Any

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "examples")]

from extension import Extension, enable  # noqa: E402  found by the path above
from gallery import ANISOTROPIC_FILTERS, render  # noqa: E402

from ocean_tweak.core import OceanParameters  # noqa: E402
from tools.papers import chen, horvath, lantz, mastin  # noqa: E402
from tools.papers.pages import PAGES  # noqa: E402

WIDTH, SAMPLES = 480, 32

#: patches along a side of Chen's scene
PATCHES = 17


def main() -> None:
    """Render as the command line says."""
    parser = argparse.ArgumentParser(prog="render.py")
    parser.add_argument("--only", nargs="+", default=tuple(SCENES), choices=tuple(SCENES))
    parser.add_argument("--measured", type=Path, help="where frame times go; without, none are measured")
    arguments = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    os.environ.setdefault("MESA_EXTENSION_OVERRIDE", ANISOTROPIC_FILTERS)
    extension = enable()
    for name in arguments.only:
        bpy.ops.wm.read_homefile(use_empty=True)
        SCENES[name](extension)
        settings(bpy.context.scene)
        raw = ROOT / "build" / "papers" / f"{name.replace('/', '-')}.png"
        raw.parent.mkdir(parents=True, exist_ok=True)
        render(bpy.context.scene, 1, raw)
        save_jpeg(raw, PAGES / f"{name}.jpg")
    if arguments.measured:
        found = {str(samples): frame_time(extension, samples) for samples in (128, 256)}
        arguments.measured.parent.mkdir(parents=True, exist_ok=True)
        arguments.measured.write_text(json.dumps(found))


def settings(scene: bpy.types.Scene) -> None:
    """Small and quick."""
    scene.render.use_motion_blur = False
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, WIDTH * 9 // 16
    scene.cycles.device = "CPU"
    scene.cycles.samples = scene.eevee.taa_render_samples = SAMPLES
    scene.cycles.max_bounces = 4
    scene.cycles.use_denoising = True
    scene.cycles.denoiser = "OPENIMAGEDENOISE"


def save_jpeg(picture: Path, path: Path) -> None:
    """The picture as a small JPEG."""
    path.parent.mkdir(parents=True, exist_ok=True)
    image = bpy.data.images.load(str(picture))
    image.pixels[0] = image.pixels[0]  # or Blender copies the file as it is
    image.file_format = "JPEG"
    image.save(filepath=str(path), quality=82)


def build(
    extension: Extension,
    sea: OceanParameters,
    base: str,
    towards: float,
    engine: str = "CYCLES",
    light: Mapping[str, float] = MappingProxyType({}),
    **look: Any,
) -> bpy.types.Object:
    """One of the extension's own scenes with a sea of ours; `look` changes fields of its mood.

    towards : where the waves run, rad counter-clockwise from the view
    light : of fields of its sky
    """
    moods, stage = extension.module("scene.moods"), extension.module("scene.surroundings")
    layers = tuple(
        layer.changed(wind_direction=moods.VIEW + towards) if layer.kind == "WAVES" else layer
        for layer in sea.layers
    )
    given = extension.module("core").OceanParameters.from_json(sea.replace(layers=layers).to_json())
    half = given.replace(foam=dataclasses.replace(given.foam, resolution=given.resolution // 2))

    class Given(moods.Mood):  # type: ignore[misc, name-defined]
        def sea(self, timing: object) -> object:
            return half.replace(timing=timing)

    fields = {field.name: getattr(moods.MOODS[base], field.name) for field in dataclasses.fields(moods.Mood)}
    sky = dataclasses.replace(fields["sky"], **light)
    moods.MOODS["PAPER"] = Given(**{**fields, **look, "sky": sky})
    wishes = stage.Wishes(engine=engine, afloat=False)
    return stage.build(bpy.context.scene, "PAPER", wishes).ocean


def figure_6(extension: Extension, engine: str = "CYCLES") -> None:
    """Horvath's figure 6."""
    build(extension, horvath.FIGURE_6, "STORM", math.radians(160.0), engine, eye=4.0, rings=2)


def figure_7(extension: Extension, engine: str = "CYCLES") -> None:
    """Horvath's figure 7."""
    build(extension, horvath.FIGURE_7, "STORM", math.radians(160.0), engine, eye=6.0, rings=2)


def patches(extension: Extension, sea: OceanParameters = chen.PATCH) -> bpy.types.Object:
    """Chen's figure 3: 17 x 17 patches of 256 m."""
    return build(
        extension, sea, "FRESH_BREEZE", math.radians(215.0), rings=PATCHES // 2, eye=25.0,
        tilt=math.radians(6.0),
    )  # fmt: skip


def fog(extension: Extension) -> None:
    """Lantz's surface with lighting and fog."""
    build(
        extension, lantz.PATCH, "FRESH_BREEZE", math.radians(200.0), rings=7, eye=5.0,
        light={
            "clouds": 0.2, "sun_elevation": math.radians(20.0), "sun_azimuth": math.radians(100.0),
            "visibility": 250.0,
        },
    )  # fmt: skip


def ray_traced(extension: Extension) -> None:
    """Mastin's figure 9: his heights, three tenths of blue and seven of the mirrored sky."""
    heights = mastin.heights()
    n, spacing = len(heights), mastin.SIDE / len(heights)
    x, y = np.meshgrid(spacing * np.arange(n), spacing * np.arange(n))
    corners = np.arange(n * n).reshape(n, n)
    quads = np.stack([corners[:-1, :-1], corners[:-1, 1:], corners[1:, 1:], corners[1:, :-1]], axis=-1)
    mesh = bpy.data.meshes.new("Sea")
    mesh.from_pydata(np.stack([x, y, heights], axis=-1).reshape(-1, 3), [], quads.reshape(-1, 4).tolist())
    mesh.shade_smooth()
    mesh.materials.append(_blue_and_mirror())
    scene = bpy.context.scene
    scene.collection.objects.link(bpy.data.objects.new("Sea", mesh))
    stage, sky = extension.module("scene.surroundings"), extension.module("scene.sky")
    extension.module("scene.scene_sky").put(scene, sky.Sky(math.radians(18.0), math.radians(60.0), 0.4))
    stage.set_engine(scene, "CYCLES")
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.camera.data.clip_end = 1e5
    scene.camera.location = (0.5 * mastin.SIDE, 0.1 * mastin.SIDE, 45.0)
    scene.camera.rotation_euler = (math.radians(83.0), 0.0, 0.0)
    scene.collection.objects.link(scene.camera)


def _blue_and_mirror() -> bpy.types.Material:
    material = bpy.data.materials.new("Water")
    if material.node_tree is None:
        material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    mix, blue, mirror = (
        nodes.new(f"ShaderNode{kind}") for kind in ("MixShader", "BsdfDiffuse", "BsdfGlossy")
    )
    blue.inputs["Color"].default_value = (0.02, 0.1, 0.25, 1.0)
    mirror.inputs["Roughness"].default_value = 0.0
    mix.inputs["Fac"].default_value = 0.7
    links.new(blue.outputs[0], mix.inputs[1])
    links.new(mirror.outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def frame_time(extension: Extension, samples: int) -> float:
    """Milliseconds from one frame of Chen's scene to the next: the sea and all of its copies evaluated."""
    bpy.ops.wm.read_homefile(use_empty=True)
    ocean = patches(extension, chen.PATCH.replace(resolution=samples))
    ocean.ocean_tweak.viewport_resolution = samples
    horizon = next(child for child in ocean.children if child.modifiers)
    extension.module("nodes.modifier_inputs").set_input(horizon.modifiers[0], "Viewport Rings", PATCHES // 2)
    scene, took = bpy.context.scene, []
    for frame in range(1, 14):
        before = time.perf_counter()
        scene.frame_set(frame)
        took.append(time.perf_counter() - before)
    return 1e3 * float(np.median(took[3:]))


#: page and name of a picture → what makes its scene
SCENES: dict[str, Callable[[Extension], object]] = {
    "horvath-2015/figure-6": figure_6,
    "horvath-2015/figure-6-eevee": partial(figure_6, engine="EEVEE"),
    "horvath-2015/figure-7": figure_7,
    "horvath-2015/figure-7-eevee": partial(figure_7, engine="EEVEE"),
    "chen-2014/figure-3": patches,
    "mastin-1987/figure-9": ray_traced,
    "lantz/fog": fog,
}


if __name__ == "__main__":
    main()
