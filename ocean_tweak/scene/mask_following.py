# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes masks follow their objects.

After manual changes: at once if the object is moved or edited, and a moment after each stroke of painted
weights. These are only read in a window, and by a timer, as reading needs the evaluated mesh.

For animation by keys, drivers, constraints or parents: a driver of the ocean's settings then depends on the
object, so that Blender evaluates it before the ocean, even if it is hidden, and the ocean counts as animated.
"""

from __future__ import annotations

from collections.abc import Iterator, Set

import bpy

from ..core import ParameterError
from . import floating
from .refinement import has_window
from .refresh import tell
from .settings import OceanObjectError, OceanSettings, oceans_in, settings_of, shown_oceans

Objects = Set[bpy.types.Object]

# s without a stroke after which weights are read
_PAUSE = 0.3
# what is driven, by nothing but the need of objects
_MOTION = "ocean_tweak.mask_motion"


def follow(scene: bpy.types.Scene, moved: Objects, edited: Objects) -> None:
    """Let masks of a scene's oceans follow what was moved, edited or painted: these or the masks' objects."""
    for item in oceans_in(scene) if moved or edited else ():
        settings = settings_of(item)
        objects = settings.mask_objects()
        if item.library is None and objects and (item in moved or objects & (moved | edited)):
            settings.place_masks()
        painted = settings.painted_meshes()
        if painted and (item in moved or any(is_painted(mesh, moved, edited) for mesh in painted)):
            read_soon()


def bind(scene: bpy.types.Scene) -> None:
    """Let a scene's oceans need the objects of their masks that move by themselves, and no others."""
    for item in oceans_in(scene):
        if item.library is None and item.override_library is None:
            _bind(item, moving_objects(item))


def is_bound(item: bpy.types.Object) -> bool:
    """Whether an ocean needs objects of its masks."""
    return _driver_of(item) is not None


def moving_objects(item: bpy.types.Object) -> list[bpy.types.Object]:
    """The objects of an ocean's masks that move by themselves over it; none that floats, which is refused."""
    found = settings_of(item).mask_objects()
    moving = found if _moves(item) else {each for each in found if _moves(each)}
    return sorted((each for each in moving if not floating.floats(each)), key=lambda each: each.name_full)


def take_over(item: bpy.types.Object, shown: OceanSettings, depsgraph: bpy.types.Depsgraph | None) -> None:
    """Keep where an evaluation has the objects of masks, as Blender keeps animated values: in the viewport
    alone.

    shown : the ocean's settings in that evaluation
    """
    if depsgraph is not None and depsgraph.mode == "VIEWPORT" and is_bound(item):
        settings = settings_of(item)
        with settings.quiet():
            settings.take_mask_places(shown)


def _moves(item: bpy.types.Object) -> bool:
    """Whether an object may be elsewhere at another frame."""
    return any(
        each.constraints or each.rigid_body is not None or _is_keyed(each) or each.parent_type != "OBJECT"
        for each in _with_ancestors(item)
    )


def _with_ancestors(item: bpy.types.Object | None) -> Iterator[bpy.types.Object]:
    while item is not None:
        yield item
        item = item.parent


def _is_keyed(item: bpy.types.Object) -> bool:
    data = item.animation_data
    return data is not None and bool(data.action or data.nla_tracks or _drives_more(data.drivers))


def _drives_more(drivers: bpy.types.bpy_prop_collection) -> bool:
    return any(not curve.data_path.startswith("ocean_tweak.") for curve in drivers)


def _driver_of(item: bpy.types.Object) -> bpy.types.FCurve | None:
    return None if item.animation_data is None else item.animation_data.drivers.find(_MOTION)


def _bind(item: bpy.types.Object, objects: list[bpy.types.Object]) -> None:
    curve = _driver_of(item)
    known = [] if curve is None else [each.targets[0].id for each in curve.driver.variables]
    if known == objects:
        return
    if curve is not None:
        item.driver_remove(_MOTION)
    if objects:
        driver = item.driver_add(_MOTION).driver
        driver.type = "SUM"  # of no Python, which may be forbidden
        for each in objects:
            variable = driver.variables.new()
            variable.type = "TRANSFORMS"
            variable.targets[0].id = each


def is_painted(mesh: bpy.types.Object, moved: Objects, edited: Objects) -> bool:
    """Whether a mesh's weights may lie otherwise on the water now.

    One that changes by itself does not count: it may read the sea.
    """
    return mesh in moved or (mesh in edited and mesh.mode == "WEIGHT_PAINT")


def read_soon() -> None:
    """Read all weights of masks once nothing has been painted for a moment."""
    forget_all()
    if has_window():
        bpy.app.timers.register(read, first_interval=_PAUSE)


def forget_all() -> None:
    """Read nothing: another file is opened, or the extension is disabled."""
    if bpy.app.timers.is_registered(read):
        bpy.app.timers.unregister(read)


def read() -> float | None:
    """The timer: read the weights of all masks that have read them before. The same ones change nothing."""
    if bpy.app.is_job_running("RENDER"):
        return _PAUSE
    for item, scene in shown_oceans().items():
        settings = settings_of(item)
        if item.library is None and settings.painted_meshes():
            try:
                settings.read_masks(scene)
            except (OceanObjectError, ParameterError) as error:
                tell(item, error)
    return None
