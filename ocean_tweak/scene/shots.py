# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts an ocean to a shot, with its animation sampled in each frame, and back."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace

import bpy
import numpy as np

from ..core import Current, Mask, OceanParameters, ParameterError, Raster
from ..core.data.frames import Frame
from ..core.data.raster import LARGEST_SIDE
from ..core.data.validation import changing_fields
from ..core.parameters.shot import OCEAN_TIME, Animation, Samples, Shot
from ..core.parameters.surroundings import Surroundings
from ..core.sea.placed_waves import repeating
from ..core.spectral.equaliser import GAINS
from . import coast_surface, handlers, mask_place, patch_objects
from .animated import clock_of, has_own_time, is_animated, key_each_frame, set_keys, shown_settings
from .plan import area_around, camera_of, camera_place, camera_surface_of
from .settings import OceanObjectError, settings_of
from .units import metres_per_unit
from .view_layers import evaluated, taking_part

#: ends of paths of masks' places
_PLACE = ("mask.x", "mask.y")


def shot_of(item: bpy.types.Object, scene: bpy.types.Scene, frames: Iterable[Frame] = ()) -> Shot:
    """The shot of an ocean over frames, by default the scene's. Raises ParameterError for invalid settings.

    The scene ends at the frame where it was.
    """
    settings = settings_of(item)
    parameters = settings.to_parameters(scene)
    if not (is_animated(item) or has_own_time(settings)):
        return Shot(parameters)
    wanted = tuple(frames) or (scene.frame_start, scene.frame_end)
    # one more frame on either side, for the velocity at the ends
    first, last = math.floor(min(wanted)) - 1, math.ceil(max(wanted)) + 1
    seas, samples = zip(
        *(_sample(item, scene, depsgraph) for depsgraph in evaluations(scene, range(first, last + 1), item)),
        strict=True,
    )
    changing = {
        path: _joined(path, [sample[path] for sample in samples])
        for path in samples[0]
        if path == OCEAN_TIME or any(sample[path] != samples[0][path] for sample in samples)
    }
    if not changing:
        return Shot(parameters)
    # the sea of the first frame, whatever frame the scene is at
    return Shot(seas[0], Animation(first, tuple(changing.items())))


def bake_shot_of(item: bpy.types.Object, scene: bpy.types.Scene, frames: Iterable[Frame] = ()) -> Shot:
    """The shot of an ocean's bake. Where a camera surface shows what does not repeat, its tile is without
    that, and wakes are in the square around the camera.

    Raises ParameterError for what is no sea.
    """
    shot = shot_of(item, scene, frames)
    if camera_surface_of(item) is None:
        return shot
    if patch_objects.has_wakes_to_bake(item):
        return with_surroundings(shot, item, scene, frames)
    return replace(shot, parameters=repeating(shot.parameters))


def with_surroundings(
    shot: Shot, item: bpy.types.Object, scene: bpy.types.Scene, frames: Iterable[Frame] = ()
) -> Shot:
    """The shot of an ocean with the square around its camera, if a bake holds wakes there."""
    if not patch_objects.has_wakes_to_bake(item):
        return shot
    return replace(shot, around=_surroundings(item, scene, frames, shot.parameters))


def _surroundings(
    item: bpy.types.Object, scene: bpy.types.Scene, frames: Iterable[Frame], parameters: OceanParameters
) -> Surroundings:
    """Where the camera of an ocean's camera surface is over frames, by default the scene's."""
    wanted = tuple(frames) or (scene.frame_start, scene.frame_end)
    first, last = math.floor(min(wanted)), math.ceil(max(wanted))
    surface, scale = camera_surface_of(item), float(1 / metres_per_unit(scene))
    cuts = any(marker.camera is not None for marker in scene.timeline_markers)
    if _rests(item) and _rests(camera_of(surface, scene)) and not cuts:
        places = [camera_place(surface, scene, scale)]
    else:
        places = []
        for depsgraph in evaluations(scene, range(first, last + 1), item):
            ocean, camera = (
                each.evaluated_get(depsgraph).matrix_world for each in (item, camera_of(surface, scene))
            )
            x, y, _ = ocean.inverted_safe() @ camera.translation
            places.append((x / scale, y / scale))
    areas = [area_around(place, parameters.domain_size, parameters.resolution) for place in places]
    corners = tuple(area.corner for area in areas)
    corners = corners[:1] if len(set(corners)) == 1 else corners
    return Surroundings(areas[0].size, areas[0].resolution, corners, first if len(corners) > 1 else 0)


def _rests(item: bpy.types.Object) -> bool:
    """Whether nothing is seen that moves an object or its parents."""
    each: bpy.types.Object | None = item
    while each is not None:
        is_free = each.animation_data is None and not each.constraints and each.rigid_body is None
        if not (is_free and each.parent_type == "OBJECT"):
            return False
        each = each.parent
    return True


def needed_maps(item: bpy.types.Object) -> tuple[str, ...]:
    """The maps, besides images, that a bake needs so that everything in the file that shows the ocean
    moves."""
    return (*patch_objects.shot_maps(item), *coast_surface.shot_maps(item))


