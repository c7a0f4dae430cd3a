# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of layers of all kinds: add, remove, duplicate, move, solo."""

import dataclasses
from typing import Any, NamedTuple

import bpy
from bpy.props import EnumProperty

from ..core import OceanParameters, ParameterError, PictureLayer, WaveLayer
from ..core.waves.hero.presets import hero_wave
from ..core.waves.wind_field.presets import WIND_FIELDS, wind_field
from ..scene.animated import move_keys
from ..scene.settings import LAYER_KINDS, OceanObjectError, settings_of
from .active_ocean import OfOwnList, nearest, refuse

_WINDS = {
    "UNIFORM": ("Uniform", "The same wind everywhere (Li and Wang 2016, figure 9 B)"),
    "OPPOSED_HALVES": ("Opposed Halves", "Winds that blow apart, to the left and to the right (figure 9 D)"),
    "VARYING_SPEED": ("Varying Speed", "One direction, weak at the lower edge, strong above (figure 9 F)"),
}


class Entry(NamedTuple):
    """A layer's place: its list in the parameters, and its number there."""

    parameter: str
    index: int


def entries(parameters: OceanParameters) -> list[Entry]:
    """All layers in the order in which they stand in the list."""
    names = [kind.parameter for kind in LAYER_KINDS.values()]
    return [Entry(name, index) for name in names for index in range(len(getattr(parameters, name)))]


class _OfLayers(OfOwnList):
    """Operators that change the list as a whole, through the parameters."""

    kept = "A library override keeps its layers: make the ocean local first"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Change the list, and keep a layer active; keys follow their layers."""
        item = context.active_object
        settings = settings_of(item)
        try:
            before = settings.to_parameters(context.scene)
            places = entries(before)
            after, active = self.changed(before, places[nearest(settings.active_layer, places)])
            settings.from_parameters(after, context.scene)
        except (ParameterError, OceanObjectError) as error:
            return refuse(self, error)
        by_id = {layer.id: place for place, layer in enumerate(after.layers)}
        move_keys(item, {place: by_id.get(layer.id) for place, layer in enumerate(before.layers)})
        settings.active_layer = entries(after).index(active)
        return {"FINISHED"}

    def changed(self, parameters: OceanParameters, active: Entry) -> tuple[OceanParameters, Entry]:
        """The sea with another list, and the layer that is active then."""
        raise NotImplementedError


def _with(parameters: OceanParameters, name: str, layers: Any) -> OceanParameters:
    return parameters.replace(**{name: tuple(layers)})


class OCEAN_OT_layer_add(_OfLayers, bpy.types.Operator):
    """Add a layer."""

    bl_idname = "ocean.layer_add"
    bl_description = "Add a layer: a swell from another direction, a wind field, a picture, a hero wave"
    bl_label = "Add Layer"
    bl_options = {"REGISTER", "UNDO"}

    kind: EnumProperty(
        name="Kind",
        items=[(key, kind.label, kind.description) for key, kind in LAYER_KINDS.items()],
        options={"SKIP_SAVE"},
        description="What makes its waves",
    )
    wind: EnumProperty(
        name="Wind",
        items=[(key, *_WINDS[key]) for key in WIND_FIELDS],
        options={"SKIP_SAVE"},
        description="The wind field to begin with",
    )

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """What is added."""
        if properties.kind == "WIND_FIELD":
            return _WINDS[properties.wind][1]
        return LAYER_KINDS[properties.kind].description

    def changed(self, parameters: OceanParameters, _active: Entry) -> tuple[OceanParameters, Entry]:
        """A layer behind those of its kind."""
        name = LAYER_KINDS[self.kind].parameter
        layers = getattr(parameters, name)
        return _with(parameters, name, (*layers, self._new(parameters))), Entry(name, len(layers))

    def _new(self, parameters: OceanParameters) -> object:
        if self.kind == "WIND_FIELD":
            return wind_field(self.wind, parameters.domain_size, parameters.water.gravity)
        if self.kind == "HERO_WAVE":
            time = parameters.timing.time(bpy.context.scene.frame_current)
            return hero_wave(parameters.domain_size, parameters.resolution, float(time))
        return WaveLayer() if self.kind == "WAVES" else PictureLayer()


class OCEAN_OT_layer_duplicate(_OfLayers, bpy.types.Operator):
    """Duplicate the active layer."""

    bl_idname = "ocean.layer_duplicate"
    bl_description = "Duplicate the active layer; the copy has waves of its own"
    bl_label = "Duplicate Layer"
    bl_options = {"REGISTER", "UNDO"}

    def changed(self, parameters: OceanParameters, active: Entry) -> tuple[OceanParameters, Entry]:
        """A copy with another identity behind the active one."""
        name, index = active
        layers = getattr(parameters, name)
        copy = layers[index]
        if name != "hero_waves":  # these have no random numbers, and so no identity
            copy = dataclasses.replace(copy, id=-1)
        with_copy = (*layers[: index + 1], copy, *layers[index + 1 :])
        return _with(parameters, name, with_copy), Entry(name, index + 1)


class OCEAN_OT_layer_remove(_OfLayers, bpy.types.Operator):
    """Remove the active layer."""

    bl_idname = "ocean.layer_remove"
    bl_description = "Remove the active layer; the others keep their waves"
    bl_label = "Remove Layer"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """One wave layer must stay."""
        if not super().poll(context):
            return False
        settings = settings_of(context.active_object)
        kinds = [layer.kind for layer in settings.layers]
        if kinds.count("WAVES") < 2 and kinds[nearest(settings.active_layer, kinds)] == "WAVES":
            cls.poll_message_set("A sea has at least one layer of waves: mute it for flat water")
            return False
        return True

    def changed(self, parameters: OceanParameters, active: Entry) -> tuple[OceanParameters, Entry]:
        """The others."""
        name, index = active
        layers = getattr(parameters, name)
        after = _with(parameters, name, (*layers[:index], *layers[index + 1 :]))
        return after, entries(after)[max(entries(parameters).index(active) - 1, 0)]


class OCEAN_OT_layer_move(_OfLayers, bpy.types.Operator):
    """Move the active layer among those of its kind."""

    bl_idname = "ocean.layer_move"
    bl_description = "Move the active layer among those of its kind; the sea stays as it is"
    bl_label = "Move Layer"
    bl_options = {"REGISTER", "UNDO"}

    direction: EnumProperty(
        name="Direction",
        items=[("UP", "Up", "Towards the first"), ("DOWN", "Down", "Towards the last")],
        description="Where to",
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Move it, unless it stands at the end already."""
        kinds = [layer.kind for layer in settings_of(context.active_object).layers]
        here = nearest(settings_of(context.active_object).active_layer, kinds)
        there = here + (1 if self.direction == "DOWN" else -1)
        if not (0 <= there < len(kinds) and kinds[here] == kinds[there]):
            return {"CANCELLED"}
        return super().execute(context)

    def changed(self, parameters: OceanParameters, active: Entry) -> tuple[OceanParameters, Entry]:
        """The layer and its neighbour the other way round."""
        name, index = active
        other = index + (1 if self.direction == "DOWN" else -1)
        layers = list(getattr(parameters, name))
        layers[index], layers[other] = layers[other], layers[index]
        return _with(parameters, name, layers), Entry(name, other)


