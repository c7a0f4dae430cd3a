# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam around or in front of the camera: points that the surface around the camera reads.

Rings are used in the viewport, where they have few places, and around a camera that looks down. Renders use a
fan, which is as dense as the pixels.

Renders wait for it. In the viewport, the history of another moment or place is computed in the background;
until then only breaking crests have foam.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import OceanParameters
from ..core.foam.model import Whitecaps
from ..core.foam.threshold import foam_outlook
from ..core.numerics.memo import MEMO
from ..core.sea.foam_fan import Fan, FoamFan, View
from ..core.sea.foam_levels import FINEST, FoamLevels
from ..core.sea.foam_rings import FoamRings, Place, Rings, samples_for
from ..core.sea.placed_waves import Afloat, is_seen_around, makes_foam, repeating, with_own_foam
from ..nodes.camera_foam import RING_FOAM
from ..nodes.modifier_inputs import get_input
from .camera_view import view_of
from .patch_points import Points
from .plan import Plan, camera_place, sea_over_bed, surface_modifier
from .units import time_stretch

# s after the foam that was made last, within which the next one is quickly made
_IS_NEAR = Fraction(1)
# of a window's first ring, that a camera may be away from its middle before rings follow it
_FOLLOWS = 1 / 6
_RINGS = "foam rings"


class _Shown(NamedTuple):
    """Rings of a window.

    time : s, that they are of
    place : around which they lie
    samples : along each side
    """

    time: Fraction
    place: Place
    samples: int

    def leads_to(self, other: _Shown) -> bool:
        """Whether others, around the same place, are quickly made after these."""
        return self.samples == other.samples and 0 <= other.time - self.time <= _IS_NEAR


class _Maker:
    """The foam of a sea: its fan, its rings, those of a window, and around which place these lie: it drifts
    along."""

    def __init__(self, parameters: OceanParameters, far: bool) -> None:
        self._key = parameters, far
        self._levels = FoamLevels(parameters, far)
        self._whole = FoamRings(self._levels)
        self._few: FoamRings | None = None
        self._fan: FoamFan | None = None
        self._shown: _Shown | None = None
        self._busy = threading.Lock()

    @property
    def nbytes(self) -> int:
        """Bytes of the rings and the fan."""
        made = (self._whole, self._few, self._fan)
        return sum(each.nbytes for each in made if each is not None)

    def before(self, time: Fraction, view: View, places: int) -> Fan:
        """The fan before a camera, with its history."""
        with self._busy:
            if self._fan is None or self._fan.places != places:
                self._fan = FoamFan(self._levels, places)
            made = self._fan.at(time, view)
        MEMO.put(_RINGS, self._key, self)  # it has grown
        return made

    def at(self, time: Fraction, place: Place) -> Rings:
        """Rings around a place, with their history."""
        with self._busy:
            made = self._whole.at(time, place)
        MEMO.put(_RINGS, self._key, self)  # it has grown
        return made

    def follow(self, wanted: _Shown, told: Callable[[float], None]) -> None:
        """Make a window's rings around another place or moment, and only then let go of those it shows.

        told : hears the share that is made
        """
        rings = FoamRings(self._levels, wanted.samples)
        rings.at(wanted.time, wanted.place, told=told)
        with self._busy:
            self._few, self._shown = rings, wanted

    def at_once(self, wanted: _Shown) -> tuple[Rings, bool]:
        """A window's rings, quickly made, and whether they are those of the time and around the place."""
        led = self._led_to(wanted)
        if led is None:
            alone = FoamRings(self._levels, wanted.samples)
            return alone.at(wanted.time, wanted.place, history=False), False
        made, last = led
        MEMO.put(_RINGS, self._key, self)  # it has grown
        return made, math.dist(last.place, wanted.place) <= _FOLLOWS * last.samples * FINEST

    def _led_to(self, wanted: _Shown) -> tuple[Rings, _Shown] | None:
        """Rings that follow the window's, and these; None where none do, or while a thread makes some."""
        if not self._busy.acquire(blocking=False):
            return None
        try:
            few, last = self._few, self._shown
            if few is None or last is None or not last.leads_to(wanted):
                return None
            made = few.at(wanted.time, last.place)
            self._shown = last._replace(time=wanted.time)
            return made, last
        finally:
            self._busy.release()


