# SPDX-License-Identifier: GPL-3.0-or-later
"""A real Blender in a window of its own, on a display in memory, moved by mouse and keyboard.

Xvfb and xdotool stand where the Blender stands: on PATH, or with it in a root file system of its own. The
hands' events go through the X server as a person's would; what Blender makes of them is asked of a script
that runs inside (`tests/ui/in_blender.py`).
"""

from __future__ import annotations

import json
import os
import shutil
import socket
import struct
import subprocess
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from .project import TOOLS, ToolError
from .real_blender import DEBIAN_ROOT, RealBlender

SHADERS = TOOLS / "shaders"
# s; a software renderer on a busy machine needs some
START_TIMEOUT = 90.0
ANSWER_TIMEOUT = 120.0
STOP_TIMEOUT = 10.0
# the fields of an X window dump's header, each four bytes, that say where its pixels are
_XWD_FIELDS = 25


class NoWindow(ToolError):
    """There can be no window on this machine; the text says why."""


class Display:
    """An X server without a screen. Use it in a `with` block."""

    def __init__(self, blender: RealBlender, folder: Path, size: tuple[int, int]) -> None:
        """folder : where its frame buffer and its log go; size : width and height in pixels."""
        self.size = size
        self._folder = folder
        self._prefix = blender.command[:-1]
        for program in ("Xvfb", "xdotool"):
            if not _is_there(program, self._prefix):
                raise NoWindow(
                    f"{program} was not found beside {blender}: install it (Debian: {program.lower()})"
                )

    def __enter__(self) -> Display:
        width, height = self.size
        self._log = (self._folder / "xvfb.log").open("wb")
        self._server = subprocess.Popen(
            [*self._prefix, "Xvfb", "-displayfd", "1", "-screen", "0", f"{width}x{height}x24",
             "-fbdir", str(self._folder), "+extension", "GLX", "-nolisten", "tcp", "-noreset"],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=self._log,
        )  # fmt: skip
        number = self._server.stdout.readline().strip().decode()
        if not number:
            self.__exit__()
            raise NoWindow(f"Xvfb does not start; {self._log.name} says why")
        self.name = f":{number}"
        self._hand = subprocess.Popen(
            [*self._prefix, "xdotool", "-"], env={**os.environ, "DISPLAY": self.name},
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, bufsize=1,
        )  # fmt: skip
        return self

    def __exit__(self, *_error: object) -> None:
        for process in (getattr(self, "_hand", None), self._server):
            if process is not None:
                stop(process)
        self._log.close()

    def do(self, *commands: str) -> None:
        """Let xdotool do something, and return when the X server has done it.

        commands : as on xdotool's command line

        Raises ToolError with what xdotool says.
        """
        # the last one answers, and X answers in the order it is asked
        self._hand.stdin.write("".join(f"{command}\n" for command in (*commands, "getmouselocation")))
        self._hand.stdin.flush()
        answer = self._hand.stdout.readline()
        if not answer.startswith("x:"):
            raise ToolError(f"xdotool could not do {commands}: {answer.strip() or 'it has ended'}")

    def picture(self) -> tuple[int, int, bytes]:
        """The whole screen now: width, height, and rows of 4 bytes a pixel (blue, green, red, unused)."""
        data = (self._folder / "Xvfb_screen0").read_bytes()
        header = struct.unpack(f">{_XWD_FIELDS}I", data[: 4 * _XWD_FIELDS])
        length, width, height, bits, row_bytes, colours = (header[i] for i in (0, 4, 5, 11, 12, 19))
        if bits != 32:
            raise ToolError(f"the screen has {bits} bits a pixel, not 32")
        begin = length + 12 * colours
        starts = range(begin, begin + height * row_bytes, row_bytes)
        return width, height, b"".join(data[start : start + 4 * width] for start in starts)


class BlenderWindow:
    """A Blender whose window fills the display, with a script inside that answers. For a `with` block."""

    def __init__(
        self, blender: RealBlender, display: Display, script: Path, folder: Path, env: Mapping[str, str]
    ) -> None:
        """script : it connects to the socket named in OCEAN_TWEAK_ANSWERS and answers JSON lines in order."""
        self._display, self._folder = display, folder
        width, height = display.size
        self._command: Sequence[str] = [
            *blender.command, "--gpu-backend", "opengl",
            "--window-geometry", "0", "0", str(width), str(height),
            "--python-exit-code", "1", "--python", str(script),
        ]  # fmt: skip
        # Mesa of another version cuts a shared cache's index while it is in use, and then Blender crashes
        self._env = {**env, "MESA_SHADER_CACHE_DIR": str(SHADERS)}

    def __enter__(self) -> BlenderWindow:
        SHADERS.mkdir(parents=True, exist_ok=True)
        address = self._folder / "answers"
        self._log = (self._folder / "blender.log").open("wb")
        with socket.socket(socket.AF_UNIX) as door:
            door.bind(str(address))
            door.listen(1)
            self._process = subprocess.Popen(
                self._command,
                env={**self._env, "DISPLAY": self._display.name, "OCEAN_TWEAK_ANSWERS": str(address)},
                stdin=subprocess.DEVNULL, stdout=self._log, stderr=subprocess.STDOUT,
            )  # fmt: skip
            try:
                self._line = self._accept(door)
            except BaseException:
                self.__exit__()
                raise
        self._line.settimeout(ANSWER_TIMEOUT)
        self._answers = self._line.makefile("r", encoding="utf-8")
        return self

    def __exit__(self, *_error: object) -> None:
        if hasattr(self, "_line"):
            self._line.close()
        stop(self._process)
        self._log.close()

    def _accept(self, door: socket.socket) -> socket.socket:
        door.settimeout(1.0)
        deadline = time.monotonic() + START_TIMEOUT
        while time.monotonic() < deadline and self._process.poll() is None:
            try:
                return door.accept()[0]
            except TimeoutError:
                continue
        raise ToolError(f"Blender does not open a window:\n{self.said()}")

    def ask(self, expression: str) -> Any:
        """Evaluate an expression inside Blender, when it is through with all events up to now.

        Raises ToolError with the traceback, or where Blender does not answer any more.
        """
        try:
            self._line.sendall(json.dumps(expression).encode() + b"\n")
            line = self._answers.readline()
        except OSError as error:
            raise ToolError(f"Blender does not answer {expression!r}: {error!r}\n{self.said()}") from error
        if not line:
            raise ToolError(f"Blender ended at {expression!r} ({self._ended()})\n{self.said()}")
        answer = json.loads(line)
        if "error" in answer:
            raise ToolError(f"{expression!r} failed inside Blender:\n{answer['error']}")
        return answer["value"]

    def said(self) -> str:
        """The end of what Blender has printed."""
        return (self._folder / "blender.log").read_text(errors="replace")[-4000:]

    def is_running(self) -> bool:
        """Whether Blender has not ended."""
        return self._process.poll() is None

    def _ended(self) -> str:
        try:
            return f"exit code {self._process.wait(STOP_TIMEOUT)}"
        except subprocess.TimeoutExpired:
            return "still running"


def stop(process: subprocess.Popen[Any]) -> None:
    """End a process that was started here."""
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            pipe.close()
    if process.poll() is None:
        process.terminate()
        try:
            process.wait(STOP_TIMEOUT)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def _is_there(program: str, prefix: Sequence[str]) -> bool:
    if prefix:
        return (DEBIAN_ROOT / "usr" / "bin" / program).exists()
    return shutil.which(program) is not None
