# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders frames of every scene of storm.blend into DIR/<scene>.<frame>.png.

blender --background storm.blend --python examples/storm_render.py -- --frames 1 12 24 --out DIR
"""

from __future__ import annotations

import argparse
import contextlib
import sys
import time
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))

from extension import enable


def main() -> None:
    """Render as the command line says."""
    arguments = parse(sys.argv[sys.argv.index("--") + 1 :])
    if arguments.check:
        check_baked_oceans_move(arguments.frames)
    enable()
    for scene in bpy.data.scenes:
        if arguments.scene in (None, scene.name):
            render_settings(scene, arguments.width, arguments.width * 9 // 16, arguments.samples)
            render(scene, arguments.frames, arguments.out)


def parse(argv: list[str]) -> argparse.Namespace:
    """The arguments after "--"."""
    parser = argparse.ArgumentParser(prog="storm_render.py")
    parser.add_argument("--frames", type=int, nargs="+", required=True)
    parser.add_argument("--out", type=Path, required=True, help="folder for the pictures")
    parser.add_argument("--scene", help="only this scene")
    parser.add_argument("--width", type=int, default=960, help="pixels; the height is 9/16 of it")
    parser.add_argument("--samples", type=int, default=24)
    parser.add_argument(
        "--check", action="store_true", help="first see the baked oceans move without the extension"
    )
    return parser.parse_args(argv)


def render_settings(scene, width=960, height=540, samples=16):
    """Cycles on the processor: few samples, a denoiser where this Blender has one."""
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_adaptive_sampling = True
    scene.cycles.adaptive_threshold = 0.02
    scene.cycles.adaptive_min_samples = 6
    scene.cycles.max_bounces = 2
    scene.cycles.transparent_max_bounces = 64  # layers of mist
    scene.cycles.caustics_reflective = scene.cycles.caustics_refractive = False
    scene.cycles.use_denoising = has_denoiser()
    if scene.cycles.use_denoising:
        scene.cycles.denoiser = "OPENIMAGEDENOISE"
        scene.cycles.denoising_prefilter = "FAST"
    with contextlib.suppress(TypeError):  # a studio's OCIO configuration may lack these
        scene.view_settings.view_transform = "AgX"
        scene.view_settings.look = "AgX - Medium High Contrast"


def has_denoiser():
    """Whether this Blender was built with Open Image Denoise."""
    import _cycles

    return bool(getattr(_cycles, "with_openimagedenoise", False))


def check_baked_oceans_move(frames: list[int]) -> None:
    """Raise RuntimeError if an ocean that reads files stands still while the extension is not enabled."""
    assert not hasattr(bpy.types.Object, "ocean_tweak"), "the extension is enabled already"
    for name in ("Displace", "Geometry nodes"):
        scene = bpy.data.scenes[name]
        heights = [elevation(scene, frame) for frame in (frames[0], frames[-1])]
        moved = float(np.sqrt(np.mean((heights[0] - heights[1]) ** 2)))
        if not (heights[0].std() > 0.1 and moved > 0.1):
            raise RuntimeError(
                f"{name}: frames {frames[0]} and {frames[-1]} differ by only {moved:.3g} m rms"
            )
        particles = count_of_spray(scene)
        if particles == 0:
            raise RuntimeError(f"{name}: there is no spray")
        print(
            f"{name}: without the extension the water moves {moved:.2f} m rms, under {particles} particles",
            flush=True,
        )


def count_of_spray(scene: bpy.types.Scene) -> int:
    """Particles at the frame that is shown."""
    depsgraph = scene.view_layers[0].depsgraph
    item = scene.objects[f"Ocean {scene.name} Spray"].evaluated_get(depsgraph)
    geometry = item.evaluated_geometry()  # keeps the points
    return 0 if geometry.pointcloud is None else len(geometry.pointcloud.points)


def elevation(scene: bpy.types.Scene, frame: int) -> np.ndarray:
    """Heights of the evaluated ocean's vertices at a frame, m."""
    scene.frame_set(frame)
    depsgraph = scene.view_layers[0].depsgraph
    depsgraph.update()
    vertices = bpy.data.objects[f"Ocean {scene.name}"].evaluated_get(depsgraph).data.vertices
    positions = np.empty(3 * len(vertices), np.float32)
    vertices.foreach_get("co", positions)
    return positions[2::3].astype(np.float64)


def render(scene: bpy.types.Scene, frames: list[int], folder: Path) -> None:
    """Render still frames of a scene."""
    scene.render.image_settings.file_format = "PNG"
    # any other scene would be rendered at the frame of the one in the window
    bpy.context.window.scene = scene
    for frame in frames:
        started = time.perf_counter()
        scene.frame_set(frame)
        path = folder.resolve() / f"{scene.name}.{frame:04d}.png"
        scene.render.filepath = str(path)
        bpy.ops.render.render(write_still=True, scene=scene.name)
        if not path.exists():
            raise RuntimeError(f"{path} was not rendered")
        print(f"{scene.name}: frame {frame} in {time.perf_counter() - started:.1f} s", flush=True)


if __name__ == "__main__":
    main()
