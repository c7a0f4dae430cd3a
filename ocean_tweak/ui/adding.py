# SPDX-License-Identifier: GPL-3.0-or-later
"""What operators share that add an ocean."""

import bpy


class InObjectMode:
    """Operators that add an object."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Objects are added in Object Mode."""
        cls.poll_message_set("Switch to Object Mode to add an ocean")
        return context.mode == "OBJECT"


def make_active(item: bpy.types.Object, layer: bpy.types.ViewLayer) -> None:
    """Select an object and no other one of a view layer, and make it the active one."""
    layer.update()  # it does not know yet what has just been linked
    for other in tuple(layer.objects.selected):
        other.select_set(False, view_layer=layer)
    # an excluded collection keeps its objects out of the view layer
    if item.name in layer.objects:
        item.select_set(True, view_layer=layer)
        layer.objects.active = item
