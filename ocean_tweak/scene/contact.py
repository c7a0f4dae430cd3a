# SPDX-License-Identifier: GPL-3.0-or-later
"""Where objects touch the water: the wet band on their meshes, and their collars in the water's materials.

What touches the water says so by itself, in custom properties that its copies have too. Collars follow from
that: `refresh` brings the materials into step. Where nobody does, a deleted object's collar shows nothing.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager

import bpy
import numpy as np
from mathutils import Vector

from ..core import ParameterError
from ..core.foam.threshold import foam_wind
from ..core.waves.contribution import Wind
from ..nodes.contact import COLLAR, CONTACT, RIPPLE_NORMAL
from ..nodes.modifier_inputs import all_inputs, set_inputs
from ..nodes.versioned import is_of_kind, node_group
from ..nodes.water import WATER
from . import solid_foam
from .hull import Hull, Waterline, hull_of, meshes_of
from .settings import is_ocean, scene_of, settings_of
from .units import metres_per_unit

#: inputs of a collar by their names
Values = Mapping[str, object]

_NAME = "Ocean Contact"
# custom properties of what touches the water: the ocean, and the water's height above the object's origin
_OCEAN, _LEVEL = "ocean_tweak_contact", "ocean_tweak_waterline"
#: of the beam
_FOAM_WIDTH, _RIPPLE_LENGTH = 0.12, 0.25
_WIDEST_FOAM, _LONGEST_RIPPLE = 1.5, 2.0  # m
#: by the wind in m/s: foam at a hull, and how much wider it lies around it
_FOAM_BY_WIND = (2.0, 10.0), (0.2, 0.95)
_WIDER_BY_WIND = (4.0, 12.0, 25.0), (1.0, 2.0, 5.0)
#: and a wash down the wind, of the length of the waterline
_WASH_BY_WIND = (12.0, 25.0), (0.0, 1.6)
#: how high it is wet, of the beam, and how much of the white water laps at it
_WET_BAND_BY_WIND = (4.0, 20.0), (0.12, 0.26)
_SLOP_BY_WIND = (3.0, 12.0), (0.0, 1.0)
#: inputs of a collar that are links
_LINKED = {"Vector", "Foam Map", "Height", "Time"}


def touch(item: bpy.types.Object, ocean: bpy.types.Object, hull: Hull | None, level: float) -> bool:
    """Let an object touch an ocean's water; returns whether the water cuts it there.

    hull : of the object
    level : of the water above the object's origin, Blender units
    """
    values = _fitted(item, ocean, hull, level)
    if hull is None or not values:
        part(item)
        return False
    item[_OCEAN], item[_LEVEL] = ocean, level
    for mesh in meshes_of(item):
        modifier = modifier_of(mesh)
        if modifier is None:
            modifier = mesh.modifiers.new(_NAME, "NODES")
            modifier.node_group = node_group(CONTACT)
            modifier.show_in_editmode = False
            set_inputs(modifier, _wetted(hull, _wind(ocean)))
        set_inputs(modifier, {"Ocean": ocean})
    refresh({item: values})
    return True


def part(item: bpy.types.Object) -> None:
    """Let an object touch the water no more."""
    for mesh in meshes_of(item):
        modifier = modifier_of(mesh)
        if modifier is not None:
            mesh.modifiers.remove(modifier)
    if touches(item):
        del item[_OCEAN], item[_LEVEL]
        refresh()


def touches(item: bpy.types.Object) -> bool:
    """Whether an object was made to touch the water."""
    return _OCEAN in item and isinstance(item.get(_LEVEL), float)


def ocean_of(item: bpy.types.Object) -> bpy.types.Object | None:
    """Whose water touches an object; None for a dry one."""
    ocean = item.get(_OCEAN)
    return ocean if isinstance(ocean, bpy.types.Object) else None


def level_of(item: bpy.types.Object) -> float:
    """How high above the origin of what touches the water that water is, Blender units."""
    return float(item[_LEVEL])


def modifier_of(item: bpy.types.Object) -> bpy.types.NodesModifier | None:
    """What knows how wet a mesh is; None where nothing does."""
    nodes = (modifier for modifier in item.modifiers if modifier.type == "NODES")
    return next((each for each in nodes if is_of_kind(each.node_group, CONTACT)), None)


def collars_of(item: bpy.types.Object) -> list[bpy.types.Node]:
    """The nodes of an object's collar, one in each of the water's materials."""
    waters = (material for material in bpy.data.materials if not solid_foam.is_copy(material))
    found = (_collars(material).get(item) for material in waters)
    return [collar for collar in found if collar is not None]


def refresh(fitted: Mapping[bpy.types.Object, Values] | None = None) -> None:
    """Give the materials of each ocean's water the collars of what touches it, and no others.

    fitted : inputs of collars to recompute
    """
    fitted = fitted or {}
    known = {item: item[_OCEAN] for item in bpy.data.objects if touches(item) and is_shown(item)}
    # what a file says there may be anything
    oceans = {ocean for ocean in known.values() if isinstance(ocean, bpy.types.Object) and is_ocean(ocean)}
    shown = {ocean: set(materials_of(ocean)) for ocean in oceans}
    for material in bpy.data.materials:
        water = _water(material)
        if water is None:
            continue
        wanted = [item for item, ocean in known.items() if ocean in shown and material in shown[ocean]]
        present = _collars(material)
        if set(present) != set(wanted) or not fitted.keys().isdisjoint(wanted):
            _chain(material.node_tree, water, _inputs_of(wanted, present, fitted))


@contextmanager
def set_aside() -> Iterator[None]:
    """While this is open no material has collars, which would take their objects along into a library."""
    kept: dict[bpy.types.Object, Values] = {}
    for material in bpy.data.materials:
        water, present = _water(material), _collars(material)
        if water is not None and present:
            kept |= {item: _look(node) for item, node in present.items() if item is not None}
            _chain(material.node_tree, water, {})
    try:
        yield
    finally:
        refresh(kept)


def is_shown(item: bpy.types.Object) -> bool:
    """Whether an object is this file's and in a scene."""
    return item.library is None and len(item.users_scene) > 0


