# SPDX-License-Identifier: GPL-3.0-or-later
"""New Python processes that find this package and what it needs, also from inside Blender."""

from __future__ import annotations

import os
import sys
from pathlib import Path

PACKAGE = "ocean_tweak"


def module_command(module: str = "") -> list[str]:
    """The start of a command that runs this package, or a module of it by its name inside the package."""
    return [sys.executable, "-m", f"{PACKAGE}.{module}" if module else PACKAGE]


def environment() -> dict[str, str]:
    """The environment in which that command works.

    Each process is one of several workers: threads of its own would only fight with the others'.
    """
    home = Path(__file__).resolve().parents[2]
    path = os.pathsep.join([str(home), *(entry for entry in sys.path if entry)])
    own = {"PYTHONPATH": path, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    return {**os.environ, **own, "PYTHONIOENCODING": "utf-8:backslashreplace"}
