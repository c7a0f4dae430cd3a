# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry nodes that displace a grid like a sea and write its attributes.

They read either mesh attributes, which is fastest and used for a live sea in the viewport, or images: of
baked files, for a mesh that does not have one vertex per sample, and for renders finer than the viewport.
Images are in metres; `Scale` converts them to Blender units. They are sampled at the attribute `st`, which
includes the half texel, or, without it, at the position.

A sea of several patches is their sum at a vertex's rest position:

- displacements and velocities are added;
- normals are added by their slopes n_xy / n_z, with n_z at least 0.01: an overhanging sheet counts as very
  steep. A single patch keeps its normals;
- foam and breaking combine like independent layers: 1 - (1 - a)(1 - b);
- the age of foam is that of the denser one;
- compressions (cusp) are added, as for compressions along the same direction, which is the maximum.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from typing import Any, NamedTuple

import bpy

from .building import Builder, Panel, Plug, Socket, output
from .extension_check import ABSENCE
from .extension_check import INPUTS as ABSENCE_INPUTS
from .frame_warnings import WARNINGS
from .grid import GRID
from .grid import INPUTS as GRID_INPUTS
from .names import BREAKING, CUSP, DISPLACEMENT, FOAM, FOAM_AGE, TEXTURE_COORDINATES, VELOCITY
from .patch import EARLY_IMAGE_INPUTS, IMAGE_INPUTS, PATCH, SCALE_INPUTS
from .shown_frame import FRAME_INPUTS, SHOWN_FRAME
from .versioned import GroupKind, node_group

_VERSION = 6
_NAME = "Ocean Tweak"

#: largest number of patches that a group can add
MOST_ADDED = 8

#: smallest n_z for slopes
_LEAST_UPWARDS = 0.01

_SEA_INPUTS = (
    Plug("Use Attributes", "NodeSocketBool", False, "Read the mesh's attributes instead of the images"),
    Plug("Move", "NodeSocketBool", True, "Move the mesh; otherwise only write attributes"),
    *SCALE_INPUTS,
    Plug(
        "Warn Out of Range", "NodeSocketBool", False,
        "Show a warning at frames without a file. The last one before, or else the first, is held either way",
    ),
    *ABSENCE_INPUTS,
    Plug(
        "Displaced", "NodeSocketBool", False,
        "A Displace modifier has moved the mesh, by the last whole frame: move it on from there",
        hidden=True,
    ),
    Plug("Purpose", "NodeSocketString", "", "What the extension made this modifier for", hidden=True),
)  # fmt: skip

_GRID_PANEL = Panel(
    "Grid",
    (
        Plug(
            "Make Grid",
            "NodeSocketBool",
            False,
            "Replace the mesh by a grid; the materials are kept",
        ),
        *(plug for plug in GRID_INPUTS if plug[0] not in ("Samples", "Live")),
    ),
)

_PATCH_INPUTS = (
    *IMAGE_INPUTS,
    *EARLY_IMAGE_INPUTS,
    Plug("Domain Size", "NodeSocketFloat", 400.0, "Side of the patch that repeats, in Blender units"),
    Plug("Resolution", "NodeSocketInt", 512, "Samples along each side of the images"),
    *FRAME_INPUTS,
)


def numbered(name: str, patch: int) -> str:
    """The name of a patch's input; the first patch has the plain name."""
    return name if patch == 1 else f"{name} {patch}"


@lru_cache
def ocean_group(patches: int = 1) -> GroupKind:
    """The group for a number of patches. Raises ValueError outside 1 to MOST_ADDED."""
    if not 1 <= patches <= MOST_ADDED:
        raise ValueError(f"patches = {patches}: must be from 1 to {MOST_ADDED}")
    name = _NAME if patches == 1 else f"{_NAME} {patches} Patches"
    return GroupKind(name, _VERSION, lambda tree: _build(tree, patches))


class _Surface(NamedTuple):
    """Fields over the mesh, and whether each map is present.

    on_from_begun : the displacement since the last whole frame
    is_between : whether there is any
    """

    displacement: Socket
    on_from_begun: Socket
    velocity: Socket
    normal: Socket
    foam: Socket
    cusp: Socket
    breaking: Socket
    foam_age: Socket
    is_between: Socket
    has_velocity: Socket
    has_normal: Socket
    has_foam: Socket
    has_foam_age: Socket
    warns: Socket


