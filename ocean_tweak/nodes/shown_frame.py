# SPDX-License-Identifier: GPL-3.0-or-later
"""A node group that selects the file of an image sequence for the scene's frame.

It is the nearest one. At subframes, as used for motion blur, the water of the nearest file is moved by its
velocity for the remaining time, so it moves smoothly although files are of whole frames.
"""

from __future__ import annotations

from collections.abc import Sequence

import bpy

from .building import Builder, Plug, Socket, output
from .fields import alone, whole_number
from .versioned import GroupKind

#: name, socket type, default, description
FRAME_INPUTS = (
    Plug("First Frame", "NodeSocketInt", 1, "First file of the image sequence; held before it"),
    Plug("Last Frame", "NodeSocketInt", 1_048_574, "Last file of the image sequence; held after it"),
    Plug(
        "Baked Frames", "NodeSocketString", "",
        "Which frames have a file, the last one first: 1 for one that has, 0 for one that has none and holds "
        "the file before. Empty where all have one",
        hidden=True,
    ),
    Plug(
        "Files per Frame", "NodeSocketFloat", 1.0,
        "Files in a frame of the animation: 2 for a sequence that was baked with a Time Stretching of 100 to "
        "200",
        hidden=True,
    ),
    Plug(
        "Seconds per File", "NodeSocketFloat", 0.0,
        "Of the scene, from one file to the next: for so long velocity moves the water at frames between. "
        "0 lets it stand",
        hidden=True,
    ),
)  # fmt: skip

# tolerance of a file's index, as a product of two float32 values may be slightly off an integer
_TOLERANCE = 1.0 / 128.0


def _build(tree: bpy.types.NodeTree) -> None:
    outputs = (
        Plug("Frame", "NodeSocketInt", None, "The file that is shown: in a gap the last one before it"),
        Plug("Scene Frame", "NodeSocketInt", None, "The file that is nearest to the scene's time"),
        Plug("Is Held", "NodeSocketBool", None, "Whether the two differ"),
        Plug("Seconds", "NodeSocketFloat", None, "Of the scene, since the file's moment; below 0 before it"),
        Plug("Begun Frame", "NodeSocketInt", None, "The last file at or before the scene's time"),
    )
    build = Builder(tree, FRAME_INPUTS, outputs)
    time = build.add("GeometryNodeInputSceneTime")
    # Blender's scene time already includes the stretch
    file = build.math("MULTIPLY", output(time, "Frame"), build.given("Files per Frame"))
    whole = _whole(build, file, 0.5 + _TOLERANCE)
    limited = _limited(build, whole)
    held = build.integer("SUBTRACT", limited, _frames_back(build, limited))
    since = build.math("SUBTRACT", file, whole)
    is_between = build.compare(
        "GREATER_THAN", alone(build, "ABSOLUTE", since, "ShaderNodeMath"), _TOLERANCE, "FLOAT"
    )
    seconds = build.math("MULTIPLY", since, build.given("Seconds per File"))
    build.finish_with(
        {
            "Frame": held,
            "Scene Frame": whole,
            "Is Held": build.compare("NOT_EQUAL", held, whole),
            "Seconds": build.switch("FLOAT", is_between, 0.0, seconds),
            "Begun Frame": _limited(build, _whole(build, file, _TOLERANCE)),
        }
    )


def _whole(build: Builder, file: Socket, more: float) -> Socket:
    return whole_number(build, build.math("ADD", file, more), "FLOOR")


def _limited(build: Builder, frame: Socket) -> Socket:
    """The frame, clamped to the sequence, beyond which the image node silently returns zero."""
    begun = build.integer("MAXIMUM", frame, build.given("First Frame"))
    return build.integer("MINIMUM", begun, build.given("Last Frame"))


def _frames_back(build: Builder, frame: Socket) -> Socket:
    """Distance to the last frame with a file; 0 if the frame has one itself."""
    frames = build.given("Baked Frames")
    start = build.integer("SUBTRACT", build.given("Last Frame"), frame)
    length = build.add("FunctionNodeStringLength", {"String": frames})
    inputs = {"String": frames, "Position": start, "Length": output(length, "Length")}
    before = output(build.add("FunctionNodeSliceString", inputs), "String")
    found = build.add("FunctionNodeFindInString", {"String": before, "Search": "1"})
    return build.integer("MAXIMUM", output(found, "First Found"), 0)


def frame_values(
    frames: Sequence[int], files_per_frame: float = 1.0, seconds_per_file: float = 0.0
) -> dict[str, object]:
    """Values of FRAME_INPUTS for a sequence of ascending frames."""
    values = (frames[0], frames[-1], baked_text(frames), files_per_frame, seconds_per_file)
    return {plug.name: value for plug, value in zip(FRAME_INPUTS, values, strict=True)}


def baked_text(frames: Sequence[int]) -> str:
    """The value of the input Baked Frames for ascending frames."""
    first, last = frames[0], frames[-1]
    if len(frames) == last - first + 1:
        return ""
    present = set(frames)
    return "".join("1" if frame in present else "0" for frame in range(last, first - 1, -1))


SHOWN_FRAME = GroupKind("Ocean Tweak Frame", 3, _build)
