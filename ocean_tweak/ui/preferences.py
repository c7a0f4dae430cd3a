# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's own preferences."""

import logging
import os

import bpy
from bpy.app.translations import pgettext_rpt as translated
from bpy.props import BoolProperty, EnumProperty, IntProperty

from ..core import ParameterError
from ..core.data.printable import readable_bytes
from ..core.numerics.memo import MEMO, UNITS, VARIABLE
from ..export import logs
from ..export.shelf import use_environment
from ..scene.preferences import preferences, user_folder

_LOG = logging.getLogger(__name__)

_LEVELS = (
    ("ERROR", "Errors", "What failed"),
    ("WARNING", "Warnings", "Also possible problems"),
    ("INFO", "Information", "Also what is done"),
    ("DEBUG", "Details", "Also what is read, for bug reports"),
)


def apply() -> None:
    """Let the console hear, and seas keep, as much as the user chose."""
    chosen = preferences()
    logs.to_console(logging.WARNING if chosen is None else getattr(logging, chosen.log_level))
    is_automatic = chosen is None or chosen.memory_is_automatic or VARIABLE in os.environ
    MEMO.budget = None if is_automatic else chosen.memory * UNITS["mb"]
    try:
        use_environment(user_folder("coasts"))
    except (OSError, ParameterError) as error:
        _LOG.warning("waves over coasts are not kept on disk: %s", error)


class OCEAN_AP_preferences(bpy.types.AddonPreferences):
    """Registration gives it the name that Blender knows the extension by."""

    bl_idname = "ocean_tweak"

    log_level: EnumProperty(
        name="Console",
        description="What the extension writes to the console, in lines that begin with ocean_tweak",
        items=_LEVELS,
        default="WARNING",
        update=lambda _self, _context: apply(),
    )
    write_log: BoolProperty(
        name="Log of Bakes",
        description="Write a log of each bake, with times, beside its folder: vNNN-hash8.log",
    )

    memory_is_automatic: BoolProperty(
        name="Automatic Memory",
        description="Cache seas and their latest surfaces in up to a quarter of the machine's memory",
        default=True,
        update=lambda _self, _context: apply(),
    )
    memory: IntProperty(
        name="Memory (MB)",
        description="Memory limit of the cache for all seas; what was used least recently goes first. A "
        "sea that is shown is kept even if it needs more",
        default=4000, min=10, max=10_000_000, soft_min=500, soft_max=64_000, step=100,
        update=lambda _self, _context: apply(),
    )  # fmt: skip

    def draw(self, _context: bpy.types.Context) -> None:
        """The choices, below each other."""
        column = self.layout.column()
        column.use_property_split = True
        column.prop(self, "log_level")
        column.prop(self, "write_log")
        column.prop(self, "memory_is_automatic")
        own = column.column()
        own.active = not self.memory_is_automatic and VARIABLE not in os.environ
        own.prop(self, "memory")
        for text in _memory_texts():
            column.label(text=text)


def _memory_texts() -> list[str]:
    """How much of the memory is used, and what sets it where that is not the preference."""
    try:
        used, budget = readable_bytes(sum(MEMO.report().values())), readable_bytes(MEMO.budget)
    except ParameterError as error:
        return [str(error)]
    texts = [translated("{} of {} is used").format(used, budget)]
    if VARIABLE in os.environ:
        texts.append(translated("The environment variable {} sets it").format(VARIABLE))
    return texts


CLASSES = (OCEAN_AP_preferences,)
