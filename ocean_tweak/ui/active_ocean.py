# SPDX-License-Identifier: GPL-3.0-or-later
"""What operators on the active ocean share."""

from collections.abc import Sized

import bpy

from ..core.data.printable import LONGEST, printable
from ..scene.settings import OceanSettings, is_ocean


class OfActiveOcean:
    """Operators that act on the active object."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """An ocean is active, and it is this file's own."""
        item = context.active_object
        if not is_ocean(item):
            cls.poll_message_set("Select an ocean first")
            return False
        if item.library is not None:
            cls.poll_message_set("The ocean is linked from another file: make it local or override it")
            return False
        return True


class OfOwnList(OfActiveOcean):
    """Operators that change a list of the ocean as a whole, which a library override keeps.

    kept : what is said then
    """

    kept: str

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """The list can be changed."""
        if not super().poll(context):
            return False
        if context.active_object.override_library:
            cls.poll_message_set(cls.kept)
            return False
        return True


def nearest(index: int, entries: Sized) -> int:
    """The number of the entry that an index into a list means, 0 for none: files and scripts may hold one
    beyond its ends."""
    return max(0, min(index, len(entries) - 1))


def active_layer(settings: OceanSettings) -> bpy.types.PropertyGroup | None:
    """The layer that is active in the list, if there is any."""
    return settings.layers[nearest(settings.active_layer, settings.layers)] if settings.layers else None


def refuse(operator: bpy.types.Operator, error: BaseException | str) -> set[str]:
    """Report what is wrong, and end the operator without a change."""
    missing = "Not enough memory for this sea" if isinstance(error, MemoryError) else type(error).__name__
    text = (
        f"{error.filename}: {error.strerror}" if isinstance(error, OSError) and error.filename else str(error)
    )
    operator.report({"ERROR"}, printable(text, LONGEST) or missing)
    return {"CANCELLED"}
