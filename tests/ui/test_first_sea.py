# SPDX-License-Identifier: GPL-3.0-or-later
"""The first minutes with the extension, by hand. Every step is seen in Blender's data, kept as a picture,
and taken back with Ctrl-Z."""

WIND = "ocean().layers[0].wind_speed"
DEPTH = "ocean().water.depth"


def undo(hand):
    hand.to_viewport()
    hand.key("ctrl+z")


def redo(hand):
    hand.to_viewport()
    hand.key("ctrl+shift+z")


def add_ocean(hand):
    hand.press("mesh.ocean_tweak_add")
    hand.wait("len(oceans())", 1)


def is_there_again_after_undo(hand, expression, before, after):
    """Ctrl-Z and Ctrl-Shift-Z in the window."""
    undo(hand)
    hand.wait(expression, before)
    redo(hand)
    hand.wait(expression, after)


def test_first_sea(hand):
    hand.keep("tab")

    add_ocean(hand)
    hand.wait("bpy.context.view_layer.objects.active.ocean_tweak.is_ocean")
    hand.keep("ocean-added")
    is_there_again_after_undo(hand, "len(oceans())", 0, 1)

    wind = hand.ask(WIND)
    hand.drag("layers[0].wind_speed", right=120)
    dragged = hand.wait(WIND, lambda speed: speed > wind)
    hand.keep("wind-dragged")
    is_there_again_after_undo(hand, WIND, wind, dragged)

    depth = hand.ask(DEPTH)
    hand.enter("water.depth", "35")
    hand.wait(DEPTH, 35.0)
    hand.keep("depth-typed")
    is_there_again_after_undo(hand, DEPTH, depth, 35.0)


def test_waves_follow_the_wind_at_once(hand):
    add_ocean(hand)
    before = hand.ask("highest()")
    hand.enter("layers[0].wind_speed", "25")
    hand.wait(WIND, 25.0)
    # over the same fetch, wave height grows with the wind's speed (Hasselmann et al. 1973)
    hand.wait("highest()", lambda now: now > 1.4 * before)


def test_seas_are_in_the_add_menu(hand):
    hand.to_viewport()
    hand.key("shift+a")
    hand.type("ocean tweak")
    hand.keep("add-menu")
    hand.key("Return")
    hand.wait("len(oceans())", 1)


def test_seas_are_found_by_f3(hand):
    hand.to_viewport()
    hand.key("F3")
    hand.type("ocean tweak")
    hand.keep("search")
    hand.key("Return")
    hand.wait("len(oceans())", 1)


def test_preset_is_taken_from_the_menu(hand):
    add_ocean(hand)
    before = hand.ask(WIND)
    hand.open_menu("OCEAN_MT_presets", beside="ocean.match_sea_state")
    hand.keep("presets")
    hand.pick('ocean.apply_preset(key="hurricane")')
    hand.keep("preset-taken")
    after = hand.wait(WIND, lambda speed: speed > 30.0)
    is_there_again_after_undo(hand, WIND, before, after)


def test_closed_panels_open(hand):
    add_ocean(hand)
    hand.open_panel("ocean_tweak.use_foam", "OCEAN_PT_foam")
    hand.find("foam.coverage")
    hand.keep("foam")
