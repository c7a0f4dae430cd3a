# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the command line in a separate process, so that the window stays responsive."""

from __future__ import annotations

import contextlib
import json
import logging
import subprocess
import threading
import time
from collections.abc import Sequence
from typing import IO, Any, ClassVar

import bpy

from ..core.parameters.shot import Shot
from ..export import logs
from ..export.python_process import environment

_LOG = logging.getLogger(__name__)


class CommandProcess:
    """A running command.

    command_line : how to start the command line, set by registration, as this layer does not know it
    name : of the ocean that it is about
    phase : what is being made, where that is no longer the sea itself: "spray"
    left, done : total and finished frames of this phase
    error : the last line that reported a failure
    """

    command_line: ClassVar[Sequence[str]] = ()

    def __init__(self, name: str, arguments: Sequence[str], shot: Shot | None = None) -> None:
        """Start it. Raises OSError for what the disk refuses.

        arguments : the command and what it is given
        shot : the sea, for a command that takes one
        """
        self.name = name
        self.phase = ""
        self.left, self.done = 0, 0
        self.error = ""
        self.is_stopped = False
        self._began = time.monotonic()
        # the sea is passed through a pipe, so that a killed process leaves no file behind
        sea = () if shot is None else ("--params=-",)
        self._process = subprocess.Popen(
            [*self.command_line, *arguments, "--json", *logs.verbose_arguments(), *sea],
            env=environment(), stdin=subprocess.PIPE,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, encoding="utf-8", errors="replace",
        )  # fmt: skip
        text = "" if shot is None else shot.to_json(indent=None)
        self._threads = [
            threading.Thread(target=work, args=values, name=f"Ocean Tweak {arguments[0]}", daemon=True)
            for work, *values in (
                (_write, self._process.stdin, text),
                (self._read_progress, self._process.stdout),
                (self._read_errors, self._process.stderr),
            )
        ]
        for thread in self._threads:
            thread.start()

    @property
    def factor(self) -> float:
        """The completed fraction, 0…1."""
        return self.done / self.left if self.left else 0.0

    @property
    def seconds_left(self) -> float | None:
        """Remaining time in s, if known."""
        if not 0 < self.done < self.left:
            return None
        return (time.monotonic() - self._began) / self.done * (self.left - self.done)

    def has_ended(self) -> bool:
        """Whether nothing more will come."""
        if self._process.poll() is None:
            return False
        for thread in self._threads:
            thread.join()
        return True

    @property
    def is_complete(self) -> bool:
        """Whether it has ended successfully."""
        return self._process.returncode == 0

    def stop(self) -> None:
        """Let it end after the frames in progress."""
        self.is_stopped = True
        if self._process.poll() is None:
            self._process.terminate()

    def wait(self) -> None:
        """Wait until it has ended."""
        self._process.wait()
        self.has_ended()

    def take(self, said: dict[str, Any]) -> None:
        """Handle a line of its output."""
        if "left" in said:
            self.phase, self.left, self.done = said.get("phase", ""), said["left"], 0
            self._began = time.monotonic()
        elif "seconds" in said:
            self.done += 1

    def _read_progress(self, stream: IO[str]) -> None:
        with stream:
            for line in stream:
                with contextlib.suppress(ValueError):  # output of a library
                    said = json.loads(line)
                    if isinstance(said, dict):
                        self.take(said)

    def _read_errors(self, stream: IO[str]) -> None:
        with stream:
            for line in stream:
                self.error = logs.relay(line, _LOG) or self.error


def _write(stream: IO[str], text: str) -> None:
    with contextlib.suppress(OSError), stream:  # it may have ended already, and its output says why
        stream.write(text)


class Running(dict[int, CommandProcess]):
    """Processes of one kind, by the ocean's session uid: they are not part of the file and survive undo.

    kinds : all instances
    """

    kinds: ClassVar[list[Running]] = []

    def __init__(self) -> None:
        super().__init__()
        self.kinds.append(self)

    def of(self, item: bpy.types.Object) -> CommandProcess | None:
        """The process of an ocean."""
        return self.get(item.session_uid)

    def forget(self, process: CommandProcess) -> None:
        """Remove a process that has ended and whose result has been taken."""
        for uid in [uid for uid, other in self.items() if other is process]:
            del self[uid]


def stop_all() -> None:
    """Stop all processes: another file is opened, or the extension is disabled."""
    for running in Running.kinds:
        for process in running.values():
            process.stop()
        running.clear()
