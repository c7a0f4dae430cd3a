# SPDX-License-Identifier: GPL-3.0-or-later
"""The frame loop: each frame is made from the parameters and its number alone."""

from __future__ import annotations

import re
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple, Protocol

from .fields import SurfaceFields
from .ocean import Ocean
from .parameters import ParameterError

_RANGE = re.compile(r"(-?\d+)(?:-(-?\d+)(?:x(\d+))?)?")
_MOST_FRAMES = 1_000_000


class FrameSink(Protocol):
    """Whatever keeps frames."""

    def write(self, frame: int, fields: SurfaceFields) -> Path:
        """Keep a frame's fields; returns where."""


class BakedFrame(NamedTuple):
    """A frame that has been kept."""

    frame: int
    path: Path
    seconds: float


def bake(ocean: Ocean, frames: Iterable[int], sink: FrameSink) -> Iterator[BakedFrame]:
    """Make and keep each frame; yields after each one, so that the caller can report or stop."""
    for frame in frames:
        started = time.perf_counter()
        path = sink.write(frame, ocean.frame(frame))
        yield BakedFrame(frame, path, time.perf_counter() - started)


def parse_frames(text: str) -> tuple[int, ...]:
    """Frames of `1-48`, `1-100x2`, `1001,1005-1010`, `-5--1`, ascending and each once.

    Raises ParameterError.
    """
    frames: set[int] = set()
    for part in text.split(","):
        match = _RANGE.fullmatch(part.strip())
        if not match:
            raise ParameterError("frames", text, "must look like 1-48, 1-100x2 or 1001,1005-1010")
        first = int(match[1])
        last = int(match[2]) if match[2] else first
        step = int(match[3]) if match[3] else 1
        if last < first or step < 1:
            raise ParameterError("frames", text, f"{part.strip()} holds no frames")
        if (last - first) // step >= _MOST_FRAMES:
            raise ParameterError("frames", text, f"must hold at most {_MOST_FRAMES} frames")
        frames.update(range(first, last + 1, step))
    return tuple(sorted(frames))
