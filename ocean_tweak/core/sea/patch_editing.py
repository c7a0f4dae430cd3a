# SPDX-License-Identifier: GPL-3.0-or-later
"""Adding and removing patches, so that the sea still contains every wave exactly once."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from ..data.errors import ParameterError
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.patch import LEAST_CELLS, LEAST_SAMPLES, MOST_PATCHES, REPEATING_SHARE, Patch
from ..waves.contribution import NO_SHORTEST
from .patch_plan import RESOLUTIONS, SPARE, odd_side, rotation_of, rounded, wavelength_with_share_below

#: longest waves along a side of a new patch, if its resolution allows
_CELLS = 12.0
#: smallest band that is split in two, in octaves, so that either half is worth a patch
_LEAST_RATIO = 4.0
#: samples along a side of a new patch that continues beyond the last one's grid
_LEAST_RESOLUTION = 128


def with_another_patch(parameters: OceanParameters) -> OceanParameters:
    """The sea with one more patch after the last.

    It takes over the shorter half of the last patch's octaves; from the first patch, only waves that may
    repeat. If the last patch has no short end, or too few octaves, the new one continues with shorter waves.
    A sea without patches first becomes a sea of one.

    Raises ParameterError if there are too many patches, and for settings that patches do not support.
    """
    patches = parameters.patches or (
        Patch(domain_size=parameters.domain_size, resolution=parameters.resolution),
    )
    if len(patches) >= MOST_PATCHES:
        raise ParameterError("patches", len(patches), f"are as many as there can be: {MOST_PATCHES}")
    *others, last = patches
    longest = min(last.longest_wavelength, last.domain_size)
    if last.shortest_wavelength == NO_SHORTEST:
        end = min(SPARE * LEAST_SAMPLES * last.spacing, longest / math.sqrt(_LEAST_RATIO))
        shared = replace(last, shortest_wavelength=rounded(end))
        added = _finer(shared, patches)
    elif longest < _LEAST_RATIO * last.shortest_wavelength:
        shared, added = last, _finer(last, patches)
    else:
        shared, added = _halves(parameters, last, patches)
    return parameters.replace(patches=(*others, shared, added))


def without_patch(parameters: OceanParameters, index: int) -> OceanParameters:
    """The sea without one of its patches. Its waves go to the previous one; those of the first go to the
    next, which becomes the first and is no longer rotated.

    Removing the only patch leaves a sea without patches. Raises IndexError for an invalid index.
    """
    patches = list(parameters.patches)
    gone = patches.pop(index)
    if not patches:
        return parameters.without_patches
    if index > 0:
        patches[index - 1] = replace(patches[index - 1], shortest_wavelength=gone.shortest_wavelength)
    else:
        patches[0] = replace(patches[0], longest_wavelength=gone.longest_wavelength, rotation=0.0)
    return parameters.replace(patches=tuple(patches))


def _finer(last: Patch, patches: Sequence[Patch]) -> Patch:
    """A patch of waves shorter than the last one's, down to the shortest on its grid."""
    longest = last.shortest_wavelength
    resolution = max(last.resolution, _LEAST_RESOLUTION)
    side = _side(_CELLS * longest, SPARE * _CELLS * longest, patches)
    shortest = rounded(SPARE * LEAST_SAMPLES * side / resolution)
    return Patch(side, rotation_of(len(patches)), shortest, longest, resolution)


def _halves(parameters: OceanParameters, last: Patch, patches: Sequence[Patch]) -> tuple[Patch, Patch]:
    """Split a patch into one with the longer half of its octaves and one with the shorter half."""
    shortest = last.shortest_wavelength
    longest = min(last.longest_wavelength, last.domain_size)
    end = math.sqrt(shortest * longest)
    if len(patches) == 1:
        end = min(end, wavelength_with_share_below(parameters, REPEATING_SHARE))
    end = rounded(max(end, math.sqrt(_LEAST_RATIO) * shortest))
    resolution, high = last.resolution, 0.0
    for resolution in (last.resolution, *(size for size in RESOLUTIONS if size > last.resolution)):
        high = shortest * resolution / (SPARE * LEAST_SAMPLES)
        if high >= SPARE * LEAST_CELLS * end:
            break
    side = _side(SPARE * LEAST_CELLS * end, min(high, SPARE * _CELLS * end), patches)
    added = Patch(side, rotation_of(len(patches)), shortest, end, resolution, last.mask)
    return replace(last, shortest_wavelength=end), added


def _side(low: float, high: float, patches: Sequence[Patch]) -> float:
    side = odd_side(low, max(low, high), patches)
    return rounded(low) if side is None else side
