# SPDX-License-Identifier: GPL-3.0-or-later
"""Statistics of a sea of patches: of the sum and of each patch."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Sequence

import numpy as np

from ..parameters.ocean_parameters import OceanParameters
from ..parameters.patch import LEAST_CELLS, LEAST_SAMPLES, REPEATING_SHARE
from ..parameters.patch_seas import patch_parameters
from ..spectral.sea_state import SeaState, together
from ..statistics.sea_spectrum import SeaSpectrum
from ..statistics.sea_statistics import (
    FLAT,
    LEAST_RESOLVED_SHARE,
    PatchStatistics,
    Statistics,
    continuous_state,
    fetch_warnings,
    grid_warnings,
    is_told_apart,
    layer_warnings,
    loop_warnings,
    steepness_warnings,
)
from ..waves.contribution import NO_LONGEST


def statistics_of_patches(parameters: OceanParameters, of_patches: Sequence[Statistics]) -> Statistics:
    """Combine the statistics of patches, each in its own axes, to those of the sea."""
    patches = parameters.patches
    in_sea = [_turned(found, patch.rotation) for found, patch in zip(of_patches, patches, strict=True)]
    whole = parameters.replace(patches=())
    sea = SeaSpectrum(whole)
    spectrum = continuous_state(sea)
    changes = [found.loop_speed_change for found in in_sea if found.loop_speed_change is not None]
    total = Statistics(
        spectrum=spectrum,
        resolved=together([found.resolved for found in in_sea]),
        seed=together([found.seed for found in in_sea]),
        wavelengths_per_domain=parameters.domain_size / spectrum.peak_wavelength,
        sample_spacing=min(patch.spacing for patch in patches),
        loop_speed_change=max(changes, default=None),
        warnings=(),
    )
    m0 = total.resolved.m0
    result = tuple(
        PatchStatistics(patch, found, found.resolved.m0 / m0 if m0 > 0.0 else 0.0)
        for patch, found in zip(patches, in_sea, strict=True)
    )
    warnings = tuple(_warnings(parameters, sea, total, result))
    return dataclasses.replace(total, warnings=warnings, patches=result)


def _turned(found: Statistics, rotation: float) -> Statistics:
    """Statistics of a patch rotated to the sea's axes."""

    def in_sea(state: SeaState) -> SeaState:
        direction = math.remainder(state.mean_direction + rotation, math.tau)
        return dataclasses.replace(state, mean_direction=direction)

    if not rotation:
        return found
    spectrum, resolved, seed = map(in_sea, (found.spectrum, found.resolved, found.seed))
    return dataclasses.replace(found, spectrum=spectrum, resolved=resolved, seed=seed)


def _warnings(
    parameters: OceanParameters, sea: SeaSpectrum, total: Statistics, patches: Sequence[PatchStatistics]
) -> Iterator[str]:
    yield from layer_warnings(sea.parameters)
    if not np.isfinite(total.peak_wavelength):
        if not is_told_apart(parameters):
            yield FLAT
        return
    if not parameters.is_cascade:
        yield from grid_warnings(sea.parameters, sea, total)
    else:
        for index, (found, of_patch) in enumerate(zip(patches, patch_parameters(parameters), strict=True)):
            yield from (f"Patch {index + 1}: {text}" for text in _patch_warnings(found, of_patch, index == 0))
        last = patches[-1].patch
        if total.resolved_share < LEAST_RESOLVED_SHARE:
            yield (
                f"The patches together resolve {100.0 * total.resolved_share:.0f} % of the "
                "energy, down to waves of "
                f"{max(last.shortest_wavelength, 2.0 * last.spacing):.3g} m. Plan them with finer "
                "detail"
            )
    yield from loop_warnings(parameters, total)
    yield from fetch_warnings(parameters, sea)
    yield from steepness_warnings(parameters)


def _patch_warnings(found: PatchStatistics, parameters: OceanParameters, is_first: bool) -> Iterator[str]:
    patch = found.patch
    if patch.shortest_wavelength > 0.0 and patch.samples_a_wave < LEAST_SAMPLES:
        samples = 2 * math.ceil(0.5 * LEAST_SAMPLES * patch.domain_size / patch.shortest_wavelength)
        yield (
            f"its shortest wave, {patch.shortest_wavelength:g} m, has only "
            f"{patch.samples_a_wave:.2g} samples. Give the patch {samples} samples, or end its "
            f"band at {LEAST_SAMPLES * patch.spacing:.3g} m"
        )
    if patch.longest_wavelength < NO_LONGEST and patch.longest_waves_a_side < LEAST_CELLS:
        yield (
            f"its longest wave, {patch.longest_wavelength:g} m, fits only "
            f"{patch.longest_waves_a_side:.2g} times into its side. Make the side at least "
            f"{LEAST_CELLS * patch.longest_wavelength:.3g} m"
        )
    if is_first:
        yield from grid_warnings(parameters, SeaSpectrum(parameters), found.statistics)
    elif found.share > REPEATING_SHARE:
        yield (
            f"it repeats every {patch.domain_size:g} m with {100.0 * found.share:.0f} % of the "
            "energy, which shows. Let the patch before it hold shorter waves too"
        )
