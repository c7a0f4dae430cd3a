# SPDX-License-Identifier: GPL-3.0-or-later
"""Validates settings of opened files, which Blender does not check against their ranges."""

from __future__ import annotations

import logging
import math
from collections.abc import Iterator

import bpy

from .settings import all_oceans, settings_of

_log = logging.getLogger(__name__)

#: JSON that is recomputed from the settings and from the bake when a file is opened
_DERIVED = ("statistics", "baked_sea", "bake_differs")


def mend_all() -> None:
    """Bring the settings of all oceans into what their properties allow; the console hears which."""
    for item in all_oceans():
        settings = settings_of(item)
        with settings.quiet():
            mended = list(mend(settings))
            for name in _DERIVED:
                settings.property_unset(name)
        if mended:
            _log.warning(
                "%s: invalid values in the file were replaced, numbers by the nearest and "
                "choices by the default: %s",
                item.name, ", ".join(mended),
            )  # fmt: skip


def mend(group: bpy.types.bpy_struct, path: str = "") -> Iterator[str]:
    """Bring a group's numbers and choices, and those of its groups, into their ranges; gives what was not."""
    for name, prop in group.bl_rna.properties.items():
        if name == "rna_type":
            continue
        if prop.type == "COLLECTION":
            for index, entry in enumerate(getattr(group, name)):
                yield from mend(entry, f"{path}{name}.{index}.")
        elif prop.type == "POINTER":
            if isinstance(getattr(group, name), bpy.types.PropertyGroup):
                yield from mend(getattr(group, name), f"{path}{name}.")
        elif group.is_property_set(name) and not _is_allowed(prop, getattr(group, name)):
            _mend(group, prop)
            yield f"{path}{name}"


def _is_allowed(prop: bpy.types.Property, value: object) -> bool:
    if prop.type == "ENUM" and not prop.is_enum_flag:
        return value in prop.enum_items
    if prop.type in ("INT", "FLOAT") and not prop.is_array:
        return prop.hard_min <= value <= prop.hard_max
    return True


def _mend(group: bpy.types.bpy_struct, prop: bpy.types.Property) -> None:
    value = getattr(group, prop.identifier)
    if prop.type == "ENUM" or not math.isfinite(value):
        group.property_unset(prop.identifier)
    else:
        setattr(group, prop.identifier, min(max(value, prop.hard_min), prop.hard_max))
