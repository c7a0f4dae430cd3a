# SPDX-License-Identifier: GPL-3.0-or-later
"""How progress is told: a bar on a terminal, a line a frame elsewhere, JSON, or a farm's own lines."""

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


#: s without a word, after which it is told what is being done for a frame
_SILENCE = 5.0


class Seldom:
    """Passes on what is being done for a frame when nothing has been said for a while."""

    def __init__(self, tell: Callable[[Frame, str], None]) -> None:
        self._tell = tell
        self.was_heard()

    def was_heard(self) -> None:
        """Something else has been said."""
        self._last = time.monotonic()

    def __call__(self, frame: Frame, doing: str) -> None:
        """Say what is being done, unless something was said just now."""
        if time.monotonic() - self._last >= _SILENCE:
            self.was_heard()
            self._tell(frame, doing)


class Progress:
    """Tells what a command does.

    name : of the sea
    machine : JSON, an object a line
    openjd : also the lines that an Open Job Description worker understands
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
        #: what is being done for a frame is said to it
        self.tell = Seldom(self._say_doing)

    @property
    def is_complete(self) -> bool:
        """Whether all frames that were to be made are."""
        return self._done >= self._total

    def say(self, text: str, **data: Any) -> None:
        """A line of text, or its data for a machine."""
        self._note(text)
        if self.machine:
            self._print(json.dumps({"sea": self.name, **data}))
        else:
            lines = f"{self.name}: {text}".split("\n")
            self._print("\n".join(printable(line, LONGEST) for line in lines))

    def remark(self, text: str) -> None:
        """A line that says why nothing happens."""
        self.say(text, remark=text)

    def begin(self, total: int) -> None:
        """Frames are made from now on."""
        self.tell.was_heard()
        self._total, self._done, self._started = total, 0, time.monotonic()
        if total == 0:
            self.share("nothing left to do")

    def frame(self, baked: BakedFrame) -> None:
        """A frame has been made."""
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
        """Of a frame that takes long."""
        label = format_frames((frame,))
        self._doing = f"frame {label} {doing}"
        if self._is_terminal:
            self._draw_bar()
        else:
            self.say(f"frame {label} {doing}", frame=to_plain(frame), doing=doing)
        self.share(self._doing)

    def share(self, status: str) -> None:
        """What part is done, for a farm."""
        if self.openjd:
            part = 100.0 * self._done / self._total if self._total else 100.0
            self._print(f"openjd_progress: {part:.1f}")
            self._print(f"openjd_status: {self.name}: {status} ({self._done}/{self._total})")

    def count(self, status: str) -> None:
        """One more is done that needs no line of its own."""
        self._done += 1
        self.share(status)

    def fail(self, reason: str) -> None:
        """Tell a farm why."""
        if self.openjd:
            self._print(f"openjd_fail: {self.name}: {reason}")

    def end(self) -> None:
        """No more frames are made."""
        if self._drawn:
            self._print("")

    def _draw_bar(self) -> None:
        filled = _BAR * self._done // self._total
        passed = time.monotonic() - self._started
        left = duration(passed / self._done * (self._total - self._done)) if self._done else "?"
        bar = "#" * filled + "." * (_BAR - filled)
        # a line that is longer than the terminal would not be drawn over by the next
        columns = shutil.get_terminal_size().columns - 1
        line = f"{self._done}/{self._total} [{bar}] {left} left  {self.name}"
        line = f"{line}  {self._doing}".rstrip()[:columns]
        self.stream.write(f"\r{line:<{self._drawn}}")
        self.stream.flush()
        self._drawn = len(line)

    def _note(self, text: str) -> None:
        """For the log's file."""
        _LOG.info("%s: %s", self.name, text, extra=PRINTED)

    def _print(self, line: str) -> None:
        print(line, file=self.stream, flush=True)


def duration(seconds: float) -> str:
    """`1:02:03`, or `2:03` below an hour."""
    whole = round(seconds)
    hours, minutes = divmod(whole // 60, 60)
    return f"{hours}:{minutes:02d}:{whole % 60:02d}" if hours else f"{minutes}:{whole % 60:02d}"
