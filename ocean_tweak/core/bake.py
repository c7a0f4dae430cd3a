# SPDX-License-Identifier: GPL-3.0-or-later
"""The frame loop: each frame is made from the parameters and its number alone."""

from __future__ import annotations

import re
import threading
import time
from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from .fields import FOAM, SurfaceFields
from .memory import check_memory, memory_need
from .ocean import Ocean
from .parameters import OceanParameters, ParameterError

_RANGE = re.compile(r"(-?\d+)(?:-(-?\d+)(?:x(\d+))?)?")
_MOST_FRAMES = 1_000_000


class FrameSink(Protocol):
    """Whatever keeps frames; called from several threads at once."""

    @property
    def outputs(self) -> frozenset[str]:
        """The fields that a frame must have."""

    def write(self, frame: int, fields: SurfaceFields) -> tuple[Path, ...]:
        """Keep a frame's fields; returns where."""


class BakedFrame(NamedTuple):
    """A frame that has been kept."""

    frame: int
    paths: tuple[Path, ...]
    seconds: float


def bake(
    parameters: OceanParameters, frames: Iterable[int], sink: FrameSink, workers: int = 1
) -> Iterator[BakedFrame]:
    """Make and keep each frame, several at once; yields each in order when it is kept.

    A worker makes a whole frame on one thread: while one encodes, another computes. Only foam, which has a
    memory, is made here, in the order of the frames. What a frame holds does not depend on the number of
    workers. When the caller stops, frames under way are finished and no more begun.

    Raises MemoryError before the first frame where the machine is too small.
    """
    need = memory_need(parameters, sink.outputs).peak(workers)
    check_memory(need, f"Baking {parameters.resolution}² samples with {workers} workers")
    with_memory = Ocean(parameters, workers=1)
    with_memory.initial_state  # noqa: B018  made once, before the workers ask for it
    own = threading.local()

    def make(frame: int, foam: NDArray[np.floating] | None) -> BakedFrame:
        started = time.perf_counter()
        if not hasattr(own, "ocean"):
            own.ocean = Ocean(parameters, workers=1)
        fields = own.ocean.frame(frame, sink.outputs - {FOAM})
        if foam is not None:
            fields = fields.including(FOAM, foam)
        return BakedFrame(frame, sink.write(frame, fields), time.perf_counter() - started)

    under_way: deque[Future[BakedFrame]] = deque()
    with ThreadPoolExecutor(workers) as pool:
        try:
            for frame in frames:
                foam = with_memory.frame(frame, {FOAM}).foam if FOAM in sink.outputs else None
                under_way.append(pool.submit(make, frame, foam))
                if len(under_way) > workers:
                    yield under_way.popleft().result()
            while under_way:
                yield under_way.popleft().result()
        finally:
            for future in under_way:
                future.cancel()


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
