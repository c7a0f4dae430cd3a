# SPDX-License-Identifier: GPL-3.0-or-later
"""A bake in processes of its own: the window stays free, and Blender need not be there at the end.

They are the command line's `bake`, fed with the ocean's shot as JSON. Frames that are whole already stay, so
a bake that was stopped goes on where it was.
"""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from typing import IO

import bpy

from ..core.frames import Frame, format_frames
from ..core.shot import Shot
from ..export.python_process import environment, module_command
from .cache_place import bake_name, cache_folder, own_uid
from .maps import wanted_maps
from .settings import settings_of


class BakeProcess:
    """A bake under way.

    folder : of the frames, None until it is known
    left, done : frames that were to be made, and that have been
    error : the last line that told of a failure
    """

    def __init__(self, item: bpy.types.Object, shot: Shot, frames: Sequence[Frame]) -> None:
        """Start it. Raises OSError for what the disk refuses."""
        maps = wanted_maps(settings_of(item))
        self.name = item.name
        self.frames = tuple(frames)
        self.folder: Path | None = None
        self.left, self.done = 0, 0
        self.error = ""
        self.is_stopped = False
        self._began = time.monotonic()
        self._parameters = _write_shot(shot.to_json(indent=None))
        command = [
            *module_command(), "bake", "--json", "--params", str(self._parameters),
            "--frames", format_frames(frames), "--out", str(cache_folder(item)),
            "--name", bake_name(item), "--uid", own_uid(item), "--maps", ",".join(maps),
        ]  # fmt: skip
        self._process = subprocess.Popen(
            command, env=environment(), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True, encoding="utf-8", errors="replace",
        )  # fmt: skip
        self._readers = [
            threading.Thread(target=read, args=(stream,), name="Ocean Tweak bake", daemon=True)
            for read, stream in (
                (self._read_progress, self._process.stdout),
                (self._read_errors, self._process.stderr),
            )
        ]
        for reader in self._readers:
            reader.start()

    @property
    def factor(self) -> float:
        """The share that is done, 0…1."""
        return self.done / self.left if self.left else 0.0

    @property
    def seconds_left(self) -> float | None:
        """How long it will take, as far as that is known."""
        if not 0 < self.done < self.left:
            return None
        return (time.monotonic() - self._began) / self.done * (self.left - self.done)

    def has_ended(self) -> bool:
        """Whether nothing more will come."""
        if self._process.poll() is None:
            return False
        for reader in self._readers:
            reader.join()
        self._parameters.unlink(missing_ok=True)
        return True

    @property
    def is_complete(self) -> bool:
        """Whether it has ended and every frame is there."""
        return self._process.returncode == 0

    def stop(self) -> None:
        """Let it end after the frames that are under way."""
        self.is_stopped = True
        if self._process.poll() is None:
            self._process.terminate()

    def wait(self) -> None:
        """Wait until it has ended."""
        self._process.wait()
        self.has_ended()

    def _read_progress(self, stream: IO[str]) -> None:
        with stream:
            for line in stream:
                try:
                    data = json.loads(line)
                except ValueError:
                    continue
                if "folder" in data:
                    self.folder, self.left = Path(data["folder"]), data["left"]
                    self._began = time.monotonic()
                elif "frame" in data:
                    self.done += 1

    def _read_errors(self, stream: IO[str]) -> None:
        with stream:
            for line in stream:
                self.error = line.strip().removeprefix("ocean_tweak: ") or self.error


def _write_shot(text: str) -> Path:
    handle, name = tempfile.mkstemp(prefix="ocean_tweak_", suffix=".json")
    with os.fdopen(handle, "w", encoding="utf-8") as file:
        file.write(text)
    return Path(name)


# Bakes under way, by the ocean's session uid. They are processes, not data of the file: they outlive undo
_running: dict[int, BakeProcess] = {}


def start(item: bpy.types.Object, shot: Shot, frames: Sequence[Frame]) -> BakeProcess:
    """Start a bake and remember it for the panel; raises what BakeProcess raises."""
    _running[item.session_uid] = BakeProcess(item, shot, frames)
    return _running[item.session_uid]


def running(item: bpy.types.Object) -> BakeProcess | None:
    """The bake of an ocean that is under way."""
    return _running.get(item.session_uid)


def forget(bake: BakeProcess) -> None:
    """It has ended, and its result has been taken."""
    for uid in [uid for uid, other in _running.items() if other is bake]:
        del _running[uid]


def stop_all() -> None:
    """Another file is opened, or the extension is disabled."""
    for bake in _running.values():
        bake.stop()
    _running.clear()
