# SPDX-License-Identifier: GPL-3.0-or-later
"""Handlers of an open file: frame changes, renders, and what is changed by hand or by a script.

Each determines what to update for which oceans; `refinement.show` does it, at once or step by step.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import wraps

import bpy
from bpy.app.handlers import persistent

from . import (
    bake_state,
    coast_surface,
    contact,
    failures,
    float_carrier,
    float_current,
    float_riding,
    hull_cut,
    left_behind,
    mask_following,
    ocean_object,
    portability,
    scene_sky,
    solid_foam,
    source_images,
    spray,
    wake_makers,
)
from .animated import is_animated, shown_settings
from .plan import camera_has_moved, camera_surface_of
from .refinement import show
from .refresh import AROUND_CAMERA, Wanted, is_live, of_a_frame
from .settings import all_oceans, is_ocean, oceans_in, once_oceans_in, settings_of, shown_oceans, was_ocean
from .units import metres_per_unit


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
    end_those_without_modifier(once_oceans_in(scene))
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
def end_without_modifier(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Notice oceans whose modifier was applied or removed, or that were converted to a mesh."""
    if depsgraph is None or not depsgraph.id_type_updated("OBJECT"):
        return
    changed = (update.id.original for update in depsgraph.updates if update.is_updated_geometry)
    end_those_without_modifier(item for item in changed if isinstance(item, bpy.types.Object))


@persistent
def look_around(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Notice objects that go with an ocean, and oceans that are gone."""
    if depsgraph is not None and portability.is_outdated(depsgraph.updates):
        _look_around()


@persistent
def clear_after_deletion(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Let what was made for a deleted ocean go with it."""
    if depsgraph is None or not depsgraph.id_type_updated("COLLECTION"):
        return
    if left_behind.clear():
        _look_around()
    hull_cut.refresh()  # hulls that are deleted stay in the file for as long as a material knows them


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


def end_those_without_modifier(items: Iterable[bpy.types.Object]) -> None:
    """Let what was made for an ocean go where its modifier is gone."""
    # found before any ends: what showed its sea goes with it
    lost = [item for item in items if was_ocean(item) and not is_ocean(item) and item.library is None]
    for item in lost:
        ocean_object.end(item)
    if lost:
        _look_around()


def _look_around() -> None:
    portability.look()
    for ocean, scene in shown_oceans().items():
        if coast_surface.lacks_points(ocean):
            show(ocean, scene, AROUND_CAMERA)
    contact.refresh()
    hull_cut.refresh()
    failures.keep_only(all_oceans())


def _evaluated_oceans(
    scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None
) -> Iterator[bpy.types.Object]:
    """The oceans of a scene whose animation this evaluation has: others are in other view layers."""
    for item in oceans_in(scene):
        if depsgraph is None or not is_animated(item) or item.evaluated_get(depsgraph).is_evaluated:
            yield item
