# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of an ocean object, `object.ocean_tweak`, and their way to and from OceanParameters."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from ..core import Foam, OceanParameters, Timing, Water, WaveLayer
from ..scene.cache_place import DEFAULT_CACHE
from ..scene.maps import MAPS
from ..scene.refinement import show
from ..scene.settings import METHODS, OUT_OF_RANGE, SOURCES, VIEWPORT_RESOLUTION, OceanObjectError
from ..scene.units import frame_rate, metres_per_unit
from . import parameter_properties
from .usd_properties import OCEAN_PG_usd

# the frame rate is the scene's
_FROM_SCENE = ("fps",)


def _changed(group: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    item = group.id_data
    settings = item.ocean_tweak
    if settings.is_quiet or not settings.is_ocean:
        return
    if settings.preset:
        settings.preset = ""
    scenes = item.users_scene
    if scenes:
        show(item, context.scene if context.scene in scenes else scenes[0], dragged=True)


def _choices(table: dict[str, tuple[str, str]]) -> list[tuple[str, str, str]]:
    return [(key, label, description) for key, (label, description) in table.items()]


# every setting of a linked ocean can be overridden
_OVERRIDE = {"override": {"LIBRARY_OVERRIDABLE"}}
_SHOWN = {"options": set(), "update": _changed, **_OVERRIDE}
_HIDDEN = {"options": {"HIDDEN"}, **_OVERRIDE}


def _set_count(layers: bpy.types.bpy_prop_collection, count: int) -> None:
    # layers that stay are kept: Blender neither adds to nor removes from a library override
    while len(layers) > count:
        layers.remove(len(layers) - 1)
    while len(layers) < count:
        layers.add()


class OCEAN_PG_water(bpy.types.PropertyGroup):
    """The body of water."""

    __annotations__ = parameter_properties.annotations(Water, _changed)


def _metres(layer: bpy.types.PropertyGroup) -> float:
    """Metres in a Blender unit of the layer's scene."""
    scenes = layer.id_data.users_scene
    scene = bpy.context.scene if bpy.context.scene in scenes or not scenes else scenes[0]
    return float(metres_per_unit(scene))


def _fetch_in_km(layer: bpy.types.PropertyGroup) -> float:
    return layer.fetch * _metres(layer) / 1000.0


def _set_fetch_in_km(layer: bpy.types.PropertyGroup, value: float) -> None:
    layer.fetch = value * 1000.0 / _metres(layer)


class OCEAN_PG_layer(bpy.types.PropertyGroup):
    """One wave system."""

    __annotations__ = {
        **parameter_properties.annotations(WaveLayer, _changed),
        # Blender has no property that is always shown in kilometres; this is the fetch itself
        "fetch_km": FloatProperty(
            name="Fetch", min=0.001, max=20e3, soft_min=0.1, soft_max=1000.0, precision=1, step=100,
            get=_fetch_in_km, set=_set_fetch_in_km, options=set(),
            description="Distance of open water over which the wind has blown, in kilometres. "
            "Longer fetch: higher and longer waves, until the sea is fully developed",
        ),
    }  # fmt: skip


class OCEAN_PG_foam(bpy.types.PropertyGroup):
    """How whitecaps cover the sea and how long they last."""

    __annotations__ = parameter_properties.annotations(Foam, _changed)


class OCEAN_PG_timing(bpy.types.PropertyGroup):
    """How frames become seconds."""

    __annotations__ = parameter_properties.annotations(Timing, _changed, _FROM_SCENE)


class OCEAN_PG_maps(bpy.types.PropertyGroup):
    """One image a map."""

    __annotations__ = {name: PointerProperty(type=bpy.types.Image, **_HIDDEN) for name in MAPS}


_SWITCHES = {
    "use_foam": BoolProperty(
        name="Foam", default=True, **_SHOWN,
        description="Write the attributes foam, how much of the water is white, and cusp, how far it is "
        "squeezed. A frame alone looks back over up to 180 moments, playback goes on from the last",
    ),
    "use_normals": BoolProperty(
        name="Normals", default=True, **_SHOWN,
        description="Shade with the normals of the waves instead of those of the mesh: finer highlights for "
        "about the cost of the displacement",
    ),
    "use_velocity": BoolProperty(
        name="Velocity", default=True, **_SHOWN,
        description="Write the attribute velocity from which Cycles makes motion blur, the only one of baked "
        "files. Costs as much as the displacement",
    ),
}  # fmt: skip


def _repeats(axis: str) -> object:
    return IntProperty(
        name=f"Repeats {axis.upper()}", default=1, min=1, max=64, soft_max=8, **_SHOWN,
        description=f"Patches side by side along {axis}, without a seam. They are all alike",
    )  # fmt: skip


class OCEAN_PG_ocean(bpy.types.PropertyGroup):
    """An ocean object's settings; see scene.settings.OceanSettings for what the scene needs of them."""

    __annotations__ = {
        **parameter_properties.annotations(OceanParameters, _changed),
        "water": PointerProperty(type=OCEAN_PG_water, **_OVERRIDE),
        "layers": CollectionProperty(type=OCEAN_PG_layer, **_OVERRIDE),
        "foam": PointerProperty(type=OCEAN_PG_foam, **_OVERRIDE),
        "timing": PointerProperty(type=OCEAN_PG_timing, **_OVERRIDE),
        "is_ocean": BoolProperty(**_HIDDEN),
        "is_quiet": BoolProperty(options={"HIDDEN", "SKIP_SAVE"}),
        "uid": StringProperty(**_HIDDEN),
        "cache_folder": StringProperty(
            name="Cache", default=DEFAULT_CACHE, subtype="DIR_PATH",
            options={"PATH_SUPPORTS_BLEND_RELATIVE"}, **_OVERRIDE,
            description="Folder of baked frames; each bake gets one of its own in it. // is beside the file",
        ),
        "preset": StringProperty(**_HIDDEN),
        "active_layer": IntProperty(name="Active Layer", options={"HIDDEN"}, **_OVERRIDE),
        "use_loop": BoolProperty(
            name="Loop", **_SHOWN,
            description="Let the sea repeat itself exactly after a number of frames. Changes the speed of "
            "the waves a little, the more the shorter the loop",
        ),
        "loop_frames": IntProperty(
            name="Loop Frames", default=240, min=1, soft_min=24, max=1_000_000, **_SHOWN,
            description="Frames after which the sea repeats itself",
        ),
        "bake_done": IntProperty(**_HIDDEN),
        "bake_total": IntProperty(**_HIDDEN),
        "use_ocean_time": BoolProperty(
            name="Own Time", **_SHOWN,
            description="Let the waves follow a clock of their own, which can be animated: slow motion, "
            "ramps, a still sea",
        ),
        "ocean_time": FloatProperty(
            name="Ocean Time", unit="TIME_ABSOLUTE", precision=3, step=10, update=_changed,
            description="Seconds on the waves' own clock; animate it", options={"ANIMATABLE"}, **_OVERRIDE,
        ),
        "method": EnumProperty(
            name="Method", items=_choices(METHODS), default="NODES", **_SHOWN,
            description="What moves the mesh",
        ),
        "source": EnumProperty(
            name="Source", items=_choices(SOURCES), default="LIVE", **_SHOWN,
            description="Where the displacement comes from",
        ),
        "viewport_resolution": IntProperty(
            name="Resolution Viewport", default=VIEWPORT_RESOLUTION, min=16, max=8192, **_SHOWN,
            description="Samples along each side in the viewport: the same sea without its shortest waves. "
            "Never more than in the render",
        ),
        "mesh_resolution": IntProperty(
            name="Mesh Resolution", min=0, max=8192, **_SHOWN,
            description="Quads along each side of a patch, in the viewport and in the render; "
            "0 for one per sample",
        ),
        **_SWITCHES,
        "repeats_x": _repeats("x"),
        "repeats_y": _repeats("y"),
        "out_of_range": EnumProperty(
            name="Out of Range", items=_choices(OUT_OF_RANGE), default="WARN", **_SHOWN,
            description="What to do at frames that were not baked",
        ),
        "render_texture": PointerProperty(type=bpy.types.Texture, **_HIDDEN),
        "live_maps": PointerProperty(type=OCEAN_PG_maps, **_OVERRIDE),
        "render_maps": PointerProperty(type=OCEAN_PG_maps, **_OVERRIDE),
        "sequence_maps": PointerProperty(type=OCEAN_PG_maps, **_OVERRIDE),
        "texture": PointerProperty(type=bpy.types.Texture, **_HIDDEN),
        "sequence_first": IntProperty(**_HIDDEN),
        "sequence_last": IntProperty(**_HIDDEN),
        "sequence_samples": IntProperty(**_HIDDEN),
        "sequence_fps": StringProperty(**_HIDDEN),
        "error": StringProperty(**_HIDDEN),
        "missing_file": StringProperty(**_HIDDEN),
        "statistics": StringProperty(**_HIDDEN),
        "usd": PointerProperty(type=OCEAN_PG_usd, **_OVERRIDE),
    }  # fmt: skip

    @contextmanager
    def quiet(self) -> Iterator[None]:
        """While this is open, a changed property refreshes nothing."""
        before, self.is_quiet = self.is_quiet, True
        try:
            yield
        finally:
            self.is_quiet = before

    def to_parameters(self, scene: bpy.types.Scene) -> OceanParameters:
        """The sea of these settings, at the scene's units and frame rate.

        Raises ParameterError naming the field, its value and what is allowed.
        """
        metres = metres_per_unit(scene)
        data = parameter_properties.read(self, OceanParameters, metres)
        data["water"] = parameter_properties.read(self.water, Water, metres)
        data["foam"] = parameter_properties.read(self.foam, Foam, metres)
        data["layers"] = [parameter_properties.read(layer, WaveLayer, metres) for layer in self.layers]
        data["timing"] = parameter_properties.read(self.timing, Timing, metres, _FROM_SCENE)
        data["timing"]["fps"] = str(frame_rate(scene))
        data["loop_duration"] = str(self.loop_frames / frame_rate(scene)) if self.use_loop else None
        return OceanParameters.from_dict(data)

    def blender_values(self, path: str, values: Sequence[float], scene: bpy.types.Scene) -> list[float]:
        """Values of a parameter that can be animated, by its path, in the units of its property."""
        kind = WaveLayer if path.startswith("layers.") else OceanParameters
        unit = parameter_properties.unit_of(kind, path.rpartition(".")[2], metres_per_unit(scene))
        return [value / unit for value in values]

    def from_parameters(self, parameters: OceanParameters, scene: bpy.types.Scene) -> None:
        """Take over a sea, and refresh the ocean once. The scene and its frame rate stay as they are.

        Raises OceanObjectError for another number of layers on a library override.
        """
        count = len(self.layers)
        if self.id_data.override_library and len(parameters.layers) != count:
            raise OceanObjectError(
                f"A library override keeps its {count} wave layers, this sea has {len(parameters.layers)}: "
                "make the ocean local first"
            )
        metres, data = metres_per_unit(scene), parameters.to_dict()
        with self.quiet():
            parameter_properties.write(self, OceanParameters, data, metres)
            parameter_properties.write(self.water, Water, data["water"], metres)
            parameter_properties.write(self.foam, Foam, data["foam"], metres)
            parameter_properties.write(self.timing, Timing, data["timing"], metres, _FROM_SCENE)
            self.use_loop = parameters.loop_duration is not None
            if parameters.loop_duration is not None:
                self.loop_frames = round(parameters.loop_duration * parameters.timing.fps)
            _set_count(self.layers, len(data["layers"]))
            for layer, values in zip(self.layers, data["layers"], strict=True):
                parameter_properties.write(layer, WaveLayer, values, metres)
        _changed(self, bpy.context)


CLASSES = (
    OCEAN_PG_water,
    OCEAN_PG_layer,
    OCEAN_PG_foam,
    OCEAN_PG_timing,
    OCEAN_PG_maps,
    OCEAN_PG_usd,
    OCEAN_PG_ocean,
)
