# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of an ocean object, `object.ocean_tweak`, and their conversion to and from OceanParameters."""

from collections.abc import Sequence
from pathlib import Path

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

from ..core import (
    Current,
    Equaliser,
    Foam,
    Mask,
    OceanParameters,
    PathSample,
    Spray,
    Timing,
    Water,
    WaveLayer,
)
from ..core.data.plain_data import from_plain, to_plain
from ..core.data.validation import Off
from ..core.waves.kinds import shown
from ..nodes.names import MAP_INPUTS
from ..scene import cache_place, current_way, middle, ocean_object, wake_paths
from ..scene.cache_place import DEFAULT_CACHE
from ..scene.image_sequence import ImageSequence
from ..scene.settings import (
    METHODS,
    OUT_OF_RANGE,
    SOURCES,
    VIEWPORT_RESOLUTION,
    OceanObjectError,
    shown_oceans,
)
from ..scene.source_images import ImageSource
from ..scene.units import frame_rate, metres_per_unit, time_stretch
from . import (
    coast_properties,
    layer_properties,
    mask_properties,
    parameter_properties,
    patch_properties,
    resizing,
)
from .layer_properties import OCEAN_PG_layer
from .parameter_properties import changed, path_changed
from .patch_properties import OCEAN_PG_patch
from .quiet import Quiet
from .usd_properties import OCEAN_PG_usd

# frame rate and time stretching are the scene's
_FROM_SCENE = ("fps", "stretch")
_FROM_KEYS = ("carried_x", "carried_y")
# patches are always merged, on the samples that are rendered
_FROM_RESOLUTION = ("merged_resolution",)


def _choices(table: dict[str, tuple[str, str]]) -> list[tuple[str, str, str]]:
    return [(key, label, description) for key, (label, description) in table.items()]


_MESH_QUADS = "Quads along each side of a patch, in the viewport and in the render"

# every setting of a linked ocean can be overridden
_OVERRIDE = {"override": {"LIBRARY_OVERRIDABLE"}}
_SHOWN = {"options": set(), "update": changed, **_OVERRIDE}
_HIDDEN = {"options": {"HIDDEN"}, **_OVERRIDE}


def _listed(kinds: list[str]) -> str:
    """How many layers of which kinds."""
    counts = {kind.names.noun: kinds.count(kind.kind) for kind in shown() if kind.kind in kinds}
    return ", ".join(f"{count} {noun}{'s' if count > 1 else ''}" for noun, count in counts.items())


class OCEAN_PG_water(bpy.types.PropertyGroup):
    """The body of water."""

    __annotations__ = parameter_properties.annotations(Water, changed)


class OCEAN_PG_current(bpy.types.PropertyGroup):
    """The current; how far it has come follows from its keys."""

    __annotations__ = parameter_properties.annotations(Current, changed, _FROM_KEYS)


class OCEAN_PG_foam(bpy.types.PropertyGroup):
    """How whitecaps cover the sea and how long they last."""

    __annotations__ = parameter_properties.annotations(Foam, changed)


class OCEAN_PG_spray(bpy.types.PropertyGroup):
    """What breaking crests throw into the air."""

    __annotations__ = parameter_properties.annotations(Spray, changed)


class OCEAN_PG_timing(bpy.types.PropertyGroup):
    """How frames become seconds."""

    __annotations__ = parameter_properties.annotations(Timing, changed, _FROM_SCENE)


class OCEAN_PG_maps(bpy.types.PropertyGroup):
    """One image a map."""

    __annotations__ = {name: PointerProperty(type=bpy.types.Image, **_HIDDEN) for name in MAP_INPUTS}


_SWITCHES = {
    "use_current": BoolProperty(
        name="Current", default=False, **_SHOWN,
        description="Let the water move: a current carries waves, foam, wakes and floating objects",
    ),
    "use_equaliser": BoolProperty(
        name="Equaliser", default=False, **_SHOWN,
        description="Change the height of all spectral waves by octave of their length",
    ),
    "use_foam": BoolProperty(
        name="Foam", default=True, **_SHOWN,
        description="Write the attributes foam (how much of the water is white), breaking (how much "
        "crests are breaking now), foam_age in seconds, and cusp (how far the water is "
        "compressed). A single frame looks back over six half-lives; playback continues from the "
        "last frame",
    ),
    "use_spray": BoolProperty(
        name="Spray", default=False, **_SHOWN,
        description="Throw spume, drops and mist up from breaking crests, as points, in winds of 9 m/s and "
        "more. A window shows an eighth of them",
    ),
    "use_normals": BoolProperty(
        name="Normals", default=True, **_SHOWN,
        description="Shade with the normals of the waves instead of those of the mesh, for finer "
        "highlights",
    ),
    "use_velocity": BoolProperty(
        name="Velocity", default=True, **_SHOWN,
        description="Write the attribute velocity, which Cycles uses for motion blur and which moves "
        "baked water between frames in any engine",
    ),
}  # fmt: skip


