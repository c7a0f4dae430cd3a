# SPDX-License-Identifier: GPL-3.0-or-later
"""What is baked, played in Blender frame after frame, against the same sea live; and what stays in memory.

Both sides have the same maps. Of To the Horizon the foam around the camera is live in either case.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy

from ocean_tweak.core import Ocean, OceanParameters
from ocean_tweak.export.exr import ExrSequence
from ocean_tweak.scene import ocean_object, surroundings
from ocean_tweak.scene.camera_surface import camera_surface_of
from ocean_tweak.scene.image_sequence import ImageSequence

from .horizon import Contender, finish, in_window, player
from .measure import interleaved
from .rows import Row, ratio_row

_LIVE, _BAKED = "live", "baked"
#: MB that Blender's cache of images may have while more than that is played, and frames of 512² that are
_LIMIT, _FRAMES = 64, 90

#: of Linux: what tells the pages that a process has in memory
_RESIDENT = Path("/proc/self/statm")


def rows(make: Callable[[int], Contender], sea: OceanParameters, rounds: int, group: str) -> Iterator[Row]:
    """Rows of one baked sea: its time against live, and the memory that playing it takes.

    make : a live ocean without maps, of so many samples a side
    """
    samples = sea.resolution
    with tempfile.TemporaryDirectory() as folder:
        live, baked = make(samples), make(samples)
        scene, item = baked
        last = max(_FRAMES, 2 * rounds + 3)
        ocean_object.use_sequence(item, scene, _written(sea, Path(folder), last))
        sides = {_LIVE: player(*live), _BAKED: player(*baked)}
        yield ratio_row(
            group, f"frame → mesh, {samples}², baked displacement against live",
            interleaved(sides, rounds), _BAKED, _LIVE, target="baked",
        )  # fmt: skip
        if not _RESIDENT.exists():
            return
        yield Row(
            group, f"memory that grows while {last - last // 3} frames of {samples}² are played beyond the "
            "limit of Blender's cache", _growth(scene, item, last), "MB", target="baked memory",
        )  # fmt: skip


def horizon_row(rounds: int, group: str) -> Row:
    """To the Horizon, baked and played, against live. It bakes for some minutes."""
    sides: dict[str, Callable[[], None]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for seed, name in enumerate((_LIVE, _BAKED), 1):
            scene = bpy.data.scenes.new(f"To the Horizon, {name}")
            with in_window():
                ocean = surroundings.build(scene, "HORIZON", surroundings.Wishes()).ocean
                ocean.ocean_tweak.seed = seed  # those that are alike share foam
                surface = camera_surface_of(ocean)
                scene.view_layers[0].update()
                finish(ocean)
            scene.frame_start, scene.frame_end = 1, rounds + 3
            sides[name] = player(scene, surface, ocean if name == _LIVE else None)
        bpy.ops.wm.save_as_mainfile(filepath=str(Path(folder, "shot.blend")))
        where = {"scene": scene, "view_layer": scene.view_layers[0], "active_object": ocean, "object": ocean}
        with bpy.context.temp_override(**where):
            bpy.ops.ocean.bake()
        return ratio_row(
            group, "To the Horizon: frame → mesh, baked against live",
            interleaved(sides, rounds), _BAKED, _LIVE, target="baked horizon",
        )  # fmt: skip


def _written(sea: OceanParameters, folder: Path, last: int) -> ImageSequence:
    """The displacement of frames from 1 on."""
    frames, ocean = tuple(range(1, last + 1)), Ocean(sea)
    sink = ExrSequence(folder, "sea", sea, maps=("disp",))
    for frame in frames:
        sink.write(frame, ocean.frame(frame, sink.outputs))
    return ImageSequence(folder, "sea", frames)


def _growth(scene: bpy.types.Scene, item: bpy.types.Object, last: int) -> float:
    """MB by which the process grows in the last two thirds of the frames: the first fill the cache."""
    system, before = bpy.context.preferences.system, 0.0
    limit, system.memory_cache_limit = system.memory_cache_limit, _LIMIT
    try:
        for frame in range(1, last + 1):
            scene.frame_set(frame)
            scene.view_layers[0].update()
            item.evaluated_get(scene.view_layers[0].depsgraph)
            if frame == last // 3:
                before = _resident()
        return max(0.0, _resident() - before) / 1e6
    finally:
        system.memory_cache_limit = limit


def _resident() -> float:
    """Bytes of this process in memory."""
    return int(_RESIDENT.read_text(encoding="ascii").split()[1]) * os.sysconf("SC_PAGE_SIZE")
