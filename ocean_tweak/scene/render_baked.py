# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders frames of the open .blend file from baked seas: a script that a farm runs, complete by itself.

blender --background SHOT.blend --python-exit-code 1 --python render_baked.py --
        --cache DIR --bake NAME-UID/hash8 --pictures DIR --frames 1-25

Where Blender has the Ocean Tweak extension, oceans read the bake from now on, whatever moved them before.
Where it has not, images of a sequence with the bake's name are looked for in the bake's folder.
"""

from __future__ import annotations

import argparse
import importlib
import json
import re
import sys
from pathlib import Path

import bpy

_FILE = re.compile(r"(?P<name>.+)_(?:disp|foam|normal|vel)\.[^.]*\.exr")
_RANGE = re.compile(r"(-?\d+)(?:-(-?\d+)(?::(\d+))?)?")


class RenderError(RuntimeError):
    """What keeps the shot from being rendered, and what to do."""


class Bake:
    """A sea's baked frames.

    text : NAME-UID/hash8, a folder of the cache and what the version's own ends with
    """

    def __init__(self, cache: Path, text: str) -> None:
        home, _, hash8 = text.rpartition("/")
        self.name = home.rpartition("-")[0]
        folders = sorted((cache / home).glob(f"v*-{hash8}"))
        if not folders:
            raise RenderError(
                f"{cache / home} holds no bake v...-{hash8}: bake the sea, or write the job anew"
            )
        self.folder = folders[0].resolve()

    def check(self, frames: list[int]) -> None:
        """Raise RenderError unless all frames are there: Blender would show a flat sea."""
        for frame in frames:
            # 0007, -007, 12345
            path = self.folder / f"{self.name}_disp.{frame:04d}.exr"
            if not path.is_file():
                raise RenderError(f"{path} is missing: bake and verify this frame again")


def main() -> None:
    """Do as the arguments after "--" say; what is wrong is said in a line, with exit code 1."""
    arguments = parse(sys.argv[sys.argv.index("--") + 1 :])
    ranges = frame_ranges(arguments.frames)
    try:
        bakes = [Bake(arguments.cache, text) for text in arguments.bake]
        frames = [frame for part in ranges for frame in part]
        for bake in bakes:
            bake.check(frames)
            show(bake, frames, alone=len(bakes) == 1)
        render(ranges, arguments.pictures, arguments.openjd)
    except RuntimeError as error:  # also what Blender's render operator raises
        message = " ".join(str(error).split())
        if arguments.openjd:
            print(f"openjd_fail: {message}", flush=True)
        sys.exit(f"render_baked: {message}")


def parse(argv: list[str]) -> argparse.Namespace:
    """The arguments after "--"."""
    parser = argparse.ArgumentParser(prog="render_baked.py")
    parser.add_argument("--cache", type=Path, required=True, help="folder of all bakes")
    parser.add_argument("--bake", action="append", required=True, metavar="NAME-UID/hash8")
    parser.add_argument("--pictures", type=Path, required=True, help="folder for the pictures")
    parser.add_argument("--frames", required=True, metavar="RANGE", help="1-25, 1-99:2 or 1,5,7-9")
    parser.add_argument("--openjd", action="store_true", help="print openjd_progress lines")
    return parser.parse_args(argv)


def frame_ranges(text: str) -> list[range]:
    """The ranges of 1-25, 1-99:2 or 1,5,7-9. Exits with code 2 for anything else."""
    ranges = []
    for part in text.split(","):
        match = _RANGE.fullmatch(part.strip())
        if match is None:
            print(f"render_baked: --frames {text}: {part!r} is no range", file=sys.stderr)
            sys.exit(2)
        first, last, step = int(match[1]), int(match[2] or match[1]), int(match[3] or 1)
        ranges.append(range(first, last + 1, step))
    return ranges


def show(bake: Bake, frames: list[int], alone: bool) -> None:
    """Let the file's oceans read the bake's frames. Raises RenderError where nothing in the file would.

    alone : whether there is no other bake, so that a file's only ocean is meant whatever its name is
    """
    images = [image for image in bpy.data.images if sequence_name(image) == bake.name]
    oceans = [item for item in bpy.data.objects if is_ocean(item)]
    named = [item for item in oceans if re.sub(r"[^\w\- ]+", "_", item.name).strip() == bake.name]
    meant = named or (oceans if alone and len(oceans) == 1 else [])
    for item in meant:
        use_sequence(item, bake, frames)
    if meant:
        return
    for image in images:
        image.filepath = str(bake.folder / file_name(image))
        image.reload()
    if not images:
        known = ", ".join(item.name for item in oceans) or "none that this Blender knows"
        raise RenderError(
            f"{bpy.data.filepath} has no images named {bake.name}_disp and no ocean {bake.name} (its oceans: "
            f"{known}): let its ocean read a baked sequence, or name the bake like the ocean"
        )


def is_ocean(item: bpy.types.Object) -> bool:
    """Whether the extension is there and takes the object for an ocean."""
    settings = getattr(item, "ocean_tweak", None)
    return bool(getattr(settings, "is_ocean", False)) and bool(item.users_scene)


def use_sequence(item: bpy.types.Object, bake: Bake, frames: list[int]) -> None:
    """Let the extension switch an ocean to the bake. Raises RenderError where it cannot."""
    package = type(item.ocean_tweak).__module__.rpartition(".ui.")[0]
    ocean_object = importlib.import_module(f"{package}.scene.ocean_object")
    sequences = importlib.import_module(f"{package}.scene.image_sequence")
    scene = item.users_scene[0]
    baked = json.loads((bake.folder / "bake.json").read_text(encoding="utf-8"))["shot"]["domain_size"]
    own = item.ocean_tweak.to_parameters(scene).domain_size
    if abs(own - baked) > 1e-6 * baked:
        raise RenderError(
            f"{item.name} is {own:g} m wide, the bake {bake.folder} {baked:g} m: give both one size"
        )
    sequence = sequences.ImageSequence(bake.folder, bake.name, tuple(sorted(set(frames))))
    try:
        ocean_object.use_sequence(item, scene, sequence)
    except ValueError as error:
        raise RenderError(f"{item.name}: {error}") from error
    print(f"{item.name} reads {bake.folder}", flush=True)


def file_name(image: bpy.types.Image) -> str:
    """The name of an image's file, from a path of whichever system."""
    return re.split(r"[\\/]", image.filepath)[-1]


def sequence_name(image: bpy.types.Image) -> str:
    """The bake's name in that of a sequence's file; "" for other images."""
    match = _FILE.fullmatch(file_name(image)) if image.source == "SEQUENCE" else None
    return match["name"] if match else ""


def render(ranges: list[range], pictures: Path, openjd: bool) -> None:
    """Render the frames of the file's scene into PICTURES/FILE_####, in the file's format."""
    scene = bpy.context.scene
    if scene.render.is_movie_format:
        raise RenderError(f"{scene.name} renders a movie: choose pictures, a farm makes each frame by itself")
    scene.render.filepath = str(pictures.resolve() / f"{Path(bpy.data.filepath).stem}_####")
    total, done = sum(map(len, ranges)), 0

    def tell(*_: object) -> None:
        nonlocal done
        done += 1
        if openjd:
            print(f"openjd_progress: {100.0 * done / total:.1f}", flush=True)

    bpy.app.handlers.render_write.append(tell)
    for part in ranges:
        scene.frame_start, scene.frame_end, scene.frame_step = part.start, part[-1], part.step
        bpy.ops.render.render(animation=True)


if __name__ == "__main__":
    main()
