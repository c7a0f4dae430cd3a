# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl-C and SIGTERM: what is under way is finished or, where that takes too long, given up; nothing more is
begun.
"""

from __future__ import annotations

import contextlib
import logging
import os
import signal
import socket
import sys
import threading
from collections.abc import Callable, Iterator
from types import FrameType
from typing import NoReturn

_SIGNALS = (signal.SIGINT, signal.SIGTERM)
#: no signal has this number
_OVER = 0

#: s that what is under way has to end
PATIENCE = 3.0
#: s that it has in a worker: whoever started it waits for it
WORKERS_PATIENCE = 2.0


@contextlib.contextmanager
def stop_requested(give_up: Callable[[], object] | None = None) -> Iterator[threading.Event]:
    """An event that is set by the first Ctrl-C or SIGTERM.

    give_up : ends the process, whatever it does; called, on another thread, where this is still open
        PATIENCE seconds later, or at a second signal. Without it a second signal does what it did before.
    """
    event = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield event  # signals are the main thread's
        return
    before = {number: signal.getsignal(number) for number in _SIGNALS}

    def stop(number: int, _frame: FrameType | None) -> None:
        event.set()
        if give_up is None:
            signal.signal(number, before[number] or signal.SIG_DFL)

    with _watched(event, give_up) if give_up else contextlib.nullcontext():
        try:
            for number in _SIGNALS:
                signal.signal(number, stop)
            yield event
        finally:
            for number, handler in before.items():
                signal.signal(number, handler or signal.SIG_DFL)


@contextlib.contextmanager
def _watched(event: threading.Event, give_up: Callable[[], object]) -> Iterator[None]:
    """Signals are seen by a thread: the main one does not come to them while it is in a long operation."""

    def watch() -> None:
        asked = False
        while True:
            ours.settimeout(PATIENCE if asked else None)
            try:
                (number,) = ours.recv(1)
            except TimeoutError:
                number = signal.SIGTERM
            if number == _OVER:
                return
            if number in _SIGNALS:
                if asked:
                    give_up()
                asked = True
                event.set()

    ours, theirs = socket.socketpair()
    with ours, theirs:
        theirs.setblocking(False)
        watcher = threading.Thread(target=watch, name="Ocean Tweak signals", daemon=True)
        watcher.start()
        before = signal.set_wakeup_fd(theirs.fileno(), warn_on_full_buffer=False)
        try:
            yield
        finally:
            signal.set_wakeup_fd(before)
            theirs.send(bytes([_OVER]))
            watcher.join()


def end_now(code: int) -> NoReturn:
    """End the process without waiting for its threads; what they have not finished is lost."""
    logging.shutdown()
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError, AttributeError):
            stream.flush()
    os._exit(code)
