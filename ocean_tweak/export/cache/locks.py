# SPDX-License-Identifier: GPL-3.0-or-later
"""Who is making which frames of a folder, so that nobody makes them twice at the same time.

A claim is a file with the frames, the host, the process and a counter that its holder keeps raising. It is
written first and the others are looked at afterwards, so of two that come at the same time at least one sees
the other, also on a disk without file locks and from machines that remember a folder's old contents for a
while; the system's own file lock only sees to it that one of them always gets in.

The claim of a process of this machine that has died counts for nothing, nor does one from before the machine
was started again. Clocks are not compared: a holder elsewhere, which cannot be asked, counts as dead only
when somebody wants it taken over and its counter stands still while it is watched. Should it be alive
nevertheless, it notices that its claim is gone and stops.
"""

from __future__ import annotations

import contextlib
import json
import os
import platform
import random
import threading
import time
import uuid
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core.data.frames import Frame, format_frames, parse_frames
from ...core.data.printable import printable
from ..files import alone, read_bytes, write_text
from .folders import ENTRY, LOCKS, refuse_links
from .processes import boot, hardware, process_start, this_machine

#: s between two beats
BEAT = 5.0
#: s without one after which a watched holder is taken for dead: longer than network disks show old contents
SILENCE = 90.0

_LARGEST_LOCK = 2**24
#: of the counter, on a line of its own at the end: it is raised in place, which needs no room on a full disk
#: and never brings back a claim that was removed
_DIGITS = 12


class Held(RuntimeError):
    """Frames that somebody else is making: says who."""


@dataclass(frozen=True)
class Claim:
    """Somebody's claim to frames.

    machine : tells machines of one name apart, and what runs in containers; another after a restart
    boot, hardware : which start of which machine it was; "" where that cannot be told
    started : of the process in the system's own count, to tell it from a later one with the same number
    frames : None for a claim that cannot be read: it may be to any
    beat : how often its holder has said that it lives
    """

    path: Path
    host: str
    machine: str
    process: int
    started: str
    frames: frozenset[Frame] | None
    beat: int
    boot: str = ""
    hardware: str = ""

    @property
    def holder(self) -> str:
        """Who it is, for a message."""
        if self.frames is None:
            return f"a process whose lock {self.path} cannot be read"
        return f"process {printable(self.process, 20)} on {printable(self.host, 60)}"

    def shared(self, frames: frozenset[Frame]) -> frozenset[Frame]:
        """Which of the frames it claims."""
        return frames if self.frames is None else frames & self.frames


class Hold:
    """Frames that are held."""

    def __init__(self) -> None:
        self._lost = threading.Event()

    def is_lost(self) -> bool:
        """Whether the claim is gone: taken over, or the folder was removed."""
        return self._lost.is_set()

    def lose(self) -> None:
        """Say that the claim is gone."""
        self._lost.set()


@contextlib.contextmanager
def claimed(
    folder: Path,
    frames: tuple[Frame, ...],
    wait: bool = False,
    take_over: bool = False,
    stopped: Callable[[], bool] = lambda: False,
    say: Callable[[str], None] = lambda text: None,
) -> Iterator[Hold]:
    """Hold frames of a folder while this is open.

    wait : until others have finished with them; otherwise refuse
    take_over : also remove the claims of holders on other machines that are dead
    stopped : asked while waiting; True ends it with Held
    say : is told once whom it waits for, and of each claim that it removes

    Raises Held naming who has them, CacheError where the folder's own parts are links.
    """
    refuse_links(folder)
    locks = folder / LOCKS
    locks.mkdir(exist_ok=True)
    own = _own_claim(locks, frames)
    told = None
    while (other := _enter(own)) is not None:
        alive = is_alive_here(other)
        if alive is False or (alive is None and take_over and _stands_still(other, stopped, say)):
            other.path.unlink(missing_ok=True)
            say(f"{other.holder} has died; its lock is removed")
            continue
        problem = _refusal(own, other, wait, take_over, stopped)
        if problem:
            raise Held(f"{_overlap(own, other)}{problem}")
        if told != other.path:
            say(f"waiting: {_overlap(own, other)}")
            told = other.path
        time.sleep(random.uniform(0.5, 1.0) * min(BEAT, 1.0) / 4.0)
    hold, ended = Hold(), threading.Event()
    heart = threading.Thread(target=_beat, args=(own, hold, ended), name="Ocean Tweak lock", daemon=True)
    heart.start()
    try:
        yield hold
    finally:
        ended.set()
        heart.join()
        with contextlib.suppress(OSError):  # what is wrong with the folder has been told
            own.path.unlink(missing_ok=True)


