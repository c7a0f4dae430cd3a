# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings that can be changed without anything following from each change."""

from collections.abc import Iterator
from contextlib import contextmanager


class Quiet:
    """Of a property group with a property `is_quiet`, for which its update callbacks look."""

    @contextmanager
    def quiet(self) -> Iterator[None]:
        """While this is open, a changed property shows nothing."""
        before, self.is_quiet = self.is_quiet, True
        try:
            yield
        finally:
            self.is_quiet = before