def _build(tree: bpy.types.NodeTree, patches: int) -> None:
    panels = (
        Panel(
            numbered("Patch", patch),
            tuple(plug._replace(name=numbered(plug.name, patch)) for plug in _PATCH_INPUTS),
        )
        for patch in range(1, patches + 1)
    )
    build = Builder(tree, (*_SEA_INPUTS, _GRID_PANEL, *panels))
    geometry = build.given("Geometry")
    # without the extension, a live sea stays as the mesh was saved
    is_live = {name: build.given(name) for name, *_ in ABSENCE_INPUTS}
    absent = output(build.group(node_group(ABSENCE), is_live), "Is Absent")
    make_grid = build.logic("NIMPLY", build.given("Make Grid"), absent)
    base = build.switch("GEOMETRY", make_grid, geometry, _own_grid(build, geometry))
    by_attributes = build.logic("NIMPLY", build.given("Use Attributes"), build.given("Make Grid"))
    by_attributes = build.logic("OR", by_attributes, absent)
    captured = build.add("GeometryNodeCaptureAttribute", domain="POINT")
    build.tree.links.new(base, captured.inputs["Geometry"])
    coordinates = [_captured(build, captured, patch) for patch in range(1, patches + 1)]
    surfaces = [
        _patch(build, place, patch, by_attributes) for patch, place in enumerate(coordinates, start=1)
    ]
    surface = _sum(build, surfaces)
    written = _written(build, output(captured, "Geometry"), surface)
    known = build.switch("GEOMETRY", by_attributes, written, base)
    offset = build.add("GeometryNodeInputNamedAttribute", {"Name": DISPLACEMENT}, data_type="FLOAT_VECTOR")
    moved = build.change("GeometryNodeSetPosition", known, {"Offset": output(offset, "Attribute")})
    moves = build.logic("OR", build.given("Move"), absent)
    result = build.switch("GEOMETRY", moves, _moved_on(build, known, surface), moved)
    # nobody asks a group for its warnings unless something hangs on them
    build.finish(build.switch("GEOMETRY", surface.warns, result, result))


def _moved_on(build: Builder, geometry: Socket, surface: _Surface) -> Socket:
    """The geometry moved by Displace, at a subframe: Displace reads the frame before."""
    moved = build.change("GeometryNodeSetPosition", geometry, {"Offset": surface.on_from_begun})
    is_behind = build.logic("AND", build.given("Displaced"), surface.is_between)
    return build.switch("GEOMETRY", is_behind, geometry, moved)


def _own_grid(build: Builder, geometry: Socket) -> Socket:
    inputs = {name: build.given(name) for name, *_ in GRID_INPUTS if name != "Samples"}
    inputs["Samples"] = build.given("Resolution")
    return build.change("GeometryNodeGroup", geometry, inputs, node_tree=node_group(GRID))


def _captured(build: Builder, captured: bpy.types.Node, patch: int) -> Socket:
    """Texture coordinates of a patch, captured once for all uses, as `st` is on corners."""
    name = numbered("Coordinates", patch)
    captured.capture_items.new("VECTOR", name)
    build.tree.links.new(_texture_coordinates(build, patch), captured.inputs[name])
    return captured.outputs[name]


def _texture_coordinates(build: Builder, patch: int) -> Socket:
    """Rest position / domain size + ½ / resolution; the first patch uses `st` if there is one."""
    attribute = build.add(
        "GeometryNodeInputNamedAttribute", {"Name": TEXTURE_COORDINATES}, data_type="FLOAT_VECTOR"
    )
    exists, st = output(attribute, "Exists"), output(attribute, "Attribute")
    place = output(build.add("GeometryNodeInputPosition"), "Position")
    if patch > 1:  # the mesh may have been displaced already: `st` has its rest position
        at_rest = build.vector("SUBTRACT", st, _half_texel(build, 1))
        place = build.switch("VECTOR", exists, place, build.scaled(at_rest, build.given("Domain Size")))
    fraction = build.vector("DIVIDE", place, build.given(numbered("Domain Size", patch)))
    centred = build.vector("ADD", fraction, _half_texel(build, patch))
    return centred if patch > 1 else build.switch("VECTOR", exists, centred, st)


def _half_texel(build: Builder, patch: int) -> Socket:
    return build.math("DIVIDE", 0.5, build.given(numbered("Resolution", patch)))


