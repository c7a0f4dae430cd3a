# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that create points of spray from a live mesh's vertices, or from baked files.

Both have the columns of `core.spray.columns`: velocity, radius, age, kind and number, as in a PLY file. At
subframes, as used for motion blur, points are moved by their velocity: they remain those of the whole frame,
so EEVEE can match them, and Cycles uses the attribute.
"""

from __future__ import annotations

import bpy

from ..core.spray.columns import COLUMNS, NUMBERS
from ..core.spray.drops import MIST
from .building import Builder, Plug, Socket, output
from .fields import alone, combined, named_attribute
from .names import VELOCITY
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
#: of their distance to the camera, the radii of drops and of puffs of mist at most: a drop at the lens is no
#: ball that covers the picture, and no camera is inside a puff
_LARGEST_DROP, _LARGEST_MIST = 0.003, 0.25
#: a radius that no point has
_ANY = 1e9
#: point attributes that the material reads: what a particle is, and how much of its life is left, 0 to 1
KIND, LEFT = "kind", "left"


def _build(tree: bpy.types.NodeTree) -> None:
    build = Builder(tree, INPUTS)
    frame = build.group(node_group(SHOWN_FRAME), {name: build.given(name) for name, *_ in FRAME_INPUTS})
    files, live = build.given(FILES), build.given("Geometry")
    length = output(build.add("FunctionNodeStringLength", {"String": files}), "Length")
    is_baked = build.compare("GREATER_THAN", length, 0)
    particles = build.switch("GEOMETRY", is_baked, live, _read(build, files, output(frame, "Frame")))
    scale = build.given("Scale")
    share = _share(build)
    shown = _thinned(build, particles, share)
    velocity = build.scaled(
        combined(build, *(_number(build, name) for name in COLUMNS[3:6])), build.given("Velocity Scale")
    )
    position = output(build.add("GeometryNodeInputPosition"), "Position")
    moved = build.vector(
        "ADD", build.scaled(position, scale), build.scaled(velocity, output(frame, "Seconds"))
    )
    larger = build.math("DIVIDE", 1.0, build.math("SQRT", share, None))
    radius = build.math("MULTIPLY", build.math("MULTIPLY", _number(build, "radius"), scale), larger)
    radius = build.math("MINIMUM", radius, _largest(build, moved))
    left = build.math("SUBTRACT", 1.0, build.math("DIVIDE", _number(build, "age"), build.given("Life")))
    shown = build.store(shown, VELOCITY, velocity, "FLOAT_VECTOR")
    shown = build.store(shown, LEFT, left, "FLOAT")
    points = build.change("GeometryNodeMeshToPoints", shown, {"Position": moved, "Radius": radius})
    build.finish(build.change("GeometryNodeSetMaterial", points, {"Material": build.given("Material")}))


def _read(build: Builder, files: Socket, frame: Socket) -> Socket:
    """The particles of a frame's file."""
    path = build.add("FunctionNodeFormatString", {"Format": "{files}{frame:04}.ply"})
    for kind, name, value in (("STRING", "files", files), ("INT", "frame", frame)):
        path.format_items.new(kind, name)
        build.tree.links.new(value, path.inputs[name])
    return output(build.add("GeometryNodeImportPLY", {"Path": output(path, "String")}), "Mesh")


def _share(build: Builder) -> Socket:
    """Of the particles, those that are shown: all of them in renders."""
    is_window = output(build.add("GeometryNodeIsViewport"), "Is Viewport")
    least = build.math("MAXIMUM", build.given("Viewport Share"), 1e-3)
    return build.switch("FLOAT", is_window, 1.0, build.math("MINIMUM", least, 1.0))


def _thinned(build: Builder, particles: Socket, share: Socket) -> Socket:
    """The particles with the smallest numbers: those have no order."""
    part = build.math("DIVIDE", _number(build, "number"), float(NUMBERS))
    more = build.compare("GREATER_THAN", part, share, "FLOAT")
    return build.change("GeometryNodeDeleteGeometry", particles, {"Selection": more}, domain="POINT")


def _largest(build: Builder, place: Socket) -> Socket:
    """The radius of a point, at most, as the scene's camera sees it; without one, any."""
    active = output(build.add("GeometryNodeInputActiveCamera"), "Active Camera")
    camera = build.add("GeometryNodeObjectInfo", {"Object": active}, transform_space="RELATIVE")
    # there is no node for it, but an object that is not there has no scale
    is_there = build.compare("GREATER_THAN", alone(build, "LENGTH", output(camera, "Scale")), 0.0, "FLOAT")
    away = alone(build, "LENGTH", build.vector("SUBTRACT", place, output(camera, "Location")))
    is_mist = build.compare("GREATER_THAN", _number(build, "kind"), MIST - 0.5, "FLOAT")
    share = build.switch("FLOAT", is_mist, _LARGEST_DROP, _LARGEST_MIST)
    return build.switch("FLOAT", is_there, _ANY, build.math("MULTIPLY", away, share))


def _number(build: Builder, name: str) -> Socket:
    return output(named_attribute(build, name, "FLOAT"), "Attribute")


SPRAY = GroupKind("Ocean Tweak Spray", 2, _build)
