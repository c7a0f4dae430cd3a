# SPDX-License-Identifier: GPL-3.0-or-later
"""Fingerprints: equal if and only if frames are computed from the same parameters.

A fingerprint is the SHA-256 of canonical JSON: sorted keys, no spaces, shortest decimals. NumPy's version and
the processor, which change only the last bits of fields, are not included.
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
from .surroundings import KEY


def fingerprint(data: object) -> str:
    """SHA-256 of plain data, as 64 hexadecimal digits. Raises ValueError for numbers that are not finite."""
    text = json.dumps(data, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def hashed(sea: Shot | OceanParameters) -> dict[str, Any]:
    """The plain data that fingerprints are computed from, in the form of format version 1.

    Neither spray, which changes no field, nor the square around a camera is included.
    """
    left_out = "spray", KEY
    return {name: value for name, value in former(sea.to_dict()).items() if name not in left_out}


def shot_fingerprint(shot: Shot) -> str:
    """The fingerprint of a whole shot, whichever of its frames are baked."""
    return fingerprint({"synthesis": formats.SYNTHESIS, "shot": hashed(shot)})


def frame_fingerprint(
    shot: Shot, frame: Frame, area: Mapping[str, Any] | None = None, around: Mapping[str, Any] | None = None
) -> str:
    """The fingerprint of one frame, from its parameters and time. Raises ParameterError for a frame outside
    the animation.

    area : plain data of the square that is sampled; None for the sea's own tile
    around : of that in which there are waves besides that do not repeat; None for none
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
            **({} if around is None else {KEY: around}),
        }
    )
