# SPDX-License-Identifier: GPL-3.0-or-later
"""The layers of an ocean as properties: waves by a spectrum, of a wind field, out of an image, by hand.

They stand in one list, so that the number of a layer is its number in the parameters and in the paths of
keys. The settings of a kind follow from the fields of its parameters.
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
    Equaliser,
    ImageLayer,
    OceanParameters,
    ParameterError,
    WakeLayer,
    WaveLayer,
    WindFieldLayer,
    WindKey,
)
from ..core.data.plain_data import to_plain
from ..core.data.raster import Raster
from ..core.waves.contribution import Contribution
from ..core.waves.kinds import shown
from ..scene import measured_text, source_images, wake_paths, wind_recording
from ..scene.source_images import ImageSource
from ..scene.units import shortest_decimal
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


class OCEAN_PG_equaliser(bpy.types.PropertyGroup):
    """Heights of waves by octave of their length."""

    __annotations__ = parameter_properties.annotations(Equaliser, changed)


#: properties of kinds besides those of their parameters: of a wind field where its wind comes from, with the
#: recorded keys as JSON and what tells them from others, of an image its image, of a wake its path
_OWN_PROPERTIES: dict[str, dict[str, Any]] = {
    "WIND_FIELD": {
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
            description="Pixel value that means no wind",
        ),
        "image_speed": FloatProperty(
            name="Speed (m/s)", default=12.0, min=0.01, max=100.0, precision=2, step=10, **_SHOWN,
            description="Wind in m/s at the largest pixel value",
        ),
        "recording": StringProperty(**_HIDDEN),
        "recording_hash": StringProperty(**_HIDDEN),
        "objects": PointerProperty(
            name="Objects", type=bpy.types.Collection, options=set(), **_OVERRIDE,
            description="Collection whose force fields of the type Wind are recorded; none for all",
        ),
        "show_vectors": BoolProperty(
            name="Show Wind", options=set(), **_OVERRIDE,
            description="Draw the wind at this frame as arrows over the patch while the ocean is active",
        ),
    },
    "IMAGE": {
        "image": PointerProperty(
            name="Image", type=bpy.types.Image, **_SHOWN,
            description="Image that becomes waves; without one, white noise. It covers one patch; colour "
            "images count by their luminance",
        ),
        "image_channels": channels_property(),
    },
    "WAKE": {
        "recording": StringProperty(**_HIDDEN),
        "object": PointerProperty(
            name="Object", type=bpy.types.Object, options=set(), **_OVERRIDE,
            description="What makes the waves: their path follows its keys. Without one it stays as it is",
        ),
    },
    "WAVES": {
        "spectra": StringProperty(**_HIDDEN),
        "equaliser": PointerProperty(type=OCEAN_PG_equaliser, **_OVERRIDE),
        "use_equaliser": BoolProperty(
            name="Equaliser", **_SHOWN,
            description="Change the height of the layer's waves by octave of their length",
        ),
    },
}  # fmt: skip


def _properties(kind: type[Contribution]) -> dict[str, Any]:
    """All settings of a kind: those of its parameters, what it has besides, and its mask."""
    mask = {"mask": PointerProperty(type=OCEAN_PG_mask, **_OVERRIDE)} if kind.has("mask") else {}
    own = _OWN_PROPERTIES.get(kind.kind, {})
    return {**parameter_properties.annotations(kind, changed), **own, **mask}


def _group(kind: type[Contribution]) -> type[bpy.types.PropertyGroup]:
    """The class of the settings of a kind."""
    content = {"__annotations__": _properties(kind), "__doc__": kind.__doc__, "__module__": __name__}
    return type(f"OCEAN_PG_{kind.names.settings}", (bpy.types.PropertyGroup,), content)


#: settings by kind; those of waves by a spectrum stand in the layer itself
GROUPS = {kind.kind: _group(kind) for kind in shown() if kind.names.settings}


class OCEAN_PG_layer(bpy.types.PropertyGroup):
    """One layer: a wave system of its own properties, or what its kind says."""

    __annotations__ = {
        **_properties(WaveLayer),
        "kind": EnumProperty(
            name="Kind", default=WaveLayer.kind, **_HIDDEN,
            items=[
                (kind.kind, kind.names.label, kind.names.description, kind.names.icon, kind.names.number)
                for kind in shown()
            ],
        ),
        **{
            kind.names.settings: PointerProperty(type=GROUPS[kind.kind], **_OVERRIDE)
            for kind in shown()
            if kind.kind in GROUPS
        },
    }  # fmt: skip

    @property
    def group(self) -> bpy.types.PropertyGroup:
        """The properties that belong to the layer's kind."""
        settings = kind_of(self).names.settings
        return getattr(self, settings) if settings else self


def kind_of(layer: bpy.types.PropertyGroup) -> type[Contribution]:
    """The kind of a layer, whatever number is stored."""
    return next((kind for kind in shown() if kind.kind == layer.kind), WaveLayer)


def first_waves(layers: bpy.types.bpy_prop_collection) -> bpy.types.PropertyGroup | None:
    """The first layer of waves by a spectrum."""
    return next((layer for layer in layers if kind_of(layer) is WaveLayer), None)


