# SPDX-License-Identifier: GPL-3.0-or-later
"""What the machine, or a container on it, lets this process have: memory and cores."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

_ROOT = Path("/")


def usable_memory() -> int | None:
    """Bytes of memory: the machine's or, where a container may have less, those; None where nobody tells."""
    limits = [] if sys.platform == "win32" else list(_memory_limits(_ROOT))
    physical = _physical_memory()
    return min([*limits, *([] if physical is None else [physical])], default=None)


def usable_cores() -> int:
    """Cores that this process may use: a farm gives a part of a machine, a container a part of the time."""
    # not everywhere
    affinity = getattr(os, "sched_getaffinity", None)
    cores = len(affinity(0)) if affinity is not None else os.cpu_count() or 1
    shares = [] if sys.platform == "win32" else list(_core_limits(_ROOT))
    return max(1, min(cores, *(math.ceil(share) for share in shares)) if shares else cores)


def _memory_limits(root: Path) -> Iterator[int]:
    """Bytes that the control groups of this process allow; none of those without a limit."""
    for group in _groups(root, "memory"):
        for name in ("memory.max", "memory.limit_in_bytes"):
            yield from _numbers(group / name)


def _core_limits(root: Path) -> Iterator[float]:
    """Seconds of work a second that the control groups of this process allow."""
    for group in _groups(root, "cpu"):
        pair = list(_numbers(group / "cpu.max"))
        pair = pair or [*_numbers(group / "cpu.cfs_quota_us"), *_numbers(group / "cpu.cfs_period_us")]
        if len(pair) == 2 and min(pair) > 0:
            yield pair[0] / pair[1]


def _groups(root: Path, controller: str) -> Iterator[Path]:
    """Folders of the control groups that hold this process, of both versions, up to the whole machine's.

    A container sees its own group as the whole, while the name that it is told may be the machine's.
    """
    try:
        lines = (root / "proc/self/cgroup").read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError):
        return
    for line in lines:
        _, controllers, name = [*line.split(":", 2), "", ""][:3]
        if controllers and controller not in controllers.split(","):
            continue
        home = root / "sys/fs/cgroup" / (controller if controllers else "")
        parts = [part for part in PurePosixPath(name).parts if part not in ("/", "..")]
        yield from (home.joinpath(*parts[:depth]) for depth in range(len(parts), -1, -1))


def _numbers(path: Path) -> Iterator[int]:
    """The numbers in a file; none where one of them is no limit."""
    try:
        words = path.read_text(encoding="ascii").split()
    except (OSError, UnicodeDecodeError):
        return
    if all(word.isdecimal() for word in words):
        yield from map(int, words)


def _physical_memory() -> int | None:
    """The machine's memory in bytes; None where the system does not tell."""
    if sys.platform == "win32":
        return _windows_memory()
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (ValueError, OSError):
        return None


def _windows_memory() -> int | None:
    import ctypes

    kilobytes = ctypes.c_ulonglong()
    kernel = ctypes.WinDLL("kernel32")  # type: ignore[attr-defined]
    if not kernel.GetPhysicallyInstalledSystemMemory(ctypes.byref(kilobytes)):
        return None
    return kilobytes.value * 1024
