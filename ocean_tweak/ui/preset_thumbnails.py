# SPDX-License-Identifier: GPL-3.0-or-later
"""The presets as pictures to choose from: a property of the window, not of any file."""

import bpy

from ..scene import user_presets
from ..scene.settings import is_ocean, settings_of
from .previews import PREVIEWS

_NONE = ("NONE", "Custom", "The settings are those of no preset")

# Blender wants the texts of an enumeration's items to be kept alive
_kept: list[tuple[str, str, str, int, int]] = []


def _items(_owner: object, context: bpy.types.Context | None) -> list[tuple[str, str, str, int, int]]:
    # enumerations must not be made while Blender only collects its properties' documentation
    if context is None:
        return [(*_NONE, _custom_icon(), 0)]
    presets = user_presets.all_presets()
    _kept[:] = [(*_NONE, _custom_icon(), 0)] + [
        (key, preset.title, preset.description, PREVIEWS.thumbnail(key), number)
        for number, (key, preset) in enumerate(presets.items(), start=1)
    ]
    return _kept


def _custom_icon() -> int:
    """Blender's own picture of an ocean."""
    icons = bpy.types.UILayout.bl_rna.functions["prop"].parameters["icon"].enum_items
    return int(icons["MOD_OCEAN"].value)


def _chosen(_owner: object) -> int:
    """The preset whose sea the active ocean has."""
    item = bpy.context.active_object
    if not is_ocean(item):
        return 0
    title = settings_of(item).preset
    titles = [preset.title for preset in user_presets.all_presets().values()]
    return titles.index(title) + 1 if title in titles else 0


def _choose(_owner: object, number: int) -> None:
    keys = list(user_presets.all_presets())
    if 0 < number <= len(keys) and bpy.ops.ocean.apply_preset.poll():
        bpy.ops.ocean.apply_preset("EXEC_DEFAULT", True, key=keys[number - 1])


def register() -> None:
    """Give windows the property."""
    bpy.types.WindowManager.ocean_tweak_preset = bpy.props.EnumProperty(
        name="Preset", description="A sea by its name", items=_items, get=_chosen, set=_choose
    )


def unregister() -> None:
    """Take it back, with its pictures."""
    del bpy.types.WindowManager.ocean_tweak_preset
    PREVIEWS.close()
    _kept.clear()
