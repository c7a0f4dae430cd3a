# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that are read: Wavefront OBJ, and PLY in text or binary. Only vertices and faces are."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.data.errors import ParameterError
from .files import read_bytes

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

#: names of files that are meshes
MESH_SUFFIXES = (".obj", ".ply")
#: largest file, bytes, and largest number of vertices and of faces
_LARGEST, _MOST = 256_000_000, 4_000_000
_PLY_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
    "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
    "double": "f8", "float64": "f8",
}  # fmt: skip
#: names of the list of a face's vertices
_CORNERS = frozenset({"vertex_indices", "vertex_index"})
_PLY_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


class Mesh(NamedTuple):
    """Vertices (N, 3), and triangles (M, 3) of their numbers."""

    vertices: Array
    triangles: Integers


def read_mesh(path: Path) -> Mesh:
    """The mesh in an OBJ or PLY file, its faces in triangles.

    Raises ParameterError, naming the file, for one that cannot be read, is too large or has no faces.
    """
    try:
        content = read_bytes(path, _LARGEST)
        vertices, faces = _ply(content) if path.suffix.lower() == ".ply" else _obj(content)
        if not len(faces):
            raise ValueError("it has no faces")
        if not np.isfinite(vertices).all() or np.min(faces) < 0 or np.max(faces) >= len(vertices):
            raise ValueError("its faces have vertices that it lacks, or that are nowhere")
    except OSError as error:
        raise ParameterError("file", str(path), f"cannot be read: {error.strerror}") from None
    except (ValueError, IndexError, KeyError, OverflowError) as error:
        raise ParameterError("file", str(path), f"is no mesh that can be read: {error}") from None
    return Mesh(vertices, faces)


def _obj(content: bytes) -> tuple[Array, Integers]:
    vertices: list[Sequence[float]] = []
    triangles: list[tuple[int, int, int]] = []
    for line in content.decode("utf-8", "replace").splitlines():
        kind, *words = line.split() or [""]
        if kind == "v":
            vertices.append([float(word) for word in words[:3]])
        elif kind == "f":
            numbers = [int(word.partition("/")[0]) for word in words]
            triangles += _fan([each - 1 if each > 0 else len(vertices) + each for each in numbers])
        _check_count(max(len(vertices), len(triangles)))
    return np.array(vertices, np.float64).reshape(-1, 3), np.array(triangles, np.int64).reshape(-1, 3)


def _fan(numbers: Sequence[int]) -> list[tuple[int, int, int]]:
    return [(numbers[0], numbers[i], numbers[i + 1]) for i in range(1, len(numbers) - 1)]


def _check_count(count: int) -> None:
    if count > _MOST:
        raise ValueError(f"it has more than {_MOST:,} vertices or triangles: give a simpler hull")


class _Element(NamedTuple):
    """Of a PLY file: how many there are, and the names and types of properties; a list has two types."""

    name: str
    number: int
    properties: list[tuple[str, tuple[str, ...]]]


def _ply(content: bytes) -> tuple[Array, Integers]:
    head, end, body = content.partition(b"end_header")
    lines = head.decode("ascii", "replace").split("\n")
    if not end or lines[0].strip() != "ply":
        raise ValueError("it does not begin as a PLY file does")
    (order,) = [_PLY_ORDERS[line.split()[1]] for line in lines if line.startswith("format ")]
    values = _Values(body, order)
    vertices, triangles = np.empty((0, 3)), np.empty((0, 3), np.int64)
    for element in _elements(lines):
        _check_count(element.number)
        rows = [_row(element, values) for _ in range(element.number)]
        if element.name == "vertex":
            vertices = np.array([[row[name][0] for name in "xyz"] for row in rows], np.float64).reshape(-1, 3)
        elif element.name == "face":
            corners = _CORNERS.intersection(name for name, _ in element.properties)
            if len(corners) != 1:
                raise ValueError(f"its faces must have one list, {' or '.join(sorted(_CORNERS))}")
            found = [_fan([int(number) for name in corners for number in row[name]]) for row in rows]
            triangles = np.array([each for face in found for each in face], np.int64).reshape(-1, 3)
    return vertices, triangles


def _elements(lines: Sequence[str]) -> list[_Element]:
    found: list[_Element] = []
    for words in (line.split() for line in lines):
        if words[:1] == ["element"]:
            found.append(_Element(words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            types = words[2:4] if words[1] == "list" else words[1:2]
            found[-1].properties.append((words[-1], tuple(_PLY_TYPES[each] for each in types)))
    return found


class _Values:
    """The numbers of a PLY file, one after another."""

    def __init__(self, body: bytes, order: str) -> None:
        self._order = order
        after = body.index(b"\n") + 1
        self._words: Iterator[bytes] = iter(body[after:].split()) if not order else iter(())
        self._bytes, self._at = body, after

    def next(self, kind: str, count: int) -> Sequence[float]:
        """So many of a type. Raises ValueError where the file ends before."""
        if not self._order:
            found = [float(word) for word in itertools.islice(self._words, count)]
            if len(found) < count:
                raise ValueError("it ends before its last number")
            return found
        dtype = np.dtype(self._order + kind)
        values = np.frombuffer(self._bytes, dtype, count, self._at)
        self._at += count * dtype.itemsize
        return [float(value) for value in values]


def _row(element: _Element, values: _Values) -> dict[str, Sequence[float]]:
    """The properties of one element."""
    row = {}
    for name, types in element.properties:
        count = 1 if len(types) == 1 else int(values.next(types[0], 1)[0])
        if count < 0:
            raise ValueError(f"one of its lists has {count} numbers")
        row[name] = values.next(types[-1], count)
    return row
