# SPDX-License-Identifier: GPL-3.0-or-later
"""OpenUSD's Python modules, where there are any: Blender's own, or those of the package usd-core."""

from __future__ import annotations

import importlib
from types import ModuleType
from typing import Any

_MODULES = ("Gf", "Kind", "Sdf", "Tf", "Usd", "UsdGeom", "UsdShade", "Vt")


class UsdError(RuntimeError):
    """A layer that cannot be written or read, with its path, the reason and the remedy."""


def pxr() -> Any:
    """The package `pxr` with the modules that are used here. Raises UsdError where there is none."""
    try:
        package: ModuleType = importlib.import_module("pxr")
        for name in _MODULES:
            importlib.import_module(f"pxr.{name}")
    except ImportError as error:
        raise UsdError(
            f"OpenUSD cannot be loaded ({error}): install it with 'pip install usd-core', or use a Blender "
            "from blender.org, which brings it along"
        ) from error
    return package