def read(layers: bpy.types.bpy_prop_collection, metres: Fraction) -> list[Any]:
    """The layers as the parameters have them, not yet validated but for images and winds.

    Raises ParameterError for an image that cannot be used.
    """
    result = []
    for index, layer in enumerate(layers):
        try:
            result.append(_read(layer, metres))
        except ParameterError as error:
            raise error.inside(f"layers.{index}") from None
    return result


def _read(layer: bpy.types.PropertyGroup, metres: Fraction) -> object:
    kind, group = kind_of(layer), layer.group
    values = parameter_properties.read(group, kind, metres)
    if kind.has("mask"):
        values["mask"] = mask_properties.read(group.mask, metres)
    if kind is WaveLayer:
        values["measured"] = measured_text.from_text(group.spectra)
        values["equaliser"] = read_equaliser(group, metres)
    if kind.kind not in _RASTERS:
        return {**values, "kind": kind.kind}
    values.update(_RASTERS[kind.kind](group))
    return source_images.made_layer(kind, tuple(values.items()))


def read_equaliser(group: bpy.types.PropertyGroup, metres: Fraction) -> dict[str, Any] | None:
    """That of a layer or of an ocean, not yet validated; None while it is switched off."""
    return parameter_properties.read(group.equaliser, Equaliser, metres) if group.use_equaliser else None


def write_equaliser(group: bpy.types.PropertyGroup, equaliser: Equaliser | None, metres: Fraction) -> None:
    """Take over the equaliser of a layer or of an ocean."""
    group.use_equaliser = equaliser is not None
    if equaliser is not None:
        parameter_properties.write(group.equaliser, Equaliser, to_plain(equaliser), metres)


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
    makers = {item.wake.recording: item.wake.object for _, item in _wakes(layers) if item.wake.object}
    set_count(layers, len(parameters.layers))
    for item, layer in zip(layers, parameters.layers, strict=True):
        item.kind = layer.kind
        parameter_properties.write(item.group, type(layer), to_plain(layer, brief=True), metres)
        if layer.has("mask"):
            mask_properties.write(item.group.mask, layer.mask, metres, known_images)
        if isinstance(layer, WindFieldLayer):
            _write_wind(item.wind_field, layer, known_winds, known_images)
        elif isinstance(layer, ImageLayer):
            if layer.image is None:
                item.image_waves.image = None
            else:
                _choose_image(item.image_waves, layer.image, known_images)
        elif isinstance(layer, WakeLayer):
            item.wake.recording = wake_paths.to_text(layer)
            item.wake.object = makers.get(item.wake.recording)
        elif isinstance(layer, WaveLayer):
            item.spectra = measured_text.to_text(layer.measured)
            write_equaliser(item, layer.equaliser, metres)


def set_recording(group: bpy.types.PropertyGroup, keys: tuple[WindKey, ...]) -> None:
    """Keep keys in a wind field's properties, and let it use them."""
    group.recording, group.recording_hash = wind_recording.to_text(keys)
    group.source = "RECORDING"


def set_count(layers: bpy.types.bpy_prop_collection, count: int) -> None:
    """Give a collection so many entries; those that stay are kept."""
    # layers that stay are kept: Blender neither adds to nor removes from a library override
    while len(layers) > count:
        layers.remove(len(layers) - 1)
    while len(layers) < count:
        layers.add()


def _image(group: bpy.types.PropertyGroup) -> dict[str, Any]:
    source = source_images.source_of(group)
    return {} if source is None else {"image": source_images.raster_of(source, 1)}


def wake_makers(layers: bpy.types.bpy_prop_collection) -> list[tuple[int, bpy.types.Object]]:
    """The number of each wake that has an object, and that."""
    return [(number, layer.wake.object) for number, layer in _wakes(layers) if layer.wake.object is not None]


def _wakes(
    layers: bpy.types.bpy_prop_collection,
) -> Iterator[tuple[int, bpy.types.PropertyGroup]]:
    return ((number, layer) for number, layer in enumerate(layers) if layer.kind == WakeLayer.kind)


def _path(group: bpy.types.PropertyGroup) -> dict[str, Any]:
    path, footprint = wake_paths.from_text(group.recording)
    return {"path": path, "footprint": footprint}


#: what kinds with rasters or paths read besides their parameters
_RASTERS = {"IMAGE": _image, "WIND_FIELD": lambda group: {"keys": _keys(group)}, "WAKE": _path}


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
        yield _KnownWind(
            group.id, keys, {name: getattr(group, name) for name in _OWN_PROPERTIES["WIND_FIELD"]}
        )


def _write_wind(
    group: bpy.types.PropertyGroup,
    layer: WindFieldLayer,
    known: list[_KnownWind],
    known_images: set[ImageSource],
) -> None:
    """Let the wind come from where it came from, as far as that gives the same keys."""
    own = [wind for wind in known if wind.id == layer.id]
    same = [wind for wind in (*own, *known) if wind.keys == layer.keys]
    for name in _OWN_PROPERTIES["WIND_FIELD"]:
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
    OCEAN_PG_equaliser,
    *GROUPS.values(),
    OCEAN_PG_layer,
)
