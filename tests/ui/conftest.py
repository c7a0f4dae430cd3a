# SPDX-License-Identifier: GPL-3.0-or-later
"""A real Blender with the installed extension, in a window on a display in memory.

Runs in the environment of the 5.2 wheel; the window's own Blender is told what to do by mouse and keyboard.
"""

import contextlib
import os
import tempfile
from pathlib import Path

import pytest

from tests.ui.hand import Hand
from tools import build, real_blender, run_tests
from tools import window as windows
from tools.project import BUILD

SIZE = (1280, 800)
PICTURES = BUILD / "window"
FAILED = pytest.StashKey()
SCRIPT = Path(__file__).with_name("in_blender.py")


@pytest.fixture(scope="session")
def blender():
    try:
        return real_blender.find()
    except real_blender.NoBlender as reason:
        pytest.skip(f"no real Blender: {reason}")


@pytest.fixture(scope="session")
def environment(blender):
    """A profile with the zip installed: the test run's, or one of its own."""
    if "OCEAN_TWEAK_ZIP" in os.environ:
        return dict(os.environ)
    env = run_tests.test_environment("window")
    run_tests.install(blender, build.build(blender), env)
    return env


@contextlib.contextmanager
def opened_window(blender, environment):
    """Mouse and keyboard on a new Blender with this environment; skips the test where there is no display."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="ocean-window-") as name:
        folder = Path(name)
        try:
            display = windows.Display(blender, folder, SIZE)
        except windows.NoWindow as reason:
            if real_blender.required():
                raise
            pytest.skip(f"no window: {reason}")
        with display, windows.BlenderWindow(blender, display, SCRIPT, folder, environment) as window:
            yield Hand(display, window, PICTURES)


@pytest.fixture(scope="session")
def session_hand(blender, environment):
    with opened_window(blender, environment) as hand:
        yield hand


@pytest.fixture
def hand(session_hand, request):
    """Mouse and keyboard on a new file, with the tab of the extension open."""
    hand = session_hand
    hand.key("Escape")
    hand.ask("run('bpy.context.preferences.view.ui_scale = 1.0')")
    hand.ask("new_file()")
    hand.wait("len(oceans())", 0)
    hand.open_sidebar()
    yield hand
    if request.node.stash.get(FAILED, False):
        hand.keep(f"failed-{request.node.name}", moving=True)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    """Remember a failure, for a last picture of the window."""
    report = yield
    if call.when == "call" and report.failed:
        item.stash[FAILED] = True
    return report
