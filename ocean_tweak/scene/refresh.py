# SPDX-License-Identifier: GPL-3.0-or-later
"""Brings mesh, images and modifiers of an ocean into step with its settings, its scene and its frame."""

from __future__ import annotations

import threading
from collections.abc import Callable

import bpy
import numpy as np

from ..core import ParameterError
from ..core.channels import CHANNELS, channels_of, image_of
from ..core.frames import format_frames
from . import (
    alarm,
    bake_state,
    evaluation,
    grid_mesh,
    image_sequence,
    live_image,
    modifiers,
    ownership,
    patch_objects,
    patch_points,
    vertex_attributes,
)
from .grid_mesh import Grid
from .image_sequence import SequenceError
from .modifiers import Images, Shown, Textures
from .plan import Plan, plan_of, velocity_scale
from .resampling import resampled, tiled
from .settings import OceanObjectError, OceanSettings, set_changed, settings_of
from .vertex_attributes import Fields

#: what a user can cause: shown with the object; anything else is a bug and raises
EXPECTED_ERRORS = (ParameterError, OceanObjectError, MemoryError)

_NO_SEQUENCE = "No image sequence is chosen: choose a baked one, or go back to live"

# a render from the window refreshes oceans on its own thread, while the window may refresh them too
_turn = threading.RLock()


def refresh_and_tell(
    item: bpy.types.Object,
    scene: bpy.types.Scene,
    coarse: bool = False,
    statistics: bool = True,
    patient: bool = True,
    shown: OceanSettings | None = None,
) -> bool:
    """Refresh an ocean; what is wrong with its settings is kept in `error`, for the panel to show."""
    try:
        return refresh(item, scene, coarse, statistics, patient, shown)
    except EXPECTED_ERRORS as error:
        tell(item, error)
    return True


def refresh(
    item: bpy.types.Object,
    scene: bpy.types.Scene,
    coarse: bool = False,
    statistics: bool = True,
    patient: bool = True,
    shown: OceanSettings | None = None,
) -> bool:
    """Show the ocean's present settings and frame in the viewport, and prepare its render.

    coarse : show a surface of few samples, on the same mesh
    statistics : bring these up to date too; otherwise they are only where they are known
    patient : otherwise foam is shown without its history where that would take long
    shown : the settings as animation makes them, where it does

    Returns whether all is shown as it should be. Raises ParameterError, SequenceError or MemoryError, and
    then leaves the ocean as it was.
    """
    with _turn:
        settings = settings_of(item)
        plan = plan_of(shown or settings, scene)
        counted = (
            bake_state.shown_parameters(settings, scene) if settings.source != "LIVE" else plan.parameters
        )
        text = (evaluation.statistics_of if statistics else evaluation.known_statistics)(counted)
        complete = True
        if settings.source == "LIVE":
            complete = _refresh_live(item, settings, plan, scene, coarse, patient)
            # a render from the window runs the frame handler on its own thread
            set_changed(scene.render, use_lock_interface=True)
        else:
            _refresh_baked(item, settings, plan, scene)
        patch_objects.refresh(item, plan, patch_points.points_of(settings, plan, scene), coarse)
        check_files(item, scene)
        bake_state.check(item, scene, shown)
        if text is not None:
            evaluation.keep_statistics(counted, text)
            set_changed(settings, statistics=text)
        set_changed(settings, error="")
        alarm.is_well(item)
    return complete


def refresh_patches(
    item: bpy.types.Object, scene: bpy.types.Scene, shown: OceanSettings | None = None
) -> None:
    """Show the present frame on the meshes of the patches, where an ocean has such; all else stays.

    They are live where files without points move the ocean's own mesh. What is wrong is kept in `error`.

    shown : the settings as animation makes them, where it does
    """
    with _turn:
        if not patch_objects.patches_of(item) or patch_objects.are_baked(item):
            return
        try:
            patch_objects.refresh(item, plan_of(shown or settings_of(item), scene), None)
        except EXPECTED_ERRORS as error:
            tell(item, error)


def refresh_render(
    item: bpy.types.Object, scene: bpy.types.Scene, shown: OceanSettings | None = None
) -> None:
    """Make the present frame for a render, where the viewport does not show the same; texels that are there
    stay. What is wrong with the settings is kept in `error`.

    shown : the settings as animation makes them, where it does
    """
    with _turn:
        settings = settings_of(item)
        if settings.source != "LIVE":
            return
        try:
            plan = plan_of(shown or settings, scene)
            if plan.has_own_render:
                _write_render(settings, plan)
        except EXPECTED_ERRORS as error:
            tell(item, error)


