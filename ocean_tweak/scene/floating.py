# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that float on an ocean: a carrier stands where the object is, and the object goes along with it.

The carrier is a small triangle that has the object's place in the scene: its parent, animation and
constraints. Its node group moves it onto the surface. The object itself keeps its own transform, overruled by
constraints, so that it is back where it was as soon as those are gone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import bpy

from ..nodes.floating import CARRIER, TRANSFORM
from ..nodes.modifier_inputs import get_input, set_input
from ..nodes.versioned import is_of_kind, node_group
from . import contact, float_keys
from .hull import Hull, hull_of
from .settings import OceanObjectError, is_ocean, oceans_in
from .units import metres_per_unit

_NAME = "Float on Ocean"
# what stands in a custom property of helpers, by which they are recognised whatever they are called
_KEY = "ocean_tweak_float_part"
_CARRIER, _RIDER = "carrier", "rider"
_LEAST_SIZE = 1.0  # m, of a carrier
_PLACE = (
    "parent", "parent_type", "parent_bone", "parent_vertices", "matrix_parent_inverse", "rotation_mode",
    "location", "rotation_euler", "rotation_quaternion", "rotation_axis_angle",
    "delta_location", "delta_rotation_euler", "delta_rotation_quaternion",
)  # fmt: skip


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
    """

    waterline: float = 0.0
    draft: float = 0.0
    keel: float = 0.0
    tilt: float = 1.0
    drift: float = 0.0

    @property
    def level(self) -> float:
        """How high above its origin the water stands, Blender units."""
        return self.draft - self.keel


def float_on(
    item: bpy.types.Object,
    ocean: bpy.types.Object,
    scene: bpy.types.Scene,
    ride: Ride | None = None,
    is_wet: bool = False,
) -> bpy.types.Object:
    """Let an object float on an ocean, or on another one than before. Returns its carrier, which moves it.

    is_wet : whether it gets a collar of foam and a wet band, where the water cuts it

    Raises FloatError for what cannot float there.
    """
    check(item, ocean)
    ride = ride or Ride()
    carrier = carrier_of(item)
    if carrier is None and float_keys.is_baked(item):
        float_keys.unbake(item)
        bpy.context.view_layer.update()
    if is_wet:
        contact.touch(item, ocean, own_hull(item), ride.level)
    if carrier is None:
        carrier = place_carrier(item, scene)
        attach = _attach_by_attribute if bpy.app.version >= (5, 0) else _attach_by_rider
        attach(item, carrier)
    let_ride(carrier, ocean, ride)
    return carrier


def own_hull(item: bpy.types.Object) -> Hull | None:
    """The hull of an object as it stands without floating; None where it has none."""
    carrier = carrier_of(item)
    upright = item if carrier is None else carrier
    return hull_of(item, upright.matrix_world, bpy.context.evaluated_depsgraph_get())


def ride_by_size(hull: Hull | None) -> Ride:
    """How something of this size floats: it feels no waves shorter than its beam, and has a ship's draft."""
    return Ride() if hull is None else Ride(waterline=hull.beam, draft=hull.draft, keel=hull.keel)


def touch_water(item: bpy.types.Object, ocean: bpy.types.Object) -> bool:
    """Let an object touch the water where it floats, or stands; whether there is any.

    ocean : of what does not float
    """
    carrier, hull = carrier_of(item), own_hull(item)
    if carrier is not None:
        known, ride = ride_of(carrier)
        return contact.touch(item, known or ocean, hull, ride.level)
    if contact.touches(item) and float_keys.is_baked(item):
        return contact.touch(item, ocean, hull, contact.level_of(item))
    level = ocean.matrix_world.translation.z - item.matrix_world.translation.z
    return contact.touch(item, ocean, hull, level)


def sink(item: bpy.types.Object) -> None:
    """Let an object float no more, live or baked: it is back where it was before, and dry.

    Of a carrier: let whatever it carries float no more.
    """
    for each in list(carried_by(item)) if is_carrier(item) else [item]:
        contact.part(each)
    take_off(item)


def take_off(item: bpy.types.Object) -> None:
    """As `sink`, but the water goes on to touch it."""
    carrier = item if is_carrier(item) else carrier_of(item)
    for each in list(carried_by(item)) if is_carrier(item) else [item]:
        for constraint in [each.constraints[name] for name in _constraints_of(each)]:
            each.constraints.remove(constraint)
        float_keys.unbake(each)
    # a copy of a floating object shares its carrier
    if carrier is not None and not any(carried_by(carrier)):
        remove_carrier(carrier)


def check(item: bpy.types.Object, ocean: bpy.types.Object) -> None:
    """Raise FloatError where an object cannot float on an ocean."""
    if is_ocean(item) or not is_ocean(ocean):
        raise FloatError(f"{item.name} cannot float on {ocean.name}: choose an ocean, and what is none")
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
        raise FloatError(f"{name!r} is no ocean of this scene" if name else "There is no ocean in this scene")
    return active if active in oceans else oceans[0]


def outermost(items: Iterable[bpy.types.Object]) -> list[bpy.types.Object]:
    """Those that no other of them carries as its parent: children go along anyway."""
    everything = list(items)
    return [item for item in everything if not any(other in everything for other in _ancestors(item))]


def carrier_of(item: bpy.types.Object) -> bpy.types.Object | None:
    """What carries a floating object; None for one that does not float, or whose carrier was deleted."""
    for name in _constraints_of(item):
        target = item.constraints[name].target
        carrier = target.parent if target.get(_KEY) == _RIDER else target
        if is_carrier(carrier):
            return carrier
    return None


