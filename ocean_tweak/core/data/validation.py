# SPDX-License-Identifier: GPL-3.0-or-later
"""Dataclass fields with a unit, a range and a description, validated on construction."""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Sequence
from fractions import Fraction
from numbers import Real
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import ParameterError
from .raster import Raster, with_holes


class _Open:
    def __repr__(self) -> str:
        return "OPEN"


#: largest of Blender's whole numbers
LARGEST_INTEGER = 2**31 - 1

#: placeholder for a field that was not given, until its value can be derived from other fields
OPEN: Any = _Open()


class Off(NamedTuple):
    """A field value that means "off": files store this number, and the panel shows a switch instead.

    value : that number
    first : the field's value when it is first switched on
    means : what the number does, as in "0 keeps all short waves"
    """

    value: float
    first: float
    means: str


def number(
    default: float,
    minimum: float,
    maximum: float,
    unit: str,
    description: str,
    why: str = "",
    *,
    useful: tuple[float, float] | None = None,
    changes: bool = False,
    may_be_told: bool = False,
    off: Off | None = None,
    left_out: bool = False,
) -> Any:
    """A real-valued dataclass field with range, unit, description and the reason for the range.

    useful : the slider's soft range, where the full range is much wider
    changes : whether it can be animated; all other fields determine which waves exist and how fast they
        travel
    may_be_told : whether its default may depend on other fields, see `default_of`
    off : a value that means "off"
    left_out : omit the key from JSON while the value is the default
    """
    return dataclasses.field(
        default=OPEN if may_be_told else default,
        metadata={
            "kind": float, "minimum": minimum, "maximum": maximum, "useful": useful or (minimum, maximum),
            "unit": unit, "description": description, "why": why, "changes": changes,
            "default": default, "left_out": left_out, "off": off,
        },
    )  # fmt: skip


def angle(description: str, *, changes: bool = False, left_out: bool = False) -> Any:
    """A dataclass field that holds an angle in rad, which may be any number of turns."""
    why = "any number of turns, to the precision of a float"
    return number(0.0, -1e6, 1e6, "rad", description, why, changes=changes, left_out=left_out)


def place(default: float, description: str) -> Any:
    """A dataclass field that holds a coordinate in m."""
    return number(default, -1e6, 1e6, "m", description, "far beyond any patch")


def moment(default: float, description: str) -> Any:
    """A dataclass field that holds an ocean time in s."""
    return number(default, -1e6, 1e6, "s", description, "more than a week either way")


def changing_fields(kind: type) -> tuple[str, ...]:
    """The fields of a parameter class that can be animated."""
    return tuple(field.name for field in dataclasses.fields(kind) if field.metadata.get("changes"))


def integer(
    default: int,
    minimum: int,
    maximum: int,
    description: str,
    why: str = "",
    *,
    even_from: int = 0,
    left_out: bool = False,
    may_be_told: bool = False,
    off: Off | None = None,
) -> Any:
    """A whole-number dataclass field with its range.

    even_from : if given, only even numbers from this on, and 0 where the range has it
    left_out : where it is 0, JSON has no such key
    may_be_told, off : as of a `number`
    """
    return dataclasses.field(
        default=OPEN if may_be_told else default,
        metadata={
            "kind": int, "minimum": minimum, "maximum": maximum,
            "unit": "", "description": description, "why": why, "left_out": left_out,
            "default": default, "off": off, "even_from": even_from,
        },
    )  # fmt: skip


def default_of(field: dataclasses.Field[Any]) -> Any:
    """The default of a field that is neither given nor derived from other fields."""
    return field.metadata["default"] if field.default is OPEN else field.default


def choice(default: str, choices: tuple[str, ...], description: str, left_out: bool = False) -> Any:
    """A dataclass field restricted to the given names.

    left_out : where it is the default, JSON has no such key
    """
    metadata = {"kind": str, "choices": choices, "description": description, "left_out": left_out}
    return dataclasses.field(default=default, metadata=metadata)


def switch(default: bool, description: str) -> Any:
    """A dataclass field that is on or off."""
    return dataclasses.field(default=default, metadata={"kind": bool, "description": description})


