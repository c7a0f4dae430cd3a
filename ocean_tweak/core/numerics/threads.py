# SPDX-License-Identifier: GPL-3.0-or-later
"""Blocks of an array processed by several threads; NumPy releases the GIL while it computes."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

_Block = TypeVar("_Block")

#: number of values to transform from which threads pay off: six fields of 512²
_WORTH_SHARING = 6 * 512**2

#: values of one array in a block of rows: enough that the overhead of NumPy calls is small
_BLOCK = 2**16


def default_workers(numbers: int) -> int:
    """Number of threads for transforming this many values, or for equal work: one per core, or one."""
    return (os.cpu_count() or 1) if numbers >= _WORTH_SHARING else 1


def run_blocks(work: Callable[[_Block], None], blocks: Iterable[_Block], workers: int) -> None:
    """Run the work for each block on the given number of threads; an error in any of them stops all."""
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

    # this thread takes part: starting another takes as long as some blocks
    with ThreadPoolExecutor(workers - 1) as pool:
        others = [pool.submit(pull) for _ in range(workers - 1)]
        pull()
        for done in others:
            done.result()


def row_blocks(rows: int, columns: int) -> Iterator[slice]:
    """Blocks of rows of a (rows, columns) array, for elementwise work."""
    count = max(1, _BLOCK // columns)
    return (slice(first, min(first + count, rows)) for first in range(0, rows, count))
