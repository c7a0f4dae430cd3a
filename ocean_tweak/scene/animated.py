# SPDX-License-Identifier: GPL-3.0-or-later
"""Oceans whose settings are animated or driven.

Blender evaluates animation after the frame-change handlers and copies it back to the settings in the viewport
only, so an animated ocean is updated after the evaluation, from the evaluated object.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import bpy
import numpy as np

from .settings import OceanSettings, settings_of
from .units import frame_rate, frame_with_subframe, shortest_decimal, time_stretch

_GROUP = "ocean_tweak."
#: path of the ocean time
OCEAN_TIME = "ocean_tweak.ocean_time"
_LAYER = re.compile(r"ocean_tweak\.layers\[(\d+)\]")


class Clock(NamedTuple):
    """An ocean's time at a moment of the scene.

    time : s, exact
    rate : seconds of it per second of the scene; None if a driver makes that unknown
    """

    time: Fraction
    rate: float | None


def is_animated(item: bpy.types.Object) -> bool:
    """Whether keys, drivers or NLA strips change an ocean's settings."""
    data = item.animation_data
    if data is None:
        return False
    paths = [driver.data_path for driver in data.drivers]
    paths += [curve.data_path for curve in curves_of(item)]
    return any(path.startswith(_GROUP) for path in paths)


def has_own_time(settings: OceanSettings) -> bool:
    """Whether the ocean time does not simply follow the scene's frames."""
    return settings.use_ocean_time or settings.time_scale != 1.0


def shown_settings(item: bpy.types.Object, depsgraph: bpy.types.Depsgraph | None) -> OceanSettings:
    """The settings as animated in this evaluation."""
    if depsgraph is None or not is_animated(item):
        return settings_of(item)
    return settings_of(item.evaluated_get(depsgraph))


def clock_of(settings: OceanSettings, scene: bpy.types.Scene, start_frame: int) -> Clock:
    """The ocean time at the scene's frame or subframe."""
    # as Blender does with keys
    frame, rate = frame_with_subframe(scene) / time_stretch(scene), 1 / time_stretch(scene)
    fps = frame_rate(scene)
    if not settings.use_ocean_time:
        scale = shortest_decimal(settings.time_scale)
        return Clock((frame - start_frame) / fps * scale, float(rate * scale))
    change = _change(settings.id_data, frame)
    return Clock(
        shortest_decimal(settings.ocean_time), None if change is None else float(change * fps * rate)
    )


def _change(item: bpy.types.Object, frame: Fraction) -> float | None:
    """Seconds of ocean time per frame of the animation, from the keys around a frame."""
    data = item.animation_data
    if data is not None and any(driver.data_path == OCEAN_TIME for driver in data.drivers):
        return None
    curve = next((curve for curve in curves_of(item) if curve.data_path == OCEAN_TIME), None)
    if curve is None:
        return 0.0
    half = 0.5
    return float(curve.evaluate(float(frame) + half) - curve.evaluate(float(frame) - half))


def set_keys(
    item: bpy.types.Object, scene: bpy.types.Scene, first_frame: int, samples: Mapping[str, Sequence[float]]
) -> None:
    """Key an ocean's settings in each frame, with linear interpolation; other keys and drivers are removed.

    samples : values in Blender units, by path as in `core.parameters.shot.ANIMATED`; none takes the animation
        off
    """
    _remove_animation(item)
    for path, values in samples.items():
        key_each_frame(item, _GROUP + re.sub(r"\.(\d+)", r"[\1]", path), scene, first_frame, values)


def key_each_frame(
    item: bpy.types.Object,
    data_path: str,
    scene: bpy.types.Scene,
    first_frame: int,
    values: Sequence[float],
    index: int = -1,
) -> None:
    """Key a property in each frame, with linear interpolation.

    index : of a property that is several numbers
    """
    # creates action, slot and curve if missing
    item.keyframe_insert(data_path, index=index, frame=first_frame)
    known = (data_path, max(index, 0))
    points = next(
        curve for curve in curves_of(item) if (curve.data_path, curve.array_index) == known
    ).keyframe_points
    points.add(len(values) - len(points))
    frames = (first_frame + np.arange(len(values))) / float(time_stretch(scene))
    points.foreach_set("co", np.stack((frames, values), axis=-1).astype(np.float32).ravel())
    for point in points:
        point.interpolation = "LINEAR"
    points.handles_recalc()


def move_keys(item: bpy.types.Object, places: Mapping[int, int | None]) -> None:
    """Move keys and drivers of wave layers along with these in the list.

    places : index of a layer before and after; None removes its keys
    """
    data = item.animation_data
    if data is None or all(old == new for old, new in places.items()):
        return
    for driver in list(data.drivers):
        _move_curve(driver, places, data.drivers)
    for bag in channel_bags(data.action, data.action_slot):
        for curve in list(bag.fcurves):
            _move_curve(curve, places, bag.fcurves)


def _move_curve(curve: bpy.types.FCurve, places: Mapping[int, int | None], curves: Any) -> None:
    match = _LAYER.match(curve.data_path)
    if match is None or int(match[1]) not in places:
        return
    place = places[int(match[1])]
    if place is None:
        curves.remove(curve)
    else:
        curve.data_path = f"{_GROUP}layers[{place}]{curve.data_path[match.end() :]}"


def _remove_animation(item: bpy.types.Object) -> None:
    data = item.animation_data
    if data is None:
        return
    for driver in list(data.drivers):
        if driver.data_path.startswith(_GROUP):
            data.drivers.remove(driver)
    for bag in channel_bags(data.action, data.action_slot):
        for curve in list(bag.fcurves):
            if curve.data_path.startswith(_GROUP):
                bag.fcurves.remove(curve)


def curves_of(item: bpy.types.Object) -> Iterator[bpy.types.FCurve]:
    """All curves of an object, of its action and of its NLA strips."""
    data = item.animation_data
    if data is None:
        return
    yield from _action_curves(data.action, data.action_slot)
    for track in data.nla_tracks:
        for strip in track.strips:
            yield from _action_curves(strip.action, strip.action_slot)


def _action_curves(
    action: bpy.types.Action | None, slot: bpy.types.ActionSlot | None
) -> Iterator[bpy.types.FCurve]:
    for bag in channel_bags(action, slot):
        yield from bag.fcurves


def channel_bags(
    action: bpy.types.Action | None, slot: bpy.types.ActionSlot | None
) -> Iterator[bpy.types.ActionChannelbag]:
    """The channel bags of an action's slot."""
    if action is None or slot is None:
        return
    for layer in action.layers:
        for strip in layer.strips:
            bag = strip.channelbag(slot)
            if bag is not None:
                yield bag
