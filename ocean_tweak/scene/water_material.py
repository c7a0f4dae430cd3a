# SPDX-License-Identifier: GPL-3.0-or-later
"""The water material, and what each ocean tells it by custom properties.

One material serves many oceans, and renders where the extension is not installed: what differs between them
are plain numbers on the objects.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import bpy
import numpy as np

from ..core import OceanParameters
from ..core.foam.threshold import foam_wind
from ..core.statistics.unresolved_slopes import total_slope_variance, unresolved_slope_variance
from ..nodes.shading import Shading
from ..nodes.versioned import beside, is_of_kind, is_stale, lay_out, node_group
from ..nodes.water import WATER
from ..nodes.water_pattern import DEPTH, DOMAIN, METRES, SLOPES, SPACING, WIND, WIND_SPEED
from . import solid_foam
from .material_drivers import follow_lamp, follow_pixel_angle, follow_seconds, lamp_of
from .units import metres_per_unit
from .water_colour import coefficients_of, water_colour

_KEY = "ocean_tweak_material"
# marks flat water that stands for the ocean it is a child of
_FAR = "ocean_tweak_is_far"
# marks a mesh that shows the waves of the ocean it is a child of
_NEAR = "ocean_tweak_is_near"
NAME = "Ocean Tweak Water"
# the input, and the label of the node that says it
_SUN_DIRECTION = "Sun Direction"

#: of the Solid view: bright enough for waves to show, and as smooth as shows their crests
_IN_SOLID, _ROUGHNESS_IN_SOLID = (0.20, 0.44, 0.54, 1.0), 0.25
#: and what it was before
_DARK_IN_SOLID = (0.02, 0.08, 0.12, 1.0)

#: inputs of the group for waters of some kinds; absorption and backscatter per metre in red, green and blue
WATERS: dict[str, tuple[str, str, dict[str, object]]] = {
    "OCEANIC": ("Open Ocean", "Clear and deep blue", {}),
    "COASTAL": (
        "Coastal", "Green from plankton",
        {"Absorption": (0.40, 0.105, 0.190, 1.0), "Backscatter": (0.0060, 0.0080, 0.0075, 1.0)},
    ),
    "STORM": (
        "Stormy", "Green-grey, full of bubbles, with streaks of foam",
        {
            "Absorption": (0.36, 0.080, 0.070, 1.0), "Backscatter": (0.0022, 0.0038, 0.0040, 1.0),
            "Crest Light": 0.4,
        },
    ),
}  # fmt: skip


def describe(
    item: bpy.types.Object, parameters: OceanParameters, scene: bpy.types.Scene | None = None
) -> None:
    """Tell the material about an ocean, by custom properties; those that hold their value stay untouched.

    The ocean's horizon and its surfaces around cameras go along. A linked object keeps what it has: Blender
    drops changes to it.

    parameters : of the render
    scene : whose units hold, by default the first one that the object is in
    """
    values = _values(item, parameters, scene)
    if _set_properties(item, values):
        for child in item.children:
            if is_far(child):
                _set_properties(child, {**values, SLOPES: total_slope_variance(parameters)})
            elif _NEAR in child:
                _set_properties(child, {**values, **_finest(parameters)})


def describe_near(
    item: bpy.types.Object, parameters: OceanParameters, scene: bpy.types.Scene | None = None
) -> None:
    """Tell the material about another mesh that shows an ocean's waves, of all its patches."""
    _set_properties(item, {**_values(item, parameters, scene), **_finest(parameters), _NEAR: 1.0})


def describe_far(
    item: bpy.types.Object, parameters: OceanParameters, scene: bpy.types.Scene | None = None
) -> None:
    """Tell the material about flat water that stands for an ocean far away: all waves are roughness."""
    slopes = total_slope_variance(parameters)
    _set_properties(item, {**_values(item, parameters, scene), SLOPES: slopes, _FAR: 1.0})


def is_far(item: bpy.types.Object) -> bool:
    """Whether an object is flat water that stands for an ocean far away."""
    return _FAR in item


def _values(
    item: bpy.types.Object, parameters: OceanParameters, scene: bpy.types.Scene | None
) -> dict[str, float]:
    wind = foam_wind(parameters)
    return {
        DOMAIN: parameters.domain_size,
        SPACING: parameters.domain_size / parameters.resolution,
        SLOPES: unresolved_slope_variance(parameters),
        WIND: wind.direction if wind is not None else 0.0,
        WIND_SPEED: wind.speed if wind is not None else 0.0,
        DEPTH: parameters.water.depth,
        METRES: _metres(item, scene),
    }


def _finest(parameters: OceanParameters) -> dict[str, float]:
    """What samples hold where each of several patches has its own: two go into the shortest wave."""
    if not parameters.patches:
        return {}
    last = parameters.patches[-1]
    spacing = max(last.spacing, 0.5 * last.shortest_wavelength)
    return {SPACING: spacing, SLOPES: unresolved_slope_variance(parameters.separate)}


def _metres(item: bpy.types.Object, scene: bpy.types.Scene | None) -> float:
    scenes = (scene,) if scene is not None else item.users_scene
    return float(metres_per_unit(scenes[0])) if scenes else 1.0


