# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that create points of spray from a live mesh's vertices, or from baked files.

Both have the columns of `core.spray.columns`: velocity, radius, age, kind and number, as in a PLY file. At
subframes, as used for motion blur, points are moved by their velocity: they remain those of the whole frame,
so EEVEE can match them, and Cycles uses the attribute.
"""

from __future__ import annotations

import math

import bpy

from ..core.spray.columns import COLUMNS, NUMBERS
from ..core.spray.drops import MIST
from .building import Builder, Plug, Socket, output
from .fields import alone, combined, coordinates, whole_number
from .names import VELOCITY
from .point_files import column, is_given, point_file
from .shown_frame import FRAME_INPUTS, SHOWN_FRAME
from .versioned import GroupKind, node_group

#: the input that holds a path
FILES = "Files"

INPUTS = (
    Plug(
        "Files", "NodeSocketString", "", "Baked spray, up to the number of the frame; empty where it is live"
    ),
    *FRAME_INPUTS,
    Plug("Scale", "NodeSocketFloat", 1.0, "Blender units in a metre of the files"),
    Plug(
        "Velocity Scale",
        "NodeSocketFloat",
        1.0,
        "Blender units per second in a metre per second of the files",
    ),
    Plug("Life", "NodeSocketFloat", 4.0, "Seconds in which mist fades away"),
    Plug("Viewport Share", "NodeSocketFloat", 1.0, "Of all particles, those that a window shows, the larger"),
    Plug("Material", "NodeSocketMaterial", None, "Of the points"),
)
#: of their distance to the camera, the radii of drops, least and most, and of puffs of mist, at most: a drop
#: at the lens is no ball that covers the picture, all are not of one size there, and no camera is in a puff
_LARGEST_DROPS, _LARGEST_MIST = (0.00025, 0.0009), 0.25
#: puffs behind each other, from which on fewer and denser ones are drawn in their place, up to some density.
# Cycles ends light in black after as many as its transparent bounces, and those are slow
_LAYERS, _DENSEST = 8.0, 6.0
#: directions around the camera in which puffs are counted: sectors, and bands of height of equal solid angle
_SECTORS, _BANDS = 32, 64
#: radius of a puff, relative to its distance to the camera, beyond which it thins: one alone is like a drop
# on the lens; smaller ones may be denser, the smaller they are
_LARGE_PUFF = 0.02
#: densities by which a puff comes and goes relative to the mean that they leave: ∫ min(1, 1/x - 1) dx is ln 2
_FADING = 1.0 / math.log(2.0)
#: a distance beyond all, and the least denominator
_FAR, _TINY = 1e9, 1e-7
#: point attributes: what a particle is, how much of its life is left, 0 to 1, and for the material the
# density of mist, relative to new mist
KIND, LEFT, DENSITY = "kind", "left", "mist_density"


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, INPUTS)
    frame = build.group(node_group(SHOWN_FRAME), {name: build.given(name) for name, *_ in FRAME_INPUTS})
    files, live = build.given(FILES), build.given("Geometry")
    is_baked = is_given(build, files)
    particles = build.switch("GEOMETRY", is_baked, live, point_file(build, files, output(frame, "Frame")))
    scale = build.given("Scale")
    share = _share(build)
    shown = _thinned(build, particles, share)
    velocity = build.scaled(
        combined(build, *(column(build, name) for name in COLUMNS[3:6])), build.given("Velocity Scale")
    )
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    moved = build.vector(
        "ADD", build.scaled(position, scale), build.scaled(velocity, output(frame, "Seconds"))
    )
    larger = build.math("DIVIDE", 1.0, build.math("SQRT", share, None))
    radius = build.math("MULTIPLY", build.math("MULTIPLY", column(build, "radius"), scale), larger)
    is_mist = build.compare("GREATER_THAN", column(build, KIND), MIST - 0.5, "FLOAT")
    view = _from_camera(build, moved)
    away = alone(build, "LENGTH", view)
    largest = build.switch("FLOAT", is_mist, _largest_drop(build), _LARGEST_MIST)
    largest = build.math("MULTIPLY", away, largest)
    radius = build.math("MINIMUM", radius, largest)
    left = build.math("SUBTRACT", 1.0, build.math("DIVIDE", column(build, "age"), build.given("Life")))
    shown = build.store(shown, VELOCITY, velocity, "FLOAT_VECTOR")
    shown = build.store(shown, LEFT, left, "FLOAT")
    seen = build.math("DIVIDE", radius, away)
    layers = _layers(build, view, build.math("MULTIPLY", seen, is_mist))
    shown = build.store(shown, DENSITY, _density(build, layers, left, seen, share), "FLOAT")
    # none is deleted: EEVEE pairs points by their order, and the camera moves within a frame
    is_drawn = build.compare("GREATER_THAN", column(build, DENSITY), 0.0, "FLOAT")
    is_drawn = build.logic("OR", is_drawn, build.logic("NOT", is_mist, False))
    radius = build.switch("FLOAT", is_drawn, 0.0, radius)
    points = build.change("GeometryNodeMeshToPoints", shown, {"Position": moved, "Radius": radius})
    build.finish(build.change("GeometryNodeSetMaterial", points, {"Material": build.given("Material")}))


def _largest_drop(build: Builder) -> Socket:
    """Radius of a drop relative to its distance, at most: few are large, as few drops are."""
    least, most = _LARGEST_DROPS
    part = build.math("DIVIDE", column(build, "number"), float(NUMBERS))
    return build.math("ADD", build.math("MULTIPLY", build.math("POWER", part, 3.0), most - least), least)


def _share(build: Builder) -> Socket:
    """Of the particles, those that are shown: all of them in renders."""
    is_window = output(build.add("GeometryNodeIsViewport"), "Is Viewport")
    least = build.math("MAXIMUM", build.given("Viewport Share"), 1e-3)
    return build.switch("FLOAT", is_window, 1.0, build.math("MINIMUM", least, 1.0))


def _thinned(build: Builder, particles: Socket, share: Socket) -> Socket:
    """The particles with the smallest numbers: those have no order."""
    part = build.math("DIVIDE", column(build, "number"), float(NUMBERS))
    more = build.compare("GREATER_THAN", part, share, "FLOAT")
    return build.change("GeometryNodeDeleteGeometry", particles, {"Selection": more}, domain="POINT")


def _from_camera(build: Builder, place: Socket) -> Socket:
    """Vectors from the scene's camera to points; without one, from beyond all."""
    active = output(build.add("GeometryNodeInputActiveCamera"), "Active Camera")
    camera = build.add("GeometryNodeObjectInfo", {"Object": active}, transform_space="RELATIVE")
    # there is no node for it, but an object that is not there has no scale
    is_there = build.compare("GREATER_THAN", alone(build, "LENGTH", output(camera, "Scale")), 0.0, "FLOAT")
    view = build.vector("SUBTRACT", place, output(camera, "Location"))
    return build.switch("VECTOR", is_there, (0.0, 0.0, _FAR), view)


