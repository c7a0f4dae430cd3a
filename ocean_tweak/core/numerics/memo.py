# SPDX-License-Identifier: GPL-3.0-or-later
"""One memory for all arrays that outlive a call, with a budget in bytes.

What is in it can be made again. It counts as long as anybody has it: an ocean that is in use holds its waves
itself, so that a small budget makes other seas be forgotten, and not this one be made again for each frame.
"""

from __future__ import annotations

import contextlib
import functools
import itertools
import math
import os
import re
import threading
import weakref
from collections import OrderedDict
from collections.abc import Callable, Hashable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any, ParamSpec, TypeVar, cast

from ..data.errors import ParameterError
from .machine import usable_memory

#: the environment variable that sets the budget of a process
VARIABLE = "OCEAN_TWEAK_MEMORY"

#: bytes in a unit of memory, by its name in small letters
UNITS = {"b": 1, "kb": 10**3, "mb": 10**6, "gb": 10**9, "tb": 10**12}

#: bytes that a machine has which does not tell
_UNKNOWN_MACHINE = 8 * 10**9

#: bytes of the least budget
_LEAST = 10**6

#: bytes that a value counts at least: those of the parameters that are its key
_SMALL = 10**4

_Parameters = ParamSpec("_Parameters")
_Value = TypeVar("_Value")
_Name = tuple[str, Hashable]


