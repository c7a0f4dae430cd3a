# SPDX-License-Identifier: GPL-3.0-or-later
"""`bake --spray`: particles beside the images of a sea, made by one process in the order of frames."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ..core import Ocean, OceanParameters, Spray
from ..core.parameters.shot import Moment
from ..core.sea.bake import BakedFrame
from ..core.sea.foam_levels import FoamLevels
from ..core.sea.spray import CameraSpray, TileSpray, check_spray
from ..core.spray.particles import Particles
from ..export.cache.job import Job
from ..export.cache.locks import claimed
from ..export.spray import SpraySequence
from .outcome import DONE, FAILED, UsageError
from .progress import Progress
from .seas import FileSea
from .stopping import stop_requested


@dataclass(frozen=True)
class WantedSpray:
    """Spray that is asked for, and the place around which it is made; None for the sea's tile."""

    spray: Spray
    place: tuple[float, float] | None


def spray_of(arguments: argparse.Namespace, sea: FileSea) -> WantedSpray | None:
    """The spray that a command asks for; None where it asks for none.

    Raises UsageError or ParameterError for what cannot be, and for more than the memory holds.
    """
    if not arguments.spray:
        if arguments.spray_place is not None:
            raise UsageError("--spray-place: is where --spray is made, and that is missing")
        return None
    parameters = sea.shot.parameters
    place = sea.place if arguments.spray_place is None else tuple(arguments.spray_place)
    if parameters.is_cascade and place is None:
        raise UsageError(
            "--spray: the sum of patches does not repeat: say where it is seen, --spray-place 0 0"
        )
    spray = parameters.spray or Spray()
    check_spray(parameters, spray)
    return WantedSpray(spray, place if parameters.patches else None)


def bake_spray(arguments: argparse.Namespace, folder: Path, job: Job, wanted: WantedSpray) -> int:
    """Make what is missing of the frames' spray. Returns the exit code."""
    frames = arguments.only or job.frames
    files = SpraySequence(folder, job.name, job.shot, wanted.spray, wanted.place)
    progress = Progress(job.name, arguments.json, arguments.openjd)
    with (
        stop_requested() as stop,
        claimed(folder, tuple(frames), arguments.wait, arguments.take_over, stop.is_set, progress.remark),
    ):
        todo = [frame for frame in frames if not files.is_whole(frame)]
        progress.begin(len(todo))
        maker = SprayMaker(wanted.place)
        try:
            for frame in todo:
                if stop.is_set():
                    progress.fail("stopped")
                    return FAILED
                started = time.perf_counter()
                path = files.write(frame, maker.at(job.shot.at(frame), wanted.spray))
                progress.frame(BakedFrame(frame, (path,), time.perf_counter() - started))
        finally:
            progress.end()
    return DONE


class SprayMaker:
    """Spray of a shot's moments: of one sea, or of another where it is animated."""

    def __init__(self, place: tuple[float, float] | None) -> None:
        self._place = place
        self._made: tuple[OceanParameters, Callable[[Moment, Spray], Particles]] | None = None

    def at(self, moment: Moment, spray: Spray) -> Particles:
        """Particles at a moment, with velocities per second of the shot."""
        if self._made is None or self._made[0] != moment.parameters:
            self._made = moment.parameters, self._maker(moment.parameters)
        made = self._made[1](moment, spray)
        return made if moment.rate == 1.0 else made._replace(velocity=made.velocity * moment.rate)

    def _maker(self, sea: OceanParameters) -> Callable[[Moment, Spray], Particles]:
        place = self._place
        if place is None:
            tile = TileSpray(Ocean(sea))
            return lambda moment, spray: tile.at(moment.time, spray)
        around = CameraSpray(FoamLevels(sea))
        return lambda moment, spray: around.at(moment.time, spray, place)
