# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything around an ocean for a picture: horizon, sky, sun, camera, render settings.

What a scene already has is kept, unless the caller says otherwise. Unchanged objects of Blender's start-up
file are removed.
"""

from __future__ import annotations

import contextlib
import math
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import Ocean, OceanParameters, Timing
from ..nodes import detail_image
from ..nodes.horizon import HORIZON
from ..nodes.modifier_inputs import set_input
from ..nodes.versioned import node_group
from . import middle, ocean_object, scene_sky, startup_file, water_material
from .afloat import add_afloat, own_afloat
from .camera_surface import add_camera_surface, remove_camera_surface
from .clear_water import clear_place
from .floating import sink
from .moods import MOODS, VIEW, Mood
from .settings import VIEWPORT_RESOLUTION, OceanObjectError, settings_of
from .spray import TRANSPARENT_BOUNCES
from .units import frame_rate, metres_per_unit
from .view_layers import evaluated

#: how far beside the middle of the picture the highest wave may be, rad
_ASIDE = math.radians(4.0)
#: a camera that is lower, m, rides the waves as a boat does, with a key in so many frames
_BOAT, _KEY_FRAMES = 10.0, 12
#: samples of the sea that it feels
_FELT = 256
_FAR = 30e3  # m, beyond the horizon of any camera on a ship
_FRAMES = 240
_SAMPLES = 32  # of Cycles, whose denoiser does the rest: a storm's first picture in minutes, not in hours
_EEVEE_RINGS = 2  # it draws every copy anew
_WORLD_GREY = 0.0508761  # of a new file's world
#: custom property of cameras that ocean scenes bring
_OURS = "ocean_tweak_camera"


@dataclass(frozen=True)
class Wishes:
    """What may be changed in a scene that has it already.

    engine : "CYCLES" or "EEVEE"
    camera, world : whether the scene gets new ones where it has its own
    afloat : whether something floats before the camera
    """

    engine: str = "CYCLES"
    camera: bool = False
    world: bool = False
    afloat: bool = True


@dataclass(frozen=True)
class Made:
    """What a scene got.

    kept : what it had and kept besides its camera, in words
    replaced : names of the start-up file's objects, which are gone
    """

    ocean: bpy.types.Object
    camera: bpy.types.Object
    kept: tuple[str, ...]
    replaced: tuple[str, ...]


def build(
    scene: bpy.types.Scene, mood: str, wishes: Wishes, collection: bpy.types.Collection | None = None
) -> Made:
    """Make the sea of a mood, with all that makes a picture of it; the scene's 3D cursor is in the picture.

    Raises ValueError for an unknown mood, and what `ocean_object.add` raises; then nothing is made.
    """
    chosen, target = _mood(mood), collection or scene.collection
    # while the sea is made, and Blender's own data, for which there is one thread alone
    detail_image.make_ahead()
    left = startup_file.untouched_objects(scene)
    is_empty = len(left) == len(scene.objects)
    parameters = _sea(chosen, scene)
    ocean = ocean_object.add(
        scene, parameters.replace(spray=None), collection=target, viewport_resolution=VIEWPORT_RESOLUTION
    )
    replaced = tuple(item.name for item in left)
    startup_file.remove(left)
    camera, place = _compose(ocean, chosen, parameters, scene, target, wishes.engine)
    if wishes.camera or scene.camera is None:
        scene.camera = camera
    kept = set_up(scene, chosen, wishes, target, is_empty)
    _finish(ocean, chosen, parameters, scene)
    if wishes.afloat:
        add_afloat(chosen.floats, place, camera, parameters, ocean, scene, target)
    return Made(ocean, camera, kept, replaced)


def change(ocean: bpy.types.Object, mood: str, scene: bpy.types.Scene) -> None:
    """Give an ocean the sea of another mood, and its scene that mood's sky and camera.

    The scene's camera is moved where an ocean scene brought it; one of the artist's own makes room for a new
    one, and is kept. What an ocean scene let float makes room for the new mood's.

    Raises ValueError for an unknown mood, OceanObjectError for an ocean that shows a bake or is overridden;
    then nothing is changed.
    """
    chosen, target = _mood(mood), ocean.users_collection[0] if ocean.users_collection else scene.collection
    settings = settings_of(ocean)
    if settings.source != "LIVE":
        raise OceanObjectError(f"{ocean.name} shows a bake, which keeps its sea: switch it to Live first")
    parameters = _sea(chosen, scene)
    settings.from_parameters(parameters.replace(spray=None), scene)
    remove_camera_surface(ocean)
    for child in [child for child in ocean.children if water_material.is_far(child)]:
        _remove(child)
    was_afloat = own_afloat(ocean, scene)
    for item in was_afloat:
        sink(item)
        _remove(item)
    ocean.rotation_euler = (0.0, 0.0, 0.0)  # as the camera is placed
    own = scene.camera if scene.camera is not None and _OURS in scene.camera else None
    scene.camera, place = _compose(ocean, chosen, parameters, scene, target, _engine(scene), own)
    scene_sky.put(scene, chosen.sky, VIEW, f"{chosen.label} Sky", target)
    _finish(ocean, chosen, parameters, scene)
    if was_afloat:
        add_afloat(chosen.floats, place, scene.camera, parameters, ocean, scene, target)


def _mood(key: str) -> Mood:
    if key not in MOODS:
        raise ValueError(f"mood = {key!r}: must be one of {', '.join(MOODS)}")
    return MOODS[key]


def _sea(mood: Mood, scene: bpy.types.Scene) -> OceanParameters:
    parameters = mood.sea(Timing(fps=frame_rate(scene), start_frame=scene.frame_start))
    return parameters.on_one_grid(parameters.resolution)  # as an ocean object shows patches


def _compose(
    ocean: bpy.types.Object,
    mood: Mood,
    parameters: OceanParameters,
    scene: bpy.types.Scene,
    collection: bpy.types.Collection,
    engine: str,
    camera: bpy.types.Object | None = None,
) -> tuple[bpy.types.Object, NDArray[np.float64]]:
    """Stand an ocean where the cursor is in the picture, with its water, its horizon and a camera.

    camera : one that is moved; by default a new one

    Returns the camera and its place in the patch, m.
    """
    place, metres = camera_place(mood, parameters), float(metres_per_unit(scene))
    x, y = clear_place(mood, place, parameters)
    middle.put(ocean, scene.cursor.location, (x / metres, y / metres))
    material = water_material.water_material(mood.water)
    water_material.set_air(material, mood.sky.visibility, mood.sky.haze(VIEW))
    water_material.assign(ocean, material)
    water_material.describe(ocean, parameters, scene)
    if mood.rings:
        rings = mood.rings if engine == "CYCLES" else min(mood.rings, _EEVEE_RINGS)
        add_horizon(ocean, parameters, scene, collection, rings)
    if camera is None:
        camera = new_camera(mood, place, ocean, scene)
        collection.objects.link(camera)
    else:
        camera.animation_data_clear()
        _place_camera(camera, mood, place, ocean, scene, VIEW)
    if mood.eye < _BOAT:
        ride(camera, place, parameters, scene)
    return camera, place


def _finish(ocean: bpy.types.Object, mood: Mood, parameters: OceanParameters, scene: bpy.types.Scene) -> None:
    """Show an ocean around its camera, if that is the mood's way, and its spray."""
    if not mood.rings:
        add_camera_surface(ocean, scene, budget=mood.vertices)
    if parameters.spray is not None:  # of patches it is around the camera, once these are seen from there
        _add_spray(ocean, parameters, scene)


