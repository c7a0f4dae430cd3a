# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders frames of the open .blend file from baked seas: a script that a farm runs, complete by itself.

blender --background SHOT.blend --python-exit-code 1 --python render_baked.py --
        --cache DIR --bake NAME-UID/hash8 --pictures DIR --frames 1-25

Where Blender has the Ocean Tweak extension, oceans read the bake from now on, whatever moved them before.
Where it has not, images of a sequence with the bake's name are looked for in the bake's folder.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from fractions import Fraction
from pathlib import Path

import bpy

_FILE = re.compile(r"(?P<name>.+)_(?:disp|foam|normal|vel|foam_age)\.[^.]*\.exr")
#: inputs of the ocean's modifiers that are on where the extension computes the sea
_LIVE = ("Live", "Use Attributes")
#: custom property of our node groups, and what it begins with on what a current carries along
_GROUP, _DRIFTLESS = "ocean_tweak_group", "Ocean Tweak Driftless"
#: custom property of the mesh of a patch
_PATCH = "ocean_tweak_patch"
#: inputs of its modifier that hold where its points begin
_POINTS = ("Files", "Viewport Files")
_RANGE = re.compile(r"(-?\d{1,10})(?:-(-?\d{1,10})(?:[x:](\d{1,10}))?)?")
_MOST_FRAMES = 1_000_000


#: exit code where the file needs the extension and this Blender has not got it
_WITHOUT_EXTENSION = 3


class RenderError(RuntimeError):
    """What keeps the shot from being rendered, and what to do."""

    code = 1


class NeedsExtension(RenderError):
    """What only the extension could move."""

    code = _WITHOUT_EXTENSION


class Bake:
    """A sea's baked frames.

    text : NAME-UID/hash8, a folder of the cache and what the version's own ends with
    """

    def __init__(self, cache: Path, text: str) -> None:
        home, _, hash8 = text.rpartition("/")
        self.name, _, self.uid = home.rpartition("-")
        folders = sorted((cache / home).glob(f"v*-{hash8}"))
        if not folders:
            raise RenderError(
                f"{cache / home} holds no bake v...-{hash8}: bake the sea, or write the job anew"
            )
        self.folder = folders[0].absolute()
        try:
            shot = json.loads((self.folder / "bake.json").read_text(encoding="utf-8"))["shot"]
            self.domain_size = float(shot["domain_size"])
            self.stretch = Fraction(str(shot["timing"].get("stretch", 1)))  # 0.7 is 7/10
        except (OSError, ValueError, KeyError, TypeError, AttributeError, ZeroDivisionError) as error:
            raise RenderError(f"{self.folder / 'bake.json'} cannot be read: {error!r}") from error

    def check(self, frames: list[int]) -> None:
        """Raise RenderError unless all frames are there, with the scene's Time Stretching: Blender would show
        a flat sea, or other frames."""
        render = bpy.context.scene.render
        stretch = Fraction(render.frame_map_new, render.frame_map_old)
        if stretch != self.stretch:
            raise RenderError(
                f"Time Stretching, new / old, is {stretch} in {bpy.data.filepath} and {self.stretch} in the "
                f"bake {self.folder}: give both the same"
            )
        for frame in frames:
            # 0007, -007, 12345
            path = self.folder / f"{self.name}_disp.{frame:04d}.exr"
            if not path.is_file():
                raise RenderError(f"{path} is missing: bake and verify this frame again")


def main() -> None:
    """Do as the arguments after "--" say; what is wrong is said in a line, with exit code 1, or 3 where this
    Blender lacks the extension."""
    arguments = parse(sys.argv[sys.argv.index("--") + 1 :])
    ranges = frame_ranges(arguments.frames)
    try:
        bakes = [Bake(arguments.cache, text) for text in arguments.bake]
        frames = [frame for part in ranges for frame in part]
        check_extension()
        for bake in bakes:
            bake.check(frames)
            show(bake, frames, alone=len(bakes) == 1)
        render(ranges, arguments.pictures, arguments.openjd)
    except RuntimeError as error:  # also what Blender's render operator raises
        message = " ".join(str(error).split())
        if arguments.openjd:
            print(f"openjd_fail: {message}", flush=True)
        print(f"render_baked: {message}", file=sys.stderr)
        sys.exit(getattr(error, "code", 1))


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
        if last < first or step < 1:
            print(f"render_baked: --frames {text}: {part!r} holds no frames", file=sys.stderr)
            sys.exit(2)
        ranges.append(range(first, last + 1, step))
    least, most = min(part[0] for part in ranges), max(part[-1] for part in ranges)
    # counted before they are made; which of those in between are baked is written out too
    if max(sum(map(len, ranges)), most - least) > _MOST_FRAMES:
        print(f"render_baked: --frames {text[:80]}: must be at most {_MOST_FRAMES} frames", file=sys.stderr)
        sys.exit(2)
    return ranges


