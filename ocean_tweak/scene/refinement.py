# SPDX-License-Identifier: GPL-3.0-or-later
"""Progressive refinement: few samples while a parameter is dragged, then all of them, then foam with its
history and the statistics.

Only in a window. In the background there are no timers, and everything is done at once.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Container, Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from typing import Any, NamedTuple

import bpy

from ..core import OceanParameters
from . import bake_state, coast_surface, evaluation, foam_rings, live_spray, patch_objects, patch_points
from .modifiers import set_changed
from .plan import camera_surface_of, plan_for
from .refresh import EXPECTED_ERRORS, Wanted, is_live, refresh, tell
from .settings import OceanSettings, all_oceans, scene_of, settings_of

# time in s without a change after which all samples are shown
PAUSE = 0.15
# interval of the timer in s
_INTERVAL = 0.05

#: parts that wait for all samples
_AFTER_SAMPLES = Wanted.SAMPLES | Wanted.NEIGHBOURS
_NOTHING = Wanted(0)


def _waves_job(item: bpy.types.Object, scene: bpy.types.Scene) -> Callable[[], object]:
    """A job that computes the waves at full viewport resolution.

    Like the other jobs it accesses no Blender data and may run on any thread. Raises ParameterError or
    OceanObjectError for invalid settings.
    """
    plan = plan_for(item, settings_of(item), scene)
    seas = [plan.viewport_sea()]
    if patch_objects.lack_points(item):
        seas += patch_objects.seas_in_window(plan)
    return lambda: [evaluation.surfaces_of(sea).ocean.prepare() for sea in seas]


def _foam_job(item: bpy.types.Object, scene: bpy.types.Scene) -> Callable[[], object]:
    """A job that computes what the viewport lacks of foam, and of waves over a bed; raises the errors of
    `_waves_job`."""
    settings = settings_of(item)
    plan, jobs = plan_for(item, settings, scene), list[Callable[[], object]]()
    is_shown = coast_surface.is_live(item) or not coast_surface.is_baked(item)
    make_coast = coast_surface.making(plan) if is_shown else None
    if make_coast is not None:
        told = partial(_tell_or_end, item.session_uid, "Computing the waves over the bed…")
        jobs.append(partial(make_coast, told))
    if is_live(item):
        maker = evaluation.surfaces_of(plan.viewport_sea()).foam_of(plan.is_whole)
        jobs.append(lambda: maker.at(plan.time))
    surface = camera_surface_of(item)
    if surface is not None:
        points = patch_points.points_of(settings, plan, scene)
        around = foam_rings.around(surface, plan, points, scene)
        told = partial(_tell, item.session_uid, "Making the foam of earlier moments…")
        jobs += [partial(around.make, told)] if around is not None else []
    asked = live_spray.wanted(item, plan, scene)
    if asked is not None:
        jobs.append(asked.make)
    return lambda: [job() for job in jobs]


def _statistics_job(
    item: bpy.types.Object, scene: bpy.types.Scene
) -> Callable[[], tuple[OceanParameters, str]] | None:
    """A job that computes the statistics of the sea; None if they are known, and then they are shown."""
    settings = settings_of(item)
    if settings.error:
        return None
    parameters = bake_state.shown_parameters(settings, scene)
    text = evaluation.known_statistics(parameters)
    if text is None:
        return lambda: (parameters, evaluation.computed_statistics(parameters))
    set_changed(settings, statistics=text)
    return None


#: parts that follow later, and their jobs, which access no Blender data
_JOBS: dict[Wanted, Callable[[bpy.types.Object, bpy.types.Scene], Callable[[], object] | None]] = {
    Wanted.SAMPLES: _waves_job,
    Wanted.HISTORY: _foam_job,
    Wanted.STATISTICS: _statistics_job,
}


class Progress(NamedTuple):
    """Of long work for an ocean: what it is, and which share is done, 0…1."""

    doing: str
    share: float


class _OutdatedError(Exception):
    """What is being made is no longer wanted."""


def _tell(uid: int, doing: str, share: float) -> None:
    """From the thread: how far it is."""
    _outstanding.shares[uid] = Progress(doing, share)


def _tell_or_end(uid: int, doing: str, share: float) -> None:
    """As `_tell`. Raises _OutdatedError where the settings have changed meanwhile, or the file."""
    if _outstanding.lacks(uid, Wanted.SAMPLES) or (uid, Wanted.HISTORY) not in _outstanding.making:
        raise _OutdatedError
    _tell(uid, doing, share)


@dataclass
class _Outstanding:
    """Outstanding work, by the object's session uid.

    missing : missing parts of an ocean, from _JOBS
    due : time at which all samples are due
    making : parts being computed
    shares : progress of foam around a camera, or of waves over a bed, that are being computed
    worker : the thread
    """

    missing: dict[int, Wanted] = field(default_factory=dict)
    due: dict[int, float] = field(default_factory=dict)
    making: dict[tuple[int, Wanted], Future[Any]] = field(default_factory=dict)
    shares: dict[int, Progress] = field(default_factory=dict)
    worker: ThreadPoolExecutor | None = None

    @property
    def uids(self) -> set[int]:
        """Objects with outstanding work."""
        return {*self.missing, *(uid for uid, _ in self.making)}

    def lacks(self, uid: int, parts: Wanted) -> bool:
        """Whether an object lacks any of some parts."""
        return bool(self.missing.get(uid, _NOTHING) & parts)

    def note(self, uid: int, parts: Wanted, is_missing: bool) -> None:
        """Note that an object lacks some parts, or no longer does."""
        before = self.missing.pop(uid, _NOTHING)
        left = before | parts if is_missing else before & ~parts
        if left:
            self.missing[uid] = left

    def keep_only(self, uids: Iterable[int]) -> None:
        """Drop objects that no longer exist."""
        for uid in self.uids.difference(uids):
            self.missing.pop(uid, None)
            self.due.pop(uid, None)
            self.shares.pop(uid, None)
            for part in _JOBS:
                self.making.pop((uid, part), None)

    def submit(self, uid: int, part: Wanted, job: Callable[[], object]) -> None:
        """Submit a job to the thread."""
        if self.worker is None:
            self.worker = ThreadPoolExecutor(1, "Ocean Tweak")
        if part is Wanted.HISTORY:
            self.shares.pop(uid, None)
        self.making[uid, part] = self.worker.submit(job)

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
    wanted: Wanted = Wanted.ALL,
    shown: OceanSettings | None = None,
) -> None:
    """Update what is wanted of an ocean for its settings and the scene's frame; in a window, slow parts
    follow later. Problems are stored in `error`.

    All events arrive here: a changed setting, a frame, a render, an opened file.

    shown : the settings as animation makes them, where it does
    """
    if not has_window():
        # computing statistics in each frame of an animated sea would cost more than the frame
        _show_now(item, scene, wanted if shown is None else wanted & ~Wanted.STATISTICS, shown)
        return
    uid = item.session_uid
    now = wanted & ~Wanted.STATISTICS
    if Wanted.RENDER in wanted:  # which does not wait
        late = Wanted.ALL & ~Wanted.STATISTICS if is_unfinished(item) else _NOTHING
        _show_now(item, scene, now | late, shown)
        return
    if Wanted.BY_HAND in wanted or _outstanding.lacks(uid, Wanted.SAMPLES):
        now &= ~_AFTER_SAMPLES
    # the frame of a render from the window is made on another thread: it is complete, and timers belong here
    in_window = threading.current_thread() is threading.main_thread()
    missing = _show_now(item, scene, now & ~Wanted.HISTORY if in_window else now, shown)
    if not in_window or not wanted & (Wanted.SURFACE | Wanted.PATCHES):
        return
    if Wanted.BY_HAND in wanted:
        _outstanding.due[uid] = time.monotonic() + PAUSE
        _outstanding.note(uid, Wanted.SAMPLES | Wanted.STATISTICS, True)
    elif Wanted.SURFACE in wanted and not (_is_playing() or _has_statistics(item, scene)):
        _outstanding.note(uid, Wanted.STATISTICS, True)
    follow_up(item, missing)


def show_new(item: bpy.types.Object, scene: bpy.types.Scene, wanted: Wanted = Wanted.ALL) -> None:
    """Show an ocean for the first time; in a window, slow parts follow later.

    Raises as `refresh`.
    """
    if not has_window():
        refresh(item, scene, wanted)
        return
    missing = refresh(item, scene, wanted & ~(Wanted.HISTORY | Wanted.STATISTICS))
    if Wanted.STATISTICS in wanted and not _has_statistics(item, scene):
        _outstanding.note(item.session_uid, Wanted.STATISTICS, True)
    follow_up(item, missing)


def follow_up(item: bpy.types.Object, missing: Wanted) -> None:
    """In a window, compute the foam's history later if a refresh left it out."""
    if not has_window():
        return
    _outstanding.note(item.session_uid, Wanted.HISTORY, Wanted.HISTORY in missing)
    if item.session_uid in _outstanding.uids and not bpy.app.timers.is_registered(go_on):
        bpy.app.timers.register(go_on, first_interval=_INTERVAL)


