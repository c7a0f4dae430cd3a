# SPDX-License-Identifier: GPL-3.0-or-later
"""The arithmetic of the benchmarks, and that their published results are whole. No test asserts a time."""

import dataclasses
import itertools
import json
import re

import pytest

from benchmarks import baking, foam_rows, precision, report, transforms
from benchmarks.__main__ import GROUPS
from benchmarks.measure import Timings, interleaved
from benchmarks.plan import FULL, SMOKE
from benchmarks.rows import Row, ratio_row
from benchmarks.targets import TARGETS, Target


class Clock:
    """Time that passes only in the work itself."""

    def __init__(self):
        self.now = 0.0

    def __call__(self):
        return self.now

    def work(self, *seconds):
        remaining = itertools.cycle(seconds)

        def run():
            self.now += next(remaining)

        return run


def row(**changes):
    values = {"group": "transforms", "name": "a", "value": 1.1, "target": "3 fields"}
    return Row(**{**values, **changes})


def test_sides_take_turns_in_both_directions():
    clock, order = Clock(), []

    def side(name):
        def run():
            order.append(name)
            clock.now += 1.0

        return run

    interleaved({"a": side("a"), "b": side("b")}, 3, clock)
    assert "".join(order) == "aabb" + "ab" + "ba" + "ab"  # first each untimed, and once to see how long


def test_ratio_is_the_median_of_the_rounds():
    clock = Clock()
    # one untimed call and one to see how long, then the rounds
    sides = {"slow": clock.work(9.0, 9.0, 2.0, 8.0, 3.0), "fast": clock.work(9.0, 9.0, 1.0, 2.0, 3.0)}
    timings = interleaved(sides, 3, clock)
    assert timings.ratios("slow", "fast") == [2.0, 4.0, 1.0]
    assert timings.ratio("slow", "fast") == 2.0
    assert timings.quartiles("slow", "fast") == (1.5, 3.0)
    assert timings.median("slow") == 3.0


def test_what_is_too_quick_for_the_clock_is_repeated():
    clock = Clock()
    assert interleaved({"a": clock.work(0.005)}, 2, clock).median("a") == pytest.approx(0.005)
    assert clock.now == pytest.approx(0.005 * (2 + 2 * 4))


def test_how_much_faster_is_the_inverse():
    timings = Timings({"ours": [1.0, 1.0, 1.0], "theirs": [6.0, 5.0, 7.0]})
    assert ratio_row("g", "n", timings, "ours", "theirs").value == pytest.approx(1 / 6)
    faster = ratio_row("g", "n", timings, "ours", "theirs", faster=True)
    assert (faster.value, faster.seconds, faster.reference_seconds) == (6.0, 1.0, 6.0)


def test_free_cores_are_two_where_two_transforms_take_the_time_of_one():
    assert transforms.free_cores(Timings({"numpy": [3.0], "probe": [1.0]}), 3) == 2.0
    assert transforms.free_cores(Timings({"numpy": [1.0], "probe": [2.0]})) == 1.0


def test_ideal_bake_takes_half_of_both():
    timings = Timings({"compute": [1.0], "encode": [3.0], "two workers": [2.2]})
    assert baking._shares(timings) == pytest.approx([1.1])


def test_relative_error_is_of_the_fields_rms():
    import numpy as np

    assert precision.relative_error(np.array([3.0, 4.001]), np.array([3.0, 4.0])) == pytest.approx(2e-4)


@pytest.mark.parametrize(
    ("at_least", "value", "met"),
    [(False, 1.9, True), (False, 2.1, False), (True, 1.9, False), (True, 2.0, True)],
)
def test_limits_have_a_direction(at_least, value, met):
    assert Target("work", 2.0, "×", at_least=at_least).met(value) is met


@pytest.mark.parametrize(
    ("value", "cores", "met"), [(1.6, 2.0, True), (1.2, 2.0, False), (1.2, 1.3, None), (1.2, None, None)]
)
def test_two_workers_are_judged_where_two_cores_are_free(value, cores, met):
    assert row(value=value, free_cores=cores, target="two workers").met is met


