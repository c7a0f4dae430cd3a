# SPDX-License-Identifier: GPL-3.0-or-later
"""USD layers, written atomically, with our mark, and never over files of others."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

from ...core.data import formats
from ...core.data.frames import Frame
from ...core.data.printable import printable, shown
from ..files import PART, begun_file, whole_file
from .library import UsdError, pxr
from .package import Package

#: key of customData and customLayerData
MARK = "ocean_tweak"
#: errors for damaged layers: OpenUSD's own, and Python's for values of the wrong type and undecodable text
UNREADABLE = (RuntimeError, ValueError, TypeError, LookupError, AttributeError, ArithmeticError)
_LONGEST = 300  # largest length of a reason, in characters
_REPLACE = "replace it with --force (in Blender: Overwrite)"


@contextlib.contextmanager
def whole_layer(
    path: Path, text: bool = False, alone: AbstractContextManager[Any] | None = None
) -> Iterator[Any]:
    """Context manager for a new `Sdf.Layer`; at the end it is saved, synced and replaces `path`.

    text : write text instead of binary, for a layer named .usd
    alone : lock held while OpenUSD is used, but not while syncing

    Raises UsdError if it cannot be written; the old file is then kept.
    """
    with whole_file(path) as beside, alone or contextlib.nullcontext():
        # OpenUSD chooses the format by the suffix
        draft = beside.with_name(beside.name + path.suffix)
        try:
            with named_errors(path, (pxr().Tf.ErrorException,)):
                yield from _filled(draft, path, text)
            draft.replace(beside)
        finally:
            with contextlib.suppress(OSError):
                draft.unlink(missing_ok=True)


def _filled(draft: Path, path: Path, text: bool) -> Iterator[Any]:
    """Create a layer, save it, and check that it can be opened."""
    sdf = pxr().Sdf
    layer = sdf.Layer.CreateNew(str(draft), args=_format(path, text))
    try:
        yield layer
        save(layer, path)
    finally:
        del layer  # otherwise the next opening of this path would return this layer
    if sdf.Layer.OpenAsAnonymous(str(draft), metadataOnly=True) is None:
        raise UsdError(f"{path}: what was written cannot be read back")


def remove_leftovers(path: Path) -> None:
    """Remove unfinished files of a layer left by killed processes."""
    for part in path.parent.glob(f".{path.name}.*{PART}*"):
        if begun_file(part.with_suffix("") if part.suffix != PART else part) == path.name:
            part.unlink(missing_ok=True)


def _format(path: Path, text: bool) -> dict[str, str]:
    return {"format": "usda" if text else "usdc"} if path.suffix == ".usd" else {}


@contextlib.contextmanager
def named_errors(path: Path, kinds: tuple[type[Exception], ...] = UNREADABLE) -> Iterator[None]:
    """Context manager that converts errors of OpenUSD into UsdError with the file's name, on one line.

    kinds : of errors; by default all that reading may raise
    """
    try:
        yield
    except UsdError:
        raise
    except kinds as error:
        raise UsdError(f"{path}: {reason(error)}") from error


def reason(error: Exception) -> str:
    """The message of an OpenUSD error, without the position in its source."""
    try:
        lines = str(error).splitlines()
    except UnicodeDecodeError:
        return "it holds bytes that are not text"
    said = [line.rpartition(" : ")[2].strip().strip("'") for line in lines if line.strip()]
    return printable("; ".join(dict.fromkeys(said)), _LONGEST) or "OpenUSD failed without a message"


def save(layer: Any, path: Path) -> None:
    """Save a layer. Raises UsdError."""
    with named_errors(path, (pxr().Tf.ErrorException,)):
        saved = layer.Save()
    if not saved:
        raise UsdError(f"{path}: OpenUSD could not save it")


def write_header(
    layer: Any, package: Package, frames: tuple[Frame, ...], prim: str, mark: dict[str, Any] | None = None
) -> None:
    """Write units, up axis, time range and mark of a layer.

    frames : its frames; none for a layer that does not move
    prim : its default prim
    """
    usd_geom = pxr().UsdGeom
    layer.defaultPrim = prim
    layer.timeCodesPerSecond = layer.framesPerSecond = package.frames_per_second
    if frames:
        layer.startTimeCode, layer.endTimeCode = float(frames[0]), float(frames[-1])
    root = layer.pseudoRoot
    root.SetInfo("metersPerUnit", package.metres_per_unit)
    root.SetInfo("upAxis", {"Z": usd_geom.Tokens.z, "Y": usd_geom.Tokens.y}[package.up_axis])
    layer.customLayerData = {MARK: {"format": formats.LAYER, "asset": package.name, **(mark or {})}}


def mark_of(path: Path) -> dict[str, Any] | None:
    """Our mark in a layer; None if there is none or it cannot be read."""
    try:
        layer = pxr().Sdf.Layer.OpenAsAnonymous(str(path))
        mark = layer.customLayerData.get(MARK) if layer is not None else None
    except UNREADABLE:
        return None
    return dict(mark) if isinstance(mark, dict) else None


def refuse_foreign(paths: Iterable[Path], package: Package) -> None:
    """Raise UsdError for a file that this asset's export did not write."""
    for path in paths:
        if not path.exists():
            continue
        owner = (mark_of(path) or {}).get("asset")
        if owner is None:
            raise UsdError(
                f"{path} exists already and was not written by Ocean Tweak, or is damaged: choose "
                f"another folder, or {_REPLACE}"
            )
        if owner != package.name:
            raise UsdError(
                f"{path} belongs to the asset {shown(owner)}: give each asset its own folder, or {_REPLACE}"
            )
