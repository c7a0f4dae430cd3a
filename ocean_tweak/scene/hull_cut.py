# SPDX-License-Identifier: GPL-3.0-or-later
"""Hulls that are cut out of the water: their plans, and what the water's materials know of them.

As with collars, a hull says so by itself, in custom properties that its copies have too, and `refresh` brings
the materials into step. What is hidden is not cut out: a driver follows what renders show of the hull's
meshes, keyed or not, without the extension too, and `follow` what windows show, which drivers do not see.
Shaders do not know which of the two is shown, so a switch tells them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import bpy
import numpy as np

from ..core.sea.hull_plan import BAND, LEVELS, HullPlan, hull_plan
from ..nodes.hull_cut import EDGE, HIDDEN, HIDDEN_IN_WINDOW, HULL_CUT, HULL_PLACE, IN_WINDOW
from ..nodes.versioned import is_of_kind, node_group
from . import solid_foam
from .contact import is_shown, materials_of
from .hull import Hull
from .settings import OceanObjectError, is_ocean

# custom properties of a hull: the ocean, the image of its plan, and the inputs of its place
_OCEAN, _PLAN, _PLACE = "ocean_tweak_cut", "ocean_tweak_cut_plan", "ocean_tweak_cut_place"

#: inputs of a cut that are read from the plan
_LOOK_UPS = ("Lower", "Upper")

# what refers to a hull that is cut out: (material, node) by name
_known: list[tuple[str, str]] = []


def cut_out(item: bpy.types.Object, ocean: bpy.types.Object, hull: Hull | None) -> None:
    """Let no water of an ocean be inside a hull, or cut it out anew after it was changed.

    Raises OceanObjectError for what encloses nothing.
    """
    try:
        if hull is None or not len(hull.triangles):
            raise ValueError("it has no faces")
        plan = hull_plan(hull.vertices, hull.triangles)
    except ValueError as error:
        raise OceanObjectError(f"{item.name} cannot be cut out of the water: {error}") from error
    let_in(item)
    _, rows, columns = plan.distance.shape
    item[_OCEAN], item[_PLAN] = ocean, _image_of(f"{item.name} Hull", plan)
    item[_PLACE] = {
        "Rotation": tuple(hull.tilt.to_euler()),
        "Scale": tuple(hull.scale),
        "Low": (plan.low[0] + 0.5 * plan.texel, plan.low[1] + 0.5 * plan.texel, plan.low[2]),
        "Step": (plan.texel, plan.texel, plan.spacing),
        "Count": (float(columns), float(rows), float(LEVELS)),
    }
    refresh()


def let_in(item: bpy.types.Object) -> None:
    """Let the water of its ocean be inside a hull again."""
    if not is_cut(item):
        return
    image = item[_PLAN]
    for name in (_OCEAN, _PLAN, _PLACE):
        del item[name]
    refresh()
    if image.users == 0:
        bpy.data.images.remove(image)


def is_cut(item: bpy.types.Object) -> bool:
    """Whether an object is cut out of the water."""
    # what a file says there may be anything
    return isinstance(item.get(_PLAN), bpy.types.Image) and _OCEAN in item and _PLACE in item


def ocean_of(item: bpy.types.Object) -> bpy.types.Object | None:
    """The ocean that an object is cut out of; None for none."""
    ocean = item.get(_OCEAN)
    return ocean if is_cut(item) and isinstance(ocean, bpy.types.Object) else None


def why_unseen(ocean: bpy.types.Object) -> str:
    """Why hulls that are cut out of an ocean do not show; "" where they do."""
    own = [each for each in materials_of(ocean) if each.library is None and each.node_tree is not None]
    return (
        ""
        if own
        else f"{ocean.name} has no material of this file: give it one, for example Use Water Material"
    )


def refresh() -> None:
    """Cut out of the materials of each ocean's water the hulls that are cut out of it, and no others."""
    known = {
        item: ocean for item in bpy.data.objects if is_shown(item) and (ocean := ocean_of(item)) is not None
    }
    shown = {ocean: set(materials_of(ocean)) for ocean in set(known.values()) if is_ocean(ocean)}
    for material in _own_materials():
        if solid_foam.is_copy(material):
            continue
        wanted = [item for item, ocean in known.items() if material in shown.get(ocean, ())]
        outputs = sum(1 for surface in _surfaces(material.node_tree) if surface.links)
        if _cut_from(material.node_tree) != [(item, item[_PLAN]) for item in wanted] * outputs:
            _chain(material.node_tree, wanted)
    _known[:] = [
        (material.name, cut.name) for material in _own_materials() for cut in _cuts(material.node_tree)
    ]
    follow()


