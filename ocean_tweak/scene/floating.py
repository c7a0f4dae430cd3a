# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that float on an ocean: each has a hidden carrier, and is moved, keyed and parented as usual.

The object keeps its own transform, which constraints override, so it returns there when they are removed.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import bpy

from ..core.sea.riding import USUAL_DAMPING, USUAL_ROLL_DAMPING
from ..nodes.modifier_inputs import all_inputs
from . import contact, float_carrier, float_keys, hull_cut
from .float_carrier import carrier_of, new_carrier, remove_carrier
from .hull import Hull, hull_of
from .settings import OceanObjectError, is_ocean, oceans_in
from .units import shortest_decimal

#: types of objects that view or light the sea, and stay above the water
_ABOVE = {"CAMERA", "LIGHT", "LIGHT_PROBE", "SPEAKER"}
#: tilt of a ship, which has inertia and does not follow the steepest waves
_SHIP_TILT = 0.8
#: ways of floating: label and description
RIDES = {
    "OBJECT": (
        "By Object",
        "Cameras, lights and speakers keep their height above the water. Everything else ignores "
        "waves shorter than its beam and sits a third of the beam deep, as ships do, but at most "
        "half its height",
    ),
    "SHIP": (
        "Ship",
        "Ignores waves shorter than its length, tilts 0.8 times as much as the surface, and sits "
        "a third of its beam deep, but at most half its height",
    ),
    "CUSTOM": ("Custom", "Set by the numbers below"),
}


class FloatError(OceanObjectError):
    """Why an object cannot float."""


@dataclass(frozen=True)
class Ride:
    """How an object floats.

    waterline : across it, Blender units; waves shorter than this do not move it
    draft : how deep its lowest point lies below the surface, Blender units
    keel : how far that is below its origin, Blender units
    tilt : 0 stays upright, 1 tilts as the surface does
    drift : 0 stays above its place, 1 goes along with the water
    keep_height : whether its origin stays as high above the surface as its place is above calm water,
        whatever draft and keel say
    damped : whether it has inertia; otherwise it follows the surface at every moment
    beam : of a damped one, across its length, Blender units; 0 is as wide as long
    along_y : whether its length is along its y axis
    heave_period, pitch_period, roll_period : natural ones, s; 0 are those of its size
    surge_period, sway_period : natural ones with which it swings along its length and across it about its
        place, as on a mooring, s; 0 does not swing
    damping, roll_damping : of all but roll, and of roll, as shares of the critical one
    """

    waterline: float = 0.0
    draft: float = 0.0
    keel: float = 0.0
    tilt: float = 1.0
    drift: float = 0.0
    keep_height: bool = False
    damped: bool = False
    beam: float = 0.0
    along_y: bool = False
    heave_period: float = 0.0
    pitch_period: float = 0.0
    roll_period: float = 0.0
    surge_period: float = 0.0
    sway_period: float = 0.0
    damping: float = USUAL_DAMPING
    roll_damping: float = USUAL_ROLL_DAMPING

    @property
    def level(self) -> float:
        """How high above its origin the water stands where it does not keep its height, Blender units."""
        return self.draft - self.keel


def float_on(
    item: bpy.types.Object,
    ocean: bpy.types.Object,
    ride: Ride | None = None,
    is_wet: bool = False,
) -> bpy.types.Object:
    """Let an object float on an ocean, or change how it floats. Returns its carrier.

    is_wet : whether to add a collar of foam and a wet band, if the water reaches it

    Raises FloatError for an object that cannot float there.
    """
    check(item, ocean)
    ride = ride or Ride()
    carrier = carrier_of(item)
    if carrier is None and float_keys.is_baked(item):
        float_keys.unbake(item)
        bpy.context.view_layer.update()
    if is_wet:
        contact.touch(item, ocean, own_hull(item), level_at(item, ocean, ride))
    carrier = carrier or new_carrier(item)
    let_ride(carrier, ocean, ride)
    return carrier


def own_hull(item: bpy.types.Object, depsgraph: bpy.types.Depsgraph | None = None) -> Hull | None:
    """The hull of an object in its transform without floating; None if it has none.

    depsgraph : that of a handler, in which Blender must not evaluate anew
    """
    carrier = carrier_of(item)
    upright = item if carrier is None else carrier
    return hull_of(item, upright.matrix_world, depsgraph or bpy.context.evaluated_depsgraph_get())


def usual_ride(kind: str, item: bpy.types.Object, hull: Hull | None, damped: bool = False) -> Ride:
    """How an object floats by default.

    kind : a key of RIDES
    hull : of the object, None for one without
    damped : whether it has inertia, where it has a hull
    """
    above = kind == "OBJECT" and item.type in _ABOVE
    if hull is None:
        return Ride(keep_height=above)
    if damped:
        return replace(_damped_ride(hull), keep_height=above)
    if kind == "CUSTOM":
        return Ride(keel=hull.keel)
    if kind == "SHIP":
        return Ride(waterline=hull.length, draft=hull.draft, keel=hull.keel, tilt=_SHIP_TILT)
    return Ride(waterline=hull.beam, draft=hull.draft, keel=hull.keel, keep_height=above)


