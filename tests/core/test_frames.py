# SPDX-License-Identifier: GPL-3.0-or-later
"""Frame numbers and their ranges."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ocean_tweak.core import ParameterError
from ocean_tweak.core.data.frames import Frame, as_frame, format_frames, frame_label, held_frame, parse_frames

frames = st.one_of(
    st.integers(-20_000, 20_000),
    st.integers(-(10**9), 10**9).map(lambda millionths: as_frame(Fraction(millionths, 10**6))),
)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1-4", (1, 2, 3, 4)),
        ("7", (7,)),
        ("1-10x4", (1, 5, 9)),
        ("1001,1005-1007", (1001, 1005, 1006, 1007)),
        ("3,1-3", (1, 2, 3)),
        ("-2-1", (-2, -1, 0, 1)),
        ("-5--3", (-5, -4, -3)),
        ("99999-100000", (99999, 100000)),
        ("1-2x0.25", (1, Fraction(5, 4), Fraction(3, 2), Fraction(7, 4), 2)),
        ("-0.5", (Fraction(-1, 2),)),
    ],
)
def test_frame_ranges(text: str, expected: tuple[Frame, ...]) -> None:
    assert parse_frames(text) == expected
    assert [type(frame) for frame in parse_frames(text)] == [type(frame) for frame in expected]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "a",
        "1-",
        "4-1",
        "1-5x0",
        "1..5",
        "1-2000000",
        "1,,2",
        "1.1234567",
        "1e3",
        "9999999999",
        "9" * 5000,
        "1-600000,1-600000",
    ],
)
def test_frame_ranges_that_are_none(text: str) -> None:
    with pytest.raises(ParameterError, match="frames"):
        parse_frames(text)


def test_frames_of_all_parts_are_counted_before_any_is_made(monkeypatch: pytest.MonkeyPatch) -> None:
    def made(*_: object) -> None:
        raise AssertionError("frames were made")

    monkeypatch.setattr("ocean_tweak.core.data.frames._series", made)
    with pytest.raises(ParameterError, match="at most 1000000 frames"):
        parse_frames("1-600000,1-600000")
    monkeypatch.setattr("ocean_tweak.core.data.frames._series", lambda *_: ())
    assert parse_frames("1-600000,600001-1000000") == ()


@pytest.mark.parametrize(
    ("frame", "label"),
    [
        (7, "0007"), (-7, "-007"), (12345, "12345"), (-12345, "-12345"), (0, "0000"),
        (Fraction("1001.25"), "1001.25"), (Fraction("-0.5"), "-000.5"), (Fraction("0.000001"), "0000.000001"),
    ],
)  # fmt: skip
def test_labels(frame: Frame, label: str) -> None:
    assert frame_label(frame) == label


def test_a_frame_without_decimals_is_refused() -> None:
    with pytest.raises(ParameterError, match="six decimals"):
        frame_label(Fraction(1, 3))


@given(st.sets(frames, max_size=40))
def test_what_is_formatted_is_parsed(chosen: set[Frame]) -> None:
    text = format_frames(chosen)
    assert (parse_frames(text) if text else ()) == tuple(sorted(chosen))


@given(frames, frames)
def test_labels_are_told_apart_and_parsed(one: Frame, other: Frame) -> None:
    assert (frame_label(one) == frame_label(other)) == (one == other)
    assert parse_frames(frame_label(one)) == (one,)


@pytest.mark.parametrize(
    ("text", "with_steps", "without"),
    [
        ("1,3,5,7,9,12", "1-9x2,12", "1,3,5,7,9,12"),
        ("1-10,50-60", "1-10,50-60", "1-10,50-60"),
        ("1,3", "1,3", "1,3"),
        ("-8,-4,0,1,2", "-8-0x4,1-2", "-8,-4,0-2"),
    ],
)
def test_steps_are_told_to_those_who_know_them(text: str, with_steps: str, without: str) -> None:
    frames = parse_frames(text)
    assert format_frames(frames) == with_steps
    assert format_frames(frames, ":") == with_steps.replace("x", ":")
    assert format_frames(frames, "") == without


def test_a_frame_that_is_not_there_shows_the_one_before() -> None:
    frames = (-3, 1, 3, 12)
    assert [held_frame(frames, frame) for frame in (-9, -3, 0, 1, 2, 3, 11, 12, 99)] == [
        -3, -3, -3, 1, 1, 3, 3, 12, 12,
    ]  # fmt: skip
