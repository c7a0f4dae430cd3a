# SPDX-License-Identifier: GPL-3.0-or-later
"""The interface of this layer to an ocean object's settings.

The settings themselves are the property group `object.ocean_tweak`, which the layer above registers:
it owns labels, ranges and units; here only this interface is known.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Protocol

import bpy

from ..core import OceanParameters, PathSample
from ..core.synthesis.channels import CHANNELS, MAPS
from ..nodes.names import MAP_INPUTS
from .modifiers import Textures, is_moved

if TYPE_CHECKING:  # it reads the settings' paths itself
    from .source_images import ImageSource

METHODS = {
    "DISPLACE": (
        "Displace Modifier",
        "Displace modifiers move the mesh with images. They cannot show baked frames with gaps, "
        "frames below 0 or Time Stretching: use geometry nodes for those",
    ),
    "NODES": ("Geometry Nodes", "A geometry nodes modifier moves the mesh. The fastest method"),
}
SOURCES = {
    "LIVE": ("Live", "Compute the sea at every frame change. Needs no files, but this extension"),
    "SEQUENCE": ("Baked", "Read a baked EXR sequence. Also works where this extension is not installed"),
}

OUT_OF_RANGE = {
    "HOLD": ("Hold", "Show the last baked frame before it, or else the first"),
    "WARN": (
        "Warn",
        "Show the last baked frame before it, or else the first, with a warning here and in the modifier",
    ),
}

#: samples along each side that play smoothly
VIEWPORT_RESOLUTION = 256


class OceanObjectError(ValueError):
    """Something in the file or on disk that keeps an ocean from being shown, and the remedy."""


class MapImages(Protocol):
    """One image a map, named as in files; None where there is none."""

    disp: bpy.types.Image | None
    foam: bpy.types.Image | None
    normal: bpy.types.Image | None
    vel: bpy.types.Image | None


class UsdSettings(Protocol):
    """Settings of the USD export; for the others see export.usd.options.

    file : the asset's own layer, "" for the usual place
    use_bake : displace by the images that the ocean reads
    variants : resolutions, between commas
    """

    file: str
    form: str
    use_bake: bool
    metres_per_unit: float
    attributes: set[str]
    variants: str


class OceanSettings(Protocol):
    """The part of `object.ocean_tweak` that the scene layer reads and writes.

    placed_size : the domain's size for which the object stands where it does, in Blender units; 0 in a file
        made before there was this, and until it changes
    stays_behind : whether the object's location kept the domain's middle from staying when its size changed
    preset : title of the preset whose sea this is, "" for one of the user's own making
    uid : what tells the ocean's bakes from those of others; "" while nothing was baked
    cache_folder : where they go; "" for the usual place
    use_ocean_time, ocean_time : the waves' time in s, where it does not follow the frames
    time_scale : how fast it runs where it does
    error : why the ocean cannot be shown, "" when all is well
    missing_file : the file that the present frame of a sequence should show and that is not there, or ""
    baked_sea : JSON of the sea that the shown bake is of, at the present frame; "" where that is not known
    bake_differs : JSON of path, value there and value here of all that differs in the settings; or ""
    bake_is_elsewhere : whether the shown bake lies outside of the ocean's cache folder
    statistics : JSON of the sea's statistics, "" when there are none
    usd : how it becomes USD layers
    use_foam, use_normals, use_velocity : whether these maps are made and shown
    repeats_x, repeats_y : patches side by side
    sequence_frames : the frames that were baked, as `format_frames` writes them
    sequence_first, sequence_last : the first and the last of them, in a file made before there were others
    sequence_samples : texels along each side
    sequence_maps, early_maps : images of a bake's frames, and of those before 0
    sequence_fps : frames per second of the shot it was baked for, "24000/1001"; "" where it does not say
    sequence_stretch : its frames in a frame of the animation, of Time Stretching; "" for 1
    out_of_range : a key of OUT_OF_RANGE
    viewport_resolution : the most samples along each side in the viewport
    mesh_resolution : quads along each side of one patch; 0 for as many as there are samples
    live_maps, texture, render_maps, render_texture : what moves the mesh where its attributes do not
    """

    is_ocean: bool
    domain_size: float
    placed_size: float
    stays_behind: bool
    preset: str
    uid: str
    cache_folder: str
    use_ocean_time: bool
    ocean_time: float
    time_scale: float
    method: str
    source: str
    viewport_resolution: int
    mesh_resolution: int
    use_foam: bool
    use_normals: bool
    use_velocity: bool
    repeats_x: int
    repeats_y: int
    live_maps: MapImages
    render_maps: MapImages
    sequence_maps: MapImages
    early_maps: MapImages
    sequence_frames: str
    sequence_first: int
    sequence_last: int
    sequence_samples: int
    sequence_fps: str
    sequence_stretch: str
    out_of_range: str
    texture: bpy.types.Texture | None
    render_texture: bpy.types.Texture | None
    error: str
    missing_file: str
    baked_sea: str
    bake_differs: str
    bake_is_elsewhere: bool
    statistics: str
    usd: UsdSettings
    id_data: bpy.types.Object

    def to_parameters(self, scene: bpy.types.Scene) -> OceanParameters:
        """The sea; raises ParameterError for settings that are no sea."""

    def from_parameters(
        self, parameters: OceanParameters, scene: bpy.types.Scene, keep_places: bool = False
    ) -> None:
        """Take over a sea; the scene is not changed."""

    def source_images(self) -> set[ImageSource]:
        """The images from which waves or masks are made."""

    def mask_objects(self) -> set[bpy.types.Object]:
        """Those from which the distance of a mask is measured."""

    def wake_makers(self) -> list[tuple[int, bpy.types.Object]]:
        """The number of each layer that is the wake of an object, and that."""

    def set_wake_maker(self, number: int, item: bpy.types.Object) -> None:
        """Let a layer be the wake of an object."""

    def set_wake_path(self, number: int, path: tuple[PathSample, ...]) -> bool:
        """Give a wake a path; whether it had another one."""

    def place_masks(self) -> None:
        """Measure the distances of masks from where their objects are now."""

    def take_mask_places(self, shown: OceanSettings) -> None:
        """Measure from where an evaluation has the masks' objects.

        shown : these settings as evaluated
        """

    def let_mask_follow(self, path: str, item: bpy.types.Object) -> None:
        """Put an object where the distance of a mask, by its path in the parameters, is measured from, and
        measure it from that.
        """

    def painted_meshes(self) -> set[bpy.types.Object]:
        """Those whose weights masks have read."""

    def read_masks(self, scene: bpy.types.Scene) -> None:
        """Read these weights again. Raises OceanObjectError where that cannot be."""

    def blender_values(self, path: str, values: Sequence[float], scene: bpy.types.Scene) -> list[float]:
        """Values of a parameter that can be animated, by its path, in the units of its property."""

    def quiet(self) -> AbstractContextManager[None]:
        """While this is open, a changed property refreshes nothing."""


def settings_of(item: bpy.types.Object) -> OceanSettings:
    """The ocean settings of an object. Raises RuntimeError when the extension is not enabled."""
    try:
        return item.ocean_tweak
    except AttributeError:
        raise RuntimeError("Ocean Tweak is not enabled: call registration.register() first") from None


def scene_of(item: bpy.types.Object) -> bpy.types.Scene:
    """The scene whose units and frame an object has: the context's, unless it is in other ones only."""
    scene, scenes = bpy.context.scene, item.users_scene
    return scene if scene in scenes or not scenes else scenes[0]