def _remove(item: bpy.types.Object) -> None:
    """Delete an object, and its mesh where nothing else uses it."""
    mesh = item.data
    bpy.data.objects.remove(item)
    if mesh.users == 0:
        bpy.data.meshes.remove(mesh)


def _add_spray(ocean: bpy.types.Object, parameters: OceanParameters, scene: bpy.types.Scene) -> None:
    """Let a sea have its spray, and Cycles let light through all of its mist."""
    bounces = scene.cycles.transparent_max_bounces
    scene.cycles.transparent_max_bounces = max(bounces, TRANSPARENT_BOUNCES)
    evaluated(scene)  # or the camera is at the world's origin still
    settings_of(ocean).from_parameters(parameters, scene)


def add_horizon(
    ocean: bpy.types.Object,
    parameters: OceanParameters,
    scene: bpy.types.Scene,
    collection: bpy.types.Collection,
    rings: int,
) -> bpy.types.Object:
    """Carry an ocean on to the horizon; a window shows one ring of the copies where they are cheap.

    rings : of copies around the ocean
    """
    name = f"{ocean.name} Horizon"
    horizon = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    horizon.parent = ocean
    horizon.hide_select = True
    collection.objects.link(horizon)
    water_material.describe_far(horizon, parameters, scene)
    modifier = horizon.modifiers.new(name, "NODES")
    modifier.node_group = node_group(HORIZON)
    for key, value in (
        ("Ocean", ocean),
        ("Rings", rings),
        ("Viewport Rings", int(settings_of(ocean).viewport_resolution <= VIEWPORT_RESOLUTION)),
        ("Far Distance", _FAR / float(metres_per_unit(scene))),
        ("Material", ocean.material_slots[0].material if ocean.material_slots else None),
    ):
        set_input(modifier, key, value)
    return horizon


