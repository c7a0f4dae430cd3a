# SPDX-License-Identifier: GPL-3.0-or-later
"""Identifies processes across machines and restarts."""

from __future__ import annotations

import contextlib
import os
import platform
import subprocess
import sys
import uuid
from functools import cache
from pathlib import Path

#: the machine's own process namespace, not that of a container: the same in every Linux
_OF_THE_MACHINE = "pid:[4026531836]"


@cache
def this_machine() -> str:
    """Identifies this machine, as opposed to others of the same name, an earlier start, or a container."""
    identity = [platform.node(), boot(), _process_numbers()]
    known = [part for part in identity if part]
    return " ".join(known if len(known) > 1 else [*known, f"{uuid.getnode():012x}"])


@cache
def boot() -> str:
    """Identifies the last start of this machine; "" if unknown."""
    with contextlib.suppress(OSError):
        return Path("/proc/sys/kernel/random/boot_id").read_text().strip()
    return ""


@cache
def hardware() -> str:
    """Identifies this machine across restarts.

    "" if unknown, in a container or without a network card. A cloned machine has the same name and system id,
    but not the same network address.
    """
    if _process_numbers() != _OF_THE_MACHINE:
        return ""
    addresses = set()
    for card in Path("/sys/class/net").glob("*/device"):
        with contextlib.suppress(OSError):
            addresses.add((card.parent / "address").read_text().strip())
    addresses -= {"", "00:00:00:00:00:00"}
    number = ""
    with contextlib.suppress(OSError):
        number = Path("/etc/machine-id").read_text().strip()
    return " ".join([number, *sorted(addresses)]) if addresses else ""


def process_start(process: int) -> str | None:
    """Start time of a process of this machine, in the system's units.

    "" if it is unknown whether it runs; None if there is no such process.
    """
    if not 0 < process < 2**31:
        return None
    if os.name == "nt":
        return _windows_start(process)
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return None
    except PermissionError:
        pass  # it runs, but belongs to another user
    return _told_by_ps(process) if sys.platform == "darwin" else _told_by_proc(process)


def _process_numbers() -> str:
    """The process namespace: the machine's, or a container's."""
    with contextlib.suppress(OSError):
        return str(Path("/proc/self/ns/pid").readlink())
    return ""


def _told_by_proc(process: int) -> str | None:
    try:
        # after the last bracket, as a program's name may contain spaces and brackets
        status = Path(f"/proc/{process}/stat").read_text(errors="replace").rpartition(")")[2].split()
    except OSError:
        return ""
    return None if status[0] == "Z" else status[19]


def _told_by_ps(process: int) -> str:
    command = ["/bin/ps", "-o", "lstart=", "-p", str(process)]
    with contextlib.suppress(OSError, subprocess.SubprocessError):
        answer = subprocess.run(
            command, capture_output=True, text=True, timeout=5.0, env={"LC_ALL": "C", "TZ": "UTC"}
        )
        return answer.stdout.strip()
    return ""


def _windows_start(process: int) -> str | None:
    """The id of an ended process is only kept while a handle to it is open."""
    import ctypes
    from ctypes import wintypes

    query, still_active, no_such_process = 0x1000, 259, 87
    kernel = ctypes.WinDLL("kernel32", use_last_error=True)  # type: ignore[attr-defined]
    kernel.OpenProcess.restype = wintypes.HANDLE
    handle = kernel.OpenProcess(query, False, process)
    if not handle:
        return None if ctypes.get_last_error() == no_such_process else ""  # type: ignore[attr-defined]
    handle = wintypes.HANDLE(handle)
    try:
        code, times = wintypes.DWORD(), [wintypes.FILETIME() for _ in range(4)]
        told = kernel.GetExitCodeProcess(handle, ctypes.byref(code))
        if told and code.value != still_active:
            return None
        if not kernel.GetProcessTimes(handle, *map(ctypes.byref, times)):
            return ""
    finally:
        kernel.CloseHandle(handle)
    return str(times[0].dwHighDateTime << 32 | times[0].dwLowDateTime)