def carried_by(carrier: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """The objects that float with a carrier."""
    return (item for item in bpy.data.objects if carrier_of(item) == carrier)


def is_carrier(item: bpy.types.Object | None) -> bool:
    """Whether an object was made to carry others."""
    return item is not None and item.get(_KEY) == _CARRIER


def carrier_modifier(carrier: bpy.types.Object) -> bpy.types.NodesModifier | None:
    """What moves a carrier; None where somebody took it away."""
    return next(
        (each for each in carrier.modifiers if each.type == "NODES" and is_of_kind(each.node_group, CARRIER)),
        None,
    )


def let_ride(carrier: bpy.types.Object, ocean: bpy.types.Object, ride: Ride) -> None:
    """Give a carrier its ocean and its ride."""
    modifier = carrier_modifier(carrier)
    if modifier is None:
        modifier = carrier.modifiers.new(_NAME, "NODES")
        modifier.node_group = node_group(CARRIER)
    set_input(modifier, "Ocean", ocean)
    for name, value in vars(ride).items():
        set_input(modifier, name.title(), value)
    carrier.update_tag()


def ride_of(carrier: bpy.types.Object) -> tuple[bpy.types.Object | None, Ride]:
    """A carrier's ocean, None where it was deleted, and its ride."""
    modifier = carrier_modifier(carrier)
    if modifier is None:
        return None, Ride()
    values = {name: float(get_input(modifier, name.title())) for name in vars(Ride())}
    return get_input(modifier, "Ocean"), Ride(**values)


def place_carrier(item: bpy.types.Object, scene: bpy.types.Scene) -> bpy.types.Object:
    """A carrier with an object's place in the scene, and its animation and constraints.

    Those that the object had before its floating was baked, if it was.
    """
    carrier = bpy.data.objects.new(f"{item.name} Float", _triangle(item, scene))
    carrier[_KEY] = _CARRIER
    carrier.display_type = "WIRE"
    carrier.hide_render = True
    for collection in _collections(item, scene):
        collection.objects.link(carrier)
    for name in _PLACE:
        setattr(carrier, name, getattr(item, name))
    for constraint in item.constraints:
        if constraint.name not in _constraints_of(item):
            carrier.constraints.copy(constraint)
    if item.animation_data is not None and item.animation_data.action is not None:
        animation = carrier.animation_data_create()
        animation.action = item.animation_data.action
        animation.action_slot = item.animation_data.action_slot
    float_keys.restore_place(item, carrier)
    return carrier


def remove_carrier(carrier: bpy.types.Object) -> None:
    """Delete a carrier, its mesh and its rider."""
    for rider in [child for child in carrier.children if child.get(_KEY) == _RIDER]:
        bpy.data.objects.remove(rider)
    mesh = carrier.data
    bpy.data.objects.remove(carrier)
    if mesh.users == 0:
        bpy.data.meshes.remove(mesh)


def _triangle(item: bpy.types.Object, scene: bpy.types.Scene) -> bpy.types.Mesh:
    """A triangle around the origin that points along y.

    A vertex parent has the axes of such a triangle, whose first side runs along x.
    """
    half = 0.5 * max(*item.dimensions[:2], _LEAST_SIZE / float(metres_per_unit(scene)))
    mesh = bpy.data.meshes.new(f"{item.name} Float")
    mesh.from_pydata([(-half, -half, 0.0), (half, -half, 0.0), (0.0, 2.0 * half, 0.0)], [], [(0, 1, 2)])
    return mesh


def _collections(item: bpy.types.Object, scene: bpy.types.Scene) -> list[bpy.types.Collection]:
    own = [collection for collection in item.users_collection if collection.library is None]
    return own or [scene.collection]


def _ancestors(item: bpy.types.Object) -> Iterator[bpy.types.Object]:
    while item.parent is not None:
        item = item.parent
        yield item


def _constraints_of(item: bpy.types.Object) -> list[str]:
    """Names of the object's constraints that a carrier is the target of."""
    return [
        constraint.name
        for constraint in item.constraints
        if getattr(constraint, "target", None) is not None and _KEY in constraint.target
    ]


def _attach_by_attribute(item: bpy.types.Object, carrier: bpy.types.Object) -> None:
    constraint = item.constraints.new("GEOMETRY_ATTRIBUTE")
    constraint.name = _NAME
    constraint.target = carrier
    constraint.attribute_name = TRANSFORM
    constraint.data_type = "FLOAT4X4"
    constraint.apply_target_transform = True
    constraint.mix_loc = constraint.mix_rot = True
    constraint.mix_scl = False


def _attach_by_rider(item: bpy.types.Object, carrier: bpy.types.Object) -> None:
    """Before 5.0: constraints cannot read attributes, but a vertex parent moves with the carrier."""
    rider = bpy.data.objects.new(f"{item.name} Float Rider", None)
    rider[_KEY] = _RIDER
    rider.empty_display_size = 0.0
    rider.hide_select = True
    rider.hide_render = True
    for collection in carrier.users_collection:
        collection.objects.link(rider)
    rider.parent, rider.parent_type, rider.parent_vertices = carrier, "VERTEX_3", (0, 1, 2)
    for kind in ("COPY_LOCATION", "COPY_ROTATION"):
        constraint = item.constraints.new(kind)
        constraint.name = _NAME
        constraint.target = rider
