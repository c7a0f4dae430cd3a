# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes what the project is built and tested with, each part once: `python3 -m tools.setup [PART ...]`."""

from __future__ import annotations

import argparse
import fcntl
import sys
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial

from . import environments, real_blender
from .project import TOOLS, ToolError


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the parts asked for (all by default); return the exit code."""
    parser = argparse.ArgumentParser(prog="python3 -m tools.setup", description=__doc__)
    parser.add_argument("part", nargs="*", help=f"any of {', '.join(PARTS)}; all of them by default")
    names = parser.parse_args(arguments).part or list(PARTS)
    for name in names:
        if name not in PARTS:
            parser.error(f"there is no part {name!r}: choose from {', '.join(PARTS)}")
    TOOLS.mkdir(exist_ok=True)
    with (TOOLS / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # two runs at once: the second waits, then finds all made
        if any(name != "blender" for name in names) and _make("uv", environments.make_uv):
            return 1
        with ThreadPoolExecutor(len(names)) as pool:
            return max(pool.map(_make, names, [PARTS[name] for name in names]))


def _make_python_52() -> None:
    """The environment of all tests, and what only they need beside it."""
    environments.make("python-5.2")
    environments.make_pytest_for_blender()
    environments.make("farm")


def _make(name: str, make: Callable[[], None]) -> int:
    begin = time.monotonic()
    try:
        make()
    except ToolError as error:
        print(f"set-up of {name} failed: {error}", file=sys.stderr, flush=True)
        return 1
    seconds = time.monotonic() - begin
    if seconds > 5:
        print(f"set-up of {name}: {seconds:.0f} s", flush=True)
    return 0


def _make_blender() -> None:
    """Missing is a failure only where a real Blender is required; the test run says that it had none."""
    try:
        real_blender.find(make=True)
    except real_blender.NoBlender as missing:
        if real_blender.required():
            raise
        print(f"no real Blender: {missing}", file=sys.stderr, flush=True)


PARTS = {
    "python-5.2": _make_python_52,
    "python-4.5": partial(environments.make, "python-4.5"),
    "blender": _make_blender,
}

if __name__ == "__main__":
    sys.exit(main())
