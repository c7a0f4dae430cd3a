# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python environments of the project, each made by uv from requirements/NAME.txt.

uv links packages from its cache, so another clone on the same disk takes seconds and no room, and it fetches
a Python of its own where the system has none that fits.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

from . import stamps
from .project import REQUIREMENTS, TOOLS, ToolError, run_logged

#: by environment; those of Blender are the wheels', which are made for one Python each
PYTHON_OF = {"python-5.2": "3.13", "python-4.5": "3.11", "farm": "3.13", "papers": "3.13", "docs": "3.13"}
#: pytest where the Python inside a real Blender can import it: it is pure Python
PYTEST_IN_BLENDER = TOOLS / "pytest"
_UV_PACKAGE = "uv==0.13.9"


def python(name: str) -> Path:
    """Return the interpreter of an environment."""
    return TOOLS / name / "bin" / "python"


def program(name: str, executable: str) -> Path:
    """Return a program that an environment's packages brought."""
    return TOOLS / name / "bin" / executable


def make_uv() -> None:
    """Install uv, which the rest of this module needs. Raises `ToolError`."""
    if stamps.is_made(TOOLS / "uv", _UV_PACKAGE):
        return
    with stamps.making(TOOLS / "uv", _UV_PACKAGE) as folder:
        try:
            run_logged([sys.executable, "-m", "venv", str(folder)], _log("uv"))
        except ToolError as error:
            raise ToolError(
                f"{sys.executable} cannot make virtual environments: install the rest of it (on Debian "
                f"python3-venv), or name another Python with make PYTHON=...; {error}"
            ) from None
        pip = [str(python("uv")), "-m", "pip", "install", "--quiet"]
        run_logged([*pip, "--disable-pip-version-check", _UV_PACKAGE], _log("uv"))


def make(name: str) -> None:
    """Make an environment where it is not made of its requirements already. Raises `ToolError`."""
    requirements = REQUIREMENTS / f"{name}.txt"
    version = PYTHON_OF[name]
    recipe = f"Python {version}\n{requirements.read_text()}"
    if stamps.is_made(TOOLS / name, recipe) and python(name).exists():
        return
    with stamps.making(TOOLS / name, recipe) as folder:
        try:
            _uv("venv", "--python", version, str(folder), log=name)
        except ToolError as error:
            raise ToolError(
                f"Python {version}, needed for {requirements.name}, was not found and could not be fetched: "
                f"install it with `uv python install {version}`, `pyenv install {version}` or your system's "
                f"packages, then run this again; {error}"
            ) from None
        _uv("pip", "install", "--python", str(python(name)), "-r", str(requirements), log=name)


def make_pytest_for_blender() -> None:
    """Put pytest into a folder of its own. Raises `ToolError`."""
    requirements = REQUIREMENTS / "in-blender.txt"
    recipe = requirements.read_text()
    if stamps.is_made(PYTEST_IN_BLENDER, recipe):
        return
    with stamps.making(PYTEST_IN_BLENDER, recipe) as folder:
        into = ["--target", str(folder), "--python", str(python("python-5.2"))]
        _uv("pip", "install", *into, "-r", str(requirements), log="pytest")


def _uv(*arguments: str, log: str) -> None:
    # as pip does: studios have certificates of their own
    command = [str(program("uv", "uv")), "--quiet", "--system-certs", *arguments]
    run_logged(command, _log(log), {**os.environ, "PATH": search_path()})


def search_path() -> str:
    """Return PATH with pyenv's versions in place of its shims: uv gives up at a shim that does not run."""
    pyenv = Path(os.environ.get("PYENV_ROOT", Path(os.environ.get("HOME", "/"), ".pyenv")))
    system = os.environ.get("PATH", "").split(os.pathsep)
    entries = [entry for entry in system if Path(entry) != pyenv / "shims"]
    return os.pathsep.join([*entries, *map(str, sorted(pyenv.glob("versions/*/bin"), reverse=True))])


def _log(name: str) -> Path:
    return TOOLS / "logs" / f"{name}.log"