def link_beside(item: bpy.types.Object, ocean: bpy.types.Object) -> None:
    """Put an object where an ocean is: into its collections, or into its scene where they take in nothing."""
    own = [each for each in ocean.users_collection if _takes_in(each)]
    for collection in own or [scene_of(ocean).collection]:
        collection.objects.link(item)


def stay_beside(item: bpy.types.Object, ocean: bpy.types.Object) -> None:
    """Let an object be in each scene that an ocean is in, and in no other; where in it, users choose."""
    wanted, present = ocean.users_scene, item.users_scene
    for scene in wanted:
        if scene not in present:
            of_scene = {scene.collection, *scene.collection.children_recursive}
            own = [each for each in ocean.users_collection if each in of_scene and _takes_in(each)]
            for collection in own or [scene.collection]:
                collection.objects.link(item)
    for scene in present if wanted else ():
        if scene not in wanted:
            of_scene = {scene.collection, *scene.collection.children_recursive}
            for collection in [
                each for each in item.users_collection if each in of_scene and _takes_in(each)
            ]:
                collection.objects.unlink(item)


def _takes_in(collection: bpy.types.Collection) -> bool:
    return collection.is_editable and collection.override_library is None


def is_ocean(item: bpy.types.Object | None) -> bool:
    """Whether an object was made as an ocean and still has the modifier that moves it.

    If it was applied or removed, or the object was converted, it is an ordinary mesh.
    """
    if not was_ocean(item):
        return False
    settings = settings_of(item)
    return is_moved(item, Textures(settings.texture, settings.render_texture))


def was_ocean(item: bpy.types.Object | None) -> bool:
    """Whether an object was made as an ocean, whatever became of it."""
    return item is not None and item.type == "MESH" and settings_of(item).is_ocean


def oceans_in(scene: bpy.types.Scene) -> Iterator[bpy.types.Object]:
    """Each ocean of a scene once: its own objects, instanced collections and background scenes."""
    return filter(is_ocean, once_oceans_in(scene))


def once_oceans_in(scene: bpy.types.Scene) -> Iterator[bpy.types.Object]:
    """As `oceans_in`, whatever became of them."""
    seen: set[bpy.types.Object] = set()
    waiting: list[bpy.types.Object] = []
    background: bpy.types.Scene | None = scene
    scenes = set()
    while background is not None and background not in scenes:
        scenes.add(background)
        waiting += background.objects
        background = background.background_set
    while waiting:
        item = waiting.pop()
        if item in seen:
            continue
        seen.add(item)
        if item.instance_collection is not None:
            waiting += item.instance_collection.all_objects
        if was_ocean(item):
            yield item


def shown_oceans() -> dict[bpy.types.Object, bpy.types.Scene]:
    """The oceans that a scene has, each with its scene: the context's where they are in that."""
    found: dict[bpy.types.Object, bpy.types.Scene] = {}
    for scene in (bpy.context.scene, *bpy.data.scenes):
        for item in oceans_in(scene):
            found.setdefault(item, scene)
    return found


def all_oceans() -> Iterator[bpy.types.Object]:
    """Every ocean of the file."""
    return (item for item in bpy.data.objects if is_ocean(item))


def wanted_channels(settings: OceanSettings) -> frozenset[str]:
    """The channels that an ocean's switches ask for, each an attribute of its mesh."""
    return frozenset(
        name
        for name, channel in CHANNELS.items()
        if channel.switch is not None and (not channel.switch or getattr(settings, channel.switch))
    )


def maps_of(channels: Collection[str]) -> tuple[str, ...]:
    """The maps among those that Blender reads of which all channels are wanted."""
    return tuple(name for name in MAP_INPUTS if all(channel in channels for channel in MAPS[name]))
