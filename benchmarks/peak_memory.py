# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the command line and says last what memory it took: `python -m benchmarks.peak_memory ARGUMENT …`."""

from __future__ import annotations

import re
import resource
import sys
from pathlib import Path

from ocean_tweak.cli import main

_STATUS = Path("/proc/self/status")


def peak_bytes() -> int:
    """The largest resident size of this process.

    Not `ru_maxrss` where there is another way: on Linux a new process inherits that of the one that began it.
    """
    if _STATUS.exists():
        found = re.search(r"^VmHWM:\s+(\d+) kB", _STATUS.read_text(), re.MULTILINE)
        if found:
            return 1024 * int(found[1])
    unit = 1 if sys.platform == "darwin" else 1024
    return unit * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


if __name__ == "__main__":
    code = main(sys.argv[1:])
    print(peak_bytes())
    sys.exit(code)
