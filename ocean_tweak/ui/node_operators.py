# SPDX-License-Identifier: GPL-3.0-or-later
"""Ocean Sample and Float on Ocean in the Add menu of the geometry node editor."""

import bpy
from bpy.props import EnumProperty

from ..nodes.floating import FLOAT
from ..nodes.sample import SAMPLE
from ..nodes.versioned import node_group

_GROUPS = {"SAMPLE": SAMPLE, "FLOAT": FLOAT}
_TREE = "GeometryNodeTree"


class NODE_OT_ocean_tweak_add_group(bpy.types.Operator):
    """Add a node group that reads an ocean."""

    bl_idname = "node.ocean_tweak_add_group"
    bl_description = "Add a node group that reads an ocean"
    bl_label = "Add Ocean Group"
    bl_options = {"REGISTER", "UNDO"}

    group: EnumProperty(
        name="Group",
        items=(
            ("SAMPLE", SAMPLE.name, "Height, normal, foam and motion of the sea at any position"),
            ("FLOAT", FLOAT.name, "Let instances, or a geometry as a whole, ride the waves"),
        ),
    )

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Tell what the group is for."""
        return cls.bl_rna.properties["group"].enum_items[properties.group].description

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """A geometry node tree is open."""
        space = context.space_data
        if getattr(space, "tree_type", "") != _TREE or space.edit_tree is None:
            cls.poll_message_set("Open a geometry node tree first")
            return False
        return True

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Add it under the pointer, to be moved from there."""
        space = context.space_data
        space.cursor_location_from_region(event.mouse_region_x, event.mouse_region_y)
        result = self.execute(context)
        bpy.ops.node.translate_attach_remove_on_cancel("INVOKE_DEFAULT")
        return result

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add it at the editor's cursor."""
        space = context.space_data
        for other in space.edit_tree.nodes:
            other.select = False
        node = space.edit_tree.nodes.new("GeometryNodeGroup")
        node.node_tree = node_group(_GROUPS[self.group])
        node.location = space.cursor_location
        space.edit_tree.nodes.active = node
        return {"FINISHED"}


def draw_add_menu(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    """Draw the entries in the node editor's Add menu."""
    if context.space_data.tree_type != _TREE:
        return
    self.layout.separator()
    for key, kind in _GROUPS.items():
        operator = self.layout.operator(NODE_OT_ocean_tweak_add_group.bl_idname, text=kind.name)
        operator.group = key


CLASSES = (NODE_OT_ocean_tweak_add_group,)
