# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds objects that will not move in a Blender without the extension, before a farm does.

This examines all objects of the file, and is therefore done on events instead of whenever a panel is drawn.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import bpy

from ..nodes.modifier_inputs import reads
from . import coast_surface, float_carrier, float_current, patch_objects, spray
from .baked_spray import left_out
from .cache_place import shown_bake
from .plan import camera_surface_of
from .settings import all_oceans, is_ocean, oceans_in, settings_of, shown_oceans, was_ocean


class Need(NamedTuple):
    """An object that only the extension moves.

    name : of the object
    """

    name: str
    reason: str
    remedy: str

    @property
    def text(self) -> str:
        """As one line of text."""
        return f"{self.name} {self.reason}: {self.remedy}"


class Neighbours(NamedTuple):
    """Objects related to an ocean.

    needs : objects that do not move without the extension
    has_surface : whether a surface around the camera shows it
    has_bake : whether it reads a bake of ours, which lies on disk
    """

    needs: tuple[Need, ...] = ()
    has_surface: bool = False
    has_bake: bool = False


#: an object's name, and the path of its library
_Key = tuple[str, str | None]


@dataclass
class _Seen:
    """The result of the last search.

    of : the neighbours of each ocean, by session uid
    scenes : names of the oceans of each scene, each with the file that it is linked from, by session uid
    readers : session uids of the objects whose modifiers read oceans
    objects : number of objects in the file
    """

    of: dict[int, Neighbours] = field(default_factory=dict)
    scenes: dict[int, tuple[_Key, ...]] = field(default_factory=dict)
    readers: set[int] = field(default_factory=set)
    objects: int = 0


_seen = _Seen()


def neighbours_of(ocean: bpy.types.Object) -> Neighbours:
    """The neighbours of an ocean from the last search, which is repeated if objects were added or removed."""
    return _found().of.get(ocean.session_uid, Neighbours())


def has_ocean(scene: bpy.types.Scene) -> bool:
    """Whether a scene has an ocean; as `neighbours_of`."""
    return scene.session_uid in _found().scenes


