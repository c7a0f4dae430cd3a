# SPDX-License-Identifier: GPL-3.0-or-later
"""What a layer of ours says of the sea that it was made from."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ...core import ParameterError
from ...core.data.printable import printable
from .layers import MARK, UNREADABLE, named_errors
from .library import UsdError, pxr
from .package import Package

SUFFIXES = (".usd", ".usda", ".usdc")


def read_package(path: Path) -> tuple[str, Package]:
    """Of our layer, or one that brings a single asset of ours: the path of its prim and what was exported.

    Raises UsdError for a layer that cannot be read or holds no sea, or several.
    """
    modules = pxr()
    if not path.is_file():
        raise UsdError(f"{path}: no such file")
    with named_errors(path):
        stage = modules.Usd.Stage.Open(str(path), modules.Usd.Stage.LoadNone)
        found = {str(prim.GetPath()): data for prim in stage.TraverseAll() if (data := _record(prim))}
    if not found:
        raise UsdError(f"{path}: holds no sea of Ocean Tweak")
    if len(found) > 1:
        raise UsdError(f"{path}: holds several seas, {', '.join(found)}: give the layer of one of them")
    ((prim_path, data),) = found.items()
    try:
        return prim_path, Package.from_record(data)
    except ParameterError as error:
        raise UsdError(f"{path}: {prim_path} {error}") from error
    except UNREADABLE as error:
        raise UsdError(
            f"{path}: what {prim_path} says about its sea cannot be used: {printable(error, 200)}"
        ) from error


def _record(prim: Any) -> dict[str, Any] | None:
    data = prim.GetCustomDataByKey(MARK)
    return data if isinstance(data, dict) else None
