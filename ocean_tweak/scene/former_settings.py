# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings in files of versions in which they had other names: values, keys, drivers and overrides.

Blender keeps a value under the name of its property, and a curve by the path to it. After a property got
another name, the value waits under the old one while the property shows its default.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import bpy

from ..core.parameters.former_json import LAYER_NAMES, MASK_NAMES, SEA_NAMES
from ..core.waves.kinds import shown

_SETTINGS = "ocean_tweak"
_Names = Mapping[str, str]

#: of the groups in a layer: former names by today's
_GROUP_NAMES = {"image_waves": "picture"}


def _names_by_group() -> dict[str, _Names]:
    """Former names of properties by today's, of each group in a layer; of the layer itself under ""."""
    names = {kind.names.settings: dict(LAYER_NAMES.get(kind.kind, {})) for kind in shown()}
    # the image of such a layer is a datablock, whose property had its name before
    names["image_waves"].pop("image")
    return names


def _names_by_prefix() -> Iterator[tuple[str, _Names]]:
    """Former names by today's, and what stands before them in paths, as a regular expression."""
    layer = rf"{_SETTINGS}\.layers\[\d+\]\."
    yield rf"{_SETTINGS}\.", SEA_NAMES
    yield layer, _GROUP_NAMES
    for group, names in _names_by_group().items():
        yield layer + (rf"{group}\." if group else ""), names
    yield rf"{_SETTINGS}\.(?:layers|patches)\[\d+\]\.(?:\w+\.)?mask\.", MASK_NAMES


#: in the order in which they are applied: the names of groups before those of what is in them
_PATHS = [
    (re.compile(rf"^({prefix}){old}(?!\w)"), rf"\1{new}")
    for prefix, names in _names_by_prefix()
    for new, old in names.items()
]


def take_over() -> None:
    """Move what the file holds under former names to today's."""
    for item in bpy.data.objects:
        group = _stored(item)
        if group is not None:
            _take_over_values(group)
            _take_over_overrides(item)
    for curve in _curves():
        curve.data_path = modern_path(curve.data_path)
    for target in _driver_targets():
        target.data_path = modern_path(target.data_path)


def modern_path(path: str) -> str:
    """A path of RNA, with today's names where it leads to a setting of an ocean."""
    for pattern, modern in _PATHS:
        path = pattern.sub(modern, path)
    return path


def _stored(item: bpy.types.Object) -> Any:
    """What the file holds of an object's settings, by name; None without any."""
    if hasattr(item, "bl_system_properties_get"):  # from Blender 5.0 on
        held = item.bl_system_properties_get()
        return None if held is None else held.get(_SETTINGS)
    return item.get(_SETTINGS)


def _take_over_values(settings: Any) -> None:
    _rename(settings, SEA_NAMES)
    by_group = _names_by_group()
    for layer in settings.get("layers", ()):
        _rename(layer, _GROUP_NAMES)
        for name, names in by_group.items():
            group = layer if not name else layer.get(name)
            if group is not None:
                _rename(group, names)
                _rename_mask(group)
    for patch in settings.get("patches", ()):
        _rename_mask(patch)


def _rename_mask(group: Any) -> None:
    if "mask" in group:
        _rename(group["mask"], MASK_NAMES)


def _rename(group: Any, names: _Names) -> None:
    """Move values to today's names, the exact ones that stand in JSON too."""
    for new, old in names.items():
        if old in group and new not in group:
            group[new] = group[old]
            del group[old]
    text = group.get("exact")
    if isinstance(text, str) and any(f'"{old}"' in text for old in names.values()):
        group["exact"] = _renamed_text(text, {old: new for new, old in names.items()})


def _renamed_text(text: str, names: _Names) -> str:
    try:
        values = json.loads(text)
    except (ValueError, RecursionError):
        return text  # reported as damaged where it is read
    if not isinstance(values, dict):
        return text
    return json.dumps({names.get(key, key): value for key, value in values.items()})


def _take_over_overrides(item: bpy.types.Object) -> None:
    """Convert the paths of overridden properties."""
    override = item.override_library
    if override is None:
        return
    for known in list(override.properties):
        path = modern_path(known.rna_path)
        if path != known.rna_path:
            override.properties.add(path).operations.add("REPLACE")
            override.properties.remove(known)


def _curves() -> Iterator[bpy.types.FCurve]:
    """All keys of the file, and all drivers of objects."""
    for action in bpy.data.actions:
        for layer in action.layers:
            for strip in layer.strips:
                for bag in strip.channelbags:
                    yield from bag.fcurves
    for item in bpy.data.objects:
        if item.animation_data is not None:
            yield from item.animation_data.drivers


def _driver_targets() -> Iterator[bpy.types.DriverTarget]:
    """What drivers of whatever the file has read of oceans."""
    for owner in _with_drivers():
        for curve in owner.animation_data.drivers:
            for variable in curve.driver.variables:
                yield from (target for target in variable.targets if variable.type == "SINGLE_PROP")


def _with_drivers() -> Iterable[bpy.types.ID]:
    for collection in (getattr(bpy.data, name) for name in dir(bpy.data) if not name.startswith("_")):
        if isinstance(collection, bpy.types.bpy_prop_collection):
            for item in collection:
                if getattr(item, "animation_data", None) is not None:
                    yield item
                tree = getattr(item, "node_tree", None)
                if tree is not None and tree.animation_data is not None:
                    yield tree
