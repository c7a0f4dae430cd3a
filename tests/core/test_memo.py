# SPDX-License-Identifier: GPL-3.0-or-later
"""The memory that all seas share, on values whose bytes are known."""

from __future__ import annotations

import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np
import pytest

from ocean_tweak.core import ParameterError
from ocean_tweak.core.numerics import memo
from ocean_tweak.core.numerics.memo import Memo

KB = 100_000


def kilobytes(count: int) -> np.ndarray:
    return np.zeros(count * KB, np.uint8)


@dataclass
class Holder:
    """Holds a value that is in the memory for itself, and some bytes of its own."""

    held: np.ndarray
    nbytes: int = 0
    others: list = field(default_factory=list)


def test_a_value_is_made_once_for_its_kind_and_key() -> None:
    made, store = [], Memo(100 * KB)

    def make(name: str) -> np.ndarray:
        made.append(name)
        return kilobytes(1)

    names = ["a", "b", "a", "b", "a"]
    values = [store.get("waves", name, lambda name=name: make(name)) for name in names]
    assert made == ["a", "b"]
    assert values[0] is values[2]
    assert values[0] is not store.get("foam", "a", lambda: make("another kind's"))


def test_those_used_last_stay_within_the_budget_over_all_kinds() -> None:
    store = Memo(30 * KB)
    for number in range(3):
        store.get(["even", "odd"][number % 2], number, lambda: kilobytes(10))
    store.get("even", 0, lambda: pytest.fail("it is there"))
    store.get("odd", 3, lambda: kilobytes(10))
    assert store.report() == {"even": 20 * KB, "odd": 10 * KB}
    store.get("even", 0, lambda: pytest.fail("it was used before the last"))
    store.get("even", 2, lambda: pytest.fail("it was used before the last"))
    again = []
    store.get("odd", 1, lambda: again.append(1) or kilobytes(10))
    assert again, "the one used least lately is gone"


def test_a_value_over_half_the_budget_is_kept_by_those_who_have_it_alone() -> None:
    store = Memo(30 * KB)
    small = store.get("small", 0, lambda: kilobytes(10))
    large = store.get("large", 0, lambda: kilobytes(16))
    assert store.get("small", 0, lambda: pytest.fail("it need not go")) is small
    assert store.get("large", 0, lambda: pytest.fail("somebody has it")) is large
    assert store.report() == {"large": 16 * KB, "small": 10 * KB}
    del large
    assert store.report() == {"small": 10 * KB}


def test_what_a_value_holds_counts_until_the_value_goes() -> None:
    store = Memo(100 * KB)

    def holder(number: int) -> Holder:
        return Holder(store.get("held", number, lambda: kilobytes(30)), 5 * KB)

    for number in range(3):  # the first one held goes, and then its holder with it
        store.get("holders", number, lambda number=number: holder(number))
    assert store.report() == {"held": 60 * KB, "holders": 10 * KB}
    assert sum(store.report().values()) <= store.budget


def test_a_value_in_use_stays_where_the_budget_is_below_it() -> None:
    store = Memo(10 * KB)
    for _ in range(3):
        in_use = store.get("holders", 0, lambda: Holder(store.get("held", 0, lambda: kilobytes(40)), KB))
        store.get("small", 0, lambda: kilobytes(1))
    assert store.get("holders", 0, lambda: pytest.fail("it is the last of its kind")) is in_use
    assert store.get("held", 0, lambda: pytest.fail("the last one holds it")) is in_use.held
    assert store.report()["held"] == 40 * KB


def test_a_value_that_grows() -> None:
    store = Memo(100 * KB)
    grown = store.get("grown", 0, lambda: Holder(kilobytes(0), 10 * KB))
    for number in range(2):
        store.get("other", number, lambda: kilobytes(20))
    grown.nbytes = 70 * KB
    store.put("grown", 0, grown)
    assert store.report() == {"grown": 70 * KB, "other": 20 * KB}


def test_a_smaller_budget_takes_hold_at_once() -> None:
    store = Memo(100 * KB)
    for number in range(5):
        store.get("waves", number, lambda: kilobytes(20))
    store.budget = 45 * KB
    assert store.report() == {"waves": 40 * KB}


def test_what_fails_is_not_kept_and_tried_again() -> None:
    store = Memo(100 * KB)
    with pytest.raises(MemoryError):
        store.get("waves", 0, lambda: (_ for _ in ()).throw(MemoryError))
    assert store.report() == {}
    assert store.get("waves", 0, lambda: kilobytes(1)).nbytes == KB


def test_a_value_is_made_of_others_of_the_memory() -> None:
    store = Memo(100 * KB)

    def power(number: int) -> np.ndarray:
        if number == 0:
            return kilobytes(1)
        return store.get("powers", number, lambda: np.tile(power(number - 1), 2))

    assert power(3).nbytes == 8 * KB
    assert store.report() == {"powers": 14 * KB}


def test_a_value_that_asks_for_itself_does_not_wait_for_ever() -> None:
    store = Memo(100 * KB)

    def itself() -> np.ndarray:
        return store.get("waves", 0, itself)

    with pytest.raises(RuntimeError, match="waves"):
        itself()


