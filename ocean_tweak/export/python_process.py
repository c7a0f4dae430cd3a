# SPDX-License-Identifier: GPL-3.0-or-later
"""Starts Python processes that can import this package and its dependencies, also from inside Blender.

They never import modules from the current folder, which may contain Python files from others.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

from ..core.numerics.memo import MEMO
from .places import SHELF_VARIABLE
from .shelf import ArrayFiles

PACKAGE = "ocean_tweak"
_HOME = Path(__file__).resolve().parents[2]
#: -I excludes the current folder and the environment; the import path is passed explicitly instead
_RUN = "import runpy, sys; sys.path[:0] = {path!r}; runpy.run_module({module!r}, None, '__main__', True)"


def module_command(name: str) -> list[str]:
    """The beginning of a command line that runs a module of this package, or the package itself.

    name : the module's or package's `__name__`, which inside Blender begins with other packages
    """
    whole = PACKAGE + name.rpartition(PACKAGE)[2]
    path = [str(_HOME), *(str(entry) for entry in sys.path if not _is_current_folder(entry))]
    return [sys.executable, "-I", "-X", "utf8", "-c", _RUN.format(path=path, module=whole)]


def environment() -> dict[str, str]:
    """The environment for that command.

    Each process is one of several workers, so it uses one thread, and what takes long it finds where this one
    keeps it.
    """
    kept = {SHELF_VARIABLE: str(MEMO.shelf.folder)} if isinstance(MEMO.shelf, ArrayFiles) else {}
    return {**os.environ, **kept, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def _is_current_folder(entry: str) -> bool:
    """Whether an entry of `sys.path` is relative, or the current folder."""
    if not os.path.isabs(entry):  # noqa: PTH117  # an entry need not be a path
        return True
    try:
        return Path(entry).samefile(Path.cwd())
    except OSError:
        return False
