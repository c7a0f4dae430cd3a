# SPDX-License-Identifier: GPL-3.0-or-later
"""Dataclass fields that layers of several kinds have alike."""

from __future__ import annotations

from typing import Any

from .validation import integer, number, switch

_LARGEST = 2**31 - 1
_WHOLE = "Blender's whole numbers"


def direction(
    description: str = "Direction towards which the waves run, counter-clockwise from +x",
    changes: bool = False,
) -> Any:
    """Where a layer's waves or its wind go."""
    why = "any number of turns that a float tells apart"
    return number(0.0, -1e6, 1e6, "rad", description, why, changes=changes)


def muted() -> Any:
    """Whether a layer takes part."""
    return switch(False, "Leave the layer out; no other layer changes")


def identity() -> Any:
    """What tells a layer from others of its kind."""
    description = "Identity of the layer, from which its seed follows; -1 takes the first free one"
    return integer(-1, -1, _LARGEST, description, _WHOLE)


def own_seed(what: str = "Seed of this layer alone") -> Any:
    """The seed of a layer's random numbers."""
    return integer(-1, -1, _LARGEST, f"{what}; -1 derives it from the ocean's seed and the id", _WHOLE)