def show(bake: Bake, frames: list[int], alone: bool) -> None:
    """Let the file's oceans read the bake's frames. Raises RenderError where nothing in the file would.

    alone : whether there is no other bake, so that a file's only ocean is meant whatever its name is
    """
    images = [image for image in bpy.data.images if sequence_name(image) == bake.name]
    oceans = [item for item in bpy.data.objects if scene_of(item) is not None]
    named = [item for item in oceans if re.sub(r"[^\w\- ]+", "_", item.name).strip() == bake.name]
    meant = named or (oceans if alone and len(oceans) == 1 else [])
    for item in meant:
        use_sequence(item, bake, frames)
    if meant:
        return
    if not images:
        known = ", ".join(item.name for item in oceans) or "none that this Blender knows"
        raise RenderError(
            f"{bpy.data.filepath} has no images named {bake.name}_disp and no ocean {bake.name} (its oceans: "
            f"{known}): let its ocean read a baked sequence, or name the bake like the ocean"
        )
    for image in images:
        image.filepath = str(bake.folder / file_name(image))
        image.reload()
    show_frames(bake, images, frames)


def check_extension() -> None:
    """Raise NeedsExtension where the file has what only the extension moves, and it is not here."""
    if hasattr(bpy.types.Object, "ocean_tweak"):
        return
    scene = bpy.context.scene
    # what floating objects float on is in no scene
    shown = (item for item in bpy.data.objects if scene in item.users_scene or is_driftless(item))
    live = (item for item in shown if is_live(item))
    # nobody knows the hidden meshes of patches
    still = sorted({item.parent.name if _PATCH in item and item.parent else item.name for item in live})
    if still:
        raise NeedsExtension(
            f"this Blender has no Ocean Tweak extension, which alone moves {', '.join(still)} of "
            f"{bpy.data.filepath}: enable it on this machine, or do what the file's panel Bake lists under "
            "Renders Need Ocean Tweak, and save it"
        )


def is_driftless(item: bpy.types.Object) -> bool:
    """Whether something that a current carries along floats on an object."""
    groups = [modifier.node_group for modifier in item.modifiers if modifier.type == "NODES"]
    return any(group is not None and str(group.get(_GROUP, "")).startswith(_DRIFTLESS) for group in groups)


def is_live(item: bpy.types.Object) -> bool:
    """Whether an object waits for the extension, as its modifiers or, of a patch, their absence tell."""
    groups = [modifier.node_group for modifier in item.modifiers if modifier.type == "NODES"]
    if _PATCH in item:
        return not any(group is not None and _POINTS[0] in group_inputs(group) for group in groups)
    for modifier in item.modifiers:
        group = modifier.node_group if modifier.type == "NODES" else None
        if group is not None and str(group.get(_GROUP, "")).startswith("Ocean Tweak "):
            sockets = group_inputs(group)
            if any(modifier_input(modifier, sockets[name]) for name in _LIVE if name in sockets):
                return True
    return False


def scene_of(item: bpy.types.Object) -> bpy.types.Scene | None:
    """The scene that shows an object which the extension, where it is there, takes for an ocean."""
    return item.ocean_tweak.shown_in() if hasattr(item, "ocean_tweak") else None


def use_sequence(item: bpy.types.Object, bake: Bake, frames: list[int]) -> None:
    """Let the extension switch an ocean to the bake. Raises RenderError where it cannot."""
    settings, baked = item.ocean_tweak, bake.domain_size
    own = settings.to_parameters(scene_of(item)).domain_size
    if abs(own - baked) > 1e-6 * baked:
        raise RenderError(
            f"{item.name} is {own:g} m wide, the bake {bake.folder} {baked:g} m: give both one size"
        )
    try:
        settings.use_sequence(bake.folder, bake.name, sorted(set(frames)))
    except ValueError as error:
        raise RenderError(f"{item.name}: {error}") from error
    if settings.own_uid() == bake.uid:  # baked from this very ocean
        check_settings(item, bake, frames)
    print(f"{item.name} reads {bake.folder}", flush=True)


