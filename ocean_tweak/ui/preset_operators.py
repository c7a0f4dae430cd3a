# SPDX-License-Identifier: GPL-3.0-or-later
"""Applies, saves, renames, deletes, imports and exports presets."""

from itertools import chain, count
from pathlib import Path

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import BoolProperty, StringProperty
from bpy_extras.io_utils import ExportHelper, ImportHelper

from ..core import ParameterError
from ..core.parameters.presets import Preset
from ..export.files import write_text
from ..scene import user_presets
from ..scene.settings import OceanObjectError, settings_of
from .active_ocean import OfActiveOcean, refuse, shown_ocean
from .resizing import tell_what_stays

_ERRORS = (ParameterError, OceanObjectError, OSError)


class OCEAN_OT_apply_preset(OfActiveOcean, bpy.types.Operator):
    """Give the active ocean the sea of a preset."""

    bl_idname = "ocean.apply_preset"
    bl_description = "Give the active ocean the sea of a preset; the shot keeps its frame rate and start"
    bl_label = "Apply Preset"
    bl_options = {"REGISTER", "UNDO"}

    key: StringProperty(name="Preset", description="Key of the preset", options={"SKIP_SAVE"})

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """What the sea is."""
        preset = user_presets.all_presets().get(properties.key)
        return preset.description if preset and preset.description else cls.bl_description

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Apply it as a whole, or not at all."""
        settings = settings_of(shown_ocean(context))
        presets = user_presets.all_presets()
        if self.key not in presets:
            return refuse(self, f"There is no preset {self.key!r}; there are {', '.join(presets)}")
        try:
            now = settings.to_parameters(context.scene)
            settings.from_parameters(presets[self.key].for_shot(now), context.scene)
        except _ERRORS as error:
            return refuse(self, error)
        settings.preset = presets[self.key].title
        self.report({"INFO"}, presets[self.key].title)
        tell_what_stays(self, settings)
        return {"FINISHED"}


def free_title() -> str:
    """A name for a new preset that no other has."""
    taken = {preset.title for preset in user_presets.all_presets().values()}
    names = chain(["My Sea"], (f"My Sea {number}" for number in count(2)))
    return next(name for name in names if name not in taken)


class OCEAN_OT_save_preset(OfActiveOcean, bpy.types.Operator):
    """Keep the active ocean's sea as a preset."""

    bl_idname = "ocean.save_preset"
    bl_description = "Save the active ocean's sea as your own preset, with a picture of it"
    bl_label = "Save Preset"
    bl_options = {"REGISTER", "UNDO"}
    bl_property = "title"

    title: StringProperty(name="Name", default="My Sea", maxlen=60)
    text: StringProperty(name="Description", description="What the tooltip will say", maxlen=400)
    replace: BoolProperty(name="Replace", description="Replace a preset of this name", options={"SKIP_SAVE"})

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Ask for the name."""
        self.title = free_title()
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Write the file; the ocean has this preset's sea from now on."""
        settings = settings_of(shown_ocean(context))
        try:
            parameters = settings.to_parameters(context.scene)
            user_presets.save(Preset(self.title.strip(), self.text.strip(), parameters), self.replace)
        except _ERRORS as error:
            return refuse(self, error)
        settings.preset = self.title.strip()
        self.report({"INFO"}, translated("Preset {title} saved").format(title=self.title.strip()))
        return {"FINISHED"}


class _OfOwnPreset:
    """Operators on one of the user's own presets."""

    def _missing(self) -> set[str] | None:
        if self.key in user_presets.own_presets():
            return None
        return refuse(self, f"You have no preset with the key {self.key!r}")


class OCEAN_OT_rename_preset(_OfOwnPreset, bpy.types.Operator):
    """Give a preset of your own another name."""

    bl_idname = "ocean.rename_preset"
    bl_description = "Rename one of your own presets"
    bl_label = "Rename Preset"
    bl_options = {"REGISTER"}
    bl_property = "title"

    key: StringProperty(name="Preset", options={"SKIP_SAVE", "HIDDEN"})
    title: StringProperty(name="Name", maxlen=60)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Ask for the name."""
        preset = user_presets.own_presets().get(self.key)
        self.title = preset.title if preset else ""
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, _context: bpy.types.Context) -> set[str]:
        """Rename the file."""
        missing = self._missing()
        if missing:
            return missing
        try:
            user_presets.rename(self.key, self.title.strip())
        except _ERRORS as error:
            return refuse(self, error)
        return {"FINISHED"}


class OCEAN_OT_delete_preset(_OfOwnPreset, bpy.types.Operator):
    """Delete a preset of your own."""

    bl_idname = "ocean.delete_preset"
    bl_description = "Delete one of your own presets; this cannot be undone"
    bl_label = "Delete Preset"
    bl_options = {"REGISTER"}

    key: StringProperty(name="Preset", options={"SKIP_SAVE", "HIDDEN"})

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask whether it is meant."""
        return context.window_manager.invoke_confirm(self, event)

    def execute(self, _context: bpy.types.Context) -> set[str]:
        """Delete the file."""
        missing = self._missing()
        if missing:
            return missing
        try:
            user_presets.delete(self.key)
        except OSError as error:
            return refuse(self, error)
        return {"FINISHED"}


