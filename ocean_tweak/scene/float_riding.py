# SPDX-License-Identifier: GPL-3.0-or-later
"""Hulls that ride damped: where each is at the frame that is shown, from what it felt of the sea before.

And hulls over a bed, damped or not: the waves that nodes see are those of the open sea.

Nodes see one frame only, so this is worked out here and given to the carrier, with the frame for which it
holds. Of the past only moments are asked for that frames share, and what a hull felt then is kept: a frame
more needs the water at one moment of each mode or none. In a window, a hull that is moved by hand follows the
surface until the hand rests.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import cache
from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Matrix, Vector
from numpy.typing import NDArray

from ..core import OceanParameters, ParameterError
from ..core.numerics.memo import MEMO
from ..core.sea.felt_water import Felt, FeltWater, Footprint, felt_sea
from ..core.sea.placed_waves import without_placed
from ..core.sea.riding import LEAST_DAMPING, Moments, Oscillator, moments, natural_periods, ride
from ..nodes.floating import CARRIER
from ..nodes.modifier_inputs import all_inputs, get_input
from ..nodes.versioned import is_of_kind
from . import float_carrier, float_path
from .animated import is_animated, shown_settings
from .float_current import come
from .floating import Ride, ride_of
from .plan import Plan, plan_for
from .settings import OceanObjectError, is_ocean, oceans_in, settings_of
from .units import frame_rate, time_stretch

Array = NDArray[np.float64]

#: of MEMO
_FELT = "water that hulls felt"
MEMO.limit(_FELT, 16)
#: digits of m and of rad below which two places are one
_DIGITS = 3, 5
#: m, half of the size of what follows the surface at a point of a bed's waves
_POINT = 0.25
#: s before a frame at which keys that were changed are noticed
_LOOKS = (0, 1, 3, 10, 30)
#: s that a hand must rest
_PAUSE = 0.25
#: of a carrier to which nothing is given
_NEVER = -1e6

# by the session uid of a carrier: what the place that it has follows from
_known: dict[int, object] = {}


class Solved(NamedTuple):
    """Where a hull is: height in m, slopes along x and y, and m off its place, in the ocean's space."""

    height: float
    slope_x: float
    slope_y: float
    off_x: float = 0.0
    off_y: float = 0.0


def can_ride(ride: Ride) -> bool:
    """Whether a ride is damped, of something that has a size."""
    return ride.damped and ride.waterline > 0.0


def is_solved(plan: Plan, ride: Ride) -> bool:
    """Whether a hull on a live sea is where it is solved to be, and not where nodes find the surface."""
    return can_ride(ride) or plan.over_bed is not None


def why_not(carrier: bpy.types.Object) -> str:
    """Why a carrier that shall ride damped does not, or not as it should; "" where all is well."""
    ocean, ride = ride_of(carrier)
    if ride.waterline <= 0.0:
        return "Follows the surface: set Waterline to its length"
    if ocean is not None and is_ocean(ocean) and settings_of(ocean).source != "LIVE":
        return "Follows the surface: on a baked ocean only Bake to Keyframes rides damped"
    if not float_path.is_known(carrier):
        if float_path.recorded(carrier) is not None:
            return "Its past is recorded: press Float on Ocean again after a change"
        return "Its past is not known from keys: press Float on Ocean again to record it"
    return ""


