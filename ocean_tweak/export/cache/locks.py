# SPDX-License-Identifier: GPL-3.0-or-later
"""Who is making which frames of a folder, so that nobody makes them twice at the same time.

A claim is a file with the frames, the host, the process and a counter that its holder keeps raising. Claims
are looked at and written under the system's own file lock, which a process that dies lets go; it is held for
a moment only. Clocks are not compared: a holder on another machine counts as dead only when its counter
stands still while it is watched.
"""

from __future__ import annotations

import contextlib
import json
import os
import platform
import threading
import time
import uuid
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core.frames import Frame, format_frames, parse_frames
from ..files import whole_file
from .job import LOCKS

#: s between two beats
BEAT = 5.0
#: s without one after which a watched holder is taken for dead
SILENCE = 3.0 * BEAT


class Held(RuntimeError):
    """Frames that somebody else is making: says who."""


@dataclass(frozen=True)
class Claim:
    """Somebody's claim to frames.

    started : of the process in the system's own count, to tell it from a later one with the same number
    beat : how often its holder has said that it lives
    """

    path: Path
    host: str
    process: int
    started: str
    frames: frozenset[Frame]
    beat: int

    @property
    def holder(self) -> str:
        """Who it is, for a message."""
        return f"process {self.process} on {self.host}"


@contextlib.contextmanager
def claimed(
    folder: Path,
    frames: tuple[Frame, ...],
    wait: bool = False,
    take_over: bool = False,
    stopped: Callable[[], bool] = lambda: False,
    beat: float = BEAT,
) -> Iterator[None]:
    """Hold frames of a folder while this is open.

    wait : until others have finished with them; otherwise refuse
    take_over : remove the claims of holders that are dead
    stopped : asked while waiting; True ends it with Held

    Raises Held naming who has them.
    """
    locks = folder / LOCKS
    locks.mkdir(exist_ok=True)
    own = _own_claim(locks, frames)
    while (other := _enter(own)) is not None:
        if take_over:
            if not _is_dead(other, SILENCE / BEAT * beat, stopped):
                raise Held(f"{_overlap(own, other)} and is alive: only a dead one's lock is taken over")
            other.path.unlink(missing_ok=True)
        elif not wait:
            raise Held(
                f"{_overlap(own, other)}: wait for it with --wait, "
                "or, if it died, take its lock over with --take-over"
            )
        elif stopped():
            raise Held(f"{_overlap(own, other)}; stopped waiting for it")
        else:
            time.sleep(min(beat, 1.0) / 4.0)
    ended = threading.Event()
    heart = threading.Thread(target=_beat, args=(own, ended, beat), name="Ocean Tweak lock", daemon=True)
    heart.start()
    try:
        yield
    finally:
        ended.set()
        heart.join()
        own.path.unlink(missing_ok=True)


def _enter(own: Claim) -> Claim | None:
    """Write the claim, or return one that stands against it."""
    with _alone(own.path.parent):
        for other in claims(own.path.parent):
            if other.frames & own.frames:
                return other
        _write(own)
    return None


@contextlib.contextmanager
def _alone(locks: Path) -> Iterator[None]:
    """Nobody else in here; on a system or disk without file locks, everybody."""
    with (locks / "entry").open("a+b") as file:
        try:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX)
        except (ImportError, OSError):
            yield
            return
        yield  # closing the file lets go


def _overlap(own: Claim, other: Claim) -> str:
    return f"frames {format_frames(own.frames & other.frames)} are being baked by {other.holder}"


def claims(locks: Path) -> list[Claim]:
    """All claims that can be read; one that cannot be read claims nothing."""
    found = []
    for path in sorted(locks.glob("*.lock")):
        with contextlib.suppress(OSError, ValueError, KeyError, TypeError, RecursionError):
            found.append(_read(path))
    return found


def is_alive_here(claim: Claim) -> bool | None:
    """Whether the claim's process runs, where that can be told: on its own host."""
    if claim.host != platform.node():
        return None
    started = _process_start(claim.process)
    return started is not None and started == claim.started


def _is_dead(claim: Claim, silence: float, stopped: Callable[[], bool]) -> bool:
    alive = is_alive_here(claim)
    if alive is not None:
        return not alive
    until = time.monotonic() + silence
    while time.monotonic() < until and not stopped():
        time.sleep(silence / 20.0)
        try:
            if _read(claim.path).beat != claim.beat:
                return False
        except (OSError, ValueError):
            return not claim.path.exists()
    return not stopped()


def _own_claim(locks: Path, frames: tuple[Frame, ...]) -> Claim:
    process = os.getpid()
    path = locks / f"{uuid.uuid4().hex}.lock"
    return Claim(path, platform.node(), process, _process_start(process) or "", frozenset(frames), 0)


def _write(claim: Claim, beat: int = 0) -> None:
    data = {
        "host": claim.host,
        "process": claim.process,
        "started": claim.started,
        "frames": format_frames(claim.frames),
        "beat": beat,
    }
    with whole_file(claim.path) as beside:
        beside.write_text(json.dumps(data), encoding="utf-8")


def _read(path: Path) -> Claim:
    data: Any = json.loads(path.read_text(encoding="utf-8"))
    return Claim(
        path, str(data["host"]), int(data["process"]), str(data["started"]),
        frozenset(parse_frames(data["frames"])), int(data["beat"]),
    )  # fmt: skip


def _beat(claim: Claim, ended: threading.Event, beat: float) -> None:
    count = 0
    while not ended.wait(beat):
        count += 1
        # a folder that is gone or full is the bake's to report
        with contextlib.suppress(OSError):
            if claim.path.exists():
                _write(claim, count)


def _process_start(process: int) -> str | None:
    """When a process of this machine was started, in the system's own count; None when there is none."""
    try:
        os.kill(process, 0) if os.name != "nt" else None
    except ProcessLookupError:
        return None
    except PermissionError:
        pass  # it runs, and is somebody else's
    try:
        # after the last bracket: a program's name may hold spaces and brackets itself
        status = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return "" if not Path("/proc/self").exists() else None
    return None if status[0] == "Z" else status[19]
