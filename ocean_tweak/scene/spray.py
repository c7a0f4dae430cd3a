# SPDX-License-Identifier: GPL-3.0-or-later
"""Spray of an ocean in Blender: a child of it whose vertices are the particles, which nodes make points of.

It is recomputed in every whole frame and not saved, unless nodes read it from the files of a bake. Of a sea
of patches it is around the camera; of one that repeats, each particle is in the repeat that is nearest to it.
"""

from __future__ import annotations

import contextlib
import dataclasses
import functools
import math
import threading
from collections.abc import Hashable
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import Ocean, OceanParameters
from ..core.data import formats
from ..core.data.errors import ParameterError
from ..core.data.frames import held_frame
from ..core.data.plain_data import from_plain, to_plain
from ..core.data.printable import without_exponent
from ..core.numerics.memo import MEMO
from ..core.parameters.patch_seas import open_sea
from ..core.parameters.spray import Spray
from ..core.sea.foam_levels import FoamLevels
from ..core.sea.placed_waves import is_seen_around, repeating
from ..core.sea.spray import CameraSpray, TileSpray, squares, why_none
from ..core.spray.columns import COLUMNS, columns
from ..core.spray.particles import Particles
from ..export.frame_files import SPRAY as SPRAY_FILES
from ..export.frame_files import files_start
from ..export.ply import told_by_ply
from ..export.spray import spray_files
from ..nodes.modifier_inputs import set_inputs
from ..nodes.shading import Shading
from ..nodes.shown_frame import frame_values
from ..nodes.spray import FILES, SPRAY
from ..nodes.spray_look import SPRAY_LOOK
from ..nodes.versioned import is_of_kind, lay_out, node_group
from . import failures, held_sea, water_material
from .image_sequence import baked_stretch, shown_frame
from .ownership import remove_with_meshes
from .patch_points import files_of
from .plan import Plan, camera_place, camera_surface_of, seconds_per_file, velocity_scale
from .settings import OceanSettings, is_ocean, link_beside, settings_of
from .units import frame_rate, metres_per_unit, time_stretch

_MARK = "ocean_tweak_spray"
#: custom property of the ocean that keeps its spray's material: the object itself is not saved
_MATERIAL = "ocean_tweak_spray_material"
_NAME = "Ocean Tweak Spray"
_KIND = "spray"
#: of all particles, those that a window shows, as much larger
_IN_WINDOW = 0.125
#: layers of mist that light goes through in Cycles
TRANSPARENT_BOUNCES = 64
#: frames that there are: those of live spray have no files
_MOST = 1_048_574
#: s after the spray that was made last, within which the next one is quickly made
_IS_NEAR = Fraction(1)

Place = tuple[float, float]


@dataclass(frozen=True)
class _Held:
    """What a mesh holds, and the frame for which it was asked."""

    content: Hashable
    frame: Fraction


# what the meshes hold, by their session uid
_shown: dict[int, _Held] = {}


class _Maker:
    """Spray of a sea, and of which time and where it was made last."""

    def __init__(self, sea: OceanParameters, is_around: bool) -> None:
        self._levels = FoamLevels(sea) if is_around else None
        self._source = TileSpray(Ocean(sea)) if self._levels is None else CameraSpray(self._levels)
        self._last: tuple[Fraction, Place] | None = None
        self._busy = threading.Lock()

    @property
    def nbytes(self) -> int:
        """Bytes of the crests that are remembered."""
        return self._source.nbytes

    def at(self, time: Fraction, spray: Spray, place: Place) -> Particles:
        """All that is in the air at a time. It may be called on any thread."""
        with self._busy:
            if isinstance(self._source, TileSpray):
                made = self._source.at(time, spray)
            else:
                made = self._source.at(time, spray, place)
            self._last = time, place
        return made

    def is_near(self, time: Fraction, place: Place) -> bool:
        """Whether the spray of a time around a place is quickly made: nobody is making any now, and what was
        made last is a little older, in the same squares of cells."""
        if self._last is None or self._busy.locked():
            return False
        last, there = self._last
        is_there = self._levels is None or squares(self._levels, place) == squares(self._levels, there)
        return is_there and 0 <= time - last <= _IS_NEAR


@dataclass(frozen=True)
class Wanted:
    """Spray that is wanted of an ocean at a time in s, that of a whole frame.

    sea : whose crests break
    place : x and y of the camera, in the ocean's space, m
    is_around : whether it is made around the camera, and not on the sea's own tile
    repeats : of the tile along x and y; 0 where it goes on to the horizon
    """

    sea: OceanParameters
    time: Fraction
    spray: Spray
    place: Place
    is_around: bool
    repeats: tuple[int, int]

    @property
    def is_near(self) -> bool:
        """Whether it is quickly made."""
        maker = MEMO.find(_KIND, (self.sea, self.is_around))
        return maker is not None and maker.is_near(self.time, self.place)

    def make(self) -> Particles:
        """Make it; touches no data of Blender and may run on any thread."""
        key = self.sea, self.is_around
        maker = MEMO.get(_KIND, key, lambda: _Maker(*key))
        made = maker.at(self.time, self.spray, self.place)
        MEMO.put(_KIND, key, maker)  # it has grown
        return made


