# SPDX-License-Identifier: GPL-3.0-or-later
"""The frame loop of a bake. Each frame depends only on the parameters and its number."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple, Protocol

import numpy as np

from ..data.frames import Frame
from ..foam.model import Whitecaps
from ..numerics.memo import MEMO
from ..parameters.patch_seas import AROUND, OVER_BED, PARTS, open_sea
from ..parameters.shot import Moment, Shot
from ..synthesis.channels import ADDING, CHANNELS, OF_MEMORY, SurfaceFields
from ..waves.contribution import MemoryNeed
from .memory import A_SAMPLE_AROUND, check_memory, memory_need, remedy_for
from .ocean import Ocean
from .over_bed import OVER_BED_CHANNELS, mesh_over_bed, over_bed, with_whitecaps
from .placed_waves import placed_fields, placed_foam, without_placed
from .regions import TILE, Area, Tile

#: outputs that are no fields of a tile
_BESIDE = frozenset((PARTS, OVER_BED, AROUND))


class FrameSink(Protocol):
    """Stores frames; called from several threads at once."""

    @property
    def outputs(self) -> frozenset[str]:
        """The fields that a frame must have; with PARTS, also the summable fields of each part, and with
        OVER_BED those over the bed, where the tile is that of the open sea, and with AROUND those of waves
        that do not repeat, without which the tile then is."""

    def write(self, frame: Frame, fields: SurfaceFields, *others: SurfaceFields) -> tuple[Path, ...]:
        """Store a frame's fields: those of the first patch, of the others, of the parts, over the bed
        and around the camera. Returns where."""


class BakedFrame(NamedTuple):
    """A frame that has been stored.

    seconds : time taken, including foam
    """

    frame: Frame
    paths: tuple[Path, ...]
    seconds: float


class ShotSeas:
    """Computes the surfaces of a shot's frames on one thread; fastest for consecutive frames.

    on : where to compute them: on the tile of each patch, or in an area for their sum
    outputs : that will be requested. With OVER_BED the tile is that of the open sea, with AROUND it is
        without waves that do not repeat
    """

    def __init__(self, shot: Shot, on: Tile | Area = TILE, outputs: frozenset[str] = frozenset()) -> None:
        self.shot = shot
        self.on = on
        self._with_bed = OVER_BED in outputs
        self._is_around = AROUND in outputs
        self._sea: Ocean | None = None
        self._whole: Ocean | None = None

    def sea(self, frame: Frame) -> Ocean:
        """The sea of a frame; the previous one is reused if the parameters are the same."""
        parameters = self.shot.at(frame).parameters
        if self._with_bed:
            parameters = open_sea(parameters)
        if self._is_around:
            parameters = without_placed(parameters)
        if self._sea is None or self._sea.parameters != parameters:
            self._sea = Ocean(parameters, workers=1)
        return self._sea

    def whole(self, frame: Frame) -> Ocean:
        """The sea of a frame with its coast, of which the tile is not."""
        parameters = self.shot.at(frame).parameters
        if self._whole is None or self._whole.parameters != parameters:
            self._whole = Ocean(parameters, workers=1)
        return self._whole

    def over_bed(self, frame: Frame) -> SurfaceFields:
        """OVER_BED_CHANNELS of a frame at the places of the coast's mesh."""
        moment, whole = self.shot.at(frame), self.whole(frame)
        places = mesh_over_bed(whole)
        fields = over_bed(whole, places.x, places.y, moment.time)
        for name in OVER_BED_CHANNELS if moment.rate != 1.0 else ():
            if name in CHANNELS and CHANNELS[name].is_rate:
                fields[name] = fields[name] * np.float32(moment.rate)
        return SurfaceFields(float(moment.time), fields)

    def around(self, frame: Frame) -> SurfaceFields:
        """ADDING and foam in a frame, of the waves that do not repeat, in the square around the camera."""
        moment, square = self.shot.at(frame), self.shot.around
        assert square is not None
        area = Area(square.size, square.resolution, square.corner(frame))
        fields = placed_fields(moment.parameters, area, moment.time)
        for name in ADDING if moment.rate != 1.0 else ():
            if CHANNELS[name].is_rate:
                fields[name][...] *= moment.rate
        foam = placed_foam(moment.parameters, area, moment.time)
        return fields.including(SurfaceFields(fields.time, foam._asdict()))

    def with_whitecaps(self, frame: Frame, over_bed: SurfaceFields, tile: SurfaceFields) -> SurfaceFields:
        """What is over the bed, with the whitecaps of the open sea's tile."""
        whole = self.whole(frame)
        places = mesh_over_bed(whole)
        before = {name: over_bed[name] for name in OVER_BED_CHANNELS}
        whitecaps = Whitecaps(*(tile[name] for name in Whitecaps._fields))
        return SurfaceFields(over_bed.time, with_whitecaps(whole, before, places.x, places.y, whitecaps))

    def seas(self, frame: Frame) -> tuple[Ocean, ...]:
        """The seas whose fields make up a frame: each patch, or their sum in an area."""
        sea = self.sea(frame)
        return (sea,) if isinstance(self.on, Area) else sea.patches

    def prepare(self, frame: Frame, tell: Callable[[Frame, str], None]) -> None:
        """Compute the waves of a frame, which its surfaces share.

        tell : called repeatedly with the progress of those over a coast
        """
        for sea in (*self.seas(frame), *((self.whole(frame),) if self._with_bed else ())):
            sea.prepare(lambda done: tell(frame, f"waves over the coast's bed: {100.0 * done:.0f} %"))

    def frames(self, frame: Frame, outputs: Iterable[str]) -> tuple[SurfaceFields, ...]:
        """Fields of each of its seas in a frame, ADDING of each part if PARTS is requested, what is over the
        bed if OVER_BED is, without the open sea's whitecaps, and what is around the camera if AROUND is.

        Velocity is per second of the shot.
        """
        outputs = frozenset(outputs)
        made = self._made(frame, self.seas(frame), outputs - _BESIDE, self.on)
        if PARTS in outputs:
            made += self._made(frame, self.sea(frame).parts, ADDING, TILE)
        if OVER_BED in outputs:
            made += (self.over_bed(frame),)
        return (*made, self.around(frame)) if AROUND in outputs else made

    def _made(
        self, frame: Frame, seas: tuple[Ocean, ...], outputs: frozenset[str], on: Tile | Area
    ) -> tuple[SurfaceFields, ...]:
        moment: Moment = self.shot.at(frame)
        made = tuple(sea.surface(moment.time, outputs, on) for sea in seas)
        for name in outputs if moment.rate != 1.0 else ():
            if CHANNELS[name].is_rate:
                for fields in made:
                    fields[name][...] *= moment.rate
        return made

    def frame(self, frame: Frame, outputs: Iterable[str]) -> SurfaceFields:
        """Fields of a frame of a sea on one grid, or in an area. Raises ValueError for separate patches."""
        if self.shot.parameters.is_cascade and self.on == TILE:
            raise ValueError("this sea has several patches: their fields are those of frames()")
        (fields,) = self.frames(frame, outputs)
        return fields


