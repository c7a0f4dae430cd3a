# SPDX-License-Identifier: GPL-3.0-or-later
"""Measured spectra as text that a .blend file keeps with a layer."""

from __future__ import annotations

import json
from functools import lru_cache
from typing import Any

from ..core import MeasuredSpectra, ParameterError
from ..core.data.plain_data import from_plain, parse_json, to_plain

#: texts that were read
_KEPT = 16


def to_text(spectra: MeasuredSpectra | None) -> str:
    """What `from_text` reads; empty for none."""
    return "" if spectra is None else json.dumps(to_plain(spectra))


@lru_cache(_KEPT)
def from_text(text: str) -> MeasuredSpectra | None:
    """Spectra; None of an empty text. Raises ParameterError for a damaged one."""
    if not text:
        return None
    try:
        found: Any = from_plain(MeasuredSpectra, parse_json(text))
    except (ParameterError, TypeError) as error:
        raise ParameterError("measured", text[:40], f"is damaged: {error}. Import the file again") from None
    return found
