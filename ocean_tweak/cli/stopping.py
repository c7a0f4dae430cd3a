# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl-C and SIGTERM: frames in progress are finished or, if that takes too long, given up; no more are
started.
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
#: not the number of a signal
_OVER = 0

#: time in s for frames in progress to finish
PATIENCE = 3.0
#: the same time in a worker, shorter because its parent waits for it
WORKERS_PATIENCE = 2.0


@contextlib.contextmanager
def stop_requested(give_up: Callable[[], object] | None = None) -> Iterator[threading.Event]:
    """Context manager for an event that is set by the first Ctrl-C or SIGTERM.

    give_up : ends the process at once; called on another thread if this is still open PATIENCE seconds later,
        or at a second signal. Without it, a second signal has its previous effect.
    """
    event = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield event  # signals are handled by the main thread
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
    """Watch for signals on a separate thread, as the main one cannot handle them during a long operation."""

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
    """End the process without waiting for its threads; their unfinished work is lost."""
    logging.shutdown()
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError, AttributeError):
            stream.flush()
    os._exit(code)
