# SPDX-License-Identifier: GPL-3.0-or-later
"""Handlers that keep oceans up to date: frame changes, renders, opened files, undo, changed units and frame
rates.

Each event determines what to update for which oceans; `refinement.show` does it, at once or step by step.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import wraps

import bpy
from bpy.app.handlers import persistent

from ..core.numerics.memo import MEMO
from ..nodes.extension_check import show_that_it_ends, show_that_it_runs
from ..nodes.kinds import ALL_KINDS
from ..nodes.upgrades import upgrade_groups
from . import (
    absence_notes,
    bake_state,
    bed_points,
    cache_place,
    coast_surface,
    command_process,
    contact,
    failures,
    float_carrier,
    float_current,
    float_riding,
    former_settings,
    held_sea,
    hull_cut,
    left_behind,
    live_image,
    mask_following,
    ocean_object,
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
from .animated import is_animated, shown_settings
from .plan import camera_has_moved, camera_surface_of, forget_cameras
from .refinement import show
from .refresh import AROUND_CAMERA, Wanted, is_live, of_a_frame
from .settings import all_oceans, is_ocean, oceans_in, once_oceans_in, settings_of, shown_oceans, was_ocean
from .units import metres_per_unit

# scene settings that change an ocean and have no update callback of ours
_FOLLOWED = (
    ("UnitSettings", "scale_length"),
    ("RenderSettings", "fps"),
    ("RenderSettings", "fps_base"),
    ("RenderSettings", "frame_map_old"),
    ("RenderSettings", "frame_map_new"),
)
# paths that were changed for the save that is under way, and what they were
_changed_paths: list[tuple[stored_paths.Kept, str]] = []
# subscriptions to properties are made and cleared under this owner
_OWNER = object()


def _loud(handler: Callable[..., None]) -> Callable[..., None]:
    """A handler whose exceptions end a background render, as Blender only prints them and continues."""

    @persistent
    @wraps(handler)
    def run(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
        try:
            handler(scene, depsgraph)
        except Exception:
            failures.fail_render()
            raise

    return run


@_loud
def follow_before_frame(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """A script may have moved floating objects or keyed masks since the last evaluation."""
    float_carrier.follow()
    float_current.follow_before_frame(scene)
    float_riding.follow_before_frame(scene)
    wake_makers.follow(scene, frozenset(), depsgraph)
    mask_following.bind(scene)


@_loud
def refresh_on_frame_change(scene: bpy.types.Scene, _depsgraph: object = None) -> None:
    """Show the frame that the scene is about to evaluate, sub-frame included."""
    _end_those_without_modifier(once_oceans_in(scene))
    for item in oceans_in(scene):
        show(item, scene, Wanted.FILES if is_animated(item) else of_a_frame(item))


@_loud
def refresh_animated(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Show oceans with animated settings, which are only known after the evaluation."""
    for item in _evaluated_oceans(scene, depsgraph):
        if is_animated(item):
            shown = shown_settings(item, depsgraph)
            mask_following.take_over(item, shown, depsgraph)
            show(item, scene, of_a_frame(item) & ~Wanted.FILES, shown)
    float_current.follow_after_frame(scene, depsgraph)
    float_riding.follow_after_frame(scene, depsgraph)


