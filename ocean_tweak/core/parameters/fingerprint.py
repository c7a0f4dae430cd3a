# SPDX-License-Identifier: GPL-3.0-or-later
"""Fingerprints: equal where a frame would be made of the same numbers.

They are SHA-256 of canonical JSON: sorted keys, no spaces, the shortest decimals. NumPy and the processor,
which change the last bits only, do not enter.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

from ..data import formats
from ..data.frames import Frame, frame_label
from .former_json import former
from .ocean_parameters import OceanParameters
from .shot import Shot, time_text


def fingerprint(data: object) -> str:
    """SHA-256, 64 hexadecimal digits, of plain data. Raises ValueError for numbers that are not finite."""
    text = json.dumps(data, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def hashed(sea: Shot | OceanParameters) -> dict[str, Any]:
    """The plain data of which fingerprints are made: as they stood in JSON from the first on.

    Spray is not among them: it changes no field.
    """
    return {name: value for name, value in former(sea.to_dict()).items() if name != "spray"}


def shot_fingerprint(shot: Shot) -> str:
    """That of a whole shot, whichever of its frames are made."""
    return fingerprint({"synthesis": formats.SYNTHESIS, "shot": hashed(shot)})


def frame_fingerprint(shot: Shot, frame: Frame, area: Mapping[str, Any] | None = None) -> str:
    """That of a frame: of its own parameters and time. Raises ParameterError where there is no such frame.

    area : plain data of the square where it is made; None for the sea's own tile
    """
    moment = shot.at(frame)
    return fingerprint(
        {
            "synthesis": formats.SYNTHESIS,
            "parameters": hashed(moment.parameters),
            "frame": frame_label(frame),
            "time": time_text(moment.time),
            "rate": moment.rate,
            **({} if area is None else {"area": area}),
        }
    )
