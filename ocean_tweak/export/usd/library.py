# SPDX-License-Identifier: GPL-3.0-or-later
"""OpenUSD's Python modules, where there are any: Blender's own, or those of the package usd-core."""

from __future__ import annotations

import importlib
import importlib.util
import sys
from functools import cache
from types import ModuleType
from typing import Any

_MODULES = ("Gf", "Kind", "Sdf", "Tf", "Usd", "UsdGeom", "UsdShade", "Vt")


_INSTALL = "install it with 'pip install usd-core', or use a Blender from blender.org, which brings it along"
#: shown in a Blender without OpenUSD
MISSING_IN_BLENDER = f"The Python of this Blender, which would do the work, has no OpenUSD: {_INSTALL}"


class UsdError(RuntimeError):
    """A layer that cannot be written or read, with its path, the reason and the remedy."""


def pxr() -> Any:
    """The package `pxr` with the modules that are used here. Raises UsdError where there is none."""
    try:
        package: ModuleType = importlib.import_module("pxr")
        for name in _MODULES:
            importlib.import_module(f"pxr.{name}")
    except ImportError as error:
        raise UsdError(f"OpenUSD cannot be loaded ({error}): {_INSTALL}") from error
    return package


def is_installed() -> bool:
    """Whether there is a package `pxr`; it is not loaded. Folders are looked through once in a session."""
    if "pxr" in sys.modules:
        return sys.modules["pxr"] is not None
    return _is_found()


@cache
def _is_found() -> bool:
    return importlib.util.find_spec("pxr") is not None
