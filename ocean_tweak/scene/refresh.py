# SPDX-License-Identifier: GPL-3.0-or-later
"""Brings mesh, images and modifiers of an ocean into step with its settings, its scene and its frame."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from fractions import Fraction

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import OceanParameters, ParameterError
from . import evaluation, grid_mesh, live_image, modifiers, ownership
from .grid_mesh import Grid
from .image_sequence import SequenceError
from .modifiers import Displacement, Textures
from .resampling import resampled
from .settings import OceanObjectError, OceanSettings, settings_of
from .units import frame_with_subframe, metres_per_unit

#: what a user can cause: shown with the object; anything else is a bug and raises
EXPECTED_ERRORS = (ParameterError, OceanObjectError, MemoryError)

#: samples along each side of the surface that is shown while a parameter is dragged
COARSE = 128
_LEAST_SAMPLES = 16

# a render from the window refreshes oceans on its own thread, while the window may refresh them too
_turn = threading.RLock()


@dataclass(frozen=True)
class _Plan:
    """What an ocean needs.

    parameters : of the render
    metres : in a Blender unit
    viewport, render : mesh and samples
    """

    parameters: OceanParameters
    metres: Fraction
    viewport: Grid
    render: Grid

    @property
    def has_own_render(self) -> bool:
        return self.render != self.viewport


def refresh_and_tell(
    item: bpy.types.Object, scene: bpy.types.Scene, coarse: bool = False, statistics: bool = True
) -> None:
    """Refresh an ocean; what is wrong with its settings is kept in `error`, for the panel to show."""
    try:
        refresh(item, scene, coarse, statistics)
    except EXPECTED_ERRORS as error:
        tell(item, error)


def refresh(
    item: bpy.types.Object, scene: bpy.types.Scene, coarse: bool = False, statistics: bool = True
) -> None:
    """Show the ocean's present settings and frame in the viewport, and prepare its render.

    coarse : show a surface of few samples, on the same mesh
    statistics : bring these up to date too; otherwise they are only where they are known

    Raises ParameterError, SequenceError or MemoryError, and then leaves the ocean as it was.
    """
    with _turn:
        settings = settings_of(item)
        plan = _plan(settings, scene)
        text = (evaluation.statistics_of if statistics else evaluation.known_statistics)(plan.parameters)
        if settings.source == "LIVE":
            _refresh_live(item, settings, plan, scene, coarse)
            # a render from the window runs the frame handler on its own thread
            set_changed(scene.render, use_lock_interface=True)
        else:
            _refresh_baked(item, settings, plan)
        if text is not None:
            evaluation.keep_statistics(plan.parameters, text)
            set_changed(settings, statistics=text)
        set_changed(settings, error="")


def refresh_render(item: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Make the present frame for a render, where the viewport does not show the same; texels that are there
    stay. What is wrong with the settings is kept in `error`."""
    with _turn:
        settings = settings_of(item)
        if settings.source != "LIVE":
            return
        try:
            plan = _plan(settings, scene)
            if not plan.has_own_render:
                return
            frame = frame_with_subframe(scene)
            image = settings.render_image
            if image is not None and not live_image.shows(image, (plan.parameters, frame)):
                surface = evaluation.sea_of(plan.parameters).surface(frame)
                live_image.prepare(image, plan.render.samples)
                live_image.write(image, surface[:-1, :-1], (plan.parameters, frame))
        except EXPECTED_ERRORS as error:
            tell(item, error)


def has_statistics(item: bpy.types.Object, scene: bpy.types.Scene) -> bool:
    """Whether the statistics that the ocean shows are those of its settings, or there can be none."""
    settings = settings_of(item)
    return bool(settings.error) or (
        evaluation.known_statistics(settings.to_parameters(scene)) == settings.statistics
    )


def set_changed(target: object, **values: object) -> None:
    """Set what differs: writing a property again would mark the file as changed on every frame."""
    for name, value in values.items():
        if getattr(target, name) != value:
            setattr(target, name, value)