def bake(
    shot: Shot,
    frames: Iterable[Frame],
    sink: FrameSink,
    workers: int = 1,
    tell: Callable[[Frame, str], None] = lambda frame, doing: None,
    on: Tile | Area = TILE,
) -> Iterator[BakedFrame]:
    """Compute and store frames, several at once; yields each in order once it is stored.

    Each worker computes a whole frame on one thread, so one can encode while another computes. Only the foam
    of a tile, which has a history, is computed here, in the order of the frames; foam in an area is computed
    from scratch in each frame. Results do not depend on the number of workers. When the caller stops, frames
    in progress are finished and no more are started.

    tell : called repeatedly with the progress of a frame
    on : where to compute the fields

    Raises MemoryError before the first frame if the machine has too little memory, and ValueError for fields
    that separate patches do not have.
    """
    _check(shot, sink, workers, on)
    with_bed = OVER_BED in sink.outputs
    with_memory = ShotSeas(shot, on, sink.outputs)
    wanted = _of_memory(shot, sink.outputs, on)
    own = threading.local()

    def make(frame: Frame, started: float, foam: SurfaceFields | None) -> BakedFrame:
        started += time.perf_counter()
        if not hasattr(own, "surfaces"):
            own.surfaces = ShotSeas(shot, on, sink.outputs)
        fields, *others = own.surfaces.frames(frame, sink.outputs - wanted)
        if foam is not None:
            fields = fields.including(foam)
            if with_bed:
                others[-1] = own.surfaces.with_whitecaps(frame, others[-1], foam)
        return BakedFrame(frame, sink.write(frame, fields, *others), time.perf_counter() - started)

    under_way: deque[Future[BakedFrame]] = deque()
    # frames are in ascending order: keep what they share, and drop the seas of past frames
    need = _need(shot, sink.outputs, on)
    with MEMO.at_most(need.state + workers * need.surface), ThreadPoolExecutor(workers) as pool:
        try:
            for frame in frames:
                begun = time.perf_counter()
                if not under_way:  # computed once, before the workers need it
                    with_memory.prepare(frame, tell)
                foam = _foam(with_memory, frame, wanted, tell) if wanted else None
                # do not count the wait for a worker
                under_way.append(pool.submit(make, frame, begun - time.perf_counter(), foam))
                if len(under_way) > workers:
                    yield under_way.popleft().result()
            while under_way:
                yield under_way.popleft().result()
        finally:
            for future in under_way:
                future.cancel()


