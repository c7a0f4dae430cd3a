# SPDX-License-Identifier: GPL-3.0-or-later
"""What keeps an ocean from being shown is heard: on the console, and by the end of a background render.

In a window the panel and the 3D view tell it too, and somebody looks. In the background nobody does: a render
would go on and leave pictures of a sea that nobody made, so it ends before the picture is written, with exit
code 3. Blender ends it as by Ctrl-C, so films are closed and placeholders removed.
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
    """What of the present shot is known.

    said : what the console has heard: each thing once a shot
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
    """The settings of an ocean are no sea that can be shown; a render in the background ends."""
    # while a number is dragged, the console hears of its parameter once
    _failed(item, _SETTINGS + text.partition(" = ")[0], text)


def missed(item: bpy.types.Object, text: str) -> None:
    """A file is not there that the present frame should show; a render in the background ends."""
    _failed(item, text, text)


def warned(item: bpy.types.Object, subject: str, text: str) -> None:
    """Something is not as it seems to be.

    subject : of which the console hears once a shot, whatever the text
    """
    _say(logging.WARNING, item, subject, text)


def is_well(item: bpy.types.Object) -> None:
    """The settings are a sea: if they are none again, it is said again."""
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
    """End a background render, but for an ocean that is not in its pictures."""
    if not (_shot.is_rendered and bpy.app.background) or _shot.has_failed:
        return
    if item is not None and not _is_rendered(item):
        return
    if not bpy.app.module:  # whose signals are those of the script that renders, and so is its exit code
        _shot.has_failed = True
        signal.raise_signal(signal.SIGINT)


def render_begins() -> None:
    """A shot of its own: all is said again."""
    _shot.said.clear()
    _shot.is_rendered, _shot.has_failed = True, False


def render_ends() -> None:
    """No more pictures are written. A background render that failed ends Blender here."""
    _shot.is_rendered = False
    if _shot.has_failed:
        logging.shutdown()
        for stream in (sys.stdout, sys.stderr):
            if stream is not None:
                stream.flush()
        os._exit(EXIT_CODE)


def follow(item: bpy.types.Object) -> None:
    """The settings and files of an ocean were looked at: what is in the way now is told in the 3D view."""
    settings = settings_of(item)
    text = settings.error or missing_text(settings)
    if not text:
        _shot.troubles.pop(item.session_uid, None)
    elif item.session_uid in _shot.troubles:
        _trouble(item, text)


def keep_only(items: Iterable[bpy.types.Object]) -> None:
    """Forget what is wrong with oceans that are gone."""
    present = {item.session_uid for item in items}
    for uid in _shot.troubles.keys() - present:
        del _shot.troubles[uid]


def troubles() -> list[str]:
    """What is wrong now with oceans of the file that cannot be shown, a line each, for the 3D view."""
    return list(_shot.troubles.values())


def missing_text(settings: OceanSettings) -> str:
    """What to say of the file that the present frame of a sequence lacks; "" where it lacks none."""
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
    """Whether an ocean is in a picture of its scene, as far as its switches and collections say."""
    return not item.hide_render and is_in_view_layer(item, scene_of(item))