class OCEAN_OT_layer_solo(_OfLayers, bpy.types.Operator):
    """Hear the active layer alone."""

    bl_idname = "ocean.layer_solo"
    bl_description = "Mute all layers but the active one; again, to have all of them back"
    bl_label = "Solo Layer"
    bl_options = {"REGISTER", "UNDO"}

    def changed(self, parameters: OceanParameters, active: Entry) -> tuple[OceanParameters, Entry]:
        """The active layer alone, or all."""
        places = entries(parameters)
        alone = {entry: entry != active for entry in places}
        now = {entry: getattr(parameters, entry.parameter)[entry.index].muted for entry in places}
        muted = dict.fromkeys(places, False) if now == alone else alone
        changes = {
            kind.parameter: tuple(
                dataclasses.replace(layer, muted=muted[Entry(kind.parameter, index)])
                for index, layer in enumerate(getattr(parameters, kind.parameter))
            )
            for kind in LAYER_KINDS.values()
        }
        return parameters.replace(**changes), active


class OCEAN_MT_layer_add(bpy.types.Menu):
    """The kinds of layers."""

    bl_idname = "OCEAN_MT_layer_add"
    bl_label = "Add Layer"
    bl_description = "Add a layer: a swell from another direction, a wind field, a picture, a hero wave"

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw an entry a kind; wind fields have several to begin with."""
        for key, kind in LAYER_KINDS.items():
            if key == "WIND_FIELD":
                self.layout.menu(OCEAN_MT_wind_fields.bl_idname, icon=kind.icon)
            else:
                text = f"{kind.label}" if key != "PICTURE" else "Picture or Noise"
                self.layout.operator(OCEAN_OT_layer_add.bl_idname, text=text, icon=kind.icon).kind = key


class OCEAN_MT_wind_fields(bpy.types.Menu):
    """Wind fields to begin with."""

    bl_idname = "OCEAN_MT_wind_fields"
    bl_label = "Wind Field"

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw an entry a field."""
        for key, (label, _) in _WINDS.items():
            operator = self.layout.operator(OCEAN_OT_layer_add.bl_idname, text=label)
            operator.kind, operator.wind = "WIND_FIELD", key


#: buttons beside the list, below that which adds, and their icons
BUTTONS = (
    (OCEAN_OT_layer_remove, "REMOVE"),
    (OCEAN_OT_layer_duplicate, "DUPLICATE"),
    (OCEAN_OT_layer_solo, "SOLO_ON"),
)

CLASSES = (
    OCEAN_OT_layer_add,
    OCEAN_OT_layer_move,
    *(operator for operator, _ in BUTTONS),
    OCEAN_MT_layer_add,
    OCEAN_MT_wind_fields,
)