def materials_of(ocean: bpy.types.Object) -> Iterator[bpy.types.Material]:
    """Those that an ocean's water is shown with."""
    for item in (ocean, *ocean.children):
        yield from (slot.material for slot in item.material_slots if slot.material is not None)
        for modifier in item.modifiers:
            if modifier.type == "NODES" and modifier.node_group is not None:
                values = all_inputs(modifier).values()
                yield from (value for value in values if isinstance(value, bpy.types.Material))


def _water(material: bpy.types.Material) -> bpy.types.Node | None:
    """The water's node of a material that can be changed; None where there is none."""
    if material.library is not None or material.node_tree is None or solid_foam.is_copy(material):
        return None
    return next((node for node in material.node_tree.nodes if _is_group(node, WATER)), None)


def _is_group(node: bpy.types.Node, kind: object) -> bool:
    return node.type == "GROUP" and is_of_kind(node.node_tree, kind)


def _collars(material: bpy.types.Material) -> dict[bpy.types.Object | None, bpy.types.Node]:
    """By their object; those whose object was deleted by None."""
    if material.node_tree is None:
        return {}
    nodes = [node for node in material.node_tree.nodes if _is_group(node, COLLAR)]
    return {(place.object if (place := _coordinates(node)) else None): node for node in nodes}


def _coordinates(collar: bpy.types.Node) -> bpy.types.Node | None:
    links = collar.inputs["Vector"].links
    return links[0].from_node if links else None


def _inputs_of(
    wanted: list[bpy.types.Object],
    present: Mapping[bpy.types.Object | None, bpy.types.Node],
    fitted: Mapping[bpy.types.Object, Values],
) -> dict[bpy.types.Object, Values]:
    """By object: what it is fitted with, has, or what another of the same mesh has; else fitted now."""
    had = {item: _look(node) for item, node in present.items() if item is not None}
    alike = {(item.data, item.get(_LEVEL)): values for item, values in had.items() if item.data is not None}
    result: dict[bpy.types.Object, Values] = {}
    for item in wanted:
        values = fitted.get(item) or had.get(item) or alike.get((item.data, item[_LEVEL]))
        if values is None:
            values = _fitted(item, item[_OCEAN], hull_of(item, item.matrix_world), item[_LEVEL])
        result[item] = values
    return result


def _chain(
    tree: bpy.types.NodeTree, water: bpy.types.Node, inputs: Mapping[bpy.types.Object, Values]
) -> None:
    """Make these collars all that a material has, one after another up to the water."""
    foam, constant = _before(water)
    height: bpy.types.NodeSocket | None = None
    _clear(tree)
    for number, (item, values) in enumerate(inputs.items()):
        collar = _new_collar(tree, water, item, number, values)
        if foam is None:
            collar.inputs["Foam Map"].default_value = constant
        else:
            tree.links.new(foam, collar.inputs["Foam Map"])
        if height is not None:
            tree.links.new(height, collar.inputs["Height"])
        foam, height = collar.outputs["Foam Map"], collar.outputs["Height"]
    if foam is not None:
        tree.links.new(foam, water.inputs["Foam Map"])
    if height is not None and not water.inputs["Normal Map"].links:  # somebody's own normals go first
        ripples = _new_node(tree, water, "ShaderNodeGroup", -180.0, -260.0)
        ripples.node_tree = node_group(RIPPLE_NORMAL)
        tree.links.new(height, ripples.inputs["Height"])
        tree.links.new(ripples.outputs["Normal Map"], water.inputs["Normal Map"])


