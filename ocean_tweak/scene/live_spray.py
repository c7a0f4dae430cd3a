# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray that an ocean wants live: around the camera of a sea of patches, else on the sea's own tile."""

from __future__ import annotations

import dataclasses
import math
import threading
from dataclasses import dataclass
from fractions import Fraction

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import Ocean, OceanParameters
from ..core.numerics.memo import MEMO
from ..core.parameters.spray import Spray
from ..core.sea.placed_waves import is_seen_around, repeating
from ..core.sea.spray import CameraSpray, TileSpray, above_bed
from ..core.sea.spray_outlook import why_none
from ..core.spray.columns import columns
from ..core.spray.particles import Particles
from . import water_material
from .plan import Plan, camera_place, camera_surface_of, scene_camera_place
from .units import frame_rate

_KIND = "spray"
#: of all particles, those that a window shows, as much larger
IN_WINDOW = 0.125
#: s after the spray that was made last, within which the next one is quickly made
_IS_NEAR = Fraction(1)

Place = tuple[float, float]


class _Maker:
    """Spray of a sea, and of which time and where it was made last."""

    def __init__(self, sea: OceanParameters, is_around: bool) -> None:
        self._source = CameraSpray.of(sea) if is_around else TileSpray(Ocean(sea))
        self._last: tuple[Fraction, Place] | None = None
        self._busy = threading.Lock()

    @property
    def nbytes(self) -> int:
        """Bytes of the crests that are remembered."""
        return self._source.nbytes

    def at(self, time: Fraction, spray: Spray, place: Place) -> Particles:
        """All that is in the air at a time. It may be called on any thread."""
        with self._busy:
            if isinstance(self._source, TileSpray):
                made = self._source.at(time, spray)
            else:
                made = self._source.at(time, spray, place)
            self._last = time, place
        return made

    def is_near(self, time: Fraction, place: Place) -> bool:
        """Whether the spray of a time around a place is quickly made: nobody is making any now, and what was
        made last is a little older, in the same squares of cells."""
        if self._last is None or self._busy.locked():
            return False
        last, there = self._last
        is_there = isinstance(self._source, TileSpray) or self._source.is_there(place, there)
        return is_there and 0 <= time - last <= _IS_NEAR


@dataclass(frozen=True)
class Wanted:
    """Spray that is wanted of an ocean at a time in s, that of a whole frame.

    sea : whose crests break
    place : x and y of the camera, in the ocean's space, m
    is_around : whether it is made around the camera, and not on the sea's own tile
    repeats : of the tile along x and y; 0 where it goes on to the horizon
    ends : whether the coast is shown by its mesh, which ends beside the bed
    """

    sea: OceanParameters
    time: Fraction
    spray: Spray
    place: Place
    is_around: bool
    repeats: tuple[int, int]
    ends: bool

    @property
    def is_near(self) -> bool:
        """Whether it is quickly made."""
        maker = MEMO.find(_KIND, (self.sea, self.is_around))
        return maker is not None and maker.is_near(self.time, self.place)

    def make(self) -> Particles:
        """Make it; touches no data of Blender and may run on any thread."""
        key = self.sea, self.is_around
        maker = MEMO.get(_KIND, key, lambda: _Maker(*key))
        made = maker.at(self.time, self.spray, self.place)
        MEMO.put(_KIND, key, maker)  # it has grown
        return above_bed(made, self.sea) if self.ends else made

    def columns(self) -> NDArray[np.float32]:
        """Columns of the particles, each where it is nearest to the camera, of all places where the tile is
        shown."""
        values = columns(self.make())
        if self.is_around:
            return values
        side = self.sea.domain_size
        for axis, (camera, repeats) in enumerate(zip(self.place, self.repeats, strict=True)):
            number = np.rint((camera - values[:, axis]) / side)
            if repeats:
                number = np.clip(number, 0, repeats - 1)
            values[:, axis] += side * number
        return values


def wanted(
    ocean: bpy.types.Object, plan: Plan, scene: bpy.types.Scene, is_rendered: bool = False
) -> Wanted | None:
    """The spray that an ocean wants; None where there is none.

    is_rendered : whether all particles are wanted, which without a window always are
    """
    spray, share = plan.whole.spray, 1.0 if is_rendered or bpy.app.background else IN_WINDOW
    if spray is None or why_none(plan.whole) is not None or spray.amount == 0.0:
        return None
    shown = dataclasses.replace(spray, amount=spray.amount * share, size=min(spray.size / share**0.5, 1.0))
    surface = camera_surface_of(ocean)
    is_around = plan.over_bed is not None or (surface is not None and is_seen_around(plan.whole))
    # a tile has no waves that do not repeat
    sea = plan.whole if is_around else repeating(plan.parameters)
    goes_on = surface is not None or any(water_material.is_far(child) for child in ocean.children)
    repeats = (0, 0) if goes_on else plan.render.repeats
    place, ends = _place(ocean, surface, plan, scene), plan.over_bed is not None and surface is None
    return Wanted(sea, _time(plan, scene), shown, place, is_around, repeats, ends)


def _time(plan: Plan, scene: bpy.types.Scene) -> Fraction:
    """The ocean's time at the whole frame that is nearest: from there the nodes move spray."""
    since = plan.frame - math.floor(plan.frame + Fraction(1, 2))
    return plan.time - Fraction(plan.rate) * since / frame_rate(scene)


def _place(
    ocean: bpy.types.Object, surface: bpy.types.Object | None, plan: Plan, scene: bpy.types.Scene
) -> Place:
    if surface is not None:
        return camera_place(surface, scene, plan.scale)
    return scene_camera_place(ocean, scene, plan.scale)
