# SPDX-License-Identifier: GPL-3.0-or-later
"""The layers of an ocean as properties: waves by a spectrum, of a wind field, out of a picture, by hand.

They stand in one list, wave layers first, so that the number of a wave layer is its number in the parameters
and in the paths of keys.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any, NamedTuple

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    PointerProperty,
    StringProperty,
)

from ..core import (
    HeroWave,
    OceanParameters,
    ParameterError,
    PictureLayer,
    WaveLayer,
    WindFieldLayer,
    WindKey,
)
from ..core.plain_data import to_plain
from ..core.raster import Raster
from ..scene import source_images, wind_recording
from ..scene.settings import LAYER_KINDS, scene_of
from ..scene.source_images import ImageSource
from ..scene.units import metres_per_unit, shortest_decimal
from . import mask_properties, parameter_properties
from .mask_properties import OCEAN_PG_mask, channels_property
from .parameter_properties import changed

_OVERRIDE = {"override": {"LIBRARY_OVERRIDABLE"}}
_SHOWN = {"options": set(), "update": changed, **_OVERRIDE}
_HIDDEN = {"options": {"HIDDEN"}, **_OVERRIDE}

SOURCES = {
    "UNIFORM": ("Uniform", "The same wind everywhere"),
    "IMAGE": ("Image", "Red and green of an image are the wind along x and along y"),
    "RECORDING": ("Recording", "What Record Wind took from force fields, or keys that came with a file"),
}


def _metres(layer: bpy.types.PropertyGroup) -> float:
    """Metres in a Blender unit of the layer's scene."""
    return float(metres_per_unit(scene_of(layer.id_data)))


def _fetch_in_km(layer: bpy.types.PropertyGroup) -> float:
    return layer.fetch * _metres(layer) / 1000.0


def _set_fetch_in_km(layer: bpy.types.PropertyGroup, value: float) -> None:
    layer.fetch = value * 1000.0 / _metres(layer)


class OCEAN_PG_wind_field(bpy.types.PropertyGroup):
    """Waves that follow a wind field, and where its wind comes from.

    recording : keys as JSON; recording_hash : what tells them from others
    """

    __annotations__ = {
        **parameter_properties.annotations(WindFieldLayer, changed),
        "source": EnumProperty(
            name="Source", default="UNIFORM", **_SHOWN,
            items=[(key, *texts) for key, texts in SOURCES.items()],
            description="Where the wind comes from",
        ),
        "image": PointerProperty(
            name="Image", type=bpy.types.Image, **_SHOWN,
            description="Red and green are the wind along the ocean's x and y; it covers one patch",
        ),
        "image_channels": channels_property(),
        "image_values": EnumProperty(
            name="Numbers", default="CENTRED", **_SHOWN,
            items=[(key, *texts[:2]) for key, texts in source_images.WIND_VALUES.items()],
            description="Which number is calm",
        ),
        "image_speed": FloatProperty(
            name="Speed (m/s)", default=12.0, min=0.01, max=100.0, precision=2, step=10, **_SHOWN,
            description="Wind in m/s where a number of the image is at its end",
        ),
        "recording": StringProperty(**_HIDDEN),
        "recording_hash": StringProperty(**_HIDDEN),
        "objects": PointerProperty(
            name="Objects", type=bpy.types.Collection, options=set(), **_OVERRIDE,
            description="Collection whose force fields of the type Wind are recorded; none for all",
        ),
        "mask": PointerProperty(type=OCEAN_PG_mask, **_OVERRIDE),
        "show_vectors": BoolProperty(
            name="Show Wind", options=set(), **_OVERRIDE,
            description="Draw the wind of this frame as arrows over the patch, while the ocean is active",
        ),
    }  # fmt: skip


class OCEAN_PG_picture(bpy.types.PropertyGroup):
    """Waves out of a picture."""

    __annotations__ = {
        **parameter_properties.annotations(PictureLayer, changed),
        "image": PointerProperty(
            name="Picture", type=bpy.types.Image, **_SHOWN,
            description="Picture whose trace the waves bear; without one, white noise. "
            "It covers one patch, of a colour picture the luminance",
        ),
        "image_channels": channels_property(),
        "mask": PointerProperty(type=OCEAN_PG_mask, **_OVERRIDE),
    }  # fmt: skip


class OCEAN_PG_hero_wave(bpy.types.PropertyGroup):
    """A single group of waves."""

    __annotations__ = parameter_properties.annotations(HeroWave, changed)


