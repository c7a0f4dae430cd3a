# SPDX-License-Identifier: GPL-3.0-or-later
"""The sea of an ocean's bake, and how the ocean's settings differ from it."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import bpy

from ..core import OceanParameters, ParameterError
from ..core.data import formats
from ..core.data.raster import has_brief_rasters, raster_bytes
from ..core.numerics.memo import remembered
from ..core.parameters.former_json import modern
from ..core.parameters.patch_seas import open_sea
from ..core.parameters.shot import OCEAN_TIME, Moment, Shot
from ..core.sea.placed_waves import repeating, without_placed
from ..export.cache.folders import JOB_FILE, read_job
from ..export.cache.job import CacheError
from ..export.exr import ExrError, read_header
from . import failures
from .animated import clock_of, has_own_time, is_animated
from .cache_place import is_left_behind
from .image_sequence import SequenceError, baked_frames, file_of, folder_of, shown_frame, unbaked_frames
from .modifiers import set_changed
from .settings import OceanSettings, settings_of

#: tolerance for times in s, as Blender stores them as float32
_SAME_TIME = 1e-3


class Difference(NamedTuple):
    """A value that differs between bake and settings, with its path in the parameters."""

    path: str
    baked: Any
    own: Any


def parameters_of(path: Path, frame: int) -> OceanParameters:
    """The sea that an image of a frame was baked from.

    Raises ExrError, ParameterError or SequenceError if the image does not contain it.
    """
    metadata = read_header(path)
    if "parameters" not in metadata:
        raise SequenceError(f"{path} does not say which sea it was baked from: switch off Use Its Parameters")
    told = metadata["parameters"]
    try:
        return OceanParameters.from_dict(told)
    except ParameterError:
        if not has_brief_rasters(told):
            raise
    # images name their images and winds, which stand in the job beside them
    try:
        parameters = read_job(path.parent).shot.at(frame).parameters
    except (CacheError, ParameterError) as error:
        raise SequenceError(
            f"{path} names the images or winds of its sea, but does not hold them, and the bake's job does "
            f"not either ({error}): switch off Use Its Parameters"
        ) from None
    if parameters.to_dict(brief=True) != modern(told):
        raise SequenceError(
            f"{path} belongs to another sea than the job beside it: switch off Use Its Parameters"
        )
    return parameters


def baked_shot(settings: OceanSettings) -> Shot | None:
    """The shot that an ocean's files are of, from the job beside them or else from the header of the first.

    None for a live ocean, or if neither contains it. Cached until the file changes.
    """
    frames = baked_frames(settings)
    path = file_of(settings, frames[0]) if settings.source == "SEQUENCE" else None
    if path is None:
        return None
    told = (told_by(each, frames[0]).shot for each in (path.with_name(JOB_FILE), path))
    return next((shot for shot in told if shot is not None), None)


@dataclass(frozen=True)
class Told:
    """The data in a file of a bake.

    shot : None if it contains none
    maps : that a job has
    nbytes : of the images in the shot
    foam : version of a job's foam
    """

    shot: Shot | None = None
    maps: tuple[str, ...] = ()
    nbytes: int = 0
    foam: int = formats.FOAM


def told_by(path: Path, frame: int = 0) -> Told:
    """The data of a job or of a frame's image, cached until the file changes."""
    try:
        written = path.stat()
    except OSError:
        return Told()
    return _read(path, frame, (written.st_mtime_ns, written.st_size))


@remembered("bakes")
def _read(path: Path, frame: int, _written: tuple[int, int]) -> Told:
    try:
        if path.name != JOB_FILE:
            shot, maps, foam = Shot(parameters_of(path, frame)), (), formats.FOAM
        else:
            job = read_job(path.parent)
            shot, maps, foam = job.shot, job.maps, job.foam
    except (CacheError, ExrError, ParameterError, SequenceError):
        return Told()
    return Told(shot, maps, raster_bytes(shot.parameters), foam)


def shown_parameters(settings: OceanSettings, scene: bpy.types.Scene) -> OceanParameters:
    """The sea that an ocean shows: that of the bake at the present frame if it is baked, else that of its
    settings.

    Raises ParameterError for settings that are no sea.
    """
    shot = baked_shot(settings)
    if shot is None:
        return settings.to_parameters(scene)
    return _moment(shot, shown_frame(settings, scene, scene.frame_current)).parameters