class Memo:
    """Values by their kind and key; those that were used last, as many as the budget holds, and in any case
    the last of each kind: it is in use.

    A value's `nbytes` are the bytes of its own arrays, without those of other values that it holds.

    budget : bytes, all kinds together; None for OCEAN_TWEAK_MEMORY or else a quarter of the memory that the
        machine, or the container, has
    """

    def __init__(self, budget: int | None = None) -> None:
        self._budget = budget
        self._parts: dict[str, int] = {}
        self._lock = threading.Lock()
        self._clock = itertools.count()
        # those that are kept, by kind and key, the one used last at the end; bytes of each kind; and those
        # that others may still have
        self._kept: dict[str, OrderedDict[Hashable, _Entry]] = {}
        self._bytes: dict[str, int] = {}
        self._dropped: dict[_Name, weakref.ref[Any]] = {}
        self._making: dict[_Name, _Making] = {}

    @property
    def budget(self) -> int:
        """Bytes. Raises ParameterError for an OCEAN_TWEAK_MEMORY that is no size."""
        if self._budget is None:
            self._budget = automatic_budget()
        return self._budget

    @budget.setter
    def budget(self, size: int | None) -> None:
        self._budget = size
        if size is not None:
            self.trim()

    @contextlib.contextmanager
    def at_most(self, size: int) -> Iterator[None]:
        """While this is open, the budget is no larger than some bytes."""
        before, self.budget = self._budget, min(self.budget, size)
        try:
            yield
        finally:
            self._budget = before

    def limit(self, kind: str, part: int) -> None:
        """Let what is quickly made again have no more than one of so many parts of the budget."""
        self._parts[kind] = part

    def get(self, kind: str, key: Hashable, make: Callable[[], _Value]) -> _Value:
        """The value of a key, which is made where it is not there.

        Of several threads that want the same one makes it, and the others wait; `make` may ask for other
        values. What is larger than half the budget is not kept, but found as long as somebody has it. Where
        `make` fails nothing is kept.
        """
        name = (kind, key)
        while True:
            with self._lock:
                found = self._found(name)
                if found is not None:
                    return cast(_Value, found)
                making = self._making.get(name)
                if making is None:
                    making = self._making[name] = _Making()
                    break
            making.wait(kind)
        try:
            value = make()
            self._keep(name, value, most=self.budget // 2)
            return value
        finally:
            with self._lock:
                del self._making[name]
            making.done.set()

    def put(self, kind: str, key: Hashable, value: object) -> None:
        """Keep a value whatever its size, instead of that which the key had; or count one that has grown."""
        self._keep((kind, key), value)

    def _keep(self, name: _Name, value: object, most: float = math.inf) -> None:
        budget, (kind, key) = self.budget, name
        with self._lock:
            self._remove(name)
            entry = _Entry(value, _size(value), next(self._clock))
            self._kept.setdefault(kind, OrderedDict())[key] = entry
            self._bytes[kind] = self._bytes.get(kind, 0) + entry.size
            if entry.size > most:
                self._drop(name)
            self._trim(budget)

    def find(self, kind: str, key: Hashable) -> Any:
        """The value of a key; None where there is none."""
        with self._lock:
            return self._found((kind, key))

    def take(self, kind: str, key: Hashable) -> Any:
        """The value of a key, for the caller alone until it is put back; None where there is none."""
        with self._lock:
            return self._remove((kind, key))

    def watch(self, kind: str, value: object) -> None:
        """Count a value that somebody else keeps, for as long as that is."""
        with self._lock:
            self._dropped[kind, id(value)] = weakref.ref(value)

    def trim(self) -> None:
        """Drop what was used least lately until the rest fits: a value that is watched has grown."""
        budget = self.budget
        with self._lock:
            self._trim(budget)

    def drop(self, kind: str | None = None) -> None:
        """Forget all values, or those of a kind."""
        with self._lock:
            for each in [kind] if kind is not None else [*self._kept]:
                self._kept.pop(each, None)
                self._bytes.pop(each, None)
            for name in [name for name in self._dropped if kind in (None, name[0])]:
                del self._dropped[name]

    def report(self) -> dict[str, int]:
        """Bytes by kind, the largest first."""
        with self._lock:
            total = self._held()
            for kind, size in self._bytes.items():
                total[kind] = total.get(kind, 0) + size
        return {kind: size for kind, size in sorted(total.items(), key=lambda entry: -entry[1]) if size}

    def _found(self, name: _Name) -> Any:
        entries = self._kept.get(name[0])
        if entries is not None and name[1] in entries:
            entries.move_to_end(name[1])
            entries[name[1]].used = next(self._clock)
            return entries[name[1]].value
        dropped = self._dropped.get(name)
        return None if dropped is None else dropped()

    def _held(self) -> dict[str, int]:
        """Bytes by kind of what is not kept, but others have."""
        total: dict[str, int] = {}
        for name, dropped in list(self._dropped.items()):
            value = dropped()
            if value is None:
                del self._dropped[name]
            else:
                total[name[0]] = total.get(name[0], 0) + _size(value)
        return total

    def _trim(self, budget: int) -> None:
        for kind, part in self._parts.items():
            self._fit(budget // part, kind)
        self._fit(budget)

    def _fit(self, most: int, kind: str | None = None) -> None:
        """Drop what was used least lately, of a kind or of all, until what is alive of it takes no more."""
        while self._total(kind) > most:
            kinds = [each for each in self._kept if kind in (None, each) and len(self._kept[each]) > 1]
            if not kinds:
                return
            oldest = min(kinds, key=lambda each: next(iter(self._kept[each].values())).used)
            self._drop((oldest, next(iter(self._kept[oldest]))))

    def _total(self, kind: str | None) -> int:
        parts = (self._bytes, self._held())
        return sum(size for part in parts for each, size in part.items() if kind in (None, each))

    def _drop(self, name: _Name) -> None:
        value = self._remove(name)
        with contextlib.suppress(TypeError):  # numbers cannot be referred to weakly
            self._dropped[name] = weakref.ref(value)

    def _remove(self, name: _Name) -> Any:
        """Forget a value; returns it."""
        self._dropped.pop(name, None)
        entry = self._kept.get(name[0], OrderedDict()).pop(name[1], None)
        if entry is None:
            return None
        self._bytes[name[0]] -= entry.size
        return entry.value


@dataclass
class _Entry:
    """A value that is kept, its bytes, and when it was used last."""

    value: Any
    size: int
    used: int


def _size(value: Any) -> int:
    # whether it tells, its class says: to ask the value itself would take an error in telling for a no
    return max(int(value.nbytes), _SMALL) if hasattr(type(value), "nbytes") else _SMALL


class _Making:
    """That a thread makes a value."""

    def __init__(self) -> None:
        self.done = threading.Event()
        self._thread = threading.get_ident()

    def wait(self, kind: str) -> None:
        """Until it is made, or has failed."""
        if self._thread == threading.get_ident():
            raise RuntimeError(f"{kind}: to make one asks for the same one")
        self.done.wait()


#: the memory of this process
MEMO = Memo()


def remembered(kind: str) -> Callable[[Callable[_Parameters, _Value]], Callable[_Parameters, _Value]]:
    """A function whose results are in the memory of this process, by its arguments."""

    def with_memory(function: Callable[_Parameters, _Value]) -> Callable[_Parameters, _Value]:
        @functools.wraps(function)
        def ask(*arguments: _Parameters.args, **named: _Parameters.kwargs) -> _Value:
            key = (arguments, *named.items())
            return MEMO.get(kind, key, lambda: function(*arguments, **named))

        return ask

    return with_memory


def automatic_budget() -> int:
    """Bytes: OCEAN_TWEAK_MEMORY, or else a quarter of the machine. Raises ParameterError for no size."""
    text = os.environ.get(VARIABLE, "").strip()
    if not text:
        return (usable_memory() or _UNKNOWN_MACHINE) // 4
    size = bytes_in(text)
    if size is None or size < _LEAST:
        raise ParameterError(
            VARIABLE, text,
            "must be a size of 1MB or more with its unit, such as 8GB; without it a quarter of the machine's "
            "memory is used",
        )  # fmt: skip
    return size


def bytes_in(text: str) -> int | None:
    """Bytes that a text such as 8GB or 1.5 MB tells; None where it tells none."""
    match = re.fullmatch(r"(\d+(?:\.\d*)?|\.\d+)\s*([a-z]+)", text.strip(), re.IGNORECASE)
    if match is None or match[2].lower() not in UNITS:
        return None
    return round(float(match[1]) * UNITS[match[2].lower()])


def total_bytes(arrays: Iterable[Any]) -> int:
    """Bytes of some arrays, or of what says how many its arrays take; those that are None have none."""
    return sum(array.nbytes for array in arrays if array is not None)
