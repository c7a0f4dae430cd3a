# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads layers from unknown sources in a separate process.

OpenUSD crashes on some damaged layers, and the caller, perhaps Blender with unsaved work, must not crash with
it. The request is a line of JSON, and so is each answer.
"""

from __future__ import annotations

import json
import logging
import subprocess
import sys
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from ...core.data.frames import Frame, format_frames, parse_frames
from .. import logs
from ..python_process import environment, module_command
from . import reading
from .library import UsdError, pxr
from .package import Package
from .verify import Problem, verify

_LOG = logging.getLogger(__name__)


def read_package(path: Path) -> tuple[str, Package]:
    """As `reading.read_package`."""
    (answer,) = _answers(path, {"path": str(path)})
    return answer["prim"], Package.from_record(answer["record"])


def problems_of(path: Path, frames: Sequence[Frame] | None = None) -> Iterator[Problem]:
    """As `verify.verify`."""
    chosen = None if frames is None else format_frames(frames)
    for answer in _answers(path, {"path": str(path), "verify": True, "frames": chosen}):
        place = answer["frame"]
        yield Problem(None if place is None else parse_frames(place)[0], answer["problem"])


def answer(asked: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """The answers of the process, the last of which may be an error."""
    path, frames = Path(asked["path"]), asked.get("frames")
    try:
        if asked.get("verify"):
            for frame, text in verify(path, None if frames is None else parse_frames(frames)):
                yield {"frame": None if frame is None else format_frames((frame,)), "problem": text}
        else:
            prim, package = reading.read_package(path)
            yield {"prim": prim, "record": package.record()}
    except UsdError as error:
        yield {"error": str(error)}
    except MemoryError as error:
        yield {"memory": str(error)}


def _answers(path: Path, asked: dict[str, Any]) -> Iterator[dict[str, Any]]:
    pxr()  # if there is none, report that at once
    for said in lines(path, asked):
        if "error" in said:
            raise UsdError(said["error"])
        if "memory" in said:
            raise MemoryError(said["memory"])
        yield said


def lines(path: Path, asked: dict[str, Any]) -> Iterable[dict[str, Any]]:
    """The answers of the process. Raises UsdError if it crashes."""
    done = subprocess.run(
        module_command(__name__), input=json.dumps(asked), env=environment(), capture_output=True,
        encoding="utf-8", errors="replace", check=False,
    )  # fmt: skip
    for line in done.stderr.splitlines():
        logs.relay(line, _LOG)
    if done.returncode not in (0, 1):
        raise UsdError(f"{path}: OpenUSD crashes on it: a layer is damaged, so export the sea again")
    if done.returncode == 1:  # Python's exit code for an error
        raise UsdError(f"{path}: reading it failed: {' '.join(done.stderr.splitlines()[-1:])}")
    return map(json.loads, done.stdout.splitlines())


if __name__ == "__main__":
    for said in answer(json.loads(sys.stdin.read())):
        print(json.dumps(said), flush=True)
