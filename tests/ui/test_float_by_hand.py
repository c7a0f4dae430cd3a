# SPDX-License-Identifier: GPL-3.0-or-later
"""What floats is moved, copied and deleted in a window, and the sidebar shows the ocean all the while."""

BEGIN = (
    "with over('WINDOW'): bpy.ops.mesh.ocean_tweak_add()\n"
    "ocean().viewport_resolution = 32\n"
    "cube = bpy.data.objects['Cube']\n"
    "for item in bpy.context.scene.objects: item.select_set(item == cube)\n"
    "bpy.context.view_layer.objects.active = cube\n"
    "with over('WINDOW'): bpy.ops.object.ocean_tweak_float()\n"
    "with over('WINDOW'): bpy.ops.ed.undo_push(message='float')"
)
NAMES = "sorted(item.name for item in bpy.context.scene.objects if item.type == 'MESH')"
CARRIERS = "sum(item.get('ocean_tweak_float_part') == 'follower' for item in bpy.data.objects)"


def place(name):
    """x of an object, of where it is shown and of its carrier, in whole units."""
    carrier = f"extension('scene.float_carrier').carrier_of(bpy.data.objects[{name!r}])"
    own = f"bpy.data.objects[{name!r}]"
    return f"[round(x) for x in ({own}.location.x, {own}.matrix_world.translation.x, {carrier}.location.x)]"


def test_it_goes_where_the_hand_puts_it(hand):
    hand.ask(f"run({BEGIN!r})")
    hand.find("layers[0].wind_speed")  # the ocean is at hand, though the cube is selected
    hand.to_viewport()
    hand.key("g", "x")
    hand.type("30")
    hand.key("Return")
    hand.wait(place("Cube"), [30, 30, 30])
    hand.key("shift+d", "x")
    hand.type("20")
    hand.key("Return")
    hand.wait(place("Cube.001"), [50, 50, 50])
    assert hand.ask(place("Cube")) == [30, 30, 30]
    hand.key("Delete")
    hand.wait(NAMES, ["Cube", "Ocean"])
    hand.wait(CARRIERS, 1)
    hand.key("ctrl+z")
    hand.wait(place("Cube.001"), [50, 50, 50])
    hand.key("ctrl+shift+z")
    hand.wait(NAMES, ["Cube", "Ocean"])
    for _ in range(2):
        hand.key("ctrl+z")
    hand.wait(place("Cube"), [30, 30, 30])
    hand.keep("float-by-hand", moving=True)
