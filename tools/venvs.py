# SPDX-License-Identifier: GPL-3.0-or-later
"""One virtual environment for each Blender supported, with that Blender as a wheel."""

from __future__ import annotations

from pathlib import Path

from . import interpreters, stamps
from .project import REQUIREMENTS, TOOLS, run_logged

PYTHON_OF_BLENDER = {"5.2": "3.13", "4.5": "3.11"}
PYTEST_IN_BLENDER = TOOLS / "pytest"
FARM = TOOLS / "farm"
PAPERS = TOOLS / "papers"


def python(blender: str) -> Path:
    """Return the interpreter of the environment for this Blender ("5.2")."""
    return _folder(blender) / "bin" / "python"


def interpreter_to_use(blender: str) -> str | None:
    """Return the Python to make this Blender's environment with, None if it stands already.

    Raises `ToolError` if there is no such Python.
    """
    folder, recipe = _folder(blender), _recipe(blender)
    if stamps.is_made(folder, recipe) and python(blender).exists():
        return None
    return interpreters.find_interpreter(PYTHON_OF_BLENDER[blender], f"Blender {blender}")


def make_venv(blender: str, interpreter: str) -> None:
    """Make the environment of this Blender."""
    log = TOOLS / "logs" / f"python-{blender}.log"
    requirements = str(_requirements(blender))
    with stamps.making(_folder(blender), _recipe(blender)) as folder:
        run_logged([interpreter, "-m", "venv", str(folder)], log)
        run_logged([str(python(blender)), "-m", "pip", "install", "-r", requirements], log)


def make_pytest_for_blender() -> None:
    """Put pytest where the Python inside a real Blender can import it: it is pure Python."""
    requirements = REQUIREMENTS / "in-blender.txt"
    recipe = requirements.read_text()
    if stamps.is_made(PYTEST_IN_BLENDER, recipe):
        return
    install = [str(python("5.2")), "-m", "pip", "install", "--target", str(PYTEST_IN_BLENDER), "-r"]
    with stamps.making(PYTEST_IN_BLENDER, recipe):
        run_logged([*install, str(requirements)], TOOLS / "logs" / "pytest.log")


def make_farm() -> None:
    """Make the environment of the farms' own programs: their versions would disturb those of the others."""
    _make_beside(FARM)


def make_papers() -> None:
    """Make the environment that draws the plots of docs/papers: nothing else wants what it needs."""
    _make_beside(PAPERS)


def _make_beside(place: Path) -> None:
    """Make an environment of its own from the requirements of its name."""
    requirements = REQUIREMENTS / f"{place.name}.txt"
    recipe = requirements.read_text()
    if stamps.is_made(place, recipe):
        return
    log = TOOLS / "logs" / f"{place.name}.log"
    with stamps.making(place, recipe):
        run_logged([str(python("5.2")), "-m", "venv", str(place)], log)
        run_logged([str(place / "bin" / "python"), "-m", "pip", "install", "-r", str(requirements)], log)


def _folder(blender: str) -> Path:
    return TOOLS / f"python-{blender}"


def _requirements(blender: str) -> Path:
    return REQUIREMENTS / f"python-{blender}.txt"


def _recipe(blender: str) -> str:
    return f"Python {PYTHON_OF_BLENDER[blender]}\n{_requirements(blender).read_text()}"
