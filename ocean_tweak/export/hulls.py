# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of hulls that stand in parameters in place of a wake's footprint."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.data.errors import ParameterError
from ..core.data.raster import Raster
from ..core.sea.underwater_hull import shares_of_draught
from ..core.waves.wake.parameters import WakeLayer
from .meshes import MESH_SUFFIXES, read_mesh

Array = NDArray[np.float64]

#: what stands beside "file": height of calm water in the mesh's own unit, m in that unit, and two axes
_KEYS = frozenset({"file", "waterline", "scale", "up", "forward"})
#: rows that take a mesh to x forward, y to port, z up
_UP = {"z": np.eye(3), "y": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])}
_FORWARD = {"x": (1, 0), "y": (0, 1), "-x": (-1, 0), "-y": (0, -1)}


def with_hulls(data: Any, folder: Path) -> Any:
    """Plain data of a sea in which each wake whose footprint is the mesh of a hull has its shape and size.

    {"file": "hull.obj"} may stand for a footprint, with "waterline", the height of calm water (0), "scale",
    the metres in a unit (1), "up", z or y, and "forward" of the turned mesh, x, -x, y or -y. Length, beam
    and draught are those of the part below the water.

    folder : what relative paths are relative to

    Raises ParameterError with the path of what is wrong. Data of another form is left for validation.
    """
    layers = data.get("layers") if isinstance(data, dict) else None
    if not isinstance(layers, list):
        return data
    made = []
    for index, layer in enumerate(layers):
        try:
            made.append(_with_hull(layer, folder))
        except ParameterError as error:
            raise error.inside("footprint").inside(str(index)).inside("layers") from None
    return {**data, "layers": made}


def _with_hull(layer: Any, folder: Path) -> Any:
    if not isinstance(layer, dict) or layer.get("kind") != WakeLayer.kind:
        return layer
    given = layer.get("footprint")
    if not isinstance(given, dict):
        return layer
    name = given.get("file")
    if not isinstance(name, str) or Path(name).suffix.lower() not in MESH_SUFFIXES:
        return layer
    waterline, scale, turn = _checked(given)
    mesh = read_mesh(folder / name)
    vertices = scale * (mesh.vertices @ turn.T)
    level = scale * waterline
    try:
        low, high = _below(vertices, mesh.triangles, level)
        shares = shares_of_draught(vertices, mesh.triangles, level, low, high)
    except ValueError as error:
        raise ParameterError("file", name, f"is no hull in the water: {error}") from None
    length, beam = high[0] - low[0], high[1] - low[1]
    size = {"length": length, "beam": beam, "draught": level - float(np.min(vertices[:, 2]))}
    return {**layer, **size, "footprint": Raster(shares, Path(name).name).to_plain()}


def _checked(given: dict[str, Any]) -> tuple[float, float, Array]:
    """Waterline and scale of a reference, and the rows that turn its mesh."""
    unknown = sorted(set(given) - _KEYS)
    if unknown:
        known = ", ".join(sorted(_KEYS))
        raise ParameterError(str(unknown[0]), given[unknown[0]], f"unknown key; Known keys: {known}")
    numbers = []
    for key, usual, least in (("waterline", 0.0, -1e6), ("scale", 1.0, 1e-6)):
        value = given.get(key, usual)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not least <= value <= 1e6:
            raise ParameterError(key, value, f"must be a number from {least:g} to 1e6")
        numbers.append(float(value))
    for key, known_axes in (("up", _UP), ("forward", _FORWARD)):
        if given.get(key, next(iter(known_axes))) not in [*known_axes]:  # which may be of any kind
            raise ParameterError(key, given[key], f"must be one of {', '.join(known_axes)}")
    cosine, sine = _FORWARD[given.get("forward", "x")]
    ahead = np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return numbers[0], numbers[1], ahead @ _UP[given.get("up", "z")]


def _below(
    vertices: Array, triangles: NDArray[np.int64], level: float
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Corners (x, y) of the part below a level."""
    above: Array = vertices[:, 2] - level
    if not np.any(above < 0.0):
        raise ValueError(
            f"its lowest point is {np.min(above):.3g} m above the waterline: lower the waterline"
        )
    points = [vertices[above <= 0.0]]
    for first, second in ((0, 1), (1, 2), (2, 0)):
        one, other = triangles[:, first], triangles[:, second]
        cut = above[one] * above[other] < 0.0
        one, other = one[cut], other[cut]
        share = (above[one] / (above[one] - above[other]))[:, np.newaxis]
        points.append(vertices[one] * (1.0 - share) + vertices[other] * share)
    plan: Array = np.concatenate(points)[:, :2]
    low, high = np.min(plan, axis=0).tolist(), np.max(plan, axis=0).tolist()
    if not (high[0] > low[0] and high[1] > low[1]):
        raise ValueError("the part below the waterline has no width")
    return (low[0], low[1]), (high[0], high[1])
