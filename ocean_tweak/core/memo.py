# SPDX-License-Identifier: GPL-3.0-or-later
"""One memory for all arrays that outlive a call, with a budget in bytes.

What is in it can be made again. It counts as long as anybody has it: an ocean that is in use holds its waves
itself, so that a small budget makes other seas be forgotten, and not this one be made again for each frame.
"""

from __future__ import annotations

import contextlib
import functools
import os
import re
import threading
import weakref
from collections import OrderedDict
from collections.abc import Callable, Hashable, Iterable, Iterator
from typing import Any, ParamSpec, TypeVar, cast

from .errors import ParameterError
from .machine import usable_memory

#: the environment variable that sets the budget of a process
VARIABLE = "OCEAN_TWEAK_MEMORY"

#: bytes in a unit of memory, by its name in small letters
UNITS = {"b": 1, "kb": 10**3, "mb": 10**6, "gb": 10**9, "tb": 10**12}

#: bytes that a machine has which does not tell
_UNKNOWN_MACHINE = 8 * 10**9

#: bytes of the least budget
_LEAST = 10**6

#: bytes that a value counts which has no arrays: a few numbers, and the parameters that are their key
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
        self._lock = threading.Lock()
        # those that are kept, the one used last at the end, and those that others may still have
        self._kept: OrderedDict[_Name, Any] = OrderedDict()
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
            self.put(kind, key, value)
            return value
        finally:
            with self._lock:
                del self._making[name]
            making.done.set()

    def put(self, kind: str, key: Hashable, value: object) -> None:
        """Keep a value, instead of that which the key had."""
        name, budget = (kind, key), self.budget
        with self._lock:
            self._kept.pop(name, None)
            self._kept[name] = value
            if 2 * _size(value) > budget:
                self._drop(name)
            self._trim(budget)

    def find(self, kind: str, key: Hashable) -> Any:
        """The value of a key; None where there is none."""
        with self._lock:
            return self._found((kind, key))

    def take(self, kind: str, key: Hashable) -> Any:
        """The value of a key, for the caller alone until it is put back; None where there is none."""
        with self._lock:
            self._dropped.pop((kind, key), None)
            return self._kept.pop((kind, key), None)

    def watch(self, kind: str, value: object) -> None:
        """Count a value that somebody else keeps, for as long as that is."""
        with self._lock:
            self._dropped[kind, id(value)] = weakref.ref(value)

    def trim(self) -> None:
        """Drop what was not used for longest until the rest fits: a value has grown."""
        budget = self.budget
        with self._lock:
            self._trim(budget)

    def drop(self, kind: str | None = None) -> None:
        """Forget all values, or those of a kind."""
        with self._lock:
            for names in (self._kept, self._dropped):
                for name in [name for name in names if kind in (None, name[0])]:
                    del names[name]

    def report(self) -> dict[str, int]:
        """Bytes by kind, the largest first."""
        total: dict[str, int] = {}
        with self._lock:
            for name, size in self._sizes().items():
                total[name[0]] = total.get(name[0], 0) + size
        return dict(sorted(total.items(), key=lambda entry: -entry[1]))

    def _found(self, name: _Name) -> Any:
        if name in self._kept:
            self._kept.move_to_end(name)
            return self._kept[name]
        dropped = self._dropped.get(name)
        return None if dropped is None else dropped()

    def _sizes(self) -> dict[_Name, int]:
        """Bytes of all that is kept, and of what others still have."""
        sizes = {name: _size(value) for name, value in self._kept.items()}
        for name, dropped in list(self._dropped.items()):
            value = dropped()
            if value is None or name in sizes:
                del self._dropped[name]
            else:
                sizes[name] = _size(value)
        return sizes

    def _trim(self, budget: int) -> None:
        sizes = self._sizes()
        total = sum(sizes.values())
        if total <= budget:
            return
        in_use = dict(self._kept.keys())  # the last key of each kind
        for kind, key in [name for name in self._kept if in_use[name[0]] != name[1]]:
            self._drop((kind, key))
            # it may be held, or have held others
            total = sum(sizes[name] for name in self._kept)
            total += sum(sizes[name] for name, dropped in self._dropped.items() if dropped() is not None)
            if total <= budget:
                return

    def _drop(self, name: _Name) -> None:
        with contextlib.suppress(TypeError):  # numbers cannot be referred to weakly
            self._dropped[name] = weakref.ref(self._kept[name])
        del self._kept[name]


def _size(value: object) -> int:
    return int(getattr(value, "nbytes", _SMALL))


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
