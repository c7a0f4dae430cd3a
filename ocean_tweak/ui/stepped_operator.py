# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that work on Blender's data a step at a time: the window shows how far they are, Esc gives up."""

from __future__ import annotations

import time
from typing import Any, Protocol

import bpy
from bpy.app.translations import pgettext_rpt as translated

from ..scene import ocean_object
from .active_ocean import refuse

_EXPECTED_ERRORS = (OSError, *ocean_object.EXPECTED_ERRORS)
_TURN = 0.05  # s of work before the window may draw again
_LOOK = 0.01  # s


class Work(Protocol):
    """What takes some steps.

    steps, done : how many there are, and how many were taken
    """

    steps: int
    done: int

    def advance(self) -> None:
        """Take a step."""

    def finish(self) -> Any:
        """Put down what was made, after the last step."""

    def cancel(self) -> None:
        """Leave everything as it was before the first step."""

    def abandon(self) -> None:
        """End what goes on beside Blender, and touch none of its data: they are gone, or about to be."""


class SteppedOperator:
    """`begin` gives the work and `conclude` takes its result. Without a window all steps are taken at once.

    doing : what it does, for the status bar
    cancelled : what Esc leaves
    """

    doing = ""
    cancelled = "Cancelled: nothing was changed"
    _work: Work

    def begin(self, context: bpy.types.Context) -> Work:
        """The work, not yet begun. Raises OceanObjectError, ParameterError, MemoryError or OSError."""
        raise NotImplementedError

    def conclude(self, context: bpy.types.Context, result: Any) -> set[str]:
        """Report on the work, which is finished."""
        raise NotImplementedError

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Take steps from time to time."""
        if bpy.app.background:
            return self.execute(context)
        if not self._start(context):
            return {"CANCELLED"}
        manager = context.window_manager
        manager.progress_begin(0, self._work.steps)
        self._tell(context)
        self._timer = manager.event_timer_add(_LOOK, window=context.window)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Go on for a moment, unless Esc is pressed."""
        if event.type == "ESC" and event.value == "PRESS":
            try:
                self._work.cancel()
            finally:
                self._clean_up(context)
            self.report({"WARNING"}, translated(self.cancelled))
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        result = {"CANCELLED"}
        try:
            result = self._go_on(context, until=time.monotonic() + _TURN)
        finally:  # also after an unexpected error
            if result != {"RUNNING_MODAL"}:
                self._clean_up(context)
        if result == {"RUNNING_MODAL"}:
            self._tell(context)
        return result

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Take all steps at once."""
        return self._go_on(context, until=float("inf")) if self._start(context) else {"CANCELLED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender itself ends the operator: the file is closed, and its objects with it."""
        self._work.abandon()
        self._clean_up(context)

    def _start(self, context: bpy.types.Context) -> bool:
        try:
            self._work = self.begin(context)
        except _EXPECTED_ERRORS as error:
            refuse(self, error)
            return False
        return True

    def _go_on(self, context: bpy.types.Context, until: float) -> set[str]:
        work = self._work
        try:
            while work.done < work.steps:
                work.advance()
                context.window_manager.progress_update(work.done)
                if time.monotonic() > until:
                    return {"RUNNING_MODAL"}
            result = work.finish()
        except Exception as error:
            work.cancel()
            if isinstance(error, _EXPECTED_ERRORS):
                return refuse(self, error)
            raise
        return self.conclude(context, result)

    def _tell(self, context: bpy.types.Context) -> None:
        share = 100 * self._work.done // self._work.steps
        context.workspace.status_text_set(f"{self.doing}: {share} %   |   Esc: cancel")

    def _clean_up(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