def tell(item: bpy.types.Object, error: BaseException) -> None:
    """Keep what is wrong for the panel."""
    text = str(error) or "Not enough memory for this resolution"
    set_changed(settings_of(item), error=text, statistics="")


def _plan(settings: OceanSettings, scene: bpy.types.Scene) -> _Plan:
    parameters, metres = settings.to_parameters(scene), metres_per_unit(scene)
    size = float(Fraction(parameters.domain_size) / metres)
    # an even number, as the core wants it
    most = max(settings.viewport_resolution // 2 * 2, _LEAST_SAMPLES)
    if settings.source == "LIVE":
        render, view = parameters.resolution, min(most, parameters.resolution)
        quads = view
    else:
        # the files have their resolution, the viewport fewer quads to move
        render = view = settings.sequence_samples
        quads = min(most, view)
    fixed = settings.mesh_resolution
    return _Plan(parameters, metres, Grid(size, fixed or quads, view), Grid(size, fixed or render, render))


def _refresh_live(
    item: bpy.types.Object, settings: OceanSettings, plan: _Plan, scene: bpy.types.Scene, coarse: bool
) -> None:
    grid = plan.viewport
    surface = _viewport_surface(plan, frame_with_subframe(scene), coarse)
    _refresh_mesh(item, grid)
    by_attribute = settings.method == "NODES" and grid_mesh.can_hold_displacement(item.data, grid)
    if by_attribute:
        grid_mesh.write_displacement(item.data, _in_units(surface, plan.metres))
    else:
        grid_mesh.remove_displacement(item.data)
    # materials and other objects may read the image too
    if not by_attribute or ownership.has_other_users(settings.live_image):
        ownership.own_image(item, "live_image", f"{item.name} live", grid.samples)
        live_image.prepare(settings.live_image, grid.samples)
        live_image.write(settings.live_image, surface[:-1, :-1])
    if plan.has_own_render:
        # filled when a render asks for it: playback does not pay for it
        ownership.own_image(item, "render_image", f"{item.name} render", 1)
    _refresh_modifiers(
        item,
        settings,
        Displacement(
            image=None if by_attribute else settings.live_image,
            frames=None,
            grid=grid,
            render_image=settings.render_image if plan.has_own_render else None,
            render_grid=plan.render if plan.has_own_render else None,
            scale=float(1 / plan.metres),
        ),
    )


def _refresh_baked(item: bpy.types.Object, settings: OceanSettings, plan: _Plan) -> None:
    image = settings.sequence_image
    if image is None:
        raise SequenceError("No image sequence is chosen: choose a baked one, or go back to live")
    _refresh_mesh(item, plan.viewport)
    grid_mesh.remove_displacement(item.data)
    _refresh_modifiers(
        item,
        settings,
        Displacement(
            image=image,
            frames=(settings.sequence_first, settings.sequence_last),
            grid=plan.viewport,
            render_image=image,
            render_grid=plan.render if plan.has_own_render else None,
            scale=float(1 / plan.metres),
        ),
    )


def _viewport_surface(plan: _Plan, frame: Fraction, coarse: bool) -> NDArray[np.float32]:
    """(samples+1, samples+1, 3), m."""
    samples = plan.viewport.samples
    shown = min(COARSE, samples) if coarse else samples
    surface = evaluation.sea_of(plan.parameters.replace(resolution=shown)).surface(frame)
    return surface if shown == samples else resampled(surface, samples)


def _in_units(surface: NDArray[np.float32], metres: Fraction) -> NDArray[np.float32]:
    return surface if metres == 1 else surface * np.float32(1 / metres)


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


def _refresh_modifiers(item: bpy.types.Object, settings: OceanSettings, shown: Displacement) -> None:
    if settings.method == "NODES":
        modifiers.apply_nodes(item, Textures(settings.texture, settings.render_texture), shown)
        return
    ownership.own_texture(item, "texture", item.name)
    if shown.render_image != shown.image and shown.render_image is not None:
        ownership.own_texture(item, "render_texture", f"{item.name} render")
    modifiers.apply_displace(item, Textures(settings.texture, settings.render_texture), shown)
