# SPDX-License-Identifier: GPL-3.0-or-later
"""What a sea needs of the machine's memory, told before it is made."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..data.printable import readable_bytes
from ..numerics.machine import usable_memory
from ..numerics.memo import MEMO, VARIABLE
from ..parameters.ocean_parameters import OceanParameters
from ..parameters.patch_seas import PARTS, merged_bands, parts
from ..synthesis.channels import ADDING, CHANNELS, OF_MEMORY, memory_groups
from ..synthesis.transforms import term
from ..waves.contribution import Gives, MemoryNeed
from ..waves.kinds import KINDS
from .regions import TILE, Area, Tile

#: float64 arrays of half the plane that live while the initial state is made, beyond what stays
_TEMPORARY_ARRAYS = 5

#: bytes a sample of an area: where it lies, between which samples of a part, and what is read there
_READING = 80

#: bytes a sample of a tile that are kept for each part which is read between its samples: where it lies
#: there, and how much counts at the far sides
_PLACED = 18

#: bytes a sample of an area where foam is made: births there and where old foam is drawn from
_LOOKING_BACK = 96

#: bytes of the tables from which a state is made, whatever the resolution
TABLES = 48 * 2**20


def memory_need(
    parameters: OceanParameters,
    outputs: Iterable[str] = ("displacement",),
    precision: str = "single",
    on: Tile | Area = TILE,
) -> MemoryNeed:
    """Bytes that a sea needs for the outputs asked for; one of several patches has all of them at once."""
    outputs = frozenset(outputs)
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
    """That of the sea and of each of its parts, which are kept beside it."""
    needs = [memory_need(parameters, outputs, precision)]
    needs += [memory_need(part.parameters, ADDING, precision) for part in parts(parameters)]
    return MemoryNeed(
        sum(need.state for need in needs),
        max(need.building for need in needs),
        sum(need.surface for need in needs),
    )


def _need_of_parts(parameters: OceanParameters, outputs: frozenset[str], precision: str) -> MemoryNeed:
    """That of all parts, and on one grid of the components that are added up there."""
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


def _need_in_area(
    parameters: OceanParameters, outputs: frozenset[str], precision: str, on: Area
) -> MemoryNeed:
    """That of all parts on samples of their own, and of the components that are added up in the area."""
    separate = merged_bands(parameters) if parameters.merged_resolution else parameters
    waves = (outputs - OF_MEMORY) | ({"cusp"} if outputs & OF_MEMORY else set())
    needs = [memory_need(part.parameters, waves, precision) for part in parts(separate)]
    keys = {key for name in waves for key in CHANNELS[name].needs}
    real = 4 if precision == "single" else 8
    numbers = sum(max(1, CHANNELS[name].components) for name in outputs)
    a_sample = _READING + (2 * numbers + (len(needs) + 1) * len(keys)) * real
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
    """The fields themselves; births with their times, the looks that they are from, what draws them out, a
    compression and temporaries at the foam's own resolution."""
    own = parameters.foam.resolution or parameters.resolution
    return 4 * len(OF_MEMORY) * parameters.resolution**2 + 104 * own**2


def _columns(group: Iterable[str], gradient: bool) -> int:
    return len({term(*need, gradient=gradient).column for name in group for need in CHANNELS[name].needs})


def check_memory(need: int, what: str) -> None:
    """Raise MemoryError, with a remedy, where the machine, or the container, has fewer bytes than needed."""
    available = usable_memory()
    if available is not None and need > available:
        raise MemoryError(
            f"{what} needs {need / 2**30:.1f} GB of memory and this machine has {available / 2**30:.1f} GB: "
            "lower the resolution or the number of workers"
        )


def beyond_budget(parameters: OceanParameters) -> str | None:
    """What to say, with a remedy, of a sea whose waves take more than the memory of this process may keep.

    None where they fit. Such a sea is shown all the same: whoever has it keeps its waves.
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