def test_threads_wait_for_their_own_key_alone() -> None:
    store, made = Memo(100 * KB), []
    begun, may_end = threading.Event(), threading.Event()

    def slow() -> np.ndarray:
        made.append("slow")
        begun.set()
        assert may_end.wait(10)
        return kilobytes(1)

    with ThreadPoolExecutor(3) as pool:
        first = pool.submit(store.get, "waves", "slow", slow)
        assert begun.wait(10)
        second = pool.submit(store.get, "waves", "slow", slow)
        other = pool.submit(store.get, "waves", "quick", lambda: kilobytes(2))
        assert other.result(10).nbytes == 2 * KB
        time.sleep(0.05)
        assert not second.done()
        may_end.set()
        assert first.result(10) is second.result(10)
    assert made == ["slow"]


def test_a_thread_that_waited_for_a_failure_makes_it() -> None:
    store = Memo(100 * KB)
    begun, may_fail = threading.Event(), threading.Event()

    def failing() -> np.ndarray:
        begun.set()
        assert may_fail.wait(10)
        raise MemoryError

    with ThreadPoolExecutor(2) as pool:
        first = pool.submit(store.get, "waves", 0, failing)
        assert begun.wait(10)
        second = pool.submit(store.get, "waves", 0, lambda: kilobytes(3))
        may_fail.set()
        assert isinstance(first.exception(10), MemoryError)
        assert second.result(10).nbytes == 3 * KB


def test_numbers_count_with_their_keys() -> None:
    store = Memo(KB)
    for number in range(1000):
        store.get("numbers", number, lambda number=number: 0.5 * number)
    assert store.get("numbers", 999, lambda: pytest.fail("it is there")) == 499.5
    assert 0.5 * KB < sum(store.report().values()) <= KB
    assert store.find("numbers", 0) is None


def test_what_is_taken_is_its_taker_s_alone() -> None:
    store = Memo(100 * KB)
    array = kilobytes(5)
    store.put("workspace", 0, array)
    assert store.take("workspace", 0) is array
    assert store.take("workspace", 0) is None
    assert store.report() == {}
    store.put("workspace", 0, array)
    assert store.report() == {"workspace": 5 * KB}


def test_a_kind_that_is_quickly_made_has_a_part_of_the_budget() -> None:
    store = Memo(80 * KB)
    store.limit("surfaces", 4)
    for number in range(6):
        store.get("waves", number, lambda: kilobytes(5))
        store.get("surfaces", number, lambda: kilobytes(5))
    assert store.report() == {"waves": 30 * KB, "surfaces": 20 * KB}


def test_a_value_that_others_keep_counts_as_long_as_they_do() -> None:
    store = Memo(50 * KB)
    for number in range(4):
        store.get("waves", number, lambda: kilobytes(10))
    watched = Holder(kilobytes(0), 5 * KB)
    store.watch("foam", watched)
    watched.nbytes = 25 * KB
    store.trim()
    assert store.report() == {"foam": 25 * KB, "waves": 20 * KB}
    del watched
    assert store.report() == {"waves": 20 * KB}


def test_a_value_that_fails_to_tell_its_bytes_is_not_taken_for_a_small_one() -> None:
    class Failing:
        @property
        def nbytes(self) -> int:
            return None.bytes  # type: ignore[attr-defined]

    store, failing = Memo(50 * KB), Failing()
    store.watch("foam", failing)
    with pytest.raises(AttributeError, match="bytes"):
        store.report()


def test_one_call_forgets_a_kind_or_all() -> None:
    store = Memo(100 * KB)
    values = {kind: store.get(kind, 0, lambda: kilobytes(1)) for kind in ("waves", "foam")}
    store.drop("foam")
    assert store.report() == {"waves": KB}
    assert store.get("foam", 0, lambda: kilobytes(2)) is not values["foam"]
    store.drop()
    assert store.report() == {}


def test_all_but_a_kind_are_forgotten_those_in_use_elsewhere_too() -> None:
    store = Memo(100 * KB)
    values = {kind: store.get(kind, 0, lambda: kilobytes(1)) for kind in ("waves", "foam", "patterns")}
    held = kilobytes(1)
    store.watch("seas", held)
    store.drop(but=("patterns",))
    assert store.report() == {"patterns": KB}
    assert store.find("patterns", 0) is values["patterns"]


@pytest.mark.parametrize(
    ("text", "size"),
    [("8GB", 8 * 10**9), ("1.5 gb", 1_500_000_000), ("500MB", 5 * 10**8), (" 2000000 B ", 2 * 10**6)],
)
def test_the_environment_s_budget(monkeypatch: pytest.MonkeyPatch, text: str, size: int) -> None:
    monkeypatch.setenv("OCEAN_TWEAK_MEMORY", text)
    assert Memo().budget == size


@pytest.mark.parametrize("text", ["8", "8 bananas", "-1GB", "GB", "1e3MB", "0MB", "900kB", "nanGB"])
def test_a_bad_budget_is_told_in_a_line_with_the_remedy(monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    monkeypatch.setenv("OCEAN_TWEAK_MEMORY", text)
    with pytest.raises(ParameterError) as told:
        Memo().get("waves", 0, lambda: kilobytes(1))
    assert "OCEAN_TWEAK_MEMORY" in str(told.value)
    assert text in str(told.value)
    assert "such as 8GB" in str(told.value)
    assert "\n" not in str(told.value)


def test_a_quarter_of_the_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("OCEAN_TWEAK_MEMORY", raising=False)
    monkeypatch.setattr(memo, "usable_memory", lambda: 32 * 10**9)
    assert Memo().budget == 8 * 10**9