def _show_now(
    item: bpy.types.Object, scene: bpy.types.Scene, wanted: Wanted, shown: OceanSettings | None = None
) -> Wanted:
    """Refresh, and store any problem. Returns the missing parts."""
    try:
        return refresh(item, scene, wanted, shown)
    except EXPECTED_ERRORS as error:
        tell(item, error)
    return _NOTHING


def _is_playing() -> bool:
    return any(window.screen.is_animation_playing for window in bpy.context.window_manager.windows)


def _has_statistics(item: bpy.types.Object, scene: bpy.types.Scene) -> bool:
    """Whether the ocean's statistics are up to date, or impossible."""
    settings = settings_of(item)
    return bool(settings.error) or (
        evaluation.known_statistics(bake_state.shown_parameters(settings, scene)) == settings.statistics
    )


def has_window() -> bool:
    """Whether there is a window."""
    return not bpy.app.background


def is_unfinished(item: bpy.types.Object) -> bool:
    """Whether the viewport will soon show more: all samples, or foam with its history."""
    return _outstanding.lacks(item.session_uid, Wanted.SAMPLES | Wanted.HISTORY)


def progress_of(item: bpy.types.Object) -> Progress | None:
    """Progress of foam around a camera, or of waves over a bed, that are being computed; None if none are."""
    uid = item.session_uid
    return _outstanding.shares.get(uid) if (uid, Wanted.HISTORY) in _outstanding.making else None


