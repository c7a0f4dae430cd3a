# SPDX-License-Identifier: GPL-3.0-or-later
"""The choices of an export as artists meet them: texts, defaults, and how the command line writes them.

The arguments of the command `usd` and the properties in Blender are both made from these tables.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import MISSING, fields
from typing import Any, NamedTuple

from .package import FORMS, Package


class Option(NamedTuple):
    """A choice.

    label : in a panel
    text : what it does, to be continued with its default
    """

    label: str
    text: str

    @property
    def sentence(self) -> str:
        """The text alone, as a tooltip."""
        return f"{self.text[0].upper()}{self.text[1:]}"


#: by the name of a Package's field, or of the command's argument
OPTIONS = {
    "up_axis": Option("Up Axis", "Z as in Blender, or Y, which rotates points, velocities and normals"),
    "metres_per_unit": Option("Metres per Unit", "metres per unit of the layers; 0.01 for centimetres"),
    "subframes": Option("Time Samples", "time samples per frame, for motion blur"),
    "attributes": Option("Attributes", "what the mesh carries beside points and extent"),
    "half": Option("Half Precision", "foam, cusp, breaking and foam_age in 16 bits"),
    "tiles": Option("Tiles", "patches side by side, as instances"),
    "proxy": Option("Proxy", "quads along each side of the coarse viewport mesh; 0 for none"),
    "variants": Option(
        "Variants", "resolutions to choose from, such as 512,256; the first one is shown by default"
    ),
    "force": Option("Overwrite", "replace existing files, also those of other programs"),
}

#: form → label and what moves the mesh
FORM_OPTIONS: dict[str, Option] = dict(
    zip(
        FORMS,
        (
            Option("Points", "the points of every frame in one layer: for short shots"),
            Option("Clips", "value clips, one layer per frame: for long shots and farms"),
            Option("Displacement", "a flat grid, moved by its material from baked EXR images"),
        ),
        strict=True,
    )
)

#: the usual form
DEFAULT_FORM = "clips"

DEFAULTS: dict[str, Any] = {
    **{field.name: field.default for field in fields(Package) if field.default is not MISSING},
    "form": DEFAULT_FORM,
    "subframes": 1,
    "force": False,
}

#: what stands between the parts of a list
_BETWEEN = {"attributes": ",", "variants": ",", "tiles": "x"}


def written(name: str, value: Any) -> str:
    """A choice as the command line takes it."""
    between = _BETWEEN.get(name)
    return str(value) if between is None or isinstance(value, str) else between.join(map(str, value))


def command_arguments(choices: Mapping[str, Any]) -> Iterator[str]:
    """The arguments that say these choices; a switch that is off and no variants say nothing."""
    for name, value in choices.items():
        argument = f"--{name.replace('_', '-')}"
        if isinstance(value, bool):
            if value:
                yield argument
        elif name != "variants" or value:
            yield f"{argument}={written(name, value)}"
