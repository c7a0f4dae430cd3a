# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of layers of all kinds: add, remove, duplicate, move, solo."""

from collections.abc import Sequence

import bpy
from bpy.props import EnumProperty

from ..core import OceanParameters, ParameterError
from ..core.data.validation import changing_fields
from ..core.waves.contribution import Contribution
from ..core.waves.kinds import shown
from ..core.waves.wind_field.presets import WIND_FIELDS, wind_field
from ..scene.animated import clock_of, move_keys
from ..scene.settings import OceanObjectError, settings_of
from .active_ocean import OfOwnList, nearest, refuse, shown_ocean
from .measured_operators import OCEAN_OT_import_measured

_WINDS = {
    "UNIFORM": ("Uniform", "The same wind everywhere (Li and Wang 2016, figure 9 B)"),
    "OPPOSED_HALVES": ("Opposed Halves", "Winds that blow apart, to the left and to the right (figure 9 D)"),
    "VARYING_SPEED": ("Varying Speed", "One direction, weak at the lower edge, strong above (figure 9 F)"),
}


class _OfLayers(OfOwnList):
    """Base class of operators that change the whole list, through the parameters."""

    kept = "A library override keeps its layers: make the ocean local first"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Change the list and the active layer; keys follow their layers."""
        item = shown_ocean(context)
        settings = settings_of(item)
        try:
            before = settings.to_parameters(context.scene)
            layers, active = self.changed(before, nearest(settings.active_layer, before.layers))
            after = before.replace(layers=tuple(layers))
            settings.from_parameters(after, context.scene)
        except (ParameterError, OceanObjectError) as error:
            return refuse(self, error)
        there = {(layer.kind, layer.id): place for place, layer in enumerate(after.layers)}
        own = [place for place, layer in enumerate(before.layers) if changing_fields(type(layer))]
        move_keys(item, {old: there.get((before.layers[old].kind, before.layers[old].id)) for old in own})
        settings.active_layer = active
        return {"FINISHED"}

    def changed(self, parameters: OceanParameters, active: int) -> tuple[Sequence[Contribution], int]:
        """The new list, and the index of its active layer."""
        raise NotImplementedError


class OCEAN_OT_layer_add(_OfLayers, bpy.types.Operator):
    """Add a layer."""

    bl_idname = "ocean.layer_add"
    bl_description = "Add a layer: a swell from another direction, a wind field, an image, a hero wave"
    bl_label = "Add Layer"
    bl_options = {"REGISTER", "UNDO"}

    kind: EnumProperty(
        name="Kind",
        items=[(kind.kind, kind.names.label, kind.names.description) for kind in shown()],
        options={"SKIP_SAVE"},
        description="What makes its waves",
    )
    wind: EnumProperty(
        name="Wind",
        items=[(key, *_WINDS[key]) for key in WIND_FIELDS],
        options={"SKIP_SAVE"},
        description="The wind field to start with",
    )

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Describe what is added."""
        if properties.kind == "WIND_FIELD":
            return _WINDS[properties.wind][1]
        return _kind(properties.kind).names.description

    def changed(self, parameters: OceanParameters, active: int) -> tuple[Sequence[Contribution], int]:
        """Insert a layer after those of its kind, and of kinds before it in the menu."""
        new = self._new(parameters)
        before = [layer.names.number <= new.names.number for layer in parameters.layers]
        place = max((index + 1 for index, is_before in enumerate(before) if is_before), default=0)
        return (*parameters.layers[:place], new, *parameters.layers[place:]), place

    def _new(self, parameters: OceanParameters) -> Contribution:
        if self.kind == "WIND_FIELD":
            return wind_field(self.wind, parameters.domain_size, parameters.water.gravity)
        settings, scene = settings_of(shown_ocean(bpy.context)), bpy.context.scene
        time = clock_of(settings, scene, parameters.timing.start_frame).time
        return _kind(self.kind).to_begin_with(parameters, float(time))


