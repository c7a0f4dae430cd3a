# SPDX-License-Identifier: GPL-3.0-or-later
"""The window stays alive while a value is dragged: how long Blender's own thread is inside the extension.

Work is counted, not the clock: the drawing of this display is a processor's, and others use the machine too.
"""

LONGEST_STAY = 0.2  # s


def test_nothing_blocks_the_window_while_a_value_is_dragged(hand):
    hand.press("mesh.ocean_tweak_add")
    hand.wait("len(oceans())", 1)
    hand.ask("run('ocean().viewport_resolution = 512')")
    hand.wait("len(evaluated_ocean().vertices)", 513**2)
    # work takes longer too where others fill the processor's caches: the quietest of some drags counts
    longest = []
    for right in (90, -60, 60):
        stays, gap = watched_drag(hand, right)
        said = ", ".join(f"{name} {1e3 * work:.0f} ms ({1e3 * clock:.0f})" for work, clock, name in stays[:5])
        print(f"{len(stays)} stays, the longest, by the clock in brackets: {said}; "
              f"{1e3 * gap:.0f} ms between two rounds of events at most")  # fmt: skip
        assert {name for _, _, name in stays} >= {"_limited.<locals>.limited", "go_on"}, "nothing was seen"
        longest.append(stays[0][0])
        if longest[-1] < LONGEST_STAY:
            break
    assert min(longest) < LONGEST_STAY


def watched_drag(hand, right):
    """Pull the wind's number; return what the clock has seen until all samples, foam and statistics stand."""
    before = hand.ask("ocean().layers[0].wind_speed")
    place = hand.find("layers[0].wind_speed")
    hand.ask("clock.start()")
    hand.drag_from(*place, right, steps=9)
    hand.wait("is_refining()", False)
    seen = hand.ask("clock.stop()")
    assert hand.ask("ocean().layers[0].wind_speed") != before
    return seen
