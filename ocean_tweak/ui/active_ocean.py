# SPDX-License-Identifier: GPL-3.0-or-later
"""The ocean shown in the sidebar, and base classes of operators that change it."""

from collections.abc import Sized

import bpy

from ..core.data.printable import LONGEST, printable
from ..scene.floating import carrier_of, ride_of
from ..scene.portability import known_oceans
from ..scene.settings import OceanSettings, is_ocean


def shown_ocean(context: bpy.types.Context) -> bpy.types.Object | None:
    """The ocean shown in the sidebar and changed by operators; None if the scene has none.

    The pinned one, or the active object, or the one on which the active object floats, or the scene's first
    by name.
    """
    oceans, active = known_oceans(context.scene), context.active_object
    pinned = getattr(context.scene, PINNED)
    if pinned and pinned in (names := [ocean.name for ocean in oceans]):
        return oceans[names.index(pinned)]
    if is_ocean(active):
        return active
    carrier = carrier_of(active) if active is not None else None
    below = ride_of(carrier)[0] if carrier is not None else None
    return below if below in oceans else next(iter(oceans), None)


#: the scene's property with the pinned ocean's name
PINNED = "ocean_tweak_pinned"


class OfActiveOcean:
    """Base class of operators on the ocean shown in the sidebar."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There is an ocean, and it is not linked."""
        item = shown_ocean(context)
        if item is None:
            cls.poll_message_set("There is no ocean in this scene: add one first")
            return False
        if item.library is not None:
            cls.poll_message_set("The ocean is linked from another file: make it local or override it")
            return False
        return True


class OfOwnList(OfActiveOcean):
    """Base class of operators that change a whole list of the ocean, which a library override cannot.

    kept : message for library overrides
    """

    kept: str

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """The list can be changed."""
        if not super().poll(context):
            return False
        if shown_ocean(context).override_library:
            cls.poll_message_set(cls.kept)
            return False
        return True


def nearest(index: int, entries: Sized) -> int:
    """The nearest valid index into a list, 0 for an empty one, as files and scripts may contain invalid
    ones."""
    return max(0, min(index, len(entries) - 1))


def active_layer(settings: OceanSettings) -> bpy.types.PropertyGroup | None:
    """The active layer of the list, if there is any."""
    return settings.layers[nearest(settings.active_layer, settings.layers)] if settings.layers else None


def refuse(operator: bpy.types.Operator, error: BaseException | str) -> set[str]:
    """Report an error and cancel the operator."""
    missing = "Not enough memory for this sea" if isinstance(error, MemoryError) else type(error).__name__
    text = (
        f"{error.filename}: {error.strerror}" if isinstance(error, OSError) and error.filename else str(error)
    )
    operator.report({"ERROR"}, printable(text, LONGEST) or missing)
    return {"CANCELLED"}
