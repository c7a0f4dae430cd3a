# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the tables of docs/parameters.md and docs/channels.md from what they describe: `make docs`."""

from __future__ import annotations

import dataclasses
import re
import sys
from fractions import Fraction
from typing import Any

from ocean_tweak.core.data.raster import Raster
from ocean_tweak.core.data.validation import default_of
from ocean_tweak.core.parameters.ocean_parameters import (
    Coast,
    Current,
    Equaliser,
    Foam,
    Mask,
    MeasuredSpectra,
    OceanParameters,
    Patch,
    PathSample,
    Spray,
    Timing,
    Water,
    WindKey,
)
from ocean_tweak.core.synthesis.channels import CHANNELS, MAPS, STATE, Channel
from ocean_tweak.core.waves.kinds import shown

from .project import ROOT

BEGIN = "<!-- tables: written by `make docs` from the code, not by hand -->"
END = "<!-- end of tables -->"

#: class → where its fields stand in JSON
CLASSES = {
    OceanParameters: "at the top",
    Water: "in `water`",
    **{kind: f"in each layer of the kind `{kind.kind}`" for kind in shown()},
    WindKey: "in each entry of a wind field's list `keys`",
    PathSample: "in each entry of a wake's list `path`",
    Patch: "in each entry of the list `patches`",
    Mask: "in the `mask` of a layer of any kind but hero waves, or of a patch",
    Coast: "in `coast`, which a sea may lack",
    MeasuredSpectra: "in the `measured` of a layer of the kind `WAVES`",
    Equaliser: "in the `equaliser` of the sea or of a layer of the kind `WAVES`",
    Current: "in `current`",
    Foam: "in `foam`",
    Spray: "in `spray`, which a sea may lack: it changes none of its waves",
    Timing: "in `timing`",
}

HEAD = "| name | unit | default | allowed | why this range | what it is |\n|---|---|---|---|---|---|"
CHANNELS_HEAD = (
    "| output | what it is | numbers | unit | image | attribute in Blender | in USD | adds up |\n"
    "|---|---|---|---|---|---|---|---|"
)


def main() -> int:
    """Write the tables into the documents."""
    for name, made in DOCUMENTS.items():
        path = ROOT / "docs" / name
        path.write_text(updated(path.read_text(encoding="utf-8"), made()), encoding="utf-8")
        print(f"written: {path.relative_to(ROOT)}")
    return 0


def updated(document: str, made: str) -> str:
    """Return a document with tables between the marks. Raises ValueError without the marks."""
    before, _, rest = document.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not end:
        raise ValueError(f"the document must hold the marks {BEGIN} and {END}")
    return f"{before}{BEGIN}\n\n{made}\n{END}{after}"


def channels() -> str:
    """Return the table of all channels."""
    return "\n".join([CHANNELS_HEAD, *map(_channel_row, CHANNELS.values()), ""])


def _channel_row(channel: Channel) -> str:
    images = []
    for name, packed in MAPS.items():
        letters, first = "RGB", 0
        for each in packed:
            count = max(CHANNELS[each].components, 1)
            if each == channel.name:
                images.append(f"`{name}` {letters[first : first + count]}")
            first += count
    where = "" if channel.switch is not None else " over a bed" if channel.source == STATE else " of patches"
    cells = [
        f"`{channel.name}`", channel.text, str(max(channel.components, 1)), channel.unit, ", ".join(images),
        f"`{channel.attribute}`{where}" if channel.attribute else "",
        f"`{channel.usd.name}`" if channel.usd else "", "yes" if channel.adds else "",
    ]  # fmt: skip
    return "| " + " | ".join(cells) + " |"


def parameters() -> str:
    """Return one headed Markdown table for each parameter class."""
    parts = []
    for kind, place in CLASSES.items():
        rows = [_row(field) for field in dataclasses.fields(kind) if "nested" not in field.metadata]
        parts.append("\n".join([f"### {kind.__name__}, {place}\n", HEAD, *rows, ""]))
    return "\n".join(parts)


def _row(field: dataclasses.Field[Any]) -> str:
    meta = field.metadata
    cells = [
        f"`{field.name}`",
        meta.get("unit", ""),
        "" if meta["kind"] is Raster and not meta["optional"] else _shown(default_of(field)),
        _allowed(meta),
        meta.get("why", ""),
        meta["description"] + (f"; {_shown(off.value)} {off.means}" if (off := meta.get("off")) else ""),
    ]
    return "| " + " | ".join(cells) + " |"


def _allowed(meta: Any) -> str:
    if "choices" in meta:
        return ", ".join(f"`{choice}`" for choice in meta["choices"])
    if meta["kind"] is bool:
        return "`true`, `false`"
    if meta["kind"] is Raster:
        samples = f"{meta['channels']} numbers a sample"
        return f"{samples}, or `null`" if meta["optional"] else samples
    span = f"{_shown(meta['minimum'])} … {_shown(meta['maximum'])}"
    return f"{span}, or `null`" if meta.get("optional") else span


def _shown(value: Any) -> str:
    """Return a value as it would stand in JSON, without a needless fraction."""
    if value is None:
        return "`null`"
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    if isinstance(value, str):
        return f"`{value}`"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, (float, Fraction)) and value == int(value) and abs(value) < 1e6:
        return str(int(value))
    return re.sub(r"e([+-])0*", lambda match: "e" + match[1].strip("+"), f"{float(value):g}")


#: file in docs/ → what makes its tables
DOCUMENTS = {"parameters.md": parameters, "channels.md": channels}

if __name__ == "__main__":
    sys.exit(main())