def hold(item: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Put the sea that a live ocean shows on its mesh, which a file keeps: images are saved without texels.

    It is what a Blender without the extension shows.
    """
    with _turn:
        settings = settings_of(item)
        textures = Textures(settings.texture, settings.render_texture)
        modifiers.tell_held_frame(item, textures, scene.frame_current)
        try:
            plan = plan_of(settings, scene)
            if settings.method == "NODES" and vertex_attributes.can_hold(item.data, plan.viewport):
                return
            fields, _ = _viewport_fields(plan, coarse=False, patient=False)
        except EXPECTED_ERRORS:  # the panel tells
            return
        if grid_mesh.is_current(item.data, plan.viewport) and not item.data.is_editmode:
            vertex_attributes.write(item.data, _on_vertices(fields, plan))


def check_files(item: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Keep for the panel which file of the present frame is not there, and let the console hear it."""
    settings, file = settings_of(item), None
    if settings.source == "SEQUENCE":
        if settings.sequence_maps.disp is None:
            alarm.missed(item, _NO_SEQUENCE)
        present, frames = scene.frame_current, image_sequence.baked_frames(settings)
        frame = image_sequence.shown_frame(settings, scene, present)
        file = image_sequence.missing_file(settings, frame)
        if file is not None:
            set_changed(settings, missing_file=str(file))
            alarm.missed(item, alarm.missing_text(settings))
        elif settings.out_of_range == "WARN" and image_sequence.unbaked_frames(settings, scene, (present,)):
            folder = image_sequence.folder_of(settings)
            alarm.warned(
                item, "frames",
                f"this frame was not baked, {frame} is held; {folder} has {format_frames(frames)}",
            )  # fmt: skip
    set_changed(settings, missing_file="" if file is None else str(file))


def has_statistics(item: bpy.types.Object, scene: bpy.types.Scene) -> bool:
    """Whether the statistics that the ocean shows are those of its sea, or there can be none."""
    settings = settings_of(item)
    return bool(settings.error) or (
        evaluation.known_statistics(bake_state.shown_parameters(settings, scene)) == settings.statistics
    )


def waves_job(item: bpy.types.Object, scene: bpy.types.Scene) -> Callable[[], object]:
    """What makes the waves of all the viewport's samples, before any surface of them; as `foam_job`."""
    return evaluation.sea_of(plan_of(settings_of(item), scene).viewport_sea()).ocean.prepare


def foam_job(item: bpy.types.Object, scene: bpy.types.Scene) -> Callable[[], object]:
    """What makes the foam that the viewport lacks; it touches no data of Blender and may run on any thread.

    Raises ParameterError or OceanObjectError for settings that are no sea.
    """
    plan = plan_of(settings_of(item), scene)
    maker = evaluation.sea_of(plan.viewport_sea()).foam_of(plan.is_whole)
    return lambda: maker.at(plan.time)


def tell(item: bpy.types.Object, error: BaseException) -> None:
    """Keep what is wrong for the panel, and let the console hear it."""
    text = str(error) or "Not enough memory for this resolution"
    set_changed(settings_of(item), error=text, statistics="")
    alarm.refused(item, text)


def _refresh_live(
    item: bpy.types.Object,
    settings: OceanSettings,
    plan: Plan,
    scene: bpy.types.Scene,
    coarse: bool,
    patient: bool,
) -> bool:
    grid = plan.viewport
    fields, complete = _viewport_fields(plan, coarse, patient)
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
        # filled when a render asks for it: playback does not pay for it
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
    return complete


def _refresh_baked(
    item: bpy.types.Object, settings: OceanSettings, plan: Plan, scene: bpy.types.Scene
) -> None:
    images, early_images = (
        {name: getattr(maps, name) for name in plan.maps if getattr(maps, name) is not None}
        for maps in (settings.sequence_maps, settings.early_maps)
    )
    if "disp" not in images:
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
        ),
    )


def _viewport_fields(plan: Plan, coarse: bool, patient: bool) -> tuple[Fields, bool]:
    """(samples+1, samples+1, …) by output, m; and whether they are all that they will be."""
    sea = evaluation.sea_of(plan.viewport_sea(coarse))
    fields, complete = sea.fields(plan.time, plan.channels, plan.is_whole, patient=patient and not coarse)
    samples = plan.viewport.samples
    if sea.ocean.parameters.resolution != samples:
        fields = {name: resampled(field, samples) for name, field in fields.items()}
    return _in_scene_time(fields, plan), complete


def _in_scene_time(fields: Fields, plan: Plan) -> Fields:
    """The fields with what is per second, per second of the scene."""
    if plan.rate == 1.0:
        return fields
    rate = np.float32(plan.rate)
    return {name: field * rate if CHANNELS[name].is_rate else field for name, field in fields.items()}


def _on_vertices(fields: Fields, plan: Plan) -> Fields:
    """The channels on the viewport's mesh, in Blender units; between samples they are bilinear."""
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
    made, _ = evaluation.sea_of(plan.parameters).fields(plan.time, channels_of(stale), plan.is_whole)
    fields = _in_scene_time(made, plan)
    for name in stale:
        _write_image(images[name], fields, name, content)


def _write_image(image: bpy.types.Image, fields: Fields, name: str, content: object = None) -> None:
    """Put a map into an image; `fields` have the far edges, which an image has not."""
    texels = image_of(name, {channel: field[:-1, :-1] for channel, field in fields.items()})
    live_image.prepare(image, texels.shape[0])
    live_image.write(image, texels, content)


def _refresh_mesh(item: bpy.types.Object, grid: Grid) -> None:
    # a linked duplicate has its own sea from now on
    if ownership.is_borrowed_mesh(item):
        item.data = item.data.copy()
    if grid_mesh.is_current(item.data, grid):
        return
    if item.data.is_editmode:
        raise OceanObjectError("The mesh is in Edit Mode: leave it to rebuild the grid")
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
