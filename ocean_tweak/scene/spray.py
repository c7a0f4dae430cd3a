# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray of an ocean in Blender: a child of it whose vertices are the particles, which nodes make points of.

It is recomputed in every whole frame and not saved, unless nodes read it from the files of a bake.
"""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.data.errors import ParameterError
from ..core.data.frames import held_frame
from ..core.parameters.spray import Spray
from ..core.sea.spray_outlook import why_none
from ..core.spray.columns import COLUMNS
from ..nodes.modifier_inputs import set_inputs
from ..nodes.shading import Shading
from ..nodes.shown_frame import frame_values
from ..nodes.spray import FILES, SPRAY
from ..nodes.spray_look import SPRAY_LOOK
from ..nodes.versioned import is_of_kind, lay_out, node_group
from . import failures, held_sea, water_material
from .baked_spray import BakedSpray, baked_spray, left_out, spray_to_bake
from .image_sequence import baked_stretch, shown_frame
from .live_spray import IN_WINDOW, wanted
from .ownership import remove_with_meshes
from .plan import Plan, seconds_per_file, velocity_scale
from .settings import is_ocean, link_beside, settings_of
from .units import frame_rate, time_stretch

_MARK = "ocean_tweak_spray"
#: custom property of the ocean that keeps its spray's material: the object itself is not saved
_MATERIAL = "ocean_tweak_spray_material"
_NAME = "Ocean Tweak Spray"
#: of the Solid view, which knows no shaders: puffs of mist lie over each other as a haze, and hide no ship
_IN_SOLID = (0.95, 0.95, 0.95, 0.08)
#: layers of mist that light goes through in Cycles
TRANSPARENT_BOUNCES = 256
#: frames that there are: those of live spray have no files
_MOST = 1_048_574


@dataclass(frozen=True)
class _Held:
    """What a mesh holds, and the frame for which it was asked."""

    content: Hashable
    frame: Fraction


# what the meshes hold, by their session uid
_shown: dict[int, _Held] = {}


def refresh(
    ocean: bpy.types.Object,
    plan: Plan,
    scene: bpy.types.Scene,
    patient: bool = True,
    is_rendered: bool = False,
) -> bool:
    """Make, renew or remove an ocean's spray. Returns whether it shows all that it will.

    patient : otherwise what takes long is left out
    is_rendered : whether all particles are wanted, which without a window always are

    Raises SprayError for more particles than the memory holds.
    """
    if ocean.library is not None:
        return True
    asked = wanted(ocean, plan, scene, is_rendered)
    if asked is None:
        remove(ocean)
        if plan.whole.spray is not None and (why := why_none(plan.whole)) is not None:
            failures.warned(ocean, "spray", why)
        return True
    item = spray_of(ocean) or _new(ocean)
    if item.data.users > 1:  # of a duplicate
        item.data = item.data.copy()
    baked = baked_spray(settings_of(ocean))
    held_sea.keep_out(item, baked is None)
    _tell_nodes(ocean, item, asked.spray, baked, plan, scene)
    if baked is not None:
        if len(item.data.vertices):
            item.data.clear_geometry()
            _shown.pop(item.data.session_uid, None)
        return True
    wanted_now = _Held((asked, plan.rate, plan.scale), plan.frame)
    if _is_shown(_shown.get(item.data.session_uid), wanted_now):
        return True
    if not patient and not asked.is_near:
        return False
    _write(item.data, asked.columns(), plan)
    _shown[item.data.session_uid] = wanted_now
    return True


def _is_shown(held: _Held | None, asked: _Held) -> bool:
    """Whether a mesh holds what is asked for. Between two frames that of the nearest one is enough: the nodes
    move it, and motion blur compares the same particles."""
    if held is None:
        return False
    is_between = asked.frame.denominator != 1 and abs(asked.frame - held.frame) <= Fraction(1, 2)
    return is_between or held.content == asked.content


def too_few_bounces(ocean: bpy.types.Object, scene: bpy.types.Scene) -> str | None:
    """What to say where Cycles ends light in dense mist, which then is dark; None where all is well."""
    bounces = scene.cycles.transparent_max_bounces if scene.render.engine == "CYCLES" else TRANSPARENT_BOUNCES
    if (
        bounces >= TRANSPARENT_BOUNCES or not settings_of(ocean).use_spray
    ):  # a panel asks: no search of objects
        return None
    return (
        f"mist will be dark where it is dense: Cycles has {bounces} transparent bounces, set "
        f"{TRANSPARENT_BOUNCES} in Render > Light Paths"
    )


def spray_of(ocean: bpy.types.Object) -> bpy.types.Object | None:
    """The object that shows an ocean's spray; None where there is none."""
    return next((child for child in ocean.children if is_ours(child)), None)


def is_ours(item: bpy.types.Object) -> bool:
    """Whether an object was made to show an ocean's spray."""
    return _MARK in item


def remove(ocean: bpy.types.Object) -> None:
    """Take an ocean's spray away."""
    remove_with_meshes(child for child in ocean.children if is_ours(child))


def remove_left() -> None:
    """Take away that of deleted oceans: nobody can choose it."""
    remove_with_meshes(item for item in bpy.data.objects if is_ours(item) and not is_ocean(item.parent))


def forget_all() -> None:
    """Take no mesh for filled: a file was opened, or a step undone."""
    _shown.clear()