@_loud
def refresh_around_camera(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Let what lies around a camera follow it: of a render, and after a jump, its place is known only now."""
    for item in oceans_in(scene) if depsgraph is not None else ():
        surface = camera_surface_of(item)
        scale = float(1 / metres_per_unit(scene))
        if surface is not None and camera_has_moved(surface, scene, depsgraph, scale):
            shown = shown_settings(item, depsgraph) if is_animated(item) else None
            show(item, scene, AROUND_CAMERA, shown)


@_loud
def refresh_for_render(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Give a render, or an export of what would be rendered, the samples of the render.

    After the evaluation, because only then is its purpose known. Changes made here are evaluated again before
    they are used.
    """
    if depsgraph is not None and depsgraph.mode == "RENDER":
        for item in _evaluated_oceans(scene, depsgraph):
            show(item, scene, Wanted.RENDER, shown_settings(item, depsgraph))


@persistent
def refresh_for_images(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Show oceans whose waves are made from an image that was painted or changed otherwise."""
    if depsgraph is None or not depsgraph.id_type_updated("IMAGE"):
        return
    changed = {update.id.original for update in depsgraph.updates if isinstance(update.id, bpy.types.Image)}
    for image in changed:
        source_images.forget(image)
    for item in oceans_in(scene):
        if is_live(item) and changed & {source.image for source in settings_of(item).source_images()}:
            show(item, scene, Wanted.CHANGE)


@persistent
def refresh_for_masks(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Let masks follow their objects where these, or the ocean, are moved, edited or painted by hand."""
    if depsgraph is None or not any(map(depsgraph.id_type_updated, ("OBJECT", "ACTION"))):
        return
    mask_following.bind(scene)
    moved, edited = set(), set()
    for update in depsgraph.updates:  # one at a time: Blender may take a kept one for its own object
        is_moved, is_edited = update.is_updated_transform, update.is_updated_geometry
        if isinstance(item := update.id, bpy.types.Object):
            moved |= {item.original} if is_moved else set()
            edited |= {item.original} if is_edited else set()
    mask_following.follow(scene, moved, edited)


@persistent
def refresh_for_wakes(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Let wakes follow their objects where these are moved by hand or keyed otherwise."""
    if depsgraph is not None and any(map(depsgraph.id_type_updated, ("OBJECT", "ACTION"))):
        kinds = (bpy.types.Object, bpy.types.Action)
        names = {update.id.name for update in depsgraph.updates if isinstance(update.id, kinds)}
        wake_makers.follow(scene, names, depsgraph)


@persistent
def follow_by_hand(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Let floating objects go where they were moved to, and look after those that came and went."""
    if depsgraph is None or depsgraph.id_type_updated("OBJECT"):
        hull_cut.follow()
        float_carrier.follow()
        float_current.follow_by_hand(scene, depsgraph)
        float_riding.follow_by_hand(scene, depsgraph)


@persistent
def follow_materials(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Let what the Solid view shows of foam follow the water's material."""
    if depsgraph is not None:
        solid_foam.follow(depsgraph)


@persistent
def clear_after_deletion(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Let what was made for a deleted ocean go with it."""
    if depsgraph is None or not depsgraph.id_type_updated("COLLECTION"):
        return
    if left_behind.clear():
        _look_around()
    hull_cut.refresh()  # hulls that are deleted stay in the file for as long as a material knows them


@persistent
def look_after_save(_path: object = None, _unused: object = None) -> None:
    """A file that was saved elsewhere may have left its bakes behind."""
    for item, scene in shown_oceans().items():
        show(item, scene, Wanted.BAKE)


@persistent
def begin_render(scene: bpy.types.Scene, _depsgraph: object = None) -> None:
    """Print all messages of a shot again, and cut out the hulls that are rendered."""
    failures.render_begins()
    hull_cut.show_in_window(False)
    scene_sky.look_for_panoramas()
    for item in oceans_in(scene):
        show(item, scene, Wanted.BAKE)
        bake_state.warn(item)
        if text := portability.sharp_under_blur(item, scene):
            failures.warned(item, "blur", text)
        if text := spray.too_few_bounces(item, scene):
            failures.warned(item, "bounces", text)


@persistent
def end_render(_scene: bpy.types.Scene, _depsgraph: object = None) -> None:
    """Windows cut out the hulls that they show. A background render that failed ends here."""
    hull_cut.show_in_window(True)
    failures.render_ends()


@persistent
def end_without_modifier(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Notice oceans whose modifier was applied or removed, or that were converted to a mesh."""
    if depsgraph is None or not depsgraph.id_type_updated("OBJECT"):
        return
    changed = (update.id.original for update in depsgraph.updates if update.is_updated_geometry)
    _end_those_without_modifier(item for item in changed if isinstance(item, bpy.types.Object))


@persistent
def look_around(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Notice objects that go with an ocean, and oceans that are gone."""
    if depsgraph is not None and portability.is_outdated(depsgraph.updates):
        _look_around()


def _look_around() -> None:
    portability.look()
    for ocean, scene in shown_oceans().items():
        if coast_surface.lacks_points(ocean):
            show(ocean, scene, AROUND_CAMERA)
    contact.refresh()
    hull_cut.refresh()
    failures.keep_only(all_oceans())


def _end_those_without_modifier(items: Iterable[bpy.types.Object]) -> None:
    # found before any ends: what showed its sea goes with it
    lost = [item for item in items if was_ocean(item) and not is_ocean(item) and item.library is None]
    for item in lost:
        ocean_object.end(item)
    if lost:
        _look_around()


@persistent
def refresh_after_load(_path: object = None, _unused: object = None) -> None:
    """Fill the live images of an opened file: generated images are saved without their texels. Its node
    groups may be of another version."""
    command_process.stop_all()
    _forget_all()
    _subscribe()
    former_settings.take_over()
    stored_values.mend_all()
    absence_notes.take_back()
    show_that_it_runs()
    # what a bake's groups of another version were not told
    baked = Wanted.NOTES | Wanted.SURFACE | AROUND_CAMERA if upgrade_groups(ALL_KINDS) else Wanted.NOTES
    _end_those_without_modifier(bpy.data.objects)
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
def hold_before_save(_path: object = None, _unused: object = None) -> None:
    """Let live oceans stand still as they are, rather than lie flat, where the extension is missing; there
    hulls are cut out as in a render."""
    hull_cut.show_in_window(False)
    absence_notes.write()
    for item, scene in shown_oceans().items():
        show(item, scene, Wanted.HELD)


@persistent
def let_go_after_save(_path: object = None, _unused: object = None) -> None:
    """The file is written: show the whole surface again."""
    hull_cut.show_in_window(True)
    absence_notes.take_back()
    held_sea.take_back()


@persistent
def refresh_after_undo(_scene: object = None, _unused: object = None) -> None:
    """Undo restores settings, but neither texels nor other generated data."""
    show_that_it_runs()
    live_image.forget_all()
    patch_objects.forget_all()
    bed_points.forget_all()
    spray.forget_all()
    source_images.forget_all()
    float_carrier.follow()
    float_riding.forget_all()
    contact.refresh()
    hull_cut.refresh()
    for item, scene in shown_oceans().items():
        show(item, scene, Wanted.ALL if is_live(item) else Wanted.NOTES)


def _evaluated_oceans(
    scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None
) -> Iterator[bpy.types.Object]:
    """The oceans of a scene whose animation this evaluation has: others are in other view layers."""
    for item in oceans_in(scene):
        if depsgraph is None or not is_animated(item) or item.evaluated_get(depsgraph).is_evaluated:
            yield item


def refresh_all_oceans() -> None:
    """Refresh every ocean of the file in its own scene."""
    for item, scene in shown_oceans().items():
        show(item, scene)


_HANDLERS: tuple[tuple[str, Callable[..., None]], ...] = (
    ("frame_change_pre", follow_before_frame),
    ("frame_change_pre", refresh_on_frame_change),
    ("frame_change_post", refresh_animated),
    ("frame_change_post", refresh_around_camera),
    ("frame_change_post", refresh_for_render),
    ("depsgraph_update_post", end_without_modifier),
    ("depsgraph_update_post", follow_by_hand),
    ("depsgraph_update_post", follow_materials),
    ("depsgraph_update_post", refresh_for_render),
    ("depsgraph_update_post", refresh_for_images),
    ("depsgraph_update_post", refresh_for_masks),
    ("depsgraph_update_post", refresh_for_wakes),
    # last: a change of drivers makes Blender build the evaluation anew, and its updates are gone
    ("depsgraph_update_post", look_around),
    ("depsgraph_update_post", clear_after_deletion),
    ("render_init", begin_render),
    ("render_complete", end_render),
    ("render_cancel", end_render),
    ("load_post", refresh_after_load),
    ("save_pre", hold_before_save),
    ("save_pre", make_paths_relative),
    ("save_post", take_paths_back),
    ("save_post_fail", take_paths_back),
    ("save_post", let_go_after_save),
    ("save_post_fail", let_go_after_save),
    ("blend_import_post", mend_after_import),
    ("save_post", look_after_save),
    ("undo_post", refresh_after_undo),
    ("redo_post", refresh_after_undo),
)


def register() -> None:
    """Attach the handlers."""
    _attach()
    if _has_file():
        show_that_it_runs()
    _subscribe()


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
    bpy.msgbus.clear_by_owner(_OWNER)
    _detach()
    command_process.stop_all()
    _forget_all()


def _has_file() -> bool:
    """Whether a file is open: not while Blender starts; opening one calls a handler."""
    return hasattr(bpy.data, "node_groups")


def _forget_all() -> None:
    failures.forget_all()
    refinement.forget_all()
    mask_following.forget_all()
    float_riding.forget_all()
    wake_makers.forget_all()
    refresh.forget_all()
    forget_cameras()
    portability.forget_all()
    MEMO.drop()
    live_image.forget_all()
    patch_objects.forget_all()
    bed_points.forget_all()
    spray.forget_all()
    source_images.forget_all()


def _subscribe() -> None:
    bpy.msgbus.clear_by_owner(_OWNER)
    for owner, name in _FOLLOWED:
        key = (getattr(bpy.types, owner), name)
        bpy.msgbus.subscribe_rna(key=key, owner=_OWNER, args=(), notify=refresh_all_oceans)
