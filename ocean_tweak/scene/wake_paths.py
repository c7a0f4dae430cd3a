# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths of wakes as text that a file keeps, with the footprint of what is moved along them."""

from __future__ import annotations

import json
from functools import lru_cache
from typing import Any

from ..core import ParameterError, PathSample, Raster, WakeLayer
from ..core.data.plain_data import from_plain, parse_json

#: texts that were read
_KEPT = 16
#: fields of a layer that stand in the text, by their order
_FIELDS = ("time", "x", "y", "heading", "immersion")


def to_text(layer: WakeLayer) -> str:
    """What `from_text` reads: a path's samples in rows, and a footprint."""
    rows = [[getattr(sample, name) for name in _FIELDS] for sample in layer.path]
    footprint = None if layer.footprint is None else layer.footprint.to_plain()
    return json.dumps({"path": rows, "footprint": footprint}) if rows or footprint else ""


def with_path(text: str, path: tuple[PathSample, ...]) -> str:
    """The text of a layer with another path."""
    return to_text(WakeLayer(path=path, footprint=from_text(text)[1]))


@lru_cache(_KEPT)
def from_text(text: str) -> tuple[tuple[PathSample, ...], Raster | None]:
    """A path and a footprint; none of either in an empty text. Raises ParameterError for a damaged one."""
    if not text:
        return (), None
    data = parse_json(text)
    try:
        path = tuple(from_plain(PathSample, dict(zip(_FIELDS, row, strict=True))) for row in data["path"])
        footprint: Any = data["footprint"]
        return path, None if footprint is None else Raster.from_plain(footprint)
    except (KeyError, TypeError, ValueError) as error:
        raise ParameterError("path", text[:40], f"is damaged: {error}. Press Make Waves again") from None
