# SPDX-License-Identifier: GPL-3.0-or-later
"""Splits a sea of patches into seas of one patch each, along their own axes; their sum is the sea."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from ..waves.contribution import Contribution, Gives
from ..waves.spectral import with_settled_equaliser
from .ocean_parameters import Mask, OceanParameters, Patch

#: samples along the shortest wave of a patch that is interpolated onto a grid: bilinear interpolation then
# loses a tenth of that wave's variance, and less of longer waves
_SAMPLES_A_WAVE = 8.0
_FEWEST, _MOST = 16, 8192


#: additional outputs: the summable fields of each part of the sea, besides those of the sum
PARTS = "parts"
#: and what is over the bed of a sea with a coast, besides the tile of the open sea
OVER_BED = "coast"
#: the same for waves that do not repeat, in the square around a shot's camera
AROUND = "wakes"


def rotations(parameters: OceanParameters) -> tuple[float, ...]:
    """Rotation of each patch, rad counter-clockwise."""
    return tuple(patch.rotation for patch in parameters.patches) or (0.0,)


def patch_parameters(parameters: OceanParameters) -> tuple[OceanParameters, ...]:
    """The parameters of each patch, in axes along its sides; a sea without patches is returned as the only
    one.

    Masks are omitted, and merged patches are separated. Each layer determines what a patch holds of it; the
    first patch has the random numbers of a sea without patches.
    """
    return tuple(_without_masks(sea) for sea in _patch_seas(parameters.separate))


def _patch_seas(parameters: OceanParameters) -> tuple[OceanParameters, ...]:
    parameters = with_settled_equaliser(parameters)
    if not parameters.patches:
        return (parameters,)
    return tuple(_of_patch(parameters, index, patch) for index, patch in enumerate(parameters.patches))


def _of_patch(parameters: OceanParameters, index: int, patch: Patch) -> OceanParameters:
    held = (layer.in_patch(parameters, index, patch.rotation) for layer in parameters.layers)
    layers = tuple(layer for layer in held if layer is not None)
    current = parameters.current
    if current is not None and patch.rotation:
        current = current.turned(patch.rotation)
    return parameters.replace(patches=(replace(patch, rotation=0.0),), layers=layers, current=current)


def in_patches(parameters: OceanParameters) -> OceanParameters:
    """A sea without patches as one of a single patch, with the same waves; any other as it is.

    Patches know no trough damping: its troughs are then as deep as without.
    """
    if parameters.patches:
        return parameters
    only = Patch(parameters.domain_size, resolution=parameters.resolution)
    return parameters.replace(patches=(only,), trough_damping=0.0)


@dataclass(frozen=True)
class Part:
    """A part of a sea's waves with its own grid and weight. The sea is the sum of its parts.

    parameters : those of a sea of one patch, in axes along the patch's sides
    rotation : of these axes, rad counter-clockwise
    masks : their product is the weight, in the sea's axes
    patch : index of the patch
    """

    parameters: OceanParameters
    rotation: float
    masks: tuple[Mask, ...]
    patch: int

    @property
    def spacing(self) -> float:
        """Distance between its samples, m."""
        return self.parameters.domain_size / self.parameters.resolution


def parts(parameters: OceanParameters) -> tuple[Part, ...]:
    """The parts of a sea: for each patch, the waves under each mask."""
    found = []
    patches = parameters.patches or (None,)
    seas = _patch_seas(parameters.separate)
    masks = list(dict.fromkeys(layer.mask for layer in parameters.active() if _is_on_grid(layer)))
    if None in masks:  # unmasked waves come first
        masks.insert(0, masks.pop(masks.index(None)))
    for index, (sea, patch, rotation) in enumerate(zip(seas, patches, rotations(parameters), strict=True)):
        over_all = (parameters.mask, None if patch is None else patch.mask)
        of_patch = tuple(each for each in over_all if each is not None)
        found += [
            Part(_without_masks(under), rotation, of_patch if mask is None else (*of_patch, mask), index)
            for mask, under in _by_mask(sea, masks)
        ]
    return tuple(found)


def merged_bands(parameters: OceanParameters) -> OceanParameters:
    """A merged sea's patches on separate grids, without waves shorter than two samples of the merged grid.

    The first has the merged grid's resolution, the others as many samples as interpolation needs.
    """
    first = parameters.patches[0]
    bands = list(_bands_above(parameters.patches, 2.0 * parameters.domain_size / parameters.resolution))
    if not first.rotation:
        bands[0] = replace(first, resolution=parameters.resolution)
    return parameters.replace(merged_resolution=0, patches=tuple(bands))


def waves_above(parameters: OceanParameters, shortest: float, samples_a_wave: float) -> OceanParameters:
    """A sea's patches on separate grids, without waves shorter than a length in m, each with about a given
    number of samples along its shortest wave, rounded to sizes with fast transforms.
    """
    bands = _bands_above(parameters.patches, shortest, samples_a_wave)
    patches = tuple(replace(patch, resolution=_quickest(patch.resolution)) for patch in bands)
    return parameters.replace(merged_resolution=0, patches=patches)


def _quickest(samples: int) -> int:
    """The nearest even number whose only prime factors are 2, 3 and 5."""
    twos, threes, fives = (range(1, 14), range(9), range(6))
    products = (2**a * 3**b * 5**c for a in twos for b in threes for c in fives)
    return min((each for each in products if _FEWEST <= each <= _MOST), key=lambda each: abs(each - samples))


def _bands_above(
    patches: Sequence[Patch], shortest: float, samples_a_wave: float = _SAMPLES_A_WAVE
) -> Iterator[Patch]:
    """The patches with waves longer than a length, without the shorter ones.

    The last remaining patch also loses waves shorter than two of its own samples; the others must keep
    meeting the next band.
    """
    first, *others = patches
    kept = [first, *(patch for patch in others if patch.longest_wavelength > shortest)]
    if len(kept) > 1 and kept[-1].longest_wavelength <= 2.0 * kept[-1].spacing:
        kept.pop()
    ends = [patch.shortest_wavelength for patch in kept]
    ends[-1] = max(ends[-1], shortest, 2.0 * kept[-1].spacing)
    yield from (_readable(patch, end, samples_a_wave) for patch, end in zip(kept, ends, strict=True))


def _readable(patch: Patch, end: float, samples_a_wave: float) -> Patch:
    wanted = 2 * math.ceil(0.5 * samples_a_wave * patch.domain_size / end)
    return replace(patch, shortest_wavelength=end, resolution=min(max(wanted, _FEWEST), _MOST))


def _by_mask(
    sea: OceanParameters, masks: Sequence[Mask | None]
) -> Iterator[tuple[Mask | None, OceanParameters]]:
    """Masks, each with the sea of one patch in which all layers with other masks are muted."""
    if len(masks) < 2:
        yield (masks[0] if masks else None), sea
        return
    for mask in masks:
        layers = (
            layer if (layer.mask if _is_on_grid(layer) else masks[0]) == mask else layer.changed(muted=True)
            for layer in sea.layers
        )
        yield mask, sea.replace(layers=tuple(layers))


def _is_on_grid(layer: Contribution) -> bool:
    """Whether a layer's waves are on a grid; other layers are kept in the first part, which does not compute
    them."""
    return Gives.FIELDS not in layer.gives


def open_sea(parameters: OceanParameters) -> OceanParameters:
    """The sea whose waves are those that come to its coast, without what becomes of them there."""
    if parameters.coast is None or not parameters.has_coast:
        return parameters
    return parameters.replace(coast=replace(parameters.coast, muted=True))


def _without_masks(parameters: OceanParameters) -> OceanParameters:
    parameters = open_sea(parameters)
    if not parameters.is_masked:
        return parameters
    return parameters.replace(
        mask=None,
        layers=tuple(
            layer if layer.mask is None else layer.changed(mask=None) for layer in parameters.layers
        ),
        patches=tuple(replace(patch, mask=None) for patch in parameters.patches),
    )
