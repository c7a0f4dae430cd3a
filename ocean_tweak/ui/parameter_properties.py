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
from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from typing import Any

import bpy
import numpy as np

from ..core.data.errors import ParameterError
from ..core.data.plain_data import to_plain
from ..core.data.raster import Raster
from ..core.data.validation import Off, default_of
from ..scene import bake_versions, stored_paths
from ..scene.refinement import show
from ..scene.refresh import Wanted
from ..scene.settings import scene_of
from ..scene.units import metres_per_unit, shortest_decimal
from . import wording

_Field = dataclasses.Field[Any]
_Update = Callable[[Any, bpy.types.Context], None]

# Blender's unit of a core unit: such a property is in Blender units and grows with the scene's unit scale
_LENGTHS = {"m": "LENGTH", "m/s": "VELOCITY"}
# what belongs to the instrument and not to the scene stays in metres
_ABSOLUTE = {"wind_height"}
_SUBTYPES = {
    "rad": {"subtype": "ANGLE", "unit": "ROTATION", "soft_min": -math.pi, "soft_max": math.pi},
    "s": {"unit": "TIME_ABSOLUTE"},
}
_FLOAT32_MAX = 3e38
#: before the name of a field: of the switch that stands for its number that means none, and of what the field
#: was before it was switched off
SWITCH, _BEFORE = "use_", "before_"

#: hundredths that a number moves a pixel while it is dragged; Blender has no more than 100
_STEPS = {"m": 100, "m/s": 10}