def follow() -> None:
    """Let windows cut out the hulls that they show, and no others."""
    for material_name, name in _known:
        material = bpy.data.materials.get(material_name)
        cut = None if material is None else material.node_tree.nodes.get(name)
        if cut is None or HIDDEN_IN_WINDOW not in cut.inputs:
            continue
        hull = _source(_source(_source(cut, "Lower"), "Vector"), "Vector")
        item = getattr(hull, "object", None)
        hidden = item is not None and not any(map(_is_in_view, _meshes_of(item)))
        if cut.inputs[HIDDEN_IN_WINDOW].default_value != float(hidden):
            cut.inputs[HIDDEN_IN_WINDOW].default_value = float(hidden)


def _is_in_view(part: bpy.types.Object) -> bool:
    return part.visible_get() if part.name in bpy.context.view_layer.objects else not part.hide_viewport


def _meshes_of(item: bpy.types.Object) -> list[bpy.types.Object]:
    """Those that a hull consists of, hidden or not."""
    return [part for part in (item, *item.children_recursive) if part.type == "MESH"]


def _own_materials() -> Iterator[bpy.types.Material]:
    for material in bpy.data.materials:
        if material.library is None and material.node_tree is not None:
            yield material


def show_in_window(is_window: bool) -> None:
    """Cut out the hulls that windows show, or those that renders show."""
    for material in _own_materials():
        for cut in _cuts(material.node_tree):
            if IN_WINDOW in cut.inputs:
                cut.inputs[IN_WINDOW].default_value = float(is_window)


@contextmanager
def set_aside() -> Iterator[None]:
    """While this is open no material has hulls, which would take their objects along into a library."""
    for material in _own_materials():
        if _cut_from(material.node_tree):
            _chain(material.node_tree, [])
    try:
        yield
    finally:
        refresh()


def _cut_from(tree: bpy.types.NodeTree) -> list[tuple[bpy.types.Object | None, bpy.types.Image | None]]:
    """The objects that are cut out, and the images of their plans, in the order of the chain."""
    found = []
    for cut in _cuts(tree):
        if not _is_driven(tree, cut):
            found.append((None, None))
            continue
        lower, upper = (_source(cut, name) for name in _LOOK_UPS)
        own = _source(_source(lower, "Vector"), "Vector")
        images = {getattr(each, "image", None) for each in (lower, upper)}
        found.append((getattr(own, "object", None), images.pop() if len(images) == 1 else None))
    return found


def _cuts(tree: bpy.types.NodeTree) -> list[bpy.types.Node]:
    return [node for node in tree.nodes if _is_group(node, HULL_CUT)]


def _is_driven(tree: bpy.types.NodeTree, cut: bpy.types.Node) -> bool:
    """Whether a cut follows what renders show of its hull, as those of another version do not."""
    known = {driver.data_path for driver in tree.animation_data.drivers} if tree.animation_data else set()
    return f"{cut.inputs[HIDDEN].path_from_id()}.default_value" in known


def _source(node: bpy.types.Node | None, name: str) -> bpy.types.Node | None:
    """What an input reads; None where somebody took the link away."""
    socket = node.inputs.get(name) if node is not None else None
    return socket.links[0].from_node if socket is not None and socket.links else None


def _surfaces(tree: bpy.types.NodeTree) -> list[bpy.types.NodeSocket]:
    return [node.inputs["Surface"] for node in tree.nodes if node.type == "OUTPUT_MATERIAL"]