def _set_properties(item: bpy.types.Object, values: Mapping[str, float]) -> bool:
    """Set what differs; returns whether anything did."""
    if item.library is not None:
        return False
    changed = {name: value for name, value in values.items() if item.get(name) != value}
    for name, value in changed.items():
        item[name] = value
    return bool(changed)


def water_material(water: str = "OCEANIC") -> bpy.types.Material:
    """The file's water material of one of the kinds in WATERS; made when there is none.

    One that a user has changed is left as it is, but for a group of another version.
    """
    for material in bpy.data.materials:
        if material.library is None and material.get(_KEY) == water:
            renew(material)
            return material
    label = WATERS[water][0]
    material = bpy.data.materials.new(NAME if water == "OCEANIC" else f"{NAME} {label}")
    _fill(material, WATERS[water][2])
    material[_KEY] = water
    return material


def renew(material: bpy.types.Material) -> None:
    """Give a material this version of the group; its inputs keep their values by name.

    One that was too dark in the Solid view is so no more.
    """
    for node in material.node_tree.nodes:
        if node.type == "GROUP" and is_stale(node.node_tree, WATER):
            node.node_tree = node_group(WATER)
    if np.allclose(material.diffuse_color, _DARK_IN_SOLID):
        material.diffuse_color, material.roughness = _IN_SOLID, _ROUGHNESS_IN_SOLID


def assign(item: bpy.types.Object, material: bpy.types.Material) -> None:
    """Put a material on the first slot of an object, on its mesh where that is its own.

    Its foam is white in the Solid view.
    """
    if item.material_slots:
        item.material_slots[0].material = material
    else:
        item.data.materials.append(material)
    solid_foam.show(item, material)


def set_air(material: bpy.types.Material, visibility: float, haze: tuple[float, float, float]) -> None:
    """Put haze between camera and water: its visibility in m and its radiance."""
    inputs = _group(material).inputs
    inputs["Visibility"].default_value = visibility
    inputs["Haze Color"].default_value = (*haze, 1.0)


def light_by(material: bpy.types.Material, sun: bpy.types.Object) -> None:
    """Let a sun lamp shine through the crests of the water, wherever it turns and however bright it is."""
    group, tree = _group(material), material.node_tree
    nodes = []
    for number, name in enumerate((_SUN_DIRECTION, "Sun Light")):
        node = next((node for node in tree.nodes if node.label == name), None)
        if node is None:
            node = tree.nodes.new("ShaderNodeCombineXYZ")
            node.label, node.location = name, beside(group, number)
            tree.links.new(node.outputs[0], group.inputs[name])
        nodes.append(node)
    follow_lamp(*nodes, sun)


def sun_of(material: bpy.types.Material) -> bpy.types.Object | None:
    """The lamp that shines through the crests of the water; None where there is none."""
    node = next((node for node in material.node_tree.nodes if node.label == _SUN_DIRECTION), None)
    return lamp_of(node) if node is not None else None


def water_node(material: bpy.types.Material | None) -> bpy.types.Node | None:
    """The node of a material that is the water's group, of whatever version; None where it has none."""
    nodes = () if material is None or material.node_tree is None else material.node_tree.nodes
    return next((node for node in nodes if node.type == "GROUP" and is_of_kind(node.node_tree, WATER)), None)


def colour_of(material: bpy.types.Material) -> tuple[float, ...]:
    """Colour of a water material's deep water, linear."""
    inputs = water_node(material).inputs
    return water_colour(*(inputs[name].default_value[:3] for name in ("Absorption", "Backscatter")))


def set_colour(material: bpy.types.Material, colour: Sequence[float]) -> None:
    """Give a water material's deep water a colour, linear: absorption and backscatter follow."""
    inputs = water_node(material).inputs
    names = ("Absorption", "Backscatter")
    found = coefficients_of(colour, *(inputs[name].default_value[:3] for name in names))
    for name, value in zip(names, found, strict=True):
        inputs[name].default_value = (*value, 1.0)


def _group(material: bpy.types.Material) -> bpy.types.Node:
    return next(node for node in material.node_tree.nodes if node.type == "GROUP")


def _fill(material: bpy.types.Material, values: Mapping[str, object]) -> None:
    if material.node_tree is None:  # a material has nodes from the start since Blender 5.0
        material.use_nodes = True
    shade = Shading(material.node_tree)
    driven = {"Seconds": ("Time", follow_seconds), "Pixel Angle": ("Pixel Angle", follow_pixel_angle)}
    inputs: dict[str, object] = {**values}
    for label, (name, follow) in driven.items():
        inputs[name] = shade.node("ShaderNodeValue", label=label).outputs[0]
        follow(inputs[name])
    group = shade.node("ShaderNodeGroup", inputs, node_tree=node_group(WATER))
    shown = shade.node("ShaderNodeOutputMaterial")
    shade.tree.links.new(group.outputs["Surface"], shown.inputs["Surface"])
    lay_out(shade.tree)
    # or Cycles takes the haze for a lamp and sorts millions of triangles
    material.cycles.emission_sampling = "NONE"
    material.diffuse_color, material.roughness = _IN_SOLID, _ROUGHNESS_IN_SOLID
