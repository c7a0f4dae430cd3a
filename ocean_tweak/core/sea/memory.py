# SPDX-License-Identifier: GPL-3.0-or-later
"""Estimates of a sea's memory use, before it is created."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..data.printable import readable_bytes
from ..numerics.machine import usable_memory
from ..numerics.memo import MEMO, VARIABLE
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.patch_seas import AROUND, OVER_BED, PARTS, merged_bands, open_sea, parts
from ..synthesis.channels import ADDING, CHANNELS, OF_MEMORY, memory_groups
from ..synthesis.transforms import term
from ..waves.coast.ground import Ground
from ..waves.coast.mesh import places_over
from ..waves.contribution import Gives, MemoryNeed
from ..waves.kinds import KINDS
from .coast_pictures import most_frequencies
from .placed_waves import without_placed
from .regions import TILE, Area, Tile

#: temporary float64 half-plane arrays while the initial state is computed
_TEMPORARY_ARRAYS = 5

#: bytes per sample of an area: its position, its cell in a part, and the values read there
_READING = 80

#: bytes per sample of a tile, kept for each interpolated part: its position there, and the blend weights at
# the far sides
_PLACED = 18

#: bytes per sample of an area with foam: births there and at the sources of old foam
_LOOKING_BACK = 96

#: bytes a sample over a bed: components there and derivatives, and what they are made of
_OVER_BED = 160
#: and a place of the mesh over it, read and written
_A_PLACE = 600

#: bytes a sample of the square around a camera: its place, and components of waves that do not repeat there
A_SAMPLE_AROUND = 400

#: what lowers the memory of a sea, and that of a coast
_FEWER_SAMPLES = "lower the resolution or the number of workers"
_COARSER_COAST = "set a larger coast.step or coast.shortest_wavelength"

#: bytes of the tables from which a state is computed, at any resolution
TABLES = 48 * 2**20


def memory_need(
    parameters: OceanParameters,
    outputs: Iterable[str] = ("displacement",),
    precision: str = "single",
    on: Tile | Area = TILE,
) -> MemoryNeed:
    """Memory that a sea needs for the requested outputs; a sea of several patches holds all of them at
    once."""
    outputs = frozenset(outputs)
    if AROUND in outputs:
        return _need_beside_placed(parameters, outputs - {AROUND}, precision)
    if OVER_BED in outputs:
        return _need_over_bed(parameters, outputs - {OVER_BED}, precision)
    if PARTS in outputs:
        return _need_with_parts(parameters, outputs - {PARTS}, precision)
    if isinstance(on, Area):
        return _need_in_area(parameters, outputs, precision, on)
    if parameters.needs_summation:
        return _need_of_parts(parameters, outputs, precision)
    n = parameters.resolution
    half_plane = n * (n // 2 + 1)
    real = 4 if precision == "single" else 8
    wanted = outputs - OF_MEMORY
    moving = any(derivative == "t" for name in wanted for _, derivative in CHANNELS[name].needs)
    given = {kind: kind.memory(parameters, real, moving) for kind in KINDS if parameters.active(kind)}
    state = half_plane * (3 * 2 * real + 2 * real + 8) + sum(need.state for need in given.values())
    building = half_plane * 8 * _TEMPORARY_ARRAYS + TABLES
    building += max((given[kind].building for kind in given if Gives.COEFFICIENTS in kind.gives), default=0)
    fields = _foam_bytes(parameters) if outputs & OF_MEMORY else 0
    fields += sum(int(np.prod(CHANNELS[name].shape(n))) * real for name in wanted)
    gradient = not any(Gives.SHARES in kind.gives for kind in given)
    columns = max((_columns(group, gradient) for group in memory_groups(wanted)), default=0)
    if parameters.trough_damping > 0.0:
        columns *= 2
    surface = fields + columns * half_plane * 2 * real + sum(need.surface for need in given.values())
    return MemoryNeed(state, max([building, *(need.building for need in given.values())]), surface)


def _need_with_parts(parameters: OceanParameters, outputs: frozenset[str], precision: str) -> MemoryNeed:
    """Memory of the sea and of each of its parts, which are kept as well."""
    needs = [memory_need(parameters, outputs, precision)]
    needs += [memory_need(part.parameters, ADDING, precision) for part in parts(parameters)]
    return MemoryNeed(
        sum(need.state for need in needs),
        max(need.building for need in needs),
        sum(need.surface for need in needs),
    )


def _need_beside_placed(parameters: OceanParameters, outputs: frozenset[str], precision: str) -> MemoryNeed:
    """Memory of the sea without waves that do not repeat, and of these."""
    real = 4 if precision == "single" else 8
    kinds = (kind for kind in KINDS if Gives.FIELDS in kind.gives and parameters.active(kind))
    needs = [memory_need(without_placed(parameters), outputs, precision)]
    needs += (kind.memory(parameters, real, True) for kind in kinds)
    return MemoryNeed(
        sum(need.state for need in needs),
        max(need.building for need in needs),
        sum(need.surface for need in needs),
    )


def _need_over_bed(parameters: OceanParameters, outputs: frozenset[str], precision: str) -> MemoryNeed:
    """Memory of the open sea's tile, of the coast and of the mesh over its bed."""
    tile, coast = memory_need(open_sea(parameters), outputs, precision), coast_need(parameters)
    mesh = _A_PLACE * places_over(ground_of(parameters))
    return MemoryNeed(
        tile.state + coast.state, max(tile.building, coast.building), tile.surface + coast.surface + mesh
    )


