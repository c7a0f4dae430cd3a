# SPDX-License-Identifier: GPL-3.0-or-later
"""How many rooms of the house a wind passes on its way from the panel to the vertices.

It is set twice, to two speeds that are both new. A function of the package that then takes or gives something
else has it in its hands; a module is passed where one of its functions has it, or calls one that does. So
what only happens on the way, such as a note for the panel, is not counted, and what hands on the object that
holds the wind is. It happens as in a window, which makes statistics and foam later, for displacement alone.
"""

import dataclasses
import sys
import zlib
from collections import Counter

import numpy as np
import pytest

#: the most modules: whoever needs one more adds a room that every value has to pass
MOST = 32


def print_of(value, depth=0):
    """What tells one value from another, where it says something about a sea."""
    if isinstance(value, (bool, int, float, complex, str, bytes, type(None))):
        return value
    if isinstance(value, np.ndarray):
        return value.shape, zlib.crc32(np.ascontiguousarray(value).tobytes())
    if depth < 8 and dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = dataclasses.fields(value)
        return tuple(print_of(getattr(value, field.name, None), depth + 1) for field in fields)
    if depth < 8 and isinstance(value, dict):
        return tuple((print_of(key), print_of(each, depth + 1)) for key, each in value.items())
    if depth < 8 and isinstance(value, (tuple, list)):
        return tuple(print_of(each, depth + 1) for each in value)
    return type(value).__name__


def calls(package, run):
    """What the package's functions took and gave in a call: by module and function, with who waited."""
    found = Counter()

    def of(frame):
        return frame.f_globals.get("__name__", "").partition(f"{package}.")[2]

    def profile(frame, event, argument):
        if event not in ("call", "return") or not of(frame):
            return
        held = print_of(tuple(frame.f_locals.values()) if event == "call" else argument)
        waiting, above = set(), frame
        while above is not None:
            waiting.add(of(above))
            above = above.f_back
        found[frame.f_code.co_qualname, event, held, frozenset(waiting - {""})] += 1

    sys.setprofile(profile)
    try:
        run()
    finally:
        sys.setprofile(None)
    return found


@pytest.fixture
def layer(ocean, extension, monkeypatch):
    """The waves of an ocean that is shown as in a window, once."""
    for name in ("use_foam", "use_normals", "use_velocity"):
        setattr(ocean.ocean_tweak, name, False)
    refinement = extension("scene.refinement")
    monkeypatch.setattr(refinement, "has_window", lambda: True)
    layer = ocean.ocean_tweak.layers[0]
    layer.wind_speed = 8.0
    yield layer
    refinement.forget_all()


def test_a_wind_passes_few_modules(layer, extension):
    package = extension("core").__name__.rpartition(".")[0]
    one, other = (
        calls(package, lambda speed=speed: setattr(layer, "wind_speed", speed)) for speed in (9.0, 9.5)
    )
    passed = sorted({module for _, _, _, waiting in (one - other) + (other - one) for module in waiting})
    assert {"ui.parameter_properties", "scene.refresh", "scene.vertex_attributes"} < set(passed)
    assert len(passed) <= MOST, "\n".join(passed)