def raster(description: str, channels: int, optional: bool = True, left_out: bool = False) -> Any:
    """A dataclass field that holds an image or a vector grid with this many channels.

    left_out : where there is none, JSON has no such key
    """
    metadata = {
        "kind": Raster, "channels": channels, "optional": optional, "description": description,
        "left_out": left_out,
    }  # fmt: skip
    return dataclasses.field(default=None, metadata=metadata)


def rational(
    default: Fraction | None,
    minimum: float,
    maximum: float,
    unit: str,
    description: str,
    why: str = "",
    optional: bool = False,
    left_out: bool = False,
) -> Any:
    """A dataclass field stored as an exact fraction; may be None if optional.

    left_out : where it is the default, JSON has no such key
    """
    return dataclasses.field(
        default=default,
        metadata={
            "kind": Fraction, "minimum": minimum, "maximum": maximum,
            "unit": unit, "description": description, "why": why, "optional": optional,
            "left_out": left_out,
        },
    )  # fmt: skip


def _range_text(minimum: float, maximum: float, unit: str) -> str:
    span = f"from {minimum:g} to {maximum:g}" if math.isfinite(maximum) else "of any size"
    return f"{span} {unit}".rstrip()


def check_range(name: str, value: object, minimum: float, maximum: float, unit: str) -> None:
    """Raise ParameterError for an argument that is not a number within a range."""
    if isinstance(value, bool) or not isinstance(value, Real) or not minimum <= float(value) <= maximum:
        is_open = maximum == math.inf
        span = f"of {minimum:g} {unit} or more" if is_open else _range_text(minimum, maximum, unit)
        raise ParameterError(name, value, f"must be a number {span}")


