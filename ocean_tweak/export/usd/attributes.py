# SPDX-License-Identifier: GPL-3.0-or-later
"""The animated attributes of the mesh, from the core's fields.

All have 32 bits, as USD's schemas require for points, velocities, normals and displayColor. Others may be
stored in 16 bits, with an error of at most 2⁻¹² of a value, less than a step of an 8-bit image.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.synthesis.channels import CHANNELS, VECTOR, Channel, SurfaceFields
from .grid import UsdGrid

RealArray = NDArray[np.floating]

#: linear display colours of water and foam, for viewports without our material
WATER_COLOUR = (0.012, 0.045, 0.06)
FOAM_COLOUR = (0.8, 0.83, 0.85)


class Attribute(NamedTuple):
    """An animated attribute of the mesh.

    name, type : in USD, the type a name of `Sdf.ValueTypeNames`
    outputs : the fields that it is computed from
    values : function of these and the grid that returns (vertices, …) float32 in the layer's units and axes
    rest : the same for a flat sea
    halved : whether it may be stored in 16 bits
    """

    name: str
    type: str
    outputs: frozenset[str]
    values: Callable[[UsdGrid, SurfaceFields], RealArray]
    rest: Callable[[UsdGrid], RealArray]
    halved: bool = False


def _points(grid: UsdGrid, fields: SurfaceFields) -> RealArray:
    return grid.positions(fields.displacement)


def _colours(grid: UsdGrid, fields: SurfaceFields) -> RealArray:
    return _mixed(grid.of_vertices(fields.foam).reshape(-1, 1))


def _mixed(foam: RealArray) -> RealArray:
    water, white = np.array(WATER_COLOUR, np.float32), np.array(FOAM_COLOUR, np.float32)
    return water + foam * (white - water)


def _of_channel(channel: Channel) -> Attribute:
    assert channel.usd is not None

    def in_layer(grid: UsdGrid, field: RealArray) -> RealArray:
        if channel.turns == VECTOR:
            return grid.turned(field, grid.scale if channel.scales else 1.0)
        return field.reshape(grid.vertices, *field.shape[2:])

    def values(grid: UsdGrid, fields: SurfaceFields) -> RealArray:
        return in_layer(grid, grid.of_vertices(fields[channel.name]))

    def rest(grid: UsdGrid) -> RealArray:
        flat = np.full(channel.shape(grid.quads + 1), channel.rest, np.float32)
        return in_layer(grid, flat) + np.float32(0.0)  # avoid -0 in rotated axes

    name, type_name, halved = channel.usd
    return Attribute(name, type_name, frozenset({channel.name}), values, rest, halved)


POINTS = Attribute(
    "points", "Point3fArray", frozenset({"displacement"}), _points, lambda grid: grid.positions(None)
)
_COLOURS = Attribute(
    "primvars:displayColor", "Color3fArray", frozenset({"foam"}), _colours,
    lambda grid: _mixed(np.zeros((grid.vertices, 1), np.float32)),
)  # fmt: skip

#: in .blend files attributes are flags by their order: add new ones at the end
_FIRST = ("velocity", "normal", "foam", "cusp")
_OTHERS = tuple(name for name, channel in CHANNELS.items() if channel.usd and name not in _FIRST)

#: optional attributes, besides points and extent
ATTRIBUTES: dict[str, Attribute] = {
    attribute.name.removeprefix("primvars:"): attribute
    for attribute in (
        *(_of_channel(CHANNELS[name]) for name in _FIRST),
        _COLOURS,
        *(_of_channel(CHANNELS[name]) for name in _OTHERS),
    )
}

EXTENT = ("extent", "Float3Array")


def chosen(names: tuple[str, ...]) -> tuple[Attribute, ...]:
    """Points, and the requested attributes."""
    return (POINTS, *(ATTRIBUTES[name] for name in names))


def outputs_of(names: tuple[str, ...]) -> frozenset[str]:
    """The fields that a frame must have."""
    return frozenset().union(*(attribute.outputs for attribute in chosen(names)))


def type_name(attribute: Attribute, half: bool) -> str:
    """The type, from `Sdf.ValueTypeNames`."""
    return "HalfArray" if half and attribute.halved else attribute.type


def to_vt(vt: Any, values: RealArray, half: bool = False) -> Any:
    """A `Vt` array from (n,) or (n, 3), in 16 or 32 bits."""
    array = np.ascontiguousarray(values, np.float16 if half else np.float32)
    if array.ndim == 1:
        return (vt.HalfArray if half else vt.FloatArray).FromNumpy(array)
    return (vt.Vec3fArray if array.shape[1] == 3 else vt.Vec2fArray).FromNumpy(array)


def mesh_values(
    vt: Any, grid: UsdGrid, attributes: tuple[Attribute, ...], half: bool, fields: SurfaceFields | None
) -> Mapping[str, Any]:
    """Arrays of a mesh at a frame by attribute name, including its extent; without fields, those at rest.

    Raises ValueError for numbers that are not finite.
    """
    arrays = {
        attribute.name: attribute.rest(grid) if fields is None else attribute.values(grid, fields)
        for attribute in attributes
    }
    for name, array in arrays.items():
        if not np.all(np.isfinite(array)):
            raise ValueError(f"{name} has values that are not finite")
    points = arrays[POINTS.name]
    extent = np.stack([points.min(axis=0), points.max(axis=0)])
    halved = {attribute.name for attribute in attributes if half and attribute.halved}
    values = {name: to_vt(vt, array, name in halved) for name, array in arrays.items()}
    return {**values, EXTENT[0]: to_vt(vt, extent)}
