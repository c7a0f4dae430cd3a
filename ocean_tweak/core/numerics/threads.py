# SPDX-License-Identifier: GPL-3.0-or-later
"""Work on blocks of an array that threads share; NumPy lets others run while it computes."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

_Block = TypeVar("_Block")

#: numbers to be transformed from which on threads save more than they cost: six fields of 512²
_WORTH_SHARING = 6 * 512**2

#: numbers of one array in a block of rows: so many that calls of NumPy cost little beside them
_BLOCK = 2**16


def default_workers(numbers: int) -> int:
    """Threads that help to transform so many numbers, or with what takes as long: one a core, or only one."""
    return (os.cpu_count() or 1) if numbers >= _WORTH_SHARING else 1


def run_blocks(work: Callable[[_Block], None], blocks: Iterable[_Block], workers: int) -> None:
    """Do the work for each block, on as many threads as asked for; an error in any stops all."""
    if workers == 1:
        for block in blocks:
            work(block)
        return
    queue, lock = iter(blocks), threading.Lock()

    def pull() -> None:
        while True:
            with lock:
                block = next(queue, None)
            if block is None:
                return
            work(block)

    # this thread is one of them: to start another takes as long as some blocks
    with ThreadPoolExecutor(workers - 1) as pool:
        others = [pool.submit(pull) for _ in range(workers - 1)]
        pull()
        for done in others:
            done.result()


def row_blocks(rows: int, columns: int) -> Iterator[slice]:
    """Blocks of rows of a (rows, columns) array, for work on each number."""
    count = max(1, _BLOCK // columns)
    return (slice(first, min(first + count, rows)) for first in range(0, rows, count))
