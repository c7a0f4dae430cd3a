# SPDX-License-Identifier: GPL-3.0-or-later
"""What keeps oceans from being shown, written over the 3D view: the sea that stands there is an old one."""

from __future__ import annotations

import textwrap

import bpy

from ..scene import alarm

_FONT = 0  # Blender's own
_SIZE, _LINE, _MARGIN = 13.0, 18.0, 14.0  # pixels, at a scale of 1
_BELOW_TOP = 75.0  # Blender's own text about the view stands above
_LETTER = 0.55  # width of a letter over the size of the font
_COLOUR, _SHADOW = (1.0, 0.5, 0.4, 1.0), (0.0, 0.0, 0.0, 0.8)

# what Blender gave for the drawing, needed to take it back
_handles: list[object] = []


def register() -> None:
    """Draw in every 3D view; without a window there is none."""
    if not bpy.app.background:
        _handles.append(bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL"))


def unregister() -> None:
    """Draw no more."""
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")


def lines(width: float) -> list[str]:
    """What is written, wrapped to a width in pixels at a scale of 1."""
    letters = max(int((width - 2.0 * _MARGIN) / (_LETTER * _SIZE)), 20)
    return [line for text in alarm.troubles() for line in textwrap.wrap(text, letters)]


def _draw() -> None:
    area, region = bpy.context.area, bpy.context.region
    scale = bpy.context.preferences.system.ui_scale
    # bars lie over the view
    beside = {part.type: part for part in area.regions}
    left, right = (beside[kind].width if kind in beside else 0 for kind in ("TOOLS", "UI"))
    bars = sum(beside[kind].height for kind in ("HEADER", "TOOL_HEADER") if kind in beside)
    written = lines((region.width - left - right) / scale)
    if not written:
        return
    import blf

    blf.size(_FONT, _SIZE * scale)
    blf.color(_FONT, *_COLOUR)
    blf.enable(_FONT, blf.SHADOW)
    blf.shadow(_FONT, 3, *_SHADOW)
    top = region.height - bars - _BELOW_TOP * scale
    for index, line in enumerate(written):
        blf.position(_FONT, left + _MARGIN * scale, top - index * _LINE * scale, 0.0)
        blf.draw(_FONT, line)
    blf.disable(_FONT, blf.SHADOW)
