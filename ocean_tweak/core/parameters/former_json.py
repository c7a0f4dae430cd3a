# SPDX-License-Identifier: GPL-3.0-or-later
"""JSON of a sea as it was when each kind of layers but waves by a spectrum had a list of its own.

It is still read; and fingerprints are still made of it, so that what was baked from it is known as the same.
"""

from __future__ import annotations

import re
from typing import Any

from ..data.errors import ParameterError
from ..data.formats import checked_sea
from ..waves.contribution import Contribution
from ..waves.kinds import KINDS, shown

_LAYER = re.compile(r"layers\.([0-9]+)\.(.+)")


def _with_lists() -> dict[str, type[Contribution]]:
    """The kinds that had a list of their own, by its name."""
    return {kind.former_list: kind for kind in shown() if kind.former_list}


def modern(data: Any) -> Any:
    """Plain data of a sea of any version with one list of layers, and without the number of the version.

    Raises NewerFormatError for one that is newer than this program, ParameterError for a list that is none.
    """
    data = checked_sea(data)
    if not isinstance(data, dict) or data.keys().isdisjoint(_with_lists()):
        return data
    result = {key: value for key, value in data.items() if key not in _with_lists()}
    layers = result.get("layers", [{}])
    if not isinstance(layers, list):
        return result
    for name, kind in _with_lists().items():
        own = data.get(name, [])
        if not isinstance(own, list):
            raise ParameterError(name, own, f"must be a sequence of {kind.__name__}")
        told = ({**layer, "kind": kind.kind} if isinstance(layer, dict) else layer for layer in own)
        layers = [*layers, *told]
    return {**result, "layers": layers}


def former(data: dict[str, Any]) -> dict[str, Any]:
    """Plain data of a sea or of a shot with a list for each kind that had one."""
    lists = {kind.kind: name for name, kind in _with_lists().items()}
    result: dict[str, Any] = {**data, "layers": []}
    places: dict[str, str] = {}
    for index, layer in enumerate(data["layers"]):
        name = lists.get(layer.get("kind", KINDS[0].kind), "layers")
        own = result.setdefault(name, [])
        places[str(index)] = f"{name}.{len(own)}"
        own.append(layer if name == "layers" else {key: layer[key] for key in layer if key != "kind"})
    if "animation" in data:
        samples = {
            f"{places[found[1]]}.{found[2]}" if (found := _LAYER.fullmatch(path)) else path: values
            for path, values in data["animation"]["samples"].items()
        }
        result["animation"] = {**data["animation"], "samples": samples}
    return result