def check_settings(item: bpy.types.Object, bake: Bake, frames: list[int]) -> None:
    """Raise RenderError where an ocean was changed after its bake: the picture would be of another sea."""
    scene = item.users_scene[0]
    for frame in sorted({frames[0], frames[len(frames) // 2], frames[-1]}):
        scene.frame_set(frame)
        if item.ocean_tweak.bake_differs:
            path, baked, own = json.loads(item.ocean_tweak.bake_differs)[0]
            raise RenderError(
                f"{item.name} was changed after its bake {bake.folder}: {path} is {own} and was {baked} in "
                f"frame {frame}. Bake it again and write the job anew, or press Settings From Bake"
            )


def show_points(modifier: bpy.types.NodesModifier, bake: Bake, frames: list[int]) -> bool:
    """Let a modifier that reads points, a coast or spray of such a bake read this one's. Returns whether it
    does.

    Raises RenderError where the bake has none.
    """
    sockets = group_inputs(modifier.node_group)
    for name in (name for name in _POINTS if name in sockets):
        begin = re.split(r"[\\/]", str(modifier_input(modifier, sockets[name])))[-1]
        is_spray = begin == f"{bake.name}_spray."
        is_coast = begin == f"{bake.name}_coast."
        is_wakes = begin == f"{bake.name}_wakes."
        if not (is_spray or is_coast or is_wakes or begin.startswith(f"{bake.name}_p")):
            return False
        folder = bake.folder / "spray" if is_spray else bake.folder
        path = folder / f"{begin}{frames[0]:04d}.ply"
        if not path.is_file():
            kind, remedy = ("spray", " with --spray") if is_spray else ("points of patches", "")
            kind = "points of a coast" if is_coast else "wakes" if is_wakes else kind
            raise RenderError(
                f"{path} is missing: {modifier.id_data.name} reads {kind}; write the job anew from the "
                f".blend file{remedy}, so that they are baked"
            )
        modifier_input(modifier, sockets[name], str(folder / begin))
    return _POINTS[0] in sockets


def show_frames(bake: Bake, images: list[bpy.types.Image], frames: list[int]) -> None:
    """Let the modifiers that read a bake know its frames, which may be others than before.

    Raises RenderError for frames before 0, or from 0 on, where they have no images of such.
    """
    shown = {file_name(image).split(".")[-2].startswith("-") for image in images}
    lost = [frame for frame in frames if (frame < 0) not in shown]
    if lost:
        side = "before 0" if lost[0] < 0 else "from 0 on"
        raise RenderError(
            f"frame {lost[0]}: {bpy.data.filepath} reads no frames {side}: let its ocean read a baked "
            "sequence that has some"
        )
    first, last, baked = min(frames), max(frames), set(frames)
    values = {
        "First Frame": first,
        "Last Frame": last,
        "Baked Frames": "".join("1" if frame in baked else "0" for frame in range(last, first - 1, -1)),
        "Files per Frame": float(bake.stretch),
    }
    modifiers = [modifier for item in bpy.data.objects for modifier in item.modifiers]
    for modifier in modifiers:
        if modifier.type != "NODES" or modifier.node_group is None:
            continue
        sockets = group_inputs(modifier.node_group)
        given = [modifier_input(modifier, identifier) for identifier in sockets.values()]
        reads = any(value in images for value in given if isinstance(value, bpy.types.Image))
        if reads or show_points(modifier, bake, frames):
            for name in values.keys() & sockets.keys():
                modifier_input(modifier, sockets[name], values[name])
            modifier.id_data.update_tag()
    for texture in bpy.data.textures:
        if getattr(texture, "image", None) in images:
            # as an ocean's own textures do, which say why
            begin, user = int(first == last), texture.image_user
            user.frame_start, user.frame_offset = first + 1 - begin, first - begin
            user.frame_duration = last - first + begin
            texture.update_tag()


def group_inputs(group: bpy.types.NodeTree) -> dict[str, str]:
    """Identifiers of a group's inputs by name, the geometry not among them."""
    sockets = [socket for socket in group.interface.items_tree if getattr(socket, "in_out", "") == "INPUT"]
    return {
        socket.name: socket.identifier for socket in sockets if socket.socket_type != "NodeSocketGeometry"
    }


def modifier_input(modifier: bpy.types.NodesModifier, identifier: str, value: object = None) -> object:
    """The value of an input, set before where one is given."""
    if hasattr(modifier, "properties"):  # 5.x
        socket = getattr(modifier.properties.inputs, identifier)
        if value is not None:
            socket.value = value
        return socket.value
    if value is not None:
        modifier[identifier] = value
    return modifier.get(identifier)


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
    path = pictures.absolute() / f"{Path(bpy.data.filepath).stem}_####"
    scene.render.filepath = str(path)
    total, done = sum(map(len, ranges)), 0

    def tell(*_: object) -> None:
        nonlocal done
        done += 1
        if openjd:
            print(f"openjd_progress: {100.0 * done / total:.1f}", flush=True)

    bpy.app.handlers.render_write.append(tell)
    for part in ranges:
        # Blender renders no animation before frame 0
        for frame in (frame for frame in part if frame < 0):
            scene.frame_set(frame)
            scene.render.filepath = scene.render.frame_path(frame=frame)
            bpy.ops.render.render(write_still=True)
            scene.render.filepath = str(path)
        later = [frame for frame in part if frame >= 0]
        if later:
            scene.frame_start, scene.frame_end, scene.frame_step = later[0], later[-1], part.step
            bpy.ops.render.render(animation=True)


if __name__ == "__main__":
    main()