def camera_place(mood: Mood, parameters: OceanParameters, view: float = VIEW) -> NDArray[np.float64]:
    """Where a camera sees the highest wave of the first frame best: x, y and z in m, in the patch.

    Of the places around the mood's distance from it, the one from which it rises most above the water before
    it: in a trough, with no other wave in between.

    view : where the camera looks, rad counter-clockwise from +x
    """
    sea, time = Ocean(parameters), parameters.timing.time(parameters.timing.start_frame)
    displacement = sea.surface(time).displacement
    row, column = divmod(int(displacement[..., 2].argmax()), len(displacement))
    spacing = parameters.domain_size / len(displacement)
    crest = spacing * np.array([column, row, 0.0]) + displacement[row, column]
    forward = np.array([math.cos(view), math.sin(view)])
    usual = mood.crest_distance * sea.statistics().seed.significant_wave_height
    distance, aside = np.meshgrid(
        usual * np.linspace(0.7, 1.3, 31), np.tan(_ASIDE) * np.linspace(-1.0, 1.0, 9)
    )
    back = np.stack([distance, distance * aside], axis=-1).reshape(-1, 2)
    places = crest[:2] - back @ np.array([forward, [forward[1], -forward[0]]])
    eyes = sea.height_at(*places.T, time) + mood.eye
    way = np.linspace(0.05, 0.9, 48)[:, np.newaxis, np.newaxis]
    between = places + way * (crest[:2] - places)
    far = np.hypot(*back.T)
    before = (sea.height_at(between[..., 0], between[..., 1], time) - eyes) / (way[..., 0] * far)
    rise = (crest[2] - eyes) / far - np.maximum(before.max(axis=0), -mood.eye / far)
    best = int(rise.argmax())
    return np.array([*(places[best] % parameters.domain_size), eyes[best]])


def new_camera(
    mood: Mood,
    place: NDArray[np.float64],
    ocean: bpy.types.Object,
    scene: bpy.types.Scene,
    view: float = VIEW,
) -> bpy.types.Object:
    """A camera at a place in the patch, in m, that looks along `view`; in no collection yet."""
    camera = bpy.data.objects.new("Ocean Camera", bpy.data.cameras.new("Ocean Camera"))
    camera[_OURS] = True
    _place_camera(camera, mood, place, ocean, scene, view)
    return camera


