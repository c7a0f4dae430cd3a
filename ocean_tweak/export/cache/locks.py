# SPDX-License-Identifier: GPL-3.0-or-later
"""Locks on frames of a bake's folder, so that they are not baked twice at the same time.

A claim is a file with the frames, the host, the process and a counter that its holder keeps incrementing. A
process first writes its claim and then reads the others, so of two simultaneous ones at least one sees the
other, also on a disk without file locks and on machines that cache folder contents; the system's file lock
only ensures that one of them always succeeds.

Claims of dead processes of this machine, and from before its last restart, are ignored. Clocks are not
compared: a holder on another machine, whose state cannot be queried, counts as dead only if a takeover is
requested and its counter does not change while it is watched. If it is alive after all, it notices that its
claim is gone and stops.
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

#: interval in s at which the counter is incremented
BEAT = 5.0
#: time in s without an increment after which a watched holder counts as dead: longer than network disks cache
# contents
SILENCE = 90.0

_LARGEST_LOCK = 2**24
#: digits of the counter, on a line of its own at the end: it is updated in place, which needs no space on a
# full disk and cannot recreate a removed claim
_DIGITS = 12


class Held(RuntimeError):
    """Frames are being baked by another process; says which."""


@dataclass(frozen=True)
class Claim:
    """The claim of a process to frames.

    machine : distinguishes machines of the same name, and containers; changes at a restart
    boot, hardware : identify the machine and its last start; "" if unknown
    started : start time of the process in the system's units, to distinguish it from a later one with the
        same id
    frames : None for an unreadable claim, which may be to any frame
    beat : the counter
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
        """The holder, for messages."""
        if self.frames is None:
            return f"a process whose lock {self.path} cannot be read"
        return f"process {printable(self.process, 20)} on {printable(self.host, 60)}"

    def shared(self, frames: frozenset[Frame]) -> frozenset[Frame]:
        """Which of the frames it claims."""
        return frames if self.frames is None else frames & self.frames


class Hold:
    """Claimed frames."""

    def __init__(self) -> None:
        self._lost = threading.Event()

    def is_lost(self) -> bool:
        """Whether the claim is lost: taken over, or the folder was removed."""
        return self._lost.is_set()

    def lose(self) -> None:
        """Mark the claim as lost."""
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
    """Context manager that claims frames of a folder.

    wait : wait until others have finished with them, instead of raising Held
    take_over : also remove claims of dead holders on other machines
    stopped : polled while waiting; True raises Held
    say : called once with the holder it waits for, and with each claim that it removes

    Raises Held, which names the holder, and CacheError if parts of the folder are links.
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
        with contextlib.suppress(OSError):  # the problem with the folder has been reported
            own.path.unlink(missing_ok=True)


def _refusal(own: Claim, other: Claim, wait: bool, take_over: bool, stopped: Callable[[], bool]) -> str:
    """The error for a conflicting claim."""
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
    """Write the claim, or return a conflicting one."""
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
        with contextlib.suppress(FileNotFoundError):  # it was released meanwhile
            found.append(_read(path))
    return found


def let_go(folder: Path) -> None:
    """Remove this process's claims to frames of a folder, before it ends."""
    own = (this_machine(), os.getpid(), process_start(os.getpid()) or "")
    for claim in claims(folder / LOCKS):
        if (claim.machine, claim.process, claim.started) == own:
            with contextlib.suppress(OSError):
                claim.path.unlink(missing_ok=True)


def is_alive_here(claim: Claim) -> bool | None:
    """Whether the claim's process is running, as far as this machine can know."""
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
    """Whether the counter stands still, or the claim is released, while it is watched."""
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
    """Read a claim. Raises FileNotFoundError if there is none."""
    for _ in range(3):
        try:
            content = read_bytes(path, _LARGEST_LOCK)
            break
        except FileNotFoundError:
            raise
        except OSError:  # network disks sometimes do so for a file that is changing
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
        except OSError:  # a failing disk is reported by the bake's own files
            pass