class OCEAN_OT_layer_duplicate(_OfLayers, bpy.types.Operator):
    """Duplicate the active layer."""

    bl_idname = "ocean.layer_duplicate"
    bl_description = "Duplicate the active layer; the copy has its own random waves"
    bl_label = "Duplicate Layer"
    bl_options = {"REGISTER", "UNDO"}

    def changed(self, parameters: OceanParameters, active: int) -> tuple[Sequence[Contribution], int]:
        """Insert a copy with a new id after the active one."""
        layers = list(parameters.layers)
        copy = layers[active]
        layers.insert(active + 1, copy.changed(id=-1) if copy.has("id") else copy)
        return layers, active + 1


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
        settings = settings_of(shown_ocean(context))
        kinds = [layer.kind for layer in settings.layers]
        if kinds.count("WAVES") < 2 and kinds[nearest(settings.active_layer, kinds)] == "WAVES":
            cls.poll_message_set("A sea has at least one wave layer: mute it for flat water")
            return False
        return True

    def changed(self, parameters: OceanParameters, active: int) -> tuple[Sequence[Contribution], int]:
        """Remove the active one."""
        return (*parameters.layers[:active], *parameters.layers[active + 1 :]), max(active - 1, 0)


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
        """Move it, unless it is at the end already."""
        kinds = [layer.kind for layer in settings_of(shown_ocean(context)).layers]
        here = nearest(settings_of(shown_ocean(context)).active_layer, kinds)
        there = here + (1 if self.direction == "DOWN" else -1)
        if not (0 <= there < len(kinds) and kinds[here] == kinds[there]):
            return {"CANCELLED"}
        return super().execute(context)

    def changed(self, parameters: OceanParameters, active: int) -> tuple[Sequence[Contribution], int]:
        """Swap the layer with its neighbour."""
        other = active + (1 if self.direction == "DOWN" else -1)
        layers = list(parameters.layers)
        layers[active], layers[other] = layers[other], layers[active]
        return layers, other


class OCEAN_OT_layer_solo(_OfLayers, bpy.types.Operator):
    """Show the active layer alone."""

    bl_idname = "ocean.layer_solo"
    bl_description = "Mute all layers but the active one; press again to restore them"
    bl_label = "Solo Layer"
    bl_options = {"REGISTER", "UNDO"}

    def changed(self, parameters: OceanParameters, active: int) -> tuple[Sequence[Contribution], int]:
        """Mute all other layers, or none."""
        alone = [index != active for index in range(len(parameters.layers))]
        is_alone = [layer.muted for layer in parameters.layers] == alone
        muted = [False] * len(alone) if is_alone else alone
        pairs = zip(parameters.layers, muted, strict=True)
        return [layer.changed(muted=is_muted) for layer, is_muted in pairs], active


def _kind(name: str) -> type[Contribution]:
    return next(kind for kind in shown() if kind.kind == name)


class OCEAN_MT_layer_add(bpy.types.Menu):
    """The kinds of layers."""

    bl_idname = "OCEAN_MT_layer_add"
    bl_label = "Add Layer"
    bl_description = "Add a layer: a swell from another direction, a wind field, an image, a hero wave"

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw an entry for each kind; wind fields have a submenu."""
        for kind in shown():
            names = kind.names
            if kind.kind == "WIND_FIELD":
                self.layout.menu(OCEAN_MT_wind_fields.bl_idname, icon=names.icon)
            else:
                text = names.entry or names.label
                add = self.layout.operator(OCEAN_OT_layer_add.bl_idname, text=text, icon=names.icon)
                add.kind = kind.kind
            if kind.kind == "WAVES":
                measured = self.layout.operator(
                    OCEAN_OT_import_measured.bl_idname, text="Measured", icon="IMPORT"
                )
                measured.target = "LAYER"


class OCEAN_MT_wind_fields(bpy.types.Menu):
    """Built-in wind fields."""

    bl_idname = "OCEAN_MT_wind_fields"
    bl_label = "Wind Field"

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw an entry for each field."""
        for key, (label, _) in _WINDS.items():
            operator = self.layout.operator(OCEAN_OT_layer_add.bl_idname, text=label)
            operator.kind, operator.wind = "WIND_FIELD", key


#: buttons beside the list, below the one that adds, with their icons
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
