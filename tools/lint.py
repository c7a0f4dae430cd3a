# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs every static check, also after one has failed: `make lint`, or `make lint` with `FIX=1` to format."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from .project import ROOT

BIN = Path(sys.executable).parent
CHECKS = (
    ("ruff", "format", "--check"), ("ruff", "check"), ("mypy",), ("lint-imports",),
    ("python", "-m", "tools.unused"), ("python", "-m", "tools.arrows"), ("codespell",),
    ("python", "-m", "tools.words"),
)  # fmt: skip
FIXES = (("ruff", "format"), ("ruff", "check", "--fix"))


def main() -> int:
    """Run the checks; return the exit code."""
    fixes = FIXES if os.environ.get("FIX") else ()
    failed = []
    for name, *arguments in (*fixes, *CHECKS):
        print(f"== {' '.join([name, *arguments])}", flush=True)
        if subprocess.call([str(BIN / name), *arguments], cwd=ROOT):
            failed.append(" ".join([name, *arguments]))
    print(f"lint failed: {', '.join(failed)}" if failed else "lint: all checks passed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
