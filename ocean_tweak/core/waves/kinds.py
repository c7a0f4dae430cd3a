# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of all kinds of waves."""

from __future__ import annotations

from .contribution import Contribution
from .hero.parameters import HeroWave
from .image.parameters import ImageLayer
from .spectral import WaveLayer
from .wake.parameters import WakeLayer
from .wind_field.parameters import WindFieldLayer

#: in the order in which their waves are added, on which sums of floats depend; a layer of which JSON does not
#: say its kind is of the first
KINDS: list[type[Contribution]] = [WaveLayer, HeroWave, ImageLayer, WindFieldLayer, WakeLayer]


def shown() -> list[type[Contribution]]:
    """The kinds in the order of menus and lists."""
    return sorted(KINDS, key=lambda kind: kind.names.number)