def _clear(tree: bpy.types.NodeTree) -> None:
    for node in [node for node in tree.nodes if _is_group(node, COLLAR)]:
        place = _coordinates(node)
        if place is not None:
            tree.nodes.remove(place)
        tree.nodes.remove(node)
    for node in [node for node in tree.nodes if _is_group(node, RIPPLE_NORMAL)]:
        tree.nodes.remove(node)


def _before(water: bpy.types.Node) -> tuple[bpy.types.NodeSocket | None, float]:
    """What somebody linked to the water's foam map, before all collars, and the value without a link."""
    socket = water.inputs["Foam Map"]
    while socket.links and _is_group(socket.links[0].from_node, COLLAR):
        socket = socket.links[0].from_node.inputs["Foam Map"]
    return (socket.links[0].from_socket if socket.links else None), socket.default_value


def _look(collar: bpy.types.Node) -> dict[str, object]:
    """What an artist may have set."""
    values = {socket.name: socket.default_value for socket in collar.inputs if socket.name not in _LINKED}
    return {name: tuple(value) if hasattr(value, "__len__") else value for name, value in values.items()}


def _new_collar(
    tree: bpy.types.NodeTree, water: bpy.types.Node, item: bpy.types.Object, number: int, values: Values
) -> bpy.types.Node:
    collar = _new_node(tree, water, "ShaderNodeGroup", -420.0, -260.0 - 420.0 * number)
    collar.node_tree, collar.label = node_group(COLLAR), f"{item.name} Collar"
    place = _new_node(tree, water, "ShaderNodeTexCoord", -640.0, -260.0 - 420.0 * number)
    place.object = item
    for name, value in values.items():
        collar.inputs[name].default_value = value
    tree.links.new(place.outputs["Object"], collar.inputs["Vector"])
    time = water.inputs["Time"].links
    if time:
        tree.links.new(time[0].from_socket, collar.inputs["Time"])
    return collar


def _new_node(
    tree: bpy.types.NodeTree, water: bpy.types.Node, kind: str, right: float, up: float
) -> bpy.types.Node:
    node = tree.nodes.new(kind)
    node.location = (water.location.x + right, water.location.y + up)
    return node


def _fitted(item: bpy.types.Object, ocean: bpy.types.Object, hull: Hull | None, level: float) -> Values:
    """A collar's inputs for an object; none where the water does not cut it."""
    line = hull.waterline(level) if hull is not None else None
    if hull is None or line is None:
        return {}
    metres = float(metres_per_unit(scene_of(item)))
    wind = _wind(ocean)
    speed = 0.0 if wind is None else wind.speed
    foam = float(np.interp(speed, *_FOAM_BY_WIND))
    values = {**_placed(hull, line, level, metres), **_sized(line, metres, speed), "Foam": foam}
    return values if wind is None else {**values, "Lee": _lee(item, ocean, hull, wind.direction)}


def _lee(item: bpy.types.Object, ocean: bpy.types.Object, hull: Hull, direction: float) -> Sequence[float]:
    """Down the wind in the upright axes of a hull; `direction` is in rad, in the ocean's axes."""
    wind = ocean.matrix_world.to_quaternion() @ Vector((math.cos(direction), math.sin(direction), 0.0))
    lee = hull.tilt @ (item.matrix_world.to_quaternion().inverted() @ wind)
    return tuple(lee.xy.normalized().to_3d())


def _placed(hull: Hull, line: Waterline, level: float, metres: float) -> dict[str, object]:
    place = (-line.middle[0] * metres, -line.middle[1] * metres, -level * metres)
    return {
        "Location": place,
        "Rotation": tuple(hull.tilt.to_euler()),
        "Scale": tuple(part * metres for part in hull.scale),
        "Half Length": line.half_length * metres,
        "Half Beam": line.half_beam * metres,
        "Fullness": line.fullness,
    }


def _sized(line: Waterline, metres: float, wind: float) -> dict[str, object]:
    beam = 2.0 * min(line.half_length, line.half_beam) * metres
    return {
        "Foam Width": min(_FOAM_WIDTH * beam, _WIDEST_FOAM) * float(np.interp(wind, *_WIDER_BY_WIND)),
        "Ripple Length": min(_RIPPLE_LENGTH * beam, _LONGEST_RIPPLE),
        "Wash": 2.0 * line.half_length * metres * float(np.interp(wind, *_WASH_BY_WIND)),
    }


def _wetted(hull: Hull, wind: Wind | None) -> Values:
    """What a mesh's modifier knows of how far the water splashes up at it."""
    speed = 0.0 if wind is None else wind.speed
    return {
        "Wet Band": float(np.interp(speed, *_WET_BAND_BY_WIND)) * hull.beam,
        "Slop": float(np.interp(speed, *_SLOP_BY_WIND)),
    }


def _wind(ocean: bpy.types.Object) -> Wind | None:
    """The wind that makes an ocean's foam; None without one."""
    try:
        return foam_wind(settings_of(ocean).to_parameters(scene_of(ocean)))
    except ParameterError:
        return None
