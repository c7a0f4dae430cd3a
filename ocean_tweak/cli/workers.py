# SPDX-License-Identifier: GPL-3.0-or-later
"""Worker processes that share the frames of a bake. A killed one is restarted for its remaining frames.

A worker runs this module with the folder as its argument. It reads a JSON line with its frames, bakes them
from the job in the folder and prints a JSON line per frame. It does not lock: its parent holds the lock. When
its input is closed, as happens when the parent dies, it ends after its frame or, if that takes too long, in
the middle of it.

`concurrent.futures.ProcessPoolExecutor` does none of this. If a process is killed, it ends the others in the
middle of their frames and fails entirely. If the parent is killed, even by SIGTERM, its processes wait for
ever. And they import modules from the current folder, which may contain files from others. Only threads are
used from it: each supervises one process.
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
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

from ..core.data.frames import Frame, format_frames, parse_frames
from ..core.sea.bake import BakedFrame
from ..core.sea.bake import bake as make_frames
from ..export import logs
from ..export.cache.folders import read_job
from ..export.cache.job import CacheError, Job
from ..export.cache.records import CacheSink, give_up_writing
from ..export.exr import ExrError
from ..export.python_process import environment, module_command
from ..export.shelf import use_environment
from .outcome import DONE, FAILED, message_of
from .progress import Seldom
from .stopping import WORKERS_PATIENCE, end_now

_LOG = logging.getLogger(__name__)

#: number of times a process may die before its first frame
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
    """Bake frames, each process a contiguous part; yields them as they finish.

    job : that of the folder
    stopped : polled; True lets every process end after its frame
    tell : called with the progress of a slow frame

    Raises the error that ended a process, as OSError or CacheError, or CacheError if one dies repeatedly.
    """
    size = -(-len(frames) // workers)
    heard: queue.SimpleQueue[BakedFrame | tuple[Frame, str] | None] = queue.SimpleQueue()
    stretches = [
        _Stretch(folder, job, list(frames[start : start + size]), heard, stopped)
        for start in range(0, len(frames), size)
    ]
    with ThreadPoolExecutor(len(stretches), "Ocean Tweak workers") as threads:
        minding = [threads.submit(stretch.make) for stretch in stretches]
        under_way = len(stretches)
        try:
            while under_way:
                # if one fails, the others end after their frame
                if stopped() or any(each.done() and each.exception() for each in minding):
                    _end(stretches)
                try:
                    said = heard.get(timeout=_LOOK)
                except queue.Empty:
                    continue
                if isinstance(said, BakedFrame):
                    yield said
                elif said is not None:
                    tell(*said)
                else:
                    under_way -= 1
        finally:
            _end(stretches)
    for each in minding:
        each.result()


def _end(stretches: Sequence[_Stretch]) -> None:
    for stretch in stretches:
        stretch.end()


@dataclass
class _Stretch:
    """A part of the frames, and the process that bakes the rest of them.

    heard : receives the frames, the progress of a slow one, and None at the end
    stopped : whether they are no longer needed
    """

    folder: Path
    job: Job
    left: list[Frame]
    heard: queue.SimpleQueue[BakedFrame | tuple[Frame, str] | None]
    stopped: Callable[[], bool]
    process: subprocess.Popen[str] | None = None
    is_ended: threading.Event = field(default_factory=threading.Event)
    said: list[str] = field(default_factory=list)
    problem: CacheError | OSError | None = None

    def make(self) -> None:
        """Bake them, starting a new process if one is killed. Raises OSError or CacheError."""
        deaths = 0
        try:
            while not self._is_over():
                before = len(self.left)
                code = self._run()
                deaths = deaths + 1 if len(self.left) == before else 1
                if not self._is_over():
                    self._refuse(code, deaths)
                    _LOG.info("a bake process ended with code %s; another one continues", code)
        finally:
            self.heard.put(None)

    def end(self) -> None:
        """Let the process end after its frame, and do not start another."""
        self.is_ended.set()
        self._close()

    def _close(self) -> None:
        if self.process is not None and self.process.stdin is not None:
            with contextlib.suppress(OSError):
                self.process.stdin.close()

    def _is_over(self) -> bool:
        return not self.left or self.is_ended.is_set() or self.stopped()

    def _refuse(self, code: int, deaths: int) -> None:
        """Raise OSError or CacheError if another process would not help."""
        said = " ".join(self.said).strip()
        if self.problem is not None:
            raise self.problem
        if code == FAILED:  # Python's exit code for an error, which would occur again
            raise CacheError(f"a bake process failed: {said or 'without a word'}")
        if deaths >= _MOST_DEATHS:
            raise CacheError(
                f"a bake process ended {_MOST_DEATHS} times with code {code} before finishing "
                f"frame {self.left[0]}: "
                f"{said or 'perhaps there is not enough memory; use fewer workers'}"
            )

    def _run(self) -> int:
        """Let a process bake the remaining frames. Returns its exit code."""
        self.said.clear()
        self.process = process = subprocess.Popen(
            [*module_command(__name__), str(self.folder)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            env=environment(), text=True, encoding="utf-8", errors="replace",
        )  # fmt: skip
        errors = threading.Thread(target=self._read_errors, args=(process.stderr,), daemon=True)
        errors.start()
        # not as an argument, as systems limit their length
        order = {
            "frames": format_frames(self.left),
            "asked": format_frames(self.job.frames),
            "log": logs.level(),
        }
        with contextlib.suppress(OSError, ValueError):  # it has ended, or will
            assert process.stdin is not None
            process.stdin.write(json.dumps(order) + "\n")
            process.stdin.flush()
        if self.is_ended.is_set():  # meanwhile
            self._close()
        for line in _lines(process.stdout):
            try:
                said = json.loads(line)
            except ValueError:  # an incomplete line of a killed process, or output of a library
                continue
            if isinstance(said, dict):
                self._take(said)
        errors.join()
        code = process.wait()
        self._close()
        return code

    def _take(self, line: dict[str, Any]) -> None:
        """Handle a line: a frame, the progress of one, or the error that ends the process."""
        if "failed" in line:
            code, path = line["errno"], line["path"]
            self.problem = OSError(code, os.strerror(code), path) if code else CacheError(line["failed"])
            return
        (frame,) = parse_frames(line["frame"])
        if "doing" in line:
            self.heard.put((frame, line["doing"]))
            return
        self.left.remove(frame)
        self.heard.put(BakedFrame(frame, tuple(map(Path, line["paths"])), line["seconds"]))

    def _read_errors(self, stream: IO[str] | None) -> None:
        for line in _lines(stream):
            self.said = [*self.said[-3:], logs.relay(line, _LOG)]


def _lines(stream: IO[str] | None) -> Iterator[str]:
    if stream is not None:
        with stream:
            yield from stream


def main(argv: Sequence[str]) -> int:
    """Bake the frames given on stdin in the folder argv[0]. Returns the exit code."""
    ended = threading.Event()
    # Ctrl-C reaches the whole process group: the parent decides
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, lambda _number, _frame: ended.set())
    try:
        order = json.loads(sys.stdin.readline() or "{}")
        if not order:
            return DONE  # it is no longer needed
        threading.Thread(target=_watch, args=(ended,), daemon=True).start()
        threading.Thread(target=_give_up, args=(ended, Path(argv[0])), daemon=True).start()
        logs.to_console(order["log"])
        use_environment()
        folder = Path(argv[0])
        job = read_job(folder, parse_frames(order["asked"]) if order["asked"] else ())
        _make(folder, job, parse_frames(order["frames"]), ended)
    except BrokenPipeError:
        return DONE  # the parent has gone
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
    with contextlib.closing(make_frames(job.shot, frames, sink, tell=tell, on=job.on)) as making:
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
    end_now(code)  # the thread waiting for stdin would block a normal exit
