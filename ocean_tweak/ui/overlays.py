# SPDX-License-Identifier: GPL-3.0-or-later
"""Overlays of the 3D view: arrows for the wind of the active ocean's layers, and messages about oceans that
cannot be shown, as the visible sea is then outdated.
"""

from __future__ import annotations

import textwrap

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import WindFieldLayer
from ..core.waves.wind_field.wind import bilinear
from ..scene import failures
from ..scene.animated import clock_of
from ..scene.refresh import sea_of_settings
from ..scene.settings import is_ocean, settings_of
from ..scene.units import metres_per_unit
from . import coast_overlay
from .active_ocean import shown_ocean
from .arrows import arrow_lines

#: arrows along each side of the patch
_ARROWS = 16
#: of the distance of two arrows: the length of the strongest
_LENGTH = 0.9
_COLOUR, _WIDTH = (1.0, 0.65, 0.1, 0.9), 1.5

_FONT = 0  # Blender's own
_SIZE, _LINE, _MARGIN = 13.0, 18.0, 14.0  # pixels, at a scale of 1
_BELOW_TOP = 75.0  # Blender's own text about the view stands above
_LETTER = 0.55  # width of a letter over the size of the font
_TEXT, _SHADOW = (1.0, 0.5, 0.4, 1.0), (0.0, 0.0, 0.0, 0.8)

# what Blender gave for the drawing, needed to take it back
_handles: list[object] = []


def register() -> None:
    """Add the draw handlers, if there is a window."""
    if not bpy.app.background:
        for draw, kind in (
            (coast_overlay.draw, "POST_VIEW"), (_draw_wind, "POST_VIEW"),
            (coast_overlay.draw_legend, "POST_PIXEL"), (_draw_troubles, "POST_PIXEL"),
        ):  # fmt: skip
            _handles.append(bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", kind))


def unregister() -> None:
    """Remove the draw handlers."""
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")


def wind_lines(item: bpy.types.Object, scene: bpy.types.Scene) -> NDArray[np.float32]:
    """(n, 2, 3) ends of the lines of all arrows, in Blender units of the ocean's own space."""
    settings = settings_of(item)
    shown = [layer.wind_field.show_vectors for layer in settings.layers if layer.kind == "WIND_FIELD"]
    if not any(shown):
        return np.zeros((0, 2, 3), np.float32)
    parameters = sea_of_settings(item, scene)
    if parameters is None:
        return np.zeros((0, 2, 3), np.float32)
    time = float(clock_of(settings, scene, parameters.timing.start_frame).time)
    size = parameters.domain_size
    parts = [
        arrows(layer, time, size)
        for layer, is_shown in zip(parameters.of(WindFieldLayer), shown, strict=True)
        if is_shown and not layer.muted
    ]
    metres = float(metres_per_unit(scene))
    return np.concatenate([np.zeros((0, 2, 3)), *parts]).astype(np.float32) / np.float32(metres)


def arrows(layer: WindFieldLayer, time: float, size: float) -> NDArray[np.float64]:
    """(n, 2, 3) lines in m: a shaft and two strokes of a head for each place where wind blows.

    time : s
    size : side of the patch, m
    """
    step = size / _ARROWS
    x, y = (axis.ravel() for axis in np.meshgrid(*2 * [(np.arange(_ARROWS) + 0.5) * step]))
    wind = wind_now(layer, time, x, y, size)
    if layer.greatest_speed == 0.0:
        return np.zeros((0, 2, 3))
    along = wind * (_LENGTH * step / layer.greatest_speed)
    blowing = np.hypot(*along.T) > 0.0
    return arrow_lines(np.stack((x, y), axis=-1)[blowing], along[blowing])


def wind_now(
    layer: WindFieldLayer, time: float, x: NDArray[np.float64], y: NDArray[np.float64], size: float
) -> NDArray[np.float64]:
    """(places, 2) the layer's wind in m/s at places in m: of the keys around the time alone."""
    if not layer.keys:
        direction = np.array([np.cos(layer.wind_direction), np.sin(layer.wind_direction)])
        return np.tile(layer.wind_scale * layer.wind_speed * direction, (len(x), 1))
    times = np.array([key.time for key in layer.keys])
    after = int(np.clip(np.searchsorted(times, time), 1, max(len(times) - 1, 1)))
    near = layer.rasters[after - 1 : after + 1]
    values = [bilinear(raster, x, y, size) for raster in near]
    if len(near) == 1:
        return layer.wind_scale * values[0]
    share = float(np.clip((time - times[after - 1]) / (times[after] - times[after - 1]), 0.0, 1.0))
    return layer.wind_scale * ((1.0 - share) * values[0] + share * values[1])


def _draw_wind() -> None:
    context = bpy.context
    item, space = shown_ocean(context), context.space_data
    if not (space.overlay.show_overlays and is_ocean(item) and item.visible_get()):
        return
    ends = wind_lines(item, context.scene)
    if not len(ends):
        return
    import gpu
    from gpu_extras.batch import batch_for_shader

    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    batch = batch_for_shader(shader, "LINES", {"pos": ends.reshape(-1, 3)})
    region = context.region
    shader.uniform_float("viewportSize", (region.width, region.height))
    shader.uniform_float("lineWidth", _WIDTH * context.preferences.system.ui_scale)
    shader.uniform_float("color", _COLOUR)
    gpu.state.blend_set("ALPHA")
    with gpu.matrix.push_pop():
        gpu.matrix.multiply_matrix(item.matrix_world)
        batch.draw(shader)
    gpu.state.blend_set("NONE")


def trouble_lines(width: float) -> list[str]:
    """What is written, wrapped to a width in pixels at a scale of 1."""
    letters = max(int((width - 2.0 * _MARGIN) / (_LETTER * _SIZE)), 20)
    return [line for text in failures.troubles() for line in textwrap.wrap(text, letters)]


def _draw_troubles() -> None:
    area, region = bpy.context.area, bpy.context.region
    scale = bpy.context.preferences.system.ui_scale
    # bars lie over the view
    beside = {part.type: part for part in area.regions}
    left, right = (beside[kind].width if kind in beside else 0 for kind in ("TOOLS", "UI"))
    bars = sum(beside[kind].height for kind in ("HEADER", "TOOL_HEADER") if kind in beside)
    written = trouble_lines((region.width - left - right) / scale)
    if not written:
        return
    import blf

    blf.size(_FONT, _SIZE * scale)
    blf.color(_FONT, *_TEXT)
    blf.enable(_FONT, blf.SHADOW)
    blf.shadow(_FONT, 3, *_SHADOW)
    top = region.height - bars - _BELOW_TOP * scale
    for index, line in enumerate(written):
        blf.position(_FONT, left + _MARGIN * scale, top - index * _LINE * scale, 0.0)
        blf.draw(_FONT, line)
    blf.disable(_FONT, blf.SHADOW)
