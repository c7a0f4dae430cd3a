# SPDX-License-Identifier: GPL-3.0-or-later
"""What is shown at once and what follows: a few samples while a parameter is dragged, then all of them, then
foam with its history and the statistics.

Only in a window. Without one there are no timers, and everything is done at once.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import bpy

from ..core import OceanParameters
from . import bake_state, evaluation
from .refresh import (
    EXPECTED_ERRORS,
    foam_job,
    has_statistics,
    refresh_and_tell,
    tell,
    waves_job,
)
from .settings import OceanSettings, all_oceans, scene_of, set_changed, settings_of

# s without a change after which all samples are shown
PAUSE = 0.15
# s between two looks at what is to be done
_INTERVAL = 0.05


@dataclass
class _Outstanding:
    """What is still to be done, by the object's session uid.

    coarse : when all samples are due
    preparing : the waves of all samples that are being made
    uncounted : oceans whose statistics are to be made
    counting : sea and result of those that are being made
    foamless : oceans whose foam lacks its history
    foaming : the foam that is being made
    worker : the thread that makes waves, foam and statistics; they touch no data of Blender
    """

    coarse: dict[int, float] = field(default_factory=dict)
    preparing: dict[int, Future[object]] = field(default_factory=dict)
    uncounted: set[int] = field(default_factory=set)
    counting: dict[int, tuple[OceanParameters, Future[str]]] = field(default_factory=dict)
    foamless: set[int] = field(default_factory=set)
    foaming: dict[int, Future[object]] = field(default_factory=dict)
    worker: ThreadPoolExecutor | None = None

    @property
    def uids(self) -> set[int]:
        """Objects with something to be done."""
        return {*self.coarse, *self.preparing, *self.uncounted, *self.counting, *self.foamless, *self.foaming}

    def keep_only(self, uids: Iterable[int]) -> None:
        """Forget objects that are gone."""
        for uid in self.uids.difference(uids):
            self.coarse.pop(uid, None)
            self.preparing.pop(uid, None)
            self.uncounted.discard(uid)
            self.counting.pop(uid, None)
            self.foamless.discard(uid)
            self.foaming.pop(uid, None)

    def submit(self, job: Callable[[], object]) -> Future[Any]:
        """Let the thread do something."""
        if self.worker is None:
            self.worker = ThreadPoolExecutor(1, "Ocean Tweak")
        return self.worker.submit(job)

    def clear(self) -> None:
        """Forget all objects, and end the thread."""
        self.keep_only(())
        if self.worker is not None:
            self.worker.shutdown(wait=False, cancel_futures=True)
            self.worker = None


_outstanding = _Outstanding()


def show(
    item: bpy.types.Object,
    scene: bpy.types.Scene,
    dragged: bool = False,
    shown: OceanSettings | None = None,
) -> None:
    """Refresh an ocean, now or in two steps; what is wrong with it is kept in `error`.

    dragged : a setting changed, and it may change again within a moment
    shown : the settings as animation makes them, where it does
    """
    if not has_window():
        # statistics of each frame of an animated sea would cost more than the frame
        refresh_and_tell(item, scene, statistics=shown is None, shown=shown)
        return
    uid = item.session_uid
    in_window = threading.current_thread() is threading.main_thread()
    # a render's frame is complete, it needs no statistics, and timers belong to the main thread
    coarse = dragged or uid in _outstanding.coarse
    complete = refresh_and_tell(
        item, scene, coarse=coarse, statistics=False, patient=not in_window, shown=shown
    )
    if not in_window:
        return
    if dragged:
        _outstanding.coarse[uid] = time.monotonic() + PAUSE
    if dragged or not (_is_playing() or has_statistics(item, scene)):
        _outstanding.uncounted.add(uid)
    _note_foam(uid, complete)
    if uid in _outstanding.uids and not bpy.app.timers.is_registered(go_on):
        bpy.app.timers.register(go_on, first_interval=_INTERVAL)


def _note_foam(uid: int, complete: bool) -> None:
    if complete:
        _outstanding.foamless.discard(uid)
    else:
        _outstanding.foamless.add(uid)


def _is_playing() -> bool:
    return any(window.screen.is_animation_playing for window in bpy.context.window_manager.windows)


def has_window() -> bool:
    """Whether somebody looks."""
    return not bpy.app.background


def is_unfinished(item: bpy.types.Object) -> bool:
    """Whether the viewport will show more in a moment: all samples, or foam with its history."""
    uid = item.session_uid
    return uid in _outstanding.coarse or uid in _outstanding.foamless


def is_outstanding(item: bpy.types.Object) -> bool:
    """Whether the surface or the statistics shown are not yet those of the settings."""
    return item.session_uid in _outstanding.uids


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
    done = [*_show_all_samples(oceans), *_take_foam(oceans), *_take_statistics(oceans)]
    _start_waves(oceans)
    _start_foam(oceans)
    _start_statistics(oceans)
    if done:
        _redraw_panels()
    return _INTERVAL if _outstanding.uids else None


def _start_waves(oceans: dict[int, bpy.types.Object]) -> None:
    now = time.monotonic()
    for uid, due in list(_outstanding.coarse.items()):
        if due > now or uid in _outstanding.preparing:
            continue
        try:
            job = waves_job(oceans[uid], scene_of(oceans[uid]))
        except EXPECTED_ERRORS as error:
            del _outstanding.coarse[uid]
            tell(oceans[uid], error)
        else:
            _outstanding.preparing[uid] = _outstanding.submit(job)


def _show_all_samples(oceans: dict[int, bpy.types.Object]) -> Iterator[int]:
    for uid, future in list(_outstanding.preparing.items()):
        if not future.done():
            continue
        del _outstanding.preparing[uid]
        if _outstanding.coarse.get(uid, 0.0) > time.monotonic():
            continue  # another sea was set meanwhile
        _outstanding.coarse.pop(uid, None)
        _refresh(uid, oceans[uid])  # tells what went wrong with the waves, too
        yield uid


def _refresh(uid: int, item: bpy.types.Object) -> None:
    _note_foam(uid, refresh_and_tell(item, scene_of(item), statistics=False, patient=False))


def _start_foam(oceans: dict[int, bpy.types.Object]) -> None:
    for uid in _outstanding.foamless - _outstanding.coarse.keys() - _outstanding.foaming.keys():
        try:
            job = foam_job(oceans[uid], scene_of(oceans[uid]))
        except EXPECTED_ERRORS as error:
            _outstanding.foamless.discard(uid)
            tell(oceans[uid], error)
        else:
            _outstanding.foaming[uid] = _outstanding.submit(job)


def _take_foam(oceans: dict[int, bpy.types.Object]) -> Iterator[int]:
    for uid, future in list(_outstanding.foaming.items()):
        if not future.done():
            continue
        del _outstanding.foaming[uid]
        try:
            future.result()
        except EXPECTED_ERRORS as error:
            _outstanding.foamless.discard(uid)
            tell(oceans[uid], error)
        else:
            _refresh(uid, oceans[uid])  # the history is there now, unless time has jumped again
        yield uid


def _start_statistics(oceans: dict[int, bpy.types.Object]) -> None:
    for uid in _outstanding.uncounted - _outstanding.coarse.keys() - _outstanding.counting.keys():
        _outstanding.uncounted.discard(uid)
        item = oceans[uid]
        if has_statistics(item, scene_of(item)):
            continue
        parameters = bake_state.shown_parameters(settings_of(item), scene_of(item))
        future = _outstanding.submit(partial(evaluation.computed_statistics, parameters))
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


def _redraw_panels() -> None:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
