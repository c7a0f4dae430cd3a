# SPDX-License-Identifier: GPL-3.0-or-later
"""Damages a layer of an asset in many ways and lets every command read it, in a process that may use little
memory.

`python -m tests.usd.fuzz FOLDER SCRATCH FIRST LAST`: as `tests.batch.fuzz`, of a folder with a sea.usd.
"""

from __future__ import annotations

import contextlib
import io
import random
import resource
import shutil
import signal
import sys
from pathlib import Path

from ocean_tweak.cli import main
from tests.batch.fuzz import SECONDS, mutated

MEMORY = 2**31


def attempt(pristine: Path, scratch: Path, seed: int) -> None:
    """One damage, and every command on it. Raises where one does anything but end with a code."""
    chance = random.Random(seed)
    # each in a folder of its own: OpenUSD remembers layers by their paths
    folder = scratch / str(seed)
    shutil.copytree(pristine, folder)
    path = chance.choice(sorted(path for path in folder.rglob("*.usd*")))
    path.write_bytes(mutated(path.read_bytes(), chance))
    said = io.StringIO()
    commands = (["info", "--params", str(folder / "sea.usd")], ["usd-verify", str(folder / "sea.usd")])
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        codes = [main(arguments) for arguments in commands]
    assert set(codes) <= {0, 1, 2}, (path.name, codes)
    assert "Traceback" not in said.getvalue(), path.name
    shutil.rmtree(folder)


def run(pristine: Path, scratch: Path, seeds: range) -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    for seed in seeds:
        print(seed, flush=True)
        signal.setitimer(signal.ITIMER_PROF, SECONDS)  # ends the process where a command goes on and on
        attempt(pristine, scratch, seed)
    signal.setitimer(signal.ITIMER_PROF, 0)
    print("done", flush=True)


if __name__ == "__main__":
    run(Path(sys.argv[1]), Path(sys.argv[2]), range(int(sys.argv[3]), int(sys.argv[4])))
