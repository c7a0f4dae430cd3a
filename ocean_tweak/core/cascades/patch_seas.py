# SPDX-License-Identifier: GPL-3.0-or-later
"""A sea of patches as seas of one patch each, in their own axes: their sum is the sea."""

from __future__ import annotations

from dataclasses import replace

from .. import random
from ..initial_state import layer_seed
from ..parameters import OceanParameters, Patch, WaveLayer

_LARGEST_SEED = 2**31 - 1


#: outputs of a patch that, turned, add up to those of the sea; normals and eigenvalues are made of the sums
ADDING = frozenset({"displacement", "velocity", "slope", "strain"})


def rotations(parameters: OceanParameters) -> tuple[float, ...]:
    """By how much each patch is turned, rad counter-clockwise."""
    return tuple(patch.rotation for patch in parameters.patches) or (0.0,)


def patch_parameters(parameters: OceanParameters) -> tuple[OceanParameters, ...]:
    """The parameters of each patch, in axes that lie along its sides; a sea without patches is its only one.

    A wind towards θ blows towards θ - rotation there. Each patch has random numbers of its own, or waves at a
    band's end, of which two patches hold a part each, would be alike in both. The first keeps those of a
    sea of one patch, and holds the pictures, wind fields and hero waves.
    """
    if not parameters.patches:
        return (parameters,)
    return tuple(_of_patch(parameters, index, patch) for index, patch in enumerate(parameters.patches))


def _of_patch(parameters: OceanParameters, index: int, patch: Patch) -> OceanParameters:
    layers = tuple(_in_patch(parameters, layer, index, patch.rotation) for layer in parameters.layers)
    others = {"pictures": (), "wind_fields": (), "hero_waves": ()} if index else {}
    return parameters.replace(layers=layers, patches=(replace(patch, rotation=0.0),), **others)


def _in_patch(parameters: OceanParameters, layer: WaveLayer, index: int, rotation: float) -> WaveLayer:
    if rotation:
        layer = replace(layer, wind_direction=layer.wind_direction - rotation)
    if index:
        seed = random.combine(layer_seed(parameters, layer), index) & _LARGEST_SEED
        layer = replace(layer, seed=seed)
    return layer
