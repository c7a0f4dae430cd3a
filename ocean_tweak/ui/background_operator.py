# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that run a separate process: the window stays responsive, and Esc stops it."""

from __future__ import annotations

from typing import Any

import bpy

from ..core import ParameterError
from ..scene.command_process import CommandProcess
from ..scene.refinement import redraw_views
from ..scene.settings import OceanObjectError
from .active_ocean import OfActiveOcean, refuse, shown_ocean

_LOOK = 0.1  # s


class BackgroundOperator(OfActiveOcean):
    """Acts on the active ocean; `begin` starts the process and `conclude` handles its result.

    processes : registry of processes of this kind
    doing : text for the status bar
    busy : message if one is already running
    """

    processes: Any
    doing = ""
    busy = ""
    _process: CommandProcess

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There is an ocean of this file without a running process of this kind."""
        if not super().poll(context):
            return False
        if cls.processes.running(shown_ocean(context)):
            cls.poll_message_set(cls.busy)
            return False
        return True

    def begin(self, context: bpy.types.Context) -> CommandProcess:
        """Start the process. Raises ParameterError, OceanObjectError or OSError."""
        raise NotImplementedError

    def conclude(self, context: bpy.types.Context) -> set[str]:
        """Handle the result of the finished process."""
        raise NotImplementedError

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Start the process and a timer."""
        if not self._start(context):
            return {"CANCELLED"}
        self._timer = context.window_manager.event_timer_add(_LOOK, window=context.window)
        context.window_manager.modal_handler_add(self)
        self._tell(context)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show the progress; Esc stops."""
        if event.type == "ESC" and event.value == "PRESS" and not self._process.is_stopped:
            self._process.stop()
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if not self._process.has_ended():
            self._tell(context)
            return {"PASS_THROUGH"}
        context.window_manager.event_timer_remove(self._timer)
        context.workspace.status_text_set(None)
        return self._end(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Run the process and wait for it."""
        if not self._start(context):
            return {"CANCELLED"}
        self._process.wait()
        return self._end(context)

    def failed(self) -> set[str]:
        """Report why the process failed."""
        return refuse(
            self, self._process.error or (f"{self.doing} {self._process.name} failed without a message")
        )

    def _start(self, context: bpy.types.Context) -> bool:
        self._item, self._scene = shown_ocean(context).name, context.scene.name
        try:
            self._process = self.begin(context)
        except (ParameterError, OceanObjectError, OSError) as error:
            refuse(self, error)
            return False
        return True

    def _end(self, context: bpy.types.Context) -> set[str]:
        self.processes.forget(self._process)
        redraw_views()
        return self.conclude(context)

    def _tell(self, context: bpy.types.Context) -> None:
        process = self._process
        doing = "Finishing the frame" if process.is_stopped else f"{self.doing} {process.name}"
        phase = f", {process.phase}" if process.phase else ""
        count = f"{phase}: {process.done} of {process.left}" if process.left else "…"
        context.workspace.status_text_set(f"{doing}{count}   |   Esc: stop")
        redraw_views()


class StopsProcess:
    """Base class of operators that stop the process of the active ocean.

    processes : registry of the processes
    idle : message if there is none
    """

    processes: Any
    idle = ""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """A process is running."""
        item = shown_ocean(context)
        if item is None or cls.processes.running(item) is None:
            cls.poll_message_set(cls.idle)
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Request the end; the running operator notices it."""
        self.processes.running(shown_ocean(context)).stop()
        return {"FINISHED"}