def _place_camera(
    camera: bpy.types.Object,
    mood: Mood,
    place: NDArray[np.float64],
    ocean: bpy.types.Object,
    scene: bpy.types.Scene,
    view: float,
) -> None:
    metres, data = float(metres_per_unit(scene)), camera.data
    data.lens = mood.lens
    data.clip_start, data.clip_end = 0.1 / metres, 2.0 * _FAR / metres
    camera.location = np.array(ocean.location) + place / metres
    camera.rotation_euler = (0.5 * math.pi - mood.tilt, 0.0, view - 0.5 * math.pi)


def ride(
    camera: bpy.types.Object,
    place: NDArray[np.float64],
    parameters: OceanParameters,
    scene: bpy.types.Scene,
) -> None:
    """Key a camera's height over the first frames, so that long waves lift it and none goes over it."""
    metres, first = float(metres_per_unit(scene)), scene.frame_start
    sea = Ocean(parameters.at_resolution(min(_FELT, parameters.resolution)))
    frames = range(first, first + _FRAMES + _KEY_FRAMES, _KEY_FRAMES)
    heights = [float(sea.height_at(*place[:2], parameters.timing.time(frame))) for frame in frames]
    at_first = camera.location.z
    for frame, height in zip(frames, heights, strict=True):
        camera.location.z = at_first + (height - heights[0]) / metres
        camera.keyframe_insert("location", index=2, frame=frame)
    camera.location.z = at_first


def set_up(
    scene: bpy.types.Scene,
    mood: Mood,
    wishes: Wishes,
    collection: bpy.types.Collection,
    is_empty: bool,
    view: float = VIEW,
) -> tuple[str, ...]:
    """Sky and settings, where the scene has none or they are wished for; says what was kept."""
    kept = []
    if wishes.world or is_plain(scene.world):
        scene_sky.settings_of(scene).use_exposure = is_empty
        scene_sky.put(scene, mood.sky.turned(view - VIEW), view, f"{mood.label} Sky", collection)
    else:
        kept.append(f"world {scene.world.name}")
    set_engine(scene, wishes.engine)
    scene.render.use_motion_blur = True
    if is_empty:
        scene.frame_end = scene.frame_start + _FRAMES - 1
        scene.cycles.samples = _SAMPLES
        with contextlib.suppress(TypeError):  # a studio's OCIO configuration may lack these
            scene.view_settings.view_transform = "AgX"
            scene.view_settings.look = "AgX - Medium High Contrast"
    else:
        kept.append("frame range, samples and color management")
    return tuple(kept)


def is_plain(world: bpy.types.World | None) -> bool:
    """Whether there is no world, or only the grey one of a new file."""
    if world is None:
        return True
    if world.library is not None or world.node_tree is None:
        return False
    backgrounds = [node for node in world.node_tree.nodes if node.type == "BACKGROUND"]
    if len(world.node_tree.nodes) != 2 or len(backgrounds) != 1:
        return False
    colour, strength = (backgrounds[0].inputs[name].default_value for name in ("Color", "Strength"))
    return strength == 1.0 and all(abs(part - _WORLD_GREY) < 1e-4 for part in colour[:3])


def _engine(scene: bpy.types.Scene) -> str:
    return "EEVEE" if "EEVEE" in scene.render.engine else "CYCLES"


def set_engine(scene: bpy.types.Scene, engine: str) -> None:
    """Choose "CYCLES" or "EEVEE", by the name that this Blender has for it."""
    names = {"CYCLES": ("CYCLES",), "EEVEE": ("BLENDER_EEVEE", "BLENDER_EEVEE_NEXT")}[engine]
    for name in names:
        try:
            scene.render.engine = name
        except TypeError:  # the name of another version
            continue
        break
    if engine == "EEVEE":
        scene.eevee.use_raytracing = True
