# SPDX-License-Identifier: GPL-3.0-or-later
"""An ocean as a shot that needs no Blender: its sea, and what is animated, a sample a frame; and back."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import bpy

from ..core import OceanParameters
from ..core.data.frames import Frame
from ..core.data.validation import changing_fields
from ..core.parameters.shot import OCEAN_TIME, Animation, Shot
from . import handlers
from .animated import clock_of, has_own_time, is_animated, set_keys, shown_settings
from .settings import settings_of
from .view_layers import evaluated, taking_part


def shot_of(item: bpy.types.Object, scene: bpy.types.Scene, frames: Iterable[Frame] = ()) -> Shot:
    """The shot of an ocean over frames, by default the scene's. Raises ParameterError for what is no sea.

    The scene ends at the frame where it was.
    """
    settings = settings_of(item)
    parameters = settings.to_parameters(scene)
    if not (is_animated(item) or has_own_time(settings)):
        return Shot(parameters)
    wanted = tuple(frames) or (scene.frame_start, scene.frame_end)
    # one more on either side: the velocity of an end is that of the motion through it
    first, last = math.floor(min(wanted)) - 1, math.ceil(max(wanted)) + 1
    samples = [
        _sample(item, scene, depsgraph) for depsgraph in evaluations(scene, range(first, last + 1), item)
    ]
    changing = {
        path: tuple(sample[path] for sample in samples)
        for path in samples[0]
        if path == OCEAN_TIME or any(sample[path] != samples[0][path] for sample in samples)
    }
    if not changing:
        return Shot(parameters)
    return Shot(parameters, Animation(first, tuple(changing.items())))


def animate(item: bpy.types.Object, scene: bpy.types.Scene, shot: Shot) -> None:
    """Give an ocean, which is the shot's sea already, keys for what changes; none where nothing does."""
    samples = dict(shot.animation.samples) if shot.animation is not None else {}
    settings = settings_of(item)
    with settings.quiet():
        settings.use_ocean_time = OCEAN_TIME in samples
        settings.time_scale = 1.0
    first = shot.animation.first_frame if shot.animation is not None else 0
    set_keys(
        item, scene, first, {path: settings.blender_values(path, samples[path], scene) for path in samples}
    )
    if samples:
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)


def evaluations(
    scene: bpy.types.Scene, frames: Iterable[int], item: bpy.types.Object
) -> Iterator[bpy.types.Depsgraph]:
    """The scene at each frame, without the waves of any ocean; it ends at the frame where it was.

    item : whose settings and place are evaluated, whatever hides it
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
) -> dict[str, float]:
    """What can be animated, by its path, at the scene's present frame."""
    settings = shown_settings(item, depsgraph)
    parameters = settings.to_parameters(scene)
    values = dict(_values(parameters))
    if has_own_time(settings):
        values[OCEAN_TIME] = float(clock_of(settings, scene, parameters.timing.start_frame).time)
    return values


def _values(parameters: OceanParameters) -> Iterator[tuple[str, float]]:
    yield from ((name, getattr(parameters, name)) for name in changing_fields(OceanParameters))
    for index, layer in enumerate(parameters.layers):
        own = changing_fields(type(layer))
        yield from ((f"layers.{index}.{name}", getattr(layer, name)) for name in own)
