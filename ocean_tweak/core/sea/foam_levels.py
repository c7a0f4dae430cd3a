# SPDX-License-Identifier: GPL-3.0-or-later
"""Foam of a sea as it is seen at several distances: each level knows half as fine waves as the one before.

Level n has cells of the size FINEST·2ⁿ, and its foam is that of the sea without the waves shorter than four
of them: it is born on the crests that can be seen at that distance, with the threshold that belongs to them,
and no lattice shows.

The coarser a level, the less it knows of what breaks. Of its foam F counts the share κ of the strains'
variance that it holds, of that which is seen, and for the rest the mean W of the sea, κF + (1 - κ)W: the mean
stays, and what cannot be known is even. Beyond the last level there is W alone. Dupuy & Bruneton (2012)
average whitecaps over the waves that are too small to be seen for the same reason.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property

import numpy as np

from ..foam.model import Whitecaps
from ..foam.threshold import foam_outlook
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.patch_seas import waves_above
from .ocean import Ocean

#: m, of the finest level's cells
FINEST = 0.25
#: cells in a level's shortest wave
_CELLS_A_WAVE = 4.0
#: samples of a patch along its shortest wave: read between them, a fourth of that wave's variance is lost,
#: and less of longer ones
_SAMPLES_A_WAVE = 4.25
#: by how much longer a level's shortest wave may be than a patch's, and the patch is whole all the same:
#: levels share the strains of a patch that they both have whole
_WHOLE = 1.15
#: a level whose waves have less of the strains' variance than this tells little
_LEAST_SHARE = 0.15
_MOST_LEVELS = 10


class FoamLevels:
    """Those of a sea of patches. Making it is cheap.

    `parameters` are those of the sea, `seas` those of the levels, as many as tell anything of the strains.
    """

    def __init__(self, parameters: OceanParameters) -> None:
        self.parameters = parameters

    @cached_property
    def seas(self) -> tuple[Ocean, ...]:
        """From the finest on; each has the same drift."""
        found = [self._sea(0)]
        least = _LEAST_SHARE * found[0].divergence_variance
        while len(found) < _MOST_LEVELS:
            sea = self._sea(len(found))
            if sea.divergence_variance <= least:
                break
            found.append(sea)
        return tuple(found)

    @cached_property
    def beyond(self) -> Whitecaps:
        """What the mean of the sea is."""
        foam = foam_outlook(self.parameters).coverage
        breaking = min(self.seas[0].mean_breaking, foam)
        # births are as frequent at any time before, so what is left of them is exponential in its age
        age = self.parameters.foam.half_life / math.log(2.0)
        return Whitecaps(*(np.array(value, np.float32) for value in (foam, breaking, age)))

    def mixed(self, own: Whitecaps, level: int, seen: float = FINEST) -> Whitecaps:
        """Foam of a level with the mean for what it does not know.

        seen : size in m of the smallest cell that can be seen at all; the waves of smaller ones count nowhere
        """
        share = np.float32(min(1.0, self.seas[level].divergence_variance / self._variance(seen)))
        mean, rest = self.beyond, np.float32(1.0) - share
        foam, breaking, age = own
        return Whitecaps(
            share * foam + rest * mean.foam,
            share * breaking + rest * mean.breaking,
            np.where(share * foam >= rest * mean.foam, age, mean.foam_age),
        )

    def _variance(self, cell: float) -> float:
        """Of the strains that a level with cells of any size in m would hold."""
        variances = [sea.divergence_variance for sea in self.seas]
        return float(np.interp(math.log2(cell / FINEST), np.arange(len(variances)), variances))

    def _sea(self, level: int) -> Ocean:
        # foam that is made coarser elsewhere is coarse by the levels alone here
        parameters = self.parameters
        sea = parameters.replace(foam=replace(parameters.foam, resolution=0), patches=parameters.patches)
        shortest = _CELLS_A_WAVE * FINEST * 2.0**level
        ends = (patch.shortest_wavelength for patch in sea.patches)
        shortest = next((end for end in ends if end <= shortest <= _WHOLE * end), shortest)
        return Ocean(waves_above(sea, shortest, _SAMPLES_A_WAVE))
