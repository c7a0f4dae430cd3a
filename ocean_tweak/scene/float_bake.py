# SPDX-License-Identifier: GPL-3.0-or-later
"""Floating baked to keyframes, one frame after another."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import ExitStack
from dataclasses import dataclass, field

import bpy
from mathutils import Matrix

from ..core.sea.felt_water import Felt, felt
from . import contact, float_carrier, float_keys, float_riding, floating, handlers
from .animated import shown_settings
from .floating import FloatError, Ride
from .floating_place import Water, place_on, water_at
from .hull import Hull
from .plan import plan_for
from .units import frame_rate, metres_per_unit, time_stretch
from .view_layers import evaluated, taking_part


@dataclass(frozen=True)
class _Rider:
    """An object that is being baked.

    place : has the object's transform without waves; its carrier, or a temporary empty
    was_live : whether it is its carrier
    hull : of the object, if the water is to touch it
    level : height of the water above its origin
    track : where the object was so far
    felt : of a damped one on a sequence: the water so far
    """

    item: bpy.types.Object
    place: bpy.types.Object
    was_live: bool
    ocean: bpy.types.Object
    ride: Ride
    hull: Hull | None
    level: float
    track: float_keys.Track
    felt: list[Felt] = field(default_factory=list)


class FloatBake:
    """A bake in steps of one frame, which can be cancelled.

    Objects that already float keep their ocean, ride and collar; others get the given ones. Keys are written
    by `finish`, after `advance` was called once for each of `frames`; `cancel` restores everything. The
    scene's frame is changed, so that parents, animation and the ocean's settings are those of each frame.

    Raises FloatError for objects that cannot float, and OceanObjectError or ParameterError for an ocean
    without a surface.
    """

    def __init__(
        self,
        scene: bpy.types.Scene,
        items: Iterable[bpy.types.Object],
        ocean: bpy.types.Object,
        ride: Callable[[bpy.types.Object], Ride],
        frames: range,
        is_wet: bool = False,
    ) -> None:
        chosen = floating.outermost(items)
        for item in chosen:
            floating.check(item, ocean)
        if not len(frames):
            raise FloatError("The first frame lies after the last one")
        self.frames, self.steps, self.done = frames, len(frames), 0
        self._scene, self._frame = scene, (scene.frame_current, scene.frame_subframe)
        self._riders = [self._begin(item, ocean, ride(item), is_wet) for item in chosen]
        self._taking_part = ExitStack()
        needed = {rider.ocean for rider in self._riders} | {rider.place for rider in self._riders}
        self._taking_part.enter_context(taking_part(scene, *needed))

    def _begin(self, item: bpy.types.Object, ocean: bpy.types.Object, ride: Ride, is_wet: bool) -> _Rider:
        carrier = float_carrier.carrier_of(item)
        if carrier is None:
            hull = floating.own_hull(item) if is_wet else None
            level, place = floating.level_at(item, ocean, ride), float_carrier.stand_in(item)
            return _Rider(item, place, False, ocean, ride, hull, level, float_keys.Track(item))
        known, ride = floating.ride_of(carrier)
        return _Rider(item, carrier, True, known or ocean, ride, None, 0.0, float_keys.Track(item))

    def advance(self) -> None:
        """Process one frame. Raises the errors of missing or broken images."""
        frame = self.frames[self.done]
        with handlers.asleep():  # waves in the viewport are not needed
            self._scene.frame_set(frame)
            depsgraph = evaluated(self._scene)
        metres = float(metres_per_unit(self._scene))
        waters: dict[bpy.types.Object, Water] = {}
        for rider in self._riders:
            if rider.ocean not in waters:
                waters[rider.ocean] = water_at(rider.ocean, self._scene, depsgraph, frame)
            water = waters[rider.ocean]
            places = [each.evaluated_get(depsgraph).matrix_world for each in (rider.place, rider.ocean)]
            solved = self._solved(rider, water, *places, depsgraph)
            rider.track.add(place_on(water, *places, rider.ride, metres, solved))
        self.done += 1

    def _solved(
        self, rider: _Rider, water: Water, place: Matrix, ocean: Matrix, depsgraph: bpy.types.Depsgraph
    ) -> float_riding.Solved | None:
        """Where a damped hull is: on a live sea from all of its past, on a sequence from what was baked; and
        where any is over a bed. None for one that is on the surface of the water.
        """
        scene, settings = self._scene, shown_settings(rider.ocean, depsgraph)
        plan = plan_for(rider.ocean, settings, scene)
        if settings.source == "LIVE":
            if not float_riding.is_solved(plan, rider.ride):
                return None
            at = float_riding.place_of(rider.place, depsgraph, plan.frame / time_stretch(scene))
            return float_riding.solve(plan, rider.ride, ocean, scene, at)
        if not float_riding.can_ride(rider.ride):
            return None
        under = float_riding.footprint(place, ocean, rider.ride, float(plan.metres))
        under = float_riding.gone_along(under, water.come)
        rider.felt.append(felt(under, water.carried, lambda x, y: water.surface(x, y)[0]))
        seconds, gravity = 1 / frame_rate(scene), plan.parameters.water.gravity
        return float_riding.solve_by_frames(rider.felt, seconds, rider.ride, under, gravity)

    def finish(self) -> int:
        """Write the keys, and stop live floating. Returns the number of objects."""
        stretch = time_stretch(self._scene)
        self._clear()
        for rider in self._riders:
            floating.take_off(rider.item)
            if rider.hull is not None:
                contact.touch(rider.item, rider.ocean, rider.hull, rider.level)
            rider.track.write(self.frames[0] / stretch, 1 / stretch)
        self._go_back()
        return len(self._riders)

    def cancel(self) -> None:
        """Restore everything."""
        self._clear()
        self._go_back()

    def abandon(self) -> None:
        """Nothing runs in the background."""

    def _clear(self) -> None:
        self._taking_part.close()
        for rider in self._riders:
            if not rider.was_live:
                bpy.data.objects.remove(rider.place)

    def _go_back(self) -> None:
        frame, subframe = self._frame
        self._scene.frame_set(frame, subframe=subframe)
