# SPDX-License-Identifier: GPL-3.0-or-later
"""The ready scene To the Horizon in Blender, against a plain sea of 512² samples without maps.

It is played as in a window: frame after frame, with foam that goes on from the frame before. Its renders are
those of a farm.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from unittest.mock import patch

import bpy

from ocean_tweak.nodes.modifier_inputs import get_input, set_inputs
from ocean_tweak.scene import refinement, surroundings
from ocean_tweak.scene.camera_surface import camera_surface_of
from ocean_tweak.scene.refresh import Wanted, refresh

from .measure import interleaved
from .rows import Row, ratio_row

_MOOD, _BUDGET = "HORIZON", "Viewport Vertex Budget"
_PLAIN, _SHOWN = "plain sea, 512², no maps", "To the Horizon"

#: a scene and its ocean
Contender = tuple[bpy.types.Scene, bpy.types.Object]


def rows(plain: Contender, rounds: int, group: str) -> Iterator[Row]:
    """The rows of the scene, in whose place a window would be free of it, played and changed.

    plain : a sea of 512² samples without maps
    """
    scene = bpy.data.scenes.new(_SHOWN)
    with in_window():
        start = time.perf_counter()
        ocean = surroundings.build(scene, _MOOD, surroundings.Wishes()).ocean
        seconds = time.perf_counter() - start
        surface = camera_surface_of(ocean)
        _mesh(scene, surface)  # only now it is known where the camera is
        finish(ocean)
    yield Row(group, "To the Horizon: from the click to a free window", seconds, "s", target="horizon click")
    sides = {_PLAIN: player(*plain), _SHOWN: player(scene, surface, ocean)}
    yield ratio_row(
        group, "To the Horizon: frame → mesh, consecutive frames, against a plain sea",
        interleaved(sides, rounds), _SHOWN, _PLAIN, target="horizon frame",
    )  # fmt: skip
    yield _render_row(scene, ocean, surface, rounds, group)
    winds = (9.0 + 1e-2 * step for step in itertools.count())
    sides = {name: _dragger(*each, winds) for name, each in ((_PLAIN, plain), (_SHOWN, (scene, ocean)))}
    yield ratio_row(
        group, "To the Horizon: Wind dragged → first mesh, against a plain sea",
        interleaved(sides, rounds), _SHOWN, _PLAIN, target="horizon drag",
    )  # fmt: skip


def in_window() -> AbstractContextManager[object]:
    """As if somebody looked on."""
    return patch.object(refinement, "has_window", lambda: True)


def finish(ocean: bpy.types.Object) -> None:
    """Let follow what follows in a window."""
    while refinement.is_outstanding(ocean):
        refinement.go_on()
        time.sleep(0.01)


def _render_row(
    scene: bpy.types.Scene, ocean: bpy.types.Object, surface: bpy.types.Object, rounds: int, group: str
) -> Row:
    """A vertex of a frame with all that a render has, against one of the viewport's."""
    modifier, counts = surface.modifiers[0], dict[str, int]()
    frames, viewport = itertools.count(2), get_input(modifier, _BUDGET)

    def shown(name: str, wanted: Wanted, budget: int) -> Callable[[], None]:
        def run() -> None:
            set_inputs(modifier, {_BUDGET: budget})
            surface.update_tag()
            with in_window() if not wanted else nullcontext():
                scene.frame_set(next(frames))
            refresh(ocean, scene, wanted)
            counts[name] = len(_mesh(scene, surface).vertices)

        return run

    sides = {
        "render": shown("render", Wanted.RENDER, get_input(modifier, "Vertex Budget")),
        "viewport": shown("viewport", Wanted(0), viewport),
    }
    timings = interleaved(sides, rounds)
    set_inputs(modifier, {_BUDGET: viewport})
    share = counts["viewport"] / counts["render"]
    row = ratio_row(
        group, "To the Horizon: a vertex of a render's surface against one of the viewport's",
        timings, "render", "viewport", target="horizon render",
    )  # fmt: skip
    low, high = row.quartiles or (row.value, row.value)
    return replace(row, value=row.value * share, quartiles=(low * share, high * share))


def player(
    scene: bpy.types.Scene, item: bpy.types.Object, ocean: bpy.types.Object | None = None
) -> Callable[[], None]:
    """Goes to the next frame and asks for the mesh; raises RuntimeError where more of an ocean follows."""
    frames = itertools.count(2)

    def run() -> None:
        with in_window():
            scene.frame_set(next(frames))
            _mesh(scene, item)
            if ocean is not None and refinement.is_unfinished(ocean):
                raise RuntimeError("To the Horizon is played without the foam of the past")

    return run


def _dragger(scene: bpy.types.Scene, ocean: bpy.types.Object, winds: Iterator[float]) -> Callable[[], None]:
    """Changes the wind and asks for what a window shows first."""
    shown = camera_surface_of(ocean) or ocean

    def run() -> None:
        with ocean.ocean_tweak.quiet():
            ocean.ocean_tweak.layers[0].wind_speed = next(winds)
        refresh(ocean, scene, Wanted.SURFACE | Wanted.PATCHES)
        _mesh(scene, shown)

    return run


def _mesh(scene: bpy.types.Scene, item: bpy.types.Object) -> bpy.types.Mesh:
    layer = scene.view_layers[0]
    layer.update()
    return item.evaluated_get(layer.depsgraph).data