def wanted(
    ocean: bpy.types.Object, plan: Plan, scene: bpy.types.Scene, is_rendered: bool = False
) -> Wanted | None:
    """The spray that an ocean wants; None where there is none.

    is_rendered : whether all particles are wanted, which without a window always are
    """
    spray, share = plan.whole.spray, 1.0 if is_rendered or bpy.app.background else _IN_WINDOW
    if spray is None or why_none(plan.whole) is not None or spray.amount == 0.0:
        return None
    shown = dataclasses.replace(spray, amount=spray.amount * share, size=min(spray.size / share**0.5, 1.0))
    surface = camera_surface_of(ocean)
    is_around = surface is not None and is_seen_around(plan.whole)
    # a tile has no waves that do not repeat
    sea = open_sea(plan.whole) if is_around else repeating(plan.parameters)
    goes_on = surface is not None or any(water_material.is_far(child) for child in ocean.children)
    repeats = (0, 0) if goes_on else plan.render.repeats
    return Wanted(sea, _time(plan, scene), shown, _place(ocean, surface, plan, scene), is_around, repeats)


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
    baked = _baked(settings_of(ocean))
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
    values = columns(asked.make())
    if not asked.is_around:
        _put_near(values, asked)
    _write(item.data, values, plan)
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


def spray_arguments(ocean: bpy.types.Object, scene: bpy.types.Scene) -> list[str]:
    """What the command `bake` is told of an ocean's spray."""
    parameters = repeating(settings_of(ocean).to_parameters(scene))
    if parameters.spray is None or why_none(parameters) is not None:
        return []
    place = bake_place(ocean, scene)
    return ["--spray", *(() if place is None else ("--spray-place", *map(without_exponent, place)))]


def spray_numbers(ocean: bpy.types.Object, scene: bpy.types.Scene) -> list[str]:
    """What a command is told of them besides, that takes the sea from a bake."""
    if not spray_arguments(ocean, scene):
        return []
    numbers = to_plain(settings_of(ocean).to_parameters(scene).spray)
    return [f"--set=spray.{name}={value}" for name, value in numbers.items()]


def bake_place(ocean: bpy.types.Object, scene: bpy.types.Scene) -> Place | None:
    """Where the camera is now around which an ocean of patches is shown, m; None for another ocean.

    A bake is without what does not repeat: one of a single patch has its spray on its tile.
    """
    surface = camera_surface_of(ocean)
    if surface is None or not len(settings_of(ocean).patches):
        return None
    return camera_place(surface, scene, float(1 / metres_per_unit(scene)))


def remove(ocean: bpy.types.Object) -> None:
    """Take an ocean's spray away."""
    remove_with_meshes(child for child in ocean.children if is_ours(child))


def remove_left() -> None:
    """Take away that of deleted oceans: nobody can choose it."""
    remove_with_meshes(item for item in bpy.data.objects if is_ours(item) and not is_ocean(item.parent))


def forget_all() -> None:
    """Take no mesh for filled: a file was opened, or a step undone."""
    _shown.clear()


def _time(plan: Plan, scene: bpy.types.Scene) -> Fraction:
    """The ocean's time at the whole frame that is nearest: from there the nodes move spray."""
    since = plan.frame - math.floor(plan.frame + Fraction(1, 2))
    return plan.time - Fraction(plan.rate) * since / frame_rate(scene)


def _place(
    ocean: bpy.types.Object, surface: bpy.types.Object | None, plan: Plan, scene: bpy.types.Scene
) -> Place:
    if surface is not None:
        return camera_place(surface, scene, plan.scale)
    if scene.camera is None:
        return 0.0, 0.0
    x, y, _ = ocean.matrix_world.inverted_safe() @ scene.camera.matrix_world.translation
    return x / plan.scale, y / plan.scale


def _put_near(values: NDArray[np.float32], asked: Wanted) -> None:
    """Put each particle where it is nearest to the camera, of all places where the tile is shown."""
    side = asked.sea.domain_size
    for axis, (camera, repeats) in enumerate(zip(asked.place, asked.repeats, strict=True)):
        number = np.rint((camera - values[:, axis]) / side)
        if repeats:
            number = np.clip(number, 0, repeats - 1)
        values[:, axis] += side * number


def _new(ocean: bpy.types.Object) -> bpy.types.Object:
    name = f"{ocean.name} Spray"
    item = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    item[_MARK] = ""
    item.parent = ocean
    item.hide_select = True
    link_beside(item, ocean)
    item.modifiers.new(_NAME, "NODES").node_group = node_group(SPRAY)
    held_sea.keep_out(item, True)
    return item