def check(item: bpy.types.Object, scene: bpy.types.Scene, shown: OceanSettings | None = None) -> None:
    """Store for the panel the sea of an ocean's bake, and the differences of its settings.

    shown : the settings as animation makes them, where it does
    """
    settings = settings_of(item)
    is_elsewhere = settings.source == "SEQUENCE" and is_left_behind(item)
    set_changed(settings, bake_is_elsewhere=is_elsewhere)
    shot = baked_shot(settings)
    if shot is None:
        set_changed(settings, baked_sea="", bake_differs="")
        return
    frame = shown_frame(settings, scene, scene.frame_current)
    sea = _moment(shot, frame).parameters.to_dict(brief=True)
    set_changed(settings, baked_sea=json.dumps(sea, sort_keys=True))
    if moves(item) and unbaked_frames(settings, scene, (scene.frame_current,)):
        return  # another frame is held, whose values differ anyway
    try:
        found = differences(shot, frame, shown or settings, scene)
    except ParameterError:
        found = []  # the panel already reports that the settings are invalid
    set_changed(settings, bake_differs=json.dumps(found) if found else "")


def moves(item: bpy.types.Object) -> bool:
    """Whether an ocean's bake or its settings change from frame to frame."""
    shot = baked_shot(settings_of(item))
    return shot is not None and (shot.animation is not None or is_animated(item))


def warn(item: bpy.types.Object) -> None:
    """Warn on the console, once per shot, that the settings of a baked ocean differ from its bake, and that
    its foam has no age.
    """
    settings = settings_of(item)
    folder = folder_of(settings) if settings.source == "SEQUENCE" else None
    if folder is not None and told_by(folder / JOB_FILE).foam < formats.FOAM_OF_TWO_AGES:
        failures.warned(
            item, "foam",
            f"the bake in {folder} was made before foam had an age: the water material estimates it from the "
            "amount of foam; bake again to tell breaking crests from old foam",
        )  # fmt: skip
    if settings.bake_differs:
        found = [Difference(*entry) for entry in json.loads(settings.bake_differs)]
        more = f" and {len(found) - 1} more" if len(found) > 1 else ""
        failures.warned(
            item, "bake",
            f"the bake in {folder_of(settings)} is shown, not the settings: {found[0].path} is "
            f"{found[0].own} and was {found[0].baked}{more}",
        )  # fmt: skip


def differences(shot: Shot, frame: int, settings: OceanSettings, scene: bpy.types.Scene) -> list[Difference]:
    """The differences between settings and a frame of a bake. Raises ParameterError for invalid settings."""
    moment, parameters = _moment(shot, frame), settings.to_parameters(scene)
    # no bake of a tile holds what does not repeat, but it may hold a coast beside it
    bare = without_placed if moment.parameters.has_coast else repeating
    seas = (moment.parameters, parameters)
    if shot.around is not None:  # it holds what does not repeat beside the tile
        bare = open_sea
    baked, own = (bare(sea.replace(spray=None)).to_dict(brief=True) for sea in seas)
    found = sorted(_different("", baked, own))
    has_clock = shot.animation is not None and OCEAN_TIME in dict(shot.animation.samples)
    if has_clock or has_own_time(settings):
        time = clock_of(settings, scene, parameters.timing.start_frame).time
        if abs(time - moment.time) > _SAME_TIME:
            found.append(Difference(OCEAN_TIME, float(moment.time), float(time)))
    return found


def _different(path: str, baked: Any, own: Any) -> Iterator[Difference]:
    if isinstance(baked, dict) and isinstance(own, dict):
        for name in baked.keys() | own.keys():
            yield from _different(f"{path}.{name}".lstrip("."), baked.get(name), own.get(name))
    elif isinstance(baked, list) and isinstance(own, list):
        if len(baked) != len(own):
            yield Difference(path, len(baked), len(own))
            return
        for index, pair in enumerate(zip(baked, own, strict=True)):
            yield from _different(f"{path}.{index}", *pair)
    elif baked != own:
        yield Difference(path, baked, own)


def _moment(shot: Shot, frame: int) -> Moment:
    if shot.animation is not None:
        frame = min(max(frame, shot.animation.first_frame), shot.animation.last_frame)
    return shot.at(frame)