def known_oceans(scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """The oceans of a scene by name; as `neighbours_of`."""
    found = [bpy.data.objects.get(key) for key in _found().scenes.get(scene.session_uid, ())]
    if not all(map(is_ocean, found)):  # one was renamed
        look()
        found = [bpy.data.objects.get(key) for key in _seen.scenes.get(scene.session_uid, ())]
    return [item for item in found if is_ocean(item)]


def _found() -> _Seen:
    if len(bpy.data.objects) != _seen.objects:
        look()
    return _seen


def look_at(ocean: bpy.types.Object) -> None:
    """Search the neighbours of an ocean."""
    has_surface = camera_surface_of(ocean) is not None
    for scene in ocean.users_scene:
        keys = _seen.scenes.get(scene.session_uid, ())
        _seen.scenes[scene.session_uid] = tuple(sorted({*keys, _key(ocean)}, key=_by_name))
    has_bake = settings_of(ocean).source == "SEQUENCE" and shown_bake(ocean) is not None
    _seen.of[ocean.session_uid] = Neighbours(needs_of(ocean), has_surface, has_bake)


def look() -> None:
    """Search the neighbours of all oceans of the file."""
    oceans = list(all_oceans())
    _seen.of.clear()
    _seen.objects = len(bpy.data.objects)
    _seen.readers = {item.session_uid for item in bpy.data.objects if reads(item, oceans)}
    keys = {scene: tuple(sorted(map(_key, oceans_in(scene)), key=_by_name)) for scene in bpy.data.scenes}
    _seen.scenes = {scene.session_uid: found for scene, found in keys.items() if found}
    for ocean in oceans:
        look_at(ocean)


def _key(ocean: bpy.types.Object) -> _Key:
    return ocean.name, None if ocean.library is None else ocean.library.filepath


def _by_name(key: _Key) -> tuple[str, str]:
    return key[0], key[1] or ""


def is_outdated(updates: Iterable[bpy.types.DepsgraphUpdate]) -> bool:
    """Whether objects were added or removed, or one that reads an ocean, or may do so now, has changed.

    Where no ocean is known, nothing is: one that comes is looked at when something asks for it.
    """
    return bool(_seen.of) and (len(bpy.data.objects) != _seen.objects or any(map(_concerns, updates)))


def sharp_under_blur(ocean: bpy.types.Object, scene: bpy.types.Scene) -> str:
    """Warning for a bake that motion blur leaves sharp, as it has no velocity; "" for others."""
    settings = settings_of(ocean)
    has_velocity = any(maps.vel is not None for maps in (settings.sequence_maps, settings.early_maps))
    if settings.source != "SEQUENCE" or not scene.render.use_motion_blur or has_velocity:
        return ""
    if patch_objects.shot_maps(ocean):  # points, which have it, show the sea
        return ""
    return (
        "Motion blur is on, but the bake has no velocity, so its water stays sharp. Bake it with Velocity on"
    )


def forget_all() -> None:
    """Another file is opened, or the extension is disabled."""
    _seen.of.clear()
    _seen.scenes.clear()
    _seen.readers.clear()
    _seen.objects = 0


def needs_of(ocean: bpy.types.Object) -> tuple[Need, ...]:
    """The ocean and objects that read it, as far as they need the extension; none if everything is baked."""
    surface = camera_surface_of(ocean)
    if settings_of(ocean).source == "LIVE":
        what, bake = f"{ocean.name}, which is computed live", f"bake {ocean.name}"
        around = _coast_around_camera(ocean, surface)
        shown = () if surface is None or around else (Need(surface.name, f"reads {what}", bake),)
        floating = f"{bake}, or bake the floating to keys"
        return (*around, _live(ocean), *shown, *_readers(ocean, what, bake, floating))
    dry = (*_over_bed(ocean, surface), *_dry(ocean), *_drifting(ocean))
    if surface is not None and patch_objects.shows_area(ocean):
        reason = f"shows waves of {ocean.name} that do not repeat, which its bake does not have"
        again = "mute their layers" if coast_surface.has_bed(ocean) else f"bake {ocean.name} again"
        return (Need(surface.name, reason, again), *dry)
    if surface is not None and patch_objects.lack_points(ocean):
        reason = f"shows the patches of {ocean.name}, whose bake has no points"
        return (Need(surface.name, reason, f"bake {ocean.name} again"), *dry)
    return dry


def _over_bed(ocean: bpy.types.Object, surface: bpy.types.Object | None) -> Iterator[Need]:
    """What shows the coast of a baked ocean live."""
    if not coast_surface.is_live(ocean):
        return
    yield from _coast_around_camera(ocean, surface)
    coast = coast_surface.coast_of(ocean)
    if coast is not None and not coast_surface.is_baked(ocean):
        yield Need(coast.name, f"shows the coast of {ocean.name}, whose bake has none", "bake it again")
    what = f"the coast of {ocean.name}, of which a bake moves the mesh only"
    yield from _readers(ocean, what, "enable the extension", "bake the floating to keys")


def _coast_around_camera(ocean: bpy.types.Object, surface: bpy.types.Object | None) -> tuple[Need, ...]:
    if surface is None or not coast_surface.has_bed(ocean):
        return ()
    reason = f"shows the coast of {ocean.name} around a camera, which no bake has"
    return (Need(surface.name, reason, "remove the camera surface, so that a bake shows the coast"),)


def _dry(ocean: bpy.types.Object) -> Iterator[Need]:
    scene = shown_oceans().get(ocean)
    if scene is None:
        return
    if spray.waits_for_bake(ocean, scene):
        yield Need(ocean.name, "has spray, which its bake has not", "bake it again")
    for what, remedy in left_out(ocean, scene):
        yield Need(ocean.name, f"has spray of {what}, which its bake has not", remedy)


def _drifting(ocean: bpy.types.Object) -> Iterator[Need]:
    for carrier in float_current.carriers_in_current(ocean):
        for item in float_carrier.carried_by(carrier):
            reason = f"drifts with the current of {ocean.name}, which no bake carries it along with"
            yield Need(item.name, reason, "bake the floating to keys")


def _live(ocean: bpy.types.Object) -> Need:
    if ocean.library is not None:
        where = bpy.path.basename(ocean.library.filepath)
        return Need(ocean.name, "is linked and computed live", f"bake it in {where}")
    return Need(ocean.name, "is computed live", "bake it")


def _readers(ocean: bpy.types.Object, what: str, remedy: str, for_floating: str) -> Iterator[Need]:
    """Objects whose modifiers read an ocean, and those that float on it, but no camera surface.

    what : they read
    """
    surface = camera_surface_of(ocean)
    for item in bpy.data.objects:
        if item in (ocean, surface) or not reads(item, (ocean,)):
            continue
        if not float_carrier.is_carrier(item):
            yield Need(item.name, f"reads {what}", remedy)
            continue
        for other in float_carrier.carried_by(item):
            yield Need(other.name, f"floats on {what}", for_floating)


def _concerns(update: bpy.types.DepsgraphUpdate) -> bool:
    item = update.id.original
    if not isinstance(item, bpy.types.Object) or was_ocean(
        item
    ):  # changes of an ocean itself are handled elsewhere
        return False
    if update.is_updated_transform and not update.is_updated_geometry:
        return False
    return item.session_uid in _seen.readers or any(each.type == "NODES" for each in item.modifiers)
