# SPDX-License-Identifier: GPL-3.0-or-later
"""Plans an ocean from its settings: the seas and grids of viewport and render."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

import bpy
from mathutils import Matrix

from ..core import Area, Ocean, OceanParameters
from ..core.numerics.machine import usable_memory
from ..core.numerics.memo import MEMO
from ..core.parameters.patch_seas import open_sea
from ..core.sea.placed_waves import repeating
from ..core.synthesis.channels import Channel
from ..nodes.camera_surface import CAMERA_SURFACE
from ..nodes.modifier_inputs import get_input
from ..nodes.versioned import is_of_kind
from .animated import clock_of
from .grid_mesh import Grid
from .image_sequence import baked_stretch
from .settings import OceanObjectError, OceanSettings, maps_of, wanted_channels
from .units import frame_rate, frame_with_subframe, metres_per_unit, time_stretch

#: samples along each side of the surface that is shown while a parameter is dragged
COARSE = 128
#: resolution of the viewport's foam if renders compute their own
VIEWPORT_FOAM = 128
#: smallest resolution of a patch in the viewport
_PATCH_SAMPLES = 256
_LEAST_SAMPLES = 16
#: side of the square for waves that do not repeat, in domains, and its largest number of cells
_AROUND, _AREA_CELLS = 2, 512
# distance in m that a camera may move before its surroundings are recomputed
_FAR_MOVED = 9.0
# angle in rad that it may turn
_FAR_TURNED = math.radians(2.0)
# bytes per vertex of a grid with all its attributes, including one copy for evaluation
_VERTEX_BYTES = 200


class _Seen(NamedTuple):
    """The evaluated and the original matrix of a camera at the same time."""

    stale: Matrix
    matrix: Matrix


# by the session uid of the surface around it: where a camera was last seen, and what was last made for
_seen: dict[int, _Seen] = {}
_used: dict[int, Matrix] = {}


@dataclass(frozen=True)
class Placed:
    """The waves of an ocean with a camera surface that do not repeat.

    whole : the sea with all of its waves
    area : where they are shown, in addition to the ocean's mesh
    """

    whole: OceanParameters
    area: Area


@dataclass(frozen=True)
class Plan:
    """The plan of an ocean.

    parameters : for renders
    metres : per Blender unit
    viewport, render : mesh and samples
    channels : the requested ones
    frame : of the scene, possibly a subframe
    time : the ocean's, s
    rate : seconds of it per second of the scene
    placed : waves omitted from the parameters; None for none
    over_bed : the sea with its coast, without which the parameters are; None for the open sea
    """

    parameters: OceanParameters
    metres: Fraction
    viewport: Grid
    render: Grid
    channels: frozenset[str]
    frame: Fraction
    time: Fraction
    rate: float
    placed: Placed | None = None
    over_bed: OceanParameters | None = None

    @property
    def whole(self) -> OceanParameters:
        """The sea with all of its waves."""
        if self.over_bed is not None:
            return self.over_bed
        return self.parameters if self.placed is None else self.placed.whole

    @property
    def maps(self) -> tuple[str, ...]:
        """The requested image maps."""
        return maps_of(self.channels)

    @property
    def has_own_render(self) -> bool:
        """Whether renders show another surface than the viewport."""
        return self.render != self.viewport

    @property
    def is_whole(self) -> bool:
        """Whether the frame is not a subframe."""
        return self.frame.denominator == 1

    @property
    def scale(self) -> float:
        """Blender units in a metre."""
        return float(1 / self.metres)

    def viewport_sea(self, coarse: bool = False) -> OceanParameters:
        """The sea that the viewport shows; if coarse, with few samples."""
        samples = self.viewport.samples
        return _sea_in_viewport(
            self.parameters, min(COARSE, samples) if coarse else samples, self.has_own_render
        )


def sea_over_bed(plan: Plan) -> Ocean:
    """The sea of a plan that has a coast, with what is made once of it."""
    assert plan.over_bed is not None
    return sea_over(plan.over_bed)


def sea_over(parameters: OceanParameters) -> Ocean:
    """The sea of parameters with a coast, with what is made once of it."""
    return MEMO.get("seas over beds", parameters, lambda: Ocean(parameters))


def in_units(channel: Channel, plan: Plan) -> float:
    """By what a channel's values are multiplied to be in Blender units, per second of the scene."""
    return (plan.scale if channel.scales else 1.0) * (plan.rate if channel.is_rate else 1.0)


