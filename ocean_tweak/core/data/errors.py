# SPDX-License-Identifier: GPL-3.0-or-later
"""The error raised for invalid parameters."""

from __future__ import annotations

from .printable import printable, shown


class ParameterError(ValueError):
    """An invalid parameter. The message names the field, its value and what is allowed.

    Examples
    --------
    >>> print(ParameterError("depth", -1.0, "must be above 0 m").inside("water"))
    water.depth = -1.0: must be above 0 m
    """

    def __init__(self, field: str, value: object, reason: str) -> None:
        self.field = field
        self.value = value
        self.reason = reason
        super().__init__(f"{printable(field, 120)} = {shown(value)}: {reason}")

    def inside(self, container: str) -> ParameterError:
        """The same error with a parent prepended to the field's path."""
        return ParameterError(f"{container}.{self.field}", self.value, self.reason)
