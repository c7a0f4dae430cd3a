# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar at twice the size and in a narrow region: what matters can be found and moved by hand there."""

import pytest

MAIN_SETTINGS = ("layers[0].wind_speed", "water.depth", "choppiness")


def add_ocean(hand):
    hand.press("mesh.ocean_tweak_add")
    hand.wait("len(oceans())", 1)


@pytest.fixture
def maximised(hand):
    """The 3D view alone: at 200 % it needs the room."""
    hand.to_viewport()
    hand.key("ctrl+space")
    hand.wait("len(window().screen.areas)", 1)
    return hand


def test_settings_can_be_moved_at_200_percent(maximised):
    hand = maximised
    hand.ask("run('bpy.context.preferences.view.ui_scale = 2.0')")
    hand.wait("bpy.context.preferences.system.ui_scale > 1.9")
    hand.wait("box()[2] > 500")
    add_ocean(hand)
    for setting in MAIN_SETTINGS:
        hand.find(setting)
    before = hand.ask("ocean().layers[0].wind_speed")
    hand.drag("layers[0].wind_speed", right=80)
    hand.wait("ocean().layers[0].wind_speed", lambda speed: speed > before)
    hand.keep("scale-200")


def test_settings_can_be_moved_in_a_sidebar_of_300_pixels(hand):
    add_ocean(hand)
    hand.widen_sidebar(300)
    for setting in MAIN_SETTINGS:
        hand.find(setting)
    before = hand.ask("ocean().choppiness")
    hand.enter("choppiness", "0.5")
    hand.wait("ocean().choppiness", 0.5)
    assert before != 0.5
    hand.keep("sidebar-300")