@dataclass(frozen=True)
class Around:
    """Foam that is wanted around a camera.

    sea : of several patches
    whole : the same with layers that make foam of their own
    time : s
    place : of the camera
    view : of one that is turned towards the horizon
    vertices : of the surface, at the most
    in_window : of the surface in a window
    frame : of the scene, in which it is shown
    scale : Blender units in a metre
    afloat : what is left of hulls' foam over a bed; None on the open sea
    """

    sea: OceanParameters
    whole: OceanParameters
    time: Fraction
    place: Place
    view: View | None
    vertices: int
    in_window: int
    frame: float
    scale: float
    afloat: Afloat | None

    def write(self, mesh: bpy.types.Mesh, patient: bool) -> bool:
        """Put it on the points of a mesh; returns whether it is all that it will be.

        patient : otherwise it is shown without its history where that would take long
        """
        if not patient and MEMO.find(_RINGS, self._key) is None:
            return False  # what rings there are takes longer to find than the foam on them
        maker = self._maker
        if patient and self.view is not None:
            _fill_fan(mesh, maker.before(self.time, self.view, self.vertices), self)
            return True
        if patient:
            rings, is_complete = maker.at(self.time, self.place), True
        else:
            rings, is_complete = maker.at_once(self._in_window)
        _fill(mesh, rings, self)
        return is_complete

    def make(self, told: Callable[[float], None]) -> None:
        """Let it be quickly made from now on; touches no data of Blender and may run on any thread.

        told : hears the share that is made, 0…1
        """
        self._maker.follow(self._in_window, told)

    def values(self, foam: Whitecaps, x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float32]:
        """(places, 3) foam, breaking and age at places in m: the waves', and that of hulls."""
        of_waves = Whitecaps(*(np.ravel(field) for field in foam))
        found = with_own_foam(self.whole, of_waves, np.ravel(x), np.ravel(y), self.time, self.afloat)
        return np.stack(found, axis=-1).astype(np.float32, copy=False)

    @property
    def _key(self) -> tuple[OceanParameters, bool]:
        """What the foam of the waves follows from: the sea, and whether that of hulls is seen farther off."""
        return self.sea, makes_foam(self.whole)

    @property
    def _maker(self) -> _Maker:
        return MEMO.get(_RINGS, self._key, lambda: _Maker(*self._key))

    @property
    def _in_window(self) -> _Shown:
        return _Shown(self.time, self.place, samples_for(min(self.in_window, self.vertices)))


def around(
    surface: bpy.types.Object, plan: Plan, points: Points | None, scene: bpy.types.Scene
) -> Around | None:
    """The foam that a surface around a camera wants; None where there is none, or a mesh's own is all.

    plan, points : of the ocean and of its bake, if it has one
    """
    sea, time = (plan.parameters, plan.time) if points is None else points.moment[:2]
    sea, whole = repeating(sea), plan.whole
    has_foam = "foam" in plan.channels and (foam_outlook(sea).coverage > 0.0 or makes_foam(whole))
    if not (has_foam and is_seen_around(whole)):
        return None
    place = Place(*camera_place(surface, scene, plan.scale))
    budgets = (
        get_input(surface_modifier(surface), name) for name in ("Vertex Budget", "Viewport Vertex Budget")
    )
    frame = float(plan.frame / time_stretch(scene))
    view, coast = view_of(surface, scene, plan.scale), None
    if plan.over_bed is not None and makes_foam(whole):
        coast = sea_over_bed(plan).coast
    afloat = None if coast is None else coast.afloat
    return Around(sea, whole, time, place, view, *budgets, frame, plan.scale, afloat)


def _fill(mesh: bpy.types.Mesh, rings: Rings, shown: Around) -> None:
    """Points ring after ring, x fastest, and the one beyond them, at x = the frame of the scene, z = the
    places along each side of a ring."""
    samples = len(rings.foam[0].foam)
    places = np.zeros((len(rings.foam) * samples**2 + 1, 3), np.float32)
    values = np.empty_like(places)
    along = np.arange(samples)
    for number, (corner, foam) in enumerate(zip(rings.corners, rings.foam, strict=True)):
        block = slice(number * samples**2, (number + 1) * samples**2)
        x, y = np.meshgrid(*(first + FINEST * 2.0**number * along for first in corner))
        places[block, 0], places[block, 1] = shown.scale * x.ravel(), shown.scale * y.ravel()
        values[block] = shown.values(foam, x, y)
    values[-1], places[-1] = rings.beyond, (shown.frame, 0.0, samples)
    _write(mesh, places, values)


def _fill_fan(mesh: bpy.types.Mesh, fan: Fan, shown: Around) -> None:
    """Points row after row, with the size of the cells as z, and one more, at x = the frame of the scene, y =
    the number of columns."""
    last = shown.frame, fan.x.shape[1], 0.0
    places = shown.scale * np.stack((fan.x, fan.y, fan.size), axis=-1).reshape(-1, 3)
    values = shown.values(fan.foam, fan.x, fan.y)
    _write(mesh, np.append(places, [last], 0).astype(np.float32), np.append(values, values[-1:], 0))


def _write(mesh: bpy.types.Mesh, places: NDArray[np.float32], values: NDArray[np.float32]) -> None:
    """Places in Blender units, and foam, breaking and age there; (points, 3) each."""
    if len(mesh.vertices) != len(places):
        mesh.clear_geometry()
        mesh.vertices.add(len(places))
    mesh.attributes["position"].data.foreach_set("vector", places.reshape(-1))
    attribute = mesh.attributes.get(RING_FOAM) or mesh.attributes.new(RING_FOAM, "FLOAT_VECTOR", "POINT")
    attribute.data.foreach_set("vector", values.reshape(-1))
    mesh.update_tag()
