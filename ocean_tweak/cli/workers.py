# SPDX-License-Identifier: GPL-3.0-or-later
"""Processes that share the frames of a bake. One that is killed is started again for what it left.

A process runs this module with the folder as its argument: it reads a JSON line that says which frames, makes
them from what lies in the folder and prints a JSON line a frame. It locks nothing: whoever started it holds
the lock. When its input is closed, as it is when whoever started it is gone, it ends: after its frame or,
where that takes too long, in the middle of it.
"""

from __future__ import annotations

import contextlib
import json
import logging
import os
import queue
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import IO, Any

from ..core.bake import BakedFrame
from ..core.bake import bake as make_frames
from ..core.frames import Frame, format_frames, parse_frames
from ..export import logs
from ..export.cache.job import CacheError, Job, read_job
from ..export.cache.records import CacheSink, give_up_writing
from ..export.exr import ExrError
from ..export.python_process import environment, module_command
from .outcome import DONE, FAILED, message_of
from .progress import Seldom
from .stopping import WORKERS_PATIENCE, end_now

_LOG = logging.getLogger(__name__)

#: how often a process may die before its first frame
_MOST_DEATHS = 3
_LOOK = 0.2  # s


def make_in_processes(
    folder: Path,
    job: Job,
    frames: Sequence[Frame],
    workers: int,
    stopped: Callable[[], bool],
    tell: Callable[[Frame, str], None] = lambda frame, doing: None,
) -> Iterator[BakedFrame]:
    """Make frames, each process a stretch of them; yields them as they are made.

    job : must be that of the folder
    stopped : asked again and again; True lets every process end after its frame
    tell : is told what is being done for a frame that takes long

    Raises what ended a process, as OSError or CacheError, or CacheError when one dies again and again.
    """
    size = -(-len(frames) // workers)
    events: queue.SimpleQueue[tuple[_Process, dict[str, Any] | None]] = queue.SimpleQueue()
    running = [
        _Process(folder, job, frames[start : start + size], events) for start in range(0, len(frames), size)
    ]
    problem: CacheError | OSError | None = None
    try:
        while running:
            if stopped():
                _end(running)
            try:
                process, line = events.get(timeout=_LOOK)
            except queue.Empty:
                continue
            if line is not None:
                baked = process.made(line, tell)
                if baked is not None:
                    yield baked
                continue
            running.remove(process)
            if process.succeeded() or stopped() or problem is not None:
                continue
            try:
                running.append(process.again())
            except (CacheError, OSError) as error:  # the others end after their frame
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
        job: Job,
        frames: Sequence[Frame],
        events: queue.SimpleQueue[tuple[_Process, dict[str, Any] | None]],
        deaths: int = 0,
    ) -> None:
        self.folder = folder
        self.job = job
        self.left = list(frames)
        self._events = events
        self._deaths = deaths
        self._process = subprocess.Popen(
            [*module_command(__name__), str(folder)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            env=environment(), text=True, encoding="utf-8", errors="replace",
        )  # fmt: skip
        self._said: list[str] = []
        self._problem: CacheError | OSError | None = None
        self._readers = [
            threading.Thread(target=self._read_errors, daemon=True),
            threading.Thread(target=self._read_frames, daemon=True),
        ]
        for reader in self._readers:
            reader.start()
        # not among the arguments, whose length systems limit
        order = {
            "frames": format_frames(frames),
            "asked": format_frames(job.frames),
            "log": logs.level(),
        }
        with contextlib.suppress(OSError):  # it has ended already, and is asked why
            assert self._process.stdin is not None
            self._process.stdin.write(json.dumps(order) + "\n")
            self._process.stdin.flush()

    def made(self, line: dict[str, Any], tell: Callable[[Frame, str], None]) -> BakedFrame | None:
        """Take a line: a frame, or None where it is what ended the process or what it is doing."""
        if "failed" in line:
            code, path = line["errno"], line["path"]
            self._problem = OSError(code, os.strerror(code), path) if code else CacheError(line["failed"])
            return None
        (frame,) = parse_frames(line["frame"])
        if "doing" in line:
            tell(frame, line["doing"])
            return None
        self.left.remove(frame)
        self._deaths = 0
        return BakedFrame(frame, tuple(map(Path, line["paths"])), line["seconds"])

    def succeeded(self) -> bool:
        """Whether it made all of its frames; it has ended."""
        return self.wait() == DONE and not self.left

    def again(self) -> _Process:
        """Another process for what is left. Raises OSError or CacheError where that does not help."""
        code, said = self.wait(), " ".join(self._said).strip()
        if self._problem is not None:
            raise self._problem
        if code == FAILED:  # Python's own end by an error, which would come again
            raise CacheError(f"a process of the bake failed: {said or 'without a word'}")
        if self._deaths + 1 >= _MOST_DEATHS:
            raise CacheError(
                f"a process of the bake ended {_MOST_DEATHS} times with code {code} before it had made "
                f"frame {self.left[0]}: {said or 'perhaps there is not enough memory; use fewer workers'}"
            )
        _LOG.info("a process of the bake ended with code %s; another goes on", code)
        return _Process(self.folder, self.job, self.left, self._events, self._deaths + 1)

    def end(self) -> None:
        """Let it end after its frame."""
        stdin = self._process.stdin
        if stdin is not None and not stdin.closed:
            with contextlib.suppress(OSError):
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
        try:
            for line in _lines(self._process.stdout):
                # what was being written when it was killed, or what a library had to say
                with contextlib.suppress(ValueError):
                    said = json.loads(line)
                    if isinstance(said, dict):
                        self._events.put((self, said))
        finally:
            self._events.put((self, None))

    def _read_errors(self) -> None:
        for line in _lines(self._process.stderr):
            self._said = [*self._said[-3:], logs.relay(line, _LOG)]


def _lines(stream: IO[str] | None) -> Iterator[str]:
    if stream is not None:
        with stream:
            yield from stream


def main(argv: Sequence[str]) -> int:
    """Make the frames that stdin tells in the folder argv[0]. Returns the exit code."""
    ended = threading.Event()
    # Ctrl-C reaches the whole group: whoever started this process decides
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, lambda _number, _frame: ended.set())
    try:
        order = json.loads(sys.stdin.readline() or "{}")
        if not order:
            return DONE  # nobody wants it any more
        threading.Thread(target=_watch, args=(ended,), daemon=True).start()
        threading.Thread(target=_give_up, args=(ended, Path(argv[0])), daemon=True).start()
        logs.to_console(order["log"])
        folder = Path(argv[0])
        job = read_job(folder, parse_frames(order["asked"]) if order["asked"] else ())
        _make(folder, job, parse_frames(order["frames"]), ended)
    except BrokenPipeError:
        return DONE  # nobody wants to know
    except (OSError, ExrError, CacheError, MemoryError) as error:
        code, path = (error.errno, error.filename) if isinstance(error, OSError) else (None, None)
        _say({"failed": message_of(error), "errno": code, "path": path and str(path)})
        return FAILED
    return DONE


def _watch(ended: threading.Event) -> None:
    sys.stdin.read()
    ended.set()


def _give_up(ended: threading.Event, folder: Path) -> None:
    """End in the middle of a frame that takes too long."""
    ended.wait()
    time.sleep(WORKERS_PATIENCE)
    try:
        give_up_writing(folder)
    finally:
        end_now(DONE)


def _make(folder: Path, job: Job, frames: Sequence[Frame], ended: threading.Event) -> None:
    tell = Seldom(lambda frame, doing: _say({"frame": format_frames((frame,)), "doing": doing}))
    sink = CacheSink(folder, job, tell)
    with contextlib.closing(make_frames(job.shot, frames, sink, tell=tell)) as making:
        for frame, paths, seconds in making:
            _say(
                {
                    "frame": format_frames((frame,)),
                    "paths": [str(path) for path in paths],
                    "seconds": seconds,
                }
            )
            tell.was_heard()
            if ended.is_set():
                return


def _say(line: dict[str, Any]) -> None:
    print(json.dumps(line), flush=True)


if __name__ == "__main__":
    code = main(sys.argv[1:])
    end_now(code)  # the thread that waits for stdin would hold up the interpreter's own way out
