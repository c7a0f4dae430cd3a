# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl-C and SIGTERM: what is under way is finished, nothing more is begun."""

from __future__ import annotations

import contextlib
import signal
import threading
from collections.abc import Iterator
from types import FrameType

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


@contextlib.contextmanager
def stop_requested() -> Iterator[threading.Event]:
    """An event that is set by the first Ctrl-C or SIGTERM; a second one ends the process at once."""
    event = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield event  # signals are the main thread's
        return
    before = {number: signal.getsignal(number) for number in _SIGNALS}

    def stop(number: int, _frame: FrameType | None) -> None:
        event.set()
        signal.signal(number, before[number] or signal.SIG_DFL)

    try:
        for number in _SIGNALS:
            signal.signal(number, stop)
        yield event
    finally:
        for number, handler in before.items():
            signal.signal(number, handler or signal.SIG_DFL)