def _damped_ride(hull: Hull) -> Ride:
    """Of a hull that inertia, and not a smaller tilt, keeps from following the water."""
    return Ride(
        waterline=hull.length, beam=hull.beam, along_y=hull.is_along_y, draft=hull.draft, keel=hull.keel,
        damped=True,
    )  # fmt: skip


def level_at(item: bpy.types.Object, ocean: bpy.types.Object, ride: Ride | None = None) -> float:
    """Height of the water above an object's origin, Blender units.

    ride : None for an object that stands still
    """
    if ride is not None and not ride.keep_height:
        return ride.level
    upright = carrier_of(item) or item
    return float(ocean.matrix_world.translation.z - upright.matrix_world.translation.z)


def touch_water(item: bpy.types.Object, ocean: bpy.types.Object) -> bool:
    """Let an object touch the water where it floats, or stands; whether there is any.

    ocean : of what does not float
    """
    carrier, hull = carrier_of(item), own_hull(item)
    if carrier is not None:
        known, ride = ride_of(carrier)
        return contact.touch(item, known or ocean, hull, level_at(item, known or ocean, ride))
    if contact.touches(item) and float_keys.is_baked(item):
        return contact.touch(item, ocean, hull, contact.level_of(item))
    return contact.touch(item, ocean, hull, level_at(item, ocean))


def cut_out(item: bpy.types.Object, ocean: bpy.types.Object) -> bool:
    """Let no water be inside an object: of the ocean that it floats on, else of the given one.

    Returns whether the water reaches it as it is now.

    Raises OceanObjectError for what has no inside, or cannot be changed.
    """
    check(item, ocean)
    carrier, hull = carrier_of(item), own_hull(item)
    known, ride = (None, None) if carrier is None else ride_of(carrier)
    hull_cut.cut_out(item, known or ocean, hull)
    return hull is not None and hull.is_cut(level_at(item, known or ocean, ride))


def sink(item: bpy.types.Object) -> None:
    """Stop floating an object, live or baked: it returns to its place without water, dry."""
    contact.part(item)
    take_off(item)


def take_off(item: bpy.types.Object) -> None:
    """As `sink`, but the water goes on to touch it."""
    carrier = carrier_of(item)
    for constraint in float_carrier.own_constraints(item):
        item.constraints.remove(constraint)
    float_keys.unbake(item)
    # a copy shares its carrier until it is looked after
    if carrier is not None and carrier.library is None and not any(float_carrier.carried_by(carrier)):
        remove_carrier(carrier)


def check(item: bpy.types.Object, ocean: bpy.types.Object) -> None:
    """Raise FloatError if an object cannot float on an ocean."""
    if is_ocean(item) or not is_ocean(ocean):
        raise FloatError(
            f"{item.name} cannot float on {ocean.name}: choose an ocean, and an object that is not one"
        )
    if item.library is not None:
        raise FloatError(f"{item.name} is linked from another file: make it local or override it")
    if item in _ancestors(ocean):
        raise FloatError(f"{item.name} carries {ocean.name}: it cannot float on it too")


def chosen_ocean(
    scene: bpy.types.Scene, active: bpy.types.Object | None = None, name: str = ""
) -> bpy.types.Object:
    """The scene's ocean of that name, else the active one, else the first by name.

    Raises FloatError when there is none.
    """
    oceans = sorted(oceans_in(scene), key=lambda ocean: ocean.name)
    if name:
        oceans = [ocean for ocean in oceans if ocean.name == name]
    if not oceans:
        raise FloatError(
            f"{name!r} is not an ocean of this scene" if name else "There is no ocean in this scene"
        )
    return active if active in oceans else oceans[0]


def outermost(items: Iterable[bpy.types.Object]) -> list[bpy.types.Object]:
    """Objects without a parent among the others, as children move along anyway."""
    everything = list(items)
    return [item for item in everything if not any(other in everything for other in _ancestors(item))]


def floats(item: bpy.types.Object) -> bool:
    """Whether an object floats, or has a parent that does."""
    return any(float_carrier.carrier_of(each) is not None for each in (item, *_ancestors(item)))


def let_ride(carrier: bpy.types.Object, ocean: bpy.types.Object, ride: Ride) -> None:
    """Set a carrier's ocean and ride."""
    float_carrier.set_inputs(
        carrier, {"Ocean": ocean, **{_title(name): value for name, value in vars(ride).items()}}
    )


def ride_of(carrier: bpy.types.Object) -> tuple[bpy.types.Object | None, Ride]:
    """A carrier's ocean, or None if it was deleted, and its ride."""
    modifier = float_carrier.modifier_of(carrier)
    given = {} if modifier is None else all_inputs(modifier)
    # a linked one may be of a version with fewer inputs
    values = {name: _as(type(usual), given.get(_title(name), usual)) for name, usual in vars(Ride()).items()}
    return given.get("Ocean"), Ride(**values)


def _as(kind: type, value: Any) -> Any:
    """A value of a node group as that of a Ride: its floats have few digits."""
    return float(shortest_decimal(value)) if kind is float else kind(value)


def _title(name: str) -> str:
    """Of the input of the node group that a field of Ride is."""
    return name.replace("_", " ").title()


def _ancestors(item: bpy.types.Object) -> Iterator[bpy.types.Object]:
    while item.parent is not None:
        item = item.parent
        yield item
