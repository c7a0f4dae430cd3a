# SPDX-License-Identifier: GPL-3.0-or-later
"""A bake in separate processes: the window stays responsive, and the bake survives Blender.

It runs the command line's `bake` with the ocean's shot as JSON. Complete frames are kept, so a stopped bake
continues where it was.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import bpy

from ..core.data.frames import Frame, format_frames
from ..core.parameters.shot import Shot
from .baked_spray import spray_arguments
from .cache_place import bake_name, cache_folder, own_uid
from .command_process import CommandProcess, Running
from .preferences import preferences
from .settings import maps_of, scene_of, settings_of, wanted_channels
from .shots import needed_maps


class BakeProcess(CommandProcess):
    """A bake under way.

    frames : all that are wanted
    folder : theirs, None until it is known
    """

    def __init__(self, item: bpy.types.Object, shot: Shot, frames: Sequence[Frame]) -> None:
        """Start it. Raises OSError for what the disk refuses."""
        self.frames = tuple(frames)
        self.folder: Path | None = None
        maps = (*maps_of(wanted_channels(settings_of(item))), *needed_maps(item))
        arguments = [
            "bake", f"--frames={format_frames(frames)}", f"--out={cache_folder(item)}",
            f"--name={bake_name(item)}", f"--uid={own_uid(item)}",
            f"--maps={','.join(maps)}",
        ]  # fmt: skip
        arguments += spray_arguments(item, scene_of(item))
        chosen = preferences()
        if chosen is not None and chosen.write_log:
            arguments.append("--log")
        super().__init__(item.name, arguments, shot)

    def take(self, said: dict[str, Any]) -> None:
        """It also says where the frames are."""
        if "folder" in said:
            self.folder = Path(said["folder"])
        super().take(said)


_running = Running()


def start(item: bpy.types.Object, shot: Shot, frames: Sequence[Frame]) -> BakeProcess:
    """Start a bake and remember it for the panel; raises what BakeProcess raises."""
    bake = _running[item.session_uid] = BakeProcess(item, shot, frames)
    return bake


running, forget = _running.of, _running.forget
