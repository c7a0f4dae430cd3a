# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory and cores available to this process, within the limits of a container."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

_ROOT = Path("/")


def usable_memory() -> int | None:
    """Available memory in bytes: the machine's, or a container's limit if that is lower; None if unknown."""
    limits = [] if sys.platform == "win32" else list(_memory_limits(_ROOT))
    physical = _physical_memory()
    return min([*limits, *([] if physical is None else [physical])], default=None)


def usable_cores() -> int:
    """Number of cores this process may use: farms restrict it to some cores, containers to a share of the
    time."""
    # not everywhere
    affinity = getattr(os, "sched_getaffinity", None)
    cores = len(affinity(0)) if affinity is not None else os.cpu_count() or 1
    shares = [] if sys.platform == "win32" else list(_core_limits(_ROOT))
    return max(1, min(cores, *(math.ceil(share) for share in shares)) if shares else cores)


def _memory_limits(root: Path) -> Iterator[int]:
    """Memory limits in bytes of this process's control groups; those without a limit are omitted."""
    for group in _groups(root, "memory"):
        for name in ("memory.max", "memory.limit_in_bytes"):
            yield from _numbers(group / name)


def _core_limits(root: Path) -> Iterator[float]:
    """CPU limits of this process's control groups, in seconds of CPU time per second."""
    for group in _groups(root, "cpu"):
        pair = list(_numbers(group / "cpu.max"))
        pair = pair or [*_numbers(group / "cpu.cfs_quota_us"), *_numbers(group / "cpu.cfs_period_us")]
        if len(pair) == 2 and min(pair) > 0:
            yield pair[0] / pair[1]


def _groups(root: Path, controller: str) -> Iterator[Path]:
    """Folders of the control groups (v1 and v2) that contain this process, up to the root group.

    A container sees its own group as the root, while the name it is given may be that on the host.
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
    """The numbers in a file; an empty list if one of them means "no limit"."""
    try:
        words = path.read_text(encoding="ascii").split()
    except (OSError, UnicodeDecodeError):
        return
    if all(word.isdecimal() for word in words):
        yield from map(int, words)


def _physical_memory() -> int | None:
    """The machine's memory in bytes; None if the system does not report it."""
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
