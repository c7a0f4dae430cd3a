# SPDX-License-Identifier: GPL-3.0-or-later
"""The patches of an ocean as properties, which stay a sea while one number is dragged.

Where two bands meet, both ends are one number; and the first patch's size is the ocean's. Each is stored
twice, and a change of one updates the other.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import bpy
from bpy.props import FloatProperty, IntProperty, PointerProperty

from ..core import OceanParameters, ParameterError, Patch
from ..core.data.plain_data import to_plain
from ..core.sea.patch_plan import WISHES, Wish
from ..scene.settings import OceanObjectError
from ..scene.units import metres_per_unit, shortest_decimal
from . import mask_properties, parameter_properties, resizing
from .active_ocean import nearest
from .layer_properties import set_count
from .parameter_properties import changed

_OVERRIDE = {"override": {"LIBRARY_OVERRIDABLE"}}

#: a band that is dragged keeps at least this ratio of its ends
_NARROWEST = 1.01
_MEGABYTE = 10**6


def _quietly(
    change: Callable[[bpy.types.PropertyGroup, bpy.types.PropertyGroup], None],
) -> Callable[[bpy.types.PropertyGroup, bpy.types.Context], None]:
    """An update that changes what belongs to a property, and then shows the ocean once.

    change : of the group whose property was set, and the ocean's settings
    """

    def update(group: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
        settings = group.id_data.ocean_tweak
        if not settings.is_quiet:
            with settings.quiet():
                change(group, settings)
        changed(group, context)

    return update


def _join_shorter(patch: bpy.types.PropertyGroup, settings: bpy.types.PropertyGroup) -> None:
    """The next patch's waves begin where these end now."""
    following = _neighbour(patch, settings, 1)
    high = patch.longest_wavelength / _NARROWEST
    if following is None:
        patch.shortest_wavelength = min(patch.shortest_wavelength, high)
        return
    low = max(following.shortest_wavelength * _NARROWEST, _least(settings))
    patch.shortest_wavelength = _between(patch.shortest_wavelength, low, high)
    following.longest_wavelength = patch.shortest_wavelength


def _join_longer(patch: bpy.types.PropertyGroup, settings: bpy.types.PropertyGroup) -> None:
    """The waves of the patch before end where these begin now."""
    before = _neighbour(patch, settings, -1)
    low = max(patch.shortest_wavelength * _NARROWEST, _least(settings))
    if before is None:
        patch.longest_wavelength = max(patch.longest_wavelength, low)
        return
    high = before.longest_wavelength / _NARROWEST
    patch.longest_wavelength = _between(patch.longest_wavelength, low, high)
    before.shortest_wavelength = patch.longest_wavelength


def _give_to_ocean(patch: bpy.types.PropertyGroup, settings: bpy.types.PropertyGroup) -> None:
    if patch == settings.patches[0]:
        settings.domain_size = patch.domain_size


def _resize_first(patch: bpy.types.PropertyGroup, settings: bpy.types.PropertyGroup) -> None:
    _give_to_ocean(patch, settings)
    resizing.keep_middle(settings)


def _give_to_first(_group: bpy.types.PropertyGroup, settings: bpy.types.PropertyGroup) -> None:
    for patch in settings.patches[:1]:
        patch.domain_size = settings.domain_size
    resizing.keep_middle(settings)


def _neighbour(
    patch: bpy.types.PropertyGroup, settings: bpy.types.PropertyGroup, step: int
) -> bpy.types.PropertyGroup | None:
    place = list(settings.patches).index(patch) + step
    return settings.patches[place] if 0 <= place < len(settings.patches) else None


def _least(settings: bpy.types.PropertyGroup) -> float:
    """The shortest long end that a band may have, Blender units."""
    metres = metres_per_unit(bpy.context.scene)
    return float(Patch.__dataclass_fields__["longest_wavelength"].metadata["minimum"] / metres)


def _between(value: float, low: float, high: float) -> float:
    """The value, or the end that it has passed; between ends that have passed each other, their middle."""
    return min(max(value, low), high) if low <= high else math.sqrt(low * high)