def _new(ocean: bpy.types.Object) -> bpy.types.Object:
    name = f"{ocean.name} Spray"
    item = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    item[_MARK] = ""
    item.parent = ocean
    item.hide_select = True
    # from each puff of mist that a ray meets others go to the sun and around, through all the puffs there
    item.visible_shadow = item.visible_diffuse = item.visible_glossy = False
    link_beside(item, ocean)
    item.modifiers.new(_NAME, "NODES").node_group = node_group(SPRAY)
    held_sea.keep_out(item, True)
    return item


def _tell_nodes(
    ocean: bpy.types.Object,
    item: bpy.types.Object,
    spray: Spray,
    baked: BakedSpray | None,
    plan: Plan,
    scene: bpy.types.Scene,
) -> None:
    modifier = next(each for each in item.modifiers if is_of_kind(each.node_group, SPRAY))
    settings = settings_of(ocean)
    material = _material(ocean)
    if not item.data.materials:  # the Solid view takes colors of slots and not those of nodes
        item.data.materials.append(material)
    inputs: dict[str, object] = {"Material": material, "Life": spray.life}
    if baked is None:
        # a file a frame of the scene, whatever its stretch of time
        files, seconds = float(time_stretch(scene)), float(1 / frame_rate(scene))
        inputs |= {FILES: "", "Scale": 1.0, "Velocity Scale": 1.0, "Viewport Share": 1.0}
        inputs |= frame_values(range(-_MOST, _MOST + 1), files, seconds)
    else:
        inputs |= {
            FILES: baked.start, "Scale": plan.scale, "Velocity Scale": velocity_scale(settings, plan, scene),
            "Life": baked.spray.life, "Viewport Share": IN_WINDOW,
            **frame_values(
                baked.frames, float(baked_stretch(settings)), seconds_per_file(settings, scene)
            ),
        }  # fmt: skip
    set_inputs(modifier, inputs)


def is_live(ocean: bpy.types.Object) -> bool:
    """Whether an ocean has spray that no files show."""
    return spray_of(ocean) is not None and baked_spray(settings_of(ocean)) is None


def waits_for_bake(ocean: bpy.types.Object, scene: bpy.types.Scene) -> bool:
    """Whether an ocean has spray that no files show, and another bake would write some."""
    try:
        return is_live(ocean) and spray_to_bake(ocean, scene) is not None
    except ParameterError:
        return False  # the ocean tells


def note_files(ocean: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Let the console hear that the present frame has no file of spray, so that that of another is shown, or
    that files are of an older bake."""
    settings = settings_of(ocean)
    baked = None if spray_of(ocean) is None else baked_spray(settings)
    if baked is None:
        return
    if (text := baked.differs(settings.to_parameters(scene).spray)) is not None:
        failures.warned(ocean, "spray bake", f"{text}: bake it again to see yours")
    for what, remedy in left_out(ocean, scene):
        failures.warned(ocean, f"spray of {what}", f"the baked spray has none of {what}: {remedy}")
    frame = shown_frame(settings, scene, scene.frame_current)
    if frame not in baked.frames:
        held = held_frame(baked.frames, frame)
        failures.warned(
            ocean, "spray files",
            f"{Path(baked.start).name}{frame:04}.ply is missing, and the spray of frame {held} is shown: "
            "bake it again with spray",
        )  # fmt: skip


def _material(ocean: bpy.types.Object) -> bpy.types.Material:
    """That of an ocean's spray; made where it has none, in the air of its water."""
    material = ocean.get(_MATERIAL)
    if isinstance(material, bpy.types.Material):
        return material
    material = bpy.data.materials.new(_NAME)
    if material.node_tree is None:  # a material has nodes from the start since Blender 5.0
        material.use_nodes = True
    material.diffuse_color = _IN_SOLID
    shade = Shading(material.node_tree)
    look = shade.node("ShaderNodeGroup", node_tree=node_group(SPRAY_LOOK))
    shade.tree.links.new(look.outputs["Surface"], shade.node("ShaderNodeOutputMaterial").inputs["Surface"])
    lay_out(shade.tree)
    ocean[_MATERIAL] = material
    put_in_air(ocean)
    return material


def put_in_air(ocean: bpy.types.Object) -> None:
    """Give an ocean's spray the air of its water."""
    material, water = ocean.get(_MATERIAL), water_material.water_node(ocean.active_material)
    if not isinstance(material, bpy.types.Material) or water is None:
        return
    nodes = (node for node in material.node_tree.nodes if node.type == "GROUP")
    for look in (node for node in nodes if is_of_kind(node.node_tree, SPRAY_LOOK)):
        for name in {"Visibility", "Haze Color"} & {*look.inputs.keys()} & {*water.inputs.keys()}:
            look.inputs[name].default_value = water.inputs[name].default_value


def _write(mesh: bpy.types.Mesh, values: NDArray[np.float32], plan: Plan) -> None:
    """Put (particles, columns) on the vertices of a mesh, in Blender units, per second of the scene."""
    values[:, :7] *= np.float32(plan.scale)
    values[:, 3:6] *= np.float32(plan.rate)
    if len(mesh.vertices) != len(values):
        mesh.clear_geometry()
        mesh.vertices.add(len(values))
    places = np.ascontiguousarray(values[:, :3])
    mesh.attributes["position"].data.foreach_set("vector", places.reshape(-1))
    for number, name in enumerate(COLUMNS[3:], 3):
        attribute = mesh.attributes.get(name) or mesh.attributes.new(name, "FLOAT", "POINT")
        attribute.data.foreach_set("value", np.ascontiguousarray(values[:, number]))
    mesh.update_tag()
