# SPDX-License-Identifier: GPL-3.0-or-later
"""Brings mesh, images and modifiers of an ocean into step with its settings, its scene and its frame."""

from __future__ import annotations

import threading
from enum import Flag, auto

import bpy
import numpy as np

from ..core import OceanParameters, ParameterError
from ..core.data.frames import format_frames
from ..core.synthesis.channels import CHANNELS, MOVING_MAP, channels_of, image_of
from . import (
    bake_state,
    coast_surface,
    evaluation,
    failures,
    grid_mesh,
    held_sea,
    image_sequence,
    live_image,
    modifiers,
    ownership,
    patch_objects,
    patch_points,
    portability,
    spray,
    vertex_attributes,
)
from .grid_mesh import Grid
from .image_sequence import SequenceError
from .modifiers import Images, Shown, Textures, set_changed
from .plan import Plan, plan_for, seconds_per_file, velocity_scale
from .settings import OceanObjectError, OceanSettings, settings_of
from .vertex_attributes import Fields, resampled, tiled

#: errors that a user can cause, shown with the object; any other is a bug and is raised
EXPECTED_ERRORS = (ParameterError, OceanObjectError, MemoryError)

_NO_SEQUENCE = "No image sequence is chosen: choose a baked one, or go back to live"

# the sea of each ocean's settings, by session uid, as panels and views need it whenever they are drawn
_seas: dict[int, OceanParameters] = {}
# a render from the window refreshes oceans on its own thread, while the window may refresh them too
_turn = threading.RLock()


class Wanted(Flag):
    """The parts of an ocean to update.

    SURFACE : the viewport's mesh, and what moves it: modifiers, attributes and images
    SAMPLES : all samples of a live surface and of patches; without it, they have few
    HISTORY : foam that remembers, and waves over a bed, however long that takes; without it, only where they
        are quickly made
    STATISTICS : those of the sea; without it, only where they are known
    PATCHES : meshes of the patches, of which a surface around the camera is made
    FILES : the note of the file that the present frame lacks
    BAKE : the notes of the sea that the shown bake is of, and of what differs in the settings
    NEIGHBOURS : the notes of the objects that go with an ocean
    RENDER : what a render shows, where the viewport does not show the same
    HELD : the sea of a live ocean on its mesh, which a file keeps: images are saved without texels. It is
        what a Blender without the extension shows
    BY_HAND : nothing by itself; a setting was changed, and it may be changed again within a moment
    """

    SURFACE = auto()
    SAMPLES = auto()
    HISTORY = auto()
    STATISTICS = auto()
    PATCHES = auto()
    FILES = auto()
    BAKE = auto()
    NEIGHBOURS = auto()
    RENDER = auto()
    HELD = auto()
    BY_HAND = auto()
    NOTES = FILES | BAKE | NEIGHBOURS
    ALL = SURFACE | SAMPLES | HISTORY | STATISTICS | PATCHES | NOTES
    CHANGE = ALL | BY_HAND


#: all of what a surface around a camera is made of
AROUND_CAMERA = Wanted.PATCHES | Wanted.SAMPLES | Wanted.HISTORY
_NOTHING = Wanted(0)
_OF_SEA = Wanted.SURFACE | Wanted.PATCHES | Wanted.RENDER


def of_a_frame(item: bpy.types.Object) -> Wanted:
    """The parts that change with the frame; Blender itself reads the files of a baked ocean.

    Its patches and what lies over a bed are live if there are no baked points.
    """
    if is_live(item):
        return Wanted.ALL & ~Wanted.NEIGHBOURS
    wanted = Wanted.FILES
    if bake_state.moves(item):
        wanted |= Wanted.BAKE
    if patch_objects.are_live(item) or spray.is_live(item) or coast_surface.is_live(item):
        wanted |= AROUND_CAMERA
    return wanted


def is_live(item: bpy.types.Object) -> bool:
    """Whether an ocean is computed, not read from files."""
    return settings_of(item).source == "LIVE"