def _tell_nodes(
    ocean: bpy.types.Object,
    item: bpy.types.Object,
    spray: Spray,
    baked: _Baked | None,
    plan: Plan,
    scene: bpy.types.Scene,
) -> None:
    modifier = next(each for each in item.modifiers if is_of_kind(each.node_group, SPRAY))
    settings = settings_of(ocean)
    inputs: dict[str, object] = {"Material": _material(ocean), "Life": spray.life}
    if baked is None:
        # a file a frame of the scene, whatever its stretch of time
        files, seconds = float(time_stretch(scene)), float(1 / frame_rate(scene))
        inputs |= {FILES: "", "Scale": 1.0, "Velocity Scale": 1.0, "Viewport Share": 1.0}
        inputs |= frame_values((-_MOST, _MOST), files, seconds) | {"Baked Frames": ""}
    else:
        inputs |= {
            FILES: baked.start, "Scale": plan.scale, "Velocity Scale": velocity_scale(settings, plan, scene),
            "Life": baked.spray.life, "Viewport Share": _IN_WINDOW,
            **frame_values(
                baked.frames, float(baked_stretch(settings)), seconds_per_file(settings, scene)
            ),
        }  # fmt: skip
    set_inputs(modifier, inputs)


@dataclass(frozen=True)
class _Baked:
    """Spray that files have.

    start : of the files' paths, up to the frame
    frames : that have one, ascending
    spray : what they were made from; the usual where they do not tell
    is_older : whether an older version made them
    """

    start: str
    frames: tuple[int, ...]
    spray: Spray
    is_older: bool


def _baked(settings: OceanSettings) -> _Baked | None:
    """The spray of the bake that an ocean reads; None where it is live, or the bake has none."""
    found = files_of(settings)
    if found is None:
        return None
    stored, name, here = found
    folder = here / SPRAY_FILES
    try:
        changed = folder.stat().st_mtime_ns
    except OSError:
        return None
    return _baked_in(folder, name, stored, changed)


@functools.lru_cache(maxsize=64)
def _baked_in(folder: Path, name: str, stored: str, _changed: int) -> _Baked | None:
    """The spray in a folder, which is read anew when it has changed."""
    start, files = files_start(name, SPRAY_FILES), spray_files(folder.parent, name)
    if not files:
        return None
    told = told_by_ply(files[min(files)], (COLUMNS,)) or {}
    spray = Spray()
    with contextlib.suppress(ParameterError):
        spray = from_plain(Spray, told.get("spray", {}))
    is_older = told.get("version", formats.SPRAY) != formats.SPRAY
    return _Baked(f"{stored}{SPRAY_FILES}/{start}", tuple(files), spray, is_older)


def is_live(ocean: bpy.types.Object) -> bool:
    """Whether an ocean has spray that no files show."""
    return spray_of(ocean) is not None and _baked(settings_of(ocean)) is None


def note_files(ocean: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Let the console hear that the present frame has no file of spray, so that that of another is shown, or
    that files are of an older bake."""
    settings = settings_of(ocean)
    baked = None if spray_of(ocean) is None else _baked(settings)
    if baked is None:
        return
    if (text := _differs(baked, settings.to_parameters(scene).spray)) is not None:
        failures.warned(ocean, "spray bake", f"{text}: bake it again to see yours")
    frame = shown_frame(settings, scene, scene.frame_current)
    if frame not in baked.frames:
        held = held_frame(baked.frames, frame)
        failures.warned(
            ocean, "spray files",
            f"{Path(baked.start).name}{frame:04}.ply is missing, and the spray of frame {held} is shown: "
            "bake it again with spray",
        )  # fmt: skip


def _differs(baked: _Baked, own: Spray | None) -> str | None:
    """How baked spray is another one than the settings say; None where it is that."""
    if baked.is_older:
        return "its spray was baked by another version"
    if own is None or baked.spray == own:
        return None
    was, now = to_plain(baked.spray), to_plain(own)
    name = next(name for name in was if was[name] != now[name])
    return f"its spray was baked with a {name} of {was[name]:g}, and the settings have {now[name]:g}"


def _material(ocean: bpy.types.Object) -> bpy.types.Material:
    """That of an ocean's spray; made where it has none, in the air of its water."""
    material = ocean.get(_MATERIAL)
    if isinstance(material, bpy.types.Material):
        return material
    material = bpy.data.materials.new(_NAME)
    if material.node_tree is None:  # a material has nodes from the start since Blender 5.0
        material.use_nodes = True
    shade = Shading(material.node_tree)
    look = shade.node("ShaderNodeGroup", node_tree=node_group(SPRAY_LOOK))
    shade.tree.links.new(look.outputs["Surface"], shade.node("ShaderNodeOutputMaterial").inputs["Surface"])
    lay_out(shade.tree)
    water = water_material.water_node(ocean.active_material)
    if water is not None and "Visibility" in water.inputs:
        look.inputs["Visibility"].default_value = water.inputs["Visibility"].default_value
    ocean[_MATERIAL] = material
    return material


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
