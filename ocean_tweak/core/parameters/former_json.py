# SPDX-License-Identifier: GPL-3.0-or-later
"""JSON of format version 1, in which each kind of layer other than spectral waves had a list of its own.

Many fields had other names. Such files are still read, and fingerprints are still computed from this form, so
that existing bakes keep theirs.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

from ..data.errors import ParameterError
from ..data.formats import checked_sea
from ..waves.contribution import Contribution
from ..waves.hero.parameters import HeroWave
from ..waves.image.parameters import ImageLayer
from ..waves.kinds import KINDS, shown
from ..waves.spectral import WaveLayer
from ..waves.wind_field.parameters import WindFieldLayer

#: present → former names of fields: of the sea itself,
SEA_NAMES = {"orbital_motion": "orbits", "merged_resolution": "joined"}
#: of a mask,
MASK_NAMES = {"inner_radius": "near", "outer_radius": "far"}
#: and of each kind of layer
LAYER_NAMES: dict[str, dict[str, str]] = {
    WaveLayer.kind: {"amplitude_scale": "gain"},
    ImageLayer.kind: {"amplitude_scale": "gain", "image": "picture"},
    WindFieldLayer.kind: {
        "amplitude_scale": "gain",
        "wind_scale": "strength",
        "minimum_wind_speed": "calm",
        "crest": "front",
    },
    HeroWave.kind: {},
}
#: present → former values of the one choice whose values were renamed
_AMPLITUDES = {"RANDOM": "GAUSSIAN", "DETERMINISTIC": "FIXED"}

_Names = Mapping[str, str]
_LAYER = re.compile(r"layers\.([0-9]+)\.(.+)")


def _with_lists() -> dict[str, type[Contribution]]:
    """The kinds that had a list of their own, by the name of the list."""
    return {kind.former_list: kind for kind in shown() if kind.former_list}


def modern(data: Any) -> Any:
    """Convert plain data of a sea of any version to one list of layers, without the format version.

    Raises NewerFormatError for data of a newer version, ParameterError if a list is not a list.
    """
    data = checked_sea(data)
    return _renamed(_in_one_list(data), _reversed) if isinstance(data, dict) else data


def _in_one_list(data: dict[str, Any]) -> dict[str, Any]:
    if data.keys().isdisjoint(_with_lists()):
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
    """Convert plain data of a sea or shot to the form of version 1: its lists and its names."""
    data = _renamed(data, dict)
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


def _reversed(names: _Names) -> dict[str, str]:
    return {old: new for new, old in names.items()}


def _renamed(data: dict[str, Any], direction: Callable[[_Names], dict[str, str]]) -> dict[str, Any]:
    """The same data with fields renamed.

    direction : applied to each table of names: identity, or reversal
    """
    layers = data.get("layers", [])
    names = [_names_of(layer) for layer in layers] if isinstance(layers, list) else []
    result = _with_names(data, direction(SEA_NAMES))
    for name in ("layers", "patches"):
        if isinstance(result.get(name), list):
            known = names if name == "layers" else [{}] * len(result[name])
            pairs = zip(result[name], known, strict=True)
            result[name] = [_entry(entry, direction(own), direction(MASK_NAMES)) for entry, own in pairs]
    if isinstance(result.get("amplitudes"), str):
        result["amplitudes"] = direction(_AMPLITUDES).get(result["amplitudes"], result["amplitudes"])
    animation = result.get("animation")
    if isinstance(animation, dict) and isinstance(animation.get("samples"), dict):
        samples = {_path(path, names, direction): values for path, values in animation["samples"].items()}
        result["animation"] = {**animation, "samples": samples}
    return result


def _names_of(layer: Any) -> _Names:
    kind = layer.get("kind", KINDS[0].kind) if isinstance(layer, dict) else None
    return LAYER_NAMES.get(kind, {}) if isinstance(kind, str) else {}


def _entry(entry: Any, names: _Names, of_mask: _Names) -> Any:
    """Rename the fields of a layer or patch, and of its mask."""
    if not isinstance(entry, dict):
        return entry
    result = _with_names(entry, names)
    if isinstance(result.get("mask"), dict):
        result["mask"] = _with_names(result["mask"], of_mask)
    return result


def _with_names(data: dict[str, Any], names: _Names) -> dict[str, Any]:
    """If both names are present, keep both, so that the former one is reported as unknown."""
    return {
        names[key] if key in names and names[key] not in data else key: value for key, value in data.items()
    }


def _path(path: str, names: list[_Names], direction: Callable[[_Names], dict[str, str]]) -> str:
    """Rename the path of an animated value, of a layer or of the sea."""
    found = _LAYER.fullmatch(path)
    if found is None:
        return direction(SEA_NAMES).get(path, path)
    number = int(found[1]) if len(found[1]) < 6 else len(names)
    own = direction(names[number]) if number < len(names) else {}
    return f"layers.{found[1]}.{own.get(found[2], found[2])}"