def is_outstanding(item: bpy.types.Object) -> bool:
    """Whether the surface or the statistics are not yet up to date."""
    return item.session_uid in _outstanding.uids


def forget_all() -> None:
    """Drop all work: another file is opened, or the extension is disabled."""
    if bpy.app.timers.is_registered(go_on):
        bpy.app.timers.unregister(go_on)
    _outstanding.clear()


def go_on() -> float | None:
    """The timer: one step for each ocean. Returns the seconds to the next one, None if nothing is left."""
    if bpy.app.is_job_running("RENDER"):
        return 10 * _INTERVAL
    oceans = {item.session_uid: item for item in all_oceans() if item.users_scene}
    _outstanding.keep_only(oceans)
    made = [key for key, future in _outstanding.making.items() if future.done()]
    for uid, part in made:
        _take(oceans[uid], part, _outstanding.making.pop((uid, part)))
    for uid, parts in list(_outstanding.missing.items()):
        for part in parts:
            _start(oceans[uid], part)
    if made:
        redraw_views()
    elif any(part is Wanted.HISTORY for _, part in _outstanding.making):
        redraw_views({"UI"})  # redraw the progress bar
    return _INTERVAL if _outstanding.uids else None


def _start(item: bpy.types.Object, part: Wanted) -> None:
    """Start a job for a missing part of an ocean, unless one is running or it has to wait."""
    uid = item.session_uid
    if part is Wanted.SAMPLES:
        has_to_wait = _outstanding.due[uid] > time.monotonic()
    else:
        has_to_wait = _outstanding.lacks(uid, Wanted.SAMPLES)
    if has_to_wait or (uid, part) in _outstanding.making:
        return
    try:
        job = _JOBS[part](item, scene_of(item))
    except EXPECTED_ERRORS as error:
        _fail(item, part, error)
        return
    if job is None:
        _outstanding.note(uid, part, False)
    else:
        _outstanding.submit(uid, part, job)


def _take(item: bpy.types.Object, part: Wanted, future: Future[Any]) -> None:
    """Show the result for an ocean, unless its sea has changed meanwhile: then compute it again."""
    uid = item.session_uid
    if part is Wanted.SAMPLES:
        if _outstanding.due[uid] > time.monotonic():
            return
    elif part is Wanted.HISTORY and _outstanding.lacks(uid, Wanted.SAMPLES):
        return
    try:
        made = future.result()
    except _OutdatedError:  # it begins again
        return
    except EXPECTED_ERRORS as error:
        _fail(item, part, error)
        return
    if part is Wanted.STATISTICS:
        evaluation.keep_statistics(*made)  # and shown where they are looked for next
        return
    _outstanding.note(uid, part, False)
    # the history is complete, unless time has jumped again
    missing = _show_now(item, scene_of(item), Wanted.ALL & ~(Wanted.STATISTICS | Wanted.HISTORY))
    _outstanding.note(uid, Wanted.HISTORY, Wanted.HISTORY in missing)


def _fail(item: bpy.types.Object, part: Wanted, error: BaseException) -> None:
    _outstanding.note(item.session_uid, part, False)
    tell(item, error)


def redraw_views(regions: Container[str] = ("UI", "WINDOW")) -> None:
    """Let the 3D views and their panels show what is new, or some regions of them."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            for region in area.regions if area.type == "VIEW_3D" else ():
                if region.type in regions:
                    region.tag_redraw()