class OCEAN_OT_import_preset(bpy.types.Operator, ImportHelper):
    """Take presets of others into your own."""

    bl_idname = "ocean.import_preset"
    bl_description = "Add a preset from a JSON file to your own; nothing in it is executed"
    bl_label = "Import Preset"
    bl_options = {"REGISTER"}

    filename_ext = ".json"
    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})
    replace: BoolProperty(name="Replace", description="Replace a preset of the same name")

    def execute(self, _context: bpy.types.Context) -> set[str]:
        """Read the file as a whole, then keep it."""
        try:
            preset = user_presets.read_preset(Path(self.filepath))
            user_presets.save(preset, self.replace)
        except _ERRORS as error:
            return refuse(self, error)
        self.report({"INFO"}, translated("Preset {title} imported").format(title=preset.title))
        return {"FINISHED"}


class OCEAN_OT_export_preset(bpy.types.Operator, ExportHelper):
    """Write a preset to a file."""

    bl_idname = "ocean.export_preset"
    bl_description = "Write a preset to a JSON file, for others to import"
    bl_label = "Export Preset"
    bl_options = {"REGISTER"}

    filename_ext = ".json"
    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})
    key: StringProperty(name="Preset", options={"SKIP_SAVE", "HIDDEN"})

    def execute(self, _context: bpy.types.Context) -> set[str]:
        """Write the file."""
        presets = user_presets.all_presets()
        if self.key not in presets:
            return refuse(self, f"There is no preset {self.key!r}")
        try:
            write_text(Path(self.filepath), presets[self.key].to_json())
        except OSError as error:
            return refuse(self, error)
        self.report({"INFO"}, translated("Preset written to {file}").format(file=self.filepath))
        return {"FINISHED"}


class OCEAN_MT_presets(bpy.types.Menu):
    """Presets, and what can be done with one's own."""

    bl_idname = "OCEAN_MT_presets"
    bl_label = "Presets"
    bl_description = "Seas by name"

    def draw(self, _context: bpy.types.Context) -> None:
        """Those that came along, then one's own."""
        presets = user_presets.all_presets()
        for key, preset in presets.items():
            if not user_presets.is_own(key):
                self.layout.operator(OCEAN_OT_apply_preset.bl_idname, text=preset.title).key = key
        own = {key: preset for key, preset in presets.items() if user_presets.is_own(key)}
        if own:
            self.layout.separator()
        for key, preset in own.items():
            self.layout.operator(OCEAN_OT_apply_preset.bl_idname, text=preset.title, icon="USER").key = key
        self.layout.separator()
        self.layout.operator(OCEAN_OT_save_preset.bl_idname, icon="ADD")
        self.layout.operator(OCEAN_OT_import_preset.bl_idname, icon="IMPORT")
        if own:
            self.layout.menu(OCEAN_MT_own_presets.bl_idname, icon="PREFERENCES")


class OCEAN_MT_own_presets(bpy.types.Menu):
    """One's own presets, to be changed."""

    bl_idname = "OCEAN_MT_own_presets"
    bl_label = "Manage Presets"

    def draw(self, _context: bpy.types.Context) -> None:
        """Three entries for each."""
        for index, (key, preset) in enumerate(user_presets.own_presets().items()):
            if index:
                self.layout.separator()
            for operator, verb, icon in (
                (OCEAN_OT_rename_preset, "Rename", "GREASEPENCIL"),
                (OCEAN_OT_export_preset, "Export", "EXPORT"),
                (OCEAN_OT_delete_preset, "Delete", "TRASH"),
            ):
                # otherwise Blender would run rename and delete without asking
                self.layout.operator_context = "INVOKE_DEFAULT"
                text = f"{verb} {preset.title}"
                self.layout.operator(operator.bl_idname, text=text, icon=icon).key = key


CLASSES = (
    OCEAN_OT_apply_preset,
    OCEAN_OT_save_preset,
    OCEAN_OT_rename_preset,
    OCEAN_OT_delete_preset,
    OCEAN_OT_import_preset,
    OCEAN_OT_export_preset,
    OCEAN_MT_presets,
    OCEAN_MT_own_presets,
)