def refresh(
    item: bpy.types.Object,
    scene: bpy.types.Scene,
    wanted: Wanted = Wanted.ALL,
    shown: OceanSettings | None = None,
) -> Wanted:
    """Update parts of an ocean for its settings and the scene's frame, at once.

    shown : the settings as animation makes them, where it does

    Returns what of the viewport is still to come: HISTORY where foam is shown without it. Raises
    ParameterError, SequenceError or MemoryError, and then leaves the surface as it was.
    """
    with _turn:
        settings = settings_of(item)
        if Wanted.HELD in wanted:
            _hold(item, settings, scene)
        missing = _refresh_sea(item, settings, scene, wanted, shown) if wanted & _OF_SEA else _NOTHING
        if Wanted.FILES in wanted:
            _note_files(item, scene)
        if Wanted.BAKE in wanted:
            if not wanted & _OF_SEA:
                _seas.pop(item.session_uid, None)
            bake_state.check(item, scene, shown)
        if Wanted.NEIGHBOURS in wanted:
            portability.look_at(item)
        if wanted & (Wanted.SURFACE | Wanted.FILES):
            failures.follow(item)
    return missing


def _refresh_sea(
    item: bpy.types.Object,
    settings: OceanSettings,
    scene: bpy.types.Scene,
    wanted: Wanted,
    shown: OceanSettings | None,
) -> Wanted:
    """Show the waves in viewport, patches and render. Returns the parts still missing."""
    plan = plan_for(item, shown or settings, scene)
    missing, is_baked = _NOTHING, settings.source != "LIVE"
    _seas[item.session_uid] = plan.whole
    text = _statistics(settings, plan, scene, wanted) if Wanted.SURFACE in wanted else None
    if Wanted.SURFACE in wanted and is_baked:
        _refresh_baked(item, settings, plan, scene)
    elif Wanted.SURFACE in wanted:
        missing = _refresh_live(item, settings, plan, scene, wanted)
        # a render from the window runs the frame handler on its own thread
        set_changed(scene.render, use_lock_interface=True)
    points = None
    if wanted & (Wanted.PATCHES | Wanted.RENDER):
        points = patch_points.points_of(settings, plan, scene)
    if Wanted.PATCHES in wanted:
        missing |= _refresh_parts(item, plan, points, scene, wanted)
    if Wanted.RENDER in wanted:
        patch_objects.show_for_render(item, plan, points, scene)
        coast_surface.show_for_render(item, plan, coast_surface.points_of(item, plan, scene))
        spray.refresh(item, plan, scene, is_rendered=True)
        if plan.has_own_render and not is_baked:
            _write_render(settings, plan)
    if Wanted.SURFACE in wanted:
        set_changed(settings, error="", **({} if text is None else {"statistics": text}))
        failures.is_well(item)
    return missing


def _refresh_parts(
    item: bpy.types.Object,
    plan: Plan,
    points: patch_points.Points | None,
    scene: bpy.types.Scene,
    wanted: Wanted,
) -> Wanted:
    """Show what lies around a camera, over a bed and in the air. Returns what is still to come."""
    patient, coarse = Wanted.HISTORY in wanted, Wanted.SAMPLES not in wanted
    is_complete = patch_objects.refresh(item, plan, points, scene, patient, coarse)
    if not coarse:
        of_coast = coast_surface.points_of(item, plan, scene)
        is_complete = coast_surface.refresh(item, plan, of_coast, patient) and is_complete
        is_complete = spray.refresh(item, plan, scene, patient) and is_complete
    return _NOTHING if is_complete else Wanted.HISTORY


def _statistics(settings: OceanSettings, plan: Plan, scene: bpy.types.Scene, wanted: Wanted) -> str | None:
    """Those of the sea that is shown, as JSON; None where they are not known, and not wanted."""
    counted = plan.whole if settings.source == "LIVE" else bake_state.shown_parameters(settings, scene)
    if Wanted.STATISTICS not in wanted:
        return evaluation.known_statistics(counted)
    text = evaluation.statistics_of(counted)
    evaluation.keep_statistics(counted, text)
    return text


