# SPDX-License-Identifier: GPL-3.0-or-later
"""How many modules a wind passes on its way from the panel to the vertices.

It is set twice, to two speeds that are both new. A function carries it where what it gives back, or what it
fills, is another thing the second time, or where it waits while the vertices are written. A module is passed
where such a function was asked by one module and asks another, which answers with something that carries it
too: there, who follows the value has to read on elsewhere. What is asked, calculates and answers by itself is
a helper and no more on the way than NumPy is; nor is what only gives its asker the word back, as the memory
does, nor what only happens on the way, such as a check of the memory.

It happens as in a window, which makes statistics and foam later, for displacement alone.
"""

import dataclasses
import sys
import types
import zlib
from typing import NamedTuple

import numpy as np
import pytest

#: the most modules: whoever needs one more adds one that every value has to pass
MOST = 15

#: where the value arrives
END = ("scene.vertex_attributes", "write")


class Call(NamedTuple):
    """A call of a function that is written in the package.

    asker : the number of the call that made it; None for Blender
    given : what it gave back, and what it changed of what it was given
    """

    module: str
    function: str
    asker: int | None
    given: object


def print_of(value, package, depth=0):
    """What tells one value from another, also by what it holds."""
    if isinstance(value, (bool, int, float, complex, str, bytes, type(None))):
        return value
    if isinstance(value, np.ndarray):
        return value.shape, zlib.crc32(np.ascontiguousarray(value).tobytes())
    if depth == 8 or isinstance(value, type):
        return type(value).__name__
    if isinstance(value, dict):
        held = [each for pair in value.items() for each in pair]
    elif isinstance(value, (tuple, list)):
        held = value
    elif dataclasses.is_dataclass(value):
        held = [getattr(value, field.name, None) for field in dataclasses.fields(value)]
    elif isinstance(value, types.FunctionType):
        held = [cell.cell_contents for cell in value.__closure__ or ()]
    elif type(value).__module__.startswith(package):
        held = [each for _, each in sorted(vars(value).items())]
    else:
        held = ()
    return type(value).__name__, tuple(print_of(each, package, depth + 1) for each in held)


def calls(package, run):
    """All calls in a run, in order."""
    made, numbers, held = [], {}, {}

    def module_of(frame):
        written = not frame.f_code.co_filename.startswith("<")  # but for what dataclasses write themselves
        return frame.f_globals.get("__name__", "").partition(f"{package}.")[2] if written else ""

    def arguments(frame):
        code = frame.f_code
        names = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
        return [frame.f_locals.get(name) for name in names]

    def prints(values):
        return tuple(print_of(value, package) for value in values)

    def profile(frame, event, result):
        if event not in ("call", "return") or not module_of(frame):
            return
        if event == "call":
            asker = frame.f_back
            while asker is not None and asker not in numbers:
                asker = asker.f_back
            taken = arguments(frame)
            numbers[frame], held[frame] = len(made), (taken, prints(taken))
            made.append(Call(module_of(frame), frame.f_code.co_qualname, numbers.get(asker), None))
        elif frame in numbers:
            number, (taken, before) = numbers.pop(frame), held.pop(frame)
            filled = tuple(set(prints(taken)).difference(before))
            made[number] = made[number]._replace(given=(print_of(result, package), filled))

    sys.setprofile(profile)
    try:
        run()
    finally:
        sys.setprofile(None)
    return made


def passed(ours, others):
    """The modules that a value passes in one of two runs, and which each was asked by and asks."""
    known = {(call.module, call.function, call.given) for call in others}
    carries = [(call.module, call.function, call.given) not in known for call in ours]
    for call in ours:
        above = call.asker if (call.module, call.function) == END else None
        while above is not None:
            carries[above], above = True, ours[above].asker
    found = {END[0]: set()}
    stays, answers = [], {}
    for number, call in enumerate(ours):
        asker = "" if call.asker is None else ours[call.asker].module
        stays.append(stays[call.asker] if asker == call.module else number)
        if asker not in ("", call.module) and carries[number]:
            answers.setdefault(stays[call.asker], set()).add(call.module)
    for first, asked in answers.items():
        call = ours[first]
        asker = "Blender" if call.asker is None else ours[call.asker].module
        if carries[first] and asked - {asker}:
            found.setdefault(call.module, set()).update({(call.function, asker, *sorted(asked))})
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
    found = passed(one, other).keys() | passed(other, one).keys()
    assert {"ui.parameter_properties", "scene.refresh", "core.sea.ocean", END[0]} < found
    assert len(found) <= MOST, "\n".join(sorted(found))