def _patch(build: Builder, coordinates: Socket, patch: int, by_attributes: Socket) -> _Surface:
    """One patch's maps, and warnings where files are missing."""

    def given(names: Iterable[tuple[Any, ...]]) -> dict[str, Socket]:
        return {name: build.given(numbered(name, patch)) for name, *_ in names}

    frame = build.group(node_group(SHOWN_FRAME), given(FRAME_INPUTS))
    maps = {
        **given(IMAGE_INPUTS),
        **given(EARLY_IMAGE_INPUTS),
        **{name: build.given(name) for name, *_ in SCALE_INPUTS},
        "Coordinates": coordinates,
    }
    shown, begun, seconds = (output(frame, name) for name in ("Frame", "Begun Frame", "Seconds"))
    read = build.group(node_group(PATCH), {**maps, "Frame": shown, "Seconds": seconds})
    before = build.group(node_group(PATCH), {**maps, "Frame": begun})
    warnings = build.group(
        node_group(WARNINGS),
        {
            "Scene Frame": output(frame, "Scene Frame"),
            "Frame": output(frame, "Frame"),
            "Is Held": build.logic("AND", output(frame, "Is Held"), build.given("Warn Out of Range")),
            "Is Missing": build.logic("NOR", output(read, "Has Displacement"), by_attributes),
        },
    )
    return _Surface(
        displacement=output(read, "Displacement"),
        on_from_begun=build.vector("SUBTRACT", output(read, "Displacement"), output(before, "Displacement")),
        velocity=output(read, "Velocity"),
        normal=output(read, "Normal"),
        foam=output(read, "Foam"),
        cusp=output(read, "Cusp"),
        breaking=output(read, "Breaking"),
        foam_age=output(read, "Foam Age"),
        is_between=build.logic(
            "OR",
            build.compare("NOT_EQUAL", seconds, 0.0, "FLOAT"),
            build.compare("NOT_EQUAL", shown, begun),
        ),
        has_velocity=output(read, "Has Velocity"),
        has_normal=output(read, "Has Normal"),
        has_foam=output(read, "Has Foam"),
        has_foam_age=output(read, "Has Foam Age"),
        warns=output(warnings, "Warning"),
    )


def _sum(build: Builder, surfaces: list[_Surface]) -> _Surface:
    """The sum of the patches; the rules are at the top of this file."""
    total = surfaces[0]
    slope = _slope(build, total.normal) if len(surfaces) > 1 else None
    for other in surfaces[1:]:
        slope = build.vector("ADD", slope, _slope(build, other.normal))
        is_denser = build.compare("GREATER_THAN", other.foam, total.foam, "FLOAT")
        total = _Surface(
            displacement=build.vector("ADD", total.displacement, other.displacement),
            on_from_begun=build.vector("ADD", total.on_from_begun, other.on_from_begun),
            velocity=build.vector("ADD", total.velocity, other.velocity),
            normal=total.normal,
            foam=_either(build, total.foam, other.foam),
            cusp=build.math("ADD", total.cusp, other.cusp),
            breaking=_either(build, total.breaking, other.breaking),
            foam_age=build.switch("FLOAT", is_denser, total.foam_age, other.foam_age),
            is_between=build.logic("OR", total.is_between, other.is_between),
            has_velocity=build.logic("OR", total.has_velocity, other.has_velocity),
            has_normal=build.logic("OR", total.has_normal, other.has_normal),
            has_foam=build.logic("OR", total.has_foam, other.has_foam),
            has_foam_age=build.logic("OR", total.has_foam_age, other.has_foam_age),
            warns=build.logic("OR", total.warns, other.warns),
        )
    if slope is None:
        return total
    upwards = build.vector("ADD", slope, (0.0, 0.0, 1.0))
    unit = build.add("ShaderNodeVectorMath", {"Vector": upwards}, operation="NORMALIZE")
    return total._replace(normal=output(unit, "Vector"))


def _either(build: Builder, one: Socket, other: Socket) -> Socket:
    """Combined coverage of two independent layers."""
    free = build.math("MULTIPLY", build.math("SUBTRACT", 1.0, one), build.math("SUBTRACT", 1.0, other))
    return build.math("SUBTRACT", 1.0, free)


def _slope(build: Builder, normal: Socket) -> Socket:
    """n_xy / n_z, and 0."""
    parts = build.add("ShaderNodeSeparateXYZ", {"Vector": normal})
    held = build.math("MAXIMUM", output(parts, "Z"), _LEAST_UPWARDS)
    flat = build.vector("MULTIPLY", normal, (1.0, 1.0, 0.0))
    return build.vector("DIVIDE", flat, held)


def _written(build: Builder, geometry: Socket, surface: _Surface) -> Socket:
    """The geometry with the surface's attributes; those without a map are omitted."""
    result = build.store(geometry, DISPLACEMENT, surface.displacement, "FLOAT_VECTOR")
    moving = build.store(result, VELOCITY, surface.velocity, "FLOAT_VECTOR")
    result = build.switch("GEOMETRY", surface.has_velocity, result, moving)
    foamy = build.store(result, FOAM, surface.foam, "FLOAT")
    foamy = build.store(foamy, CUSP, surface.cusp, "FLOAT")
    foamy = build.store(foamy, BREAKING, surface.breaking, "FLOAT")
    result = build.switch("GEOMETRY", surface.has_foam, result, foamy)
    aged = build.store(result, FOAM_AGE, surface.foam_age, "FLOAT")
    result = build.switch("GEOMETRY", surface.has_foam_age, result, aged)
    smooth = build.change("GeometryNodeSetShadeSmooth", result)  # flat faces have normals of their own
    shaded = build.change(
        "GeometryNodeSetMeshNormal", smooth, {"Custom Normal": surface.normal}, mode="FREE", domain="POINT"
    )
    return build.switch("GEOMETRY", surface.has_normal, result, shaded)