def new_viewport_sea(parameters: OceanParameters, viewport_resolution: int) -> OceanParameters:
    """The sea that the viewport will show of a live ocean that is made with these."""
    samples = min(_most_samples(viewport_resolution), parameters.resolution)
    return _sea_in_viewport(parameters, samples, samples != parameters.resolution)


def _sea_in_viewport(parameters: OceanParameters, samples: int, has_own_render: bool) -> OceanParameters:
    parameters = parameters.at_resolution(samples)
    if not has_own_render:
        return parameters
    foam = parameters.foam
    most = min(foam.resolution or parameters.resolution, VIEWPORT_FOAM)
    return parameters.replace(foam=dataclasses.replace(foam, resolution=most))


def _most_samples(viewport_resolution: int) -> int:
    """An even number, as the core wants it."""
    return max(viewport_resolution // 2 * 2, _LEAST_SAMPLES)


def plan_of(settings: OceanSettings, scene: bpy.types.Scene) -> Plan:
    """The plan for some settings at the scene's present frame.

    Raises ParameterError for invalid settings, OceanObjectError for a grid too large.
    """
    parameters, metres = settings.to_parameters(scene), metres_per_unit(scene)
    size = float(Fraction(parameters.domain_size) / metres)
    most = _most_samples(settings.viewport_resolution)
    if settings.source == "LIVE":
        render, view = parameters.resolution, min(most, parameters.resolution)
        quads = view
    else:
        # the files have their own resolution, but the viewport moves fewer quads
        render = view = settings.sequence_samples
        quads = min(most, view)
    fixed, repeats = settings.mesh_resolution, (settings.repeats_x, settings.repeats_y)
    viewport = Grid(size, fixed or quads, view, repeats)
    clock, channels = clock_of(settings, scene, parameters.timing.start_frame), wanted_channels(settings)
    if clock.rate is None:  # without velocity, renderers use subframes for motion blur
        channels -= {"velocity"}
    plan = Plan(
        parameters, metres, viewport, Grid(size, fixed or render, render, repeats), channels,
        frame_with_subframe(scene), clock.time, 1.0 if clock.rate is None else clock.rate,
    )  # fmt: skip
    for grid in (plan.viewport, plan.render):
        _check(grid)
    return plan


def in_window(samples: int) -> int:
    """Samples along each side of a patch that a window shows, of those of a render.

    Planned patches have four samples per shortest wave, and two are enough to resolve it.
    """
    return min(samples, max(_PATCH_SAMPLES, samples // 4 * 2))


def velocity_scale(settings: OceanSettings, plan: Plan, scene: bpy.types.Scene) -> float:
    """Blender units per second of the scene in a metre per second of the sea.

    A sequence shows its files by the scene's frames, whatever frame rate and time stretch it was baked with,
    so it may play faster or slower.
    """
    if settings.source == "LIVE" or not settings.sequence_fps:
        return plan.scale
    played = baked_stretch(settings) / time_stretch(scene)
    return float(played * frame_rate(scene) / Fraction(settings.sequence_fps) / plan.metres)


def seconds_per_file(settings: OceanSettings, scene: bpy.types.Scene) -> float:
    """Scene time in s from one file of a sequence to the next."""
    return float(time_stretch(scene) / baked_stretch(settings) / frame_rate(scene))


def _check(grid: Grid) -> None:
    memory, need = usable_memory(), grid.vertices * _VERTEX_BYTES
    if memory is not None and need > memory:
        raise OceanObjectError(
            f"{grid.repeats[0]} x {grid.repeats[1]} repeats of {grid.quads}² quads need "
            f"{need / 2**30:.0f} GB of memory and this machine has {memory / 2**30:.0f} GB: "
            "lower the repeats or the resolution"
        )


def camera_surface_of(ocean: bpy.types.Object) -> bpy.types.Object | None:
    """The camera surface of an ocean, or None."""
    return next((child for child in ocean.children if surface_modifier(child) is not None), None)


def plan_for(ocean: bpy.types.Object, settings: OceanSettings, scene: bpy.types.Scene) -> Plan:
    """The plan of an ocean; with a camera surface, its own mesh has only waves that repeat.

    settings : of the ocean, original or animated

    Raises as `plan_of`.
    """
    plan, surface = plan_of(settings, scene), camera_surface_of(ocean)
    if plan.parameters.has_coast:
        whole = plan.parameters
        plan = dataclasses.replace(plan, parameters=open_sea(whole), over_bed=whole)
    own = repeating(plan.parameters) if surface is not None else plan.parameters
    if surface is None or own is plan.parameters:
        return plan
    area = area_around(camera_place(surface, scene, plan.scale), own.domain_size, plan.viewport.samples)
    return dataclasses.replace(plan, parameters=own, placed=Placed(plan.parameters, area))


def area_around(place: tuple[float, float], domain_size: float, samples: int) -> Area:
    """Where waves that do not repeat are shown around a camera at a place in m, of a sea with so many samples
    along each side of its domain."""
    size, cells = _AROUND * domain_size, min(_AROUND * samples, _AREA_CELLS)
    cell = size / cells  # a moving camera shows the same samples
    x, y = (cell * round((along - 0.5 * size) / cell) for along in place)
    return Area(size + cell, cells + 1, (x, y))


def camera_place(surface: bpy.types.Object, scene: bpy.types.Scene, scale: float) -> tuple[float, float]:
    """x and y in m, in the ocean's space, of the camera around which a surface shows it.

    scale : Blender units in a metre
    """
    matrix = camera_matrix(surface, scene)
    x, y, _ = surface.parent.matrix_world.inverted_safe() @ matrix.translation
    return x / scale, y / scale


def scene_camera_place(ocean: bpy.types.Object, scene: bpy.types.Scene, scale: float) -> tuple[float, float]:
    """x and y in m, in an ocean's space, of the scene's camera; its origin without one.

    scale : Blender units in a metre
    """
    if scene.camera is None:
        return 0.0, 0.0
    x, y, _ = ocean.matrix_world.inverted_safe() @ scene.camera.matrix_world.translation
    return x / scale, y / scale


def camera_matrix(surface: bpy.types.Object, scene: bpy.types.Scene) -> Matrix:
    """Of the camera around which a surface shows its ocean, in the world."""
    matrix = camera_of(surface, scene).matrix_world.copy()
    seen = _seen.get(surface.session_uid)
    if seen is not None and seen.stale == matrix:
        matrix = seen.matrix
    _used[surface.session_uid] = matrix
    return matrix


def camera_has_moved(
    surface: bpy.types.Object, scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph, scale: float
) -> bool:
    """Whether an evaluation has the camera of a surface elsewhere than what lies around it was made for, or
    turned elsewhere.

    In a render only the evaluation knows where a camera is: from now on `camera_place` goes by it.
    """
    camera, uid = camera_of(surface, scene), surface.session_uid
    now = camera.evaluated_get(depsgraph).matrix_world.copy()
    _seen[uid] = _Seen(camera.matrix_world.copy(), now)
    if uid not in _used:
        return False
    before = _used[uid]
    turned = before.to_quaternion().rotation_difference(now.to_quaternion()).angle
    return turned > _FAR_TURNED or (before.translation - now.translation).length > _FAR_MOVED * scale


def forget_cameras() -> None:
    """Another file is opened, or the extension is disabled."""
    _seen.clear()
    _used.clear()


def camera_of(surface: bpy.types.Object, scene: bpy.types.Scene) -> bpy.types.Object:
    """The camera of a surface; the surface itself if there is none."""
    return get_input(surface_modifier(surface), "Camera") or scene.camera or surface


def surface_modifier(surface: bpy.types.Object) -> bpy.types.NodesModifier | None:
    """The camera surface's modifier on an object, or None."""
    modifiers = (modifier for modifier in surface.modifiers if modifier.type == "NODES")
    return next((each for each in modifiers if is_of_kind(each.node_group, CAMERA_SURFACE)), None)
