# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress output: a bar on a terminal, otherwise one line per frame, JSON, or a farm's own format."""

from __future__ import annotations

import json
import logging
import shutil
import sys
import time
from collections.abc import Callable
from typing import Any, TextIO

from ..core.data.frames import Frame, format_frames
from ..core.data.plain_data import to_plain
from ..core.data.printable import LONGEST, printable
from ..core.sea.bake import BakedFrame
from ..export.logs import PRINTED

_LOG = logging.getLogger(__name__)

_BAR = 30


#: time in s without output after which the progress of a frame is printed
_SILENCE = 5.0


class Seldom:
    """Passes on the progress of a frame if there was no output for a while."""

    def __init__(self, tell: Callable[[Frame, str], None]) -> None:
        self._tell = tell
        self.was_heard()

    def was_heard(self) -> None:
        """Record that something else was printed."""
        self._last = time.monotonic()

    def __call__(self, frame: Frame, doing: str) -> None:
        """Print the progress, unless something was printed just now."""
        if time.monotonic() - self._last >= _SILENCE:
            self.was_heard()
            self._tell(frame, doing)


class Sharing:
    """Shows which share of a long piece of work is done: on a terminal by a bar, else by a line from time to
    time.

    doing : what it is, such as "beach: waves over the bed"
    """

    def __init__(self, doing: str) -> None:
        self._doing, self._stream = doing, sys.stderr
        self._last, self._shown = time.monotonic(), -1

    def __call__(self, done: float) -> None:
        """Show the share, 0…1."""
        percent, now = round(100.0 * done), time.monotonic()
        if self._stream.isatty():
            if percent != self._shown:
                filled = _BAR * percent // 100
                bar = "#" * filled + "." * (_BAR - filled)
                end = "\n" if percent == 100 else ""
                self._stream.write(f"\r{self._doing}: [{bar}] {percent:>3} %{end}")
                self._stream.flush()
        elif now - self._last >= _SILENCE:
            self._last = now
            print(f"{self._doing}: {percent} %", file=self._stream, flush=True)
        self._shown = percent


class Progress:
    """Prints the progress of a command.

    name : of the sea
    machine : print JSON, one object per line
    openjd : also print lines for an Open Job Description worker
    """

    def __init__(
        self, name: str, machine: bool = False, openjd: bool = False, stream: TextIO | None = None
    ) -> None:
        self.name = name
        self.machine = machine
        self.openjd = openjd
        self.stream = stream or sys.stdout
        self._is_terminal = self.stream.isatty() and not machine and not openjd
        self._total = 0
        self._done = 0
        self._started = time.monotonic()
        self._drawn = 0
        self._doing = ""
        #: receives the progress of a frame
        self.tell = Seldom(self._say_doing)

    @property
    def is_complete(self) -> bool:
        """Whether all frames are done."""
        return self._done >= self._total

    def say(self, text: str, **data: Any) -> None:
        """Print a line of text, or its data as JSON."""
        self._note(text)
        if self.machine:
            self._print(json.dumps({"sea": self.name, **data}))
        else:
            lines = f"{self.name}: {text}".split("\n")
            self._print("\n".join(printable(line, LONGEST) for line in lines))

    def remark(self, text: str) -> None:
        """Print a line that explains a wait."""
        self.say(text, remark=text)

    def begin(self, total: int) -> None:
        """Start counting frames."""
        self.tell.was_heard()
        self._total, self._done, self._started = total, 0, time.monotonic()
        if total == 0:
            self.share("nothing left to do")

    def frame(self, baked: BakedFrame) -> None:
        """Report a finished frame."""
        self._done += 1
        self._doing = ""
        self.tell.was_heard()
        seconds = round(baked.seconds, 4)
        label = format_frames((baked.frame,))
        text = (
            f"frame {label} ({self._done}/{self._total}) "
            f"{seconds:.2f} s  {', '.join(path.name for path in baked.paths)}"
        )
        if self._is_terminal:
            self._note(text)
            self._draw_bar()
            return
        self.say(
            text,
            frame=to_plain(baked.frame), paths=[str(path) for path in baked.paths], seconds=seconds,
        )  # fmt: skip
        self.share(f"frame {label}")

    def _say_doing(self, frame: Frame, doing: str) -> None:
        """Print the progress of a slow frame."""
        label = format_frames((frame,))
        self._doing = f"frame {label} {doing}"
        if self._is_terminal:
            self._draw_bar()
        else:
            self.say(f"frame {label} {doing}", frame=to_plain(frame), doing=doing)
        self.share(self._doing)

    def share(self, status: str) -> None:
        """Report the completed fraction to a farm."""
        if self.openjd:
            part = 100.0 * self._done / self._total if self._total else 100.0
            self._print(f"openjd_progress: {part:.1f}")
            self._print(f"openjd_status: {self.name}: {status} ({self._done}/{self._total})")

    def count(self, status: str) -> None:
        """Count an item without printing a line."""
        self._done += 1
        self.share(status)

    def fail(self, reason: str) -> None:
        """Report the reason of a failure to a farm."""
        if self.openjd:
            self._print(f"openjd_fail: {self.name}: {reason}")

    def end(self) -> None:
        """Finish the progress output."""
        if self._drawn:
            self._print("")

    def _draw_bar(self) -> None:
        filled = _BAR * self._done // self._total
        passed = time.monotonic() - self._started
        left = duration(passed / self._done * (self._total - self._done)) if self._done else "?"
        bar = "#" * filled + "." * (_BAR - filled)
        # the next line would not overwrite one that is longer than the terminal
        columns = shutil.get_terminal_size().columns - 1
        line = f"{self._done}/{self._total} [{bar}] {left} left  {self.name}"
        line = f"{line}  {self._doing}".rstrip()[:columns]
        self.stream.write(f"\r{line:<{self._drawn}}")
        self.stream.flush()
        self._drawn = len(line)

    def _note(self, text: str) -> None:
        """Write to the log file."""
        _LOG.info("%s: %s", self.name, text, extra=PRINTED)

    def _print(self, line: str) -> None:
        print(line, file=self.stream, flush=True)


def duration(seconds: float) -> str:
    """`1:02:03`, or `2:03` below an hour."""
    whole = round(seconds)
    hours, minutes = divmod(whole // 60, 60)
    return f"{hours}:{minutes:02d}:{whole % 60:02d}" if hours else f"{minutes}:{whole % 60:02d}"
