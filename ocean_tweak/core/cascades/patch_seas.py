# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea of patches as seas of one patch each, in their own axes: their sum is the sea."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

from ..parameters import Mask, OceanParameters, Patch

#: samples along the shortest wave of a patch that is read between its samples for a grid: bilinear, a tenth
#: of that wave's variance is lost, and less of longer ones
_SAMPLES_A_WAVE = 8.0
_FEWEST, _MOST = 16, 8192

#: the fields that hold layers of any kind
_LAYERS = ("layers", "pictures", "wind_fields")


#: among outputs: those of each part of the sea, which add up, behind the sea's own
PARTS = "parts"


def rotations(parameters: OceanParameters) -> tuple[float, ...]:
    """By how much each patch is turned, rad counter-clockwise."""
    return tuple(patch.rotation for patch in parameters.patches) or (0.0,)


def patch_parameters(parameters: OceanParameters) -> tuple[OceanParameters, ...]:
    """The parameters of each patch, in axes that lie along its sides; a sea without patches is its only one.

    Masks are left out, and patches are apart even where they are joined. What a patch holds of a layer is for
    the layer to say; the first keeps the random numbers of a sea of one patch.
    """
    parameters = _without_masks(parameters).apart
    if not parameters.patches:
        return (parameters,)
    return tuple(_of_patch(parameters, index, patch) for index, patch in enumerate(parameters.patches))


def _of_patch(parameters: OceanParameters, index: int, patch: Patch) -> OceanParameters:
    held = {
        name: tuple(
            layer
            for given in getattr(parameters, name)
            if (layer := given.in_patch(parameters, index, patch.rotation)) is not None
        )
        for name in (*_LAYERS, "hero_waves")
    }
    return parameters.replace(patches=(replace(patch, rotation=0.0),), **held)


@dataclass(frozen=True)
class Part:
    """Some waves of a sea, which have a grid and a weight of their own. The sea is the sum of its parts.

    parameters : of a sea of one patch, in axes along the patch's sides
    rotation : by which those are turned, rad counter-clockwise
    masks : whose product is the weight, in the sea's axes
    patch : the number of the patch
    """

    parameters: OceanParameters
    rotation: float
    masks: tuple[Mask, ...]
    patch: int

    @property
    def spacing(self) -> float:
        """Between its samples, m."""
        return self.parameters.domain_size / self.parameters.resolution


def parts(parameters: OceanParameters) -> tuple[Part, ...]:
    """The parts of a sea: of each patch, the waves under each mask."""
    found = []
    patches = parameters.patches or (None,)
    seas = patch_parameters(parameters)
    for index, (sea, patch, rotation) in enumerate(zip(seas, patches, rotations(parameters), strict=True)):
        of_patch = (patch.mask,) if patch is not None and patch.mask is not None else ()
        found += [
            Part(under, rotation, of_patch if mask is None else (*of_patch, mask), index)
            for mask, under in _by_mask(parameters, sea)
        ]
    return tuple(found)


def joined_bands(parameters: OceanParameters) -> OceanParameters:
    """A joined sea's patches apart, without the waves shorter than two samples of its one grid.

    The first has the grid's samples, the others as many as reading between them takes. The last that is left
    holds no waves shorter than two of its own samples either; where another follows, bands must meet.
    """
    shortest = 2.0 * parameters.domain_size / parameters.resolution
    first, *others = parameters.patches
    kept = [first, *(patch for patch in others if patch.longest_wavelength > shortest)]
    if len(kept) > 1 and kept[-1].longest_wavelength <= 2.0 * kept[-1].spacing:
        kept.pop()
    ends = [patch.shortest_wavelength for patch in kept]
    ends[-1] = max(ends[-1], shortest, 2.0 * kept[-1].spacing)
    bands = [_readable(patch, end) for patch, end in zip(kept, ends, strict=True)]
    if not first.rotation:
        bands[0] = replace(first, resolution=parameters.resolution)
    return parameters.replace(joined=0, patches=tuple(bands))


def _readable(patch: Patch, end: float) -> Patch:
    wanted = 2 * math.ceil(0.5 * _SAMPLES_A_WAVE * patch.domain_size / end)
    return replace(patch, shortest_wavelength=end, resolution=min(max(wanted, _FEWEST), _MOST))


def _by_mask(
    parameters: OceanParameters, sea: OceanParameters
) -> Iterable[tuple[Mask | None, OceanParameters]]:
    """The masks of a sea's layers, and with each a patch of the sea whose other layers are muted."""
    own = [layer for name in _LAYERS for layer in getattr(parameters, name) if not layer.muted]
    masks = list(dict.fromkeys(layer.mask for layer in own))
    if len(masks) < 2:
        return [(masks[0] if masks else None, sea)]
    if None in masks:  # with the waves that are everywhere
        masks.insert(0, masks.pop(masks.index(None)))
    return [(mask, _only(parameters, sea, mask, index == 0)) for index, mask in enumerate(masks)]


def _only(
    parameters: OceanParameters, sea: OceanParameters, mask: Mask | None, with_hero_waves: bool
) -> OceanParameters:
    changes: dict[str, Any] = {} if with_hero_waves else {"hero_waves": ()}
    for name in _LAYERS:
        changes[name] = tuple(
            replace(layer, muted=layer.muted or given.mask != mask)
            for given, layer in zip(getattr(parameters, name), getattr(sea, name), strict=False)
        )
    return sea.replace(**changes)


def _without_masks(parameters: OceanParameters) -> OceanParameters:
    if not parameters.is_masked:
        return parameters
    changes = {
        name: tuple(replace(layer, mask=None) for layer in getattr(parameters, name))
        for name in (*_LAYERS, "patches")
    }
    return parameters.replace(**changes)
