# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts dataclasses to plain data and back. Unknown keys are errors that give their path."""

from __future__ import annotations

import dataclasses
import difflib
import json
from fractions import Fraction
from typing import Any

from .errors import ParameterError
from .raster import Raster
from .validation import check_count, kind_of


def parse_json(text: str) -> Any:
    """Parse JSON text; duplicate keys are refused. Raises ParameterError."""
    try:
        return json.loads(text, object_pairs_hook=_unique_keys)
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        raise ParameterError("JSON", text[:40], f"is not valid JSON at {place}: {error.msg}") from None
    except RecursionError:
        raise ParameterError("JSON", text[:40], "is nested too deeply") from None
    except ParameterError:
        raise
    except ValueError as error:  # a number with more digits than Python accepts
        raise ParameterError("JSON", text[:40], f"is not valid JSON: {error}") from None


def _unique_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    result: dict[str, Any] = {}
    for key, value in pairs:
        if key in result:
            raise ParameterError(key, value, "stands twice in the same JSON object")
        result[key] = value
    return result


def to_plain(value: Any, brief: bool = False) -> Any:
    """A dataclass as dictionaries, lists and numbers; a fraction without a short decimal form becomes text.

    brief : reduce rasters to name, shape and hash, which cannot be read back
    """
    if dataclasses.is_dataclass(value):
        fields = [f for f in dataclasses.fields(value) if not _is_unused(f, getattr(value, f.name))]
        return {f.name: _field_to_plain(f, getattr(value, f.name), brief) for f in fields}
    if isinstance(value, tuple):
        return [to_plain(item, brief) for item in value]
    if isinstance(value, Raster):
        return value.brief() if brief else value.to_plain()
    if isinstance(value, Fraction):
        decimal = int(value) if value.denominator == 1 else float(value)
        return decimal if Fraction(str(decimal)) == value else str(value)
    return value


def _field_to_plain(field: dataclasses.Field[Any], value: Any, brief: bool) -> Any:
    plain, kinds = to_plain(value, brief), field.metadata.get("kinds")
    if not kinds:
        return plain
    pairs = zip(value, plain, strict=True)
    return [data if entry.kind == kinds[0].kind else {"kind": entry.kind, **data} for entry, data in pairs]


def _is_unused(field: dataclasses.Field[Any], value: object) -> bool:
    """Whether a value is the default of a field marked as left out. Omitting it keeps the JSON, and so the
    fingerprints, of seas that do not use a newer feature unchanged."""
    is_empty = not value and not isinstance(value, float)
    return bool(field.metadata.get("left_out")) and (is_empty or value == field.default)


def from_plain(cls: type, data: object) -> Any:
    """An instance of a dataclass from plain data. Missing keys keep their defaults; an instance is returned
    as it is.

    A field with "nested" in its metadata holds a dataclass, with "many" a list of them; a Raster is read by
    `Raster.from_plain`. Raises ParameterError with the path of the invalid value.
    """
    if isinstance(data, cls):
        return data
    if not isinstance(data, dict):
        raise ParameterError(cls.__name__, data, "must be a JSON object")
    fields = {f.name: f for f in dataclasses.fields(cls)}
    arguments = {}
    for key, value in data.items():
        if key not in fields:
            raise ParameterError(str(key), value, _unknown_key(str(key), list(fields)))
        if isinstance(value, list):
            check_count(fields[key].name, value, fields[key].metadata)
        try:
            arguments[key] = _nested_value(fields[key], value)
        except ParameterError as error:
            raise error.inside(key) from None
    return cls(**arguments)


def _nested_value(field: dataclasses.Field[Any], value: object) -> object:
    nested = field.metadata.get("nested")
    if field.metadata.get("kind") is Raster and value is not None:
        return Raster.from_plain(value)
    if nested is None:
        return value
    if not field.metadata.get("many"):
        return None if value is None and field.metadata.get("optional") else from_plain(nested, value)
    if not isinstance(value, list):
        return value
    items = []
    for index, item in enumerate(value):
        try:
            items.append(from_plain(class_of(field.metadata, item), without_kind(field.metadata, item)))
        except ParameterError as error:
            raise error.inside(str(index)) from None
    return tuple(items)


def class_of(metadata: Any, entry: object) -> type:
    """The class of one entry (an instance or plain data) of a list field. Raises ParameterError."""
    kinds = {kind.kind: kind for kind in metadata["kinds"]}
    if not kinds:
        nested: type = metadata["nested"]
        return nested
    name = kind_of(entry, next(iter(kinds)))
    if not isinstance(name, str) or name not in kinds:
        near = difflib.get_close_matches(str(name)[:40].upper(), kinds, n=1, cutoff=0.0)
        raise ParameterError(
            "kind", name, f"unknown kind; did you mean {near[0]}? Known kinds: {', '.join(kinds)}"
        )
    found: type = kinds[name]
    return found


def without_kind(metadata: Any, entry: object) -> object:
    """The plain data of one entry of a list field, without the key that names its class."""
    if not metadata["kinds"] or not isinstance(entry, dict):
        return entry
    return {key: value for key, value in entry.items() if key != "kind"}


def _unknown_key(key: str, known: list[str]) -> str:
    near = difflib.get_close_matches(key[:40], known, n=1)
    hint = f"did you mean {near[0]}? " if near else ""
    return f"unknown key; {hint}Known keys: {', '.join(known)}"
