# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray that an ocean reads from the files of its bake, and what commands are told that bake it."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import bpy

from ..core.data import formats
from ..core.data.errors import ParameterError
from ..core.data.plain_data import from_plain, to_plain
from ..core.data.printable import without_exponent
from ..core.parameters.spray import Spray
from ..core.sea.placed_waves import makes_foam, repeating
from ..core.sea.spray_outlook import breaks_ashore, why_none
from ..core.spray.columns import COLUMNS
from ..export.frame_files import SPRAY, WAKES, files_start
from ..export.ply import told_by_ply
from ..export.spray import WantedSpray, spray_files
from .patch_objects import has_wakes_to_bake
from .patch_points import files_of, has_points
from .plan import camera_place, camera_surface_of, scene_camera_place
from .settings import OceanSettings, settings_of
from .units import metres_per_unit


@dataclass(frozen=True)
class BakedSpray:
    """Spray that files have.

    start : of the files' paths, up to the frame
    frames : that have one, ascending
    spray : what they were made from; the usual where they do not tell
    is_older : whether an older version made them
    """

    start: str
    frames: tuple[int, ...]
    spray: Spray
    is_older: bool

    def differs(self, own: Spray | None) -> str | None:
        """How it is another one than the settings say; None where it is that."""
        if self.is_older:
            return "its spray was baked by another version"
        if own is None or self.spray == own:
            return None
        was, now = to_plain(self.spray), to_plain(own)
        name = next(name for name in was if was[name] != now[name])
        return f"its spray was baked with a {name} of {was[name]:g}, and the settings have {now[name]:g}"


def baked_spray(settings: OceanSettings) -> BakedSpray | None:
    """The spray of the bake that an ocean reads; None where it is live, or the bake has none."""
    found = files_of(settings)
    if found is None:
        return None
    stored, name, here = found
    folder = here / SPRAY
    try:
        changed = folder.stat().st_mtime_ns
    except OSError:
        return None
    return _baked_in(folder, name, stored, changed)


@functools.lru_cache(maxsize=64)
def _baked_in(folder: Path, name: str, stored: str, _changed: int) -> BakedSpray | None:
    """The spray in a folder, which is read anew when it has changed."""
    start, files = files_start(name, SPRAY), spray_files(folder.parent, name)
    if not files:
        return None
    told = told_by_ply(files[min(files)], (COLUMNS,)) or {}
    spray = Spray()
    with contextlib.suppress(ParameterError):
        spray = from_plain(Spray, told.get("spray", {}))
    is_older = told.get("version", formats.SPRAY) != formats.SPRAY
    return BakedSpray(f"{stored}{SPRAY}/{start}", tuple(files), spray, is_older)


def spray_to_bake(ocean: bpy.types.Object, scene: bpy.types.Scene) -> WantedSpray | None:
    """The spray that a bake of an ocean makes; None where there is none."""
    parameters = settings_of(ocean).to_parameters(scene)
    if camera_surface_of(ocean) is not None and not has_wakes_to_bake(ocean):  # as its shot is
        parameters = repeating(parameters)
    if parameters.spray is None or why_none(parameters) is not None:
        return None
    return WantedSpray(parameters.spray, bake_place(ocean, scene))


def left_out(ocean: bpy.types.Object, scene: bpy.types.Scene) -> Iterator[tuple[str, str]]:
    """What throws up spray of an ocean around a camera and is in no bake of it, each with a remedy."""
    settings = settings_of(ocean)
    if camera_surface_of(ocean) is None or not settings.use_spray:
        return
    try:
        parameters = settings.to_parameters(scene)
    except ParameterError:
        return  # the ocean tells
    if makes_foam(parameters) and parameters.has_coast:
        yield "bows", "press Back to Live, or mute their layers"
    elif makes_foam(parameters) and settings.source != "LIVE" and not has_points(settings, WAKES):
        yield "bows", "bake it again"
    if breaks_ashore(parameters):
        yield "breakers on the coast", "press Back to Live, or remove the camera surface and bake again"


def spray_arguments(ocean: bpy.types.Object, scene: bpy.types.Scene) -> list[str]:
    """What the command `bake` is told of an ocean's spray."""
    spray = spray_to_bake(ocean, scene)
    if spray is None:
        return []
    return [
        "--spray",
        *(() if spray.place is None else ("--spray-place", *map(without_exponent, spray.place))),
    ]


def spray_numbers(ocean: bpy.types.Object, scene: bpy.types.Scene) -> list[str]:
    """What a command is told of them besides, that takes the sea from a bake."""
    spray = spray_to_bake(ocean, scene)
    numbers = {} if spray is None else to_plain(spray.spray)
    return [f"--set=spray.{name}={value}" for name, value in numbers.items()]


def bake_place(ocean: bpy.types.Object, scene: bpy.types.Scene) -> tuple[float, float] | None:
    """Where the camera is now around which an ocean of patches, with wakes or with a coast is shown, m; None
    for another ocean, which has its spray on its tile: a bake is without a coast that a camera surface
    shows."""
    settings, scale = settings_of(ocean), float(1 / metres_per_unit(scene))
    surface = camera_surface_of(ocean)
    if surface is None:
        has_coast = settings.to_parameters(scene).has_coast
        return scene_camera_place(ocean, scene, scale) if has_coast else None
    is_around = len(settings.patches) or has_wakes_to_bake(ocean)
    return camera_place(surface, scene, scale) if is_around else None
