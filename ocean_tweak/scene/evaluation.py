# SPDX-License-Identifier: GPL-3.0-or-later
"""The seas of the open file's oceans, kept from one frame to the next."""

from __future__ import annotations

import json
from dataclasses import dataclass

import bpy

from ..core import Ocean, OceanParameters
from .settings import all_oceans


@dataclass(frozen=True)
class Sea:
    """An ocean ready for any frame, and its statistics as JSON."""

    ocean: Ocean
    statistics: str


# Cache, by the object's session uid: the last sea of each object of the open file, so that playback neither
# makes the initial state again nor loses it to another object. It holds nothing that cannot be computed.
_seas: dict[int, Sea] = {}


def sea_of(item: bpy.types.Object, parameters: OceanParameters) -> Sea:
    """The object's sea with these parameters. Raises MemoryError for one too large."""
    cached = _seas.get(item.session_uid)
    if cached is not None and cached.ocean.parameters == parameters:
        return cached
    ocean = Ocean(parameters)
    if cached is not None and cached.ocean.initial_state is ocean.initial_state:
        statistics = cached.statistics  # only time or choppiness differ
    else:
        statistics = json.dumps(ocean.statistics().to_dict())
    _forget_removed()
    _seas[item.session_uid] = Sea(ocean, statistics)
    return _seas[item.session_uid]


def forget_all() -> None:
    """Drop the cache: another file is opened, or the extension is disabled."""
    _seas.clear()


def _forget_removed() -> None:
    alive = {item.session_uid for item in all_oceans()}
    for uid in [uid for uid in _seas if uid not in alive]:
        del _seas[uid]
