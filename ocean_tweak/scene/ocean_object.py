# SPDX-License-Identifier: GPL-3.0-or-later
"""Ocean objects: made, kept in step with their settings, switched between live and baked."""

from __future__ import annotations

from fractions import Fraction

import bpy

from ..core import Ocean, OceanParameters, ParameterError
from . import grid_mesh, live_image, modifiers
from .evaluation import sea_of
from .grid_mesh import Grid
from .image_sequence import ImageSequence, SequenceError, load_image
from .modifiers import Displacement
from .settings import METHODS, SOURCES, OceanObjectError, OceanSettings, all_oceans, settings_of
from .units import frame_with_subframe, metres_per_unit

#: what a user can cause: shown with the object; anything else is a bug and raises
EXPECTED_ERRORS = (ParameterError, OceanObjectError, MemoryError)


def add(
    scene: bpy.types.Scene,
    parameters: OceanParameters,
    method: str = "NODES",
    source: str = "LIVE",
    sequence: ImageSequence | None = None,
    name: str = "Ocean",
    collection: bpy.types.Collection | None = None,
    mesh_resolution: int | None = None,
) -> bpy.types.Object:
    """Add an ocean to a scene; its origin is the patch's corner x = y = 0.

    The scene keeps its own frame rate: set it with `units.set_frame_rate` where the parameters' should hold.

    parameters : the sea; for a sequence, what it was baked with
    method : a key of METHODS
    source : a key of SOURCES
    sequence : the files, for the source "SEQUENCE"
    collection : where the object goes, the scene's own collection by default
    mesh_resolution : quads along each side, by default as many as the image has samples

    Raises ValueError for an unknown method or source, SequenceError for files that cannot be used and
    MemoryError for a sea too large; then nothing is added.
    """
    _check(method, METHODS, "method")
    _check(source, SOURCES, "source")
    if source == "SEQUENCE" and sequence is None:
        raise SequenceError('An ocean with the source "SEQUENCE" needs an image sequence')
    baked = load_image(sequence) if sequence is not None else None
    item = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    (collection or scene.collection).objects.link(item)
    settings = settings_of(item)
    with settings.quiet():
        settings.is_ocean = True
        settings.method = method
        settings.mesh_resolution = mesh_resolution or 0
        settings.from_parameters(parameters, scene)
        if sequence is not None and baked is not None:
            _set_sequence(settings, sequence, *baked)
        settings.source = source
    try:
        refresh(item, scene)
    except EXPECTED_ERRORS:
        bpy.data.meshes.remove(item.data)  # and the object with it
        raise
    return item


def use_sequence(item: bpy.types.Object, scene: bpy.types.Scene, sequence: ImageSequence) -> None:
    """Let baked files move the ocean. Raises SequenceError, and then changes nothing."""
    baked = load_image(sequence)
    settings = settings_of(item)
    with settings.quiet():
        _set_sequence(settings, sequence, *baked)
        settings.source = "SEQUENCE"
    refresh(item, scene)


def use_live(item: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Let the ocean be computed on every frame."""
    settings = settings_of(item)
    with settings.quiet():
        settings.source = "LIVE"
    refresh(item, scene)


def refresh_and_tell(item: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Refresh an ocean; what is wrong with its settings is kept in `error`, for the panel to show."""
    try:
        refresh(item, scene)
    except EXPECTED_ERRORS as error:
        text = str(error) or "Not enough memory for this resolution"
        _set(settings_of(item), error=text, statistics="")


def refresh(item: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Bring mesh, image and modifier of an ocean into step with its settings, its scene and its frame.

    Raises ParameterError, SequenceError or MemoryError, and then leaves the ocean as it was.
    """
    settings = settings_of(item)
    parameters = settings.to_parameters(scene)
    sea = sea_of(item, parameters)
    if settings.source == "LIVE":
        image = _refreshed_live_image(item, settings, sea.ocean, scene)
        frames, samples = None, parameters.resolution
        # a render from the window runs the frame handler on its own thread
        _set(scene.render, use_lock_interface=True)
    else:
        image = _sequence_image(settings)
        frames, samples = (settings.sequence_first, settings.sequence_last), settings.sequence_samples
    metres = metres_per_unit(scene)
    size = float(Fraction(parameters.domain_size) / metres)
    shown = Displacement(image, frames, size, samples, float(1 / metres))
    _refresh_mesh(item, Grid(shown.size, settings.mesh_resolution or shown.samples, shown.samples))
    _refresh_modifier(item, settings, shown)
    _set(settings, error="", statistics=sea.statistics)


def _refreshed_live_image(
    item: bpy.types.Object, settings: OceanSettings, ocean: Ocean, scene: bpy.types.Scene
) -> bpy.types.Image:
    samples = ocean.parameters.resolution
    displacement = ocean.frame(frame_with_subframe(scene)).displacement
    if settings.live_image is None or _is_borrowed(item, "live_image"):
        settings.live_image = live_image.new_image(f"{item.name} live", samples)
    live_image.prepare(settings.live_image, samples)
    live_image.write(settings.live_image, displacement)
    return settings.live_image


def _sequence_image(settings: OceanSettings) -> bpy.types.Image:
    image = settings.sequence_image
    if image is None:
        raise SequenceError("No image sequence is chosen: choose a baked one, or go back to live")
    return image


def _refresh_mesh(item: bpy.types.Object, grid: Grid) -> None:
    if grid_mesh.is_current(item.data, grid):
        return
    if item.data.is_editmode:
        raise OceanObjectError("The mesh is in Edit Mode: leave it to rebuild the grid")
    if item.data.users > 1:  # a linked duplicate has its own size from now on
        item.data = item.data.copy()
    grid_mesh.fill(item.data, grid)


def _refresh_modifier(item: bpy.types.Object, settings: OceanSettings, shown: Displacement) -> None:
    if settings.method == "NODES":
        modifiers.apply_nodes(item, settings.texture, shown)
        return
    if settings.texture is None:
        settings.texture = modifiers.new_texture(item.name)
    elif _is_borrowed(item, "texture"):
        shared, settings.texture = settings.texture, settings.texture.copy()
        for modifier in modifiers.own_modifiers(item, shared):
            if modifier.type == "DISPLACE":
                modifier.texture = settings.texture
    modifiers.apply_displace(item, settings.texture, shown)


def _is_borrowed(item: bpy.types.Object, name: str) -> bool:
    """Whether a duplicate still has the image or texture of the object it was made from, the older one."""
    block = getattr(settings_of(item), name)
    return any(
        getattr(settings_of(other), name) == block and other.session_uid < item.session_uid
        for other in all_oceans()
    )


def _set_sequence(
    settings: OceanSettings, sequence: ImageSequence, image: bpy.types.Image, samples: int
) -> None:
    settings.sequence_image = image
    settings.sequence_samples = samples
    settings.sequence_first = sequence.first
    settings.sequence_last = sequence.last


def _set(target: object, **values: object) -> None:
    """Set what differs: writing a property again would mark the file as changed on every frame."""
    for name, value in values.items():
        if getattr(target, name) != value:
            setattr(target, name, value)


def _check(value: str, allowed: dict[str, tuple[str, str]], name: str) -> None:
    if value not in allowed:
        raise ValueError(f"{name} = {value!r}: must be one of {', '.join(allowed)}")
