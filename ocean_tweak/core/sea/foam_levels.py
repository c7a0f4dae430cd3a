# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of detail of a sea's foam: each level resolves waves half as fine as the one before.

Level n has cells of size FINEST·2ⁿ, and the foam of the sea without waves shorter than four cells: it forms
on the crests visible at that distance, with the threshold for these waves, so the grid does not show.

The coarser a level, the fewer breaking crests it resolves. Its foam F is weighted by the fraction κ of the
visible strain variance that it resolves, and mixed with the sea's mean W: κF + (1 - κ)W. This preserves the
mean, and unresolved foam is even. Beyond the last level there is only W. Dupuy & Bruneton (2012) average
whitecaps over unresolved waves for the same reason.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property

import numpy as np

from ..foam.model import Whitecaps
from ..foam.threshold import foam_outlook
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.patch_seas import in_patches, waves_above
from .ocean import Ocean
from .placed_waves import makes_foam

#: size of the finest level's cells, m
FINEST = 0.25
#: cells per shortest wave of a level
_CELLS_A_WAVE = 4.0
#: samples of a patch along its shortest wave: interpolation then loses a quarter of that wave's variance, and
# less of longer ones
_SAMPLES_A_WAVE = 4.25
#: ratio up to which a level's shortest wave may exceed that of a patch without cutting the patch: levels
# share the strains of patches that they hold completely
_WHOLE = 1.15
#: a level that resolves less than this fraction of the strain variance is not used
_LEAST_SHARE = 0.15
_MOST_LEVELS = 10
#: levels of a sea with hulls, whose foam is seen where the waves are too short for any: some 800 m
_FAR_LEVELS = 6


class FoamLevels:
    """The foam levels of a sea of patches; one without is a single patch. Creating it is cheap.

    far : reach as far as foam of hulls is seen, whatever the waves are; so it is where the sea has hulls

    `parameters` describe that sea, `seas` the levels, as far as they resolve enough of the strains.
    """

    def __init__(self, parameters: OceanParameters, far: bool = False) -> None:
        self.parameters = in_patches(parameters)
        self._least = _FAR_LEVELS if far or makes_foam(parameters) else 1

    @cached_property
    def seas(self) -> tuple[Ocean, ...]:
        """From the finest level; all have the same drift."""
        found = [self._sea(0)]
        least = _LEAST_SHARE * found[0].divergence_variance
        while len(found) < _MOST_LEVELS:
            sea = self._sea(len(found))
            if len(found) >= self._least and sea.divergence_variance <= least:
                break
            found.append(sea)
        return tuple(found)

    @cached_property
    def beyond(self) -> Whitecaps:
        """The mean foam of the sea."""
        foam = foam_outlook(self.parameters).coverage
        breaking = min(self.seas[0].mean_breaking, foam)
        # births are equally frequent at all times, so the remaining foam is exponential in its age
        age = self.parameters.foam.half_life / math.log(2.0)
        return Whitecaps(*(np.array(value, np.float32) for value in (foam, breaking, age)))

    def mixed(self, own: Whitecaps, level: int, seen: float = FINEST) -> Whitecaps:
        """Foam of a level, mixed with the mean for unresolved foam.

        seen : size in m of the smallest visible cell; waves too short for it are ignored
        """
        own_variance, whole = self.seas[level].divergence_variance, self._variance(seen)
        share = np.float32(min(1.0, own_variance / whole) if whole > 0.0 else 1.0)
        mean, rest = self.beyond, np.float32(1.0) - share
        foam, breaking, age = own
        return Whitecaps(
            share * foam + rest * mean.foam,
            share * breaking + rest * mean.breaking,
            np.where(share * foam >= rest * mean.foam, age, mean.foam_age),
        )

    def _variance(self, cell: float) -> float:
        """Strain variance that a level with cells of a size in m would resolve."""
        variances = [sea.divergence_variance for sea in self.seas]
        return float(np.interp(math.log2(cell / FINEST), np.arange(len(variances)), variances))

    def _sea(self, level: int) -> Ocean:
        # the resolution of foam elsewhere does not apply: here the levels determine it
        parameters = self.parameters
        sea = parameters.replace(foam=replace(parameters.foam, resolution=0), patches=parameters.patches)
        shortest = _CELLS_A_WAVE * FINEST * 2.0**level
        ends = (patch.shortest_wavelength for patch in sea.patches)
        shortest = next((end for end in ends if end <= shortest <= _WHOLE * end), shortest)
        return Ocean(waves_above(sea, shortest, _SAMPLES_A_WAVE))