#: what keeps the ocean's own size that of its first patch
OCEAN_UPDATES = {"domain_size": _quietly(_give_to_first)}


class OCEAN_PG_patch(bpy.types.PropertyGroup):
    """One of several patches: how large, how turned, and which wavelengths it holds."""

    __annotations__ = {
        **parameter_properties.annotations(
            Patch,
            changed,
            updates={
                "domain_size": _quietly(_resize_first),
                "shortest_wavelength": _quietly(_join_shorter),
                "longest_wavelength": _quietly(_join_longer),
            },
        ),
        "mask": PointerProperty(type=mask_properties.OCEAN_PG_mask, **_OVERRIDE),
    }


def _range(name: str) -> str:
    low, high, unit = WISHES[name]
    return f"({low:g} to {high:g} {unit})"


#: what patches are planned for; these change no sea by themselves
PLAN = {
    "plan_finest": FloatProperty(
        name="Finest Detail", default=0.1, min=0.0, soft_min=0.01, precision=3, step=1, unit="LENGTH",
        options=set(), **_OVERRIDE,
        description=f"Length of the shortest waves to plan for {_range('finest')}",
    ),
    "plan_area": FloatProperty(
        name="No Repeats In", default=1000.0, min=0.0, soft_min=10.0, precision=1, step=1000,
        unit="LENGTH", options=set(), **_OVERRIDE,
        description=f"Side of a square in which no repetition shows {_range('area')}",
    ),
    "plan_memory": IntProperty(
        name="Memory (MB)", default=2000, min=int(WISHES["memory"][0]) // _MEGABYTE,
        max=int(WISHES["memory"][1]) // _MEGABYTE, soft_min=100, soft_max=64_000, step=100,
        options=set(), **_OVERRIDE,
        description="Memory in megabytes for all patches together: with more, patches are larger and "
        "repeat less",
    ),
}  # fmt: skip


def wish_of(settings: bpy.types.PropertyGroup, scene: bpy.types.Scene) -> Wish:
    """What the ocean's patches are to be planned for. Raises ParameterError for what cannot be wished."""
    metres = metres_per_unit(scene)
    finest, area = (
        float(shortest_decimal(value) * metres) for value in (settings.plan_finest, settings.plan_area)
    )
    return Wish(finest, area, float(settings.plan_memory * _MEGABYTE))


def read(patches: bpy.types.bpy_prop_collection, metres: Fraction) -> list[dict[str, Any]]:
    """The patches as they stand in the parameters, not yet validated but for their masks.

    Raises ParameterError for a mask that cannot be used.
    """
    return [_read(index, patch, metres) for index, patch in enumerate(patches)]


def _read(index: int, patch: bpy.types.PropertyGroup, metres: Fraction) -> dict[str, Any]:
    try:
        mask = mask_properties.read(patch.mask, metres)
    except ParameterError as error:
        raise error.inside(f"patches.{index}") from None
    return {**parameter_properties.read(patch, Patch, metres), "mask": mask}


def check_count(settings: bpy.types.PropertyGroup, parameters: OceanParameters) -> None:
    """Raise OceanObjectError where a library override would have to take up or lose patches."""
    now, wanted = len(settings.patches), len(parameters.patches)
    if settings.id_data.override_library and now != wanted:
        raise OceanObjectError(
            f"A library override keeps its patches: it has {_counted(now)}, this sea has {_counted(wanted)}: "
            "make the ocean local first"
        )


def write(settings: bpy.types.PropertyGroup, parameters: OceanParameters, metres: Fraction) -> None:
    """Take over the parameters' patches, within `settings.quiet()`."""
    patches, images = settings.patches, settings.source_images()
    set_count(patches, len(parameters.patches))
    for group, patch in zip(patches, parameters.patches, strict=True):
        parameter_properties.write(group, Patch, to_plain(patch, brief=True), metres)
        mask_properties.write(group.mask, patch.mask, metres, images)
    for patch in patches[:1]:
        _give_to_ocean(patch, settings)
    settings.active_patch = nearest(settings.active_patch, patches)


def _counted(patches: int) -> str:
    return str(patches) if patches else "none"