def _joined(path: str, values: list[float | Raster]) -> Samples:
    """A value of each frame. Raises ParameterError for lines that are not always as many."""
    if not isinstance(values[0], Raster):
        return tuple(values)
    if len({lines.shape for lines in values}) > 1:
        raise ParameterError(
            path, "lines", "must be as many in each frame: the mask's object gains or loses edges"
        )
    if len(values) > LARGEST_SIDE:
        reason = f"must be at most {LARGEST_SIDE} with a mask whose shape moves: take the shot in parts"
        raise ParameterError(path, f"{len(values)} frames", reason)
    return Raster(np.concatenate([lines.values for lines in values]), values[0].name)


def check_keys(shot: Shot) -> None:
    """Raise OceanObjectError for a shot that keys cannot represent: one that moves the lines of a mask."""
    for path, _ in shot.animation.samples if shot.animation is not None else ():
        if path.endswith("mask.lines"):
            raise OceanObjectError(
                f"{path} moves in this shot, which only the keys of an object can tell: open the .blend file "
                "that it was made in"
            )


def animate(item: bpy.types.Object, scene: bpy.types.Scene, shot: Shot) -> None:
    """Key the animated values of a shot on an ocean that already has the shot's sea.

    shot : one that `check_keys` lets pass; a mask that moves in it gets a keyed object
    """
    samples = dict(shot.animation.samples) if shot.animation is not None else {}
    settings = settings_of(item)
    with settings.quiet():
        settings.use_ocean_time = OCEAN_TIME in samples
        settings.time_scale = 1.0
    first = shot.animation.first_frame if shot.animation is not None else 0
    values = {path: settings.blender_values(path, samples[path], scene) for path in samples}
    masks = dict.fromkeys(path.rpartition(".")[0] for path in samples if path.endswith(_PLACE))
    set_keys(item, scene, first, {path: values[path] for path in values if not path.endswith(_PLACE)})
    for mask in masks:
        along = [values.get(f"{mask}.{axis}") for axis in ("x", "y")]
        place = mask_place.new_over(item)
        settings.let_mask_follow(mask, place)
        for index, values_along in enumerate(along):
            if values_along is not None:
                key_each_frame(place, "location", scene, first, values_along, index)
    mask_place.remove_unread(item)  # those of a shot before
    if samples:
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)


def evaluations(
    scene: bpy.types.Scene, frames: Iterable[int], item: bpy.types.Object
) -> Iterator[bpy.types.Depsgraph]:
    """Evaluate the scene at each frame without computing oceans, then return to the original frame.

    item : object whose settings and transform are evaluated, even if it is hidden
    """
    before = scene.frame_current, scene.frame_subframe
    try:
        with handlers.asleep(), taking_part(scene, item):
            for frame in frames:
                scene.frame_set(frame)
                yield evaluated(scene)
    finally:
        scene.frame_set(before[0], subframe=before[1])


def scene_frames(scene: bpy.types.Scene) -> tuple[int, ...]:
    """The frames that the scene renders."""
    return tuple(range(scene.frame_start, scene.frame_end + 1, scene.frame_step))


def _sample(
    item: bpy.types.Object, scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph
) -> tuple[OceanParameters, dict[str, float | Raster]]:
    """The sea at the scene's present frame, and its animatable values by path."""
    settings = shown_settings(item, depsgraph)
    parameters = settings.to_parameters(scene)
    values = dict(_values(parameters))
    if has_own_time(settings):
        values[OCEAN_TIME] = float(clock_of(settings, scene, parameters.timing.start_frame).time)
    return parameters, values


def _values(parameters: OceanParameters) -> Iterator[tuple[str, float | Raster]]:
    yield from ((name, getattr(parameters, name)) for name in changing_fields(OceanParameters))
    for index, layer in enumerate(parameters.layers):
        own = changing_fields(type(layer))
        yield from ((f"layers.{index}.{name}", getattr(layer, name)) for name in own)
    yield from _places("", parameters.mask)
    owners = (("", parameters), *((f"layers.{n}.", layer) for n, layer in enumerate(parameters.layers)))
    for owner, holder in owners:
        equaliser = getattr(holder, "equaliser", None)
        if equaliser is not None:
            yield from ((f"{owner}equaliser.{name}", getattr(equaliser, name)) for name in GAINS)
    if parameters.current is not None:
        names = changing_fields(Current)
        yield from ((f"current.{name}", getattr(parameters.current, name)) for name in names)
    for name, entries in (("layers", parameters.layers), ("patches", parameters.patches)):
        for index, entry in enumerate(entries):
            yield from _places(f"{name}.{index}.", entry.mask)


def _places(owner: str, mask: Mask | None) -> Iterator[tuple[str, float | Raster]]:
    """Values of a mask whose object moves."""
    if mask is not None and mask.source == "DISTANCE":
        names = ("x", "y") if mask.lines is None else ("lines",)
        yield from ((f"{owner}mask.{name}", getattr(mask, name)) for name in names)