def _repeats(axis: str) -> object:
    return IntProperty(
        name=f"Repeats {axis.upper()}", default=1, min=1, max=64, soft_max=8, **_SHOWN,
        description=f"Copies of the patch side by side along {axis}, without a seam. All are the same",
    )  # fmt: skip


class OCEAN_PG_ocean(Quiet, bpy.types.PropertyGroup):
    """An ocean object's settings; see scene.settings.OceanSettings for what the scene needs of them."""

    __annotations__ = {
        **parameter_properties.annotations(
            OceanParameters, changed, _FROM_RESOLUTION, updates=patch_properties.OCEAN_UPDATES
        ),
        "water": PointerProperty(type=OCEAN_PG_water, **_OVERRIDE),
        "layers": CollectionProperty(type=OCEAN_PG_layer, **_OVERRIDE),
        "patches": CollectionProperty(type=OCEAN_PG_patch, **_OVERRIDE),
        "mask": PointerProperty(type=mask_properties.OCEAN_PG_mask, **_OVERRIDE),
        "current": PointerProperty(type=OCEAN_PG_current, **_OVERRIDE),
        "equaliser": PointerProperty(type=layer_properties.OCEAN_PG_equaliser, **_OVERRIDE),
        "coast": PointerProperty(type=coast_properties.OCEAN_PG_coast, **_OVERRIDE),
        "foam": PointerProperty(type=OCEAN_PG_foam, **_OVERRIDE),
        "spray": PointerProperty(type=OCEAN_PG_spray, **_OVERRIDE),
        "timing": PointerProperty(type=OCEAN_PG_timing, **_OVERRIDE),
        "is_ocean": BoolProperty(**_HIDDEN),
        # whose driver needs the objects of masks that move, so that Blender evaluates these first
        "mask_motion": FloatProperty(options={"HIDDEN", "ANIMATABLE"}),
        "is_quiet": BoolProperty(options={"HIDDEN", "SKIP_SAVE"}),
        "placed_size": FloatProperty(**_HIDDEN),
        "stays_behind": BoolProperty(**_HIDDEN),
        "uid": StringProperty(**_HIDDEN),
        "cache_folder": StringProperty(
            name="Cache", default=DEFAULT_CACHE, subtype="DIR_PATH",
            options={"PATH_SUPPORTS_BLEND_RELATIVE"}, update=path_changed("cache_folder"), **_OVERRIDE,
            description="Folder for baked frames; each bake gets its own folder in it. // is the folder "
            "of the file, ~ the home folder",
        ),
        "preset": StringProperty(**_HIDDEN),
        "active_layer": IntProperty(name="Active Layer", min=0, options={"HIDDEN"}, **_OVERRIDE),
        "active_patch": IntProperty(name="Active Patch", min=0, options={"HIDDEN"}, **_OVERRIDE),
        **patch_properties.PLAN,
        "use_loop": BoolProperty(
            name="Loop", **_SHOWN,
            description="Let the sea repeat exactly after a number of frames. This changes the speed of "
            "the waves slightly, and more for short loops",
        ),
        "loop_frames": IntProperty(
            name="Loop Frames", default=240, min=1, soft_min=24, max=1_000_000, **_SHOWN,
            description="Frames after which the sea repeats",
        ),
        "bake_done": IntProperty(**_HIDDEN),
        "bake_total": IntProperty(**_HIDDEN),
        "use_ocean_time": BoolProperty(
            name="Keyed Time", **_SHOWN,
            description="Take the waves' time from Ocean Time, which can be keyed, instead of the "
            "scene's frames: for speed ramps, freezes, waves that run backwards",
        ),
        "ocean_time": FloatProperty(
            name="Ocean Time", unit="TIME_ABSOLUTE", precision=3, step=10, update=changed,
            description="The waves' time in seconds. Key it: without keys the sea stands still",
            options={"ANIMATABLE"}, **_OVERRIDE,
        ),
        "time_scale": FloatProperty(
            name="Time Scale", default=1.0, min=-100.0, max=100.0, soft_min=0.0, soft_max=2.0, precision=2,
            step=1, **_SHOWN,
            description="Speed of the waves: 0.5 is half speed, 0 a still sea. At Start Frame the sea is "
            "the same whatever the scale",
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
            name="Samples in the Viewport", default=VIEWPORT_RESOLUTION, min=16, max=8192, **_SHOWN,
            description="Samples along each side in the viewport: the same sea without its shortest "
            "waves. Never more than the render has",
        ),
        "mesh_resolution": IntProperty(
            name="Mesh Quads", min=0, max=8192, **_SHOWN, description=_MESH_QUADS
        ),
        **parameter_properties.switch_of(
            "mesh_resolution", _MESH_QUADS, Off(0, 256, "has one quad per sample")
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
        "early_maps": PointerProperty(type=OCEAN_PG_maps, **_OVERRIDE),
        "texture": PointerProperty(type=bpy.types.Texture, **_HIDDEN),
        "sequence_frames": StringProperty(**_HIDDEN),
        "sequence_first": IntProperty(**_HIDDEN),
        "sequence_last": IntProperty(**_HIDDEN),
        "sequence_samples": IntProperty(**_HIDDEN),
        "sequence_fps": StringProperty(**_HIDDEN),
        "sequence_stretch": StringProperty(**_HIDDEN),
        "error": StringProperty(**_HIDDEN),
        "missing_file": StringProperty(**_HIDDEN),
        "baked_sea": StringProperty(**_HIDDEN),
        "bake_differs": StringProperty(**_HIDDEN),
        "bake_is_elsewhere": BoolProperty(**_HIDDEN),
        "statistics": StringProperty(**_HIDDEN),
        "usd": PointerProperty(type=OCEAN_PG_usd, **_OVERRIDE),
    }  # fmt: skip

    def to_parameters(self, scene: bpy.types.Scene) -> OceanParameters:
        """The sea of these settings, at the scene's units and frame rate.

        Raises ParameterError naming the field, its value and what is allowed.
        """
        metres = metres_per_unit(scene)
        data = parameter_properties.read(self, OceanParameters, metres, _FROM_RESOLUTION)
        data["water"] = parameter_properties.read(self.water, Water, metres)
        data["foam"] = parameter_properties.read(self.foam, Foam, metres)
        data["equaliser"] = layer_properties.read_equaliser(self, metres)
        if self.use_spray:
            data["spray"] = parameter_properties.read(self.spray, Spray, metres)
        data["layers"] = layer_properties.read(self.layers, metres)
        data["patches"] = patch_properties.read(self.patches, metres)
        if self.patches:  # the first of them tells the tile
            del data["resolution"], data["domain_size"]
        data["mask"] = mask_properties.read(self.mask, metres)
        data["coast"] = coast_properties.read(self.coast, metres)
        data["merged_resolution"] = self.resolution if self.patches else 0
        data["timing"] = parameter_properties.read(self.timing, Timing, metres, _FROM_SCENE)
        data["timing"].update(fps=str(frame_rate(scene)), stretch=str(time_stretch(scene)))
        if self.use_current:
            told = from_plain(Current, parameter_properties.read(self.current, Current, metres, _FROM_KEYS))
            data["current"] = current_way.carried(self, told, scene, self.timing.start_frame)
        data["loop_duration"] = str(self.loop_frames / frame_rate(scene)) if self.use_loop else None
        return from_plain(OceanParameters, data)  # as it is today, and of no size that a file could have

    def shown_in(self) -> bpy.types.Scene | None:
        """The scene that shows the ocean; None for what is none. For scripts of farms, as the next two."""
        return shown_oceans().get(self.id_data)

    def use_sequence(self, folder: Path, name: str, frames: Sequence[int]) -> None:
        """Let baked files of these frames move the ocean. Raises SequenceError, and then changes nothing."""
        item = self.id_data
        ocean_object.use_sequence(item, shown_oceans()[item], ImageSequence(folder, name, tuple(frames)))

    def own_uid(self) -> str:
        """The uid of the ocean's bakes."""
        return cache_place.own_uid(self.id_data)

    def source_images(self) -> set[ImageSource]:
        """The images from which waves or masks are made."""
        others = [mask_properties.image_source(each.mask) for each in (self, *self.patches)]
        others.append(coast_properties.image_source(self.coast))
        return layer_properties.images(self.layers) | {source for source in others if source is not None}

    def mask_objects(self) -> set[bpy.types.Object]:
        """Those from which the distance of a mask is measured."""
        found = {mask.object for mask in self._masks() if mask.source == "DISTANCE"}
        return found - {None}

    def wake_makers(self) -> list[tuple[int, bpy.types.Object]]:
        """The number of each layer that is the wake of an object, and that."""
        return layer_properties.wake_makers(self.layers)

    def set_wake_maker(self, number: int, item: bpy.types.Object) -> None:
        """Let a layer be the wake of an object."""
        self.layers[number].wake.object = item

    def set_wake_path(self, number: int, path: tuple[PathSample, ...]) -> bool:
        """Give a wake a path; whether it had another one."""
        group = self.layers[number].wake
        before, group.recording = group.recording, wake_paths.with_path(group.recording, path)
        return group.recording != before

    def place_masks(self) -> None:
        """Measure the distances of masks from where their objects are now."""
        for mask in self._masks():
            if mask.source == "DISTANCE":
                mask_properties.place(mask)

    def take_mask_places(self, shown: bpy.types.PropertyGroup) -> None:
        """Measure from where an evaluation has the masks' objects.

        shown : these settings as evaluated
        """
        for own, evaluated in zip(self._masks(), shown._masks(), strict=True):
            if own.source == "DISTANCE":
                mask_properties.take_place(own, evaluated)

    def let_mask_follow(self, path: str, item: bpy.types.Object) -> None:
        """Put an object where the distance of a mask, by its path in the parameters, is measured from, and
        measure it from that.
        """
        owner, _, number = path.removesuffix(".mask").partition(".")
        group = {"layers": self.layers, "patches": self.patches}[owner][int(number)] if number else self
        mask = (group.group if owner == "layers" else group).mask
        item.location = mask.x, mask.y, 0.0
        bpy.context.view_layer.update()
        mask.object = item

    def painted_meshes(self) -> set[bpy.types.Object]:
        """Those whose weights masks have read."""
        return {mask.mesh for mask in self._masks() if mask_properties.has_read(mask)}

    def read_masks(self, scene: bpy.types.Scene) -> None:
        """Read these weights again. Raises OceanObjectError where that cannot be."""
        for mask in self._masks():
            if mask_properties.has_read(mask):
                mask_properties.read_weights(mask, scene, mask.image.size[0])

    def _masks(self) -> list[bpy.types.PropertyGroup]:
        return [*layer_properties.masks(self.layers), *(each.mask for each in (self, *self.patches))]

    def blender_values(self, path: str, values: Sequence[float], scene: bpy.types.Scene) -> list[float]:
        """Values of a parameter that can be animated, by its path, in the units of its property."""
        belonging = {"mask": Mask, "equaliser": Equaliser, "current": Current}
        usual = WaveLayer if path.startswith("layers.") else OceanParameters
        kind = belonging.get(path.rpartition(".")[0].rpartition(".")[2], usual)
        unit = parameter_properties.unit_of(kind, path.rpartition(".")[2], metres_per_unit(scene))
        return [value / unit for value in values]

    def from_parameters(
        self, parameters: OceanParameters, scene: bpy.types.Scene, keep_places: bool = False
    ) -> None:
        """Take over a sea, and refresh the ocean once. The scene and its frame rate stay as they are.

        The middle of the domain stays where it is in the world; while this is quiet, the origin.

        keep_places : whether hero waves and places of masks were there before, and stay there too

        Raises OceanObjectError for other kinds of layers or another number of patches on a library override.
        """
        kinds, wanted = ([layer.kind for layer in own.layers] for own in (self, parameters))
        if self.id_data.override_library and wanted != kinds:
            raise OceanObjectError(
                f"A library override keeps its {_listed(kinds)}, this sea has {_listed(wanted)}: "
                "make the ocean local first"
            )
        patch_properties.check_count(self, parameters)
        metres, data, was_quiet = metres_per_unit(scene), to_plain(parameters, brief=True), self.is_quiet
        with self.quiet():
            parameter_properties.write(self, OceanParameters, data, metres, _FROM_RESOLUTION)
            parameter_properties.write(self.water, Water, data["water"], metres)
            parameter_properties.write(self.foam, Foam, data["foam"], metres)
            self.use_current = parameters.current is not None
            if parameters.current is not None:
                parameter_properties.write(self.current, Current, data["current"], metres, _FROM_KEYS)
            layer_properties.write_equaliser(self, parameters.equaliser, metres)
            self.use_spray = parameters.spray is not None
            if parameters.spray is not None:
                parameter_properties.write(self.spray, Spray, data["spray"], metres)
            parameter_properties.write(self.timing, Timing, data["timing"], metres, _FROM_SCENE)
            self.use_loop = parameters.loop_duration is not None
            if parameters.loop_duration is not None:
                self.loop_frames = round(parameters.loop_duration * parameters.timing.fps)
            layer_properties.write(self.layers, parameters, metres)
            patch_properties.write(self, parameters, metres)
            mask_properties.write(self.mask, parameters.mask, metres, self.source_images())
            coast_properties.write(self.coast, parameters.coast, metres, self.source_images())
            if was_quiet:
                middle.settle(self)
            else:
                resizing.keep_middle(self, keep_places)
        changed(self, bpy.context)


CLASSES = (
    OCEAN_PG_water,
    OCEAN_PG_current,
    *layer_properties.CLASSES,
    coast_properties.OCEAN_PG_coast,
    OCEAN_PG_foam,
    OCEAN_PG_spray,
    OCEAN_PG_timing,
    OCEAN_PG_patch,
    OCEAN_PG_maps,
    OCEAN_PG_usd,
    OCEAN_PG_ocean,
)