def _hold(item: bpy.types.Object, settings: OceanSettings, scene: bpy.types.Scene) -> None:
    """Write the sea of a live ocean to its mesh for saving."""
    if settings.source != "LIVE" or item.library is not None:
        return
    textures = Textures(settings.texture, settings.render_texture)
    modifiers.tell_held_frame(item, textures, scene.frame_current)
    try:
        plan = plan_for(item, settings, scene)
        if settings.method == "NODES" and vertex_attributes.can_hold(item.data, plan.viewport):
            held_sea.leave_out(item.data)
            return
        fields, _ = _viewport_fields(plan, Wanted.SAMPLES)
    except EXPECTED_ERRORS:  # the panel tells
        return
    if grid_mesh.is_current(item.data, plan.viewport) and not item.data.is_editmode:
        vertex_attributes.write(item.data, held_sea.held(_on_vertices(fields, plan)))


def _note_files(item: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Store the missing file of the present frame for the panel, and print it."""
    settings, file = settings_of(item), None
    if settings.source == "SEQUENCE":
        if settings.sequence_maps.disp is None:
            failures.missed(item, _NO_SEQUENCE)
        present, frames = scene.frame_current, image_sequence.baked_frames(settings)
        frame = image_sequence.shown_frame(settings, scene, present)
        file = image_sequence.missing_file(settings, frame)
        if file is not None:
            set_changed(settings, missing_file=str(file))
            failures.missed(item, failures.missing_text(settings))
        elif settings.out_of_range == "WARN" and image_sequence.unbaked_frames(settings, scene, (present,)):
            folder = image_sequence.folder_of(settings)
            failures.warned(
                item, "frames",
                f"this frame was not baked, {frame} is held; {folder} has {format_frames(frames)}",
            )  # fmt: skip
    set_changed(settings, missing_file="" if file is None else str(file))
    spray.note_files(item, scene)


def sea_of_settings(item: bpy.types.Object, scene: bpy.types.Scene) -> OceanParameters | None:
    """The sea of an ocean's settings, cached until they change; None if they are invalid."""
    if item.session_uid not in _seas and not settings_of(item).error:
        try:
            _seas[item.session_uid] = settings_of(item).to_parameters(scene)
        except ParameterError:
            return None
    return _seas.get(item.session_uid)


def forget_all() -> None:
    """Another file is opened, or the extension is disabled."""
    _seas.clear()


def tell(item: bpy.types.Object, error: BaseException) -> None:
    """Store a problem for the panel, and print it."""
    text = str(error) or "Not enough memory for this resolution"
    _seas.pop(item.session_uid, None)
    set_changed(settings_of(item), error=text, statistics="")
    failures.refused(item, text)


def _refresh_live(
    item: bpy.types.Object,
    settings: OceanSettings,
    plan: Plan,
    scene: bpy.types.Scene,
    wanted: Wanted,
) -> Wanted:
    grid = plan.viewport
    fields, is_complete = _viewport_fields(plan, wanted)
    _refresh_mesh(item, grid)
    by_attributes = settings.method == "NODES" and vertex_attributes.can_hold(item.data, grid)
    if by_attributes:
        vertex_attributes.write(item.data, _on_vertices(fields, plan))
    else:
        vertex_attributes.remove(item.data)
    images: Images = {}
    for name in plan.maps:
        # materials and other objects may read an image too
        if not by_attributes or ownership.has_other_users(getattr(settings.live_maps, name)):
            image = ownership.own_image(item, "live_maps", name, f"{item.name} live {name}", grid.samples)
            _write_image(image, fields, name)
            images[name] = image
    own_images: Images | None = None
    if plan.has_own_render:
        # filled for a render only, so that it does not slow down playback
        own_images = {
            name: ownership.own_image(item, "render_maps", name, f"{item.name} render {name}", 1)
            for name in plan.maps
        }
    _refresh_modifiers(
        item,
        settings,
        Shown(
            images=None if by_attributes else images,
            frames=None,
            grid=grid,
            render_images=own_images,
            render_grid=plan.render if plan.has_own_render else None,
            scale=plan.scale,
            velocity_scale=velocity_scale(settings, plan, scene),
            warn=False,
        ),
    )
    return _NOTHING if is_complete else Wanted.HISTORY


def _refresh_baked(
    item: bpy.types.Object, settings: OceanSettings, plan: Plan, scene: bpy.types.Scene
) -> None:
    images, early_images = (
        {name: getattr(maps, name) for name in plan.maps if getattr(maps, name) is not None}
        for maps in (settings.sequence_maps, settings.early_maps)
    )
    if MOVING_MAP not in images:
        raise SequenceError(_NO_SEQUENCE)
    _refresh_mesh(item, plan.viewport)
    vertex_attributes.remove(item.data)
    _refresh_modifiers(
        item,
        settings,
        Shown(
            images=images,
            frames=image_sequence.baked_frames(settings),
            grid=plan.viewport,
            render_images=images,
            render_grid=plan.render if plan.has_own_render else None,
            scale=plan.scale,
            velocity_scale=velocity_scale(settings, plan, scene),
            warn=settings.out_of_range == "WARN",
            early_images=early_images,
            files_per_frame=float(image_sequence.baked_stretch(settings)),
            seconds_per_file=seconds_per_file(settings, scene),
        ),
    )


def _viewport_fields(plan: Plan, wanted: Wanted) -> tuple[Fields, bool]:
    """(samples+1, samples+1, …) by output, m; and whether they are final."""
    patient = Wanted.SAMPLES | Wanted.HISTORY in wanted
    sea = evaluation.surfaces_of(plan.viewport_sea(coarse=Wanted.SAMPLES not in wanted))
    fields, is_complete = sea.fields(plan.time, plan.channels, plan.is_whole, patient)
    samples = plan.viewport.samples
    if sea.ocean.parameters.resolution != samples:
        fields = {name: resampled(field, samples) for name, field in fields.items()}
    return _in_scene_time(fields, plan), is_complete


def _in_scene_time(fields: Fields, plan: Plan) -> Fields:
    """The fields with rates converted to scene time."""
    if plan.rate == 1.0:
        return fields
    rate = np.float32(plan.rate)
    return {name: field * rate if CHANNELS[name].is_rate else field for name, field in fields.items()}


def _on_vertices(fields: Fields, plan: Plan) -> Fields:
    """The channels on the viewport's mesh, in Blender units, interpolated bilinearly."""
    result = {}
    for name, field in fields.items():
        scaled = field * np.float32(plan.scale) if CHANNELS[name].scales and plan.metres != 1 else field
        if plan.viewport.quads != plan.viewport.samples:
            scaled = resampled(scaled, plan.viewport.quads)
        result[name] = tiled(scaled, plan.viewport.repeats)
    return result


def _write_render(settings: OceanSettings, plan: Plan) -> None:
    content = (plan.parameters, plan.time, plan.rate)
    images = {name: getattr(settings.render_maps, name) for name in plan.maps}
    stale = [
        name for name, image in images.items() if image is not None and not live_image.shows(image, content)
    ]
    if not stale:
        return
    made, _ = evaluation.surfaces_of(plan.parameters).fields(plan.time, channels_of(stale), plan.is_whole)
    fields = _in_scene_time(made, plan)
    for name in stale:
        _write_image(images[name], fields, name, content)


def _write_image(image: bpy.types.Image, fields: Fields, name: str, content: object = None) -> None:
    """Write a map to an image; `fields` include the far edges, which an image lacks."""
    texels = image_of(name, {channel: field[:-1, :-1] for channel, field in fields.items()})
    live_image.prepare(image, texels.shape[0])
    live_image.write(image, texels, content)


def _refresh_mesh(item: bpy.types.Object, grid: Grid) -> None:
    # from now on a linked duplicate has its own sea
    if ownership.is_borrowed_mesh(item):
        item.data = item.data.copy()
    if grid_mesh.is_current(item.data, grid):
        return
    if item.data.is_editmode:
        raise OceanObjectError("The mesh is in Edit Mode: leave Edit Mode to rebuild the grid")
    if item.data.users > 1:
        item.data = item.data.copy()
    grid_mesh.fill(item.data, grid)


def _refresh_modifiers(item: bpy.types.Object, settings: OceanSettings, shown: Shown) -> None:
    if settings.method == "NODES" or not shown.suits_displace:
        modifiers.apply_nodes(item, Textures(settings.texture, settings.render_texture), shown)
        return
    ownership.own_texture(item, "texture", item.name)
    if shown.render_grid is not None and not shown.render_is_alike:
        ownership.own_texture(item, "render_texture", f"{item.name} render")
    modifiers.apply_displace(item, Textures(settings.texture, settings.render_texture), shown)