def _layers(build: Builder, view: Socket, seen: Socket) -> Socket:
    """How many puffs of mist the camera sees behind each other, on average over the directions around each.

    view : from the camera to the puff
    seen : radius of the puff relative to its distance; 0 for what is no mist
    """
    x, y, z = coordinates(build, view)
    turn = build.math("MULTIPLY", build.math("ARCTAN2", y, x), _SECTORS / (2.0 * math.pi))
    height = build.math("MULTIPLY", build.math("DIVIDE", z, alone(build, "LENGTH", view)), _BANDS)
    sector, band = (whole_number(build, each, "FLOOR") for each in (turn, height))
    direction = build.integer("ADD", build.integer("MULTIPLY", sector, 4 * _BANDS), band)
    # a puff covers π seen², and 2π of a sphere have all sectors at all heights above 0
    covered = build.math("MULTIPLY", build.math("MULTIPLY", seen, seen), 0.5 * _SECTORS * _BANDS)
    total = build.add(
        "GeometryNodeAccumulateField",
        {"Value": build.math("MINIMUM", covered, 1.0), "Group ID": direction},
        data_type="FLOAT",
    )
    return output(total, "Total")


def _density(build: Builder, layers: Socket, left: Socket, seen: Socket, share: Socket) -> Socket:
    """Density of a puff of mist relative to new mist; 0 for those that are not drawn.

    Mist thins with age. Of puffs thinner than the least density, as many are drawn with that density as leave
    the mean as it is, those with the smallest numbers; each comes and goes by degrees.

    seen : radius relative to the distance to the camera
    share : of the particles, those that are shown, with the smallest numbers
    """
    crowd = build.math("DIVIDE", layers, _LAYERS)
    # a large puff is thinned below, and until then may be as much denser
    large = build.math("DIVIDE", seen, _LARGE_PUFF)
    densest = build.math("MAXIMUM", large, build.math("DIVIDE", 1.0, large))
    densest = build.math("MINIMUM", densest, _DENSEST)
    least = build.math("MAXIMUM", build.math("MINIMUM", crowd, densest), _TINY)
    left = build.math("MAXIMUM", left, 0.0)
    number = build.math("DIVIDE", column(build, "number"), build.math("MULTIPLY", share, float(NUMBERS)))
    limit = build.math("MULTIPLY", least, build.math("MAXIMUM", number, _TINY))
    over = build.math("SUBTRACT", build.math("DIVIDE", build.math("MULTIPLY", left, _FADING), limit), 1.0)
    fade = build.math("MINIMUM", build.math("MAXIMUM", over, 0.0), 1.0)
    near = build.math("DIVIDE", _LARGE_PUFF, build.math("MAXIMUM", seen, _LARGE_PUFF))
    density = build.math("MULTIPLY", build.math("MAXIMUM", left, least), fade)
    return build.math("MULTIPLY", density, build.math("MULTIPLY", near, near))


SPRAY = GroupKind("Ocean Tweak Spray", 7, _build)
