# SPDX-License-Identifier: GPL-3.0-or-later
"""One cache for all arrays that outlive a call, with a budget in bytes.

Its contents can be recomputed. A value counts for as long as anything refers to it: an ocean in use holds its
own waves, so a small budget evicts other seas instead of recomputing this one for every frame.
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
from collections.abc import Callable, Container, Hashable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any, ParamSpec, Protocol, TypeVar, cast

from numpy.typing import NDArray

from ..data.errors import ParameterError
from .machine import usable_memory

#: the environment variable that sets the budget of a process
VARIABLE = "OCEAN_TWEAK_MEMORY"

#: bytes in a unit of memory, by its name in small letters
UNITS = {"b": 1, "kb": 10**3, "mb": 10**6, "gb": 10**9, "tb": 10**12}

#: memory assumed for a machine that does not report it, bytes
_UNKNOWN_MACHINE = 8 * 10**9

#: smallest budget, bytes
_LEAST = 10**6

#: smallest size counted for a value, bytes: that of the parameters that are its key
_SMALL = 10**4

_Parameters = ParamSpec("_Parameters")
_Value = TypeVar("_Value")
_Name = tuple[str, Hashable]


class Shelf(Protocol):
    """Where arrays that take long to compute are kept beyond this process."""

    def find(self, name: str, /) -> tuple[NDArray[Any], ...] | None:
        """The arrays of a name, or None. What is there and cannot be used is reported, not raised."""

    def keep(self, name: str, arrays: tuple[NDArray[Any], ...], /) -> None:
        """Keep arrays under a name, if there is room; that there is none is reported, not raised."""


class Memo:
    """Values by kind and key: the most recently used ones that fit the budget, and always the latest of each
    kind, as that is in use.

    A value's `nbytes` is the size of its own arrays, without those of other values that it refers to.

    budget : bytes, all kinds together; None for OCEAN_TWEAK_MEMORY or, if that is not set, a quarter of the
        memory of the machine or container
    shelf : for arrays that take long to compute; None where there is none
    """

    def __init__(self, budget: int | None = None) -> None:
        self._budget = budget
        self.shelf: Shelf | None = None
        self._parts: dict[str, int] = {}
        self._lock = threading.Lock()
        self._clock = itertools.count()
        # cached values by kind and key, the most recently used last; bytes of each kind; and evicted values
        # that may still be in use elsewhere
        self._kept: dict[str, OrderedDict[Hashable, _Entry]] = {}
        self._bytes: dict[str, int] = {}
        self._dropped: dict[_Name, weakref.ref[Any]] = {}
        self._making: dict[_Name, _Making] = {}

    @property
    def budget(self) -> int:
        """The budget in bytes. Raises ParameterError if OCEAN_TWEAK_MEMORY is not a size."""
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
        """Context manager that caps the budget at some number of bytes."""
        before, self.budget = self._budget, min(self.budget, size)
        try:
            yield
        finally:
            self._budget = before

    def limit(self, kind: str, part: int) -> None:
        """Limit a kind that is quick to recompute to a fraction 1/parts of the budget."""
        self._parts[kind] = part

    def get(self, kind: str, key: Hashable, make: Callable[[], _Value]) -> _Value:
        """The value of a key, created if it is missing.

        If several threads ask for the same key, one creates it and the others wait; `make` may ask for other
        values. A value larger than half the budget is not kept, but is found for as long as something else
        refers to it. If `make` fails, nothing is kept.
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
        """Store a value whatever its size, replacing any earlier one of the key; also updates the size of one
        that has grown."""
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
        """The value of a key, or None."""
        with self._lock:
            return self._found((kind, key))

    def take(self, kind: str, key: Hashable) -> Any:
        """Remove and return the value of a key, or None; `put` returns it to the cache."""
        with self._lock:
            return self._remove((kind, key))

    def watch(self, kind: str, value: object) -> None:
        """Count a value that is kept elsewhere, for as long as it exists."""
        with self._lock:
            self._dropped[kind, id(value)] = weakref.ref(value)

    def trim(self) -> None:
        """Evict the least recently used values until the rest fits; called when a watched value has grown."""
        budget = self.budget
        with self._lock:
            self._trim(budget)

    def drop(self, kind: str | None = None, but: Container[str] = ()) -> None:
        """Drop all values, or those of one kind, but for some kinds."""
        with self._lock:
            for each in {*self._kept, *(name[0] for name in self._dropped)}:
                if kind in (None, each) and each not in but:
                    self._kept.pop(each, None)
                    self._bytes.pop(each, None)
                    for name in [name for name in self._dropped if name[0] == each]:
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
        """Bytes by kind of evicted values that are still in use elsewhere."""
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
        """Evict the least recently used values, of one kind or of all, until those alive fit the limit."""
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
        with contextlib.suppress(TypeError):  # there are no weak references to numbers
            self._dropped[name] = weakref.ref(value)

    def _remove(self, name: _Name) -> Any:
        """Remove a value and return it."""
        self._dropped.pop(name, None)
        entry = self._kept.get(name[0], OrderedDict()).pop(name[1], None)
        if entry is None:
            return None
        self._bytes[name[0]] -= entry.size
        return entry.value


@dataclass
class _Entry:
    """A cached value, its size in bytes, and when it was last used."""

    value: Any
    size: int
    used: int


def _size(value: Any) -> int:
    # ask the class whether there is such an attribute: asking the value would hide errors raised by the
    # property
    return max(int(value.nbytes), _SMALL) if hasattr(type(value), "nbytes") else _SMALL


class _Making:
    """Marks a value that a thread is creating."""

    def __init__(self) -> None:
        self.done = threading.Event()
        self._thread = threading.get_ident()

    def wait(self, kind: str) -> None:
        """Wait until it has been created or has failed."""
        if self._thread == threading.get_ident():
            raise RuntimeError(f"{kind}: to make one asks for the same one")
        self.done.wait()


#: the cache of this process
MEMO = Memo()


def remembered(kind: str) -> Callable[[Callable[_Parameters, _Value]], Callable[_Parameters, _Value]]:
    """Decorator that caches a function's results in `MEMO` by its arguments."""

    def with_memory(function: Callable[_Parameters, _Value]) -> Callable[_Parameters, _Value]:
        @functools.wraps(function)
        def ask(*arguments: _Parameters.args, **named: _Parameters.kwargs) -> _Value:
            key = (arguments, *named.items())
            return MEMO.get(kind, key, lambda: function(*arguments, **named))

        return ask

    return with_memory


def automatic_budget() -> int:
    """The default budget in bytes: OCEAN_TWEAK_MEMORY, or a quarter of the machine's memory. Raises
    ParameterError for an invalid size."""
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
    """Bytes of a size given as text, such as 8GB or 1.5 MB; None if it is not a size."""
    match = re.fullmatch(r"(\d+(?:\.\d*)?|\.\d+)\s*([a-z]+)", text.strip(), re.IGNORECASE)
    if match is None or match[2].lower() not in UNITS:
        return None
    return round(float(match[1]) * UNITS[match[2].lower()])


def total_bytes(arrays: Iterable[Any]) -> int:
    """Total bytes of arrays, or of values with `nbytes`; None counts as 0."""
    return sum(array.nbytes for array in arrays if array is not None)
