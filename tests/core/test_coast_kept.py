# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of waves over a bed that are kept, and found again by all that they follow from."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from ocean_tweak.core import Ocean, OceanParameters, Places, Water
from ocean_tweak.core.numerics.memo import MEMO
from ocean_tweak.core.sea import coast_pictures, coast_waves
from tests.coasts import BEACH, DEEP, sea


class Kept:
    """A shelf in memory."""

    def __init__(self) -> None:
        self.held: dict[str, tuple[np.ndarray, ...]] = {}

    def find(self, name: str) -> tuple[np.ndarray, ...] | None:
        return self.held.get(name)

    def keep(self, name: str, arrays: tuple[np.ndarray, ...]) -> None:
        self.held[name] = arrays


@pytest.fixture
def shelf(monkeypatch: pytest.MonkeyPatch) -> Iterator[Kept]:
    kept = Kept()
    monkeypatch.setattr(MEMO, "shelf", kept)
    MEMO.drop()
    yield kept
    MEMO.drop()  # what was made of changed pictures


def shown(parameters: OceanParameters) -> np.ndarray:
    x, y = np.meshgrid(np.arange(0.0, 180.0, 9.0), np.arange(0.0, 200.0, 20.0))
    return Ocean(parameters).surface(3.0, on=Places(x, y)).displacement


def test_pictures_that_are_kept_are_the_sea_s_and_are_not_made_again(
    shelf: Kept, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[float] = []
    made = Ocean(sea())
    made.prepare(told.append)
    assert told == sorted(told)
    assert told[-1] == 1.0
    assert len(told) > 20
    expected = shown(sea())
    MEMO.drop()
    monkeypatch.setattr(coast_waves, "pictures", lambda *_: pytest.fail("they were made again"))
    assert_array_equal(shown(sea()), expected)
    # it is these that are shown
    (name,) = shelf.held
    numbers, elevation, potential = shelf.held[name]
    shelf.held[name] = numbers, 2.0 * elevation, potential
    MEMO.drop()
    assert np.abs(shown(sea()) - expected).max() > 0.1


@pytest.mark.parametrize(
    "other",
    [
        {"rim": 41.0}, {"breaking": False}, {"mirror": 0.5}, {"step": 3.0},
        {"shortest_wavelength": 40.0}, {"bed": BEACH + 0.1},
        {"x": 2.0}, {"shore": "-X", "bed": BEACH[:, ::-1]},
    ],
)  # fmt: skip
def test_pictures_are_kept_apart_by_all_that_they_follow_from(shelf: Kept, other: dict[str, object]) -> None:
    assert len(fingerprints(sea(), sea(**other))) == 2


def test_pictures_of_other_waves_are_kept_apart(shelf: Kept) -> None:
    first = sea()
    others = [
        first.replace(**change)
        for change in (
            {"seed": 4}, {"water": Water(depth=21.0)}, {"water": Water(depth=DEEP, gravity=9.8)},
            {"layers": (replace(first.layers[0], wind_speed=11.1),)}, {"loop_duration": 64},
            {"orbital_motion": "FINITE_DEPTH"},
        )
    ]  # fmt: skip
    assert len(fingerprints(first, *others)) == 1 + len(others)
    # what acts after the waves are drawn
    assert fingerprints(first, first.replace(choppiness=0.3)) == fingerprints(first)


def fingerprints(*seas: OceanParameters) -> set[str]:
    coasts = [Ocean(each).coast for each in seas]
    return {
        coast_pictures.fingerprint(each, coast.incoming, coast.ground)
        for each, coast in zip(seas, coasts, strict=True)
        if coast is not None
    }
