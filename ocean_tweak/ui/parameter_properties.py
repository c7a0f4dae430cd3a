# SPDX-License-Identifier: GPL-3.0-or-later
"""Core parameters as Blender properties: made from the fields' metadata, read back without loss.

Blender keeps a property as float32, and a length in Blender units. So a group also keeps the exact values it
was last given (`exact`, JSON): a field counts as changed by the user only where its float32 differs from
them. Fields that have no property here live in `exact` alone.
"""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

import bpy
import numpy as np

from ..scene.units import shortest_decimal

_Field = dataclasses.Field[Any]

# Blender's unit of a core unit. All of these grow with the scene's unit scale, angles do not
_LENGTHS = {"m": "LENGTH", "m/s": "VELOCITY", "m/s²": "ACCELERATION"}
_SUBTYPES = {"rad": {"subtype": "ANGLE", "unit": "ROTATION", "soft_min": -math.pi, "soft_max": math.pi}}
_FLOAT32_MAX = 3e38
_ACRONYMS = {"TMA", "JONSWAP"}

#: what sliders offer, where the allowed range is much wider than the useful one
_SOFT_RANGES = {"swell": (0.0, 1.0), "choppiness": (0.0, 1.5), "gain": (0.0, 2.0), "wind_speed": (0.5, 50.0)}


def annotations(
    kind: type, update: Callable[[Any, bpy.types.Context], None], without: tuple[str, ...] = ()
) -> dict[str, Any]:
    """Blender properties for the plain fields of a parameter class, and the hidden `exact`.

    without : fields that come from elsewhere
    """
    properties = {field.name: _property(field, update) for field in _plain_fields(kind, without)}
    return {**properties, "exact": bpy.props.StringProperty(options={"HIDDEN"})}


def write(
    group: bpy.types.PropertyGroup, values: object, metres: Fraction, without: tuple[str, ...] = ()
) -> None:
    """Set a group's properties from a parameter object.

    metres : in a Blender unit
    """
    exact = {}
    for field in dataclasses.fields(values):  # type: ignore[arg-type]
        value = getattr(values, field.name)
        if not dataclasses.is_dataclass(value) and not isinstance(value, tuple) and field.name not in without:
            exact[field.name] = value
    group.exact = json.dumps(exact)
    for field in _plain_fields(type(values), without):
        setattr(group, field.name, _to_blender(field, exact[field.name], metres))


def read(
    group: bpy.types.PropertyGroup, kind: type, metres: Fraction, without: tuple[str, ...] = ()
) -> dict[str, Any]:
    """Values of a group by field name, in SI units and not yet validated."""
    result: dict[str, Any] = json.loads(group.exact) if group.exact else {}
    for field in _plain_fields(kind, without):
        value = getattr(group, field.name)
        exact = result.get(field.name)
        if field.metadata["kind"] is float:
            value = _exact_float(field, value, exact, metres)
        result[field.name] = value
    return result


def _plain_fields(kind: type, without: tuple[str, ...]) -> Iterator[_Field]:
    for field in dataclasses.fields(kind):
        # a field that may be None has no number or choice to show
        shown = field.metadata.get("kind") in _BUILDERS and field.default is not None
        if shown and field.name not in without:
            yield field


def _property(field: _Field, update: Callable[[Any, bpy.types.Context], None]) -> Any:
    common = {
        "name": field.name.replace("_", " ").title(),
        "default": field.default,
        "update": update,
        "options": set(),  # not animatable: the initial state is made anew when it changes
        "override": {"LIBRARY_OVERRIDABLE"},
    }
    return _BUILDERS[field.metadata["kind"]](field, common)


def _float_property(field: _Field, common: dict[str, Any]) -> Any:
    meta = field.metadata
    low, high = meta["minimum"], meta["maximum"]
    soft_low, soft_high = _SOFT_RANGES.get(field.name, (low, high))
    limits = {"min": low, "max": high, "soft_min": soft_low, "soft_max": soft_high}
    if meta["unit"] in _LENGTHS:
        # the range is in metres and the property in Blender units: the core says what is out of range
        limits |= {"min": 0.0, "max": _FLOAT32_MAX, "unit": _LENGTHS[meta["unit"]]}
    limits |= _SUBTYPES.get(meta["unit"], {})
    return bpy.props.FloatProperty(
        description=f"{meta['description']} ({low:g} to {high:g} {meta['unit']})".replace(" )", ")"),
        precision=3 if meta["unit"] in _LENGTHS or high > 10.0 else 2,
        **limits,
        **common,
    )


def _int_property(field: _Field, common: dict[str, Any]) -> Any:
    meta = field.metadata
    return bpy.props.IntProperty(
        description=f"{meta['description']} ({meta['minimum']} to {meta['maximum']})",
        min=meta["minimum"], max=meta["maximum"], **common,
    )  # fmt: skip


def _enum_property(field: _Field, common: dict[str, Any]) -> Any:
    description = field.metadata["description"]
    items = [(choice, _label(choice), description) for choice in field.metadata["choices"]]
    return bpy.props.EnumProperty(items=items, description=description, **common)


def _bool_property(field: _Field, common: dict[str, Any]) -> Any:
    return bpy.props.BoolProperty(description=field.metadata["description"], **common)


_BUILDERS: dict[type, Callable[[_Field, dict[str, Any]], Any]] = {
    float: _float_property,
    int: _int_property,
    str: _enum_property,
    bool: _bool_property,
}


def _label(choice: str) -> str:
    return choice if choice in _ACRONYMS else choice.replace("_", " ").title()


def _unit(field: _Field, metres: Fraction) -> Fraction:
    return metres if field.metadata.get("unit") in _LENGTHS else Fraction(1)


def _to_blender(field: _Field, value: Any, metres: Fraction) -> Any:
    if field.metadata["kind"] is not float:
        return value
    return float(Fraction(value) / _unit(field, metres))


def _exact_float(field: _Field, value: float, exact: object, metres: Fraction) -> float:
    """What a float32 in Blender stands for: the exact value it was given, or the shortest decimal."""
    if isinstance(exact, (int, float)) and np.float32(_to_blender(field, exact, metres)) == np.float32(value):
        return exact
    if not math.isfinite(value):
        return value  # the core names it
    return float(shortest_decimal(value) * _unit(field, metres))
