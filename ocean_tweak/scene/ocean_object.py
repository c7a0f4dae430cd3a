# SPDX-License-Identifier: GPL-3.0-or-later
"""Creates ocean objects, and switches them between live and baked."""

from __future__ import annotations

import logging

import bpy

from ..core import OceanParameters
from ..core.data.frames import format_frames
from ..nodes.names import MAP_INPUTS
from . import coast_surface, grid_mesh, modifiers, patch_objects, spray, vertex_attributes
from .cache_place import new_uid
from .camera_surface import camera_surface_of, remove_camera_surface
from .image_sequence import ImageSequence, LoadedSequence, SequenceError, load_sequence
from .modifiers import Textures
from .refinement import show_new
from .refresh import EXPECTED_ERRORS, refresh
from .settings import METHODS, SOURCES, VIEWPORT_RESOLUTION, OceanSettings, settings_of

__all__ = ["EXPECTED_ERRORS", "add", "end", "use_sequence"]

_log = logging.getLogger(__name__)


def add(
    scene: bpy.types.Scene,
    parameters: OceanParameters,
    method: str = "NODES",
    source: str = "LIVE",
    sequence: ImageSequence | None = None,
    name: str = "Ocean",
    collection: bpy.types.Collection | None = None,
    mesh_resolution: int | None = None,
    viewport_resolution: int | None = None,
    repeats: tuple[int, int] = (1, 1),
) -> bpy.types.Object:
    """Add an ocean to a scene; its origin is the patch's corner x = y = 0.

    The scene's frame rate is not changed: use `units.set_frame_rate` to adopt that of the parameters.

    parameters : the sea; for a sequence, what it was baked with
    method : a key of METHODS
    source : a key of SOURCES
    sequence : the files, for the source "SEQUENCE"
    collection : where the object goes, the scene's own collection by default
    mesh_resolution : quads along each side of a patch, by default as many as there are samples
    viewport_resolution : samples along each side in the viewport, by default all that the sea has
    repeats : patches side by side along x and y

    Raises ValueError for an unknown method or source, SequenceError for files that cannot be used and
    MemoryError for a sea too large; then nothing is added.
    """
    _check(method, METHODS, "method")
    _check(source, SOURCES, "source")
    if source == "SEQUENCE" and sequence is None:
        raise SequenceError('An ocean with the source "SEQUENCE" needs an image sequence')
    baked = load_sequence(sequence) if sequence is not None else None
    item = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    (collection or scene.collection).objects.link(item)
    settings = settings_of(item)
    with settings.quiet():
        settings.is_ocean = True
        settings.uid = new_uid()
        settings.method = method
        settings.mesh_resolution = mesh_resolution or 0
        settings.repeats_x, settings.repeats_y = repeats
        settings.viewport_resolution = viewport_resolution or max(parameters.resolution, VIEWPORT_RESOLUTION)
        settings.from_parameters(parameters, scene)
        if sequence is not None and baked is not None:
            _set_sequence(settings, sequence, baked)
        settings.source = source
    try:
        show_new(item, scene)
    except EXPECTED_ERRORS:
        bpy.data.meshes.remove(item.data)  # and the object with it
        raise
    return item


def use_sequence(item: bpy.types.Object, scene: bpy.types.Scene, sequence: ImageSequence) -> None:
    """Switch the ocean to baked files. Raises SequenceError, and then changes nothing."""
    baked = load_sequence(sequence)
    settings = settings_of(item)
    before = _sequence_images(settings)
    with settings.quiet():
        _set_sequence(settings, sequence, baked)
        settings.source = "SEQUENCE"
    refresh(item, scene)
    for image in before - _sequence_images(settings):
        if image.users == image.use_fake_user and image.library is None:  # of a bake that is no longer shown
            bpy.data.images.remove(image)


def end(item: bpy.types.Object) -> None:
    """Turn an ocean whose modifier was applied or removed into an ordinary mesh.

    The camera surface, the coast and the patches of the moving sea are removed, so that the mesh is visible.
    """
    settings = settings_of(item)
    has_surface = camera_surface_of(item) is not None
    if has_surface:
        remove_camera_surface(item)
    coast_surface.remove(item)
    patch_objects.remove(item)
    spray.remove(item)
    if item.data.library is None:
        vertex_attributes.make_still(item.data)
        grid_mesh.release(item.data)
    with settings.quiet():
        settings.is_ocean = False
        modifiers.remove_own(item, Textures(settings.texture, settings.render_texture))
        settings.texture = settings.render_texture = None
        for maps in (settings.live_maps, settings.render_maps, settings.sequence_maps, settings.early_maps):
            for name in MAP_INPUTS:
                setattr(maps, name, None)
    _log.warning(
        "%s: its modifier was applied or removed, so it is now an ordinary mesh%s",
        item.name, "; its camera surface was removed" if has_surface else "",
    )  # fmt: skip


def _sequence_images(settings: OceanSettings) -> set[bpy.types.Image]:
    owners = (settings.sequence_maps, settings.early_maps)
    return {getattr(maps, name) for maps in owners for name in MAP_INPUTS} - {None}


def _set_sequence(settings: OceanSettings, sequence: ImageSequence, baked: LoadedSequence) -> None:
    for name in MAP_INPUTS:
        setattr(settings.sequence_maps, name, baked.images.get(name))
        setattr(settings.early_maps, name, baked.early_images.get(name))
    settings.sequence_samples = baked.samples
    settings.sequence_fps = str(baked.fps) if baked.fps is not None else ""
    settings.sequence_stretch = str(baked.stretch)
    settings.sequence_frames = format_frames(sequence.frames)


def _check(value: str, allowed: dict[str, tuple[str, str]], name: str) -> None:
    if value not in allowed:
        raise ValueError(f"{name} = {value!r}: must be one of {', '.join(allowed)}")
