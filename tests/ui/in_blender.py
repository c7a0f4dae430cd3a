# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window and answers what a test asks about it."""

import contextlib
import importlib
import json
import os
import select
import socket
import sys
import threading
import time
import traceback

import bpy
import numpy

# in the path of each file of the installed extension, and in no other
EXTENSION = "/user_default/ocean_tweak/"


class Answers:
    """A line to the test: an expression in, its value out, as JSON."""

    def __init__(self, address):
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.connect(address)
        self._buffer = b""
        self._asked = []

    def tick(self):
        """Answer what was asked before the present round of events, then see what is asked now.

        A question waits for one whole round: by then Blender has handled the events that came before it.
        """
        clock.tick()
        for question in self._asked:
            self._socket.sendall(json.dumps(answer(question)).encode() + b"\n")
        self._asked = []
        while select.select([self._socket], [], [], 0)[0]:
            data = self._socket.recv(65536)
            if not data:
                bpy.ops.wm.quit_blender()  # the test is through, whatever it ended by
            self._buffer += data
        *lines, self._buffer = self._buffer.split(b"\n")
        self._asked = [json.loads(line) for line in lines]
        return 0.0


def answer(expression):
    try:
        return {"value": eval(expression, globals())}
    except Exception:  # noqa: BLE001 - whatever it is, the test shall see it
        return {"error": traceback.format_exc()}


class Clock:
    """How long the window's thread stays in the extension at a time, and away from the window at all."""

    def __init__(self):
        self.stays, self.gaps = [], []
        self._outermost = self._since = self._last_tick = None

    def start(self):
        self.stays, self.gaps, self._outermost, self._last_tick = [], [], None, time.perf_counter()
        sys.setprofile(self._look)

    def stop(self):
        """Return the stays as (s of work, s by the clock, which function), the longest first, and the longest
        time between two rounds of events, s."""
        sys.setprofile(None)
        self._last_tick = None
        return sorted(self.stays, reverse=True), max(self.gaps)

    def tick(self):
        now = time.perf_counter()
        if self._last_tick is not None:
            self.gaps.append(now - self._last_tick)
            self._last_tick = now

    def _look(self, frame, event, _argument):
        if event == "call" and self._outermost is None and EXTENSION in frame.f_code.co_filename:
            self._outermost, self._since = frame, (time.thread_time(), time.perf_counter())
        elif event == "return" and frame is self._outermost:
            work, clock = time.thread_time() - self._since[0], time.perf_counter() - self._since[1]
            self.stays.append((work, clock, frame.f_code.co_qualname))
            self._outermost = None


class Happenings:
    """Which handlers Blender has called since the last look, and whether on the window's own thread."""

    def __init__(self, *names):
        self.seen = []
        for name in names:
            getattr(bpy.app.handlers, name).append(self._noter(name))

    def _noter(self, name):
        def note(*_arguments):
            in_window = threading.current_thread() is threading.main_thread()
            self.seen.append((name, in_window, bpy.context.scene.render.use_lock_interface))

        return bpy.app.handlers.persistent(note)


class Drawn:
    """Which panels and menus were drawn."""

    def __init__(self):
        self._names, self._counts = set(), {}

    def watch(self, name):
        """Begin to count."""
        if name not in self._names:
            self._names.add(name)
            getattr(bpy.types, name).append(lambda *_: self._counts.update({name: self.count(name) + 1}))
        self._counts[name] = 0
        region().tag_redraw()

    def count(self, name):
        return self._counts.get(name, 0)


def run(statements):
    """Execute statements."""
    exec(statements, globals())


def new_file():
    """Open the file that Blender begins with."""
    with over("WINDOW"):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_splash=False, use_empty=False)


def install(zip_file):
    """What Blender does with a zip that is dropped into its window, once that is confirmed."""
    with over("WINDOW"):
        bpy.ops.extensions.package_install_files(
            filepath=zip_file, repo="user_default", enable_on_install=True
        )


def save(path):
    """Save the file as."""
    with over("WINDOW"):
        bpy.ops.wm.save_as_mainfile(filepath=path)


def window():
    return bpy.context.window_manager.windows[0]


def area(kind="VIEW_3D"):
    """The largest area of a kind."""
    areas = [area for area in window().screen.areas if area.type == kind]
    return max(areas, key=lambda area: area.width * area.height)


def region(kind="UI", area_kind="VIEW_3D"):
    return next(region for region in area(area_kind).regions if region.type == kind)


def box(kind="UI", area_kind="VIEW_3D"):
    """x, y (from the top), width and height of a region in the window, in pixels."""
    place = region(kind, area_kind)
    return place.x, window().height - place.y - place.height, place.width, place.height


def scrolled(kind="UI", area_kind="VIEW_3D"):
    """How far a region is scrolled."""
    return region(kind, area_kind).view2d.region_to_view(0, 0)[1]


def over(kind="UI", area_kind="VIEW_3D"):
    return bpy.context.temp_override(window=window(), area=area(area_kind), region=region(kind, area_kind))


def under_mouse(kind="UI", area_kind="VIEW_3D"):
    """What the button under the mouse is: the path of a property, or the Python command of an operator."""
    with over(kind, area_kind):
        found = bpy.context.property
        if found is not None:
            owner, path, index = found
            return f"{owner.name}.{path}" + (f"[{index}]" if index >= 0 else "")
        if not bpy.ops.ui.copy_python_command_button.poll():
            return ""
        bpy.context.window_manager.clipboard = ""
        with contextlib.suppress(RuntimeError):
            bpy.ops.ui.copy_python_command_button()
        return bpy.context.window_manager.clipboard


def extension(name):
    """A module of the installed extension."""
    return importlib.import_module(f"bl_ext.user_default.ocean_tweak.ocean_tweak.{name}")


def oceans():
    """The settings of the oceans, by name."""
    return {item.name: item.ocean_tweak for item in bpy.data.objects if item.ocean_tweak.is_ocean}


def ocean():
    """The settings of the one ocean."""
    (settings,) = oceans().values()
    return settings


def is_refining():
    """Whether the extension has something left to do when there is time."""
    timers = extension("scene.refinement").go_on, extension("ui.previews").draw_spectrum
    return any(map(bpy.app.timers.is_registered, timers))


def evaluated_ocean():
    """The mesh of the one ocean, as the viewport has it."""
    item = next(item for item in bpy.data.objects if item.ocean_tweak.is_ocean)
    return item.evaluated_get(bpy.context.view_layer.depsgraph).data


def highest():
    """Of the water, in Blender units."""
    mesh = evaluated_ocean()
    places = numpy.empty(3 * len(mesh.vertices), numpy.float32)
    mesh.vertices.foreach_get("co", places)
    return float(places[2::3].max())


def baking():
    """The bake of the one ocean, None where there is none."""
    item = next(item for item in bpy.data.objects if item.ocean_tweak.is_ocean)
    return extension("scene.bake_process").running(item)


# each sample of the viewport's anti-aliasing is a drawing of its own
ANTI_ALIASING = "8" if os.environ.get("OCEAN_TWEAK_FINE_PICTURES") else "OFF"


clock, drawn = Clock(), Drawn()
happenings = Happenings("render_init", "render_complete", "render_cancel", "frame_change_pre", "render_post")
bpy.context.preferences.view.show_splash = False
bpy.context.preferences.system.viewport_aa = ANTI_ALIASING
bpy.app.timers.register(Answers(os.environ["OCEAN_TWEAK_ANSWERS"]).tick, persistent=True)
