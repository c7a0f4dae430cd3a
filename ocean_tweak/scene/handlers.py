# SPDX-License-Identifier: GPL-3.0-or-later
"""Which handlers keep oceans up to date, in which order, and when they are attached."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import bpy

from ..nodes.extension_check import show_that_it_ends, show_that_it_runs
from . import command_process, file_handlers, followed_settings, scene_handlers

_HANDLERS: tuple[tuple[str, Callable[..., None]], ...] = (
    ("frame_change_pre", scene_handlers.follow_before_frame),
    ("frame_change_pre", scene_handlers.refresh_on_frame_change),
    ("frame_change_post", scene_handlers.refresh_animated),
    ("frame_change_post", scene_handlers.refresh_around_camera),
    ("frame_change_post", scene_handlers.refresh_for_render),
    ("depsgraph_update_post", scene_handlers.end_without_modifier),
    ("depsgraph_update_post", scene_handlers.follow_by_hand),
    ("depsgraph_update_post", scene_handlers.follow_materials),
    ("depsgraph_update_post", scene_handlers.refresh_for_render),
    ("depsgraph_update_post", scene_handlers.refresh_for_images),
    ("depsgraph_update_post", scene_handlers.refresh_for_masks),
    ("depsgraph_update_post", scene_handlers.refresh_for_wakes),
    # last: a change of drivers makes Blender build the evaluation anew, and its updates are gone
    ("depsgraph_update_post", scene_handlers.look_around),
    ("depsgraph_update_post", scene_handlers.clear_after_deletion),
    ("render_init", scene_handlers.begin_render),
    ("render_complete", scene_handlers.end_render),
    ("render_cancel", scene_handlers.end_render),
    ("load_post", file_handlers.refresh_after_load),
    ("save_pre", file_handlers.hold_before_save),
    ("save_pre", file_handlers.make_paths_relative),
    ("save_post", file_handlers.take_paths_back),
    ("save_post_fail", file_handlers.take_paths_back),
    ("save_post", file_handlers.let_go_after_save),
    ("save_post_fail", file_handlers.let_go_after_save),
    ("blend_import_post", file_handlers.mend_after_import),
    ("save_post", file_handlers.look_after_save),
    ("undo_post", file_handlers.refresh_after_undo),
    ("redo_post", file_handlers.refresh_after_undo),
)


def register() -> None:
    """Attach the handlers."""
    _attach()
    if _has_file():
        show_that_it_runs()
    followed_settings.subscribe()


@contextmanager
def asleep() -> Iterator[None]:
    """While this is open, no frame, render or file makes an ocean compute."""
    _detach()
    try:
        yield
    finally:
        _attach()


def _attach() -> None:
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def _detach() -> None:
    for name, handler in _HANDLERS:
        handlers = getattr(bpy.app.handlers, name)
        if handler in handlers:
            handlers.remove(handler)


def unregister() -> None:
    """Detach the handlers and forget the seas."""
    if _has_file():
        show_that_it_ends()
    followed_settings.unsubscribe()
    _detach()
    command_process.stop_all()
    file_handlers.forget_all()


def _has_file() -> bool:
    """Whether a file is open: not while Blender starts; opening one calls a handler."""
    return hasattr(bpy.data, "node_groups")
