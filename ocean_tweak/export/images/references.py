# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that stand in parameters in place of a raster."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ...core.data.errors import ParameterError
from ...core.data.plain_data import class_of
from ...core.data.raster import Raster, check_numbers
from ...core.data.validation import check_count
from .arrays import AXES
from .reading import read_raster

#: what a JSON file may say in place of a raster; `offset` is taken away before `scale` multiplies
REFERENCE_KEYS = frozenset({"file", "channels", "axes", "offset", "scale"})

#: from a file, how many channels are wanted, their names and the order of axes; as `read_raster`
Reader = Callable[[Path, int, str, str], Raster]


def with_rasters(kind: type, data: Any, folder: Path, read: Reader = read_raster) -> Any:
    """Plain data of a dataclass in which each reference to a file has become the raster's plain data.

    kind : the dataclass; its fields of rasters say how many channels they want
    data : as it stands in JSON; {"file": "wind.exr"} may stand for a raster, with "channels" of an EXR image
        or "axes" of an array, and "offset" and "scale" where the numbers are to become
        scale · (number - offset)
    folder : what relative paths are relative to
    read : what reads a file

    Raises ParameterError with the path of what is wrong. Data of another form is left for validation.
    """
    return _Resolver(folder, read).inside(kind, data)


class _Resolver:
    """Replaces references, and counts the numbers that they bring."""

    def __init__(self, folder: Path, read: Reader) -> None:
        self._folder, self._read, self._numbers = folder, read, 0

    def inside(self, kind: type, data: Any) -> Any:
        """The data of a dataclass without references."""
        if not isinstance(data, dict):
            return data
        result = dict(data)
        for field in dataclasses.fields(kind):
            if field.name not in data:
                continue
            if isinstance(data[field.name], list):
                check_count(field.name, data[field.name], field.metadata)
            try:
                result[field.name] = self._resolved(field.metadata, data[field.name])
            except ParameterError as error:
                raise error.inside(field.name) from None
        return result

    def _resolved(self, metadata: Any, value: Any) -> Any:
        nested = metadata.get("nested")
        if metadata.get("kind") is Raster and isinstance(value, dict) and "file" in value:
            return self._referred(value, metadata["channels"]).to_plain()
        if nested is None:
            return value
        if not metadata.get("many"):
            return self.inside(nested, value)
        if not isinstance(value, list):
            return value
        items = []
        for index, item in enumerate(value):
            try:
                items.append(self.inside(class_of(metadata, item), item))
            except ParameterError as error:
                raise error.inside(str(index)) from None
        return items

    def _referred(self, reference: dict[str, Any], channels: int) -> Raster:
        offset, scale = _checked(reference)
        names, axes = reference.get("channels", ""), reference.get("axes", "")
        image = self._read(self._folder / reference["file"], channels, names, axes)
        self._numbers += image.values.size
        check_numbers(self._numbers)
        if (offset, scale) == (0.0, 1.0):
            return image
        return Raster(scale * (image.values.astype(np.float64) - offset), image.name)


def _checked(reference: dict[str, Any]) -> tuple[float, float]:
    """Offset and scale of a reference of which all else is as it must be."""
    unknown = sorted(set(reference) - REFERENCE_KEYS)
    if unknown:
        known = ", ".join(sorted(REFERENCE_KEYS))
        raise ParameterError(str(unknown[0]), reference[unknown[0]], f"unknown key; Known keys: {known}")
    if not isinstance(reference["file"], str) or not reference["file"]:
        raise ParameterError("file", reference["file"], "must be the path of a file")
    if not isinstance(reference.get("channels", ""), str):
        reason = 'must be names of channels or of a layer: "Z", "u,v", "mask"'
        raise ParameterError("channels", reference["channels"], reason)
    if reference.get("axes", "") not in ("", *AXES):
        raise ParameterError("axes", reference["axes"], f"must be one of {', '.join(AXES)}")
    offset, scale = (_number(reference, key, usual) for key, usual in (("offset", 0.0), ("scale", 1.0)))
    return offset, scale


def _number(reference: dict[str, Any], key: str, usual: float) -> float:
    value = reference.get(key, usual)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= 1e6:
        raise ParameterError(key, value, "must be a number from -1e6 to 1e6")
    return float(value)
