# SPDX-License-Identifier: GPL-3.0-or-later
"""The points of a live patch and of its averages, in the layout read by the surface around the camera.

First the points of the patch, x fastest, with the first ones of each row and column repeated at the end, then
those of its averages, each level in the same layout.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import accumulate, chain

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.numerics.halving import averages
from ..core.numerics.interpolation import wrapped
from ..nodes.names import AVERAGES_TABLE, DISPLACEMENT, OTHERS, SLOPES, VELOCITY
from .grid_mesh import Grid

RealArray = NDArray[np.float32]


def write_patch(mesh: bpy.types.Mesh, grid: Grid, fields: Mapping[str, RealArray], lost: float) -> None:
    """Write a patch and its averages to points, and where they are now.

    grid : of the patch, in Blender units
    fields : ADDING, (N+1, N+1, …) each, in Blender units
    lost : mean square slope of the waves too short for these samples
    """
    write(mesh, fields, lost)
    places = grid.positions() + fields["displacement"].reshape(-1, 3)
    put_samples(mesh, "position", places.reshape(fields["displacement"].shape))


def write(mesh: bpy.types.Mesh, fields: Mapping[str, RealArray], lost: float = 0.0) -> bool:
    """Write samples and their averages to points.

    fields : ADDING, (rows+1, columns+1, …) each, in Blender units
    lost : mean square slope of the waves too short for these samples

    Returns whether the points were there already; of new ones nothing else is known.
    """
    whole = {
        DISPLACEMENT: fields["displacement"],
        VELOCITY: fields["velocity"],
        SLOPES: _slopes(fields["slope"], lost),
        OTHERS: fields["strain"],
    }
    table = _table(*fields["displacement"].shape[:2])
    were_there = len(mesh.vertices) == len(table) and np.array_equal(_first_of(mesh), table[0])
    if not were_there:
        mesh.clear_geometry()
        mesh.vertices.add(len(table))
        for name in (AVERAGES_TABLE, *whole):
            mesh.attributes.new(name, "FLOAT_VECTOR", "POINT")
        _put(mesh, AVERAGES_TABLE, table)
    for name, closed in whole.items():
        more = (wrapped(level) for level in averages(closed[:-1, :-1]))
        _put(mesh, name, np.concatenate([level.reshape(-1, 3) for level in chain([closed], more)]))
    mesh.update_tag()
    return were_there


def put_samples(mesh: bpy.types.Mesh, name: str, values: RealArray) -> None:
    """Write an attribute of the samples only: (rows+1, columns+1, 3), or without the 3 for a number each."""
    components = values.shape[2] if values.ndim == 3 else 1
    whole = np.zeros((len(mesh.vertices), components), np.float32)
    whole[: values.size // components] = values.reshape(-1, components)
    if name not in mesh.attributes:
        mesh.attributes.new(name, "FLOAT_VECTOR" if components == 3 else "FLOAT", "POINT")
    mesh.attributes[name].data.foreach_set("vector" if components == 3 else "value", whole.reshape(-1))


def _first_of(mesh: bpy.types.Mesh) -> RealArray | None:
    """The first line of the table of its levels."""
    attribute = mesh.attributes.get(AVERAGES_TABLE)
    return None if attribute is None else np.array(attribute.data[0].vector, np.float32)


def _slopes(slope: RealArray, lost: float) -> RealArray:
    """Slopes along x and y and the sum of their squares, including the lost waves."""
    result = np.empty((*slope.shape[:2], 3), np.float32)
    result[..., :2] = slope
    np.square(slope[..., 0], out=result[..., 2])
    result[..., 2] += np.square(slope[..., 1])
    result[..., 2] += np.float32(lost)
    return result


def _table(rows: int, columns: int) -> RealArray:
    """(points, 3): numbers of points of each level along x and y, and the index of its first one."""
    sides = [(columns, rows)]
    while max(sides[-1]) > 2:
        sides.append((sides[-1][0] // 2 + 1, sides[-1][1] // 2 + 1))
    *first, count = accumulate((x * y for x, y in sides), initial=0)
    table = np.zeros((count, 3), np.float32)
    table[: len(sides)] = [(*side, number) for side, number in zip(sides, first, strict=True)]
    table[0, 2] = -len(sides)
    return table


def _put(mesh: bpy.types.Mesh, name: str, values: RealArray) -> None:
    mesh.attributes[name].data.foreach_set("vector", np.ascontiguousarray(values).reshape(-1))