def undamped(ocean: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """What shall ride damped on an ocean and follows the surface, as that is baked."""
    if settings_of(ocean).source == "LIVE":
        return
    for carrier in _solved():
        its_ocean, ride = ride_of(carrier)
        if its_ocean == ocean and can_ride(ride):
            yield from float_carrier.carried_by(carrier)


def footprint(place: Matrix, ocean: Matrix, ride: Ride, metres: float) -> Footprint:
    """The waterline of what is at a place, both matrices being those in the world.

    metres : in a Blender unit
    """
    to_ocean = ocean.inverted_safe() @ place
    turned = to_ocean.to_3x3()
    size = 0.5 * metres * (turned @ Vector((1.0, 0.0, 0.0))).length
    ahead = turned @ Vector((0.0, 1.0, 0.0) if ride.along_y else (1.0, 0.0, 0.0))
    beam = ride.beam if ride.beam > 0.0 else ride.waterline
    return Footprint(
        round(to_ocean.translation.x * metres, _DIGITS[0]),
        round(to_ocean.translation.y * metres, _DIGITS[0]),
        round(math.atan2(ahead.y, ahead.x), _DIGITS[1]),
        round(ride.waterline * size, _DIGITS[1]),
        round(beam * size, _DIGITS[1]),
        ride.drift,
        ride.damped and max(ride.surge_period, ride.sway_period) > 0.0,
    )


def gone_along(place: Footprint, way: tuple[float, float]) -> Footprint:
    """A waterline as far along with a current, which has come that way in m, as it drifts."""
    x, y = (
        round(own + place.drift * along, _DIGITS[0])
        for own, along in zip((place.x, place.y), way, strict=True)
    )
    return place._replace(x=x, y=y)


def modes_of(ride: Ride, place: Footprint, gravity: float) -> tuple[Oscillator | None, ...]:
    """Heave, pitch and roll, with the periods that are set, or else those of the size; and surge and sway,
    which there are where they have a period.

    A damping that a script set beyond its range is the end of that range.
    """
    length, beam = 2.0 * place.half_length, 2.0 * place.half_beam
    scale = length / ride.waterline
    draft = ride.draft * scale if ride.draft > 0.0 else beam / 3.0
    of_size = natural_periods(max(length, beam), min(length, beam), draft, gravity)
    heave, pitch, roll = (
        given if given > 0.0 else own
        for given, own in zip((ride.heave_period, ride.pitch_period, ride.roll_period), of_size, strict=True)
    )
    damping, roll_damping = (
        min(max(share, LEAST_DAMPING), 1.0) for share in (ride.damping, ride.roll_damping)
    )
    aside = (
        Oscillator(period, damping) if period > 0.0 else None
        for period in (ride.surge_period, ride.sway_period)
    )
    return Oscillator(heave, damping), Oscillator(pitch, damping), Oscillator(roll, roll_damping), *aside


def in_ocean(along: Sequence[float], place: Footprint) -> Solved:
    """Height, slopes and way, of which these are along a hull and across it, in the ocean's axes."""
    height, slope, heel, surge, sway = along
    cosine, sine = math.cos(place.heading), math.sin(place.heading)
    return Solved(
        height, slope * cosine - heel * sine, slope * sine + heel * cosine, surge * cosine - sway * sine,
        surge * sine + sway * cosine,
    )  # fmt: skip


def solve(
    plan: Plan,
    ride_of_hull: Ride,
    ocean: Matrix,
    scene: bpy.types.Scene,
    place_at: Callable[[Fraction], Matrix],
) -> Solved:
    """Where a hull is on a live sea at the frame of a plan; one that is not damped is on the surface.

    place_at : its place on land, in the world, at a frame of the animation
    """
    metres, stretch = float(plan.metres), time_stretch(scene)

    def lies(time: Fraction) -> Footprint:
        since = (plan.time - time) / Fraction(plan.rate) * frame_rate(scene) if plan.rate else Fraction(0)
        place = footprint(place_at((plan.frame - since) / stretch), ocean, ride_of_hull, metres)
        return gone_along(place, come(plan.parameters.current, float(time)))

    now = lies(plan.time)
    sea = _sea_of(plan, now)
    felt = MEMO.get(_FELT, sea, lambda: FeltWater(sea))
    if can_ride(ride_of_hull):
        water = cache(lambda time: felt.at(time, lies(time)))  # modes have moments in common
        along = []
        for number, mode in enumerate(modes_of(ride_of_hull, now, plan.parameters.water.gravity)):
            if mode is None:
                along.append(0.0)
                continue
            known = moments(plan.time, mode)
            forcing = np.array([water(time)[number] for time in known.times])
            along.append(ride(forcing, known, plan.time, mode))
        found = in_ocean(along, now)
    else:
        half = max(now.half_length, _POINT)
        on_surface = now._replace(half_length=half, half_beam=half, sways=False)
        found = in_ocean(felt.at(plan.time, on_surface), now)
    MEMO.put(_FELT, sea, felt)  # it has grown
    return found


def solve_by_frames(
    felt: list[Felt], seconds: Fraction, ride_of_hull: Ride, place: Footprint, gravity: float
) -> Solved:
    """Where a hull is after it felt these waters, one a frame; before the first it lay on it at rest.

    seconds : between them
    """
    modes = modes_of(ride_of_hull, place, gravity)
    count = max(len(felt), math.ceil(max(mode.memory for mode in modes if mode) / float(seconds)))
    known = Moments(seconds, range(-count, 2))
    # the next one is not known, and not needed
    water = np.array([felt[0]] * (count + 1 - len(felt)) + felt + [felt[-1]])
    along = [
        ride(water[:, number], known, Fraction(0), mode) if mode else 0.0 for number, mode in enumerate(modes)
    ]
    return in_ocean(along, place)


def _sea_of(plan: Plan, place: Footprint) -> OceanParameters:
    """The same sea on as many samples as a hull feels, and over its bed on all of them."""
    # without what hulls make, or it would lie in the dent that it makes itself
    if plan.over_bed is not None:
        return without_placed(plan.over_bed)
    return felt_sea(plan.parameters, 2.0 * min(place.half_beam, place.half_length))


def follow_before_frame(scene: bpy.types.Scene) -> None:
    """Let hulls be where they are at the frame that the scene is about to evaluate."""
    for carrier in _solved():
        ocean, ride = ride_of(carrier)
        if ocean is not None and not is_animated(ocean) and float_path.is_known(carrier):
            _give(carrier, ocean, ride, scene, None)


def follow_after_frame(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None) -> None:
    """As `follow_before_frame`, of oceans that are animated and hulls that something else than keys moves."""
    for carrier in _solved():
        ocean, ride = ride_of(carrier)
        if ocean is not None and (is_animated(ocean) or not float_path.is_known(carrier)):
            _give(carrier, ocean, ride, scene, depsgraph)


def follow_by_hand(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None) -> None:
    """Let hulls be where they are, whatever was moved or set."""
    in_window = not bpy.app.background and (depsgraph is None or depsgraph.mode == "VIEWPORT")
    for carrier in _solved():
        ocean, ride = ride_of(carrier)
        if ocean is None:
            continue
        if not in_window or not ride.damped:
            _give(carrier, ocean, ride, scene, depsgraph)
        elif _reasons(carrier, ocean, ride, scene, depsgraph) != _known.get(carrier.session_uid):
            float_carrier.set_inputs(carrier, {"Solved Frame": _NEVER})
            _wait()


def forget_all() -> None:
    """Another file is opened."""
    _known.clear()
    if bpy.app.timers.is_registered(_after_pause):
        bpy.app.timers.unregister(_after_pause)


def _wait() -> None:
    if bpy.app.timers.is_registered(_after_pause):
        bpy.app.timers.unregister(_after_pause)
    bpy.app.timers.register(_after_pause, first_interval=_PAUSE)


def _after_pause() -> None:
    for carrier in _solved():
        ocean, ride = ride_of(carrier)
        if ocean is not None:
            _give(carrier, ocean, ride, bpy.context.scene, bpy.context.evaluated_depsgraph_get())


def _solved() -> Iterator[bpy.types.Object]:
    """The carriers of this file that are told where they are, or were and are to be told no longer."""
    if not any(is_of_kind(group, CARRIER) for group in bpy.data.node_groups):
        return
    for item in list(bpy.data.objects):
        if item.library is None and float_carrier.is_carrier(item):
            ocean, ride = ride_of(item)
            over_bed = ocean is not None and is_ocean(ocean) and settings_of(ocean).coast.use
            told = all_inputs(float_carrier.modifier_of(item)).get("Solved Frame", _NEVER)
            if ride.damped or over_bed or told != _NEVER:
                yield item


class _Reasons(NamedTuple):
    """What a hull's place at a frame follows from.

    ocean, places : matrices, of the hull now and some seconds before
    """

    plan: Plan
    ride: Ride
    ocean: tuple[tuple[float, ...], ...]
    places: tuple[tuple[tuple[float, ...], ...], ...]


def _reasons(
    carrier: bpy.types.Object,
    ocean: bpy.types.Object,
    ride: Ride,
    scene: bpy.types.Scene,
    depsgraph: bpy.types.Depsgraph | None,
) -> _Reasons | None:
    """None where a hull follows the surface that nodes see, as on a sea that is not live."""
    if ocean not in oceans_in(scene) or not (can_ride(ride) or settings_of(ocean).coast.use):
        return None
    settings = shown_settings(ocean, depsgraph)
    if settings.source != "LIVE":
        return None
    try:
        plan = plan_for(ocean, settings, scene)
    except (ParameterError, OceanObjectError):
        return None  # the ocean tells
    if not is_solved(plan, ride):
        return None
    fps, stretch = frame_rate(scene), time_stretch(scene)
    at = place_of(carrier, depsgraph, plan.frame / stretch)
    places = [at((plan.frame - seconds * fps) / stretch) for seconds in _LOOKS]
    return _Reasons(plan, ride, _plain(ocean.matrix_world), tuple(map(_plain, places)))


def _plain(matrix: Matrix) -> tuple[tuple[float, ...], ...]:
    return tuple(map(tuple, matrix))


def place_of(
    carrier: bpy.types.Object, depsgraph: bpy.types.Depsgraph | None, frame: Fraction
) -> Callable[[Fraction], Matrix]:
    """By the frame of the animation: as keys say, or as it was recorded; else always where it is at one."""
    if float_path.is_known(carrier):
        return lambda frame: float_path.matrix_at(carrier, float(frame))
    there = (carrier if depsgraph is None else carrier.evaluated_get(depsgraph)).matrix_world.copy()
    return float_path.past_of(carrier, there, frame) or (lambda _frame: there)


def _give(
    carrier: bpy.types.Object,
    ocean: bpy.types.Object,
    ride: Ride,
    scene: bpy.types.Scene,
    depsgraph: bpy.types.Depsgraph | None,
) -> None:
    """Tell a carrier where its hull is, or that it follows the surface."""
    reasons, uid = _reasons(carrier, ocean, ride, scene, depsgraph), carrier.session_uid
    if reasons is None:
        _known.pop(uid, None)
        _set(carrier, Solved(0.0, 0.0, 0.0), 1.0, _NEVER)
        return
    if _known.get(uid) == reasons:
        return
    plan = reasons.plan
    at = place_of(carrier, depsgraph, plan.frame / time_stretch(scene))
    found = solve(plan, ride, ocean.matrix_world, scene, at)
    _known[uid] = reasons
    _set(carrier, found, plan.scale, float(plan.frame))


def _set(carrier: bpy.types.Object, solved: Solved, scale: float, frame: float) -> None:
    modifier, (height, slope_x, slope_y, x, y) = float_carrier.modifier_of(carrier), solved
    wanted = {
        "Solved": (scale * height, slope_x, slope_y), "Solved Way": (scale * x, scale * y, 0.0),
        "Solved Frame": frame,
    }  # fmt: skip
    known = {name: np.float32(get_input(modifier, name)) for name in wanted}
    if not all(np.array_equal(known[name], np.float32(value)) for name, value in wanted.items()):
        float_carrier.set_inputs(carrier, wanted)
