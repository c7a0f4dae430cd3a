# SPDX-License-Identifier: GPL-3.0-or-later
"""What is said of parameters that cannot be used."""

from __future__ import annotations

import reprlib

from .printable import printable


class ParameterError(ValueError):
    """A parameter that cannot be used: names the field, its value and what is allowed."""

    def __init__(self, field: str, value: object, reason: str) -> None:
        self.field = field
        self.value = value
        self.reason = reason
        super().__init__(f"{printable(field, 120)} = {printable(_WRITER.repr(value))}: {reason}")

    def inside(self, container: str) -> ParameterError:
        """The same error with the field's path lengthened at the front."""
        return ParameterError(f"{container}.{self.field}", self.value, self.reason)


class _Writer(reprlib.Repr):
    """Writes values as Python does, but of many entries only some: what a file gives may be huge or deep."""

    def __init__(self) -> None:
        super().__init__()
        self.maxtuple = self.maxlist = self.maxdict = self.maxset = 40
        self.maxstring = self.maxlong = self.maxother = 200

    def repr_int(self, x: int, level: int) -> str:
        """Digits by the thousand are not written at all: Python refuses to."""
        return super().repr_int(x, level) if x.bit_length() < 10_000 else f"({x.bit_length()} bits)"


_WRITER = _Writer()
