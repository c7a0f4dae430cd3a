# SPDX-License-Identifier: GPL-3.0-or-later
"""How a command ends."""

from __future__ import annotations

import sys

DONE, FAILED, WRONG_ARGUMENTS = 0, 1, 2


class UsageError(ValueError):
    """Arguments that do not fit together."""


def complain(message: object) -> None:
    """Say what is wrong, in a line."""
    print(f"ocean_tweak: {message}", file=sys.stderr, flush=True)