def real_array(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """An argument as float64. Raises ParameterError, naming it, for what is no array of numbers."""
    try:
        if np.iscomplexobj(values):
            raise TypeError
        return np.asarray(with_holes(values), np.float64)
    except (TypeError, ValueError):
        reason = "must hold real numbers, as many in each row"
        raise ParameterError(name, type(values).__name__, reason) from None


def _checked_number(name: str, value: object, meta: Any) -> float:
    allowed = _range_text(meta["minimum"], meta["maximum"], meta["unit"])
    if isinstance(value, bool) or not hasattr(value, "__float__"):
        raise ParameterError(name, value, f"must be a number {allowed}")
    try:
        result = float(value)
    except OverflowError:
        result = math.inf
    if not math.isfinite(result):
        raise ParameterError(name, value, f"must be a finite number {allowed}")
    if not meta["minimum"] <= result <= meta["maximum"]:
        raise ParameterError(name, value, f"must be {allowed}")
    return result + 0.0  # -0.0 and 0.0 are the same sea and must hash alike in JSON


def _checked_integer(name: str, value: object, meta: Any) -> int:
    allowed = _range_text(meta["minimum"], meta["maximum"], meta["unit"])
    whole = hasattr(value, "__index__") or (isinstance(value, float) and value.is_integer())
    if isinstance(value, bool) or not whole:
        raise ParameterError(name, value, f"must be a whole number {allowed}")
    result = int(value)  # type: ignore[call-overload]
    if not meta["minimum"] <= result <= meta["maximum"]:
        raise ParameterError(name, value, f"must be {allowed}")
    least = meta["even_from"]
    if least and (result % 2 or 0 < result < least):
        none = "" if meta["minimum"] else "0 or "
        raise ParameterError(name, value, f"must be {none}an even number from {least} to {meta['maximum']}")
    return int(result)


#: no more digits than an allowed fraction has: 1e999999999 would be expanded in full
_FRACTION = re.compile(r"[+-]?[0-9.]{1,40}(e[+-]?[0-9]{1,3}|/[0-9]{1,40})?", re.IGNORECASE)


def _checked_fraction(name: str, value: object, meta: Any) -> Fraction:
    span = _range_text(meta["minimum"], meta["maximum"], meta["unit"])
    allowed = f'must be {span}, also as a fraction: "24000/1001"'
    try:
        if isinstance(value, bool) or not isinstance(value, (int, float, str, Fraction)):
            raise TypeError
        text = str(value).strip()
        if not _FRACTION.fullmatch(text):
            raise ValueError
        result = Fraction(text)  # take 23.976 as the decimal number, not as the nearest binary float
    except (TypeError, ValueError, ZeroDivisionError):
        raise ParameterError(name, value, allowed) from None
    low, high = (Fraction(str(meta[end])) for end in ("minimum", "maximum"))
    if not low <= result <= high or result.denominator > 10**9:
        raise ParameterError(name, value, allowed)
    return result


def _checked(field: dataclasses.Field[Any], value: object) -> object:
    meta = field.metadata
    kind = meta.get("kind")
    if (value is None and meta.get("optional")) or (value is OPEN and field.default is OPEN):
        return value
    if "nested" in meta:
        return _checked_nested(field, value)
    if kind is Fraction:
        return _checked_fraction(field.name, value, meta)
    if kind is float:
        return _checked_number(field.name, value, meta)
    if kind is int:
        return _checked_integer(field.name, value, meta)
    if kind is str and value not in meta["choices"]:
        raise ParameterError(field.name, value, "must be one of " + ", ".join(meta["choices"]))
    if kind is Raster:
        return _checked_raster(field.name, value, meta)
    if kind is bool and not isinstance(value, bool):
        raise ParameterError(field.name, value, "must be true or false")
    return value


def _checked_raster(name: str, value: object, meta: Any) -> Raster:
    if not isinstance(value, Raster):
        raise ParameterError(name, value, "must be a Raster")
    if value.shape[2] != meta["channels"]:
        what = f"{name} ({value.name})" if value.name else name
        raise ParameterError(what, f"{value.shape[2]} channels", f"must have {meta['channels']}")
    return value


def nested(
    kind: type,
    many: bool = False,
    empty: bool = False,
    most: int = 64,
    optional: bool = False,
    kinds: Sequence[type] = (),
    compared: bool = True,
) -> Any:
    """A dataclass field that holds another dataclass, by default a default instance, or a tuple of them.

    empty : the tuple may be empty, and is by default
    most : maximum number of entries of each kind
    optional : may be None, which is the default
    kinds : classes that entries may have, identified in JSON by their `kind`. It may be omitted for the first
        class, of which at least one entry is required and is there by default
    compared : whether it takes part in comparisons
    """
    one = kinds[0] if kinds else kind
    default: object = None if optional else one() if not many else () if empty else (one(),)
    return dataclasses.field(
        default=default,
        compare=compared,
        metadata={
            "nested": kind, "many": many, "empty": empty, "most": most,
            "optional": optional, "left_out": empty or optional, "kinds": kinds,
        },
    )  # fmt: skip


def _checked_nested(field: dataclasses.Field[Any], value: object) -> object:
    kind = field.metadata["nested"]
    if not field.metadata["many"]:
        if not isinstance(value, kind):
            raise ParameterError(field.name, value, f"must be a {kind.__name__}")
        return value
    known = tuple(field.metadata["kinds"]) or (kind,)
    if not isinstance(value, (tuple, list)) or not all(isinstance(v, known) for v in value):
        names = ", ".join(each.__name__ for each in known)
        raise ParameterError(field.name, value, f"must be a sequence of {names}")
    check_count(field.name, value, field.metadata)
    return tuple(value)


def check_count(name: str, entries: Sequence[object], meta: Any) -> None:
    """Raise ParameterError if a list field has too many entries; checked before they are created.

    entries : instances, or their plain data
    """
    if not meta.get("many"):
        return
    fewest, most = 0 if meta["empty"] else 1, meta["most"]
    names = [kind.kind for kind in meta["kinds"]]
    found = [kind_of(entry, names[0]) if names else "" for entry in entries]
    for kind in names or [""]:
        count = found.count(kind)
        if not fewest <= count <= most:
            what = f"{count} entries" if count == len(entries) else f"{count} entries of kind {kind}"
            raise ParameterError(name, what, f"must have from {fewest} to {most} entries")
        fewest = 0  # of the other kinds


def kind_of(entry: object, usual: str) -> object:
    """The kind of an entry (an instance or plain data); the usual kind if it does not name one."""
    return entry.get("kind", usual) if isinstance(entry, dict) else getattr(entry, "kind", usual)


class Validated:
    """Base class that checks each field against its metadata on construction."""

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):  # type: ignore[arg-type]
            object.__setattr__(self, field.name, _checked(field, getattr(self, field.name)))