def _is_group(node: bpy.types.Node, kind: object) -> bool:
    return node.type == "GROUP" and is_of_kind(node.node_tree, kind)


def _chain(tree: bpy.types.NodeTree, items: list[bpy.types.Object]) -> None:
    """Make these hulls all that is cut out of a material, one after another before its outputs."""
    water = {surface: _before(surface) for surface in _surfaces(tree)}
    for cut in _cuts(tree):
        _clear(tree, cut)
    for surface, shader in water.items():
        if shader is None:
            continue
        for number, item in enumerate(items):
            shader = _new_cut(tree, surface.node, item, number, shader)
        tree.links.new(shader, surface)


def _before(surface: bpy.types.NodeSocket) -> bpy.types.NodeSocket | None:
    """The shader of the water before all hulls; None without one."""
    while surface.links and _is_group(surface.links[0].from_node, HULL_CUT):
        surface = surface.links[0].from_node.inputs["Shader"]
    return surface.links[0].from_socket if surface.links else None


def _clear(tree: bpy.types.NodeTree, cut: bpy.types.Node) -> None:
    """Remove a cut and what it alone reads, whatever is left of that."""
    place = _source(cut, "Share")
    nodes = [cut, place, _source(place, "Vector"), *(_source(cut, name) for name in _LOOK_UPS)]
    for each in nodes:
        if each is not None:
            tree.nodes.remove(each)


def _new_cut(
    tree: bpy.types.NodeTree,
    at: bpy.types.Node,
    item: bpy.types.Object,
    number: int,
    shader: bpy.types.NodeSocket,
) -> bpy.types.NodeSocket:
    def add(kind: str, left: float, **settings: Any) -> bpy.types.Node:
        node = tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        node.location = (at.location.x - left, at.location.y - 300.0 - 320.0 * number)
        return node

    own = add("ShaderNodeTexCoord", 760.0, object=item)
    place = add("ShaderNodeGroup", 580.0, node_tree=node_group(HULL_PLACE))
    cut = add("ShaderNodeGroup", 140.0, node_tree=node_group(HULL_CUT), label=f"{item.name} Cut Out")
    values: Mapping[str, Any] = item[_PLACE].to_dict()
    for name, value in values.items():
        place.inputs[name].default_value = value
    tree.links.new(own.outputs["Object"], place.inputs["Vector"])
    for name in _LOOK_UPS:
        plan = add(
            "ShaderNodeTexImage", 400.0, image=item[_PLAN], interpolation="Closest", extension="EXTEND"
        )
        tree.links.new(place.outputs[name], plan.inputs["Vector"])
        tree.links.new(plan.outputs["Color"], cut.inputs[name])
        tree.links.new(plan.outputs["Alpha"], cut.inputs[f"{name} Last"])
    for name in ("Share", "Is Above"):
        tree.links.new(place.outputs[name], cut.inputs[name])
    tree.links.new(shader, cut.inputs["Shader"])
    cut.inputs[IN_WINDOW].default_value = 1.0
    # 1 while no mesh of it is rendered
    driver = cut.inputs[HIDDEN].driver_add("default_value").driver
    driver.type = "MIN"
    for part in _meshes_of(item):
        variable = driver.variables.new()
        variable.targets[0].id, variable.targets[0].data_path = part, "hide_render"
    return cut.outputs["Shader"]


def _image_of(name: str, plan: HullPlan) -> bpy.types.Image:
    """The plan as the shader reads it: level above level, each texel with its right and upper neighbours."""
    _, rows, columns = plan.distance.shape
    image = bpy.data.images.new(name, columns, rows * LEVELS, alpha=True, float_buffer=True, is_data=True)
    image.alpha_mode = "CHANNEL_PACKED"
    whole = np.pad(EDGE + plan.distance / (2.0 * BAND), ((0, 0), (0, 1), (0, 1)), mode="edge")
    texels = np.stack([whole[:, i : rows + i, j : columns + j] for i in (0, 1) for j in (0, 1)], axis=-1)
    image.pixels.foreach_set(texels.astype(np.float32).ravel())
    image.update()
    image.pack()
    return image