class OCEAN_PG_layer(bpy.types.PropertyGroup):
    """One layer: a wave system of its own properties, or what its kind says."""

    __annotations__ = {
        **parameter_properties.annotations(WaveLayer, changed),
        "mask": PointerProperty(type=OCEAN_PG_mask, **_OVERRIDE),
        # Blender has no property that is always shown in kilometres; this is the fetch itself
        "fetch_km": FloatProperty(
            name="Fetch", min=0.0, max=20e3, soft_min=0.1, soft_max=1000.0, precision=1, step=100,
            get=_fetch_in_km, set=_set_fetch_in_km, options=set(),
            description="Distance of open water over which the wind has blown, in kilometres. "
            "Longer fetch: higher and longer waves, until the sea is fully developed",
        ),
        "kind": EnumProperty(
            name="Kind", default="WAVES", **_HIDDEN,
            items=[(key, kind.label, kind.description) for key, kind in LAYER_KINDS.items()],
        ),
        "wind_field": PointerProperty(type=OCEAN_PG_wind_field, **_OVERRIDE),
        "picture": PointerProperty(type=OCEAN_PG_picture, **_OVERRIDE),
        "hero_wave": PointerProperty(type=OCEAN_PG_hero_wave, **_OVERRIDE),
    }  # fmt: skip

    @property
    def group(self) -> bpy.types.PropertyGroup:
        """The properties that belong to the layer's kind."""
        return _GROUPS[kind_of(self)](self)


def kind_of(layer: bpy.types.PropertyGroup) -> str:
    """A key of LAYER_KINDS, whatever number is stored."""
    return layer.kind or "WAVES"


_GROUPS = {
    "WAVES": lambda layer: layer,
    "WIND_FIELD": lambda layer: layer.wind_field,
    "PICTURE": lambda layer: layer.picture,
    "HERO_WAVE": lambda layer: layer.hero_wave,
}


def read(layers: bpy.types.bpy_prop_collection, metres: Fraction) -> dict[str, list[Any]]:
    """The layers as the parameters' lists, not yet validated but for pictures and winds.

    Raises ParameterError for an image that cannot be used.
    """
    result: dict[str, list[Any]] = {kind.parameter: [] for kind in LAYER_KINDS.values()}
    for layer in layers:
        name = LAYER_KINDS[kind_of(layer)].parameter
        try:
            result[name].append(_READERS[kind_of(layer)](layer, metres))
        except ParameterError as error:
            raise error.inside(f"{name}.{len(result[name])}") from None
    return result


def images(layers: bpy.types.bpy_prop_collection) -> set[ImageSource]:
    """Those from which waves are made, or masks."""
    found = [*map(_image_source, layers), *(mask_properties.image_source(mask) for mask in masks(layers))]
    return {source for source in found if source is not None}


def masks(layers: bpy.types.bpy_prop_collection) -> list[bpy.types.PropertyGroup]:
    """Those of layers that can have one."""
    return [layer.group.mask for layer in layers if hasattr(layer.group, "mask")]


def source_image(layer: bpy.types.PropertyGroup) -> bpy.types.Image | None:
    """The image from which a layer's waves are made, if it has one."""
    return getattr(layer.group, "image", None)


def _image_source(layer: bpy.types.PropertyGroup) -> ImageSource | None:
    return None if source_image(layer) is None else source_images.source_of(layer.group)


def write(layers: bpy.types.bpy_prop_collection, parameters: OceanParameters, metres: Fraction) -> None:
    """Take over the parameters' layers; images and recordings that hold the same numbers stay."""
    known_images, known_winds = images(layers), list(_known_winds(layers))
    wanted = list(_listed(parameters))
    set_count(layers, len(wanted))
    for item, (kind, layer) in zip(layers, wanted, strict=True):
        item.kind = kind
        parameter_properties.write(item.group, type(layer), to_plain(layer, brief=True), metres)
        if hasattr(item.group, "mask"):
            mask_properties.write(item.group.mask, layer.mask, metres, known_images)
        if isinstance(layer, WindFieldLayer):
            _write_wind(item.wind_field, layer, known_winds, known_images)
        elif isinstance(layer, PictureLayer):
            if layer.picture is None:
                item.picture.image = None
            else:
                _choose_image(item.picture, layer.picture, known_images)


def kinds(parameters: OceanParameters) -> list[str]:
    """The kinds of the layers in the order in which they stand in an ocean's list."""
    return [kind for kind, _ in _listed(parameters)]


def set_recording(group: bpy.types.PropertyGroup, keys: tuple[WindKey, ...]) -> None:
    """Keep keys in a wind field's properties, and let it use them."""
    group.recording, group.recording_hash = wind_recording.to_text(keys)
    group.source = "RECORDING"


def _listed(parameters: OceanParameters) -> Iterator[tuple[str, Any]]:
    for key, kind in LAYER_KINDS.items():
        yield from ((key, layer) for layer in getattr(parameters, kind.parameter))


def set_count(layers: bpy.types.bpy_prop_collection, count: int) -> None:
    """Give a collection so many entries; those that stay are kept."""
    # layers that stay are kept: Blender neither adds to nor removes from a library override
    while len(layers) > count:
        layers.remove(len(layers) - 1)
    while len(layers) < count:
        layers.add()


