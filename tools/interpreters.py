# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the Python interpreters that Blender's own wheels are made for."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterable, Iterator
from pathlib import Path

from .project import ToolError

PROBE = "import ensurepip, sys, venv; print('%d.%d' % sys.version_info[:2])"


def find_interpreter(version: str, purpose: str) -> str:
    """Return a Python of this version ("3.13") that can make a venv; raise `ToolError` if there is none."""
    for candidate in candidates(version):
        if version_of(candidate) == version:
            return candidate
    raise ToolError(
        f"Python {version}, needed for {purpose}, was not found on PATH or among pyenv's and uv's versions: "
        f"install it with `pyenv install {version}`, `uv python install {version}` or your system's packages "
        f"(on Debian python{version} and python{version}-venv), then run this again"
    )


def candidates(version: str) -> Iterator[str]:
    """Yield existing files that may be this Python, the likeliest first."""
    yield from _existing(
        Path(folder) / f"python{version}" for folder in os.environ.get("PATH", "").split(os.pathsep) if folder
    )
    home = Path(os.environ.get("HOME", "/"))
    pyenv = Path(os.environ.get("PYENV_ROOT", home / ".pyenv")) / "versions"
    uv = Path(os.environ.get("UV_PYTHON_INSTALL_DIR", home / ".local/share/uv/python"))
    yield from _existing(sorted(pyenv.glob(f"{version}*/bin/python{version}"), reverse=True))
    yield from _existing(sorted(uv.glob(f"cpython-{version}*/bin/python{version}"), reverse=True))


def version_of(executable: str) -> str:
    """Return "major.minor" of a Python that runs and can make a venv, or "" (a pyenv shim may do neither)."""
    try:
        answer = subprocess.run(
            [executable, "-I", "-c", PROBE],
            stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=30,
        )  # fmt: skip
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return answer.stdout.strip() if answer.returncode == 0 else ""


def _existing(paths: Iterable[Path]) -> Iterator[str]:
    return (str(path) for path in paths if path.is_file() and os.access(path, os.X_OK))
