# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports problems that keep an ocean from being shown: on the console, and by ending a background render.

In a window, the panel and the 3D view also show them. A background render would continue and write pictures
of a wrong sea, so it ends before the picture is written, with exit code 3. It is ended as by Ctrl-C, so movie
files are closed and placeholders removed.
"""

from __future__ import annotations

import logging
import os
import signal
import sys
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import bpy

from .settings import OceanSettings, scene_of, settings_of
from .view_layers import is_in_view_layer

_log = logging.getLogger(__name__)

#: of a background render that met a frame which cannot be shown
EXIT_CODE = 3

#: begins the subjects of settings that are refused
_SETTINGS = "settings: "


@dataclass
class _Shot:
    """State of the present shot.

    said : messages printed so far, as each is printed once per shot
    is_rendered : whether it is being rendered now
    has_failed : whether this render met a frame that cannot be shown
    troubles : what keeps oceans from being shown, by their session uid
    """

    said: set[tuple[int, str]] = field(default_factory=set)
    is_rendered: bool = False
    has_failed: bool = False
    troubles: dict[int, str] = field(default_factory=dict)


_shot = _Shot()


def refused(item: bpy.types.Object, text: str) -> None:
    """Report invalid settings of an ocean; a background render ends."""
    # while a value is dragged, report its parameter once
    _failed(item, _SETTINGS + text.partition(" = ")[0], text)


def missed(item: bpy.types.Object, text: str) -> None:
    """Report a missing file of the present frame; a background render ends."""
    _failed(item, text, text)


def warned(item: bpy.types.Object, subject: str, text: str) -> None:
    """Print a warning.

    subject : printed once per shot, whatever the text
    """
    _say(logging.WARNING, item, subject, text)


def is_well(item: bpy.types.Object) -> None:
    """The settings are valid: report it again if they become invalid."""
    if not _shot.is_rendered:
        _shot.said -= {
            (uid, subject)
            for uid, subject in _shot.said
            if uid == item.session_uid and subject.startswith(_SETTINGS)
        }


def _failed(item: bpy.types.Object, subject: str, text: str) -> None:
    _trouble(item, text)
    _say(logging.ERROR, item, subject, text)
    fail_render(item)


def fail_render(item: bpy.types.Object | None = None) -> None:
    """End a background render, unless the ocean is not in its pictures."""
    if not (_shot.is_rendered and bpy.app.background) or _shot.has_failed:
        return
    if item is not None and not _is_rendered(item):
        return
    if not bpy.app.module:  # there, signals and exit code belong to the script that renders
        _shot.has_failed = True
        signal.raise_signal(signal.SIGINT)


def render_begins() -> None:
    """A new shot: print all messages again."""
    _shot.said.clear()
    _shot.is_rendered, _shot.has_failed = True, False


def render_ends() -> None:
    """The render has ended. A failed background render ends Blender here."""
    _shot.is_rendered = False
    if _shot.has_failed:
        logging.shutdown()
        for stream in (sys.stdout, sys.stderr):
            if stream is not None:
                stream.flush()
        os._exit(EXIT_CODE)


def follow(item: bpy.types.Object) -> None:
    """Update the problems of an ocean, after its settings and files were checked, for the 3D view."""
    settings = settings_of(item)
    text = settings.error or missing_text(settings)
    if not text:
        _shot.troubles.pop(item.session_uid, None)
    elif item.session_uid in _shot.troubles:
        _trouble(item, text)


def keep_only(items: Iterable[bpy.types.Object]) -> None:
    """Drop problems of oceans that no longer exist."""
    present = {item.session_uid for item in items}
    for uid in _shot.troubles.keys() - present:
        del _shot.troubles[uid]


def troubles() -> list[str]:
    """The present problems of oceans that cannot be shown, one line each, for the 3D view."""
    return list(_shot.troubles.values())


def missing_text(settings: OceanSettings) -> str:
    """Message for a missing file of a sequence's present frame; "" if none is missing."""
    if not settings.missing_file:
        return ""
    path = Path(settings.missing_file)
    return f"{path.name} is missing: bake it again or choose other files. Looked in {path.parent}"


def forget_all() -> None:
    """Another file is opened."""
    _shot.said.clear()
    _shot.troubles.clear()


def _trouble(item: bpy.types.Object, text: str) -> None:
    _shot.troubles[item.session_uid] = f"{item.name}: {text}"


def _say(level: int, item: bpy.types.Object, subject: str, text: str) -> None:
    entry = (item.session_uid, subject)
    if entry not in _shot.said:
        _shot.said.add(entry)
        _log.log(level, "%s, frame %s: %s", item.name, scene_of(item).frame_current, text)


def _is_rendered(item: bpy.types.Object) -> bool:
    """Whether an ocean is rendered in its scene, by its visibility settings and collections."""
    return not item.hide_render and is_in_view_layer(item, scene_of(item))
