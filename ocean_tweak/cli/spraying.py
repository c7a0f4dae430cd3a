# SPDX-License-Identifier: GPL-3.0-or-later
"""`bake --spray`: particles beside the images of a sea, computed by one process in the order of frames."""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence

from ..core.data.frames import Frame
from ..core.sea.bake import BakedFrame
from ..core.sea.placed_waves import has_tile
from ..core.sea.shot_spray import ShotSpray
from ..core.sea.spray_outlook import check_spray, is_around
from ..export.cache.locks import claimed
from ..export.spray import SpraySequence, WantedSpray
from .outcome import DONE, FAILED, UsageError
from .progress import Progress
from .seas import FileSea
from .stopping import stop_requested


def spray_of(arguments: argparse.Namespace, sea: FileSea) -> WantedSpray | None:
    """The spray requested by a command, or None.

    Raises UsageError or ParameterError for an impossible combination, and for more particles than fit into
    memory.
    """
    if not arguments.spray:
        if arguments.spray_place is not None:
            raise UsageError("--spray-place: is where --spray is made, and that is missing")
        return None
    parameters = sea.shot.parameters
    around = is_around(parameters)
    if arguments.spray_place is not None and not around:
        raise UsageError(
            "--spray-place: is for a sea of patches, with wakes or a coast; this one has it on its tile: "
            "leave it out"
        )
    place = sea.place if arguments.spray_place is None else tuple(arguments.spray_place)
    if around and place is None and not has_tile(parameters):
        raise UsageError(
            "--spray: no sum of patches, wake or coast repeats: say where it is seen, --spray-place 0 0"
        )
    spray = parameters.spray
    assert spray is not None  # set by the command's changes
    check_spray(parameters, spray)
    return WantedSpray(spray, place if around else None)


def bake_spray(arguments: argparse.Namespace, files: SpraySequence, frames: Sequence[Frame]) -> int:
    """Bake missing spray frames. Returns the exit code."""
    progress = Progress(files.name, arguments.json, arguments.openjd)
    with (
        stop_requested() as stop,
        claimed(
            files.directory, tuple(frames), arguments.wait, arguments.take_over, stop.is_set, progress.remark
        ) as hold,
    ):
        todo = files.missing(frames)
        progress.say(f"{len(todo)} of {len(frames)} frames of spray to make", left=len(todo), phase="spray")
        progress.begin(len(todo))
        maker = ShotSpray(files.shot, files.spray, files.place)
        try:
            for frame in todo:
                if stop.is_set() or hold.is_lost():
                    progress.fail("stopped")
                    return FAILED
                started = time.perf_counter()
                path = files.write(frame, maker.at(frame))
                progress.frame(BakedFrame(frame, (path,), time.perf_counter() - started))
        finally:
            progress.end()
    return DONE