def _read_waves(layer: bpy.types.PropertyGroup, metres: Fraction) -> dict[str, Any]:
    return {
        **parameter_properties.read(layer, WaveLayer, metres),
        "mask": mask_properties.read(layer.mask, metres),
    }


def _read_picture(layer: bpy.types.PropertyGroup, metres: Fraction) -> object:
    group = layer.picture
    values = parameter_properties.read(group, PictureLayer, metres)
    values["mask"] = mask_properties.read(group.mask, metres)
    source = source_images.source_of(group)
    if source is not None:
        values["picture"] = source_images.raster_of(source, 1)
    return source_images.made_layer(PictureLayer, tuple(values.items()))


def _read_wind_field(layer: bpy.types.PropertyGroup, metres: Fraction) -> object:
    group = layer.wind_field
    values = parameter_properties.read(group, WindFieldLayer, metres)
    values["keys"] = _keys(group)
    values["mask"] = mask_properties.read(group.mask, metres)
    return source_images.made_layer(WindFieldLayer, tuple(values.items()))


def _read_hero_wave(layer: bpy.types.PropertyGroup, metres: Fraction) -> dict[str, Any]:
    return parameter_properties.read(layer.hero_wave, HeroWave, metres)


_READERS = {
    "WAVES": _read_waves,
    "WIND_FIELD": _read_wind_field,
    "PICTURE": _read_picture,
    "HERO_WAVE": _read_hero_wave,
}


def _keys(group: bpy.types.PropertyGroup) -> tuple[WindKey, ...]:
    return _KEYS[group.source or "UNIFORM"](group)


def _image_keys(group: bpy.types.PropertyGroup) -> tuple[WindKey, ...]:
    source = source_images.source_of(group)
    if source is None:
        raise ParameterError("image", "", "choose an image, whose red and green are the wind along x and y")
    speed = float(shortest_decimal(group.image_speed))
    numbers = source_images.raster_of(source, 2)
    return (WindKey(vectors=source_images.wind_raster(numbers, group.image_values, speed)),)


def _recorded_keys(group: bpy.types.PropertyGroup) -> tuple[WindKey, ...]:
    if not group.recording_hash:
        raise ParameterError("recording", "", "nothing is recorded yet: press Record Wind")
    known = wind_recording.known_keys(group.recording_hash)
    return known if known is not None else wind_recording.from_text(group.recording, group.recording_hash)


_KEYS = {"UNIFORM": lambda _group: (), "IMAGE": _image_keys, "RECORDING": _recorded_keys}

#: what a wind field has besides its parameters
_BESIDES = (
    "source", "image", "image_channels", "image_values", "image_speed", "recording", "recording_hash",
    "objects", "show_vectors",
)  # fmt: skip


class _KnownWind(NamedTuple):
    """A wind field as it was: its id, the keys that it gave, None without any, and what it has besides."""

    id: int
    keys: tuple[WindKey, ...] | None
    besides: dict[str, Any]


def _known_winds(layers: bpy.types.bpy_prop_collection) -> Iterator[_KnownWind]:
    for layer in layers:
        if layer.kind != "WIND_FIELD":
            continue
        group = layer.wind_field
        try:
            keys = _keys(group)
        except ParameterError:
            keys = None
        yield _KnownWind(group.id, keys, {name: getattr(group, name) for name in _BESIDES})


def _write_wind(
    group: bpy.types.PropertyGroup,
    layer: WindFieldLayer,
    known: list[_KnownWind],
    known_images: set[ImageSource],
) -> None:
    """Let the wind come from where it came from, as far as that gives the same keys."""
    own = [wind for wind in known if wind.id == layer.id]
    same = [wind for wind in (*own, *known) if wind.keys == layer.keys]
    for name in _BESIDES:
        group.property_unset(name)
    for wind in (same or own)[:1]:
        for name, value in wind.besides.items():
            setattr(group, name, value)
    if same:
        return
    if not layer.keys:
        group.source = "UNIFORM"
    elif len(layer.keys) == 1 and layer.keys[0].time == 0.0:
        # an image can be seen and painted
        _choose_image(group, layer.rasters[0], known_images)
        group.source, group.image_values, group.image_speed = "IMAGE", "PLAIN", 1.0
    else:
        set_recording(group, layer.keys)


def _choose_image(group: bpy.types.PropertyGroup, raster: Raster, known: set[ImageSource]) -> None:
    """Let numbers come from an image of this ocean, one that the file has by their name, or a new one."""
    source = source_images.source_with(raster, known)
    known.add(source)
    source_images.choose(group, source)


CLASSES = (
    *mask_properties.CLASSES,
    OCEAN_PG_wind_field,
    OCEAN_PG_picture,
    OCEAN_PG_hero_wave,
    OCEAN_PG_layer,
)