def _of_memory(shot: Shot, outputs: frozenset[str], on: Tile | Area) -> frozenset[str]:
    """The fields of a tile with a history that outputs need."""
    if on != TILE or (OVER_BED in outputs and shot.parameters.is_cascade):
        return frozenset()  # of several tiles the sum has no foam
    return OF_MEMORY if OVER_BED in outputs else outputs & OF_MEMORY


def _foam(
    surfaces: ShotSeas, frame: Frame, wanted: frozenset[str], tell: Callable[[Frame, str], None]
) -> SurfaceFields:
    for patch in surfaces.sea(frame).patches:
        patch.foam_history.tell = lambda done, count: tell(
            frame, f"foam: looked back at {done} of {count} moments"
        )
    return surfaces.frame(frame, wanted)


def _need(shot: Shot, outputs: frozenset[str], on: Tile | Area) -> MemoryNeed:
    """Memory for the frames of a shot."""
    need = memory_need(shot.parameters, outputs, on=on)
    if AROUND not in outputs or shot.around is None:
        return need
    return replace(need, surface=need.surface + A_SAMPLE_AROUND * shot.around.resolution**2)


def _check(shot: Shot, sink: FrameSink, workers: int, on: Tile | Area) -> None:
    """Raise for a shot that cannot be baked, or not on this machine."""
    parameters = shot.parameters
    is_cascade = parameters.is_cascade and on == TILE
    if is_cascade and parameters.is_masked:
        raise ValueError(
            "masks: they lie over the sea, not over its patches, which repeat: merge the patches"
        )
    if is_cascade and not sink.outputs <= ADDING | _BESIDE:
        others = ", ".join(sorted(sink.outputs - ADDING - _BESIDE))
        raise ValueError(f"outputs = {others}: do not add up over patches; bake {', '.join(sorted(ADDING))}")
    need = _need(shot, sink.outputs, on).peak(workers)
    samples = on.resolution if isinstance(on, Area) else parameters.resolution
    check_memory(need, f"Baking {samples}² samples with {workers} workers", remedy_for(parameters, need))