def _refusal(own: Claim, other: Claim, wait: bool, take_over: bool, stopped: Callable[[], bool]) -> str:
    """Why not to wait for the other claim."""
    if stopped():
        return "; stopped waiting for it"
    if wait:
        return ""
    if take_over:
        return " and is alive: only the lock of a dead process can be taken over; wait for it with --wait"
    if is_alive_here(other):
        return ": wait for it with --wait"
    return ": wait for it with --wait or, if it has died, take over its lock with --take-over"


def _enter(own: Claim) -> Claim | None:
    """Write the claim, or return one that stands against it."""
    locks = own.path.parent
    with alone(locks / ENTRY):
        try:
            _write(own)
            other = next((other for other in claims(locks) if _stands_against(own, other)), None)
        except BaseException:
            own.path.unlink(missing_ok=True)
            raise
        if other is not None:
            own.path.unlink(missing_ok=True)
    return other


def _stands_against(own: Claim, other: Claim) -> bool:
    return other.path != own.path and bool(other.shared(own.frames or frozenset()))


def _overlap(own: Claim, other: Claim) -> str:
    shared = other.shared(own.frames or frozenset())
    return f"frames {format_frames(shared)} are being baked by {other.holder}"


def claims(locks: Path) -> list[Claim]:
    """All claims; one that cannot be read claims every frame."""
    found = []
    for path in sorted(locks.glob("*.lock")):
        with contextlib.suppress(FileNotFoundError):  # it was let go meanwhile
            found.append(_read(path))
    return found


def let_go(folder: Path) -> None:
    """Remove the claims of this process to frames of a folder; it is about to end."""
    own = (this_machine(), os.getpid(), process_start(os.getpid()) or "")
    for claim in claims(folder / LOCKS):
        if (claim.machine, claim.process, claim.started) == own:
            with contextlib.suppress(OSError):
                claim.path.unlink(missing_ok=True)


def is_alive_here(claim: Claim) -> bool | None:
    """Whether the claim's process runs, where that can be told: on its own machine."""
    if claim.frames is None:
        return None
    if claim.machine != this_machine():
        is_of_this = claim.hardware and claim.hardware == hardware()
        return False if is_of_this and claim.boot and boot() and claim.boot != boot() else None
    started = process_start(claim.process)
    if started is None:
        return False
    return started == claim.started if started and claim.started else None


def _stands_still(claim: Claim, stopped: Callable[[], bool], say: Callable[[str], None]) -> bool:
    """Whether its counter does, or the claim is let go, while it is watched."""
    say(f"watching {claim.holder} for {SILENCE:.0f} s")
    until = time.monotonic() + SILENCE
    while time.monotonic() < until:
        time.sleep(min(1.0, SILENCE / 20.0))
        if stopped():
            return False
        try:
            if _read(claim.path).beat != claim.beat:
                return False
        except FileNotFoundError:
            return True
    return True


def _own_claim(locks: Path, frames: tuple[Frame, ...]) -> Claim:
    process = os.getpid()
    path = locks / f"{uuid.uuid4().hex}.lock"
    started = process_start(process) or ""
    return Claim(
        path, platform.node(), this_machine(), process, started, frozenset(frames), 0, boot(), hardware()
    )


def _write(claim: Claim) -> None:
    data = {
        "host": claim.host,
        "machine": claim.machine,
        "boot": claim.boot,
        "hardware": claim.hardware,
        "process": claim.process,
        "started": claim.started,
        "frames": format_frames(claim.frames or ()),
    }
    write_text(claim.path, f"{json.dumps(data)}\n{0:0{_DIGITS}d}\n")


def _read(path: Path) -> Claim:
    """The claim in a file. Raises FileNotFoundError where there is none."""
    for _ in range(3):
        try:
            content = read_bytes(path, _LARGEST_LOCK)
            break
        except FileNotFoundError:
            raise
        except OSError:  # network disks do so now and then for a file that changes
            time.sleep(0.05)
    else:
        content = b""
    try:
        text, _, beat = content.partition(b"\n")
        data: Any = json.loads(text)
        return Claim(
            path, str(data["host"]), str(data["machine"]), int(data["process"]), str(data["started"]),
            frozenset(parse_frames(data["frames"])), int(beat),
            str(data.get("boot", "")), str(data.get("hardware", "")),
        )  # fmt: skip
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError, OverflowError):
        return Claim(path, "", "", 0, "", None, 0)


def _beat(claim: Claim, hold: Hold, ended: threading.Event) -> None:
    count = 0
    while not ended.wait(BEAT):
        count += 1
        try:
            with claim.path.open("r+b") as file:
                file.seek(-_DIGITS - 1, os.SEEK_END)
                file.write(b"%0*d" % (_DIGITS, count))
        except (FileNotFoundError, NotADirectoryError):
            hold.lose()
            return
        except OSError:  # of a disk that fails, the bake's own files tell
            pass
