# SPDX-License-Identifier: GPL-3.0-or-later
"""What seas keep stays within the budget of the one memory, as Python itself counts the bytes."""

from __future__ import annotations

import gc
import tracemalloc
import weakref
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.core import Foam, Mask, Ocean, OceanParameters, Patch, Timing, WaveLayer, WindFieldLayer
from ocean_tweak.core.numerics.memo import MEMO
from ocean_tweak.core.parameters.shot import Animation, Shot
from ocean_tweak.core.sea.bake import ShotSeas, bake
from ocean_tweak.core.sea.regions import Places

MB = 10**6
PATCHES = (
    Patch(domain_size=200.0, resolution=128, shortest_wavelength=10.0),
    Patch(domain_size=37.0, resolution=128, rotation=0.3, longest_wavelength=10.0),
)
OUTPUTS = {"displacement", "velocity", "cusp", "foam"}


@pytest.fixture
def small_budget() -> Iterator[int]:
    """A budget of a few small seas, and a memory that is empty before and after."""
    before = MEMO.budget
    MEMO.drop()
    MEMO.budget = 4 * MB
    yield MEMO.budget
    MEMO.budget = before
    MEMO.drop()


@pytest.fixture
def no_collector() -> Iterator[None]:
    """What is freed is freed because nobody has it, and not because Python looked for circles."""
    gc.collect()
    gc.disable()
    yield
    gc.enable()


def sea(wind_speed: float = 11.0, **changes: object) -> OceanParameters:
    layer = WaveLayer(wind_speed=wind_speed, fetch=80e3)
    foam = Foam(half_life=0.2, resolution=64)
    values = {"resolution": 128, "domain_size": 200.0, "layers": (layer,), "seed": 4, "foam": foam}
    return OceanParameters(**{**values, **changes})


def kept() -> int:
    return sum(MEMO.report().values())


def test_a_wind_that_changes_over_many_frames(small_budget: int, no_collector: None) -> None:
    frames, speeds = range(1, 21), np.linspace(5.0, 15.0, 20).tolist()
    timing = Timing(fps=24, start_frame=1)
    animation = Animation(1, (("layers.0.wind_speed", tuple(speeds)),))
    surfaces = ShotSeas(Shot(sea(timing=timing), animation))
    tracemalloc.start()
    try:
        surfaces.frame(1, OUTPUTS)
        first = tracemalloc.get_traced_memory()[0]
        for frame in frames:
            surfaces.frame(frame, OUTPUTS)
            assert kept() <= small_budget
        grown = tracemalloc.get_traced_memory()[0] - first
    finally:
        tracemalloc.stop()
    # twenty seas of 128² take twenty times 0.5 MB; what Python holds beside arrays is little
    assert grown < small_budget + MB // 2
    assert MEMO.report()["waves"] > 0.3 * MB, "the last is kept"


class Counting:
    """Keeps no frame, but the bytes that seas keep while it would be written."""

    outputs = frozenset({"displacement"})

    def __init__(self) -> None:
        self.kept: list[int] = []

    def write(self, _frame: object, _fields: object, *_others: object) -> tuple[Path, ...]:
        self.kept.append(kept())
        return ()


def test_a_bake_keeps_no_seas_of_frames_gone_by() -> None:
    MEMO.drop()
    parameters = sea(resolution=256, timing=Timing(fps=24, start_frame=1))
    animation = Animation(1, (("layers.0.wind_speed", tuple(np.linspace(5.0, 15.0, 12).tolist())),))
    budget, sink = MEMO.budget, Counting()
    frames = list(bake(Shot(parameters, animation), range(1, 13), sink))
    assert len(frames) == len(sink.kept) == 12
    # the present sea and those beside it that are made ahead, not twelve
    one = 256 * 129 * 40
    assert max(sink.kept) < 6 * one
    assert MEMO.budget == budget


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"foam": Foam(half_life=0.2)},
        {"trough_damping": 0.5},
        {"layers": (WaveLayer(wind_speed=8.0), WindFieldLayer(wind_speed=6.0))},
        {"merged_resolution": 128, "patches": PATCHES},
        {
            "layers": (
                WaveLayer(wind_speed=9.0, mask=Mask(source="DISTANCE", inner_radius=10.0, outer_radius=60.0)),
            )
        },
    ],
    ids=["plain", "foam as fine", "troughs", "wind field", "merged_resolution", "mask"],
)
def test_a_sea_that_nobody_has_is_gone_at_once(
    small_budget: int, no_collector: None, changes: dict[str, object]
) -> None:
    tracemalloc.start()
    try:
        before = tracemalloc.get_traced_memory()[0]
        ocean = Ocean(sea(**changes))
        for time in (Fraction(0), Fraction(1, 24)):
            ocean.surface(time, OUTPUTS)
            ocean.points_at([3.0], [4.0], time)
        assert len(ocean.patches) == 1
        gone = weakref.ref(ocean)
        del ocean
        assert gone() is None
        MEMO.drop()
        left = tracemalloc.get_traced_memory()[0] - before
    finally:
        tracemalloc.stop()
    assert left < MB // 4, "its waves alone are a third of a megabyte"


def test_all_that_a_sea_keeps_is_counted(no_collector: None) -> None:
    MEMO.drop()
    tracemalloc.start()
    try:
        before = tracemalloc.get_traced_memory()[0]
        oceans = Ocean(sea(foam=Foam(half_life=1.0), trough_damping=0.5)), Ocean(sea(patches=PATCHES))
        oceans[0].surface(1.0, OUTPUTS)
        oceans[1].surface(1.0, OUTPUTS, on=Places([1.0, 2.0], [3.0, 4.0]))
        grown = tracemalloc.get_traced_memory()[0] - before
    finally:
        tracemalloc.stop()
    assert grown > 3 * MB
    assert kept() == pytest.approx(grown, rel=0.1)


def test_a_sea_larger_than_the_budget_is_made_once(
    monkeypatch: pytest.MonkeyPatch, small_budget: int
) -> None:
    from ocean_tweak.core.sea import part_waves

    made = []
    make = part_waves.initial_state
    monkeypatch.setattr(part_waves, "initial_state", lambda *a: made.append(a) or make(*a))
    MEMO.budget = MB // 10
    ocean, expected = Ocean(sea()), {}
    for frame in (1, 2, 3):
        expected[frame] = ocean.frame(frame, {"displacement"}).displacement
    assert len(made) == 1
    MEMO.budget = small_budget
    again = Ocean(sea())
    for frame, field in expected.items():
        np.testing.assert_array_equal(again.frame(frame, {"displacement"}).displacement, field)
