# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that keep the contract of an ocean's evaluated one, with waves of one's choice."""

import math

import bpy
import numpy as np


def wave(n, count, height):
    """(n, n, 3): displacement of `count` waves along x, without choppiness."""
    field = np.zeros((n, n, 3))
    field[..., 2] = height * np.cos(2.0 * math.pi * count * np.arange(n) / n)
    return field


def new_sheet(scene, displacement, size, attributes=(), repeats=(1, 1)):
    """An object whose mesh is moved by a field (n, n, 3) that repeats after a size.

    attributes : by name, functions of the (rows, columns, 3) positions at rest
    """
    n = len(displacement)
    wide = np.tile(displacement, (repeats[1], repeats[0], 1))
    wide = np.concatenate([wide, wide[:1]])
    wide = np.concatenate([wide, wide[:, :1]], axis=1)
    rows, columns = wide.shape[:2]
    rest = np.zeros(wide.shape)
    rest[..., 0] = np.arange(columns) * size / n
    rest[..., 1] = (np.arange(rows) * size / n)[:, np.newaxis]
    first = (np.arange(rows - 1)[:, np.newaxis] * columns + np.arange(columns - 1)).reshape(-1, 1)
    faces = first + np.array([0, 1, columns + 1, columns])
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata((rest + wide).reshape(-1, 3).tolist(), [], faces.tolist())
    values = {"displacement": wide, **{name: value(rest) for name, value in dict(attributes).items()}}
    for name, value in values.items():
        is_vector = value.shape[-1] == 3
        attribute = mesh.attributes.new(name, "FLOAT_VECTOR" if is_vector else "FLOAT", "POINT")
        attribute.data.foreach_set("vector" if is_vector else "value", value.astype(np.float32).ravel())
    item = bpy.data.objects.new("Sheet", mesh)
    scene.collection.objects.link(item)
    return item
