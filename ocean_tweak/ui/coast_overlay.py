# SPDX-License-Identifier: GPL-3.0-or-later
"""Overlays of the 3D view over a coast: a map of the significant height, and arrows of the mean direction."""

from __future__ import annotations

from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import Ocean, Places
from ..core.numerics.memo import MEMO, total_bytes
from ..scene.plan import sea_over
from ..scene.refresh import sea_of_settings
from ..scene.settings import is_ocean, settings_of
from ..scene.units import metres_per_unit
from .active_ocean import shown_ocean
from .arrows import arrow_lines
from .panels.drawing import length_text

RealArray = NDArray[np.float32]

_MAPS = "overlays of coasts"
#: cells of the map, and arrows, along the longer side of the bed
_CELLS, _ARROWS = 160, 32
#: of the distance of two arrows: their length
_LENGTH = 0.7
#: colours of the map, from no waves to the highest, and how opaque it is
_RAMP = np.array(
    [(0.15, 0.05, 0.35), (0.16, 0.35, 0.60), (0.10, 0.62, 0.52), (0.60, 0.82, 0.25), (1.0, 0.92, 0.20)]
)
_ALPHA = 0.65
_ARROW, _WIDTH = (1.0, 1.0, 1.0, 0.9), 1.5
_FONT, _SIZE, _MARGIN, _BAR = 0, 12.0, 16.0, (120.0, 10.0)  # pixels, at a scale of 1


class StateMap(NamedTuple):
    """What is drawn over a bed.

    places : (vertices, 3) m, on still water
    colours : (vertices, 4) of the significant height
    triangles : (triangles, 3) between vertices on water
    lines : (lines, 2, 3) m, of all arrows
    highest : m, of which the last colour is
    """

    places: RealArray
    colours: RealArray
    triangles: NDArray[np.int32]
    lines: RealArray
    highest: float

    @property
    def nbytes(self) -> int:
        """Bytes of what is drawn."""
        return total_bytes(self[:4])


def state_map(item: bpy.types.Object, scene: bpy.types.Scene) -> StateMap | None:
    """What is drawn of an ocean; None without a coast, or where nothing is asked for or known yet."""
    group = settings_of(item).coast
    if not (group.use and (group.show_height or group.show_direction)):
        return None
    parameters = sea_of_settings(item, scene)
    if parameters is None or not parameters.has_coast:
        return None
    sea = sea_over(parameters)
    if sea.coast is None or not sea.coast.is_made:
        return None
    return MEMO.get(_MAPS, parameters, lambda: _made(sea))


def ramp(share: NDArray[np.floating]) -> RealArray:
    """(…, 4) colours of shares of the highest, 0…1."""
    stops = np.linspace(0.0, 1.0, len(_RAMP))
    parts = [np.interp(share, stops, _RAMP[:, index]) for index in range(3)]
    return np.stack([*parts, np.full(np.shape(share), _ALPHA)], axis=-1).astype(np.float32)


def _made(sea: Ocean) -> StateMap:
    assert sea.coast is not None
    x, y = sea.coast.ground.places
    rows, columns = x.shape
    depth, step = sea.coast.ground.depth, max(1, max(rows, columns) // _CELLS)
    here = np.ix_(range(0, rows, step), range(0, columns, step))
    found = sea.surface(0.0, {"significant_height"}, Places(x[here], y[here])).significant_height
    highest = max(float(found.max()), 1e-6)
    places = np.stack((x[here], y[here], np.zeros_like(found)), axis=-1)
    apart = max(1, max(rows, columns) // _ARROWS)
    there = np.ix_(range(apart // 2, rows, apart), range(apart // 2, columns, apart))
    wet = depth[there] > 0.0
    tail = np.stack((x[there][wet], y[there][wet]), axis=-1)
    towards = sea.surface(0.0, {"mean_direction"}, Places(tail[:, 0], tail[:, 1])).mean_direction
    along = towards.astype(np.float64) * (_LENGTH * apart * sea.coast.ground.step)
    lines = arrow_lines(tail - 0.5 * along, along).astype(np.float32)
    colours, triangles = ramp(found / highest).reshape(-1, 4), _triangles(depth[here] > 0.0)
    return StateMap(places.reshape(-1, 3).astype(np.float32), colours, triangles, lines, highest)


def _triangles(wet: NDArray[np.bool_]) -> NDArray[np.int32]:
    number = np.arange(wet.size, dtype=np.int32).reshape(wet.shape)
    corners = (
        (slice(-1), slice(-1)),
        (slice(1, None), slice(-1)),
        (slice(1, None), slice(1, None)),
        (slice(-1), slice(1, None)),
    )
    a, b, c, d = (number[corner] for corner in corners)
    is_water = np.logical_and.reduce([wet[corner] for corner in corners])
    return np.concatenate([np.stack(each, axis=-1)[is_water] for each in ((a, b, c), (a, c, d))])


def _shown() -> tuple[bpy.types.Object, StateMap] | None:
    context = bpy.context
    item = shown_ocean(context)
    if not (context.space_data.overlay.show_overlays and is_ocean(item) and item.visible_get()):
        return None
    found = state_map(item, context.scene)
    return None if found is None else (item, found)


def draw() -> None:
    """In the space of the scene."""
    shown = _shown()
    if shown is None:
        return
    import gpu
    from gpu_extras.batch import batch_for_shader

    item, found = shown
    group, units = settings_of(item).coast, np.float32(1 / metres_per_unit(bpy.context.scene))
    gpu.state.blend_set("ALPHA")
    with gpu.matrix.push_pop():
        gpu.matrix.multiply_matrix(item.matrix_world)
        if group.show_height:
            shader = gpu.shader.from_builtin("SMOOTH_COLOR")
            content = {"pos": found.places * units, "color": found.colours}
            batch_for_shader(shader, "TRIS", content, indices=found.triangles).draw(shader)
        if group.show_direction and len(found.lines):
            shader, region = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR"), bpy.context.region
            batch = batch_for_shader(shader, "LINES", {"pos": found.lines.reshape(-1, 3) * units})
            shader.uniform_float("viewportSize", (region.width, region.height))
            shader.uniform_float("lineWidth", _WIDTH * bpy.context.preferences.system.ui_scale)
            shader.uniform_float("color", _ARROW)
            batch.draw(shader)
    gpu.state.blend_set("NONE")


def draw_legend() -> None:
    """In pixels: which height has which colour."""
    shown = _shown()
    if shown is None or not settings_of(shown[0]).coast.show_height:
        return
    import blf
    import gpu
    from gpu_extras.batch import batch_for_shader

    context, highest = bpy.context, shown[1].highest
    scale = context.preferences.system.ui_scale
    tools = next((part.width for part in context.area.regions if part.type == "TOOLS"), 0)
    left, bottom = tools + _MARGIN * scale, _MARGIN * scale
    width, height = (side * scale for side in _BAR)
    across = np.linspace(0.0, 1.0, 2 * len(_RAMP))
    places = [(left + width * share, bottom + height * up) for share in across for up in (0.0, 1.0)]
    colours = np.repeat(ramp(across), 2, axis=0)
    colours[:, 3] = 1.0
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    batch_for_shader(shader, "TRI_STRIP", {"pos": places, "color": colours}).draw(shader)
    blf.size(_FONT, _SIZE * scale)
    blf.color(_FONT, 1.0, 1.0, 1.0, 1.0)
    blf.position(_FONT, left + width + 0.5 * _MARGIN * scale, bottom, 0.0)
    blf.draw(_FONT, f"Significant wave height, 0 to {length_text(context.scene, highest)}")
