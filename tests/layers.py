# SPDX-License-Identifier: GPL-3.0-or-later
"""Layers of one kind of a sea, by the kind's name in JSON: for the package and for copies of it alike."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


def layers_of(sea: Any, kind: str) -> tuple[Any, ...]:
    return tuple(layer for layer in sea.layers if layer.kind == kind)


def with_layers(sea: Any, **by_kind: Sequence[Any]) -> Any:
    """Replace all layers of some kinds; those of waves by a spectrum come first."""
    waves = by_kind.pop("WAVES", layers_of(sea, "WAVES"))
    others = (layer for layer in sea.layers if layer.kind not in ("WAVES", *by_kind))
    return sea.replace(layers=(*waves, *others, *(layer for layers in by_kind.values() for layer in layers)))
