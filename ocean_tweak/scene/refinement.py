# SPDX-License-Identifier: GPL-3.0-or-later
"""What is shown at once and what follows: a few samples while a parameter is dragged, then all of them, then
the statistics.

Only in a window. Without one there are no timers, and everything is done at once.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field

import bpy

from ..core import OceanParameters
from . import evaluation
from .refresh import EXPECTED_ERRORS, has_statistics, refresh_and_tell, set_changed, tell
from .settings import all_oceans, settings_of

# s without a change after which all samples are shown
PAUSE = 0.15
# s between two looks at what is to be done
_INTERVAL = 0.05


@dataclass
class _Outstanding:
    """What is still to be done, by the object's session uid.

    coarse : when all samples are due
    uncounted : oceans whose statistics are to be made
    counting : sea and result of those that are being made
    counter : the thread that makes them; they touch no data of Blender
    """

    coarse: dict[int, float] = field(default_factory=dict)
    uncounted: set[int] = field(default_factory=set)
    counting: dict[int, tuple[OceanParameters, Future[str]]] = field(default_factory=dict)
    counter: ThreadPoolExecutor | None = None

    def keep_only(self, uids: Iterable[int]) -> None:
        """Forget objects that are gone."""
        for uid in {*self.coarse, *self.uncounted, *self.counting}.difference(uids):
            self.coarse.pop(uid, None)
            self.uncounted.discard(uid)
            self.counting.pop(uid, None)

    def clear(self) -> None:
        """Forget all objects, and end the thread."""
        self.keep_only(())
        if self.counter is not None:
            self.counter.shutdown(wait=False, cancel_futures=True)
            self.counter = None


_outstanding = _Outstanding()


def show(item: bpy.types.Object, scene: bpy.types.Scene, dragged: bool = False) -> None:
    """Refresh an ocean, now or in two steps; what is wrong with it is kept in `error`.

    dragged : a setting changed, and it may change again within a moment
    """
    if not has_window():
        refresh_and_tell(item, scene)
        return
    uid = item.session_uid
    refresh_and_tell(item, scene, coarse=dragged or uid in _outstanding.coarse, statistics=False)
    if threading.current_thread() is not threading.main_thread():
        return  # a render's frame: it needs no statistics, and timers belong to the main thread
    if dragged:
        _outstanding.coarse[uid] = time.monotonic() + PAUSE
    if dragged or not has_statistics(item, scene):
        _outstanding.uncounted.add(uid)
        if not bpy.app.timers.is_registered(go_on):
            bpy.app.timers.register(go_on, first_interval=_INTERVAL)


def has_window() -> bool:
    """Whether somebody looks."""
    return not bpy.app.background


def is_coarse(item: bpy.types.Object) -> bool:
    """Whether the viewport shows fewer samples than it will in a moment."""
    return item.session_uid in _outstanding.coarse


def is_outstanding(item: bpy.types.Object) -> bool:
    """Whether the surface or the statistics shown are not yet those of the settings."""
    uid = item.session_uid
    return uid in _outstanding.coarse or uid in _outstanding.uncounted or uid in _outstanding.counting


def forget_all() -> None:
    """Do nothing more: another file is opened, or the extension is disabled."""
    if bpy.app.timers.is_registered(go_on):
        bpy.app.timers.unregister(go_on)
    _outstanding.clear()


def go_on() -> float | None:
    """The timer: one step for each ocean. Returns the seconds to the next one, None when nothing is left."""
    if bpy.app.is_job_running("RENDER"):
        return 10 * _INTERVAL
    oceans = {item.session_uid: item for item in all_oceans() if item.users_scene}
    _outstanding.keep_only(oceans)
    done = [*_show_all_samples(oceans), *_take_statistics(oceans)]
    _start_statistics(oceans)
    if done:
        _redraw_panels()
    left = _outstanding.coarse or _outstanding.uncounted or _outstanding.counting
    return _INTERVAL if left else None


def _show_all_samples(oceans: dict[int, bpy.types.Object]) -> Iterator[int]:
    now = time.monotonic()
    for uid in [uid for uid, due in _outstanding.coarse.items() if due <= now]:
        del _outstanding.coarse[uid]
        refresh_and_tell(oceans[uid], _scene_of(oceans[uid]), statistics=False)
        yield uid


def _start_statistics(oceans: dict[int, bpy.types.Object]) -> None:
    for uid in _outstanding.uncounted - _outstanding.coarse.keys() - _outstanding.counting.keys():
        _outstanding.uncounted.discard(uid)
        item = oceans[uid]
        if has_statistics(item, _scene_of(item)):
            continue
        parameters = settings_of(item).to_parameters(_scene_of(item))
        if _outstanding.counter is None:
            _outstanding.counter = ThreadPoolExecutor(1, "Ocean Tweak statistics")
        future = _outstanding.counter.submit(evaluation.computed_statistics, parameters)
        _outstanding.counting[uid] = (parameters, future)


def _take_statistics(oceans: dict[int, bpy.types.Object]) -> Iterator[int]:
    for uid, (parameters, future) in list(_outstanding.counting.items()):
        if not future.done():
            continue
        del _outstanding.counting[uid]
        try:
            text = future.result()
        except EXPECTED_ERRORS as error:
            tell(oceans[uid], error)
        else:
            evaluation.keep_statistics(parameters, text)
            if uid not in _outstanding.uncounted:  # otherwise another sea was set meanwhile
                set_changed(settings_of(oceans[uid]), statistics=text)
        yield uid


def _scene_of(item: bpy.types.Object) -> bpy.types.Scene:
    scene = bpy.context.scene
    return scene if scene in item.users_scene else item.users_scene[0]


def _redraw_panels() -> None:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