def test_rows_survive_json():
    for original in (row(quartiles=(1.0, 1.2), seconds=0.1), row(target=None)):
        assert Row.from_dict(json.loads(json.dumps(original.to_dict()))) == original


def whole_run():
    rows = [row(group=group, name=group, target=None) for group in GROUPS]
    return rows + [row(name=target, target=target) for target in TARGETS]


def test_whole_run_is_accepted():
    report.check(whole_run(), list(GROUPS))


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda rows: [r for r in rows if r.group != "bake"], "no rows for bake"),
        (lambda rows: [r for r in rows if r.target != "growth"], "no rows for growth"),
        (lambda rows: [*rows, rows[0]], "same name"),
        (lambda rows: [*rows, row(name="b", value=float("nan"))], "no measurement"),
        (lambda rows: [*rows, row(name="b", value=0.0)], "no measurement"),
    ],
)
def test_run_with_a_gap_is_refused(spoil, message):
    with pytest.raises(report.IncompleteRun, match=message):
        report.check(spoil(whole_run()), list(GROUPS))


def test_summary_shows_the_worst_of_each_target():
    rows = [row(name=target, target=target, value=TARGETS[target].limit) for target in TARGETS]
    rows.append(row(name="worse", value=1.3))
    first = report.summary(rows)[0]
    assert first[:-1] == (TARGETS["3 fields"].work, "≤ 1.2 × three irfft2", "1.3", "2")
    target = TARGETS["3 fields"]
    assert first[-1] == f"**not met**; the limit: {target.what_limits}. Tried: {target.tried}"
    assert {line[-1] for line in report.summary(rows)[1:]} == {"met"}


def test_document_needs_its_markers(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("nothing", encoding="utf-8")
    with pytest.raises(ValueError, match="markers"):
        report.update_document({}, page)


def test_targets_that_a_plan_leaves_out_need_no_rows():
    without = [row for row in whole_run() if row.target != "baked horizon"]
    assert len(without) < len(whole_run())
    report.check(without, list(GROUPS), SMOKE.left_out)
    with pytest.raises(report.IncompleteRun, match="baked horizon"):
        report.check(without, list(GROUPS), FULL.left_out)


def test_only_what_need_not_grow_may_measure_nothing():
    for target, is_fine in (("baked memory", True), ("baked", False)):
        rows = [dataclasses.replace(row, value=0.0) if row.target == target else row for row in whole_run()]
        if is_fine:
            report.check(rows, list(GROUPS))
        else:
            with pytest.raises(report.IncompleteRun, match="no measurement"):
                report.check(rows, list(GROUPS))


@pytest.fixture
def latest():
    return json.loads(report.LATEST.read_text(encoding="utf-8"))


def test_published_run_is_whole(latest):
    rows = report.rows_of(latest)
    report.check(rows, list(GROUPS))
    timed = [r for r in rows if r.seconds is not None]
    assert timed
    # foam of a frame alone takes seconds a call: three rounds
    assert all(r.repeats >= (3 if r.group == foam_rows.GROUP else 7) for r in timed)


def test_a_missed_target_says_what_limits_it_and_what_was_tried(latest):
    rows = report.rows_of(latest)
    names = {each.target for each in rows if each.target and each.met is False}
    missed = [TARGETS[name] for name in names]
    assert missed
    assert not [target.work for target in missed if not (target.what_limits and target.tried)]


def test_published_run_names_no_folder():
    text = report.LATEST.read_text(encoding="utf-8")
    assert not re.search(r'[\s"(=]/\w|[A-Z]:\\\\', text)


def test_document_shows_the_published_run(latest, tmp_path):
    page = tmp_path / "page.md"
    text = report.DOCUMENT.read_text(encoding="utf-8")
    page.write_text(text, encoding="utf-8")
    report.update_document(latest, page)
    assert page.read_text(encoding="utf-8") == text
    assert report.TABLES.read_text(encoding="utf-8") == report.tables(latest)


def test_smoke_run_is_the_same_run_in_small():
    assert [f.name for f in dataclasses.fields(SMOKE)] == [f.name for f in dataclasses.fields(FULL)]
    assert max(SMOKE.sizes) <= 256
    assert FULL.rounds >= 7
