# SPDX-License-Identifier: GPL-3.0-or-later
"""Mouse and keyboard on a Blender window, and the eye that finds a button by what it does.

A button is named by a part of what `in_blender.under_mouse` says of it: the path of its property
("layers[0].wind_speed") or its operator's Python command ("ocean.add_scene(mood='CALM'"). Never by its place.
"""

import time

from PIL import Image

# pixels at 100 %: half a button; a button; how far apart rows are looked at, so that none is missed
STEP, BUTTON, ROW = 10, 20, 14
# where buttons of a row are looked for, as a share of the region's width without its tabs
ACROSS = (0.62, 0.3, 0.9)
SWITCH = 0.18  # and the one in a panel's header
TABS = 26
# keycodes: of each F key's symbol xdotool takes one that Blender does not know
FUNCTION_KEYS = {"F3": "69", "F12": "96"}
DEADLINE = 60.0  # s: a software renderer on a busy machine


class NotFound(AssertionError):
    """No button like this is in the region."""


class Hand:
    def __init__(self, display, window, pictures):
        self._display, self._window, self._pictures = display, window, pictures
        self._hints = {}
        self.kept = []

    # --- Blender's data

    def ask(self, expression):
        """An expression's value inside Blender, after all events up to now."""
        return self._window.ask(expression)

    def settle(self, rounds=2):
        """Let Blender go through some rounds of events and drawing."""
        for _ in range(rounds):
            self.ask("None")

    def wait(self, expression, expected=True, seconds=DEADLINE):
        """Wait until an expression inside Blender is what it should be; return its value.

        expected : the value, or a function that accepts it
        """
        accepts = expected if callable(expected) else lambda value: value == expected
        deadline = time.monotonic() + seconds
        while not accepts(value := self.ask(expression)):
            wanted = "as it should be" if callable(expected) else repr(expected)
            assert time.monotonic() < deadline, f"{expression} is {value!r} after {seconds} s, not {wanted}"
            time.sleep(0.02)
        return value

    # --- mouse and keyboard

    def move(self, x, y):
        self._display.do(f"mousemove {round(x)} {round(y)}")

    def click(self, x, y):
        self.move(x, y)
        self.settle(1)
        self._display.do("click 1")
        self.settle()

    def key(self, *names):
        """Press keys one after another, with their modifiers: "ctrl+a"."""
        for name in names:
            *modifiers, last = name.split("+")
            # Blender asks which modifiers are down when it comes to the key: they are held until it has
            for modifier in modifiers:
                self._display.do(f"keydown {modifier}")
            try:
                self._display.do(f"key {FUNCTION_KEYS.get(last, last)}")
                self.settle()
            finally:
                for modifier in reversed(modifiers):
                    self._display.do(f"keyup {modifier}")
            self.settle(1)

    def type(self, text):
        self._display.do(f"type '{text}'")
        self.settle()

    def drag_from(self, x, y, right, down=0, steps=6):
        """Pull with the left button, a little at a time as a hand does.

        A number takes hold of the pointer and moves it, so that only steps count and not places.
        """
        self.move(x, y)
        self.settle(1)
        self._display.do("mousedown 1")
        self.settle(1)
        done = (0, 0)
        try:
            for step in range(1, steps + 1):
                due = (round(right * step / steps), round(down * step / steps))
                self._display.do(f"mousemove_relative -- {due[0] - done[0]} {due[1] - done[1]}")
                done = due
                self.settle(1)
        finally:
            self._display.do("mouseup 1")
        self.settle()

    def to_viewport(self):
        """Put the mouse where nothing but the 3D view is: keys go to what lies under it."""
        x, y, width, height = self.ask("box('WINDOW')")
        self.move(x + 0.3 * width, y + 0.6 * height)
        self.settle(1)

    # --- buttons

    def find(self, target, across=ACROSS):
        """Put the mouse on a button of the sidebar, scrolling where needed; return where that is.

        Raises NotFound with all that was there.
        """
        seen = {}
        deadline = time.monotonic() + DEADLINE
        while time.monotonic() < deadline:
            place = self._search(target, across, seen)
            if place is None and not any(target in name for name in seen if name):
                break
            if place is None:
                # it was there: a panel that was being drawn hid it for a moment
                self.to_viewport()
                self.still()
                continue
            # pictures and statistics may come late, and move all that is below them
            self.still()
            for aside in (2, -2, 4, -4):
                # a button that was drawn anew under a mouse that rests does not know of it
                self.move(place[0] + aside, place[1])
                self.settle(1)
                if self._is_at(*place, target, seen):
                    self._hints[target] = place
                    return place
            # away and back: a tooltip, or a redraw that was missed, lies over the button
            self.to_viewport()
        raise NotFound(f"no button {target!r} in the sidebar; there are {sorted(filter(None, seen))}")

    def _search(self, target, across, seen):
        hint = self._hints.get(target)
        if hint and self._is_at(*hint, target, seen):
            return hint
        # nearly all buttons are in the first column, so it is looked through as a whole before the next
        for share in across:
            place = self._look(target, share, seen)
            if place is None:
                self._scroll(up=True)
                place = self._look(target, share, seen)
            while place is None and self._scroll():
                place = self._look(target, share, seen)
            if place is not None:
                return place
        return None

    def _look(self, target, share, seen):
        left, top, width, height = self.ask("box()")
        scale = self.ask("bpy.context.preferences.system.ui_scale")
        x = left + share * (width - TABS * scale)
        for y in range(int(top + STEP * scale / 2), int(top + height), round(ROW * scale)):
            if self._is_at(x, y, target, seen):
                inside = y + (BUTTON - ROW) / 2 * scale
                return (x, inside) if self._is_at(x, inside, target, seen) else (x, y)
        return None

    def _is_at(self, x, y, target, seen):
        self.move(x, y)
        # a round later the button that the mouse has left tells of itself no more; where the view behind is
        # slow to draw, the one under the mouse may take another
        self.settle(1)
        name = self.ask("under_mouse()") or self.ask("under_mouse()")
        seen[name] = (x, y)
        return target in name

    def _scroll(self, up=False):
        """Turn the wheel over the sidebar; return whether anything moved."""
        left, top, width, height = self.ask("box()")
        before = self.ask("scrolled()")
        self.move(left + 0.5 * (width - TABS), top + 0.5 * height)
        self.settle(1)
        self._display.do(f"click --repeat {60 if up else 4} --delay 5 {4 if up else 5}")
        self.settle()
        return self.ask("scrolled()") != before

    def press(self, target):
        """Click a button of the sidebar."""
        self.click(*self.find(target))

    def drag(self, target, right, steps=6):
        """Pull a number of the sidebar to the right."""
        self.drag_from(*self.find(target), right, steps=steps)

    def enter(self, target, text):
        """Type a number into a field of the sidebar."""
        self.find(target)
        self._display.do("click --repeat 2 --delay 60 1")
        self.settle()
        self.key("ctrl+a")
        self.type(text)
        self.key("Return")

    def open_sidebar(self, tab="Ocean Tweak"):
        """Show the sidebar of the 3D view, and click its tab."""
        self.to_viewport()
        if self.ask("box()[2]") <= 1:
            self.key("n")
            self.wait("box()[2] > 1")
        left, top, width, height = self.ask("box()")
        scale = self.ask("bpy.context.preferences.system.ui_scale")
        self.wait("region().active_panel_category", lambda name: name != "UNSUPPORTED")
        x = left + width - 0.5 * TABS * scale
        rows = range(int(top + 0.7 * height), int(top), -round(2 * STEP * scale))
        hint = self._hints.get(tab)
        for place in ([hint] if hint else []) + [(x, y) for y in rows]:
            if self.ask("region().active_panel_category") == tab:
                break
            self.click(*place)
            self._hints[tab] = place
        self.wait("region().active_panel_category", tab)

    def widen_sidebar(self, width):
        """Pull the sidebar's edge until it is this wide, in pixels."""
        left, top, before, height = self.ask("box()")
        # Blender holds on to the usual width, so first well away from it
        for wanted in (max(width, before) + 120, width):
            left, top, before, height = self.ask("box()")
            self.drag_from(left, top + 0.8 * height, before - wanted)
        self.wait("box()[2]", lambda now: abs(now - width) <= 6)

    def open_panel(self, switch, name):
        """Open a closed panel whose header has a switch, with A over the header."""
        _, y = self.find(switch, across=(SWITCH,))
        left, _, width, _ = self.ask("box()")
        self.move(left + 0.5 * width, y)
        self.settle()
        self.key("a")
        self.ask(f"drawn.watch({name!r})")
        self.settle()
        self.wait(f"drawn.count({name!r}) > 0")

    def choose(self, target, expression, value):
        """Click along a row of choices until this one is chosen."""
        _, y = self.find(target)
        left, _, width, _ = self.ask("box()")
        places = [x for x in range(int(left), int(left + width), STEP) if self._is_at(x, y, target, {})]
        # the ends of the row and its middle; a click on what is chosen already does nothing
        for x in (places[1], places[-2], places[len(places) // 2]) if len(places) > 2 else places:
            self.click(x, y)
            self.still()
            if self.ask(expression) == value:
                return
        raise NotFound(f"{target!r} has no choice that makes {expression} {value!r}")

    def open_menu(self, name, beside):
        """Click the button of a menu, of which Blender tells nothing, in the rows around another button."""
        x, middle = self.find(beside)
        self.ask(f"drawn.watch({name!r})")
        for distance in range(STEP, 4 * STEP, STEP):
            for y in (middle - distance, middle + distance):
                self.move(x, y)
                if self.ask("under_mouse()"):
                    continue
                self.click(x, y)
                if self.ask(f"drawn.count({name!r})"):
                    return
        raise NotFound(f"no menu {name} beside {beside!r}")

    def pick(self, command, most=40):
        """Go down an open menu to the entry with this Python command, and take it."""
        copied = ""
        for _ in range(most):
            self.ask("setattr(bpy.context.window_manager, 'clipboard', '')")
            self.key("Down", "ctrl+c")
            copied = self.ask("bpy.context.window_manager.clipboard")
            if command in copied:
                self.key("Return")
                return
        raise NotFound(f"no entry {command!r} in the menu; the last one was {copied!r}")

    # --- pictures

    def still(self, seconds=DEADLINE):
        """Wait until the picture does not change any more; return it."""
        deadline = time.monotonic() + seconds
        before = None
        while (picture := self._display.picture()) != before and time.monotonic() < deadline:
            before = picture
            self.settle(3)
        return picture

    def keep(self, name, moving=False):
        """Keep what the window shows as a picture of this name; return it.

        moving : take it now; otherwise when the sea is complete and the picture stands still
        """
        if not moving:
            self.wait("is_refining()", False)
        width, height, pixels = self._display.picture() if moving else self.still()
        picture = Image.frombuffer("RGB", (width, height), pixels, "raw", "BGRX", 0, 1)
        picture.save(self._pictures / f"{name}.png")
        self.kept.append(name)
        return picture