def changed(group: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
    """Show the ocean whose settings hold this group."""
    item = group.id_data
    settings = item.ocean_tweak
    if settings.is_quiet or not settings.is_ocean:
        return
    bake_versions.settings_changed(item)
    if settings.preset:
        settings.preset = ""
    if item.users_scene:
        show(item, scene_of(item), Wanted.CHANGE)


def path_changed(name: str) -> Callable[[bpy.types.PropertyGroup, bpy.types.Context], None]:
    """What a changed path of this name does: it is kept relative to the file, where it can be.

    Whether the shown bake lies in the ocean's cache may be another matter then.
    """

    def update(group: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
        path = getattr(group, name)
        kept = stored_paths.relative(path)
        if kept != path:
            setattr(group, name, kept)  # which updates
        elif group.id_data.users_scene:
            show(group.id_data, scene_of(group.id_data), Wanted.BAKE)

    return update


def annotations(
    kind: type,
    update: _Update,
    without: tuple[str, ...] = (),
    updates: Mapping[str, _Update] | None = None,
) -> dict[str, Any]:
    """Blender properties for the plain fields of a parameter class, and the hidden `exact`.

    A field with a number that stands for none has a switch too; one that is shown in another unit has a
    property of that, which holds nothing itself. Keys, drivers and files know the field's own.

    without : fields that come from elsewhere
    updates : by field, where a change does more than `update`
    """
    own = updates or {}
    properties = {}
    for field in _plain_fields(kind, without):
        properties[field.name] = _property(field, own.get(field.name, update))
        if field.metadata.get("off"):
            meta = field.metadata
            is_whole, is_length = meta["kind"] is int, _is_length(field)
            properties |= switch_of(field.name, meta["description"], meta["off"], is_whole, is_length)
        if field.name in wording.SCALED:
            properties |= _scaled(field)
    return {
        **properties,
        "exact": bpy.props.StringProperty(options={"HIDDEN"}, override={"LIBRARY_OVERRIDABLE"}),
    }


def write(
    group: bpy.types.PropertyGroup,
    kind: type,
    data: dict[str, Any],
    metres: Fraction,
    without: tuple[str, ...] = (),
) -> None:
    """Set a group's properties from the plain data of a parameter class.

    data : as it stands in a JSON file; nested parameters in it have groups of their own
    metres : in a Blender unit
    """
    own = [field for field in dataclasses.fields(kind) if _is_text(field) and field.name not in without]
    # JSON leaves some fields out where they are the default
    data = {field.name: to_plain(default_of(field)) for field in own} | data
    group.exact = json.dumps({field.name: data[field.name] for field in own})
    for field in _plain_fields(kind, without):
        setattr(group, field.name, _to_blender(field, data[field.name], metres))


def read(
    group: bpy.types.PropertyGroup,
    kind: type,
    metres: Fraction,
    without: tuple[str, ...] = (),
    seen: Mapping[str, Any] | None = None,
) -> dict[str, Any]:
    """Values of a group by field name, in SI units and not yet validated.

    seen : what some properties should be, in Blender units

    Raises ParameterError where what the file stores beside the properties is damaged.
    """
    result = _exact_values(group)
    for field in _plain_fields(kind, without):
        value = (seen or {}).get(field.name, getattr(group, field.name))
        if field.metadata["kind"] is float:
            value = _exact_float(field, value, result.get(field.name), metres)
        result[field.name] = value
    return result


def _exact_values(group: bpy.types.PropertyGroup) -> dict[str, Any]:
    """What the properties cannot hold, by field name."""
    try:
        values = json.loads(group.exact) if group.exact else {}
    except (ValueError, RecursionError):
        values = None
    if not isinstance(values, dict):
        raise ParameterError(
            "exact", group.exact, "is damaged in this file: choose a preset or other parameters"
        )
    return values


def _is_text(field: _Field) -> bool:
    """Whether its value stands in JSON as it is; images are images instead, nested parameters groups."""
    return "nested" not in field.metadata and field.metadata.get("kind") is not Raster


def names_of(kind: type) -> list[str]:
    """The properties that a panel shows of a parameter class: not whether it is muted, and no identity."""
    return [field.name for field in _plain_fields(kind, ("muted", "id"))]


def _plain_fields(kind: type, without: tuple[str, ...]) -> Iterator[_Field]:
    for field in dataclasses.fields(kind):
        if field.metadata.get("kind") in _BUILDERS and field.name not in without:
            yield field


def _property(field: _Field, update: _Update) -> Any:
    common = {
        "name": wording.label(field.name, field.metadata.get("unit", "")),
        "default": default_of(field),
        "update": _limited(field, update) if _is_length(field) else update,
        "options": {"ANIMATABLE"} if field.metadata.get("changes") else set(),
        "override": {"LIBRARY_OVERRIDABLE"},
    }
    return _BUILDERS[field.metadata["kind"]](field, common)


def _float_property(field: _Field, common: dict[str, Any]) -> Any:
    meta = field.metadata
    low, high = meta["minimum"], meta["maximum"]
    soft_low, soft_high = meta["useful"]
    limits = {"min": low, "max": high, "soft_min": soft_low, "soft_max": soft_high}
    if _is_length(field):
        # the range is in metres and the property in Blender units: `_within` keeps to it
        least = 0.0 if low >= 0.0 else -_FLOAT32_MAX
        limits |= {"min": least, "max": _FLOAT32_MAX, "unit": _LENGTHS[meta["unit"]]}
    limits |= _SUBTYPES.get(meta["unit"], {})
    return bpy.props.FloatProperty(
        description=meta["description"] + wording.number_range(low, high, meta["unit"]),
        precision=3 if _is_length(field) or 0.0 < default_of(field) < 0.1 else 2,
        step=_STEPS.get(meta["unit"], 3),
        **limits,
        **common,
    )


def _int_property(field: _Field, common: dict[str, Any]) -> Any:
    meta = field.metadata
    return bpy.props.IntProperty(
        description=meta["description"] + wording.number_range(meta["minimum"], meta["maximum"], ""),
        min=meta["minimum"], max=meta["maximum"], **common,
    )  # fmt: skip


def _enum_property(field: _Field, common: dict[str, Any]) -> Any:
    description = field.metadata["description"]
    texts = wording.CHOICES.get(field.name, {})
    items = [
        (choice, *texts.get(choice, (wording.label(choice), description)))
        for choice in field.metadata["choices"]
    ]
    return bpy.props.EnumProperty(items=items, description=description, **common)


def _bool_property(field: _Field, common: dict[str, Any]) -> Any:
    return bpy.props.BoolProperty(description=field.metadata["description"], **common)


_BUILDERS: dict[type, Callable[[_Field, dict[str, Any]], Any]] = {
    float: _float_property,
    int: _int_property,
    str: _enum_property,
    bool: _bool_property,
}


def switch_of(
    name: str, description: str, off: Off, is_whole: bool = True, is_length: bool = False
) -> dict[str, Any]:
    """A switch that sets a property to the number that stands for none and back, and what it goes back to.

    is_whole, is_length : of the property's numbers
    """
    before = f"{_BEFORE}{name}"

    def in_blender(group: Any, value: float) -> float:
        if is_whole:
            return int(value)
        return float(value / float(metres_per_unit(scene_of(group.id_data)))) if is_length else value

    def is_on(group: Any) -> bool:
        return not math.isclose(getattr(group, name), in_blender(group, off.value), rel_tol=1e-5)

    def switch(group: Any, on: bool) -> None:
        if on == is_on(group):
            return
        if not on:
            setattr(group, before, getattr(group, name))
            setattr(group, name, in_blender(group, off.value))
        else:
            known = getattr(group, before) if group.is_property_set(before) else None
            setattr(group, name, in_blender(group, off.first) if known is None else known)

    kept = bpy.props.IntProperty if is_whole else bpy.props.FloatProperty
    return {
        f"{SWITCH}{name}": bpy.props.BoolProperty(
            name=wording.label(name), get=is_on, set=switch, options=set(), override={"LIBRARY_OVERRIDABLE"},
            description=f"{description}. Off: {off.means}",
        ),
        before: kept(options={"HIDDEN"}, override={"LIBRARY_OVERRIDABLE"}),
    }  # fmt: skip


def _scaled(field: _Field) -> dict[str, Any]:
    """A property in which a field is shown in a unit that Blender does not have."""
    shown, meta = wording.SCALED[field.name], field.metadata

    def get(group: Any) -> float:
        metres = metres_per_unit(scene_of(group.id_data))
        return getattr(group, field.name) * float(_unit(field, metres)) / shown.factor

    def set_scaled(group: Any, value: float) -> None:
        # what a library override tells twice stays exact
        if np.float32(value) != np.float32(get(group)):
            metres = metres_per_unit(scene_of(group.id_data))
            setattr(group, field.name, value * shown.factor / float(_unit(field, metres)))

    return {
        shown.name: bpy.props.FloatProperty(
            name=shown.label, min=meta["minimum"] / shown.factor, max=meta["maximum"] / shown.factor,
            soft_min=shown.useful[0], soft_max=shown.useful[1], precision=1, step=100,
            get=get, set=set_scaled,
            options=set(), override={"LIBRARY_OVERRIDABLE"}, description=meta["description"],
        )
    }  # fmt: skip


def _is_length(field: _Field) -> bool:
    return field.metadata.get("unit") in _LENGTHS and field.name not in _ABSOLUTE


def unit_of(kind: type, name: str, metres: Fraction) -> float:
    """How many core units one of the property's units is; 1 where the parameter class has no such field."""
    fields = {field.name: field for field in dataclasses.fields(kind)}
    return float(_unit(fields[name], metres)) if name in fields else 1.0


def _unit(field: _Field, metres: Fraction) -> Fraction:
    return metres if _is_length(field) else Fraction(1)


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
    return _within(field, float(shortest_decimal(value) * _unit(field, metres)))


def _within(field: _Field, value: float) -> float:
    """A length in metres, or the end of its range that it has passed, as Blender has it with other numbers.

    A curve between two keys passes it easily.
    """
    if not _is_length(field):
        return value
    return min(max(value, field.metadata["minimum"]), field.metadata["maximum"])


def beyond(group: Any, kind: type, metres: Fraction) -> Iterator[tuple[str, float]]:
    """Names of a group's lengths that a curve took beyond their range, and what they count as in metres."""
    for field in _plain_fields(kind, ()):
        if _is_length(field) and math.isfinite(value := getattr(group, field.name)):
            length = float(shortest_decimal(value) * metres)
            if not math.isclose(length, _within(field, length), rel_tol=1e-6):
                yield field.name, _within(field, length)


def _limited(field: _Field, update: _Update) -> _Update:
    """An update before which a length that was set beyond its range becomes the range's end."""

    def limited(group: Any, context: bpy.types.Context) -> None:
        if not group.id_data.ocean_tweak.is_quiet:
            value, metres = getattr(group, field.name), metres_per_unit(scene_of(group.id_data))
            if math.isfinite(value):  # else the core names it
                end = _to_blender(field, _within(field, float(shortest_decimal(value) * metres)), metres)
                if np.float32(end) != np.float32(value):
                    setattr(group, field.name, end)  # which updates
                    return
        update(group, context)

    return limited