def _need_of_parts(parameters: OceanParameters, outputs: frozenset[str], precision: str) -> MemoryNeed:
    """Memory of all parts, plus the summed components on the merged grid."""
    separate = merged_bands(parameters) if parameters.merged_resolution else parameters
    of_parts = parts(separate)
    needs = [memory_need(part.parameters, outputs - OF_MEMORY, precision) for part in of_parts]
    state, surface = sum(need.state for need in needs), sum(need.surface for need in needs)
    if not parameters.is_cascade:
        state += (
            _PLACED
            * parameters.resolution**2
            * sum(part.patch > 0 or part.rotation != 0.0 for part in of_parts)
        )
        keys = max(
            (
                len({key for name in group for key in CHANNELS[name].needs})
                for group in memory_groups(outputs - OF_MEMORY)
            ),
            default=0,
        )
        surface += 3 * keys * parameters.resolution**2 * (4 if precision == "single" else 8)
        surface += _foam_bytes(parameters) if outputs & OF_MEMORY else 0
    return MemoryNeed(state, max(need.building for need in needs), surface)


def ground_of(parameters: OceanParameters) -> Ground:
    """The bed of a sea with a coast, as waves meet it. Raises ParameterError."""
    assert parameters.coast is not None
    first = parameters.patches[0] if parameters.patches else None
    size, resolution = parameters.domain_size, parameters.resolution
    return Ground.of(
        parameters.coast, first.domain_size if first else size, first.resolution if first else resolution,
        first.rotation if first else 0.0, parameters.water.depth,
    )  # fmt: skip


def coast_need(parameters: OceanParameters) -> MemoryNeed:
    """That of what becomes of waves over a bed; nothing without one."""
    if not parameters.has_coast:
        return MemoryNeed(0, 0, 0)
    ground = ground_of(parameters)
    samples, count = ground.rows * ground.columns, most_frequencies(parameters)
    # what walls throw back is marched beside what arrived
    building = 24 if parameters.coast is None or parameters.coast.mirror == 0.0 else 32
    return MemoryNeed(16 * count * samples, building * count * samples, _OVER_BED * samples)


def _need_in_area(
    parameters: OceanParameters, outputs: frozenset[str], precision: str, on: Area
) -> MemoryNeed:
    """Memory of all parts on their own grids, plus the summed components in the area."""
    separate = merged_bands(parameters) if parameters.merged_resolution else parameters
    waves = (outputs - OF_MEMORY) | ({"cusp"} if outputs & OF_MEMORY else set())
    needs = [memory_need(part.parameters, waves, precision) for part in parts(separate)]
    keys = {key for name in waves for key in CHANNELS[name].needs}
    real = 4 if precision == "single" else 8
    numbers = sum(max(1, CHANNELS[name].components) for name in outputs)
    a_sample = _READING + (2 * numbers + (len(needs) + 1) * len(keys)) * real
    coast = coast_need(parameters)
    needs.append(coast)
    surface = sum(need.surface for need in needs)
    if outputs & OF_MEMORY:
        surface += _foam_bytes(parameters)
        a_sample += _LOOKING_BACK
    return MemoryNeed(
        sum(need.state for need in needs),
        max(need.building for need in needs),
        surface + a_sample * on.resolution**2,
    )


def _foam_bytes(parameters: OceanParameters) -> int:
    """Bytes of the foam fields, and at the foam's own resolution of births with their times, looks, windrow
    arrays, a compression and temporaries."""
    own = parameters.foam.resolution or parameters.resolution
    return 4 * len(OF_MEMORY) * parameters.resolution**2 + 104 * own**2


def _columns(group: Iterable[str], gradient: bool) -> int:
    return len({term(*need, gradient=gradient).column for name in group for need in CHANNELS[name].needs})


def remedy_for(parameters: OceanParameters, need: int) -> str:
    """What lowers a sea's need of so many bytes: a coarser coast, if most of it is that of a coast."""
    coast = coast_need(parameters)
    return _COARSER_COAST if 2 * (coast.state + coast.building) > need else _FEWER_SAMPLES


def check_coast_memory(parameters: OceanParameters, what: str = "What the bed makes of the waves") -> None:
    """Raise MemoryError, with a remedy, if the machine has too little memory for the sea's coast."""
    coast = coast_need(parameters)
    check_memory(coast.state + coast.building, what, _COARSER_COAST)


def check_memory(need: int, what: str, remedy: str = _FEWER_SAMPLES) -> None:
    """Raise MemoryError, with a remedy, if the machine or container has less memory than needed."""
    available = usable_memory()
    if available is not None and need > available:
        raise MemoryError(
            f"{what} needs {need / 2**30:.1f} GB of memory and this machine has {available / 2**30:.1f} GB: "
            f"{remedy}"
        )


def beyond_budget(parameters: OceanParameters) -> str | None:
    """A warning, with a remedy, for a sea whose waves exceed the memory budget of this process.

    None if they fit. Such a sea is still shown, as an ocean in use keeps its own waves.
    """
    need, budget = memory_need(parameters).state, MEMO.budget
    if need <= budget:
        return None
    return (
        f"This sea needs {readable_bytes(need)}, and the memory for all seas is "
        f"{readable_bytes(budget)}: beside other seas it is recomputed for every frame. Lower the "
        "resolution, or raise Memory in the extension's preferences (outside Blender: "
        f"{VARIABLE}) to {readable_bytes(1.5 * need)}"
    )
