# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of all kinds of waves."""

from __future__ import annotations

from .contribution import Contribution
from .hero.parameters import HeroWave
from .image.parameters import PictureLayer
from .spectral import WaveLayer
from .wind_field.parameters import WindFieldLayer

#: in the order in which their waves are added: sums of floats depend on it
KINDS: tuple[type[Contribution], ...] = (WaveLayer, HeroWave, PictureLayer, WindFieldLayer)
