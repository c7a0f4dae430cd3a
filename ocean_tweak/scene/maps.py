# SPDX-License-Identifier: GPL-3.0-or-later
"""What an ocean's settings ask for: channels on its mesh, and maps as images."""

from __future__ import annotations

from collections.abc import Collection

from ..core.synthesis.channels import CHANNELS, MAPS
from ..nodes.names import MAP_INPUTS
from .settings import OceanSettings


def wanted_channels(settings: OceanSettings) -> frozenset[str]:
    """The channels that an ocean's switches ask for, each an attribute of its mesh."""
    return frozenset(
        name
        for name, channel in CHANNELS.items()
        if channel.switch is not None and (not channel.switch or getattr(settings, channel.switch))
    )


def maps_of(channels: Collection[str]) -> tuple[str, ...]:
    """The maps among those that Blender reads of which all channels are wanted."""
    return tuple(name for name in MAP_INPUTS if all(channel in channels for channel in MAPS[name]))
