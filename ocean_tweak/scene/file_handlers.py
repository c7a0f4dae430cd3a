# SPDX-License-Identifier: GPL-3.0-or-later
"""Handlers of files that are opened, saved or imported from, and of undo: what is not stored is made anew."""

from __future__ import annotations

import bpy
from bpy.app.handlers import persistent

from ..core.numerics.memo import MEMO
from ..nodes.detail_image import CHANNELS
from ..nodes.extension_check import show_that_it_runs
from ..nodes.kinds import ALL_KINDS
from ..nodes.upgrades import upgrade_groups
from . import (
    absence_notes,
    bed_points,
    cache_place,
    command_process,
    contact,
    failures,
    float_carrier,
    float_riding,
    followed_settings,
    former_settings,
    held_sea,
    hull_cut,
    live_image,
    mask_following,
    patch_objects,
    portability,
    refinement,
    refresh,
    scene_sky,
    solid_foam,
    source_images,
    spray,
    stored_paths,
    stored_values,
    wake_makers,
)
from .plan import forget_cameras
from .refinement import show
from .refresh import AROUND_CAMERA, Wanted, is_live
from .scene_handlers import end_those_without_modifier
from .settings import shown_oceans

# paths that were changed for the save that is under way, and what they were
_changed_paths: list[tuple[stored_paths.Kept, str]] = []


@persistent
def refresh_after_load(_path: object = None, _unused: object = None) -> None:
    """Fill the live images of an opened file: generated images are saved without their texels. Its node
    groups may be of another version."""
    command_process.stop_all()
    forget_all()
    followed_settings.subscribe()
    former_settings.take_over()
    stored_values.mend_all()
    absence_notes.take_back()
    show_that_it_runs()
    # what a bake's groups of another version were not told
    baked = Wanted.NOTES | Wanted.SURFACE | AROUND_CAMERA if upgrade_groups(ALL_KINDS) else Wanted.NOTES
    end_those_without_modifier(bpy.data.objects)
    patch_objects.remove_left()
    spray.remove_left()
    float_carrier.take_over()
    solid_foam.mend()
    hull_cut.refresh()  # those of another version do not follow what is hidden
    scene_sky.look_for_panoramas()
    for scene in bpy.data.scenes:
        wake_makers.follow(scene, frozenset(), None)
    for item, scene in shown_oceans().items():
        show(item, scene, Wanted.ALL if cache_place.find_moved(item) or is_live(item) else baked)


@persistent
def hold_before_save(_path: object = None, _unused: object = None) -> None:
    """Let live oceans stand still as they are, rather than lie flat, where the extension is missing; there
    hulls are cut out as in a render."""
    hull_cut.show_in_window(False)
    absence_notes.write()
    for item, scene in shown_oceans().items():
        show(item, scene, Wanted.HELD)


@persistent
def make_paths_relative(path: str, _unused: object = None) -> None:
    """The file is about to be saved at this path."""
    if path:
        _changed_paths[:] = stored_paths.make_relative(path)


@persistent
def take_paths_back(path: str, _unused: object = None) -> None:
    """Where it was not saved there, or only a copy of it was, its own paths are what they were before."""
    if not stored_paths.is_saved_beside(path):
        for kept, before in _changed_paths:
            setattr(kept.owner, kept.name, before)
    _changed_paths.clear()


@persistent
def let_go_after_save(_path: object = None, _unused: object = None) -> None:
    """The file is written: show the whole surface again."""
    hull_cut.show_in_window(True)
    absence_notes.take_back()
    held_sea.take_back()


@persistent
def look_after_save(_path: object = None, _unused: object = None) -> None:
    """A file that was saved elsewhere may have left its bakes behind."""
    for item, scene in shown_oceans().items():
        show(item, scene, Wanted.BAKE)


@persistent
def mend_after_import(imported: bpy.types.BlendImportContext) -> None:
    """Oceans that were appended or linked are of a file that was not opened.

    Their node groups do not know yet that the extension runs.
    """
    former_settings.take_over()
    stored_values.mend_all()
    stored_paths.follow_import(imported)
    float_carrier.take_over()
    contact.refresh()
    hull_cut.refresh()
    show_that_it_runs()


@persistent
def refresh_after_undo(_scene: object = None, _unused: object = None) -> None:
    """Undo restores settings, but neither texels nor other generated data."""
    show_that_it_runs()
    _forget_made()
    float_carrier.follow()
    float_riding.forget_all()
    contact.refresh()
    hull_cut.refresh()
    for item, scene in shown_oceans().items():
        show(item, scene, Wanted.ALL if is_live(item) else Wanted.NOTES)


def forget_all() -> None:
    """Forget all that is known of the file that was open, its seas included, but not the water's patterns."""
    failures.forget_all()
    refinement.forget_all()
    mask_following.forget_all()
    float_riding.forget_all()
    wake_makers.forget_all()
    refresh.forget_all()
    forget_cameras()
    portability.forget_all()
    MEMO.drop(but=(CHANNELS,))
    _forget_made()


def _forget_made() -> None:
    """Forget what was made for a file: another one, and what an undo restores, may not have it."""
    live_image.forget_all()
    patch_objects.forget_all()
    bed_points.forget_all()
    spray.forget_all()
    source_images.forget_all()
