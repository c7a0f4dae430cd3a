# SPDX-License-Identifier: GPL-3.0-or-later
"""Processes that share the frames of a bake. One that is killed is started again for what it left.

A process is `python -m ocean_tweak.cli.workers FOLDER FRAMES`: it makes its frames from what lies in the
folder, prints a JSON object a frame, and locks nothing: whoever started it holds the lock.
"""

from __future__ import annotations

import json
import os
import queue
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from pathlib import Path
from typing import IO, Any

from ..core.bake import BakedFrame
from ..core.bake import bake as make_frames
from ..core.frames import Frame, as_frame, format_frames, parse_frames
from ..export.cache.job import CacheError, Job, read_job
from ..export.cache.records import CacheSink
from ..export.exr import ExrError
from .outcome import DONE, FAILED, complain

#: how often a process may die before its first frame
_MOST_DEATHS = 3
_LOOK = 0.2  # s


def make_in_processes(
    folder: Path, job: Job, frames: Sequence[Frame], workers: int, stopped: Callable[[], bool]
) -> Iterator[BakedFrame]:
    """Make frames, each process a stretch of them; yields them as they are made.

    job : must be that of the folder
    stopped : asked again and again; True lets every process end after its frame

    Raises CacheError with what a process said when it failed, or when it dies again and again.
    """
    size = -(-len(frames) // workers)
    events: queue.SimpleQueue[tuple[_Process, dict[str, Any] | None]] = queue.SimpleQueue()
    running = [
        _Process(folder, frames[start : start + size], events) for start in range(0, len(frames), size)
    ]
    problem: CacheError | None = None
    try:
        while running:
            try:
                process, line = events.get(timeout=_LOOK)
            except queue.Empty:
                if stopped():
                    _end(running)
                continue
            if line is not None:
                yield process.made(line)
                continue
            running.remove(process)
            if process.succeeded() or stopped() or problem is not None:
                continue
            try:
                running.append(process.again())
            except CacheError as error:  # the others end after their frame
                problem = error
                _end(running)
    finally:
        _end(running)
        for process in running:
            process.wait()
    if problem is not None:
        raise problem


def _end(running: Sequence[_Process]) -> None:
    for process in running:
        process.end()


class _Process:
    """A process that makes some frames, and what is left of them."""

    def __init__(
        self,
        folder: Path,
        frames: Sequence[Frame],
        events: queue.SimpleQueue[tuple[_Process, dict[str, Any] | None]],
        deaths: int = 0,
    ) -> None:
        self.folder = folder
        self.left = list(frames)
        self._events = events
        self._deaths = deaths
        self._process = subprocess.Popen(
            [sys.executable, "-m", "ocean_tweak.cli.workers", str(folder), format_frames(frames)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            env=_environment(), text=True, encoding="utf-8",
        )  # fmt: skip
        self._said: list[str] = []
        self._readers = [
            threading.Thread(target=self._read_errors, daemon=True),
            threading.Thread(target=self._read_frames, daemon=True),
        ]
        for reader in self._readers:
            reader.start()

    def made(self, line: dict[str, Any]) -> BakedFrame:
        """Take a frame's line."""
        frame = as_frame(Fraction(line["frame"]))
        self.left.remove(frame)
        self._deaths = 0
        return BakedFrame(frame, tuple(map(Path, line["paths"])), line["seconds"])

    def succeeded(self) -> bool:
        """Whether it made all of its frames; it has ended."""
        return self.wait() == DONE and not self.left

    def again(self) -> _Process:
        """Another process for what is left. Raises CacheError where that does not help."""
        code, said = self.wait(), " ".join(self._said).strip()
        if code == FAILED:
            raise CacheError(said or "a process of the bake failed without a word")
        if self._deaths + 1 >= _MOST_DEATHS:
            raise CacheError(
                f"a process of the bake ended {_MOST_DEATHS} times with code {code} before it had made "
                f"frame {self.left[0]}: {said or 'perhaps there is not enough memory; use fewer workers'}"
            )
        return _Process(self.folder, self.left, self._events, self._deaths + 1)

    def end(self) -> None:
        """Let it end after its frame."""
        stdin = self._process.stdin
        if stdin is not None and not stdin.closed:
            stdin.close()

    def wait(self) -> int:
        """Wait until it has ended and all that it said is here. Returns its code."""
        code = self._process.wait()
        for reader in self._readers:
            if reader is not threading.current_thread():
                reader.join()
        self.end()
        return code

    def _read_frames(self) -> None:
        for line in _lines(self._process.stdout):
            self._events.put((self, json.loads(line)))
        self._events.put((self, None))

    def _read_errors(self) -> None:
        for line in _lines(self._process.stderr):
            self._said = [*self._said[-3:], line.strip().removeprefix("ocean_tweak: ")]


def _lines(stream: IO[str] | None) -> Iterator[str]:
    if stream is not None:
        with stream:
            yield from stream


def _environment() -> dict[str, str]:
    """What lets a new Python find this package and what it needs, also from inside Blender."""
    package = Path(__file__).resolve().parents[2]
    path = os.pathsep.join([str(package), *(entry for entry in sys.path if entry)])
    # a process is a worker: threads of its own would only fight with the others'
    return {**os.environ, "PYTHONPATH": path, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def main(argv: Sequence[str]) -> int:
    """Make the frames argv[1] of the folder argv[0]; ends after a frame when stdin is closed."""
    # Ctrl-C reaches the whole group: whoever started this process decides
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    ended = threading.Event()

    def watch() -> None:
        sys.stdin.read()
        ended.set()

    threading.Thread(target=watch, daemon=True).start()
    folder = Path(argv[0])
    try:
        job = read_job(folder)
        making = make_frames(job.shot, parse_frames(argv[1]), CacheSink(folder, job))
        for frame, paths, seconds in making:
            text = {"frame": str(frame), "paths": [str(path) for path in paths], "seconds": seconds}
            print(json.dumps(text), flush=True)
            if ended.is_set():
                making.close()
                break
    except OSError as error:
        complain(f"{error.filename}: {error.strerror}" if error.filename else error)
        return FAILED
    except (ExrError, CacheError, MemoryError) as error:
        complain(error)
        return FAILED
    return DONE


if __name__ == "__main__":
    code = main(sys.argv[1:])
    # the thread that waits for stdin would hold up the interpreter's own way out
    sys.stdout.flush()
    os._exit(code)
