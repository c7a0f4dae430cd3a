# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets: named seas, stored as JSON.

The files in this folder are the built-in presets. The number in front of a file's name is its position in
lists; the rest is the preset's key.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from ...data import formats
from ...data.errors import ParameterError
from ..ocean_parameters import OceanParameters, parse_json

#: largest size of a preset file in bytes, so that a file chosen by mistake does not fill the memory
LARGEST = 200_000
_LONGEST = {"title": 60, "description": 400}
_FOLDER = Path(__file__).parent


@dataclass(frozen=True)
class Preset:
    """A named sea. A shot to which it is applied keeps its own timing.

    Raises ParameterError for an empty, overlong or unprintable title or description.
    """

    title: str
    description: str
    parameters: OceanParameters

    def __post_init__(self) -> None:
        for name, longest in _LONGEST.items():
            text = getattr(self, name)
            if not (isinstance(text, str) and len(text) <= longest and (text.isprintable())):
                raise ParameterError(name, text, f"must be a line of at most {longest} characters")
        if not self.title.strip():
            raise ParameterError("title", self.title, "must not be empty")

    def for_shot(self, parameters: OceanParameters) -> OceanParameters:
        """The preset's sea with the timing of a shot's present parameters."""
        return self.parameters.replace(timing=parameters.timing)

    def to_json(self) -> str:
        """JSON text from which `from_json` restores an equal preset."""
        data = {
            "format": formats.SEA,
            "title": self.title,
            "description": self.description,
            "parameters": self.parameters.to_dict(),
        }
        return json.dumps(data, indent=2, ensure_ascii=False) + "\n"

    @classmethod
    def from_json(cls, text: str) -> Preset:
        """A preset from JSON text. Raises ParameterError for invalid text."""
        if len(text) > LARGEST:
            raise ParameterError("preset", text[:20], f"is larger than {LARGEST // 1000} kB: not a preset")
        data: Any = formats.checked_sea(parse_json(text))
        if not isinstance(data, dict) or set(data) != {"title", "description", "parameters"}:
            raise ParameterError("preset", data, "must be an object with title, description and parameters")
        try:
            parameters = OceanParameters.from_dict(data["parameters"])
        except ParameterError as error:
            raise error.inside("parameters") from None
        return cls(data["title"], data["description"], parameters)


@cache
def built_in() -> dict[str, Preset]:
    """The built-in presets by key, in order."""
    files = sorted(_FOLDER.glob("*.json"))
    return {path.stem[3:]: Preset.from_json(path.read_text(encoding="utf-8")) for path in files}
