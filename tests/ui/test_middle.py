# SPDX-License-Identifier: GPL-3.0-or-later
"""The middle of an ocean stays where it is while its size is dragged, typed, matched or a preset's."""

import pytest

MIDDLE = (
    "[round(part + 0.5 * ocean().domain_size, 2) for part in ocean().id_data.matrix_world.translation[:2]]"
)
SIZE = "ocean().domain_size"
CORNER = "list(ocean().id_data.location)"


@pytest.fixture
def added(hand):
    """The default sea, around the world's origin."""
    hand.ask(
        "run(\"with over('WINDOW'): bpy.ops.object.select_all(action='SELECT'); bpy.ops.object.delete()\")"
    )
    hand.press("mesh.ocean_tweak_add")
    hand.wait("len(oceans())", 1)
    hand.ask("setattr(ocean(), 'viewport_resolution', 32)")
    hand.wait(MIDDLE, [0.0, 0.0])
    hand.wait("is_refining()", False)
    return hand


def undone_and_redone(hand, size, place):
    """One step takes size and place back, one step brings both again."""
    after = hand.ask(SIZE), hand.ask(CORNER)
    hand.to_viewport()
    hand.key("ctrl+z")
    hand.wait(SIZE, pytest.approx(size))
    assert hand.ask(CORNER) == pytest.approx(place)
    hand.key("ctrl+shift+z")
    hand.wait(SIZE, pytest.approx(after[0]))
    assert hand.ask(CORNER) == pytest.approx(after[1])


def test_a_dragged_size_grows_around_the_middle(added):
    added.keep("middle-before")
    before = added.ask(SIZE), added.ask(CORNER)
    added.drag("domain_size", right=120)
    added.wait(SIZE, lambda size: size > before[0] + 20.0)
    added.wait(MIDDLE, [0.0, 0.0])
    added.keep("middle-dragged")
    undone_and_redone(added, *before)
    added.wait(MIDDLE, [0.0, 0.0])


def test_a_typed_size_too(added):
    before = added.ask(SIZE), added.ask(CORNER)
    added.enter("domain_size", "123")
    added.wait(SIZE, 123.0)
    added.wait(MIDDLE, [0.0, 0.0])
    undone_and_redone(added, *before)


def test_match_keeps_it(added):
    before = added.ask(SIZE), added.ask(CORNER)
    added.press("ocean.match_sea_state")
    added.settle(4)
    added.key("Return")  # the dialog's OK
    added.wait(SIZE, lambda size: size != before[0])
    added.wait(MIDDLE, [0.0, 0.0])
    undone_and_redone(added, *before)


def test_a_preset_keeps_it(added):
    before = added.ask(SIZE), added.ask(CORNER)
    added.open_menu("OCEAN_MT_presets", beside="ocean.match_sea_state")
    added.pick('ocean.apply_preset(key="gale")')
    added.wait(SIZE, lambda size: size != before[0])
    added.wait(MIDDLE, [0.0, 0.0])
    undone_and_redone(added, *before)


def test_a_keyed_location_stays_and_the_panel_says_so(added):
    added.ask("ocean().id_data.keyframe_insert('location', frame=1)")
    before = added.ask(CORNER)
    added.enter("domain_size", "200")
    added.wait(SIZE, 200.0)
    assert added.ask(CORNER) == before
    added.wait("ocean().stays_behind")
    added.keep("middle-keyed")
